# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill event cut by a headless LinuxCNC: AUTO and MDI, both front ends, refusals."""

import numpy as np
import pytest
from shapely.geometry import MultiLineString, Point

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.operated_machine import Machine
from support.refusals import at_line
from support.sim_machines import BRISK, SIM, machine_scope

TOOLS = {1: 6.0, 2: 10.0}
FIRST = "G21 G17 G40 G49 G54 G61 G80 G90 G91.1 G94 F8000"
HOME = "G0 X0 Y0 Z5"
POCKET = "G13.2 X10 Y5 Z-2 I1 E3 R9 H2 K2 Q.2 P4000"
CALL = (
    "o<circle_mill> call [7] [10] [5] [-2] [1] [3] [9] [-9999] [2] [2] [-9999] [0.2]"
    " [4000] [8000] [6000]"
)
OUTSIDE = "G12.2 X10 Y5 Z-1 I1 R5 H1 Q.2 L0"
DEVIATION = 0.002  # mm, of the real motion in exact path mode at this feed


@pytest.fixture(scope=machine_scope)
def machine():
    with Machine(SIM / "mill_mm.ini", tools=TOOLS, overrides=BRISK) as running:
        running.mdi("T1 M6")
        yield running


@pytest.fixture(scope="module")
def tracer():
    with Tracer(SIM / "mill_mm.ini", tools=TOOLS) as running:
        yield running


@pytest.fixture(autouse=True)
def at_start(machine):
    machine.mdi(FIRST)
    machine.mdi("G0 Z5")
    machine.mdi(HOME)
    machine.errors(), machine.messages()


def programmed(tracer, block):
    """Return the programmed path in XY and in the levels passed (shapely and mm)."""
    traced = tracer.trace_text([FIRST, "T1 M6", HOME, block])
    assert traced.error is None, traced.error
    return MultiLineString(
        [cut_geometry.polyline(move) for move in cut_geometry.moving(traced.moves)]
    ), traced


def check_motion(samples, path, traced):
    points = np.column_stack([samples.axes["X"], samples.axes["Y"]])[samples.moving()]
    assert max(path.distance(Point(point)) for point in points[::3]) < DEVIATION
    height = samples.axes["Z"]
    for level in cut_geometry.levels(traced.moves):
        assert np.abs(height - level).min() < 1e-4
    assert height.min() == pytest.approx(min(cut_geometry.levels(traced.moves)), abs=1e-4)
    assert height[sideways_rapids(samples)].min() >= min(1, retracted(traced)) - 1e-4


def sideways_rapids(samples):
    across = np.hypot(np.diff(samples.axes["X"]), np.diff(samples.axes["Y"])) > 1e-6
    return np.append(across, False) & (samples.kind == 1)


def retracted(traced):
    """Return the height of the lowest rapid back to the centre: 2.54 above its level."""
    *above, _ = cut_geometry.levels(traced.moves)
    return min(above, default=1) + 2.54


@pytest.mark.parametrize(
    ("way", "block"),
    [("auto", POCKET), ("auto", CALL), ("auto", OUTSIDE), ("mdi", CALL), ("mdi", OUTSIDE)],
)
def test_the_real_motion_is_the_traced_one(machine, tracer, way, block):
    path, traced = programmed(tracer, block)
    if way == "auto":
        run = machine.run_text([FIRST, block, "M2"])
        assert (run.error, run.messages) == (None, [])
        samples = run.samples
    else:
        machine.sample()
        machine.mdi(block)
        samples = machine.samples()
        assert machine.errors() == []
    check_motion(samples, path, traced)
    assert machine.stat().position[:3] == pytest.approx((0, 0, traced.position[2]), abs=1e-4)


@pytest.mark.parametrize("way", ["auto", "mdi"])
@pytest.mark.parametrize(
    ("block", "message"),
    [
        (POCKET.replace("H2", "H1"), "G13.2: D0 with H1 does not put the tool inside the pocket:"),
        (CALL.replace("[9]", "[2]"), "circle_mill: R2 must be greater than the tool radius 3 (T1)"),
    ],
)
def test_a_refused_event_moves_nothing_and_says_why(machine, way, block, message):
    machine.mdi("G91 G90.1 G61 F4000")
    before = machine.stat()
    machine.sample()
    if way == "mdi":
        machine.mdi(block)
    else:
        machine.open_text([block, "M2"])
        machine.start()
        machine.wait_idle()
    samples, after = machine.samples(), machine.stat()
    (error,) = machine.errors()
    assert error.text.startswith(at_line(message, 1) if way == "auto" else message)
    assert not samples.moving().any()
    assert after.position == pytest.approx(before.position)
    assert after.modes.gcodes == before.modes.gcodes


def test_modes_after_the_event_are_those_before_it(machine):
    machine.mdi("G91 G90.1 G64 P0.01 F9000")
    before = machine.stat().modes
    for block in (OUTSIDE.replace("Z-1", "Z-2"), CALL.replace("[8000]", "[-9999]")):
        machine.mdi(block)
        assert machine.stat().modes == before
    assert machine.errors() == []


def test_w_stays_from_one_mdi_block_to_the_next(machine):
    machine.mdi(OUTSIDE)
    machine.mdi("G12.2 X10 Y5 Z-1 R5 H1")
    assert machine.errors() == []
    assert machine.stat().position[2] == pytest.approx(1)


def test_w_of_another_program_does_not_count(machine, tmp_path):
    programs = {"first": [FIRST, OUTSIDE, "M2"], "second": [FIRST, OUTSIDE.replace("I1", ""), "M2"]}
    for name, blocks in programs.items():
        file = tmp_path / f"{name}.ngc"
        file.write_text("\n".join(blocks) + "\n")
        run = machine.run(file)
        if name == "first":
            assert run.error is None
    rule = "I is missing: the first reference plane, which no earlier event has commanded"
    assert run.error.text == f"G12.2 line 2: {rule}"


def test_pause_resume_and_abort_and_the_program_again(machine, tracer):
    path, traced = programmed(tracer, CALL)
    machine.open_text([FIRST, HOME, CALL, "M2"])
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0 and status.position[1] < 0)
    machine.pause()
    machine.wait_for(lambda status: status.paused)
    machine.abort()
    machine.errors()
    machine.mdi("G90 G0 Z5")
    machine.mdi(HOME)
    machine.open_text([FIRST, HOME, CALL, "M2"])
    machine.sample()
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0 and status.position[1] < 0)
    machine.pause()
    machine.wait_for(lambda status: status.paused)
    machine.resume()
    machine.wait_idle()
    assert machine.errors() == []
    check_motion(machine.samples(), path, traced)
