# SPDX-License-Identifier: GPL-2.0-or-later
"""[G12] POLAR_TOOL_OFFSET in a headless LinuxCNC: the part is the same, seen from the joints."""

import numpy as np
import pytest

from support.contour_geometry import Straight, distance
from support.kinematics import needs_kinematics
from support.operated_machine import Machine
from support.sim_machines import PROGRAMS, copy_of_machines

HEXAGON = PROGRAMS / "polar" / "hexagon.ngc"
ARCS = (
    "G20 G7 G18 G90 G94 G64 P0.0002 F60", "G0 X3 Z0 C0", "G12.1", "G1 X2.4 C0", "G3 X0 C1.2 R1.2",
    "G1 X-2 C0.5", "G2 X-2 C0.5 I-0.4", "G1 X2.4 C0.6", "G13.1", "M2",
)  # fmt: skip
WAYS = [
    ("lathe_mm", 8.0, HEXAGON.read_text()),
    pytest.param("lathe_inch_kinematics", -0.3, ARCS, marks=needs_kinematics),
]


def machine_with(folder, name, offset):
    """Return the INI of a simulated machine with a tool beside the X line."""
    ini = copy_of_machines(folder) / f"{name}.ini"
    text = ini.read_text()
    if "kinematics" in name:
        hal = "HALFILE = ../kinematics/polar_kinematics.hal\n"
        text = text.replace(hal, f"{hal}HALFILE = ../kinematics/polar_tool_offset.hal\n")
        text = text.replace("[G12]\n", f"[G12]\nPOLAR_TOOL_OFFSET = {offset}\n")
    else:
        text += f"\n[G12]\nPOLAR_TOOL_OFFSET = {offset}\n"
    ini.write_text(text)
    return ini


def on_the_part(samples, offset):
    """Return where the tool was on the part, complex, for joints X and C."""
    assert samples.axes["X"].min() >= 0.0
    return (samples.axes["X"] + 1j * offset) * np.exp(1j * np.radians(samples.axes["C"]))


@pytest.mark.parametrize(("name", "offset", "program"), WAYS)
def test_the_part_is_the_same(tmp_path, name, offset, program):
    with Machine(machine_with(tmp_path, name, offset)) as lathe:
        proof = lathe.proof_of_run(program)
    assert proof.findings == []
    assert proof.sections[0].deviation <= (0.00024 * 25.4 if "inch" in name else 0.006)
    assert proof.program.samples.axes["X"].min() >= 0.0


@needs_kinematics
def test_kinematics_that_know_another_offset_are_refused(tmp_path):
    ini = machine_with(tmp_path, "lathe_mm_kinematics", 8.0)
    ini.write_text(ini.read_text().replace("HALFILE = ../kinematics/polar_tool_offset.hal\n", ""))
    with Machine(ini) as lathe:
        run = lathe.run(HEXAGON)
        assert "kinematics have the tool 0 beside X's line (polar-xzc.tool-offset)" in (
            run.error.text
        )
        assert set(run.samples.line[run.samples.moving()]) <= {5}
        assert not lathe.get("polar-xzc.face")


@needs_kinematics
def test_in_mdi_the_face_is_where_the_tool_is(tmp_path):
    with Machine(machine_with(tmp_path, "lathe_mm_kinematics", 8.0)) as lathe:
        lathe.mdi("G21 G8 G90 G94 F1000")
        lathe.mdi("G0 X30 C0")
        for block in ("M68 E2 Q0", "M68 E3 Q0", "M68 E3 Q1", "M66 P3 L3 Q10", "G17"):
            lathe.mdi(block)
        assert lathe.stat().position[:2] == pytest.approx((30, 8), abs=1e-6)
        lathe.sample()
        lathe.mdi("G1 X20 Y20")
        points = on_the_part(lathe.samples(), 8.0)
        assert distance(points, [Straight(30 + 8j, 20 + 20j)]).max() <= 0.002
        lathe.mdi("G1 X0 Y7")
        lathe.wait_for_error("kinematicsInverse")
