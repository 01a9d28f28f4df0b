# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules and numbers of ``o<polar_slot> call`` and ``o<polar_pocket> call``.

A slot with round ends is about the spindle's centre, a round pocket is anywhere on the face. Both
are cleared from the inside: down along the first ring, then outward.

A ring of the tool's centre is two half turns counterclockwise, each a line of ``length`` (0 in a
round pocket) and a half circle of the ring's radius. The first ring is so small that it leaves no
core. The descent follows it with a slope of [G12] ENTRY_ANGLE at most, and once more at the level.
The stepover to the next ring, and the return to the first, is a half circle of the mean radius,
tangent to both.

**A slot.** The rings run along a line through the spindle's centre. A cutter as wide as the slot
less its allowance has a first ring of 0: it ramps down to and fro along the line, through the
centre. Rules, in the order of the checks: a tool with a diameter in the spindle; width, length
above 0, the slot longer than wide; depth, depth_per_pass and feeds above 0; the tool above the
face; allowance from 0; room for the cutter; angle; not too long a descent, not too many moves; no
path through the centre where [G12] POLAR_POLE refuses it.

**A round pocket.** The rings run about the pocket's centre, where the zero line is the one through
that centre. Rules: a tool with a diameter in the spindle; diameter, depth, depth_per_pass and feeds
above 0; the tool above the face; allowance from 0; room for a helix; not too long a descent, not
too many moves; no ring through the spindle's centre where [G12] POLAR_POLE refuses it.

Lengths are in program units.
"""

from __future__ import annotations

from cmath import rect
from math import ceil, pi, radians, tan
from typing import NamedTuple

from g12.cut_report import RoundPocketCut, SlotCut
from g12.errors import number
from g12.request import CLEARED, loaded_tool
from g12.shapes.entries import (
    PASS_ENTRIES,
    Descent,
    Extent,
    ShapeEntries,
    ShapeMachine,
    ShapePlan,
    check_finish,
    check_moves,
    descent_of,
    locals_of,
    passes_of,
    polar_position,
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
    descent: Descent,
    length: float,
) -> RampDown:
    """Return the descent; ``length`` is that of a ring's straight side."""
    round_ = pi * rings.first_ring
    fall = (length + round_) * tan(radians(machine.entry_angle))
    step_down, first_height = descent.step_down, descent.near_z + descent.step_down
    if first_height >= MOST_RAMP_HALF_TURNS * fall:
        angle = number(machine.entry_angle)
        rule = f"a ramp of {angle} degrees needs more than {MOST_RAMP_HALF_TURNS}"
        raise entries.refuse(f"{rule} half turns of {number(length + round_)} for a pass")
    first, following = ceil(first_height / fall), ceil(step_down / fall)
    share = length / (length + round_)
    ramp = RampDown(first, first_height / first, following, step_down / following, share)
    moves = half_turns_in_all(rings, descent.levels, ramp) * (2 if length else 1)
    check_moves(entries, moves, "depth_per_pass makes")
    return ramp


def half_turns_in_all(rings: ClearingRings, levels: int, ramp: RampDown) -> int:
    """Return the number of half turns of a shape, with one back from any further rings."""
    down = ramp.first_turns + (levels - 1) * ramp.next_turns
    finish = rings.finish * (3 if rings.further else 4)
    return down + levels * rings.half_turns + finish


SLOT_ENTRIES = ("width", "length", "depth", *PASS_ENTRIES, "angle")


def plan_slot(entries: ShapeEntries, machine: ShapeMachine) -> ShapePlan:
    cutter = loaded_tool(entries).radius
    width = entries.require_positive("width", "from wall to wall")
    length = entries.require_positive("length", "over all")
    if not length > width:
        rule = f"must be greater than width {number(width)} (polar_pocket makes a round one)"
        raise entries.refuse_word("length", length, rule)
    descent = descent_of(entries, machine)
    rings = clearing_rings(entries, "width", width, cutter)
    angle = entries.angle("angle")
    end_distance = (length - width) / 2  # of each end's centre from the middle
    ramp = ramp_of(entries, machine, rings, descent, 2 * end_distance)
    if machine.pole_refused and min(rings.first_ring, end_distance) <= machine.pole:
        size = entries.context.tool_size(2 * cutter)
        raise entries.refuse(
            f"{entries.written('width', width)}: the cutter of {size} would pass"
            " through the spindle's centre, which [G12] POLAR_POLE = refuse forbids"
        )
    own = {"end_distance": end_distance, "start_angle": angle}
    # every half turn is half a turn of C, onward
    turned = 180.0 * (half_turns_in_all(rings, descent.levels, ramp) + 1)
    to_and_fro = not rings.first_ring
    extent = Extent(
        (min(rings.first_ring, end_distance), end_distance + rings.largest),
        descent.extent,
        (angle - 180.0 * to_and_fro, angle + turned),
    )
    return ShapePlan(
        own | locals_of(rings, ramp, descent),
        extent,
        lambda: SlotCut(width, length, angle, passes_of(entries, descent)),
    )


ROUND_POCKET_ENTRIES = ("x", "c", "diameter", "depth", *PASS_ENTRIES)


def plan_round_pocket(entries: ShapeEntries, machine: ShapeMachine) -> ShapePlan:
    cutter = loaded_tool(entries).radius
    away, angle = polar_position(entries, machine.diameters)
    diameter = entries.require_positive("diameter", "the pocket's")
    descent = descent_of(entries, machine)
    rings = clearing_rings(entries, "diameter", diameter, cutter)
    if not rings.first_ring:
        least = number(2 * (cutter + entries.context.smallest_ring))
        rule = f"must leave the cutter room for a helix: at least {least} and twice the allowance"
        raise entries.refuse_word("diameter", diameter, rule)
    ramp = ramp_of(entries, machine, rings, descent, 0.0)
    check_centre(entries, machine, rings, away)
    # C makes a turn with each ring about the spindle's centre, and swings to and fro with others
    round_centre = rings.largest >= away
    turned = 180.0 * (half_turns_in_all(rings, descent.levels, ramp) + 1)
    back, onward = (180.0, turned) if round_centre else (90.0, 90.0)
    end = away + rings.first_ring / 2
    extent = Extent(
        (min(end, *(abs(away - radius) for radius in rings.radii)), away + rings.largest),
        descent.extent,
        (angle - back, angle + onward),
    )
    own = {"away": away, "start_angle": angle}
    middle = rect(away, radians(angle))
    return ShapePlan(
        own | locals_of(rings, ramp, descent),
        extent,
        lambda: RoundPocketCut((middle.real, middle.imag), diameter, passes_of(entries, descent)),
    )


def check_centre(
    entries: ShapeEntries, machine: ShapeMachine, rings: ClearingRings, away: float
) -> None:
    through = any(abs(radius - away) <= machine.pole for radius in rings.radii)
    if machine.pole_refused and through:
        raise entries.refuse(
            f"a ring of the tool's centre would pass through the spindle's centre, {number(away)}"
            " away, which [G12] POLAR_POLE = refuse forbids: change the diameter or the cutter"
        )
