# SPDX-License-Identifier: GPL-2.0-or-later
"""One motor as spindle and as C: changes without a jump, threads as before, interlocks."""

import random
import time

import numpy as np
import pytest

from g12.tools.commands.main import main
from support.kinematics import needs_kinematics
from support.operated_machine import Machine, kept_machine
from support.sim_machines import PROGRAMS, SIM, copy_of_machines
from support.spindle_lathe import (
    FIRST,
    FLATS,
    INTERRUPTS,
    SPINDLE_LATHE,
    TEN_CHANGES,
    SpindleLathe,
    angle_of_flat,
    changes_of,
    interrupted,
    jumps,
    motor_jumps,
    pitch_and_start,
    random_changes,
)

PITCH = 1.5
NOT_C = "line 3: needs the spindle as C: M254 first"
HOLE = "[4] [2] [900] [0] [0] [0]"
MOST = 0.05  # degrees


running = kept_machine("lathe_spindle_c_mm", SpindleLathe)


@pytest.fixture
def lathe(running):
    running.abort()
    running.enable()
    for block in ("M255", "G10 L2 P1 X0 Z0 C0", *FIRST):
        running.mdi(block)
    running.errors(), running.messages()
    return running


def as_c(machine):
    machine.mdi("M254")
    assert machine.errors() == []
    assert machine.is_c()


def test_nothing_jumps_at_a_change(lathe):
    samples = lathe.motion_of([*FIRST, *random_changes(seed=3, count=6)])
    on, off = changes_of(samples)
    assert len(on) == len(off) == 6
    changes = [*on, *off]
    assert (jumps(samples, changes) <= [0.0, MOST, MOST]).all()
    assert motor_jumps(samples, changes) <= 0.5
    ahead = np.diff(samples.axes["P"] - samples.axes["T"]) * 360
    slow = np.abs(np.diff(samples.axes["T"])) < 2e-3
    assert np.abs(ahead[slow]).max() <= 1  # the ramp begins where the spindle stands
    assert all(turn_to_c(samples, at) <= 0.55 for at in on)
    standing = np.concatenate([on + 20, off - 1])  # C0 is the index, whatever has happened since
    beside = (samples.axes["T"] - samples.axes["C"] / 360)[standing]
    assert np.abs(beside - np.round(beside)).max() * 360 <= MOST


def turn_to_c(samples, change):
    """Return how many turns the drive's position went before a change, since the spindle stood."""
    turns = samples.axes["T"][:change]
    moving = np.abs(np.diff(turns)) > 1e-6
    stood = np.flatnonzero(~moving[:-1] & moving[1:])[-1]
    return np.ptp(turns[stood:])


def test_threads_and_flats_are_the_same_after_ten_changes(lathe):
    turned = ["S500 M4", "G4 P0.5", "M5"]
    thread = ["S400 M3", "G0 X20 Z5", f"G33 Z-8 K{PITCH}", "G0 X25", "M5"]
    part = [*turned, *thread, *FLATS]
    program = [*FIRST, *TEN_CHANGES[:3], *part, *TEN_CHANGES, *part, "M2"]
    samples = lathe.motion_of(program)
    threads = [number for number, block in enumerate(program, 1) if "G33" in block]
    (before, start), (after, start_after) = (pitch_and_start(samples, at) for at in threads)
    assert before == pytest.approx(PITCH, rel=0.005)
    assert after == pytest.approx(before, rel=0.005)
    assert (start_after - start + 0.5) % 1 - 0.5 == pytest.approx(0, abs=0.01)
    flats = [number for number, block in enumerate(program, 1) if block == "X20 C-20"]
    before, after = (angle_of_flat(samples, line) for line in flats)
    assert before == pytest.approx(0, abs=0.2)
    assert after == pytest.approx(before, abs=MOST)


