# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 cut by a headless LinuxCNC: the real motion, in AUTO, MDI, paused, stepped, aborted."""

import math

import numpy as np
import pytest
from shapely.geometry import MultiLineString, Point

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.operated_machine import Machine, kept_machine
from support.refusals import at_line
from support.sim_machines import BRISK, SIM, machine_scope

TOOLS = {1: 6.0, 2: 10.0}
FIRST = "G21 G17 G40 G49 G54 G61 G80 G90 G91.1 G94 F8000"
POCKET = "G13 X10 Y5 I5 K12 Q3 Z-1 D1"
DEVIATION = 0.002  # mm, of the real motion in exact path mode at this feed


machine = kept_machine("mill_mm", tools=TOOLS, overrides=BRISK)


@pytest.fixture(scope="module")
def tracer():
    with Tracer(SIM / "mill_mm.ini", tools=TOOLS) as running:
        yield running


@pytest.fixture(autouse=True)
def at_start(machine):
    machine.feed_override(1.0)
    machine.mdi("G21 G90 G94 G61 G0 Z2")
    machine.mdi("G0 X0 Y0")
    machine.errors(), machine.messages()


@pytest.fixture(scope=machine_scope)
def auto(machine):
    """Return the run of a program with the pocket."""
    return machine.run_text([FIRST, POCKET, "G0 Z2", "M2"])


def programmed_path(tracer, *blocks):
    """Return the programmed path in XY (shapely) and its moves."""
    traced = tracer.trace_text([FIRST, "G0 X0 Y0 Z2", *blocks])
    assert traced.error is None, traced.error
    return MultiLineString(
        [cut_geometry.polyline(move) for move in cut_geometry.moving(traced.moves)]
    ), traced


def largest_deviation(samples, path):
    """Return the largest distance of the real motion from the programmed path, mm."""
    points = np.column_stack([samples.axes["X"], samples.axes["Y"]])[samples.moving()]
    return max(path.distance(Point(point)) for point in points[::3])


def longest_reach(samples, centre=(10, 5)):
    return np.hypot(samples.axes["X"] - centre[0], samples.axes["Y"] - centre[1])[
        samples.kind == 3
    ].max()


def test_auto_cuts_the_traced_path(auto, tracer):
    path, traced = programmed_path(tracer, POCKET)
    assert auto.error is None
    assert auto.messages == []
    assert largest_deviation(auto.samples, path) < DEVIATION
    assert longest_reach(auto.samples) == pytest.approx(9, abs=DEVIATION)
    assert auto.samples.axes["Z"].min() == pytest.approx(-1, abs=1e-6)
    length = cut_geometry.path_length(cut_geometry.cutting(traced.moves))
    feeding = np.isin(auto.samples.kind, (2, 3))
    travelled = auto.samples.velocity[feeding].sum() * 0.001
    assert travelled == pytest.approx(length, rel=0.02)


def test_mdi_cuts_the_same_path(machine, tracer):
    path, _ = programmed_path(tracer, POCKET)
    machine.mdi(FIRST)
    machine.sample()
    machine.mdi(POCKET)
    samples = machine.samples()
    assert machine.errors() == []
    assert largest_deviation(samples, path) < DEVIATION
    assert longest_reach(samples) == pytest.approx(9, abs=DEVIATION)


def test_every_ring_is_round_in_real_motion(auto):
    x, y = (auto.samples.axes[axis] - centre for axis, centre in (("X", 10), ("Y", 5)))
    radius = np.hypot(x, y)
    for ring in (2, 5, 8, 9):
        on_ring = np.abs(radius - ring) < DEVIATION
        angles = np.arctan2(y, x)[on_ring]
        covered = np.histogram(angles, bins=72, range=(-math.pi, math.pi))[0]
        assert (covered > 0).all(), f"ring {ring} is not a whole circle"


def test_pause_and_resume_leave_the_path_alone(machine, tracer):
    path, _ = programmed_path(tracer, POCKET)
    machine.open_text([FIRST, POCKET, "G0 Z2", "M2"])
    machine.sample()
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0 and status.position[0] > 14)
    machine.pause()
    held = machine.wait_for(lambda status: status.paused)
    machine.resume()
    machine.wait_idle()
    assert held.position[2] == pytest.approx(-1)
    assert largest_deviation(machine.samples(), path) < DEVIATION
    assert machine.errors() == []


def test_single_steps_reach_the_end(machine, tracer):
    path, _ = programmed_path(tracer, "G13 X10 Y5 I5 K8 Q3 Z-1 D1")
    machine.open_text([FIRST, "G13 X10 Y5 I5 K8 Q3 Z-1 D1", "G0 Z2", "M2"])
    machine.sample()
    steps = 0
    machine.step()
    while True:
        status = machine.wait_for(lambda status: status.idle or status.paused)
        if status.idle:
            break
        machine.step()
        steps += 1
        assert steps < 200
    assert steps > 5
    assert machine.errors() == []
    assert largest_deviation(machine.samples(), path) < DEVIATION


