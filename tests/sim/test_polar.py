# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 and G7.1 in a headless LinuxCNC: the samples' real motion, all that an operator does."""

import math
import re
from functools import partial

import numpy as np
import pytest

from support import polar_programs
from support.contour_geometry import FROM_COLUMNS, apart, distance, lines
from support.operated_machine import Machine, kept_machine
from support.polar_programs import (
    C_ACCELERATION,
    FEED,
    FIRST,
    ROUND,
    Cut,
    accelerations,
    exceeds_limits_itself,
    section,
)
from support.sim_machines import PROGRAMS, SIM

INCH = 25.4
TOLERANCE = {"metric": 0.005, "inch": 0.0002 * INCH}  # mm: the default of POLAR_TOLERANCE
SAMPLING = 0.001  # mm, what it may add
MANUAL_TOOLS = {1: 0.5}
C_SPEED = 360
SAMPLES = {  # how many times as fast they are cut here, and how much longer they may take
    "polar/slot": (1, 1.2),  # C turns as fast as it can near the centre
    "polar/circles": (1, 1.02),
    "polar/cam": (1, 1.02),
    "polar/manual_a": (3, 1.1),
    "cylinder/helix": (10, 1.05),
    "cylinder/textbook": (6, 1.05),
    "cylinder/cam_groove": (4, 1.05),
}
C_BLENDS = ("polar/cam", "polar/manual_a")  # of which the acceleration is no matter here

metric = kept_machine("lathe_mm")
inch = kept_machine("lathe_inch", tools=MANUAL_TOOLS)


@pytest.fixture
def lathe(metric):
    metric.abort()
    metric.mdi("G21 G90 G94 G40 G8 G64")
    metric.mdi("G0 Z5")
    metric.mdi("G0 X20 C0")
    metric.errors(), metric.messages()
    return metric


@pytest.mark.parametrize("name", SAMPLES)
def test_every_sample_is_cut_as_its_words_ask(request, name):
    units, (times, longer) = "inch" if "manual" in name else "metric", SAMPLES[name]
    machine = request.getfixturevalue(units)
    text = (PROGRAMS / f"{name}.ngc").read_text()
    faster = re.sub(r"\bF([\d.]+)", lambda feed: f"F{times * float(feed[1]):g}", text)
    machine.reset()
    proof = machine.proof_of_run(faster)
    assert proof.finding_codes == []
    for each in proof.sections:
        assert each.deviation <= TOLERANCE[units] + SAMPLING
        assert 0.99 < each.values["seconds"] / each.values["seconds_programmed"] < longer
    axes = proof.program.samples.axes
    assert axes["X"].min() >= -1e-9
    assert np.abs(np.diff(axes["C"])).max() * 1000 <= C_SPEED * 1.001
    if name not in C_BLENDS and not exceeds_limits_itself(machine):
        assert accelerations(axes["C"]).max() <= C_ACCELERATION * 1.01


# ---------------------------------------------------------------- what an operator does


PART = ["G1 X12", "C5", "G3 X-5 C12 I-12 J-5", "G1 X-12 C0", "X15 C0"]
OUTLINE = [
    *lines((20, 0), (12, 0), (12, 5)), *lines((-5, 12), (-12, 0)), *lines((-12, 0), (15, 0)),
]  # fmt: skip


def part(feed="F2500", **around):
    return section(*PART, feed=feed, **around)


def on_the_part(samples):
    """Tell whether every sample lies on the straight blocks or the arc of the part."""
    points = Cut(samples).points
    off = distance(points @ FROM_COLUMNS, OUTLINE)
    return np.minimum(off, np.abs(np.hypot(*points.T) - 13)).max() < 0.006


def test_pause_and_resume(lathe):
    lathe.feed_override(0.1)  # line 8 takes six seconds
    lathe.open_text(part())
    lathe.sample()
    lathe.start()
    lathe.wait_for(lambda status: status.motion_line == 8)
    lathe.pause()
    held = lathe.wait_for(lambda status: status.paused)
    lathe.feed_override(1.0)
    lathe.resume()
    lathe.wait_idle()
    samples = lathe.samples()
    assert held.motion_line == 8
    assert on_the_part(samples)
    assert Cut(samples).points[-1] == pytest.approx((15, 0), abs=1e-6)


def test_single_step_goes_block_by_block(lathe):
    lathe.open_text(part())
    lathe.sample()
    stops = []
    while len(stops) < 400:
        lathe.step()
        status = lathe.stat()
        if status.idle:
            break
        stops.append(status.motion_line)
    samples = lathe.samples()
    assert on_the_part(samples)
    assert {6, 7, 8, 9} <= set(stops)
    assert Cut(samples).points[-1] == pytest.approx((15, 0), abs=1e-6)


