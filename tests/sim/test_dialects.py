# SPDX-License-Identifier: GPL-2.0-or-later
"""The Yasnac and Mitsubishi mills without a screen: their sample programs, refusals, abort."""

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.operated_machine import Machine
from support.sim_machines import BRISK, PROGRAMS, SIM, machine_scope

MILLS = {
    "mill_yasnac_mm": ("yasnac/example.ngc", "G12 I50 R55 D10", "G12: R55 puts the tool centre"),
    "mill_mitsubishi_mm": ("mitsubishi/planes.ngc", "G12 I50", "G12: D is missing: the tool"),
}
DEVIATION = 0.015  # mm, of the real motion: the programs blend with P0.01


@pytest.fixture(scope=machine_scope, params=MILLS)
def mill(request):
    with Machine(SIM / f"{request.param}_headless.ini", overrides=BRISK) as machine:
        yield request.param, machine


def quicker(program):
    """Return a program's text at forty times its feed."""
    return program.read_text().replace("F300", "F12000")


def test_the_sample_program_s_real_motion_is_the_traced_one(mill):
    name, machine = mill
    text = quicker(PROGRAMS / MILLS[name][0])
    with Tracer(SIM / f"{name}.ini") as tracer:
        traced = tracer.trace_text(text)
    assert traced.error is None
    run = machine.run_text(text)
    assert (run.error, run.messages) == (None, [])
    cutting = cut_geometry.cutting(traced.moves)
    programmed = cut_geometry.dense_points(cutting, step=0.1) + cutting[0].tool_offset[:3]
    circles = run.samples.kind == 3
    real = np.column_stack([run.samples.axes[axis][circles] for axis in "XYZ"])[::10]
    distances = [np.linalg.norm(programmed - point, axis=1).min() for point in real]
    assert max(distances) < DEVIATION + 0.05  # half the spacing of the programmed points
    end = np.add(traced.position[:3], cutting[0].tool_offset[:3])
    assert run.position[:3] == pytest.approx(end, abs=1e-6)


def test_a_refused_block_moves_nothing_and_says_why(mill):
    name, machine = mill
    _, block, message = MILLS[name]
    machine.mdi("G21 G90 G94 F1000")
    before = machine.stat()
    machine.sample()
    machine.mdi(block)
    samples, after = machine.samples(), machine.stat()
    (error,) = machine.errors()
    assert error.text.startswith(message)
    assert not samples.moving().any()
    assert after.position == before.position
    assert after.modes.gcodes == before.modes.gcodes
    assert after.modes.feed == pytest.approx(before.modes.feed)


def test_mdi_then_abort_then_mdi_again(mill):
    _, machine = mill
    machine.mdi("G21 G17 G90 G94 G49 G64 P0.01 F12000 G0 X0 Y0 Z0")
    before = machine.stat()
    machine.mdi("G12 I50 D10", wait=False)
    machine.wait_for(lambda status: status.position[0] > 20)
    machine.abort()
    machine.errors()
    machine.mdi("G90 G0 X0 Y0")
    machine.mdi("G13 I30 D10")
    assert machine.errors() == []
    assert machine.stat().position == pytest.approx(before.position, abs=1e-6)
