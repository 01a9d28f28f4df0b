# SPDX-License-Identifier: GPL-2.0-or-later
"""A Haas pocket with [G12] ENTRY = helix cut by a headless LinuxCNC: the real way down."""

import math

import numpy as np
import pytest

from support.contour_geometry import apart
from support.operated_machine import kept_machine
from support.polar_programs import FEED as AT_FEED
from support.polar_programs import ROUND
from support.sim_machines import machine_scope

TOOLS = {1: 10.0}
FEED, SHARE = 2400.0, 0.6  # mm/min; [G12] PLUNGE_FEED of the machine is 60
FIRST = f"G21 G17 G40 G49 G54 G64 P0.001 G80 G90 G91.1 G94 F{FEED:g}"
START = "G0 X0 Y0 Z1"
POCKET = "G13 X20 Y5 I9 K14 Q5 Z-3 D1"  # a helix of radius 4, which is the first ring
HELIX, DEPTH = 4.0, -3.0
DEVIATION = 0.002  # mm
PERIOD = 0.001  # s between samples

machine = kept_machine("mill_helix_mm", tools=TOOLS)


def go_to_start(machine):
    machine.reset()
    machine.mdi(FIRST)
    machine.mdi(START)


@pytest.fixture(autouse=True)
def at_start(machine):
    go_to_start(machine)


@pytest.fixture(scope=machine_scope)
def cut(machine):
    """Return the samples of the pocket, cut by a program in which verify finds nothing wrong."""
    go_to_start(machine)
    proof = machine.proof_of_run([FIRST, "T1 M6", START, POCKET, "M2"])
    assert proof.findings == [] and proof.pockets[0].values["off_circles"] < DEVIATION
    return proof.program.samples


def points_of(samples):
    """Return where the tool was at feed: X, Y and Z."""
    places = np.column_stack([samples.axes[axis] for axis in "XYZ"])
    return places[np.isin(samples.kind, (AT_FEED, ROUND))]


def test_the_direction_turns_no_faster_than_round_the_narrowest_arc(cut):
    """And the tool stands nowhere on its way down."""
    points = points_of(cut)
    steps = np.diff(points[points[:, 2] < 0.5], axis=0)
    length = np.linalg.norm(steps, axis=1)
    inside = slice(20, -60)  # but for the stop at the end
    assert length[inside].min() > 0.2 * SHARE * FEED / 60 * PERIOD
    along = (steps / np.maximum(length, 1e-12)[:, None])[inside]
    turn = np.degrees(np.arccos(np.clip((along[1:] * along[:-1]).sum(axis=1), -1, 1)))
    assert turn.max() < math.degrees(length.max() / (HELIX / 2)) + 0.5


def test_abort_in_the_helix_then_up_and_the_pocket_again_in_mdi(machine, cut):
    machine.feed_override(0.2)  # some seconds to the bottom
    machine.mdi(POCKET, wait=False)
    machine.wait_for(lambda status: status.position[2] < -1)
    machine.abort()
    machine.feed_override(1.0)
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
    assert apart(points_of(samples), points_of(cut)) < DEVIATION


def test_what_an_abort_in_a_program_leaves_in_f(machine):
    """F is what LinuxCNC had read: never faster than programmed."""
    machine.open_text([FIRST, START, *[POCKET.replace("Z-3", "Z-60")] * 200, "M2"])
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0)
    machine.abort()
    machine.mdi("G90")
    assert machine.stat().modes.feed <= FEED * (1 + 1e-9)
    machine.mdi("G0 Z1")
    machine.mdi(f"G91 G1 X1 F{FEED:g}")
    assert machine.errors() == []
    assert machine.stat().modes.feed == pytest.approx(FEED)
