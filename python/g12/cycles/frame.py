# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.7/G13.7 frame: a rectangle with round corners, a pocket or a wall.

The motions are in `ngc/g12_frame.ngc`. Every ring is a rectangle of the tool centre about X Y, with
the half lengths a and b along X and Y. It begins in the middle of the side in -Y, or in -X of a
frame that is narrower in X, on a half circle from the ring before.

Rules, in the order of the checks: the modes of `check_modes`; every word known; Z required, below
the tool; I, J required, above 0; R required, from 0, at most half of I and J; H whole, 0 to 2; K,
Q, P above 0, Q in a pocket only; E from 0; the cutter; inside R from its radius, I and J greater
than its diameter; room for the finish, which is at most its radius; not too many rings; a helix of
not too many turns.
"""

from math import ceil, pi, radians, sqrt, tan
from typing import NamedTuple

from g12.cut_report import FrameCut
from g12.cycles.plan import (
    CLEARANCE_MM,
    Chosen,
    CyclePlan,
    Hole,
    PocketEntry,
    check_block,
    chosen_cutter,
    hole_of,
)
from g12.errors import number
from g12.request.common import (
    CLEARED,
    CLOCKWISE,
    COUNTERCLOCKWISE,
    CycleExtent,
    check_count,
    steps_between,
)
from g12.request.words import XY, Words

FRAME_WORDS = "X Y Z I J R K Q E P H D F"
POCKET, WALL_INSIDE, WALL_OUTSIDE = 0, 1, 2  # H


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


class Rings(NamedTuple):
    """The tool centre's rings of a level: half lengths and corner of the first, their growth."""

    a: float
    b: float
    corner: float
    step: float
    number: int


def plan_frame(words: Words, arc: int, entry: PocketEntry) -> CyclePlan:
    """Return the frame of one block; ``entry`` are the machine's settings of a plunge."""
    check_block(words, FRAME_WORDS)
    context = words.context
    hole = hole_of(words, context.z)
    frame = frame_of(words)
    level = words.take_positive("K") or hole.depth
    stepover = words.take_positive("Q")
    if stepover and frame.kind != POCKET:
        raise words.refuse_word("Q", stepover, "is the stepover of a pocket (H0)")
    if stepover and stepover < 2 * context.smallest_ring:
        rule = f"must be at least {number(2 * context.smallest_ring)}"
        raise words.refuse_word("Q", stepover, rule)
    plunge_feed = words.take_positive("P") or context.feed * entry.feed / 100
    cutter = chosen_cutter(words)
    check_room(words, frame, cutter)
    stepover = stepover or cutter.radius
    if not stepover and frame.kind == POCKET:
        raise words.refuse("Q is missing: the stepover, which D0 does not give")
    rings = rings_of(words, frame, cutter, stepover)
    levels = max(1, steps_between(0.0, hole.depth, level, context.rounding))
    check_count(words, levels * (rings.number + 1), "Q and K make")
    turned = rings.a < rings.b
    lead = min(CLEARED * cutter.radius or rings.b, rings.a, rings.b)
    other = CLOCKWISE + COUNTERCLOCKWISE - arc
    numbers = {
        "x": hole.x,
        "y": hole.y,
        "top": hole.top,
        "clear": context.length(CLEARANCE_MM),
        "levels": levels,
        "fall": hole.depth / levels,
        "a": rings.b if turned else rings.a,
        "b": rings.a if turned else rings.b,
        "corner": rings.corner,
        "turned": turned,
        "step": rings.step,
        "rings": rings.number,
        "finish": frame.finish,
        "least": context.smallest_ring,
        "lead": lead,
        "side": frame.side,
        "arc": arc,
        "lead_arc": other if frame.side > 0 else arc,
        "turns": turns_down(words, hole.depth / levels, lead, entry) if entry.helix else 0,
        "plunge_feed": plunge_feed,
        "feed": context.feed,
    }

    def cut() -> FrameCut:
        levels_of_z = tuple(hole.top - (n + 1) * hole.depth / levels for n in range(levels))
        middle = frame.kind != POCKET
        return FrameCut(
            (hole.x, hole.y),
            (2 * frame.half_x, 2 * frame.half_y),
            frame.corner,
            frame.side,
            middle,
            levels_of_z,
            cutter.used,
        )

    extent = extent_of(hole, frame, cutter, lead)
    return cutter.plan(numbers, extent, cut, uncut_corners(words, rings, cutter))


