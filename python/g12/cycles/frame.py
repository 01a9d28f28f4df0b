# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.7/G13.7 frame: a rectangle with round corners, a pocket or a wall.

The motions are in `ngc/g12_frame.ngc`. Every ring is a rectangle of the tool centre about X Y, with
the half lengths a and b along X and Y. It begins in the middle of the side in -Y, on a half circle
from the ring before.
"""

from math import ceil, pi, radians, tan
from typing import NamedTuple

from g12.cut_report import FrameCut
from g12.cycles.plan import CLEARANCE_MM, CyclePlan, hole_of
from g12.errors import number
from g12.request import CLEARED, Cutter, Words, opposite, steps_between
from g12.settings import Settings

FRAME_WORDS = "X Y Z I J R K Q E P H D F"
POCKET, WALL_OUTSIDE = 0, 2  # H; 1 is the wall inside
WIDEST = 0.7  # stepover in tool diameters: more leaves material in the corners between the rings


class Frame(NamedTuple):
    """The words of the finished rectangle: half lengths, corner, what H says, finish allowance."""

    half_x: float
    half_y: float
    corner: float
    kind: int
    finish: float

    @property
    def side(self) -> int:
        """1 where the tool is outside, -1 where it is inside."""
        return 1 if self.kind == WALL_OUTSIDE else -1


def plan(words: Words, arc: int, settings: Settings) -> CyclePlan:
    words.check_block(FRAME_WORDS)
    context = words.context
    hole = hole_of(words, context.z)
    frame = frame_of(words)
    level = words.take_positive("K") or hole.depth
    stepover = words.take_positive("Q")
    plunge_feed = words.take_positive("P") or context.feed * settings.plunge_feed / 100
    cutter = words.sized_cutter()
    if stepover:
        check_stepover(words, frame, stepover, cutter)
    check_room(words, frame, cutter)
    rings = rings_of(words, frame, stepover or cutter.radius, cutter)
    levels = max(1, steps_between(0.0, hole.depth, level, context.rounding))
    words.check_count(round(levels * (rings["rings"] + 1)), "Q and K make")
    lead = min(CLEARED * cutter.radius, rings["a"], rings["b"])
    fall = hole.depth / levels
    numbers = {
        **hole._asdict(),
        **rings,
        "retract": context.length(CLEARANCE_MM),
        "levels": levels,
        "fall": fall,
        "finish": frame.finish,
        "least": context.smallest_ring,
        "lead": lead,
        "side": frame.side,
        "arc": arc,
        "lead_arc": opposite(arc) if frame.side > 0 else arc,
        "turns": turns_down(words, fall, lead, settings),
        "plunge_feed": plunge_feed,
        "feed": context.feed,
    }
    beyond = frame.side * cutter.radius
    corner = max(0.0, frame.corner + beyond)
    corners = frame.half_x + beyond - corner, frame.half_y + beyond - corner
    around = 2 * lead + frame.finish if frame.side > 0 else 0.0  # the lead onto the last ring
    words.check_travel((hole.x, hole.y, hole.z), corner + around, (hole.top, hole.z), corners)
    cut = FrameCut(
        (hole.x, hole.y),
        (2 * frame.half_x, 2 * frame.half_y),
        frame.corner,
        frame.side,
        frame.kind != POCKET,
        tuple(hole.top - (n + 1) * fall for n in range(levels)),
        cutter.used,
    )
    return CyclePlan(numbers, cut, cutter)


def frame_of(words: Words) -> Frame:
    half_x = words.require_positive("I", "the length along X") / 2
    half_y = words.require_positive("J", "the length along Y") / 2
    corner = words.require("R", "the corner radius")
    words.check_least("R", corner, 0)
    for letter, half in (("I", half_x), ("J", half_y)):
        if corner > half + words.context.rounding:
            rule = f"must be at most half of {letter}{number(2 * half)}"
            raise words.refuse_word("R", corner, rule)
    kind = words.take_whole("H", least=POCKET, most=WALL_OUTSIDE, default=POCKET)
    finish = words.take("E") or 0.0
    if finish:
        words.check_least("E", finish, 2 * words.context.smallest_ring)  # for a half circle
    return Frame(half_x, half_y, min(corner, half_x, half_y), kind, finish)


def check_stepover(words: Words, frame: Frame, stepover: float, cutter: Cutter) -> None:
    if frame.kind != POCKET:
        raise words.refuse_word("Q", stepover, "is the stepover of a pocket (H0)")
    words.check_least("Q", stepover, 2 * words.context.smallest_ring)
    if stepover > WIDEST * 2 * cutter.radius:
        size = words.context.tool_size(2 * cutter.radius)
        rule = f"must not exceed {WIDEST} x the tool diameter {size} ({cutter.source})"
        raise words.refuse_word("Q", stepover, rule)


def check_room(words: Words, frame: Frame, cutter: Cutter) -> None:
    """Refuse a frame into which the cutter does not fit, and a finish in the full."""
    context, smallest = words.context, words.context.smallest_ring
    radius = f"the tool radius {context.tool_size(cutter.radius)} ({cutter.source})"
    if cutter.radius < frame.finish - context.rounding:
        rule = f"must not exceed {radius}: it is cut at full depth"
        raise words.refuse_word("E", frame.finish, rule)
    if frame.side > 0:
        return
    if frame.corner < cutter.radius - context.rounding:
        raise words.refuse_word("R", frame.corner, f"must not be below {radius}")
    for letter, half in (("I", frame.half_x), ("J", frame.half_y)):
        if half - cutter.radius - frame.finish < smallest:
            size = context.tool_size(2 * cutter.radius)
            rule = f"must be greater than the tool diameter {size} ({cutter.source})"
            if frame.finish:
                rule += f" + 2 x E{number(frame.finish)}"
            raise words.refuse_word(letter, 2 * half, rule)


def rings_of(words: Words, frame: Frame, stepover: float, cutter: Cutter) -> dict[str, float]:
    """Return the locals of a level's rings: the first one, their growth to the last rough one.

    The first ring of a pocket leaves no core.
    """
    beyond = frame.side * (cutter.radius + frame.finish)
    a, b, corner = frame.half_x + beyond, frame.half_y + beyond, frame.corner + beyond
    inward, steps = 0.0, 0
    if frame.kind == POCKET:
        inward = min(a, b) - CLEARED * cutter.radius
        if inward < 2 * words.context.smallest_ring:  # no arc leads to the next ring
            inward = 0.0
        steps = steps_between(0.0, inward, stepover, words.context.rounding)
    return {
        "a": a - inward,
        "b": b - inward,
        "corner": corner - inward,
        "step": inward / max(steps, 1),
        "rings": steps + 1,
    }


def turns_down(words: Words, height: float, radius: float, settings: Settings) -> int:
    """Return the whole turns of the helix down to a level, none without one."""
    if settings.entry != "helix":
        return 0
    slope = tan(radians(settings.entry_angle))
    turns = max(1, ceil(height / (2 * pi * radius * slope) - 1e-9))
    words.check_count(turns, "a helix down to the level makes")
    return turns
