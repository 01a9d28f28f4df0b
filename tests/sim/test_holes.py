# SPDX-License-Identifier: GPL-2.0-or-later
"""Holes with C: what the real axes do, the clamp, taps, aborts in every phase."""

import random
from typing import ClassVar

import numpy as np
import pytest

from support.clamped import with_clamp
from support.kinematics import needs_kinematics
from support.operated_machine import Machine
from support.polar_programs import FEED, FIRST, ROUND
from support.sim_machines import SIM, machine_scope

X, Z, C = 0, 2, 5
START = [FIRST, "T3 M6", "G0 X40 Z8 C100", "F900"]
CLOSED, DRAG = "motion.digital-out-00", "motion.digital-out-01"
AS_FLOATS = ["loadrt mux2 count=2"]  # a sample has no bits
for number, pin in enumerate((CLOSED, DRAG)):
    AS_FLOATS += [f"net clamp-{number} {pin} => mux2.{number}.sel", f"setp mux2.{number}.in1 1"]
    AS_FLOATS += [f"addf mux2.{number} servo-thread"]
SLOT = "o<polar_slot> call [6] [30] [1] [-9999] [-9999] [6000] [-9999] [0]"
FACE = "o<face_holes> call [3] [30] [20] [-9999] [4] [2] [1200] [1.5] [0.1] [0]"
SIDE = "o<side_holes> call [2] [-10] [30] [270] [40] [5] [3] [1200] [-2] [0] [0]"
SAME = 0.002  # mm, degrees: within the servo's sampling


class ClampLathe(Machine):
    """A lathe whose samples tell of the clamp: K closed, D with the light drag."""

    recorded: ClassVar = {"K": "mux2.0.out", "D": "mux2.1.out"}


@pytest.fixture(
    scope=machine_scope,
    params=["lathe_mm", pytest.param("lathe_mm_kinematics", marks=needs_kinematics)],
)
def lathe(request, tmp_path_factory):
    overrides = with_clamp(request.param, tmp_path_factory.mktemp("clamp"), C_CLAMP_SHAPES="M12")
    overrides["HAL"] = {"HALCMD": AS_FLOATS}
    with ClampLathe(SIM / f"{request.param}.ini", overrides=overrides) as running:
        yield running


in_segments = pytest.mark.parametrize("lathe", ["lathe_mm"], indirect=True)  # a hole is no face


def beyond_the_start(samples):
    """Return where the samples have come to X40, from where the calls begin."""
    return int(np.argmax(samples.axes["X"] > 40 - SAME))


def bottoms(samples, axis, least):
    """Return X, Z and C of each hole's deepest point, along an axis of the machine."""
    skip = beyond_the_start(samples)
    values = samples.axes[axis][skip:]
    deep = values < least + SAME
    edges = np.flatnonzero(np.diff(np.concatenate([[0], deep.astype(int), [0]])))
    places = [(first + last) // 2 for first, last in zip(edges[::2], edges[1::2])]
    return [tuple(samples.axes[letter][skip + at] for letter in "XZC") for at in places]


def turned_low(samples, axis, height):
    """Return how far C has turned while the tool was below a height, degrees."""
    skip = beyond_the_start(samples)
    low = samples.axes[axis][skip + 1 :] < height - SAME
    return float(np.abs(np.diff(samples.axes["C"][skip:])[low]).sum())


def test_holes_on_the_face(lathe):
    lathe.reset()
    run = lathe.run_text([*START, FACE, "M2"])
    assert run.error is None
    found = bottoms(run.samples, "Z", -4)
    assert found == [pytest.approx((15, -4, c), abs=SAME) for c in (20, 140, 260)]
    assert turned_low(run.samples, "Z", 2) == 0
    assert run.position[Z] == pytest.approx(8)


@in_segments
def test_holes_in_the_side(lathe):
    lathe.reset()
    run = lathe.run_text([*START, SIDE, "M2"])
    assert run.error is None
    found = bottoms(run.samples, "X", 15)
    assert found == [pytest.approx((15, -10, c), abs=SAME) for c in (30, -60)]
    assert turned_low(run.samples, "X", 23) == 0


@in_segments
@pytest.mark.parametrize(("kind", "code"), [(1, 3), (2, 4)])
def test_a_tap_follows_the_spindle(lathe, kind, code):
    lathe.reset()
    call = f"o<face_hole_at> call [10] [0] [3] [2] [1] [0] [0] [{kind}]"
    run = lathe.run_text([*START, f"S300 M{code}", call, "M5", "M2"])
    assert run.error is None
    z = run.samples.axes["Z"]
    assert z.min() == pytest.approx(-3, abs=0.2)
    down = np.flatnonzero(np.diff(z) < 0)[-1000:-200]
    speed = -np.diff(z)[down].mean() * 1000
    assert speed == pytest.approx(300 / 60, rel=0.02)


def of_the_clamp(samples):
    """Return Z, whether C turns, and whether the clamp is closed or drags, after the start."""
    skip = beyond_the_start(samples)
    z, c, closed, drag = (samples.axes[letter][skip:] for letter in "ZCKD")
    return z, np.abs(np.diff(c, prepend=c[:1])) > 1e-6, closed > 0, drag > 0


@in_segments
def test_the_clamp_is_closed_in_holes_and_open_while_c_turns(lathe):
    lathe.reset()
    z, turning, closed, _ = of_the_clamp(lathe.motion_of([*START, FACE, "M2"]))
    assert closed[z < 1.9].all() and (z < -3.9).any()
    assert turning.any() and not closed[turning].any() and not closed[-1]


def test_aborts_in_every_phase_leave_the_clamp_open(lathe):
    chance = random.Random(28)
    ways = [(FACE, Z, chance.uniform(-4, 8)), (SIDE, X, chance.uniform(14.5, 26.5))] * 2
    for call, axis, least in (*ways, (SLOT, Z, 0.5), (SLOT, Z, -0.9)):
        lathe.reset()
        lathe.open_text([*START, call, "M2"])
        lathe.start()
        lathe.wait_for(lambda status: status.actual[axis] < least or status.idle)  # noqa: B023
        lathe.abort()
        lathe.errors()
        lathe.wait_for(lambda _: not lathe.get(CLOSED) and not lathe.get(DRAG))
        lathe.mdi("G90 G0 X50 Z20")
        assert lathe.stat().position[X] == pytest.approx(50) and not lathe.errors()
    run = lathe.run_text([*START, FACE, "M2"])
    assert run.error is None and len(bottoms(run.samples, "Z", -4)) == 3


def test_a_shape_is_cut_with_a_light_drag(lathe):
    lathe.reset()
    samples = lathe.motion_of([*START, SLOT, "G0 C0", "M2"])
    z, _, closed, drag = of_the_clamp(samples)
    cutting = (z < 0) & np.isin(samples.kind[-len(z) :], (FEED, ROUND))
    assert drag[cutting].all() and (z[cutting] < -0.9).any() and not closed[cutting].any()
    assert not drag[0] and not drag[-1]


@in_segments
def test_in_mdi(lathe):
    lathe.reset()
    for block in START:
        lathe.mdi(block)
    before = lathe.stat().modes
    lathe.mdi(FACE)
    assert not lathe.errors() and lathe.stat().modes == before
    lathe.mdi("o<face_holes> call [3] [30] [20] [-9999] [4] [2] [1200] [0] [0] [7]")
    assert [error.text for error in lathe.errors()] == ["face_holes: kind 7 must be at most 3"]
