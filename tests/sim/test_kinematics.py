# SPDX-License-Identifier: GPL-2.0-or-later
"""The face's kinematics in a headless LinuxCNC: real motion, and no way into the wrong world."""

import random
import re
import time

import numpy as np
import pytest

from support.kinematics import keeps_its_limits, needs_kinematics, on_the_face, place
from support.operated_machine import Machine, kept_machine
from support.polar_programs import (
    C_ACCELERATION,
    FEED,
    ROUND,
    accelerations,
    exceeds_limits_itself,
)
from support.sim_machines import PROGRAMS, SIM

pytestmark = needs_kinematics

X, Y = 0, 1
ON = ("M68 E2 Q0", "M68 E3 Q0", "M68 E3 Q1", "M66 P3 L3 Q10", "G17")
OFF = ("M68 E3 Q0", "M66 P3 L4 Q10", "G18")
START = ("G21 G18 G8 G90 G94 G64 P0.002 Q0", "G0 X25 Z2 C0")
SECTION = (
    *START, "G12.1", "G1 X25 C20 F6000", "X-25", "C-20", "G3 X25 C-20 R25", "X25 C0 R15", "G1 X20",
    "X-20", "C25", "X25", "C0", "G13.1", "G0 Z5", "M2",
)  # fmt: skip
CIRCLE_NEAR = ["G21 G18 G8 G90 G94 G64", "G0 X30 Z2 C0", "G12.1", "G3 I-10 F3000", "G13.1", "M2"]
IN_INCHES = (
    "G20 G7 G18 G90 G94 G64 P0.0002", "F100", "G0 X2 Z0 C0", "G12.1", "G1 X2 C1", "G3 X0 C1.5 R2",
    "G1 X-2 C0", "G13.1", "M2",
)  # fmt: skip


running = kept_machine("lathe_mm_kinematics")


@pytest.fixture
def lathe(running):
    running.abort()
    for block in (*OFF, "G21 G90 G94 G40 G8 G64", "G0 Z5", "G0 X20 C30"):
        running.mdi(block)
    running.errors(), running.messages()
    return running


def test_y_is_refused_off_the_face(lathe):
    lathe.mdi("G0 Y1")
    lathe.wait_for_error("Y moves only on the face")
    assert place(lathe) == (20, 0, 30)


def slide_and_spindle(machine):
    return pytest.approx([machine.get(f"joint.{joint}.pos-cmd") for joint in (0, 2)], abs=1e-6)


def type_each(machine, *blocks):
    """Type blocks that move and are no errors."""
    for block in blocks:
        machine.mdi(block)
        said = machine.errors()
        assert not said, (block, said)


def test_lines_of_mdi_move_on_the_face_until_g13_1(lathe):
    type_each(lathe, "G0 X40 C30", *ON, "G1 X20 Y20 F3000")
    assert place(lathe) == (20, 20, 30)
    assert slide_and_spindle(lathe) == [800**0.5, 75]
    type_each(lathe, "G3 X-20 I-20 J-20", "G91 G1 X-10", "G90 G0 X-30 Y0")
    assert slide_and_spindle(lathe) == [30, 210]
    type_each(lathe, "G13.1", "G18")
    assert not on_the_face(lathe)
    assert place(lathe) == (30, 0, 210)


def test_nothing_but_x_y_and_z_moves_on_the_face_by_hand(lathe):
    type_each(lathe, *ON, "G1 X20 Y10 F3000")
    lathe.mdi("C5")
    lathe.wait_for_error("C does not move by itself on the face")
    lathe.wait_for(lambda _: not on_the_face(lathe))
    lathe.settle()
    lathe.errors()  # of motion, which LinuxCNC may report after that of the kinematics
    type_each(lathe, "G13.1", *ON)
    lathe.manual()
    lathe.wait_for(lambda status: status.task_mode == "manual")
    lathe.jog(X, 10)
    time.sleep(0.2)
    lathe.jog(X, 0)
    lathe.wait_for_error("jog-inhibit")
    type_each(lathe, "G13.1", "G18", "G0 X22 C10")
    assert place(lathe) == (22, 0, 10)


def test_a_program_on_the_face_by_hand_needs_g13_1_first(lathe):
    type_each(lathe, *ON, "G1 X20 Y20 F3000")
    run = lathe.run_text(["G12.1", "G1 X10", "G13.1", "M2"])
    assert run.error.text == "G12.1 line 1: the face is on already, by hand: G13.1 first"
    type_each(lathe, "G13.1", *ON, "G1 X20 Y20 F3000")
    samples = lathe.motion_of(["G13.1", "G18 G90 G94", "G1 X30 Z1 F1000", "G1 X20", "M2"])
    assert set(samples.line[samples.moving()]) == {3, 4}
    assert not on_the_face(lathe)


