# SPDX-License-Identifier: GPL-2.0-or-later
"""The change between X, Z and C and the part's face (`configs/kinematics`), and back.

The machine has to stand for it, and the interpreter to wait. What it is asked by, and what it
answers with, is wired in polar_kinematics.hal.

The acceleration of X and Y on the face is that of the section. LinuxCNC takes it from HAL pins each
time before it goes on with the interpreter (`check_ini_hal_items` in emctaskmain.cc), and canon
asks for it at each move.
"""

from __future__ import annotations

from collections.abc import Iterator

import hal
import linuxcnc

from g12.errors import number
from g12.host.interp import Interp
from g12.host.program_lines import without_line
from g12.section.modes import decimal

ACCELERATIONS = ("ini.x.max_acceleration", "ini.y.max_acceleration")  # HAL pins
CENTRE_OUTPUT, FACE_OUTPUT, FACE_INPUT = 2, 3, 3  # of M68 and M66
OFF, BY_PROGRAM, BY_HAND, NO_MOVES = 0, 1, 2, 3  # what is asked for
SWITCHING = 10  # seconds that it may take at most, on a busy machine
INPUT_FOUND, TIMED_OUT = 5399, -1.0  # parameter
SAME_OFFSET = 1e-4  # program units
PLANES = {1: "G17", 2: "G19", 3: "G18"}  # interp.plane
CENTRES = {901: "G90.1", 911: "G91.1"}  # active_g_codes
ON_THE_FACE = "G17G91.1"
NOT_SWITCHED = "the machine did not change its kinematics: is polar_kinematics.hal loaded?"


def face_in_force() -> bool:
    """Return whether the machine is on the face now."""
    status = linuxcnc.stat()
    status.poll()
    return bool(status.din[FACE_INPUT])


def modes_found(interp: Interp) -> str:
    """Return the block that gives back what `ON_THE_FACE` changes."""
    active = without_line(interp.active_g_codes)
    centres = next(CENTRES[code] for code in active if code in CENTRES)
    return f"{PLANES[interp.plane]}{centres}"


def accelerate(interp: Interp, share: float) -> None:
    """Have X and Y accelerate with a share of the INI, from the next wait on."""
    if not interp.task:
        return
    of_ini = getattr(interp, "g12_accelerations", None)
    if not of_ini:
        of_ini = interp.g12_accelerations = [hal.get_value(pin) for pin in ACCELERATIONS]
    for pin, acceleration in zip(ACCELERATIONS, of_ini):
        hal.set_p(pin, repr(share * acceleration))


def to_face(interp: Interp, machine_unit: float, asked: int, share: float = 1.0) -> Iterator[str]:
    """Go to the face; yield the block to wait for.

    ``machine_unit`` is one in program units, ``share`` is of the INI's accelerations.
    """
    accelerate(interp, share)
    centre = interp.origin_offset_x + interp.axis_offset_x + interp.tool_offset.x
    interp.execute(f"M68E{CENTRE_OUTPUT}Q{decimal(centre / machine_unit)}")
    interp.execute(f"M68E{FACE_OUTPUT}Q{OFF}")  # the last request may have ended by itself
    interp.execute(f"M68E{FACE_OUTPUT}Q{asked}")
    yield f"M66P{FACE_INPUT}L3Q{SWITCHING}"


def to_axes(interp: Interp) -> Iterator[str]:
    """Go back to X, Z and C; yield the block to wait for."""
    interp.execute(f"M68E{FACE_OUTPUT}Q{OFF}")
    yield f"M66P{FACE_INPUT}L4Q{SWITCHING}"
    accelerate(interp, 1.0)  # not before the machine has been there: LinuxCNC reads ahead


def has_switched(interp: Interp) -> bool:
    """Return, after the wait, whether the machine has done it."""
    return not interp.task or interp.params[INPUT_FOUND] != TIMED_OUT


def y_offset(interp: Interp) -> float:
    """Return what a program's Y lacks of the machine's, which is the face's: its centre is 0."""
    return interp.origin_offset_y + interp.axis_offset_y + interp.tool_offset.y


def other_offset(interp: Interp, beside: float) -> str:
    """Return what is wrong where the kinematics have the tool elsewhere beside the X line, else "".

    The machine stands on the face at its beginning; ``beside`` is what the settings say, both in
    program units.
    """
    found = interp.current_y + y_offset(interp)
    if abs(found - beside) <= SAME_OFFSET:
        return ""
    return (
        f"the kinematics have the tool {number(found)} beside X's line (polar-xzc.tool-offset), "
        f"POLAR_TOOL_OFFSET {number(beside)}: setp polar-xzc.tool-offset [G12]POLAR_TOOL_OFFSET"
    )
