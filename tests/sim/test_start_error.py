# SPDX-License-Identifier: GPL-2.0-or-later
"""A wrong setting in [G12]: LinuxCNC comes up, the operator sees why no code of ours will run."""

import time

from support.operated_machine import UnhomedMachine
from support.sim_machines import SIM

SECONDS = 60.0


def first_error(machine):
    """Return the first error that the operator gets."""
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        for error in machine.errors():
            return error.text
        time.sleep(0.1)
    return None


def test_a_wrong_setting_is_shown_when_linuxcnc_comes_up():
    overrides = {"G12": {"CLEARING": "squares"}}
    with UnhomedMachine(SIM / "mill_mm.ini", overrides=overrides) as machine:
        assert first_error(machine) == "g12: [G12] CLEARING = squares: must be rings or spiral"