# ---------------------------------------------------------------- G12.1


def test_adaptive_feed_ends_with_the_face_at_a_limit_switch(lathe):
    """The machine goes off: LinuxCNC aborts twice, and drops what the first abort has queued."""
    start_on_the_face(lathe, SECTION)
    lathe.set("joint.0.pos-lim-sw-in", 1)
    lathe.wait_for(lambda status: not status.enabled)
    lathe.set("joint.0.pos-lim-sw-in", 0)
    lathe.enable()
    lathe.errors()
    type_each(lathe, "G0 Z6")
    assert not lathe.stat().adaptive


@pytest.mark.parametrize("name", ["slot", "circles"])
def test_g12_1_is_on_the_contour_and_within_the_limits(lathe, name):
    text = (PROGRAMS / "polar" / f"{name}.ngc").read_text()
    fast = re.sub(r"\bF([\d.]+)", lambda word: f"F{3 * float(word[1]):g}", text)
    proof = lathe.proof_of_run(fast)
    samples = proof.program.samples
    assert proof.findings == [] and proof.sections[0].deviation <= 0.006
    keeps_its_limits(samples)
    assert not on_the_face(lathe)
    if not exceeds_limits_itself(lathe):
        cutting = np.isin(samples.kind, (FEED, ROUND))
        assert accelerations(samples.axes["C"])[cutting[2:]].max() <= C_ACCELERATION * 1.01


def test_a_long_move_beside_the_pole_is_segments_only_near_it(lathe):
    samples = lathe.motion_of([*ROUGHLY, "G1 X10 C-60 F3000 G61", "C60", "X45 C0", "G13.1", "M2"])
    beside = samples.line == 5
    x, c = samples.axes["X"], np.radians(samples.axes["C"])
    assert np.abs(x * np.cos(c) - 10)[beside].max() <= 0.006
    assert beside.sum() * 0.001 <= 4.9  # 4.05 s on a quiet computer; segments alone take 5.5 s
    keeps_its_limits(samples)
    if not exceeds_limits_itself(lathe):
        assert np.abs(np.diff(c, 2)).max() * 1e6 <= np.radians(3600) * 1.01


def test_g12_1_with_offsets_inches_and_diameters(lathe):
    lathe.mdi("G10 L2 P1 X40 Y-7 Z3 C20")
    try:
        run = lathe.run_text(IN_INCHES)
    finally:
        lathe.mdi("G21 G8")
        lathe.mdi("G10 L2 P1 X0 Y0 Z0 C0")
    assert run.error is None
    points = (run.samples.axes["X"] - 40) * np.exp(1j * np.radians(run.samples.axes["C"] - 20))
    corners = 25.4 * np.array([1, 1 + 1j, 1.5j, -1])
    off = np.abs(points[:, None] - corners).min(axis=0)
    assert off == pytest.approx([0] * 4, abs=0.02)


CORNERS = np.array([40 + 30j, -40 + 30j, -40 - 30j, 40 - 30j])
SQUARE = ["G1 X40 C30 F6000", "X-40", "C-30", "X40", "C0"]
ROUGHLY = ["G21 G18 G8 G90 G94 G64 P0.05 Q0", "G0 X45 Z2 C0", "G12.1"]


def off_the_corners(samples):
    """Return by how much each corner was cut, in mm."""
    points = samples.axes["X"] * np.exp(1j * np.radians(samples.axes["C"]))
    return np.abs(points[:, None] - CORNERS).min(axis=0)


@pytest.mark.parametrize(
    ("exact", "sharp"),
    [("", [0, 0, 0, 0]), ("G61.1", [1, 1, 1, 1]), ("G9", [0, 1, 0, 0])],
)
def test_exact_paths_and_stops_on_the_face(lathe, exact, sharp):
    square = [SQUARE[0], f"G9 {SQUARE[1]}", *SQUARE[2:]] if exact == "G9" else [exact, *SQUARE]
    samples = lathe.motion_of([*ROUGHLY, *square, "G13.1", "M2"])
    assert (off_the_corners(samples) < 0.001).tolist() == [bool(corner) for corner in sharp]
    assert off_the_corners(samples).max() <= 0.052  # G64 P0.05


