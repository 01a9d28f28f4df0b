# SPDX-License-Identifier: GPL-2.0-or-later
"""The figures the project promises, each measured against its peer in the same run.

A module of this package yields `Figure`s from its ``figures()``; ``make bench`` prints them.
"""

import os
import subprocess
from typing import NamedTuple


class Figure(NamedTuple):
    """One promised figure: what was measured, the number, its limit, and how it came about."""

    what: str
    value: float
    limit: float
    how: str = ""
    unit: str = ""


class Used(NamedTuple):
    """What a process and its children used: CPU seconds, and MB at most."""

    seconds: float
    memory: float


def used(*command, codes=(0,), **options):
    """Run a command, which ends with one of some exit codes; return what it used."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    process = subprocess.Popen(command, **quiet, **options)
    _, status, usage = os.wait4(process.pid, 0)
    assert os.waitstatus_to_exitcode(status) in codes, f"refused: {command}"
    return Used(usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)