def test_everything_in_one_program(lathe):
    faced = ["S900 M3", "G0 X24 Z2", "G96 D1500 S60", "G95 F0.5", "G1 Z0", "X4", "G97 S300"]
    thread = ["G0 X22 Z4", "G76 P1.5 Z-8 I-1 J0.4 R1.5 K0.92 Q29.5 H0", "M5", "G94"]
    tap = ["G0 X0 Z5", "S200 M3", "G33.1 Z-1 K1", "M5"]
    program = [*FIRST, *faced, *thread, *FLATS, *tap, *FLATS, "M2"]
    samples = lathe.motion_of(program)
    tapped = samples.line == program.index("G33.1 Z-1 K1") + 1
    turns, z = samples.axes["T"][tapped], samples.axes["Z"][tapped]
    down = np.arange(len(z)) < z.argmin()
    synchronous = down & (z < 3) & (z > 0)
    assert np.ptp(turns[synchronous]) == pytest.approx(3, abs=0.05)


@pytest.mark.parametrize(
    ("program", "refusal"),
    [
        (["G12.1", "G1 X30 F100", "G13.1"], f"G12.1 {NOT_C}"),
        ([f"o<face_holes> call [3] [30] [0] [-9999] {HOLE}"], f"face_holes {NOT_C}"),
        (
            ["M254", "G12.1", "G1 X30 F100", "M255", "G13.1"],
            "G12.1 line 6: M255 line 6: the section needs C to its end",
        ),
        (["M255", "G0 C30"], "Linear move on line 4 would exceed C's positive limit"),
        (["G1 X30 C-30 F100"], "Linear move on line 3 would exceed C's negative limit"),
    ],
)
def test_refused_while_it_is_the_spindle(lathe, program, refusal):
    run = lathe.run_text([*FIRST, *program, "M2"])
    assert run.error.text == refusal
    assert np.ptp(run.samples.axes["C"]) == 0
    assert run.samples.axes["X"][-1] == pytest.approx(40)


def test_a_jog_of_c_does_not_move_the_spindle(lathe):
    lathe.manual()
    lathe.wait_for(lambda status: status.task_mode == "manual")
    stood = lathe.get("axis.c.pos-cmd")
    lathe.jog(5, 20)
    time.sleep(0.3)
    lathe.jog(5, 0)
    assert lathe.get("axis.c.pos-cmd") == pytest.approx(stood, abs=MOST)


@pytest.mark.parametrize("word", ["M3", "M4"])
def test_m3_turns_nothing_while_it_is_c(lathe, word):
    as_c(lathe)
    lathe.open_text([*FIRST, f"S300 {word}", "G1 X30 F3000", "M2"])
    lathe.start()
    lathe.wait_for_error("M3 or M4 while the spindle is C: it does not turn. M5 and C off first")
    time.sleep(0.5)
    assert lathe.errors() == []
    assert abs(lathe.get("spindle-rps")) < 0.001
    assert lathe.get("axis.x.pos-cmd") == pytest.approx(40)
    lathe.abort()
    lathe.mdi("G1 X30 F3000")
    assert lathe.get("axis.x.pos-cmd") == pytest.approx(30)


def test_a_spindle_that_cannot_become_c(tmp_path):
    paths = f"{tmp_path}:../../ngc:subs"
    slow = {
        "SPINDLE_C": {"INDEX_SPEED": 0, "TIMEOUT": 1},
        "RS274NGC": {"SUBROUTINE_PATH": paths},
    }
    with Machine(SPINDLE_LATHE, overrides=slow) as machine:
        machine.mdi("M254")
        rule = (
            "the spindle did not become C within 1 s: it has to stop, to find its index and "
            "to reach the angle of C (spindle_c.md)"
        )
        assert machine.errors()[0].text == f"M254: {rule}"
        assert not machine.get("spindle-c-holds")
        assert not machine.get("spindle.0.orient")
        (tmp_path / "change.ngc").write_text("o<change> sub\n\nM254\no<change> endsub\n")
        for text, line in (
            ("G21 G90\nM254\nM2", "2"),
            ("G21\no<s> sub\n(to C)\nM254\no<s> endsub\no<s> call\nM2", "4"),
            ("G21\no<change> call\nM2", "3 of change.ngc"),
        ):
            assert machine.run_text(text.splitlines()).error.text == f"M254 line {line}: {rule}"


