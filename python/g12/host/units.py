# SPDX-License-Identifier: GPL-2.0-or-later
"""Units, modes, tool and spindle of the interpreter; execution of a code to its end."""

from __future__ import annotations

import emccanon

from g12.host.interp import DIAMETER_ACTIVE, G7, Interp, ToolTableEntry, millimetres_per_unit
from g12.request.words import Tool
from g12.section.block_rules import NO_CODE, GGroup


def program_units_per_machine_unit(interp: Interp) -> float:
    """Return the factor from INI file and tool table lengths to the program's."""
    return millimetres_per_machine_unit() / millimetres_per_unit(interp)


def millimetres_per_machine_unit() -> float:
    return 1 / emccanon.GET_EXTERNAL_LENGTH_UNITS()


def tool_of_entry(interp: Interp, entry: ToolTableEntry) -> Tool:
    return Tool(entry.toolno, entry.diameter / 2 * program_units_per_machine_unit(interp))


def tool_in_spindle(interp: Interp) -> Tool | None:
    entry = interp.tool_table[0]
    return tool_of_entry(interp, entry) if entry.toolno > 0 else None


def spindle_speed(interp: Interp) -> float:
    return interp.speed[feed_spindle(interp)]


def feed_spindle(interp: Interp) -> int:
    """Return the number of the spindle in use, to which feeds per revolution refer.

    LinuxCNC leaves it unset until a block names one with $.
    """
    spindle = interp.active_spindle
    return spindle if 0 <= spindle < interp.num_spindles else 0


def diameter_mode(interp: Interp) -> bool:
    """Return whether G7 is active (the active codes are those before this block)."""
    commanded = interp.blocks[interp.remap_level].g_modes[GGroup.DIAMETER]
    active = interp.active_g_codes[DIAMETER_ACTIVE]
    return (active if commanded == NO_CODE else commanded) == G7


def run_code(interp: Interp, block: str) -> None:
    """Execute a block whose code may be remapped to a sub, with the sub's lines.

    `Interp::_execute` (rs274ngc_pre.cc) does so itself for a block typed in MDI, but then goes on
    until all calls have returned, the handler's own too.
    """
    level = interp.call_level
    interp.read(block)
    interp.execute(None)
    while interp.call_level > level:
        interp.read(None)
        interp.execute(None)
