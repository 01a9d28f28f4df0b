# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 in a headless LinuxCNC: the samples' real motion, MDI; test_polar.py has the operator."""

from functools import partial

import numpy as np
import pytest

from support import polar_programs
from support.contour_geometry import apart
from support.operated_machine import Machine, kept_machine
from support.polar_programs import (
    C_ACCELERATION,
    FEED,
    FIRST,
    ROUND,
    accelerations,
    exceeds_limits_itself,
)
from support.sim_machines import PROGRAMS, SIM

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add
SPEEDS = {"helix": 2500, "textbook": 1500, "cam_groove": 1000}  # not 250 mm/min
C_SPEED = 360


lathe = kept_machine("lathe_mm")


@pytest.mark.parametrize("name", SPEEDS)
def test_verify_finds_nothing_wrong_in_the_samples_and_c_keeps_its_limits(lathe, name):
    text = (PROGRAMS / "cylinder" / f"{name}.ngc").read_text()
    proof = lathe.proof_of_run(text.replace("F250", f"F{SPEEDS[name]}"))
    (section,) = proof.sections
    assert proof.findings == [] and section.deviation <= LIMIT
    assert section.values["seconds"] <= 1.05 * section.values["seconds_programmed"]
    c = proof.program.samples.axes["C"]
    assert np.abs(np.diff(c)).max() * 1000 <= C_SPEED * 1.001
    if not exceeds_limits_itself(lathe):
        assert accelerations(c).max() <= C_ACCELERATION * 1.01


# ---------------------------------------------------------------- what an operator does


PART = ["G1 Z-8", "C40", "G3 Z-2 C60 R8", "G1 Z-10 C-30", "C0"]


section = partial(
    polar_programs.section, start="G0 X22 Z0 C0", tool="T3 M6", feed="F2500", on="G07.1 C20",
    off="G07.1 C0",
)  # fmt: skip


@pytest.fixture
def ready(lathe):
    lathe.abort()
    lathe.mdi("G21 G90 G94 G40 G8 G64")
    lathe.mdi("G0 X22 Z0 C0")
    lathe.errors(), lathe.messages()
    return lathe


def on_surface(samples):
    """Return where the tool was at feed, on the surface of radius 20."""
    places = np.column_stack([np.radians(samples.axes["C"]) * 20, samples.axes["Z"]])
    return places[np.isin(samples.kind, (FEED, ROUND))]


def test_a_sub_that_mdi_calls_has_the_lines_behind(tmp_path):
    groove = section(*PART[:2], "M66 P0 L0", *PART[2:])[4:-1]
    text = ["o<groove> sub", *groove, "G0 X25", "o<groove> endsub"]
    (tmp_path / "groove.ngc").write_text("\n".join(text) + "\n")
    paths = {"RS274NGC": {"SUBROUTINE_PATH": f"../../ngc:subs:{tmp_path}"}}
    with Machine(SIM / "lathe_mm.ini", overrides=paths) as lathe:
        program = lathe.run_text(section(*PART)).samples
        for block in (FIRST, "T3 M6", "G0 X22 Z0 C0", "F2500"):
            lathe.mdi(block)
        lathe.sample()
        lathe.mdi("o<groove> call")
        samples = lathe.samples()
        lathe.mdi("G0 X30")
        assert lathe.errors() == []
        assert lathe.stat().position[0] == pytest.approx(30)
    assert apart(on_surface(samples), on_surface(program)) <= LIMIT


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
def test_more_speed_than_c_has_only_slows_the_way_down(ready, body, most):
    proof = ready.proof_of_run(section(*body, feed="F30000"))
    assert set(proof.finding_codes) == {"air"}  # on purpose
    assert proof.sections[0].deviation <= LIMIT
    assert np.abs(np.diff(proof.program.samples.axes["C"])).max() * 1000 <= most
