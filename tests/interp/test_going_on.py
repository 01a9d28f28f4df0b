# SPDX-License-Identifier: GPL-2.0-or-later
"""`rs274 -n 0` goes on after an error: a refused block is followed by the next line, once.

It names the INI after Python's start: a section finds the machine's axes there all the same.
"""

import os
import re
import subprocess

import pytest

from g12.tools.machine.ini import read_ini
from support.sim_machines import SIM

MILL = "G21 G90 G17 F600"
LATHE = "G21 G18 G8 F100"
LONGEST = 120.0  # s: the fault read on for ever
SUB = ["o<own> sub", "G1 X30 Y30", "o<own> endsub"]


def rapids(folder, machine, program):
    """Return the X of each rapid, and what was refused."""
    ini = SIM / f"{machine}.ini"
    (folder / "machine.ini").write_text(read_ini(ini).text)
    (folder / "tool.tbl").write_text("T1 P1 D10\n")
    (folder / "program.ngc").write_text("\n".join([*program, "M2", ""]))
    command = ["rs274", "-n", "0", "-g", "-i", folder / "machine.ini"]
    done = subprocess.run(
        [*command, "-t", folder / "tool.tbl", folder / "program.ngc"],
        cwd=ini.parent,
        env={**os.environ, "HOME": str(folder)},
        capture_output=True,
        text=True,
        timeout=LONGEST,
        check=True,
    )
    refused = re.findall(r"^((?:G1[23]\S*|circle_mill).*:.*)$", done.stderr, re.MULTILINE)
    return [float(x) for x in re.findall(r"STRAIGHT_TRAVERSE\(([-\d.]+)", done.stdout)], refused


@pytest.mark.parametrize(
    ("good", "bad"),
    [
        ("G12 I300 D0 Z-1", "G12 I0 D0"),
        ("G13.2 X9 Y0 Z-1 R200 I1 H2", "o<circle_mill> call [3]"),
    ],
)
def test_behind_a_cycle_that_has_run(tmp_path, good, bad):
    program = [MILL, "T1 M6 G43", "G0 X1", good, "G0 X2", bad, "G0 X3", bad, "G0 X4"]
    passed, refused = rapids(tmp_path, "mill_mm", program)
    assert [x for x in passed if x in (1, 2, 3, 4)][-3:] == [2, 3, 4]
    assert passed.count(3) == passed.count(4) == 1
    assert len(refused) == 2


def test_in_a_sub_it_is_the_line_behind_the_call(tmp_path):
    bad = ["o<bad> sub", "G0 X9", "G12 I0", "G0 X8", "o<bad> endsub"]
    program = [MILL, *bad, "G12 I20 D0 Z-1", "o<bad> call", "G0 X3", "G12 I0", "G0 X4"]
    assert rapids(tmp_path, "mill_mm", program)[0][-3:] == [9, 3, 4]


SECTIONS = [
    (["G12.1 X5"], "G12.1 line 10: must be alone in its block"),
    (["G12.1", "G1 X15", "G1 X10 X11"], "G12.1 line 12: Multiple x words on one line"),
    (["G12.1", "G1 X50000", "G1 X10", "G13.1"], "G12.1 line 11: the X axis would go to "),
    (["G12.1", "o<own> call", "G1 X#<none>"], "G12.1 line 12: Named parameter #<none>"),
]


@pytest.mark.parametrize(("section", "message"), SECTIONS)
@pytest.mark.parametrize("called", [False, True])
def test_a_section(tmp_path, section, message, called):
    """The line after the one that was read last: a refused section is not moved in its middle."""
    before = ["o<own> call"] if called else ["G1 X30"]
    program = [LATHE, "G0 X20 Z5 C0", *SUB, "G12.1", "G13.1", *before, "G0 X1", *section, "G0 X2"]
    passed, refused = rapids(tmp_path, "lathe_mm", [line.replace(" Y30", "") for line in program])
    assert passed == [20, 1, 2]
    assert [text[: len(message)] for text in refused] == [message]
