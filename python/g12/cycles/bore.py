# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.5/G13.5 bore: a hole along a helix, or along several from the inside out.

The motions are in `ngc/g12_bore.ngc`. They return to the centre at full depth, so that no core may
stay there.
"""

from math import atan, ceil, degrees, pi, radians, tan

from g12.cut_report import PocketCut
from g12.cycles.plan import CyclePlan, hole_of, turns_of
from g12.errors import number
from g12.request import CLEARED, Cutter, Words, steps_between
from g12.settings import Settings
from g12.state import XY

BORE_WORDS = "X Y Z I P R K L Q D F"


def plan(words: Words, arc: int, settings: Settings) -> CyclePlan:
    words.check_block(BORE_WORDS)
    hole = hole_of(words)
    wall = words.require_positive("I", "the finished radius")
    pitch = words.require_positive("P", "the descent per turn")
    opened = open_radius(words, wall)
    stepover = words.take_positive("Q")
    springs = words.take_whole("L", least=0)
    cutter = words.sized_cutter()
    words.check_fits("I", wall, cutter.radius, cutter.source)
    first = last = wall - cutter.radius
    steps = 0
    if stepover:  # the first helix leaves no core
        first = min(last, max(CLEARED * cutter.radius, opened + stepover - cutter.radius))
        steps = steps_between(first, last, stepover, words.context.rounding)
    if pitch > hole.depth + words.context.rounding:
        rule = f"is longer than the hole, {number(hole.depth)} from its top to Z: it is no feed"
        raise words.refuse_word("P", pitch, rule)
    check_way_back(words, wall, first - cutter.radius > opened, stepover, cutter)
    if opened < first:  # the end of the cutter is over material up to its centre
        check_slope(words, pitch, first, settings.entry_angle)
    circles = ceil(min(hole.depth / pitch, 1e9)) * (steps + 1) + springs
    words.check_count(circles, "P, Q and L make")
    numbers = {
        **hole._asdict(),
        **turns_of(hole.depth, pitch, arc),
        "radius": first,
        "step": (last - first) / max(steps, 1),
        "helices": steps + 1,
        "circles": springs + 1,
        "arc": arc,
    }
    centre, first_wall = (hole.x, hole.y, hole.z), first + cutter.radius
    words.check_travel(centre, last, (hole.start, hole.z))
    cut = PocketCut(XY, centre, wall, first_wall, stepover or 0.0, -1.0, (hole.z,), cutter.used)
    return CyclePlan(numbers, cut, cutter)


def open_radius(words: Words, wall: float) -> float:
    """Return K, the radius that is already open, 0 without."""
    opened = words.take("K") or 0.0
    words.check_least("K", opened, 0)
    if opened >= wall - words.context.rounding:
        raise words.refuse_word("K", opened, f"must be less than I{number(wall)}")
    return opened


def check_way_back(
    words: Words, wall: float, has_core: bool, stepover: float | None, cutter: Cutter
) -> None:
    """Refuse a core, or a ring between helices."""
    size = f"the tool diameter {words.context.tool_size(2 * cutter.radius)} ({cutter.source})"
    if stepover and stepover > 2 * cutter.radius:
        raise words.refuse_word("Q", stepover, f"must not exceed {size}")
    if has_core:
        cure = "the tool would cross a core at full depth. Give Q, or K if a hole is open"
        raise words.refuse_word("I", wall, f"is greater than {size}: {cure}")


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
