# SPDX-License-Identifier: GPL-2.0-or-later
"""The switch of kinematics from X, Z and C to the part's face (`configs/kinematics`), and back.

The machine has to stop for it, and the interpreter to wait. polar_kinematics.hal connects the
request and the answer.

The acceleration of X and Y on the face is that of the section. LinuxCNC reads it from HAL pins each
time before it resumes the interpreter (`check_ini_hal_items` in emctaskmain.cc), and canon reads it
at each move. polar_xzc gets the highest feed override and enforces it by adaptive feed, M52 P1.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum

import hal

from g12.errors import BlockRefusal, number
from g12.host.interp import PLANE_CODES, Interp, state_of
from g12.host.machine import MACHINE
from g12.host.program_lines import without_line
from g12.machine_ini import ACCELERATION_PINS
from g12.section.modes import decimal

OVERRIDE_PIN, UNIT_PIN = "polar-xzc.most-override", "polar-xzc.unit"
REQUEST_PIN, END_PIN = "polar-xzc.request", "polar-xzc.end-request"  # this is the newest
ADAPTIVE_FEED = 52  # active_m_codes
CENTRE_OUTPUT, FACE_OUTPUT, FACE_INPUT = 2, 3, 3  # of M68 and M66
INPUT_RESULT, TIMED_OUT = 5399, -1.0  # parameter
SAME_OFFSET_MM = 1e-4
IJK_MODES = {901: "G90.1", 911: "G91.1"}  # active_g_codes
ON_THE_FACE = "G17G91.1M52P1"
OLDER = "the module polar_xzc is older than this package: build it again, make kinematics"


class FaceRequest(IntEnum):
    """The values of ``polar-xzc.request``; BY_HAND that has ended blocks programs and MDI."""

    OFF = 0
    BY_PROGRAM = 1
    BY_HAND = 2


def face_in_force(interp: Interp) -> bool:
    """Return whether the machine is on the face now; in a preview it never is."""
    return MACHINE.switches_kinematics and interp.task and MACHINE.digital_input(FACE_INPUT)


def modes_before_face(interp: Interp) -> str:
    """Return the block that restores the modes that `ON_THE_FACE` changes."""
    active = without_line(interp.active_g_codes)
    centres = next(IJK_MODES[code] for code in active if code in IJK_MODES)
    adaptive = int(ADAPTIVE_FEED in without_line(interp.active_m_codes))
    return f"{PLANE_CODES[interp.plane]}{centres}M52P{adaptive}"


def accelerate(interp: Interp, share: float) -> None:
    """Set X's and Y's acceleration to a share of the INI's, from the next wait on.

    Refuses a pin that is connected to a signal before the first one is changed.
    """
    if not interp.task:
        return
    of_ini = state_of(interp).accelerations
    if not of_ini:
        of_ini = [hal.get_value(pin) for pin in ACCELERATION_PINS]
        for pin, acceleration in zip(ACCELERATION_PINS, of_ini):
            _try_to_set(pin, acceleration)
        state_of(interp).accelerations = of_ini
    for pin, acceleration in zip(ACCELERATION_PINS, of_ini):
        hal.set_p(pin, repr(share * acceleration))


def _try_to_set(pin: str, acceleration: float) -> None:
    try:
        hal.set_p(pin, repr(acceleration))
    except RuntimeError:
        rule = f"{pin} is connected to a HAL signal: G12.1 has to set it, take it off that net"
        raise BlockRefusal("G12.1", rule) from None


def restore_accelerations(interp: Interp) -> None:
    for pin, acceleration in zip(ACCELERATION_PINS, state_of(interp).accelerations):
        hal.set_p(pin, repr(acceleration))


def end_request(interp: Interp) -> None:
    """End the request for the face at once; the machine leaves it when it is at rest.

    A screen's preview is in a process with HAL, too: it ends nothing.
    """
    if interp.task and not is_older():
        hal.set_p(END_PIN, "1")


def is_requested() -> bool:
    """Return whether a request for the face is not withdrawn, though it may have ended."""
    return not is_older() and hal.get_value(REQUEST_PIN) != FaceRequest.OFF


def is_older() -> bool:
    """Tell whether the module polar_xzc that is loaded lacks a pin of this package."""
    try:
        hal.get_value(END_PIN)
    except RuntimeError:
        return True
    return False


def to_face(
    interp: Interp,
    machine_unit: float,
    request: FaceRequest,
    share: float = 1.0,
    override: float = 1.0,
) -> Iterator[str]:
    """Switch to the face; yield the block to wait for.

    ``machine_unit`` is one in program units, ``share`` that of the INI's accelerations,
    ``override`` the highest feed override.
    """
    if interp.task and is_older():
        raise BlockRefusal("G12.1", OLDER)
    accelerate(interp, share)
    if interp.task:
        hal.set_p(OVERRIDE_PIN, repr(override))
        hal.set_p(UNIT_PIN, repr(1.0 / machine_unit))
    centre = interp.origin_offset_x + interp.axis_offset_x + interp.tool_offset.x
    interp.execute(f"M68E{CENTRE_OUTPUT}Q{decimal(centre / machine_unit)}")
    _request(interp, FaceRequest.OFF)  # the last request may have ended by itself
    _request(interp, request)
    yield f"M66P{FACE_INPUT}L3Q{decimal(MACHINE.settings.polar_switch_time)}"


def to_axes(interp: Interp) -> Iterator[str]:
    """Switch back to X, Z and C; yield the block to wait for."""
    _request(interp, FaceRequest.OFF)
    yield f"M66P{FACE_INPUT}L4Q{decimal(MACHINE.settings.polar_switch_time)}"
    restore_accelerations(interp)  # only now, after the wait: LinuxCNC reads ahead


def _request(interp: Interp, request: FaceRequest) -> None:
    interp.execute(f"M68E{FACE_OUTPUT}Q{request:d}")


def has_switched(interp: Interp) -> bool:
    return not interp.task or interp.params[INPUT_RESULT] != TIMED_OUT


def not_switched() -> str:
    """Return the rule for a switch that the module did not confirm in time."""
    return (
        "the machine did not change its kinematics within "
        f"{number(MACHINE.settings.polar_switch_time)} s ([G12] POLAR_SWITCH_TIME): "
        "is polar_kinematics.hal loaded, and are all axes at rest?"
    )


def y_offset(interp: Interp) -> float:
    """Return the offset from a program's Y to the machine's, whose 0 is the face's centre."""
    return interp.origin_offset_y + interp.axis_offset_y + interp.tool_offset.y


def other_offset(interp: Interp, beside: float, millimetre: float) -> str:
    """Return the fault of the offset that polar_xzc has, "" without one.

    It may have another distance of the tool from the X line than ``beside``, that of the settings
    in program units; ``millimetre`` is 1 mm in them. The machine is on the face, at the start of
    its motion.
    """
    found = interp.current_y + y_offset(interp)
    if abs(found - beside) <= SAME_OFFSET_MM * millimetre:
        return ""
    return (
        f"the kinematics have the tool {number(found)} beside X's line (polar-xzc.tool-offset), "
        f"POLAR_TOOL_OFFSET {number(beside)}: setp polar-xzc.tool-offset [G12]POLAR_TOOL_OFFSET"
    )
