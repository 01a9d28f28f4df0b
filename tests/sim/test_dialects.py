# SPDX-License-Identifier: GPL-2.0-or-later
"""The other cycles in a headless LinuxCNC: real motion, refusals; Haas: test_haas.py."""

import pytest

from support.operated_machine import Machine
from support.sim_machines import BRISK, PROGRAMS, SIM, machine_scope

EVENT = "G21 G17 G40 G49 G54 G61 G80 G90 G91.1 G94 F8000\nT1 M6\nG0 X0 Y0 Z5\n"
POCKET = "G13.2 X10 Y5 Z-2 I1 E3 R9 H2 K2 Q.2 P4000"
CALL = (
    "o<circle_mill> call [7] [10] [5] [-2] [1] [3] [9] [-9999] [2] [2] [-9999] [0.2]"
    " [4000] [8000] [6000]"
)
OUTSIDE = "G12.2 X10 Y5 Z-1 I1 R5 H1 Q.2 L0"


def sample(name):
    """Return a sample program at forty times its feed."""
    return (PROGRAMS / name).read_text().replace("F300", "F12000")


MILLS = {
    "mill_yasnac_mm": [sample("yasnac/example.ngc")],
    "mill_mitsubishi_mm": [sample("mitsubishi/planes.ngc")],
    "mill_mm": [f"{EVENT}{block}\nM2\n" for block in (POCKET, CALL, OUTSIDE)],
}
BORED = {"mill_yasnac_mm": "bore 80"}  # the tool enters its holes by rapid
AIR = {"mill_mitsubishi_mm": ["air"]}  # circles in three planes, above the part
DEVIATION = 0.011  # mm, of the real motion: the programs blend with P0.01


@pytest.fixture(scope=machine_scope, params=MILLS)
def mill(request):
    tools = {1: 6.0} if request.param == "mill_mm" else None
    ini = SIM / f"{request.param}_headless.ini"
    with Machine(ini, tools=tools, overrides=BRISK) as machine:
        yield request.param, machine


def test_verify_finds_nothing_wrong_in_the_real_motion(mill):
    name, machine = mill
    for text in MILLS[name]:
        proof = machine.proof_of_run(text, BORED.get(name, ""))
        assert proof.pockets and proof.finding_codes == AIR.get(name, [])
        assert max(each.values["off_circles"] for each in proof.pockets) < DEVIATION


def test_w_lasts_from_one_mdi_block_to_the_next_but_not_into_another_program(tmp_path):
    with Machine(SIM / "mill_mm.ini", tools={1: 6.0}, overrides=BRISK) as machine:
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
