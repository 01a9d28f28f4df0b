# SPDX-License-Identifier: GPL-2.0-or-later
"""The command line: ``python3 python/g12 COMMAND``."""

import os
import signal
import sys
from importlib.util import find_spec
from pathlib import Path

SYSTEM_PYTHON = "/usr/bin/python3"  # LinuxCNC's modules and Debian's python3-* belong to it
NEEDED_MODULES = ("linuxcnc", "numpy")

if __package__ in (None, ""):
    sys.path[0] = str(Path(__file__).resolve().parents[1])
    other = os.path.realpath(sys.executable) != os.path.realpath(SYSTEM_PYTHON)
    if other and not all(map(find_spec, NEEDED_MODULES)):
        os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

from g12.tools.commands.main import main  # noqa: E402 - the path has to be set first


def end(number: int, _frame: object) -> None:
    """Exit so that every context manager and atexit handler cleans up."""
    sys.exit(128 + number)


if __name__ == "__main__":
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) != signal.SIG_IGN:  # nohup ignores SIGHUP
            signal.signal(number, end)
    sys.exit(main(sys.argv[1:]))