@pytest.mark.parametrize("interrupt", INTERRUPTS)
def test_interrupted_at_any_time(lathe, interrupt):
    chance = random.Random(interrupt)
    for _ in range(2):
        interrupted(lathe, interrupt, chance)


def test_feed_per_revolution_of_the_live_tool(lathe):
    section = ["G12.1", "G1 C10 F0.1", "X30", "G13.1"]
    start = ["M254", "G0 X40 C0", "S2000 M33", "S2000 G95 $1"]
    samples = lathe.motion_of([*FIRST, *start, *section, "G94", "M5 $1", "M255", "M2"])
    line = len(FIRST) + len(start) + 3
    cut = samples.line == line
    x, c, seconds = samples.axes["X"][cut], samples.axes["C"][cut], samples.time[cut]
    moved = abs(np.diff(x * np.exp(1j * np.radians(c)))) / np.diff(seconds)
    assert np.median(moved) * 60 == pytest.approx(200, rel=0.1)


def test_holes_with_the_live_tool(lathe):
    """The tap follows the live tool's spindle; the encoder of C is where the holes are."""
    face = "o<face_holes> call [3] [30] [20] [-9999] [4] [2] [1200] [1.5] [0.1] [0]"
    side = "o<side_holes> call [2] [-10] [30] [-9999] [40] [4] [2] [1200] [-2] [0] [0]"
    tap = "o<face_hole_at> call [10] [0] [3] [2] [1] [0] [0] [1]"
    start = ["M254", "G0 X40 Z5 C0", "S300 M3 $1", face, "G0 X40", side, "G0 Z5"]
    samples = lathe.motion_of([*FIRST, "T1 M6", *start, tap, "M5 $1", "M255", "M2"])
    line, axes = samples.line, samples.axes
    low = axes["Z"] < -3.998
    angles = 360 * axes["T"][low & (axes["X"] > 14.9) & (axes["X"] < 15.1)]
    assert {round(angle) % 360 for angle in angles} == {20, 140, 260}
    deep = axes["X"] < 16.002
    sides = 360 * axes["T"][deep & (np.abs(axes["Z"] + 10) < 0.01)]
    assert {round(angle) % 360 for angle in sides} == {30, 210}
    inside = (axes["Z"][1:] < 1.99) & (axes["Z"][1:] > -9) & (axes["X"][1:] < 20)
    assert np.abs(np.diff(axes["C"])[inside]).max() < 1e-6
    tapped = axes["Z"][np.abs(axes["X"] - 10) < 1e-3]
    assert tapped.min() == pytest.approx(-3, abs=0.2)
    assert line.max() > 0


def test_an_abort_in_a_hole_leaves_the_spindle_as_c_and_the_modes(lathe):
    holes = "o<face_holes> call [3] [30] [20] [-9999] [4] [2] [120] [0] [0] [0]"
    start = [*FIRST, "T1 M6", "M254", "G7 G0 X80 Z5 C0"]
    lathe.open_text(["%", *start, *[holes] * 200, "%"])  # LinuxCNC is still reading holes
    lathe.start()
    lathe.wait_for(lambda status: status.position[2] < 0)
    lathe.abort()
    held = lathe.stat()
    assert held.position[2] > -4 and lathe.is_c() and lathe.errors() == []
    lathe.mdi("G4 P0")
    modes = lathe.stat().modes
    assert {"G7", "G64", "G90", "G94"} <= set(modes.gcodes) and modes.blending[0] == 0.01
    for block in ("G0 Z5", holes.replace("[120]", "[6000]"), "M255"):
        lathe.mdi(block)
    assert lathe.errors() == [] and not lathe.is_c()


