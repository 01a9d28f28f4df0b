# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 in MDI with kinematics: X and Y move on the face, and nothing else does."""

import random
import time

import numpy as np
import pytest

from support.kinematics import (
    ENDED,
    interrupted_by_hand,
    joints_of,
    needs_kinematics,
    on_the_face,
    place,
    refused_for,
)
from support.kinematics import type_each as typed
from support.operated_machine import kept_machine

pytestmark = needs_kinematics

X = 0
C_SPEED, SLIDE = 360, 1000
STANDING = ("G13.1", "G40", "M52 P0", "G21 G18 G8 G90 G94 G64 P0.01", "G10 L2 P1 X0 Y0 C0")
PROGRAM = ["G18 G90 G94", "G1 X30 Z1 F1000", "G1 X20", "M2"]


running = kept_machine("lathe_mm_kinematics")


@pytest.fixture
def lathe(running):
    running.abort()
    for block in (*STANDING, "G0 Z5", "G0 X40 C30"):
        running.mdi(block)
    running.errors(), running.messages()
    return running


@pytest.mark.parametrize("how", ["abort", "estop", "off"])
def test_adaptive_feed_ends_with_the_face_however_that_ends(lathe, how):
    """Where the machine is off, LinuxCNC aborts twice and drops what the first abort queued."""
    typed(lathe, "G12.1")
    assert lathe.stat().adaptive
    getattr(lathe, how)()
    lathe.enable()
    typed(lathe, "G13.1", "G1 X38 F1000")
    assert not lathe.stat().adaptive


def test_adaptive_feed_ends_with_a_section_that_a_limit_switch_ends(lathe):
    lathe.open_text(["G18 G90 G94 F100", "G12.1", "G1 X20 C5 F100", "X-20", "G13.1", "M2"])
    lathe.start()
    lathe.wait_for(lambda _: on_the_face(lathe))
    lathe.set("joint.0.pos-lim-sw-in", 1)
    lathe.wait_for(lambda status: not status.enabled)
    lathe.set("joint.0.pos-lim-sw-in", 0)
    lathe.enable()
    assert [error.text for error in lathe.errors()] == ["joint 0 on limit switch error"]
    typed(lathe, "G0 Z6")
    assert not lathe.stat().adaptive


def slide_and_spindle(machine):
    return pytest.approx([machine.get(f"joint.{joint}.pos-cmd") for joint in (0, 2)], abs=1e-6)


def test_lines_move_on_the_face_until_g13_1(lathe):
    found = lathe.stat().modes
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    assert place(lathe) == (20, 20, 30)
    assert slide_and_spindle(lathe) == [800**0.5, 75]
    typed(lathe, "G3 X-20 I-20 J-20", "G91 G1 X-10", "G90 G0 X-30 Y0")
    assert slide_and_spindle(lathe) == [30, 210]
    typed(lathe, "G13.1")
    assert not on_the_face(lathe)
    assert place(lathe) == (30, 0, 210)
    there = lathe.stat().modes
    assert set(there.gcodes) - {"G0"} == set(found.gcodes) - {"G0"}
    assert there.mcodes == found.mcodes
    typed(lathe, "G0 X40 C30")
    assert place(lathe) == (40, 0, 30)


def test_offsets_diameters_and_inches(lathe):
    typed(lathe, "G10 L2 P1 X10 C20", "G20 G7", "G0 X2", "G12.1", "G1 X0 Y1 F100", "G13.1")
    assert slide_and_spindle(lathe) == [35.4, 120]
    typed(lathe, "G21 G8", "G10 L2 P1 X0 C0")


def test_c_and_the_slide_can_follow_near_the_centre(lathe):
    typed(lathe, "G12.1", "G0 X8 Y-3")
    lathe.sample()
    typed(lathe, "G0 X-8 Y-3")
    axes = lathe.samples().axes
    x, c = axes["X"], np.radians(axes["C"])
    assert np.abs(np.diff(c)).max() * 1e3 <= np.radians(C_SPEED) * 1.001
    assert np.abs(np.diff(x, 2)).max() * 1e6 <= SLIDE * 1.01
    assert np.abs(x * np.sin(c - np.radians(30)) + 3).max() <= 0.002


