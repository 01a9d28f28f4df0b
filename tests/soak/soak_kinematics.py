# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections with kinematics are interrupted at random moments; none is left in the wrong world."""

import random
import time

import numpy as np
import pytest

from soak import SEED, tries
from support.kinematics import keeps_its_limits, needs_kinematics
from support.operated_machine import Machine
from support.sim_machines import SIM

pytestmark = needs_kinematics

START = ["M52 P0", "G21 G18 G8 G90 G94 G64 P0.002 Q0", "G0 X25 Z2 C0"]  # M52: on after an e-stop
PROGRAMS = {
    "contour": [*START, "G12.1", "G1 C20 F3000", "X-25", "C-20", "G3 X25 C-20 R25", "X25 C0 R15",
                "G1 X20", "Z-1", "X-20", "C25", "X25", "C0", "G13.1", "G0 Z5", "M2"],
    "slot along X": [*START, "G12.1", "G1 X-30 F4000", "X40", "X-40", "X25", "G13.1", "G0 Z5",
                     "M2"],
}  # fmt: skip
UP = ["G21 G90", "G0 Z6", "M2"]  # what a program begins with, of whatever the tool stands in


@pytest.mark.parametrize("name", PROGRAMS)
def test_aborts_with_kinematics(name, request):
    program, chance = PROGRAMS[name], random.Random(SEED)
    with Machine(SIM / "lathe_mm_kinematics.ini") as machine:
        whole = machine.run_text(program)
        assert whole.error is None
        for number in tries(request, "aborts with kinematics, and the program again"):
            seed = f"abort {number} of seed {SEED}"
            machine.open_text(program)
            machine.sample()
            machine.start()
            time.sleep(chance.uniform(0, whole.seconds))
            interrupt(machine, chance)
            machine.wait_for(lambda _: not machine.get("polar-xzc.face"), timeout=2)
            keeps_its_limits(machine.samples(), seed)
            assert machine.errors() == [], seed
            goes_up_only(machine, number, seed)
            machine.mdi("G0 X25 C10")
            assert machine.errors() == [], seed
            again = machine.run_text(program)
            assert again.error is None, seed
            keeps_its_limits(again.samples, seed)
            assert again.modes == whole.modes, seed


def interrupt(machine, chance):
    """Abort, press the emergency stop, or pause and abort."""
    how = chance.choice(["abort", "abort", "estop", "pause"])
    if how == "pause":
        machine.pause()
        time.sleep(0.1)
    if how == "estop":
        machine.estop()
        machine.enable()
    else:
        machine.abort()


def goes_up_only(machine, number, seed):
    """Run a program that goes up, or type it: neither the slide nor C may move."""
    machine.sample()
    if number % 2:
        machine.open_text(UP)
        machine.start()
        time.sleep(0.1)
        machine.wait_idle()
    else:
        machine.mdi("G0 Z6")
    assert machine.errors() == [], seed
    samples = machine.samples()
    assert max(np.ptp(samples.axes[axis]) for axis in "XC") <= 1e-9, seed
    assert samples.axes["Z"][-1] == pytest.approx(6, abs=1e-3), seed
