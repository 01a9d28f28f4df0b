# SPDX-License-Identifier: GPL-2.0-or-later
"""Real runs are interrupted in all ways; modes and the next motion are those before."""

import random

import pytest

from soak import SEED, tries
from support.interruptions import HOWS, Interrupted, machine_of
from support.kinematics import needs_kinematics
from support.operated_machine import Machine

KINEMATICS = pytest.param("lathe_mm_kinematics", marks=needs_kinematics)


@pytest.mark.parametrize("name", ["mill_mm", "mill_a_mm", "lathe_mm", KINEMATICS])
def test_interruptions(name):
    ini, overrides = machine_of(name)
    with Machine(ini, overrides=overrides) as machine:
        interrupted = Interrupted(machine, name)
        for number in tries(f"interruptions on {name}"):
            chance = random.Random(f"{SEED} {name} {number}")
            turn, how = divmod(number, len(HOWS))
            try:
                interrupted.once(chance, HOWS[how], turn + how)
            except AssertionError as error:
                raise AssertionError(f"interruption {number} of seed {SEED}") from error
