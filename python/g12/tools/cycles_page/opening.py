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
    status, command = linuxcnc.stat(), linuxcnc.command()
    status.poll()
    if status.interp_state != linuxcnc.INTERP_IDLE:
        raise UsageError("a program runs: stop it, then open this one")
    if "axis" in Path(screen()).name:
        subprocess.run([AXIS_REMOTE, path], check=False, timeout=10)
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
