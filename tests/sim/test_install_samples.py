# SPDX-License-Identifier: GPL-2.0-or-later
"""The sample configs that LinuxCNC ships: installed, run headless, and again what they were."""

import shutil

import numpy as np
import pytest
from shapely.geometry import LineString, Point

from g12.tools.commands.main import main
from support.kinematics import needs_kinematics
from support.operated_machine import Machine
from support.sample_configs import SAMPLES, copy_samples, problems_of, tree

MILLS = [
    "qtdragon/qtdragon_xyz/qtdragon_metric.ini",
    "axis/remap/extend-builtins/extend-builtins.ini",  # own TOPLEVEL and remaps
    "axis/ini_with_includes/includes_demo.ini",  # [RS274NGC] goes on after an #INCLUDE
]
LATHE = "gmoccapy/lathe_configs/lathe_C.ini"
RADIUS = 2.0
POCKET = ["G21 G17 G91 G94 G61 F1200", f"G13 I{RADIUS} Z-.5 D0", "M2"]
SECTION = ["G21 G18 G8 G90 G94 G61 F1800", "G0 X20", "G12.1", "G1 X15 C0", "G3 X0 C15 R15",
           "G1 X20 C0", "G13.1", "M2"]  # fmt: skip
DEVIATION = 0.02  # mm
ROUND = ["G21 G18 G8 G90 G94 F1000", "G0 X60 C0", "G12.1", "G3 X0 C60 R60", "G13.1", "M2"]

pytestmark = pytest.mark.skipif(not SAMPLES.is_dir(), reason="no sample configs here")


@pytest.fixture(scope="module")
def sim(tmp_path_factory):
    return copy_samples(tmp_path_factory.mktemp("samples"), "sim")


def run_installed(ini, feature, program):
    """Install, check, run headless, uninstall; return the run and the size of a unit in mm."""
    before = tree(ini.parent)
    assert main(["install", str(ini), "--with", feature]) == 0
    assert problems_of(ini) == []
    with Machine(ini) as machine:
        run, unit = machine.run_text(program, timeout=300), machine.mm
    assert main(["uninstall", str(ini)]) == 0
    assert tree(ini.parent) == before
    return run, unit


@pytest.mark.parametrize("name", MILLS)
def test_a_pocket_on_a_sample_mill(sim, name):
    run, unit = run_installed(sim / name, "haas", POCKET)
    assert run.error is None
    own = ["in setfeed feed=1200.000000"] if "extend-builtins" in name else []
    assert [message.text for message in run.messages] == own  # the user's remaps go on working
    path = {axis: values * unit for axis, values in run.samples.axes.items()}
    x, y, z = (path[axis] - path[axis][0] for axis in "XYZ")
    assert z.min() == pytest.approx(-0.5, abs=1e-6)
    assert np.hypot(x, y).max() == pytest.approx(RADIUS, abs=DEVIATION)
    assert [x.min(), y.min()] == pytest.approx([-RADIUS, -RADIUS], abs=DEVIATION)


@pytest.fixture
def lathe(sim):
    """Return the sample lathe; where it shares its Python with others, with a copy of its own."""
    ini = sim / LATHE
    if "../python" in ini.read_text():
        shutil.copytree(ini.parent.parent / "python", ini.parent / "python")
        ini.write_text(ini.read_text().replace("../python", "python"))
    return ini


def test_a_section_on_a_sample_lathe(lathe):
    run, _ = run_installed(lathe, "polar", SECTION)
    assert run.error is None
    feeding = run.samples.kind == 2
    angle = np.radians(run.samples.axes["C"][feeding])
    x = run.samples.axes["X"][feeding]
    arc = [(15 * np.cos(a), 15 * np.sin(a)) for a in np.linspace(0, np.pi / 2, 2000)]
    contour = LineString([(20, 0), *arc, (20, 0)])
    points = zip(x * np.cos(angle), x * np.sin(angle))
    assert max(contour.distance(Point(point)) for point in points) < DEVIATION
    assert np.degrees(angle).max() == pytest.approx(90, abs=0.1)


@needs_kinematics
def test_the_kinematics_of_the_face_on_a_sample_lathe(lathe, capsys):
    before = tree(lathe.parent)
    assert main(["install", str(lathe), "--with", "polar", "polar-kinematics"]) == 0
    assert main(["install", str(lathe), "--with", "polar-kinematics"]) == 0
    assert "installed already, nothing to do" in capsys.readouterr().out
    assert problems_of(lathe) == []
    with Machine(lathe) as machine:
        run = machine.run_text(ROUND, timeout=300)
    assert run.error is None
    assert (run.samples.kind == 3).sum() > 1000  # an arc of LinuxCNC's own
    angle, x = np.radians(run.samples.axes["C"]), run.samples.axes["X"]
    there = (x * np.exp(1j * angle))[run.samples.line == 4]
    assert np.abs(np.abs(there) - 60).max() < DEVIATION
    assert np.degrees(angle).max() == pytest.approx(90, abs=0.1)
    assert main(["uninstall", str(lathe)]) == 0
    assert tree(lathe.parent) == before
