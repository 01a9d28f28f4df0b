# SPDX-License-Identifier: GPL-2.0-or-later
"""Bore, thread and frame in a headless LinuxCNC: an abort in any phase leaves the modes alone."""

from functools import partial
from math import hypot

import pytest

from support.interruptions import Interrupted, Modes
from support.operated_machine import Machine
from support.sim_machines import BRISK, SIM, machine_scope

# The tool is at X0 Y0 Z2 under G91; phases in their order, each by the place of the tool: r, y, z.
CYCLES = {
    "G13.5 R-2 Z-3 I16 K11 Q2.5 P1.5 D3": {
        "onto": lambda r, y, z: abs(z) < 0.01 and 1 < r < 10,
        "helix": lambda r, y, z: -2.5 < z < -0.5,
        "floor": lambda r, y, z: z < -2.999 and r > 10.4,
        "off": lambda r, y, z: z < -2.999 and 1 < r < 10,
        "up": lambda r, y, z: -2.9 < z < 0 and r < 0.1,
        "next helix": lambda r, y, z: r > 12.9 and z < -1,
    },
    "G13.6 R-2 Z-6 I13 P2 Q.7 D3": {
        "down": lambda r, y, z: -5.5 < z < 1,
        "onto": lambda r, y, z: -5.95 < z < -5.55 and 1 < r < 9,
        "helix": lambda r, y, z: -5 < z < -1,
        "off": lambda r, y, z: 0.05 < z < 0.45 and 1 < r < 9,
        "between passes": lambda r, y, z: -5.5 < z < -0.5 and r < 0.1,
        "last pass": lambda r, y, z: r > 9.5,
    },
    "G13.7 Z-4 I30 J24 R4 K2 Q4 E.5 P4000 D3": {
        "plunge": lambda r, y, z: 0.1 < z < 1.9,
        "ring": lambda r, y, z: z < 0.001 and y > 2,
        "between levels": lambda r, y, z: 0.1 < z < 0.9,
        "next level": lambda r, y, z: z < -1.999,
        "finish": lambda r, y, z: y > 8.9,
    },
}
BEFORE = Modes("G64 P0.05 Q0.03", True, False, False, "G90.1")


@pytest.fixture(scope=machine_scope)
def mill():
    with Machine(SIM / "mill_mm.ini", tools={3: 6.0}, overrides=BRISK) as machine:
        yield Interrupted(machine, "mill_mm")


def is_at(place, now):
    x, y, z = now.position[:3]
    return place(hypot(x, y), y, z)


@pytest.mark.parametrize(
    ("block", "phase"), [(block, phase) for block, phases in CYCLES.items() for phase in phases]
)
def test_an_abort_in_any_phase_leaves_the_modes_as_they_were(mill, block, phase):
    machine = mill.machine
    mill.stand(BEFORE)
    mill.type(["F12000"])
    before = mill.state()
    machine.open_text(["%", *[block] * 200, "%"])  # LinuxCNC is still reading cycles
    machine.start()
    places = [*CYCLES[block].values()]
    for place in places[: [*CYCLES[block]].index(phase) + 1]:
        machine.wait_for(partial(is_at, place), 30)
    machine.abort()
    machine.mdi("G4 P0")
    assert mill.state() == before
    assert machine.errors() == []
