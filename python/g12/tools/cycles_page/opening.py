# SPDX-License-Identifier: GPL-2.0-or-later
"""Hand a program to the running LinuxCNC, as a screen's own Open does."""

import contextlib
import os
import subprocess
from importlib import import_module
from pathlib import Path

from g12.tools.errors import UsageError

AXIS_REMOTE = "axis-remote"  # AXIS draws what it is told to open


def open_in_linuxcnc(path: str) -> None:
    """Open a program on the screen that runs; refuse while a program runs."""
    linuxcnc = import_module("linuxcnc")
    try:
        status, command = linuxcnc.stat(), linuxcnc.command()
        status.poll()
    except (linuxcnc.error, RuntimeError, SystemError) as problem:
        raise UsageError("LinuxCNC does not answer: the program is saved, not open") from problem
    if status.interp_state != linuxcnc.INTERP_IDLE:
        raise UsageError("a program runs: stop it, then open this one")
    if "axis" in Path(screen()).name:
        try:
            subprocess.run([AXIS_REMOTE, path], check=False, timeout=10)
        except subprocess.TimeoutExpired as problem:
            raise UsageError("AXIS does not answer: the program is saved, not open") from problem
        return
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(path)


def screen() -> str:
    """Return the program of [DISPLAY] DISPLAY of the machine that runs."""
    linuxcnc = import_module("linuxcnc")
    with contextlib.suppress(KeyError):
        return linuxcnc.ini(os.environ["INI_FILE_NAME"]).find("DISPLAY", "DISPLAY") or ""
    return ""
