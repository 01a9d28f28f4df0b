# SPDX-License-Identifier: GPL-2.0-or-later
"""A Haas pocket with [G12] ENTRY = helix cut by a headless LinuxCNC: the real way down."""

import math

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.operated_machine import kept_machine
from support.sim_machines import SIM, machine_scope

TOOLS = {1: 10.0}
FEED, SHARE = 2400.0, 0.6  # mm/min; [G12] PLUNGE_FEED of the machine is 60
FIRST = f"G21 G17 G40 G49 G54 G64 P0.001 G80 G90 G91.1 G94 F{FEED:g}"
START = "G0 X0 Y0 Z1"
POCKET = "G13 X20 Y5 I9 K14 Q5 Z-3 D1"  # a helix of radius 4, which is the first ring
CENTRE, HELIX, DEPTH, STEEPEST = (20, 5), 4.0, -3.0, 3.0
DEVIATION = 0.002  # mm
PERIOD = 0.001  # s between samples

machine = kept_machine("mill_helix_mm", tools=TOOLS)


@pytest.fixture(scope="module")
def tracer():
    with Tracer(SIM / "mill_helix_mm.ini", tools=TOOLS) as running:
        yield running


def go_to_start(machine):
    machine.reset()
    machine.mdi(FIRST)
    machine.mdi(START)


@pytest.fixture(autouse=True)
def at_start(machine):
    go_to_start(machine)


@pytest.fixture(scope=machine_scope)
def cut(machine):
    """Return the samples of the pocket, cut by a program."""
    go_to_start(machine)
    run = machine.run_text([FIRST, START, POCKET, "M2"])
    assert run.error is None
    return run.samples


def points_of(samples):
    """Return where the tool was while it moved (n, 3)."""
    return np.column_stack([samples.axes[axis] for axis in "XYZ"])[samples.moving()]


def check_path(samples, tracer):
    """Check that the real motion below the start lies on the traced path, and reaches all of it."""
    traced = tracer.trace_text([FIRST, START, POCKET])
    assert traced.error is None, traced.error
    path = cut_geometry.dense_points(cut_geometry.cutting(traced.moves), step=0.1)
    points = points_of(samples)
    assert cut_geometry.farthest_off(points[points[:, 2] < 0.95][::20], path) < DEVIATION
    assert cut_geometry.farthest_off(path[path[:, 2] < 0.95][::10], points) < 0.01


def on_the_way_down(points):
    """Return the samples of the helix: where it falls at its own feed."""
    radius = np.hypot(points[:, 0] - CENTRE[0], points[:, 1] - CENTRE[1])
    height = points[:, 2]
    return points[(height < 0.8) & (height > DEPTH + 0.1) & (np.abs(radius - HELIX) < 0.01)]


def check_cut(samples, tracer):
    """Check the real motion of `POCKET`: on the traced path, smooth, as deep, as fast as asked."""
    check_path(samples, tracer)
    points = points_of(samples)
    assert points[:, 2].min() == pytest.approx(DEPTH, abs=1e-6)
    down = on_the_way_down(points)
    steps = np.diff(down, axis=0)
    assert (steps[:, 2] <= 1e-9).all()
    flat = np.hypot(steps[:, 0], steps[:, 1])
    assert np.degrees(np.arctan2(-steps[:, 2], flat)).max() < STEEPEST + 0.01
    speed = np.hypot(flat, steps[:, 2]) / PERIOD * 60
    assert np.median(speed) == pytest.approx(SHARE * FEED, rel=0.005)
    assert np.quantile(speed, 0.99) < SHARE * FEED * 1.001  # but where half turns meet


def check_smooth(samples):
    """Check that the direction turns no faster than round the narrowest arc; it stands nowhere."""
    points = points_of(samples)
    steps = np.diff(points[points[:, 2] < 0.5], axis=0)
    length = np.linalg.norm(steps, axis=1)
    inside = slice(20, -60)  # but for the stop at the end
    assert length[inside].min() > 0.2 * SHARE * FEED / 60 * PERIOD
    along = (steps / np.maximum(length, 1e-12)[:, None])[inside]
    turn = np.degrees(np.arccos(np.clip((along[1:] * along[:-1]).sum(axis=1), -1, 1)))
    assert turn.max() < math.degrees(length.max() / (HELIX / 2)) + 0.5


def test_the_tool_goes_down_along_the_helix(cut, tracer):
    check_cut(cut, tracer)
    check_smooth(cut)


def test_abort_in_the_helix_then_up_and_the_pocket_again_in_mdi(machine, tracer):
    machine.mdi(POCKET, wait=False)
    machine.wait_for(lambda status: status.position[2] < -1)
    machine.abort()
    held = machine.stat()
    assert DEPTH < held.position[2] < -0.9
    assert {"G17", "G21", "G90", "G91.1", "G94"} <= set(held.modes.gcodes)
    assert held.modes.feed == pytest.approx(FEED)
    machine.errors()
    machine.mdi("G0 Z1")
    machine.mdi(START)
    machine.sample()
    machine.mdi(POCKET)
    samples = machine.samples()
    assert machine.errors() == []
    check_cut(samples, tracer)


@pytest.mark.parametrize("lines", [1, 200], ids=["read to its end", "being read"])
def test_what_an_abort_in_a_program_leaves_in_f(machine, lines):
    """F is what LinuxCNC had read, or 0 behind the cycle's end: never faster than programmed."""
    machine.open_text([FIRST, START, *[POCKET.replace("Z-3", "Z-60")] * lines, "M2"])
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0)
    machine.abort()
    machine.mdi("G90")
    assert machine.stat().modes.feed <= FEED * (1 + 1e-9)
    machine.mdi("G0 Z1")
    machine.mdi(f"G91 G1 X1 F{FEED:g}")
    assert machine.errors() == []
    assert machine.stat().modes.feed == pytest.approx(FEED)
