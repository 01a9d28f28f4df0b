# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 cut by a headless LinuxCNC: the real motion, in AUTO, MDI, paused, stepped, aborted."""

import numpy as np
import pytest

from support.contour_geometry import apart
from support.operated_machine import Machine, kept_machine
from support.refusals import at_line
from support.sim_machines import BRISK, SIM, machine_scope

TOOLS = {1: 6.0, 2: 10.0}
FIRST = "G21 G17 G40 G49 G54 G61 G80 G90 G91.1 G94 F8000"
POCKET = "G13 X10 Y5 I5 K12 Q3 Z-1 D1"
DEVIATION = 0.002  # mm, of the real motion in exact path mode at this feed


machine = kept_machine("mill_mm", tools=TOOLS, overrides=BRISK)


@pytest.fixture(autouse=True)
def at_start(machine):
    machine.mdi("G21 G90 G94 G61 G0 Z2")
    machine.mdi("G0 X0 Y0")
    machine.errors(), machine.messages()


PROGRAM = [FIRST, "T1 M6", "G0 X0 Y0 Z2", POCKET, "G0 Z2", "M2"]


@pytest.fixture(scope=machine_scope)
def auto(machine):
    """Return the motion of a program with the pocket, in which verify finds nothing wrong."""
    proof = machine.proof_of_run(PROGRAM)
    assert proof.findings == []
    assert proof.pockets[0].values["off_circles"] < DEVIATION
    return cut(proof.program.samples)


def cut(samples):
    """Return where the tool was at feed: X and Y."""
    feeding = np.isin(samples.kind, (2, 3))
    return np.column_stack([samples.axes["X"], samples.axes["Y"]])[feeding]


def test_single_steps_reach_the_end(machine, auto):
    machine.open_text(PROGRAM)
    machine.sample()
    steps = 0
    machine.step()
    while not machine.stat().idle:
        machine.step()
        steps += 1
        assert steps < 200
    assert steps > 5
    assert machine.errors() == []
    assert apart(cut(machine.samples()), auto) < DEVIATION


def started(machine):
    """Run the program until it is in the rings, where it stays for some seconds."""
    machine.feed_override(0.1)
    machine.open_text(PROGRAM)
    machine.sample()
    machine.start()
    machine.wait_for(lambda status: status.position[2] < 0 and status.position[0] > 14)


def test_abort_then_mdi_then_the_program_again_with_a_pause(machine, auto):
    started(machine)
    machine.abort()
    machine.feed_override(1.0)
    machine.samples(), machine.errors()
    for block in ("G0 Z3", "G12 I5 Z1 D1 F4000", "G0 Z3", "G0 X0 Y0 Z2"):
        machine.mdi(block)
    assert machine.errors() == []
    started(machine)
    machine.pause()
    machine.wait_for(lambda status: status.paused)
    machine.feed_override(1.0)
    machine.resume()
    machine.wait_idle()
    assert machine.errors() == []
    assert apart(cut(machine.samples()), auto) < DEVIATION


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


def test_a_d_of_the_program_before_is_reported_by_every_program_that_lacks_one(machine):
    with_d, without, both = (
        [FIRST, "T0 M6", *blocks, "G0 Z2", "M2"]
        for blocks in (["G13 I9 Z-1 D{}"], ["G13 I9 Z-1"], ["G13 I9 Z-1", "G13 I9 Z-1 D1"])
    )

    def told(program, tool=0):
        run = machine.run_text([line.format(tool) for line in program])
        assert run.error is None
        return [message.text for message in run.messages]

    text = (
        "G13: no D above this block in the program: the D of what ran before counts, "
        "diameter {}. Give D"
    )
    assert told(with_d, 2) == []
    assert told(without) == [text.format(10)]
    assert told(with_d, 1) == []
    assert told(both) == [text.format(6)]
    machine.open_text(both)
    machine.mdi("G13 I9 Z1 D2 F8000")
    machine.mdi("G13 I9 Z1")
    assert machine.messages() == []  # MDI has its own D
    machine.start()
    machine.wait_idle()
    assert [message.text for message in machine.messages()] == [text.format(10)]


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


def test_what_a_refused_form_asked_for_ends_with_it(machine):
    """A form has refused what a program is told of, also after a form that was refused."""
    entries = "[1] [3000] [9] [400] [0] [0] [10] [0] [-4] [2] [13] [1] [30] [4]"
    assert (
        "I1 must be greater" in machine.run_text(f"o<form_haas_mm> call {entries}\nM2\n").error.text
    )
    machine.reset()
    told = machine.run_text("G21 G90 F8000\nT1 M6 S3000 M3\nG0 Z5\nG13 I4 K18 Q7 Z-1 D1\nM2\n")
    assert told.error is None