def test_the_manuals_program_switches_c_on_by_m35():
    with SpindleLathe(SIM / "lathe_spindle_c_inch.ini") as machine:
        machine.feed_override(4.0)  # it cuts at 5 inches a minute
        run = machine.run(PROGRAMS / "polar" / "manual_a.ngc")
        assert run.error is None
        assert np.abs(run.samples.axes["E"]).max() < 1
        assert machine.is_c()


PINS = """\
velocity = "drive-input.in0"
position = "drive-pid.command"
holds = "drive-input.sel"
orient_speed = 1
orient_acceleration = 4
index_speed = 0.5
"""
PLAIN = """\
net spindle-cmd spindle.0.speed-out-rps => drive-input.in0
net spindle-at-speed drive-reached.out => spindle.0.at-speed
net c-follows joint.2.motor-pos-cmd => joint.2.motor-pos-fb
setp drive-pid.enable true
"""


def plain_lathe(folder):
    """Return the INI of a lathe with a spindle, a C axis that moves nothing, and no package."""
    sim = copy_of_machines(folder)
    drive = (sim / "spindle_drive.hal").read_text().splitlines()
    ours = ("spindle-c-", "sc-", "drive-reached.out", "drive-holds")
    kept = [line for line in drive if not (line.startswith("net") and any(o in line for o in ours))]
    joints = (sim / "spindle_joints.hal").read_text()
    commanded = "net spindle-cmd => drive-reached.in1\n"
    (sim / "plain.hal").write_text("\n".join([joints, *kept, PLAIN, commanded]))
    text = (sim / "lathe_spindle_c_mm.ini").read_text()
    machine = text[text.index("[TASK]") : text.index("[SPINDLE_C]")] + text[text.index("[EMCIO]") :]
    lines = [line for line in machine.splitlines() if not line.startswith(("HALFILE", "HALCMD"))]
    hal = "\n".join(lines).replace("[HAL]", "[HAL]\nHALFILE = plain.hal")
    ini = sim / "plain.ini"
    screen = "[EMC]\nVERSION = 1.1\n[DISPLAY]\nDISPLAY = axis\nGEOMETRY = CXZ!\n"
    interpreter = "[RS274NGC]\nPARAMETER_FILE = plain.var\n"
    ini.write_text(screen + interpreter + hal + "\n")
    return ini


def test_installed_on_a_plain_lathe(tmp_path):
    ini, pins = plain_lathe(tmp_path), tmp_path / "spindle.toml"
    before = ini.read_bytes()
    pins.write_text(PINS)
    options = ["--with", "polar", "spindle-c", "--pins", str(pins)]
    assert main(["install", str(ini), *options]) == 0
    assert main(["check", str(ini)]) == 0
    with Machine(ini) as machine:
        machine.motion_of([*FIRST, "S300 M3", "G4 P1", *FLATS, "S300 M3", "G33 Z-5 K1", "M2"])
        machine.mdi("M254")
        assert machine.get("spindle-c-on")
        machine.mdi("G0 C90")
        assert machine.get("encoder-turns.out") % 1 == pytest.approx(0.25, abs=1e-3)
    assert main(["install", str(ini), *options]) == 0  # again: nothing
    assert main(["uninstall", str(ini)]) == 0
    assert ini.read_bytes() == before


@needs_kinematics
def test_installed_with_the_kinematics_of_the_face(tmp_path):
    ini, pins = plain_lathe(tmp_path), tmp_path / "spindle.toml"
    pins.write_text(PINS)
    features = ["polar", "polar-kinematics", "spindle-c"]
    assert main(["install", str(ini), "--with", *features, "--pins", str(pins)]) == 0
    with Machine(ini) as machine:
        machine.motion_of([*FIRST, *FLATS, "S300 M3", "G33 Z-5 K1", "M5", *FLATS, "M2"])
        for block in ("M254", "G0 X20 C90", "M255"):
            machine.mdi(block)
        assert machine.errors() == []
        assert not machine.get("motion.digital-in-03")
