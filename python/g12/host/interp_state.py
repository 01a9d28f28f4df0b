# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter's state before a block, read once for cycles, sections and shapes."""

from __future__ import annotations

import emccanon
from interpreter import MODE_INCREMENTAL

from g12.host.interp import (
    G7,
    INCH_UNITS,
    INVERSE_TIME,
    PER_REVOLUTION,
    PLANE_CODES,
    Interp,
    ToolTableEntry,
    diameter_active,
    millimetres_per_unit,
)
from g12.section.block_rules import NO_CODE, GGroup
from g12.state import LINEAR_AXES, ROTARY_AXES, State, Tool

G96 = 960
OFFSETS = {letter: f"{{}}_offset_{letter.lower()}" for letter in LINEAR_AXES}
OFFSETS |= {letter: f"{2 * letter}_{{}}_offset" for letter in ROTARY_AXES}


def read_state(interp: Interp) -> State:
    spindle, entry = feed_spindle(interp), interp.tool_table[0]
    active = tuple(interp.active_g_codes)[1:]  # without a line number, which may look like a code
    return State(
        inch=interp.length_units == INCH_UNITS,
        machine_mm=1 / emccanon.GET_EXTERNAL_LENGTH_UNITS(),
        x=interp.current_x,
        y=interp.current_y,
        z=interp.current_z,
        a=interp.AA_current,
        b=interp.BB_current,
        c=interp.CC_current,
        offsets={letter: _offset(interp, letter) for letter in OFFSETS},
        shifts={letter: getattr(interp, OFFSETS[letter].format("axis")) for letter in LINEAR_AXES},
        rotation=interp.rotation_xy,
        plane=PLANE_CODES.get(interp.plane, "G17.1, G18.1 or G19.1"),
        incremental=interp.distance_mode == MODE_INCREMENTAL,
        inverse_time=interp.feed_mode == INVERSE_TIME,
        per_revolution=interp.feed_mode == PER_REVOLUTION,
        feed=interp.feed_rate,
        speed=interp.speed[spindle],
        compensated=interp.cutter_comp_side != 0,
        offset_pending=bool(interp.arc_not_allowed),
        spindle_tool=tool_of_entry(interp, entry) if entry.toolno > 0 else None,
        motion=interp.motion_mode,
        spindle=spindle,
        speeds=tuple(interp.speed[number] for number in range(interp.num_spindles)),
        diameter=_diameter_mode(interp),
        surface_speed=G96 in active,
    )


def _offset(interp: Interp, letter: str) -> float:
    of_program = (getattr(interp, OFFSETS[letter].format(kind)) for kind in ("origin", "axis"))
    return sum(of_program) + getattr(interp.tool_offset, letter.lower())


def tool_of_entry(interp: Interp, entry: ToolTableEntry) -> Tool:
    """Return the tool of an entry of the table, whose diameter is in machine units."""
    machine_unit = 1 / emccanon.GET_EXTERNAL_LENGTH_UNITS() / millimetres_per_unit(interp)
    return Tool(entry.toolno, entry.diameter / 2 * machine_unit)


def feed_spindle(interp: Interp) -> int:
    """Return the number of the spindle in use, to which feeds per revolution refer.

    LinuxCNC leaves it unset until a block names one with $.
    """
    spindle = interp.active_spindle
    return spindle if 0 <= spindle < interp.num_spindles else 0


def _diameter_mode(interp: Interp) -> bool:
    """Return whether G7 is active (the active codes are those before this block)."""
    commanded = interp.blocks[interp.remap_level].g_modes[GGroup.DIAMETER]
    return diameter_active(interp) if commanded == NO_CODE else bool(commanded == G7)