def test_blocks_that_wait_cut_a_section_in_two(lathe):
    waiting = [line for block in SQUARE for line in (block, "M66 P0 L0")]
    samples = lathe.motion_of([*ROUGHLY, *waiting, "G13.1", "M2"])
    assert off_the_corners(samples).max() <= 0.001
    assert place(lathe) == (40, 0, 360)


def test_pause_on_the_face(lathe):
    lathe.open_text([*ROUGHLY, *SQUARE, "G13.1", "M2"])
    lathe.start()
    lathe.wait_for(lambda status: status.motion_line == 5)
    lathe.pause()
    lathe.wait_for(lambda _: lathe.get("motion.current-vel") == 0)
    lathe.settle()  # the joints' way is smoothed
    lathe.sample()
    time.sleep(0.2)
    assert max(np.ptp(way) for way in lathe.samples().axes.values()) < 1e-9
    assert on_the_face(lathe)
    lathe.resume()
    lathe.wait_idle()
    assert lathe.errors() == []
    assert place(lathe) == (40, 0, 360)


def test_single_steps_on_the_face(lathe):
    lathe.open_text([*ROUGHLY, *SQUARE, "G13.1", "G0 Z5", "M2"])
    stood = []
    heights = []
    for _ in range(40):
        lathe.step()
        status = lathe.stat()
        stood.append(complex(status.position[X], status.position[Y]))
        heights.append(status.position[2])
        if 2 in heights and heights[-1] == 5:  # after G13.1, no longer where it starts from
            break
    assert np.abs(np.array(stood)[:, None] - CORNERS).min(axis=0).max() <= 0.001
    assert lathe.errors() == []
    assert not on_the_face(lathe)


RUN_FROM = [*ROUGHLY, *SQUARE, "G13.1", "G0 Z5", "M2"]


def test_run_from_line_runs_the_section_where_it_begins(lathe):
    lathe.mdi("G0 X45 Z2 C0")
    lathe.open_text(RUN_FROM)
    lathe.sample()
    lathe.start(6)
    lathe.wait_for(lambda status: status.position[2] == 5)
    lathe.wait_idle()
    samples = lathe.samples()
    assert lathe.errors() == []
    assert samples.line[samples.moving()][0] == 4
    assert off_the_corners(samples).max() <= 0.052
    assert not on_the_face(lathe)


FROM_IN_INCHES = [
    "G20 G18 G8 G64 P0.002 Q0", "G0 X1.7716535433 Z.0787401575 C0", "F60", "G12.1", "G1 X1.2",
    "C-.5", "G13.1", "G0 Z.2", "M2",
]  # fmt: skip


@pytest.mark.parametrize(
    ("program", "away"),
    [(RUN_FROM, "C1"), (FROM_IN_INCHES, "X45.005"), (FROM_IN_INCHES, "Z2.02")],
)
def test_run_from_line_is_refused_elsewhere(lathe, program, away):
    lathe.mdi("G21 G0 X45 Z2 C0")
    lathe.mdi(f"G0 {away}")
    lathe.open_text(program)
    lathe.sample()
    lathe.start(6)
    lathe.wait_for_error("the tool is not where the section begins")
    assert not lathe.samples().moving().any()
    assert not on_the_face(lathe)


def start_on_the_face(machine, program):
    """Start a program and wait until its section is on the face."""
    machine.open_text(program)
    machine.start()
    machine.wait_for(lambda _: on_the_face(machine))


def face_accelerations(machine):
    return [machine.get(f"ini.{axis}.max_acceleration") for axis in "xy"]


@pytest.mark.parametrize("mode", ["mdi_mode", "manual"])
def test_an_abort_leaves_the_face_and_what_belongs_to_it(lathe, mode):
    """Also where the operator changes the mode at once, which drops what the abort has queued."""
    lathe.sample()
    start_on_the_face(lathe, ("M52 P1", *CIRCLE_NEAR))
    # round the circle the slide needs some of its acceleration
    lathe.wait_for(lambda _: face_accelerations(lathe) < [707, 707])
    lathe.abort(mode == "manual")
    getattr(lathe, mode)()
    lathe.wait_for(lambda _: not on_the_face(lathe))
    lathe.mdi("G4 P0")
    lathe.wait_for(lambda _: face_accelerations(lathe) == [707, 707])
    if mode == "manual":
        lathe.wait_for(lambda now: "M52" in now.modes.mcodes)
    lathe.mdi("M52 P0")
    lathe.mdi("G0 X22 C10")
    assert place(lathe) == (22, 0, 10)
    keeps_its_limits(lathe.samples())
    lathe.motion_of(CIRCLE_NEAR)
    assert not on_the_face(lathe)


