# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter's state at the start of a section, read once."""

from __future__ import annotations

from interpreter import MODE_INCREMENTAL

from g12.host import messages, modes
from g12.host.interp import (
    INVERSE_TIME,
    PER_REVOLUTION,
    PLANE_CODES,
    Interp,
    ParsedBlock,
    millimetres_per_unit,
    words_in,
)
from g12.host.program_lines import without_line
from g12.host.section.reader import block_of
from g12.host.spindle_c import missing_code
from g12.request.context import YZ
from g12.section.block_rules import alone
from g12.section.line import BlockLocation
from g12.section.modes import SectionModes
from g12.section.start import SectionStart

OTHER_WORDS = "ABDHKTUVWY"
G96 = 960


def start_of_section(interp: Interp, line: int, words: str = "") -> SectionStart:
    """Return the state at the start of a section, whose code is the remapped block on ``line``.

    ``words`` are the letters that the block may have.
    """
    block = interp.blocks[interp.remap_level]
    tool = modes.tool_in_spindle(interp)
    return SectionStart(
        location=BlockLocation(messages.code_of_block(interp), line),
        words=block_of(block).words,
        alone=is_alone(block, words),
        level=interp.call_level,
        x=interp.current_x,
        c=interp.CC_current,
        z=interp.current_z,
        machine_unit=modes.program_units_per_machine_unit(interp),
        millimetre=1 / millimetres_per_unit(interp),
        offsets=_offsets(interp),
        x_shift=interp.axis_offset_x,
        modes=SectionModes(
            incremental=interp.distance_mode == MODE_INCREMENTAL,
            per_revolution=interp.feed_mode == PER_REVOLUTION,
            feed=interp.feed_rate,
            speed=modes.spindle_speed(interp),
            motion=interp.motion_mode,
        ),
        spindle=modes.feed_spindle(interp),
        speeds=tuple(interp.speed[number] for number in range(interp.num_spindles)),
        tool_radius=tool.radius if tool else None,
        diameter=modes.diameter_mode(interp),
        yz_plane=PLANE_CODES.get(interp.plane) == YZ,
        compensated=interp.cutter_comp_side != 0,
        offset_pending=bool(interp.arc_not_allowed),
        inverse_time=interp.feed_mode == INVERSE_TIME,
        surface_speed=G96 in without_line(interp.active_g_codes),
        rotated=interp.rotation_xy != 0,
        missing_code=missing_code(interp),
    )


def is_alone(block: ParsedBlock, words: str = "") -> bool:
    return alone(block_of(block), words) and not words_in(block, OTHER_WORDS)


def _offsets(interp: Interp) -> dict[str, float]:
    """Return the sum of work offset, G92 and tool offset for X, Z and C."""
    tool = interp.tool_offset
    return {
        "X": interp.origin_offset_x + interp.axis_offset_x + tool.x,
        "Z": interp.origin_offset_z + interp.axis_offset_z + tool.z,
        "C": interp.CC_origin_offset + interp.CC_axis_offset + tool.c,
    }
