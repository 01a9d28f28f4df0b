# SPDX-License-Identifier: GPL-2.0-or-later
"""The machine that a screen is at: its tools, its work offsets and where it stands."""

import os
import re
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import AXIS_LETTERS
from g12.tools.cycles_page.sketch import MachineState
from g12.tools.machine.ini import Ini

OFFSETS = 5201  # parameter of X of the work offset number 0; each is 20 further on
PER_OFFSET, ROTATION = 20, 9  # of a work offset: parameters, the rotation about Z after the axes
ACTIVE_OFFSET, G92_ON, G92 = 5220, 5210, 5211
WORD = re.compile(r"([TD])([-+]?(?:\d{1,9}(?:\.\d*)?|\.\d+))", re.IGNORECASE | re.ASCII)
PARAMETER = re.compile(r"\s*(\d{1,4})\s+([-+]?(?:\d+\.?\d*|\.\d+))\s*", re.ASCII)


class Tool(NamedTuple):
    """A line of the tool table."""

    diameter: float  # machine units
    remark: str


def tools_of(ini: Ini) -> dict[int, Tool]:
    """Return the tools of the machine's table, in its order."""
    table = ini.file("EMCIO", "TOOL_TABLE")
    if table is None or not table.is_file():
        return {}
    tools = {}
    for line in table.read_text(encoding="utf-8", errors="replace").splitlines():
        words, _, remark = line.partition(";")
        found = {letter.upper(): float(value) for letter, value in WORD.findall(words)}
        if found.get("T", 0) > 0:
            tools[int(found["T"])] = Tool(found.get("D", 0.0), remark.strip())
    return tools


def machine_state(ini: Ini) -> MachineState:
    """Return how the machine of this screen stands; without one, how its var file has it.

    LinuxCNC tells its screens by INI_FILE_NAME which machine is theirs.
    """
    screen = os.environ.get("INI_FILE_NAME")
    running = _status() if screen and Path(screen).resolve() == Path(ini.path).resolve() else None
    if running is not None:
        return _state_of(running)
    return MachineState(_saved(ini), 0, (0.0,) * len(AXIS_LETTERS))


def _status():
    """Return LinuxCNC's status, None where none is running."""
    try:
        linuxcnc = import_module("linuxcnc")
    except ImportError:
        return None
    try:
        status = linuxcnc.stat()
        status.poll()
    except (linuxcnc.error, RuntimeError, SystemError):
        return None
    return status


def _state_of(status) -> MachineState:
    """Return the state that a status of LinuxCNC shows."""
    first = OFFSETS + PER_OFFSET * status.g5x_index
    offset = {first + axis: value for axis, value in enumerate(status.g5x_offset)}
    g92 = {G92 + axis: value for axis, value in enumerate(status.g92_offset)}
    parameters = {
        ACTIVE_OFFSET: float(status.g5x_index),
        G92_ON: float(any(status.g92_offset)),
        first + ROTATION: status.rotation_xy,
        **offset,
        **g92,
    }
    return MachineState(parameters, status.tool_in_spindle, status.position)


def _saved(ini: Ini) -> dict[int, float]:
    path = ini.file("RS274NGC", "PARAMETER_FILE")
    if path is None or not Path(path).is_file():
        return {}
    lines = Path(path).read_text(encoding="utf-8", errors="replace").splitlines()
    rows = filter(None, map(PARAMETER.fullmatch, lines))
    return {int(row[1]): float(row[2]) for row in rows}