def frame_of(words: Words) -> Frame:
    half_x = words.require_positive("I", "the length along X") / 2
    half_y = words.require_positive("J", "the length along Y") / 2
    corner = words.require("R", "the corner radius")
    if corner < 0:
        raise words.refuse_word("R", corner, "must be at least 0")
    for letter, half in (("I", half_x), ("J", half_y)):
        if corner > half + words.context.rounding:
            rule = f"must be at most half of {letter}{number(2 * half)}"
            raise words.refuse_word("R", corner, rule)
    kind = words.take_whole("H", least=POCKET, most=WALL_OUTSIDE, default=POCKET)
    finish = words.take("E") or 0.0
    if finish and finish < 2 * words.context.smallest_ring:
        rule = f"must be at least {number(2 * words.context.smallest_ring)}"
        raise words.refuse_word("E", finish, rule)
    return Frame(half_x, half_y, min(corner, half_x, half_y), kind, finish)


def check_room(words: Words, frame: Frame, cutter: Chosen) -> None:
    """Refuse a frame into which the cutter does not fit, and a finish in the full."""
    context = words.context
    if 0 < cutter.radius < frame.finish - context.rounding:
        size = context.tool_size(cutter.radius)
        rule = f"must not exceed the tool radius {size} ({cutter.source}): it is cut at full depth"
        raise words.refuse_word("E", frame.finish, rule)
    if frame.side > 0:
        return
    size = context.tool_size(cutter.radius)
    if frame.corner < cutter.radius - context.rounding:
        rule = f"must not be below the tool radius {size} ({cutter.source})"
        raise words.refuse_word("R", frame.corner, rule)
    for letter, half in (("I", frame.half_x), ("J", frame.half_y)):
        if half - cutter.radius - frame.finish < context.smallest_ring:
            size = context.tool_size(2 * cutter.radius)
            rule = f"must be greater than the tool diameter {size} ({cutter.source})"
            if frame.finish:
                rule += f" + 2 x E{number(frame.finish)}"
            raise words.refuse_word(letter, 2 * half, rule)


def rings_of(words: Words, frame: Frame, cutter: Chosen, stepover: float) -> Rings:
    """Return the rings of a level, from the first to the last rough one.

    The first ring of a pocket leaves no core.
    """
    beyond = frame.side * (cutter.radius + frame.finish)
    a, b, corner = frame.half_x + beyond, frame.half_y + beyond, frame.corner + beyond
    if frame.kind != POCKET:
        return Rings(a, b, corner, 0.0, 1)
    narrow = min(a, b)
    first = CLEARED * cutter.radius or stepover
    inward = narrow - first
    if inward < 2 * words.context.smallest_ring:  # the half circle to the next ring is no arc
        inward = 0.0
    steps = steps_between(0.0, inward, stepover, words.context.rounding)
    step = inward / max(steps, 1)
    return Rings(a - inward, b - inward, corner - inward, step, steps + 1)


def turns_down(words: Words, height: float, radius: float, entry: PocketEntry) -> int:
    """Return the whole turns of the helix down to a level."""
    turns = max(1, ceil(height / (2 * pi * radius * tan(radians(entry.angle))) - 1e-9))
    check_count(words, turns, "a helix down to the level makes")
    return turns


def extent_of(hole: Hole, frame: Frame, cutter: Chosen, lead: float) -> CycleExtent:
    """Return the tool centre's last ring, and outside the lead onto it."""
    beyond = frame.side * cutter.radius
    corner = max(0.0, frame.corner + beyond)
    along_x, along_y = frame.half_x + beyond - corner, frame.half_y + beyond - corner
    if frame.side > 0:
        corner += 2 * lead + frame.finish
    centre = hole.x, hole.y, hole.bottom
    return CycleExtent(XY, centre, corner, (hole.top, hole.bottom), (along_x, along_y))


def uncut_corners(words: Words, rings: Rings, cutter: Chosen) -> str | None:
    """Return the operator message of a stepover that leaves material between rings, or None."""
    if not cutter.radius or rings.step * sqrt(2) <= 2 * cutter.radius + words.context.rounding:
        return None
    size = words.context.tool_size(2 * cutter.radius)
    return (
        f"{words.code}: Q{number(rings.step)} is greater than 0.7 x the tool diameter {size}:"
        " material is left in the corners between the rings"
    )
