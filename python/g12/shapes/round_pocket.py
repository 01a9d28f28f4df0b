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

from cmath import rect
from math import radians

from g12.cut_report import RoundPocketCut
from g12.errors import number
from g12.request.common import loaded_tool
from g12.shapes.entries import (
    PASS_ENTRIES,
    Extent,
    ShapeEntries,
    ShapeMachine,
    ShapePlan,
    feeds_of,
    heights_of,
    levels_of,
    locals_of,
    passes_of,
    polar_position,
)
from g12.shapes.rings import ClearingRings, clearing_rings, half_turns_in_all, ramp_of

ROUND_POCKET_ENTRIES = ("x", "c", "diameter", "depth", *PASS_ENTRIES)


def plan_round_pocket(entries: ShapeEntries, machine: ShapeMachine) -> ShapePlan:
    cutter = loaded_tool(entries).radius
    away, angle = polar_position(entries, machine.diameters)
    diameter = entries.require_positive("diameter", "the pocket's")
    levels = levels_of(entries)
    rings = clearing_rings(entries, "diameter", diameter, cutter)
    if not rings.first_ring:
        least = number(2 * (cutter + entries.context.smallest_ring))
        rule = f"must leave the cutter room for a helix: at least {least} and twice the allowance"
        raise entries.refuse_word("diameter", diameter, rule)
    feeds = feeds_of(entries, machine)
    heights = heights_of(entries)
    ramp = ramp_of(entries, machine, rings, levels, heights, 0.0)
    check_centre(entries, machine, rings, away)
    # C makes a turn with each ring about the spindle's centre, and swings to and fro with others
    round_centre = rings.largest >= away
    turned = 180.0 * (half_turns_in_all(rings, levels, ramp) + 1)
    back, onward = (180.0, turned) if round_centre else (90.0, 90.0)
    end = away + rings.first_ring / 2
    extent = Extent(
        (min(end, *(abs(away - radius) for radius in rings.radii)), away + rings.largest),
        (levels.bottom, heights.start_z),
        (angle - back, angle + onward),
    )
    own = {"away": away, "start_angle": angle}
    middle = rect(away, radians(angle))
    return ShapePlan(
        own | locals_of(rings, ramp, levels, feeds, heights),
        extent,
        lambda: RoundPocketCut(
            (middle.real, middle.imag), diameter, passes_of(entries, levels, feeds)
        ),
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
