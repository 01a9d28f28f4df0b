# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs of other controls on running machines: the INI's [FILTER] is applied to them."""

import pytest

from support.operated_machine import smoke
from support.sim_machines import SIM

PROGRAM = "%\nO5 (SLOT)\nG20 G90 G54 G00 X.1 Y0\nG01 X.3 F90.\nM31\nG53 X.5\nM30\n%\n"


@pytest.fixture
def program(tmp_path):
    path = tmp_path / "slot.nc"
    path.write_text(PROGRAM)
    return path


def test_the_headless_screen_opens_a_haas_program(program):
    code, log = smoke(SIM / "mill_inch_headless.ini", program, timeout=300)
    assert code == 0, log
    assert "slot.nc: done" in log


def test_the_headless_screen_tells_what_the_filter_refuses(tmp_path):
    program = tmp_path / "probing.nc"
    program.write_text("O6\nG20 G90 G54 G0 X0 Y0\nG65 P9810 Z-.5 F30.\nM30\n")
    code, log = smoke(SIM / "mill_inch_headless.ini", program, timeout=300)
    assert code == 1, log
    assert f"error: {program}:3: O9810 is not in this file" in log
