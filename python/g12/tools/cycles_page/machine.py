# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine that a screen is at: its tools, where it stands, and its Open."""

import contextlib
import os
import re
import subprocess
from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import AXIS_LETTERS
from g12.tools.errors import UsageError
from g12.tools.machine.ini import Ini, read_ini
from g12.tools.machine.stored_positions import stored_values

OFFSETS, PER_OFFSET = 5201, 20  # parameters: X of the work offset number 0, and how many each has
ROTATION, ACTIVE_OFFSET, G92_ON, G92 = 9, 5220, 5210, 5211  # the first counts within an offset
WORD = re.compile(r"([TD])([-+]?(?:\d{1,9}(?:\.\d*)?|\.\d+))", re.IGNORECASE | re.ASCII)


class Tool(NamedTuple):
    """A line of the tool table."""

    diameter: float  # machine units
    remark: str


class MachineState(NamedTuple):
    """The machine as it stands, in machine units and degrees."""

    parameters: Mapping[int, float]  # work offsets, as the var file numbers them
    tool: int  # in the spindle, 0 for none
    position: Sequence[float]  # of the axes, in the order of AXIS_LETTERS


def tools_of(ini: Ini) -> dict[int, Tool]:
    """Return the tools of the machine's table, in its order."""
    tools, text = {}, ""
    with contextlib.suppress(OSError):  # the interpreter says what is wrong with it
        table = ini.file("EMCIO", "TOOL_TABLE")
        text = table.read_text(encoding="utf-8", errors="replace") if table else ""
    for line in text.splitlines():
        words, _, remark = line.partition(";")
        found = {letter.upper(): float(value) for letter, value in WORD.findall(words)}
        if found.get("T", 0) > 0:
            tools[int(found["T"])] = Tool(found.get("D", 0.0), remark.strip())
    return tools


def machine_state(ini: Ini) -> MachineState:
    """Return how the machine of this screen stands; without one, how its var file has it."""
    screen = os.environ.get("INI_FILE_NAME")  # LinuxCNC tells its screens which machine is theirs
    status = linuxcnc_status() if screen and Path(screen).resolve() == ini.path.resolve() else None
    if status is None:
        saved = stored_values(ini.file("RS274NGC", "PARAMETER_FILE"))
        return MachineState(saved, 0, (0.0,) * len(AXIS_LETTERS))
    first = OFFSETS + PER_OFFSET * status.g5x_index
    parameters = {
        ACTIVE_OFFSET: float(status.g5x_index),
        G92_ON: float(any(status.g92_offset)),
        first + ROTATION: status.rotation_xy,
        **dict(enumerate(status.g5x_offset, first)),
        **dict(enumerate(status.g92_offset, G92)),
    }
    return MachineState(parameters, status.tool_in_spindle, status.position)


def linuxcnc_status():
    """Return LinuxCNC's status, None where none is running."""
    try:
        linuxcnc = import_module("linuxcnc")
        status = linuxcnc.stat()
        status.poll()
    except (ImportError, RuntimeError, SystemError):  # linuxcnc.error is a RuntimeError
        return None
    return status


def open_in_linuxcnc(path: str) -> None:
    """Open a program on the screen that runs; refuse while a program runs."""
    status = linuxcnc_status()
    if status is None:
        raise UsageError("LinuxCNC does not answer: the program is saved, not open")
    linuxcnc = import_module("linuxcnc")
    if status.interp_state != linuxcnc.INTERP_IDLE:
        raise UsageError("a program runs: stop it, then open this one")
    screen = read_ini(os.environ["INI_FILE_NAME"]).get("DISPLAY", "DISPLAY", "").split()
    if screen and os.path.basename(screen[0]) == "axis":  # it draws what it is told to open
        subprocess.Popen(["axis-remote", path])
        return
    command = linuxcnc.command()
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(path)
