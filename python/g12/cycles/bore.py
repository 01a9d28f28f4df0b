# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.5/G13.5 bore: a hole along a helix, or along several from the inside out.

The motions are in `ngc/g12_bore.ngc`. Rules, in the order of the checks: the modes of
`check_modes`; every word known; Z required, R not above the tool, Z below it; I and P required,
above 0; K from 0, less than I; Q above 0; L whole, from 0; the cutter; I greater than its radius;
in the full a slope up to [G12] ENTRY_ANGLE; not too many circles.
"""

from math import atan, ceil, degrees, pi, radians, tan

from g12.cut_report import PocketCut
from g12.cycles.hole import Chosen, check_block, chosen_cutter, hole_of, turns_of
from g12.cycles.plan import CyclePlan
from g12.errors import number
from g12.request.common import CLEARED, check_count, steps_between
from g12.request.context import XY
from g12.request.travel import CycleExtent
from g12.request.words import Words

BORE_WORDS = "X Y Z I P R K L Q D F"


def plan_bore(words: Words, arc: int, steepest: float) -> CyclePlan:
    """Return the bore of one block; ``steepest`` is [G12] ENTRY_ANGLE, in degrees."""
    check_block(words, BORE_WORDS)
    hole = hole_of(words)
    wall = words.require_positive("I", "the finished radius")
    pitch = words.require_positive("P", "the descent per turn")
    opened = open_radius(words, wall)
    stepover = words.take_positive("Q")
    springs = words.take_whole("L", least=0)
    cutter = chosen_cutter(words)
    check_wall(words, wall, cutter)
    last = wall - cutter.radius
    first = first_radius(cutter.radius, last, opened, stepover)
    steps = steps_between(first, last, stepover, words.context.rounding) if stepover else 0
    if opened < 2 * cutter.radius:
        check_slope(words, pitch, first, steepest)
    turns = turns_of(hole.depth, pitch, arc)
    circles = ceil(min(hole.depth / pitch, 1e9)) * (steps + 1) + springs
    check_count(words, circles, f"P{number(pitch)} makes")
    numbers = {
        "x": hole.x,
        "y": hole.y,
        "start": hole.start,
        "clear": hole.clear,
        "top": hole.top,
        "z": hole.bottom,
        "radius": first,
        "step": (last - first) / max(steps, 1),
        "helices": steps + 1,
        "circles": springs + 1,
        "arc": arc,
    }
    core = first - cutter.radius
    centre = hole.x, hole.y, hole.bottom

    def cut() -> PocketCut:
        first_wall = first + cutter.radius
        left = core if core > opened else -1.0
        step = stepover or 0.0
        return PocketCut(XY, centre, wall, first_wall, step, left, (hole.bottom,), cutter.used)

    extent = CycleExtent(XY, centre, last, (hole.start, hole.bottom))
    message = remains(words, wall, stepover, cutter) if core > opened else None
    message = message or between_helices(words, stepover, cutter)
    return cutter.plan(numbers | turns, extent, cut, message)


def open_radius(words: Words, wall: float) -> float:
    """Return K, the radius that is already open, 0 without."""
    opened = words.take("K") or 0.0
    if opened < 0:
        raise words.refuse_word("K", opened, "must be at least 0")
    if opened >= wall - words.context.rounding:
        raise words.refuse_word("K", opened, f"must be less than I{number(wall)}")
    return opened


def check_wall(words: Words, wall: float, cutter: Chosen) -> None:
    context = words.context
    if wall - cutter.radius < context.smallest_ring - context.rounding:
        size, least = context.tool_size(cutter.radius), number(context.smallest_ring)
        rule = f"must exceed the tool radius {size} ({cutter.source}) by at least {least}"
        raise words.refuse_word("I", wall, rule)


def first_radius(cutter: float, last: float, opened: float, stepover: float | None) -> float:
    """Return the tool centre's radius on the first helix: it leaves no core if there is a Q."""
    if not stepover:
        return last
    return min(last, max(CLEARED * cutter, opened + stepover - cutter))


def check_slope(words: Words, pitch: float, radius: float, steepest: float) -> None:
    """Refuse a helix in the full that is steeper than the machine's angle."""
    round_ = 2 * pi * radius
    angle = degrees(atan(pitch / round_))
    if angle > steepest + 1e-9:
        fits = number(int(1e4 * round_ * tan(radians(steepest))) / 1e4)
        rule = (
            f"descends at {angle:.2f} degrees into the full, [G12] ENTRY_ANGLE is"
            f" {number(steepest)}: P{fits} fits, or K if a hole is open"
        )
        raise words.refuse_word("P", pitch, rule)


def remains(words: Words, wall: float, stepover: float | None, cutter: Chosen) -> str | None:
    """Return the operator message of a bore that leaves a core, or None."""
    if not cutter.radius or stepover:
        return None
    size = words.context.tool_size(2 * cutter.radius)
    return (
        f"{words.code}: I{number(wall)} is greater than the tool diameter {size}: a core is left"
        " in the centre. Give Q, or K if a hole is open"
    )


def between_helices(words: Words, stepover: float | None, cutter: Chosen) -> str | None:
    """Return the operator message of a stepover that leaves material, or None."""
    if not cutter.radius or not stepover or stepover <= 2 * cutter.radius:
        return None
    size = words.context.tool_size(2 * cutter.radius)
    return (
        f"{words.code}: Q{number(stepover)} is greater than the tool diameter {size}:"
        " material is left between the helices"
    )
