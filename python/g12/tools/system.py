# SPDX-License-Identifier: GPL-2.0-or-later
"""LinuxCNC's system, and the call of the commands on it."""

import shlex
import sys
from pathlib import Path

PYTHON = "/usr/bin/python3"  # LinuxCNC's Python modules belong to the system's Python
DEBIAN_PACKAGE = "/usr/share/linuxcnc-g12/"
PROGRAM = Path(__file__).parents[1]  # the folder python/g12


def call() -> str:
    """Return the call of the commands as typed, else as from the package's folder."""
    if __file__.startswith(DEBIAN_PACKAGE):
        return "g12"
    typed = Path(sys.argv[0]) if sys.argv[:1] else Path()
    is_own = typed.name == PROGRAM.name and typed.is_dir() and typed.samefile(PROGRAM)
    return f"python3 {shlex.quote(sys.argv[0])}" if is_own else "python3 python/g12"


COMMAND = call()
