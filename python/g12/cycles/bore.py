# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.5/G13.5 bore: a hole along a helix, or along several from the inside out.

The motions are in `ngc/g12_bore.ngc`. Rules, in the order of the checks: the modes of
`check_modes`; every word known; Z required, R not above the tool, Z below it; I and P required,
above 0; K from 0, less than I; Q above 0; L whole, from 0; the cutter; I greater than its radius;
no material on the way back to the centre; in the full a slope up to [G12] ENTRY_ANGLE; not too many
circles.
"""

from math import atan, ceil, degrees, pi, radians, tan

from g12.cut_report import PocketCut
from g12.cycles.plan import Chosen, CyclePlan, check_block, chosen_cutter, hole_of, turns_of
from g12.errors import number
from g12.request.common import CLEARED, CycleExtent, check_count, steps_between
from g12.request.words import XY, Words

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
    if cutter.radius:
        check_way_back(words, wall, first - cutter.radius > opened, stepover, cutter)
    steps = steps_between(first, last, stepover, words.context.rounding) if stepover else 0
    if not opened or opened < 2 * cutter.radius:
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
    centre = hole.x, hole.y, hole.bottom

    def cut() -> PocketCut:
        first_wall = first + cutter.radius
        step = stepover or 0.0
        return PocketCut(XY, centre, wall, first_wall, step, -1.0, (hole.bottom,), cutter.used)

    extent = CycleExtent(XY, centre, last, (hole.start, hole.bottom))
    return cutter.plan(numbers | turns, extent, cut)


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


def check_way_back(
    words: Words, wall: float, has_core: bool, stepover: float | None, cutter: Chosen
) -> None:
    """Refuse a core or a ring between helices: the tool returns to the centre at full depth."""
    size = words.context.tool_size(2 * cutter.radius)
    if stepover and stepover > 2 * cutter.radius:
        rule = f"must not exceed the tool diameter {size} ({cutter.source})"
        raise words.refuse_word("Q", stepover, rule)
    if has_core:
        rule = (
            f"is greater than the tool diameter {size} ({cutter.source}): the tool would cross a"
            " core at full depth. Give Q, or K if a hole is open"
        )
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
