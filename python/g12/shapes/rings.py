# SPDX-License-Identifier: GPL-2.0-or-later
"""Clearing of a slot or a round pocket: down along its first ring, then outward.

A ring of the tool's centre is two half turns counterclockwise, each a line of ``length`` (0 in a
round pocket) and a half circle of the ring's radius. The first ring is so small that it leaves no
core. The descent follows it with a slope of [G12] ENTRY_ANGLE at most, and once more at the level.
The stepover to the next ring, and the return to the first, is a half circle of the mean radius,
tangent to both.

Lengths are in program units.
"""

from __future__ import annotations

from math import ceil, pi, radians, tan
from typing import NamedTuple

from g12.errors import number
from g12.request.common import CLEARED
from g12.shapes.entries import (
    Heights,
    Levels,
    ShapeEntries,
    ShapeMachine,
    check_finish,
    check_moves,
    rounds_between,
)

MOST_RAMP_HALF_TURNS = 20_000  # of a pass; more are a very flat ENTRY_ANGLE


class ClearingRings(NamedTuple):
    """The rings of a level: ``further`` ones beyond the first, each larger by ``ring_step``.

    Radii are those of the tool's centre. A ``finish`` ring (1 or 0) of ``finish_ring`` comes last.
    A first ring of 0 is the line itself.
    """

    first_ring: float
    ring_step: float
    further: int
    finish: int
    finish_ring: float

    @property
    def largest(self) -> float:
        return self.finish_ring if self.finish else self.first_ring + self.further * self.ring_step

    @property
    def radii(self) -> list[float]:
        rough = (self.first_ring + index * self.ring_step for index in range(self.further + 1))
        return [*rough, self.largest]

    @property
    def half_turns(self) -> int:
        """Return the number of half turns of a level after its descent, the flat ones included."""
        return 2 + 3 * self.further + (1 if self.further else 0)


class RampDown(NamedTuple):
    """The descent to the first level and to each further one: half turns, the fall of each.

    ``line_share`` is the line's share of a half turn's fall.
    """

    first_turns: int
    first_fall: float
    next_turns: int
    next_fall: float
    line_share: float


def clearing_rings(entries: ShapeEntries, width: str, size: float, cutter: float) -> ClearingRings:
    """Return the rings for a slot or pocket whose entry ``width`` is ``size`` wide."""
    allowance, context = entries.from_zero("allowance"), entries.context
    final, rough = size / 2 - cutter, size / 2 - cutter - allowance
    diameter, smallest = context.tool_size(2 * cutter), context.smallest_ring
    if final < -context.rounding:
        raise entries.refuse_word(width, size, f"must not be less than the cutter's {diameter}")
    if rough < -context.rounding:
        rule = f"the cutter of {diameter} does not fit between the walls that it leaves"
        raise entries.refuse(f"{entries.written('allowance', allowance)}: {rule}")
    check_finish(entries, allowance, cutter)
    if 0 < allowance < smallest:
        raise entries.refuse_word("allowance", allowance, f"must be at least {number(smallest)}")
    first = min(rough, CLEARED * cutter) if rough > smallest - context.rounding else 0.0
    further = rounds_between(first, rough, cutter, smallest) if first else 0
    step = (rough - first) / further if further else 0.0
    return ClearingRings(first, step, further, int(allowance > 0), max(final, 0.0))


def ramp_of(
    entries: ShapeEntries,
    machine: ShapeMachine,
    rings: ClearingRings,
    levels: Levels,
    heights: Heights,
    length: float,
) -> RampDown:
    """Return the descent; ``length`` is that of a ring's straight side."""
    round_ = pi * rings.first_ring
    fall = (length + round_) * tan(radians(machine.entry_angle))
    first, following = (
        ceil(height / fall) if height < MOST_RAMP_HALF_TURNS * fall else MOST_RAMP_HALF_TURNS + 1
        for height in (heights.near_z + levels.step_down, levels.step_down)
    )
    if first > MOST_RAMP_HALF_TURNS:
        angle = number(machine.entry_angle)
        rule = f"a ramp of {angle} degrees needs more than {MOST_RAMP_HALF_TURNS}"
        raise entries.refuse(f"{rule} half turns of {number(length + round_)} for a pass")
    ramp = RampDown(
        first,
        (heights.near_z + levels.step_down) / first,
        following,
        levels.step_down / following,
        length / (length + round_),
    )
    moves = half_turns_in_all(rings, levels, ramp) * (2 if length else 1)
    check_moves(entries, moves, "depth_per_pass makes")
    return ramp


def half_turns_in_all(rings: ClearingRings, levels: Levels, ramp: RampDown) -> int:
    """Return the number of half turns of a shape, with one back from any further rings."""
    down = ramp.first_turns + (levels.levels - 1) * ramp.next_turns
    finish = rings.finish * (3 if rings.further else 4)
    return down + levels.levels * rings.half_turns + finish
