# SPDX-License-Identifier: GPL-2.0-or-later
"""What is told of a LinuxCNC that did not come up."""

import pytest

from g12.tools.headless.machine import lines_to_last_error

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