@pytest.mark.parametrize("stop", ["(abort,enough)", "(py,raise ValueError)"])
def test_a_comment_that_stops_the_program_leaves_the_programs_modes(stop):
    overrides = {"AXIS_C": {"WRAPPED_ROTARY": "1"}}
    with Machine(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        run = lathe.run_text(section("G1 X2", "G2 I-1", stop, "G1 X3", before=["G64"], feed="F77"))
        assert run.error is not None
        modes = lathe.stat().modes
        assert modes.feed == pytest.approx(77)
        assert "G64" in modes.gcodes
        lathe.mdi("G0 C370")
        assert "wrapped" in lathe.errors()[0].text.lower()


@pytest.mark.parametrize(("start", "cut"), [(6, {7, 8}), (10, {11, 13})])
def test_run_from_a_line_before_and_behind_a_section(lathe, start, cut):
    program = [FIRST, "G0 X20 Z5 C0", "T1 M6", "F1500", "G1 X19", "G12.1", "X15", "C3", "G13.1",
               "G0 X20 C0", "G1 X19", "G12.1", "X15", "G13.1", "G1 X17", "M2"]  # fmt: skip
    lathe.open_text(program)
    lathe.sample()
    lathe.start(start)
    lathe.wait_idle()
    assert lathe.errors() == []
    seen = set(Cut(lathe.samples()).lines.tolist())
    assert cut <= seen
    assert seen <= set(range(start, 17))


def test_nothing_of_a_refused_section_moves_and_mdi_is_refused(lathe):
    for body in (["G1 X15", "X12 X11"], ["G1 X15", "X400"]):
        run = lathe.run_text(section(*body, feed="F1500"))
        assert run.error.text.startswith("G12.1 line 7: ")
        assert not (run.samples.kind == FEED).any()
    assert lathe.run_text(part()).error is None
    lathe.mdi("G12.1")
    assert [error.text for error in lathe.errors()] == [
        "G12.1: is not possible in MDI: it needs the lines after it. Write them into a program,"
        " or into a sub that MDI calls"
    ]
    lathe.mdi("G13.1")
    assert lathe.errors() == []


def test_waiting_for_an_input(lathe):
    choice = ["o1 if [#5399 EQ 1]", "X10", "o1 else", "X14", "o1 endif"]
    body = ["G1 X12", "M66 P0 L3 Q5", *choice, "C3", "M66 P0 L0", "C[3 + 2 * #5399]"]
    lathe.set("motion.digital-in-00", False)
    lathe.open_text(section(*body, feed="F3000"))
    lathe.sample()
    lathe.start()
    lathe.wait_for(lambda status: status.in_position and abs(status.position[0] - 12) < 1e-4)
    lathe.set("motion.digital-in-00", True)
    lathe.wait_idle()
    assert lathe.errors() == []
    assert Cut(lathe.samples()).points[-1] == pytest.approx((10, 5), abs=1e-4)


def test_program_stops_inside(lathe):
    lathe.open_text(section("G1 X12", "M0", "C3", feed="F3000"))
    lathe.start()
    lathe.wait_for(lambda status: status.paused)
    assert lathe.stat().position[0] == pytest.approx(12)
    lathe.resume()
    lathe.wait_idle()
    assert lathe.stat().position[0] == pytest.approx(math.hypot(12, 3), abs=1e-4)


def test_actions_happen_when_the_tool_gets_there(lathe):
    lathe.open_text(section("G1 X12", "M8", "X4", "M9", "X2", feed="F300"))
    lathe.start()
    for on, x in ((True, 12), (False, 4)):  # a pin may be seen late, never before the tool is there
        lathe.wait_for(lambda _, on=on: lathe.get("iocontrol.0.coolant-flood") == on)
        assert lathe.stat().position[0] <= x + 1e-4
    lathe.wait_idle()
    assert not lathe.get("iocontrol.0.coolant-flood")


# ---------------------------------------------------------------- on a cylinder


AROUND = ["G1 Z-8", "C40", "G3 Z-2 C60 R8", "G1 Z-10 C-30", "C0"]
on_cylinder = partial(
    polar_programs.section, start="G0 X22 Z0 C0", tool="T3 M6", feed="F2500", on="G07.1 C20",
    off="G07.1 C0",
)  # fmt: skip


def on_surface(samples):
    """Return where the tool was at feed, on the surface of radius 20."""
    places = np.column_stack([np.radians(samples.axes["C"]) * 20, samples.axes["Z"]])
    return places[np.isin(samples.kind, (FEED, ROUND))]


def test_a_sub_that_mdi_calls_has_the_lines_behind(tmp_path):
    groove = on_cylinder(*AROUND[:2], "M66 P0 L0", *AROUND[2:])[4:-1]
    text = ["o<groove> sub", *groove, "G0 X25", "o<groove> endsub"]
    (tmp_path / "groove.ngc").write_text("\n".join(text) + "\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"../../ngc:subs:{tmp_path}"}}
    with Machine(SIM / "lathe_mm.ini", overrides=paths) as lathe:
        program = lathe.run_text(on_cylinder(*AROUND)).samples
        for block in (FIRST, "T3 M6", "G0 X22 Z0 C0", "F2500"):
            lathe.mdi(block)
        lathe.sample()
        lathe.mdi("o<groove> call")
        samples = lathe.samples()
        lathe.mdi("G0 X30")
        assert lathe.errors() == []
        assert lathe.stat().position[0] == pytest.approx(30)
    assert apart(on_surface(samples), on_surface(program)) <= TOLERANCE["metric"] + SAMPLING


BLENDED = 0.5 * C_ACCELERATION * 1e-3  # within one servo period LinuxCNC adds two segments


@pytest.mark.parametrize(
    ("body", "most"),
    [
        # LinuxCNC joins two that end in G61
        (["G1 C180", "C360", "Z-20", "C180", "C0"], C_SPEED + 1.01 * BLENDED),
        # C would turn at 1400 degrees a second
        (["G1 Z-20 C720", "G3 Z0 R10", "G1 C0"], C_SPEED * 1.001),
    ],
)
def test_more_speed_than_c_has_only_slows_the_way_down(lathe, body, most):
    proof = lathe.proof_of_run(on_cylinder(*body, feed="F30000"))
    assert set(proof.finding_codes) == {"air"}  # on purpose
    assert proof.sections[0].deviation <= TOLERANCE["metric"] + SAMPLING
    assert np.abs(np.diff(proof.program.samples.axes["C"])).max() * 1000 <= most
