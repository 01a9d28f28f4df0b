# SPDX-License-Identifier: GPL-2.0-or-later
"""The installed LinuxCNC's version, and whether it loads a machine config."""

import re
import subprocess
from functools import cache
from pathlib import Path

from g12.tools.machine.ini import Ini
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.system import PYTHON

VERSION = "import linuxcnc; print(linuxcnc.version)"
UNREAD = "LinuxCNC does not read it"  # begins the text of `worker.ini_refused`
CONFIGURE_FAILED = "Python plugin configure() failed"
TRACEBACK_LINE = re.compile(r'File "([^"]+)", line (\d+)')


@cache
def linuxcnc_version() -> str:
    """Return the version of the LinuxCNC on this computer, empty if there is none."""
    done = subprocess.run([PYTHON, "-c", VERSION], capture_output=True, text=True, check=False)
    return done.stdout.strip()


def load_failure(ini: Ini) -> str | None:
    """Return the interpreter's own text if it does not load the INI as it is."""
    try:
        with Tracer(ini):
            return None
    except TraceFailure as refused:
        return str(refused).removeprefix(f"{ini.path}: ")


def python_error(printed: str) -> str | None:
    """Return the exception that loading printed, with file and line; None if Python loaded."""
    before, failed, _ = printed.partition(CONFIGURE_FAILED)
    if not failed:
        return None
    lines = [line.strip() for line in before.splitlines() if line.strip()]
    frames = [frame for line in lines for frame in TRACEBACK_LINE.findall(line)]
    location = f" ({Path(frames[-1][0]).name}:{frames[-1][1]})" if frames else ""
    return f"{lines[-1]}{location}" if lines else failed
