# SPDX-License-Identifier: GPL-2.0-or-later
"""The demo, and plot and verify of real motion, on short programs in headless LinuxCNC."""

import json

import pytest

from g12.tools.commands import demo
from g12.tools.commands.main import main
from g12.tools.demo import samples as samples_of_demo
from g12.tools.headless.errors import MachineError
from support.sim_machines import SIM

POCKET = """\
G21 G17 G40 G49 G54 G64 P0.01 G80 G90 G94 F2000
T4 M6 S5000 M3
G0 G43 H4 Z2
G0 X10 Y0
G12 I7 K16 Q5 Z-3 D4
G0 Z2
M2
"""


@pytest.fixture
def pocket(tmp_path):
    path = tmp_path / "pocket.ngc"
    path.write_text(POCKET)
    return str(path)


MILL = str(SIM / "mill_mm_headless.ini")


def test_verify_measures_real_motion(pocket, capsys):
    assert main(["verify", pocket, "--ini", MILL, "--run", "--json"]) == 0
    said = capsys.readouterr()
    reported = json.loads(said.out)
    (facts,) = reported["pockets"]
    assert reported["real"] and facts["off_circles"] < 0.005
    assert facts["rings"] == pytest.approx([2, 7, 11], abs=1e-6)
    assert facts["depths"] == pytest.approx([-3])
    assert facts["seconds"] == pytest.approx(facts["seconds_programmed"], rel=0.15)
    assert "running pocket.ngc" in said.err


def test_the_demo_tells_and_draws_every_program(tmp_path, monkeypatch, capsys):
    samples = [sample for sample in demo.SAMPLES if "example" in sample.program]
    samples.append(next(sample for sample in demo.SAMPLES if "slot" in sample.program))
    monkeypatch.setattr(demo, "SAMPLES", tuple(samples))
    assert main(["demo", "--output", str(tmp_path / "new" / "demo")]) == 0
    out = capsys.readouterr().out
    assert "[1 of 2]" in out and "[2 of 2]" in out
    assert "(yasnac)  ⌀ " in out and "on the contour, to Z" in out
    assert out.endswith("every circle and contour came out right\n")
    drawn = sorted(path.name for path in (tmp_path / "new" / "demo").iterdir())
    assert drawn == ["polar_slot.png", "yasnac_example.png"]


def test_the_demo_goes_on_after_a_failure(tmp_path, monkeypatch, capsys):
    samples = [s for s in demo.SAMPLES if "example" in s.program or "slot" in s.program]
    monkeypatch.setattr(demo, "SAMPLES", tuple(samples))

    def run(path, *_, **_options):
        raise MachineError(f"{path.stem} did not come up")

    monkeypatch.setattr(samples_of_demo, "run_program", run)
    assert main(["demo", "--output", str(tmp_path)]) == 1
    out = capsys.readouterr().out
    assert "polar/slot.ngc: FAILED: slot did not come up" in out and "[2 of 2]" in out
    assert "NOT everything came out right: " in out and "yasnac/example.ngc" in out.splitlines()[-1]
