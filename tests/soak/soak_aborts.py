# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs are aborted at random moments; nothing stays, and the program runs again."""

import random
import time

import pytest

from soak import SEED, tries
from support.operated_machine import Machine
from support.sim_machines import SIM

PROGRAMS = {
    "mill_mm": ["G21 G90 G94 G64 P0.002 G17", "T3 M6", "G0 X0 Y0 Z5",
                "G13 I5 K12 Q3 Z-2 D3 F4000", "G0 Z5", "M2"],
    "lathe_mm": ["G21 G90 G94 G64 G18 G8", "T3 M6", "G0 X20 Z1 C0", "G12.1", "F2500", "G1 X12",
                 "C5", "G3 X-5 C12 I-12 J-5", "G1 X-12 C0", "X15 C0", "G13.1", "M2"],
}  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_aborts(name, request):
    program, chance = PROGRAMS[name], random.Random(SEED)
    with Machine(SIM / f"{name}.ini") as machine:
        whole = machine.run_text(program)
        assert whole.error is None
        for number in tries(request, "aborts in a real run, and the program again"):
            seed = f"abort {number} of seed {SEED}"
            machine.open_text(program)
            machine.start()
            time.sleep(chance.uniform(0, whole.seconds))
            machine.abort()
            machine.wait_idle()
            modes = machine.stat().modes
            assert {"G90", "G94", "G40", "G64", "G21"} <= set(modes.gcodes), seed
            assert machine.errors() == [], seed
            machine.mdi("G0 Z5" if "X0 Y0" in program[2] else "G0 X25")
            again = machine.run_text(program)
            assert again.error is None, seed
            assert again.position == pytest.approx(whole.position, abs=1e-6), seed
            assert again.modes == whole.modes, seed
