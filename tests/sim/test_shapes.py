# SPDX-License-Identifier: GPL-2.0-or-later
"""The shapes on a lathe's face: what real motion cuts, in segments and with kinematics."""

import numpy as np
import pytest

from support.contour_geometry import apart
from support.kinematics import needs_kinematics
from support.operated_machine import Machine
from support.polar_programs import FIRST
from support.sim_machines import SIM, machine_scope

TOLERANCE = 0.006  # POLAR_TOLERANCE, sampling
START = [FIRST, "T3 M6", "G0 X40 Z5 C0", "F100"]
CALLS = {
    "polygon": "o<polar_polygon> call [5] [16] [1] [24] [1.5] [-9999] [.3] [4000] [2000] [20]",
    "flats": "o<polar_polygon> call [2] [14] [1] [24] [-9999] [-9999] [-9999] [4000] [2000] [0]",
    "slot": "o<polar_slot> call [9] [22] [.5] [-9999] [.2] [4000] [2000] [-30]",
    "pocket": "o<polar_pocket> call [4] [-2] [14] [.5] [-9999] [-9999] [4000] [2000]",
}


@pytest.fixture(
    scope=machine_scope,
    params=["lathe_mm", pytest.param("lathe_mm_kinematics", marks=needs_kinematics)],
)
def lathe(request):
    with Machine(SIM / f"{request.param}.ini") as running:
        yield running


def cut(lathe, name):
    """Return the motion of a call, in which verify finds nothing wrong."""
    lathe.reset()
    proof = lathe.proof_of_run([*START, CALLS[name], "M2"])
    assert proof.findings == [] and len(proof.shapes) == 1
    assert proof.shapes[0].deviation < TOLERANCE
    return proof.program.samples


@pytest.mark.parametrize("name", ["polygon", "slot", "pocket"])
def test_verify_finds_nothing_wrong_in_the_real_motion(lathe, name):
    cut(lathe, name)


def reached(samples):
    """Return where the tool was in the part: in its plane, and Z."""
    x, z, c = (samples.axes[axis][samples.axes["Z"] < -0.01] for axis in "XZC")
    return np.column_stack([x * np.cos(np.radians(c)), x * np.sin(np.radians(c)), z])


def test_in_mdi(lathe):
    expected = reached(cut(lathe, "flats"))
    lathe.reset()
    for block in START:
        lathe.mdi(block)
    before = lathe.stat().modes.gcodes
    lathe.sample()
    lathe.mdi(CALLS["flats"])
    assert apart(reached(lathe.samples()), expected) < TOLERANCE
    assert not lathe.errors()
    assert lathe.stat().modes.gcodes == before
    lathe.mdi("o<polar_slot> call [5] [30] [1] [-9999] [-9999] [400] [-9999] [0]")
    assert [error.text for error in lathe.errors()] == [
        "polar_slot: width 5 must not be less than the cutter's 6"
    ]