def test_feed_override_slows_the_cut_only(machine, tracer):
    path, _ = programmed_path(tracer, "G12 X10 Y5 I12 Z-1 D1 F6000")
    blocks = [FIRST, "G12 X10 Y5 I12 Z-1 D1 F6000", "M2"]
    full = machine.run_text(blocks)
    machine.feed_override(0.5)
    half = machine.run_text(blocks)
    assert np.median(full.samples.velocity[full.samples.kind == 3]) == pytest.approx(6000 / 60)
    assert np.median(half.samples.velocity[half.samples.kind == 3]) == pytest.approx(3000 / 60)
    assert largest_deviation(half.samples, path) < DEVIATION


def test_abort_inside_a_ring_then_mdi_then_the_program_again(machine, tracer):
    path, _ = programmed_path(tracer, POCKET)
    machine.open_text([FIRST, "G0 X0 Y0 Z2", POCKET, "G0 Z2", "M2"])
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0 and status.position[0] > 14)
    machine.abort()
    machine.errors()
    machine.mdi("G0 Z3")
    assert machine.stat().position[2] == pytest.approx(3)
    machine.mdi("G12 I5 Z1 D1 F4000")
    assert machine.errors() == []
    machine.mdi("G0 Z3")
    machine.mdi("G0 X0 Y0 Z2")
    machine.open_text([FIRST, "G0 X0 Y0 Z2", POCKET, "G0 Z2", "M2"])
    machine.sample()
    machine.start()
    machine.wait_idle()
    samples = machine.samples()
    assert machine.errors() == []
    assert largest_deviation(samples, path) < DEVIATION
    assert longest_reach(samples) == pytest.approx(9, abs=DEVIATION)


@pytest.mark.parametrize("way", ["auto", "mdi"])
def test_without_z_the_real_motion_stays_at_its_height(machine, way):
    machine.mdi("F8000 G1 Z-1.5")
    machine.sample()
    block = "G13 I5 K12 Q3 L2 D1"
    if way == "mdi":
        machine.mdi(block)
    else:
        machine.open_text([block, "M2"])
        machine.start()
        machine.wait_idle()
    axes = machine.samples().axes
    assert machine.errors() == []
    assert axes["Z"] == pytest.approx(-1.5, abs=1e-6)
    assert axes["X"].max() == pytest.approx(9, abs=DEVIATION)


@pytest.mark.parametrize("way", ["auto", "mdi"])
def test_a_refused_block_moves_nothing_and_says_why(machine, way):
    machine.mdi("G91 G90.1 G61 F4000")
    before = machine.stat()
    machine.sample()
    if way == "mdi":
        machine.mdi("G12 I2 Z-1 D1")
    else:
        machine.open_text(["G12 I2 Z-1 D1", "M2"])
        machine.start()
        machine.wait_idle()
    samples, after = machine.samples(), machine.stat()
    said = "G12: I2 must be greater than the tool radius 3 (D1)"
    expected = at_line(said, 1) if way == "auto" else said
    assert [error.text for error in machine.errors()] == [expected]
    assert not samples.moving().any()
    assert after.position == pytest.approx(before.position)
    assert after.modes.gcodes == before.modes.gcodes


def test_a_refusal_in_a_sub_says_its_line_and_file(tmp_path):
    (tmp_path / "flat.ngc").write_text("o<flat> sub\n\nG12 I2 Z-1 D1\no<flat> endsub\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"{tmp_path}:../../ngc:subs"}}
    with Machine(SIM / "mill_mm.ini", tools=TOOLS, overrides=paths) as machine:
        run = machine.run_text([FIRST, "G12 I9 Z0 D1", "o<flat> call", "M2"])
        said = "G12 line 3 of flat.ngc: I2 must be greater than the tool radius 3 (D1)"
        assert run.error.text == said
        machine.mdi("o<flat> call")
        machine.mdi("G12 I2 Z-1 D1")
        machine.mdi("o<circle_mill> call [3]")
        assert [error.text.split(": ")[0] for error in machine.errors()] == [
            "G12 line 3 of flat.ngc",
            "G12",
            "circle_mill",
        ]


def test_an_operator_message_does_not_stop_the_cut(machine):
    run = machine.run_text([FIRST, "G13 I5 K14 Q8 Z-1 D1", "G0 Z2", "M2"])
    assert run.error is None
    assert [message.text for message in run.messages] == [
        "G13: Q8 is greater than the tool diameter 6: material is left between the rings"
    ]


def test_modes_after_the_cycle_are_those_before_it(machine):
    machine.mdi("G21 G91 G90.1 G64 P0.01 F3000")
    before = machine.stat().modes
    machine.mdi("G13 I5 K8 Q3 Z-1 D1")
    after = machine.stat().modes
    assert after.gcodes == before.gcodes
    assert after.blending == before.blending


def test_d_with_a_random_tool_changer():
    """The loaded tool has no place in the table any more but the spindle's."""
    changer = {**BRISK, "EMCIO": {"RANDOM_TOOLCHANGER": 1}}
    with Machine(SIM / "mill_mm.ini", tools={1: 6.0, 2: 10.0}, overrides=changer) as machine:
        machine.mdi("G21 G17 G40 G90 G94 F8000")
        machine.mdi("T1 M6")
        for offset, reach in (("D1", 6), ("D2", 4)):
            machine.sample()
            machine.mdi(f"G12 I9 Z-1 {offset}")
            assert machine.samples().axes["X"].max() == pytest.approx(reach, abs=0.002)
        assert machine.errors() == []
