# SPDX-License-Identifier: GPL-2.0-or-later
"""The cycles in a headless LinuxCNC: real motion, single steps, refusals, what MDI remembers."""

import math

import numpy as np
import pytest

from support.contour_geometry import apart
from support.operated_machine import Machine, kept_machine
from support.polar_programs import FEED, ROUND
from support.sim_machines import BRISK, PROGRAMS, SIM

TOOLS = {1: 6.0, 2: 10.0}
FIRST = "G21 G17 G40 G49 G54 G61 G80 G90 G91.1 G94 F8000"
PROGRAM = [FIRST, "T1 M6", "G0 X0 Y0 Z2", "G13 X10 Y5 I5 K12 Q3 Z-1 D1", "G0 Z2", "M2"]
EXACT, BLENDED = 0.002, 0.011  # mm, of the real motion in G61, and with P0.01
EVENT = f"{FIRST}\nT1 M6\nG0 X0 Y0 Z5\n"
POCKET = "G13.2 X10 Y5 Z-2 I1 E3 R9 H2 K2 Q.2 P4000"
CALL = (
    "o<circle_mill> call [7] [10] [5] [-2] [1] [3] [9] [-9999] [2] [2] [-9999] [0.2]"
    " [4000] [8000] [6000]"
)
OUTSIDE = "G12.2 X10 Y5 Z-1 I1 R5 H1 Q.2 L0"

machine = kept_machine("mill_mm", tools=TOOLS, overrides=BRISK)


def at_start(machine):
    machine.mdi("G21 G90 G94 G61 G0 Z2")
    machine.mdi("G0 X0 Y0")
    machine.errors(), machine.messages()


def cut(samples):
    """Return where the tool was at feed: X, Y and Z."""
    places = np.column_stack([samples.axes[axis] for axis in "XYZ"])
    return places[np.isin(samples.kind, (FEED, ROUND))]


@pytest.mark.parametrize("block", [POCKET, CALL, OUTSIDE])
def test_verify_finds_nothing_wrong_in_the_real_motion_of_events(machine, block):
    machine.reset()
    proof = machine.proof_of_run(f"{EVENT}{block}\nM2\n")
    assert proof.findings == [] and proof.pockets[0].values["off_circles"] < EXACT


DIALECTS = {  # its program, the stock, what verify says of circles in three planes above the part
    "mill_yasnac_mm": ("yasnac/example", "bore 80", []),
    "mill_mitsubishi_mm": ("mitsubishi/planes", "", ["air"]),
}


@pytest.mark.parametrize("name", DIALECTS)
def test_verify_finds_nothing_wrong_in_the_real_motion_of_a_dialect(name):
    program, stock, codes = DIALECTS[name]
    text = (PROGRAMS / f"{program}.ngc").read_text().replace("F300", "F12000")
    with Machine(SIM / f"{name}.ini", overrides=BRISK) as mill:
        proof = mill.proof_of_run(text, stock)
    assert proof.pockets and proof.finding_codes == codes
    assert max(each.values["off_circles"] for each in proof.pockets) < BLENDED


def test_a_helix_turns_no_faster_than_round_its_narrowest_arc():
    """And the tool stands nowhere on its way down."""
    feed, share, radius = 2400.0, 0.6, 4.0  # mm/min; PLUNGE_FEED is 60; the first ring's
    first = FIRST.replace("G61", "G64 P0.001").replace("F8000", f"F{feed:g}")
    pocket = "G13 X20 Y5 I9 K14 Q5 Z-3 D1"
    with Machine(SIM / "mill_helix_mm.ini", tools={1: 10.0}) as mill:
        proof = mill.proof_of_run([first, "T1 M6", "G0 X0 Y0 Z1", pocket, "M2"])
    assert proof.findings == [] and proof.pockets[0].values["off_circles"] < EXACT
    points = cut(proof.program.samples)
    steps = np.diff(points[points[:, 2] < 0.5], axis=0)
    length = np.linalg.norm(steps, axis=1)
    inside = slice(20, -60)  # but for the stop at the end
    assert length[inside].min() > 0.2 * share * feed / 60 / 1000
    along = (steps / np.maximum(length, 1e-12)[:, None])[inside]
    turn = np.degrees(np.arccos(np.clip((along[1:] * along[:-1]).sum(axis=1), -1, 1)))
    assert turn.max() < math.degrees(length.max() / (radius / 2)) + 0.5


def test_single_steps_reach_the_end(machine):
    machine.reset()
    proof = machine.proof_of_run(PROGRAM)
    assert proof.findings == [] and proof.pockets[0].values["off_circles"] < EXACT
    at_start(machine)
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
    stepped, run = (cut(samples)[:, :2] for samples in (machine.samples(), proof.program.samples))
    assert apart(stepped, run) < EXACT


@pytest.mark.parametrize("way", ["auto", "mdi"])
@pytest.mark.parametrize(
    ("block", "rule"),
    [
        ("G12 I2 Z-1 D1", "I2 must be greater than the tool radius 3 (D1)"),
        ("G12 X480 I29 Z-1 D1", "the X axis would go to 506 mm, beyond its limit 500 mm"),
    ],
)
def test_a_refused_block_moves_nothing_and_says_why(machine, way, block, rule):
    at_start(machine)
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
    expected = f"G12 line 1: {rule}" if way == "auto" else f"G12: {rule}"
    assert [error.text for error in machine.errors()] == [expected]
    assert not samples.moving().any()
    assert after.position == pytest.approx(before.position)
    assert after.modes.gcodes == before.modes.gcodes


def test_a_d_of_the_program_before_is_reported_by_every_program_that_lacks_one(machine):
    with_d, without, both = (
        [FIRST, "T0 M6", *blocks, "G0 Z2", "M2"]
        for blocks in (["G13 I9 Z-1 D{}"], ["G13 I9 Z-1"], ["G13 I9 Z-1", "G13 I9 Z-1 D1"])
    )

    at_start(machine)

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


def test_w_lasts_from_one_mdi_block_to_the_next_but_not_into_another_program(machine, tmp_path):
    at_start(machine)
    for block in (*EVENT.splitlines(), OUTSIDE, "G12.2 X10 Y5 Z-1 R5 H1"):
        machine.mdi(block)
    assert machine.errors() == []
    assert machine.stat().position[2] == pytest.approx(1)
    for name, block in (("first", OUTSIDE), ("second", OUTSIDE.replace("I1", ""))):
        file = tmp_path / f"{name}.ngc"
        file.write_text(f"{EVENT}{block}\nM2\n")
        run = machine.run(file)
    rule = "I is missing: the first reference plane, which no earlier event has commanded"
    assert run.error.text == f"G12.2 line 4: {rule}"
