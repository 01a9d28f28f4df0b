# SPDX-License-Identifier: GPL-2.0-or-later
"""The switch of kinematics from X, Z and C to the part's face (`configs/kinematics`), and back.

The machine has to stop for it, and the interpreter to wait. polar_kinematics.hal connects the
request and the answer.

The acceleration of X and Y on the face is that of the section. LinuxCNC reads it from HAL pins each
time before it resumes the interpreter (`check_ini_hal_items` in emctaskmain.cc), and canon reads it
at each move. polar_xzc gets the highest feed override and enforces it by adaptive feed, M52 P1.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import hal

from g12.errors import Refusal, number
from g12.host.interp import Interp
from g12.host.machine import MACHINE
from g12.machine_ini import ACCELERATION_PINS
from g12.moves.steps import FaceSwitch
from g12.section.effects import decimal

OVERRIDE_PIN, UNIT_PIN = "polar-xzc.most-override", "polar-xzc.unit"
REQUEST_PIN, END_PIN = "polar-xzc.request", "polar-xzc.end-request"  # this is the newest
CENTRE_OUTPUT, FACE_OUTPUT, FACE_INPUT = 2, 3, 3  # of M68 and M66
OFF, FACE = 0, 1  # values of polar-xzc.request
INPUT_RESULT, TIMED_OUT = 5399, -1.0  # parameter
SAME_OFFSET_MM = 1e-4
ON_THE_FACE = "G17G91.1M52P1"
OLDER = "the module polar_xzc is older than this package: build it again, make kinematics"


def face_in_force(interp: Interp) -> bool:
    """Return whether the machine is on the face now; in a preview it never is."""
    return MACHINE.switches_kinematics and interp.task and MACHINE.digital_input(FACE_INPUT)


def accelerations(interp: Interp) -> tuple[float, ...]:
    """Return the accelerations of X and Y in HAL, none for a machine without the face."""
    on_machine = MACHINE.switches_kinematics and interp.task
    return tuple(hal.get_value(pin) for pin in ACCELERATION_PINS) if on_machine else ()


def set_accelerations(values: Sequence[float]) -> None:
    """Set the accelerations of X and Y, from the next wait on.

    A pin that has its value already may be one that cannot be set: see `refusal`.
    """
    for pin, acceleration in zip(ACCELERATION_PINS, values):
        if hal.get_value(pin) != acceleration:
            hal.set_p(pin, repr(acceleration))


def refusal(values: Sequence[float]) -> str:
    """Return why this machine cannot switch, "" if it can; ``values`` are its accelerations."""
    if is_older():
        return OLDER
    for pin, acceleration in zip(ACCELERATION_PINS, values):
        try:
            hal.set_p(pin, repr(acceleration))
        except RuntimeError:
            return f"{pin} is connected to a HAL signal: take it off that net, a section sets it"
    return ""


def leave(interp: Interp) -> None:
    """Switch back from the face where no wait is possible: after an abort or an error.

    The position that LinuxCNC takes then is the face's. `Interp::read_inputs` (rs274ngc_pre.cc)
    takes the machine's new position when it reads the next line, as after a tool change. The
    request ends in HAL, and the machine leaves the face when it is at rest: LinuxCNC drops what an
    abort queues when the mode changes before. A screen's preview has HAL too: it ends nothing.
    """
    if interp.task and not is_older():
        hal.set_p(END_PIN, "1")
    interp.toolchange_flag = True


def may_be_on_face(interp: Interp) -> bool:
    """Return whether the machine is on the face, or was requested to be and not to leave it."""
    return face_in_force(interp) or (
        MACHINE.switches_kinematics
        and bool(interp.task)
        and not is_older()
        and hal.get_value(REQUEST_PIN) != OFF
    )


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
    step: FaceSwitch,
    refuse: Callable[[str], Refusal],
    of_ini: Sequence[float],
) -> Iterator[str]:
    """Switch to the face; yield the block to wait for.

    ``machine_unit`` is one in program units, ``of_ini`` are the accelerations of X and Y. Refuses a
    machine that cannot switch before anything is changed.
    """
    if interp.task:
        wrong = refusal(of_ini)
        if wrong:
            raise refuse(wrong)
        set_accelerations([step.share * acceleration for acceleration in of_ini])
        hal.set_p(OVERRIDE_PIN, repr(step.override))
        hal.set_p(UNIT_PIN, repr(1.0 / machine_unit))
    centre = interp.origin_offset_x + interp.axis_offset_x + interp.tool_offset.x
    interp.execute(f"M68E{CENTRE_OUTPUT}Q{decimal(centre / machine_unit)}")
    _request(interp, OFF)  # the last request may have ended by itself
    _request(interp, FACE)
    yield f"M66P{FACE_INPUT}L3Q{decimal(MACHINE.settings.polar_switch_time)}"


def to_axes(interp: Interp, of_ini: Sequence[float]) -> Iterator[str]:
    """Switch back to X, Z and C, with the INI's accelerations; yield the block to wait for."""
    _request(interp, OFF)
    yield f"M66P{FACE_INPUT}L4Q{decimal(MACHINE.settings.polar_switch_time)}"
    set_accelerations(of_ini)  # only now, after the wait: LinuxCNC reads ahead


def _request(interp: Interp, request: int) -> None:
    interp.execute(f"M68E{FACE_OUTPUT}Q{request}")


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
