# SPDX-License-Identifier: GPL-2.0-or-later
"""The shapes on a lathe's face: what real motion cuts, in segments and with kinematics."""

import numpy as np
import pytest

from support.kinematics import needs_kinematics
from support.operated_machine import Machine
from support.polar_programs import FIRST
from support.shape_geometry import FacePath, area_off, disc, polygon, slot
from support.sim_machines import SIM, machine_scope

CUTTER = 3.0
TOLERANCE = 0.008  # POLAR_TOLERANCE, sampling, and the polygons of the drawing
START = [FIRST, "T3 M6", "G0 X40 Z5 C0", "F100"]
BAR = disc(0, 0, 24)
CALLS = {  # the call, the depths of its passes, and what stands or is cut there
    "polygon": (
        "o<polar_polygon> call [5] [16] [1] [24] [1.5] [-9999] [.3] [4000] [2000] [20]",
        (-1,),
        polygon(5, 16, 1.5, 20) & BAR,
    ),
    "flats": (
        "o<polar_polygon> call [2] [14] [1] [24] [-9999] [-9999] [-9999] [4000] [2000] [0]",
        (-1,),
        polygon(2, 14) & BAR,
    ),
    "slot": (
        "o<polar_slot> call [9] [22] [.5] [-9999] [.2] [4000] [2000] [-30]",
        (-0.5,),
        slot(9, 22, -30),
    ),
    "pocket": (
        "o<polar_pocket> call [4] [-2] [14] [.5] [-9999] [-9999] [4000] [2000]",
        (-0.5,),
        disc(4, -2, 14),
    ),
}

LONG = "o<polar_polygon> call [6] [27] [5] [40] [1] [.5] [-9999] [4000] [2000] [0]"


@pytest.fixture(
    scope=machine_scope,
    params=["lathe_mm", pytest.param("lathe_mm_kinematics", marks=needs_kinematics)],
)
def lathe(request):
    with Machine(SIM / f"{request.param}.ini") as running:
        yield running


def real_path(samples):
    """Return the sampled path of the tool in the part's plane."""
    points = samples.axes["X"] * np.exp(1j * np.radians(samples.axes["C"]))
    some = slice(None, None, 4)
    return FacePath(points[some], samples.axes["Z"][some])


def check_cut(name, path):
    """Check what a path cuts against the drawing of a shape."""
    _, depths, drawn = CALLS[name]
    for depth in depths:
        # Z is on its way for some samples: what is cut there is within the tolerance too
        cut = path.area(depth + 0.001, CUTTER)
        shape = BAR.difference(cut) if name in ("polygon", "flats") else cut
        assert area_off(shape, drawn, TOLERANCE) < 0.01
    assert path.z.min() == pytest.approx(depths[-1], abs=1e-6)


@pytest.mark.parametrize("name", CALLS)
def test_real_motion_cuts_the_drawing(lathe, name):
    lathe.reset()
    run = lathe.run_text([*START, CALLS[name][0], "M2"])
    assert run.error is None
    check_cut(name, real_path(run.samples))


def test_in_mdi(lathe):
    lathe.reset()
    for block in START:
        lathe.mdi(block)
    before = lathe.stat().modes.gcodes
    lathe.sample()
    lathe.mdi(CALLS["flats"][0])
    check_cut("flats", real_path(lathe.samples()))
    assert not lathe.errors()
    assert lathe.stat().modes.gcodes == before
    lathe.mdi("o<polar_slot> call [5] [30] [1] [-9999] [-9999] [400] [-9999] [0]")
    assert [error.text for error in lathe.errors()] == [
        "polar_slot: width 5 must not be less than the cutter's 6"
    ]


def test_an_abort_in_a_shape_and_the_same_call_again(lathe):
    """The call is longer than what LinuxCNC reads ahead: it is aborted inside the sub."""
    lathe.reset()
    lathe.open_text([*START, "G7", LONG, "M2"])
    lathe.start()
    lathe.wait_for(lambda status: status.position[2] < 0)
    lathe.abort()
    lathe.errors()
    lathe.mdi("G0 X50")
    assert "G7" in lathe.stat().modes.gcodes and lathe.stat().position[0] == pytest.approx(25)
    run = lathe.run_text(["G0 Z5", *START, CALLS["flats"][0], "M2"])
    assert run.error is None
    check_cut("flats", real_path(run.samples))


def test_a_coarse_g64_does_not_shorten_a_ramp():
    """LinuxCNC rounds a corner of X and Z by all of P where C stands, at any speed."""
    lines = [*START, "G64 P0.1", "o<polar_slot> call [6] [10] [1] [-9999] [-9999] [2000] [240] [0]"]
    with Machine(SIM / "lathe_mm.ini") as lathe:
        axes = lathe.run_text("\n".join([*lines, "G0 Z5", "M2", ""])).samples.axes
    x, z = axes["X"], axes["Z"]
    sloping = (z[1:-1] > -0.9) & (z[1:-1] < 0.5) & (x[1:-1] > 1.0)
    turning = sloping & (x[1:-1] >= x[:-2]) & (x[1:-1] > x[2:])
    assert turning.any()
    assert np.abs(x[1:-1][turning] - 2.0).max() < 0.005