def test_a_jog_is_refused(lathe):
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    lathe.manual()
    lathe.wait_for(lambda status: status.task_mode == "manual")
    lathe.jog(X, 10)
    time.sleep(0.2)
    lathe.jog(X, 0)
    lathe.wait_for_error("jog-inhibit")
    goes_on_only_behind_g13_1(lathe)
    assert slide_and_spindle(lathe) == [800**0.5, 75]


def test_a_program_does_not_move_there(lathe):
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    lathe.open_text(PROGRAM)
    lathe.sample()
    lathe.start()
    time.sleep(0.5)
    lathe.abort()
    assert np.ptp(lathe.samples().axes["X"]) <= 0.005
    lathe.wait_for(lambda _: not on_the_face(lathe))
    lathe.errors()
    assert ENDED in lathe.run_text(["G1 Z4 F1000", *PROGRAM]).error.text
    samples = lathe.motion_of(["G13.1", "G1 Z4 F1000", *PROGRAM])
    assert np.ptp(samples.axes["C"]) == 0


def test_a_program_ends_it_by_g13_1(lathe):
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    samples = lathe.motion_of(["G13.1", *PROGRAM])
    assert place(lathe) == (20, 0, 75)
    assert set(samples.line[samples.moving()]) == {3, 4}


def test_a_section_is_refused_there(lathe):
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    run = lathe.run_text(["G12.1", "G1 X10", "G13.1", "M2"])
    assert run.error.text == "G12.1 line 1: the face is on already, by hand: G13.1 first"


@pytest.mark.parametrize(
    ("blocks", "refusal"),
    [
        (["G12.1", "G12.1"], "G12.1: is already on"),
        (["G0 X0", "G12.1"], "G12.1: needs the tool at X above zero, not at 0 (radius)"),
        (
            ["G10 L2 P1 Y1", "G12.1"],
            "G12.1: needs an offset of 0 in Y in MDI: its Y0 is the spindle's axis",
        ),
        (["G12.1 X3"], "G12.1: must be alone in its block"),
    ],
)
def test_refused(lathe, blocks, refusal):
    typed(lathe, *blocks[:-1])
    lathe.mdi(blocks[-1])
    assert lathe.errors()[0].text == refusal


ON_THE_LATHE = ["G1 X20 C10", "C5", "G41.1 D4", "G42 D1", "G18", "M52 P0", "G92 X5", "G55", "G28"]


@pytest.mark.parametrize("line", ON_THE_LATHE)
def test_what_is_not_for_the_face_is_refused(lathe, line):
    typed(lathe, "G12.1", "G1 X20 Y20 F3000")
    lathe.mdi(line)
    lathe.wait_for(lambda _: not on_the_face(lathe))
    refused_for(lathe, ["C does not move by itself on the face", "cutter radius comp"])
    off = "G12.1 is off: nothing moves by program or MDI until G13.1 or G12.1 is typed"
    lathe.wait_for(lambda _: off in [message.text for message in lathe.messages()], timeout=5)
    assert slide_and_spindle(lathe) == [800**0.5, 75]
    goes_on_only_behind_g13_1(lathe)
    assert slide_and_spindle(lathe) == [800**0.5, 75]
    assert "G18" in lathe.stat().modes.gcodes


def test_m2_ends_it(lathe):
    typed(lathe, "G12.1")
    lathe.mdi("G1 X20 Y20 F1000", wait=False)
    time.sleep(0.3)
    typed(lathe, "M2", "G13.1", "G18")
    lathe.wait_for(lambda now: not on_the_face(lathe) and "G18" in now.modes.gcodes)
    stood = joints_of(lathe)[::2]
    typed(lathe, "G0 Z4")
    assert slide_and_spindle(lathe) == stood


def goes_on_only_behind_g13_1(lathe):
    stood = joints_of(lathe)
    lathe.mdi("G0 X30 Z4")
    refused_for(lathe, [ENDED])
    assert joints_of(lathe) == stood
    typed(lathe, "G13.1", "G0 Z4")


@pytest.mark.parametrize("seed", [1, 5, 10, 15])  # abort, error; in motion: e-stop, abort
def test_random_interrupts(lathe, seed):
    interrupted_by_hand(lathe, random.Random(seed))


def test_an_abort_with_compensation_on(lathe):
    typed(lathe, "T1 M6", "G41.1 D4 L3", "G1 X50 Z3 F300")
    lathe.mdi("G1 X90", wait=False)
    time.sleep(0.2)
    lathe.abort()
    assert lathe.errors() == []
    typed(lathe, "G40", "G0 X40")
