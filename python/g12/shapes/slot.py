# SPDX-License-Identifier: GPL-2.0-or-later
"""The rules and numbers of ``o<polar_slot> call``: a slot with round ends about the centre.

The motion is that of `g12.shapes.rings`, along a line through the spindle's centre. A cutter as
wide as the slot less its allowance has a first ring of 0: it ramps down to and fro along the line,
through the centre.

Rules, in the order of the checks: a tool with a diameter in the spindle; width, length above 0, the
slot longer than wide; depth and depth_per_pass above 0; allowance from 0; room for the cutter;
feeds above 0; angle; the tool above the face; not too long a descent, not too many moves; no path
through the centre where [G12] POLAR_POLE refuses it.
"""

from __future__ import annotations

from g12.cut_report import SlotCut
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
)
from g12.shapes.rings import clearing_rings, half_turns_in_all, ramp_of

SLOT_ENTRIES = ("width", "length", "depth", *PASS_ENTRIES, "angle")


def plan_slot(entries: ShapeEntries, machine: ShapeMachine) -> ShapePlan:
    cutter = loaded_tool(entries).radius
    width = entries.require_positive("width", "from wall to wall")
    length = entries.require_positive("length", "over all")
    if not length > width:
        rule = f"must be greater than width {number(width)} (polar_pocket makes a round one)"
        raise entries.refuse_word("length", length, rule)
    levels = levels_of(entries)
    rings = clearing_rings(entries, "width", width, cutter)
    feeds = feeds_of(entries, machine)
    angle = entries.angle("angle")
    heights = heights_of(entries)
    end_distance = (length - width) / 2  # of each end's centre from the middle
    ramp = ramp_of(entries, machine, rings, levels, heights, 2 * end_distance)
    if machine.pole_refused and min(rings.first_ring, end_distance) <= machine.pole:
        size = entries.context.tool_size(2 * cutter)
        raise entries.refuse(
            f"{entries.written('width', width)}: the cutter of {size} would pass"
            " through the spindle's centre, which [G12] POLAR_POLE = refuse forbids"
        )
    own = {"end_distance": end_distance, "start_angle": angle}
    # every half turn is half a turn of C, onward
    turned = 180.0 * (half_turns_in_all(rings, levels, ramp) + 1)
    to_and_fro = not rings.first_ring
    extent = Extent(
        (min(rings.first_ring, end_distance), end_distance + rings.largest),
        (levels.bottom, heights.start_z),
        (angle - 180.0 * to_and_fro, angle + turned),
    )
    return ShapePlan(
        own | locals_of(rings, ramp, levels, feeds, heights),
        extent,
        lambda: SlotCut(width, length, angle, passes_of(entries, levels, feeds)),
    )
