# SPDX-License-Identifier: GPL-2.0-or-later
"""Cycles that leave the machine's travel are refused by a real LinuxCNC before they move."""

import pytest

from support.operated_machine import Machine
from support.refusals import at_line
from support.sim_machines import BRISK, SIM, machine_scope

LIMITS = {"AXIS_X": (-100, 300), "AXIS_Y": (-200, 200), "AXIS_Z": (-50, 60)}
OVERRIDES = BRISK | {
    axis: {**BRISK[axis], "MIN_LIMIT": low, "MAX_LIMIT": high}
    for axis, (low, high) in LIMITS.items()
}
FIRST = "G21 G17 G40 G49 G54 G64 G90 G91.1 G94 F12000"
CASES = {
    "mill_mm": [
        (
            FIRST,
            "G12 X200.5 I5 K103 Q3 Z-1 D1",
            "the X axis would go to 300.5 mm, beyond its limit",
        ),
        ("G10 L2 P1 X50 R90", "G13 X160 I45 Z-1 D0", "the Y axis would go to 205 mm, beyond its"),
        ("T1 M6 G43", "G12 I5 Z-71 D1", "the Z axis would go to -51 mm, beyond its limit -50 mm"),
        ("T1 M6", "G13.2 X250 Y0 Z-1 I1 R60 H2", "the X axis would go to 307 mm, beyond its"),
    ],
    "mill_yasnac_mm": [
        (FIRST, "G12 I110.5 R90 D10", "the X axis would go to -100.5 mm, beyond its limit -100 mm"),
    ],
    "mill_mitsubishi_mm": [
        (FIRST, "G12 I110.5 D10", "the X axis would go to -100.5 mm, beyond its limit -100 mm"),
        ("G18", "G12 I60.5 D10", "the Z axis would go to -50.5 mm, beyond its limit -50 mm"),
    ],
}
FITS = {
    "mill_mm": "G12 X200 I60 K103 Q40 Z-50 D1",
    "mill_yasnac_mm": "G12 I110 R90 D10",
    "mill_mitsubishi_mm": "G12 I110 D10",
}


@pytest.fixture(scope=machine_scope, params=CASES)
def mill(request, tmp_path_factory):
    table = tmp_path_factory.mktemp("tools") / "tool.tbl"
    table.write_text("T1 P1 D6 Z20\nT10 P10 D20\n")
    with Machine(SIM / f"{request.param}.ini", tools=table, overrides=OVERRIDES) as machine:
        yield request.param, machine


def test_a_circle_beyond_a_limit_is_refused_before_it_moves(mill):
    name, machine = mill
    for setup, block, rule in CASES[name]:
        machine.reset()
        machine.mdi(FIRST)
        machine.mdi(setup)
        before = machine.stat().position
        machine.mdi(block)
        (said,) = machine.errors()
        run = machine.run_text([FIRST, setup, block, "M2"])
        code = block.split()[0]
        assert said.text.startswith(f"{code}: {rule}")
        assert run.error.text.startswith(at_line(f"{code}: {rule}", 3))
        assert machine.stat().position == before
        assert not run.samples.moving().any()


def test_a_circle_that_just_fits_is_cut(mill):
    name, machine = mill
    machine.reset()
    run = machine.run_text([FIRST, FITS[name], "M2"])
    assert run.error is None
    reached = run.samples.axes["X"]
    assert max(reached.max() - 300, -100 - reached.min()) == pytest.approx(0, abs=0.01)