def test_a_section_that_fails_leaves_the_acceleration_of_the_ini(lathe):
    """A block that cannot be executed between the moves, and moves that are refused."""
    by_m68 = [*START, *ON, "G1 X20 Y10 F3000", "G1 X400", *OFF]
    section = CIRCLE_NEAR[:-2]
    for program in ([*section, "M66 P77 L0"], [*section, "G1 X400"], by_m68):
        run = lathe.run_text([*program, "G1 X30", *CIRCLE_NEAR[-2:]])
        assert run.error
        lathe.wait_for(lambda _: face_accelerations(lathe) == [707, 707])
        assert not on_the_face(lathe)
        lathe.errors()
        lathe.mdi("G0 X22 C10")
        assert place(lathe) == (22, 0, 10)


@pytest.mark.parametrize(
    ("own", "inside", "free"), [("M52 P1", "M52 P0", True), ("M52 P0", "M52 P1", False)]
)
def test_m52_between_moves_on_the_face_acts_until_the_next_change(lathe, own, inside, free):
    section = [*CIRCLE_NEAR[:2], own, "G12.1", "G3 I-10 F2000", inside, "G3 I-10", "G13.1", "M2"]
    lathe.feed_override(2.0)
    lathe.sample()
    start_on_the_face(lathe, section)
    lathe.wait_idle()
    lathe.feed_override(1.0)
    samples = lathe.samples()
    speeds, lines = samples.velocity, samples.line
    most = lathe.get("polar-xzc.most-override") * 2000 / 60
    assert speeds[lines == 5].max() == pytest.approx(most, rel=0.01)
    assert (speeds[lines == 7].max() > 1.5 * most) == free
    assert ("M52" in lathe.stat().modes.mcodes) is (own == "M52 P1")
    lathe.mdi("M52 P0")


def test_the_feed_is_turned_up_as_far_as_c_follows(lathe):
    lathe.feed_override(2.0)
    start_on_the_face(lathe, [*CIRCLE_NEAR[:-2], *["G3 I-10"] * 4, *CIRCLE_NEAR[-2:]])
    lathe.wait_for(lambda _: lathe.get("motion.current-vel") > 49)
    most = lathe.get("polar-xzc.most-override")
    assert 1.0 <= most < 1.2
    lathe.wait_for(lambda _: lathe.get("motion.current-vel") == pytest.approx(50 * most))
    lathe.wait_for(lambda _: lathe.get("polar-xzc.feed") == pytest.approx(most / 2.0))
    lathe.feed_override(0.5)
    lathe.wait_for(lambda _: lathe.get("motion.current-vel") == pytest.approx(25))
    lathe.feed_override(1.0)
    lathe.wait_idle()
    assert lathe.errors() == []


def test_c_and_the_slide_keep_their_limits_at_any_override():
    """Where C is slow, the operator turns the feed up and down while it is cut."""
    chance = random.Random(3)
    with Machine(SIM / "lathe_slow_c_mm_kinematics.ini") as machine:
        for feed in (2000, 3000):
            circle = [block.replace("F3000", f"F{feed}") for block in CIRCLE_NEAR]
            start_on_the_face(machine, circle)
            machine.sample()
            while on_the_face(machine):
                machine.feed_override(chance.choice([0.5, 1.0, 1.5]))
                time.sleep(0.1)
            c, x = (machine.samples().axes[axis] for axis in "CX")
            machine.wait_idle()
            assert np.abs(np.diff(c)).max() * 1e3 <= 90 * 1.001
            if not exceeds_limits_itself(machine):
                assert np.abs(np.diff(c, 2)).max() * 1e6 <= 1200 * 1.001
                assert np.abs(np.diff(x, 2)).max() * 1e6 <= 1500 * 1.001


def test_a_switch_that_does_not_come_is_refused_after_the_time_that_the_ini_says():
    """Nothing drives the guard."""
    own = {"HAL": {"HALFILE": "three_joints.hal"}, "G12": {"POLAR_SWITCH_TIME": "0.5"}}
    with Machine(SIM / "lathe_mm_kinematics.ini", overrides=own) as machine:
        run = machine.run_text(CIRCLE_NEAR)
        assert "did not change its kinematics within 0.5 s" in run.error.text
        assert run.seconds < 3
        assert face_accelerations(machine) == [707, 707]
