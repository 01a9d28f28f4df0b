# SPDX-License-Identifier: GPL-2.0-or-later
"""The report of a LinuxCNC that did not start."""

from pathlib import Path

import pytest

from g12.tools.headless.machine import lines_to_last_error, startup_error
from g12.tools.machine.ini import Ini

END = """\
Shutting down and cleaning up LinuxCNC...
Note: Using POSIX non-realtime
LinuxCNC terminated with an error.  You can find more information in the log:
    /tmp/home/linuxcnc_debug.txt
as well as in the output of the shell command 'dmesg' and in the terminal
"""


@pytest.mark.parametrize(
    ("log", "last"),
    [
        (f"Starting LinuxCNC...\nparts/a.hal:2: no such pin\n{END}", "parts/a.hal:2: no such pin"),
        (END, "as well as in the output of the shell command 'dmesg' and in the terminal"),
    ],
)
def test_the_last_line_is_the_reason(log, last):
    assert lines_to_last_error(log)[-1] == last


def test_the_line_of_an_ini_that_linuxcnc_does_not_read():
    log = "/m/mill.ini:2: error: Invalid section. Missing ']'\nE: The INI-file contains errors\n"
    ini = Ini(Path("/m/mill.ini"), ("[EMC]", "[G12", "A = 1"))
    said = startup_error("LinuxCNC ended", log, ini)
    assert said == "LinuxCNC does not read it: Invalid section. Missing ']': [G12"
