# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules and numbers of ``o<polar_pocket> call``: a round pocket anywhere on the face.

The motion is that of `g12.shapes.rings` about the pocket's centre, where the zero line is the one
through that centre.

Rules, in the order of the checks: a tool with a diameter in the spindle; diameter above 0; depth
and depth_per_pass above 0; allowance from 0; room for a helix; feeds above 0; the tool above the
face; not too long a descent, not too many moves; no ring through the spindle's centre where [G12]
POLAR_POLE refuses it.
"""

from __future__ import annotations

from math import atan2, degrees, hypot
from typing import NamedTuple

from g12.errors import number
from g12.request.common import SMALLEST_RING_MM, loaded_tool
from g12.request.context import Context
from g12.shapes.entries import (
    Extent,
    Feeds,
    Heights,
    Levels,
    ShapeEntries,
    ShapeMachine,
    feeds_of,
    heights_of,
    levels_of,
    locals_of,
)
from g12.shapes.rings import ClearingRings, RampDown, clearing_rings, half_turns_in_all, ramp_of

ROUND_POCKET_ENTRIES = (
    "x",
    "c",
    "diameter",
    "depth",
    "depth_per_pass",
    "allowance",
    "feed",
    "plunge_feed",
)


class RoundPocketPlan(NamedTuple):
    """A checked pocket; its centre is ``away`` from the spindle's, at ``start_angle``.

    Lengths and feeds are in program units, the angle in degrees.
    """

    away: float
    rings: ClearingRings
    ramp: RampDown
    levels: Levels
    feeds: Feeds
    heights: Heights
    start_angle: float

    def locals(self) -> dict[str, float]:
        numbers = locals_of(self.rings, self.ramp, self.levels, self.feeds, self.heights)
        return numbers | {"away": self.away, "start_angle": self.start_angle}

    def extent(self) -> Extent:
        """Return the extent of the tool's centre.

        C makes a turn with each ring about the spindle's centre, and swings to and fro with the
        others.
        """
        largest, end = self.rings.largest, self.away + self.rings.first_ring / 2
        round_centre = largest >= self.away
        turned = 180.0 * (half_turns_in_all(self.rings, self.levels, self.ramp) + 1)
        nearest = min(end, *(abs(self.away - radius) for radius in self.rings.radii))
        return Extent(
            (nearest, self.away + largest),
            (-self.levels.levels * self.levels.step_down, self.heights.start_z),
            (
                self.start_angle - (180.0 if round_centre else 90.0),
                self.start_angle + (turned if round_centre else 90.0),
            ),
        )


def plan_round_pocket(
    entries: ShapeEntries, context: Context, machine: ShapeMachine
) -> RoundPocketPlan:
    cutter = loaded_tool(entries, context).radius
    x = (entries.take("x") or 0.0) / (2 if machine.diameters else 1)
    c = entries.take("c") or 0.0
    diameter = entries.require_positive("diameter", "the pocket's")
    levels = levels_of(entries, context)
    rings = clearing_rings(entries, context, "diameter", diameter, cutter)
    if not rings.first_ring:
        least = number(2 * (cutter + context.length(SMALLEST_RING_MM)))
        rule = f"must leave the cutter room for a helix: at least {least} and twice the allowance"
        raise entries.refuse(f"{entries.written('diameter', diameter)} {rule}")
    feeds = feeds_of(entries, context, machine)
    heights = heights_of(entries, context)
    away = hypot(x, c)
    ramp = ramp_of(entries, machine, rings, levels, heights, 0.0)
    check_centre(entries, machine, rings, away)
    return RoundPocketPlan(away, rings, ramp, levels, feeds, heights, degrees(atan2(c, x)))


def check_centre(
    entries: ShapeEntries, machine: ShapeMachine, rings: ClearingRings, away: float
) -> None:
    through = any(abs(radius - away) <= machine.pole for radius in rings.radii)
    if machine.pole_refused and through:
        raise entries.refuse(
            f"a ring of the tool's centre would pass through the spindle's centre, {number(away)}"
            " away, which [G12] POLAR_POLE = refuse forbids: change the diameter or the cutter"
        )
