# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a running lathe: opened on one that was installed for it, and FreeCAD's."""

import os
import shutil
import subprocess

import numpy as np
import pytest

from g12.tools.commands import main
from support.cam_parts import PARTS, mill_program
from support.contour_geometry import distances
from support.foreign_programs import translation
from support.operated_machine import Machine
from support.shape_geometry import polygon
from support.sim_machines import ROOT, SIM, copy_of_machines

FEATURES = ("polar", "polar-shapes", "programs-mill-on-face")
FREECAD = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
CUTTER, CLOSE = 2.5, 0.01  # mm: the radius; tolerance of G12.1, of arcs with three decimals
HOLES = [11, -5.5 + 9.526j, -5.5 - 9.526j]
STEP = 4  # of the samples one is looked at
SETTINGS = {"POLAR_Z": "allow", "LIVE_SPINDLE": "0"}


def test_a_mills_program_runs_on_the_face(tmp_path, capsys):
    machines = copy_of_machines(tmp_path)
    part = machines / "parts" / "lathe_mm.inc"
    part.write_text(part.read_text().replace("[FILTER]\n", "[OLD_FILTER]\n"))
    ini = machines / "lathe_mm.ini"
    assert main.main(["install", str(ini), "--with", *FEATURES]) == 0
    program = tmp_path / "pocket.nc"
    program.write_text(
        mill_program(PARTS["pocket"]._replace(feed=3000)).replace("Z1.0000", "Z2.0000")
    )
    assert main.main(["run", str(program), "--ini", str(ini)]) == 0
    assert "ends at X6 Z5 C" in capsys.readouterr().out


@pytest.mark.skipif(not FREECAD, reason="FreeCAD (freecadcmd) is not installed")
def test_a_job_of_freecads_is_cut_on_the_face(tmp_path):
    program = tmp_path / "job.ngc"
    where = {**os.environ, "G12_POSTED": str(program), "HOME": str(tmp_path)}
    job = ROOT / "tests" / "support" / "freecad_job.py"
    subprocess.run([FREECAD, str(job)], env=where, stdin=subprocess.DEVNULL, check=True)
    assert "G81" in program.read_text()
    text = translation(program, "mill-on-face").replace(" $1", "")
    with Machine(SIM / "lathe_mm.ini", overrides={"G12": SETTINGS}) as lathe:
        run = lathe.run_text(["G21 G7 G90 G0 X100", "G0 Z50", *text.splitlines()])
    assert run.error is None, run.error
    check_the_part(run.samples.axes)


def check_the_part(axes):
    """Prove profile, pocket and holes from where the tool's centre has really been."""
    turned = (axes["X"] * np.exp(1j * np.radians(axes["C"])))[::STEP]
    z, points = axes["Z"][::STEP], np.column_stack([turned.real, turned.imag])
    hole = np.min([abs(turned - place) for place in HOLES], axis=0) < CLOSE
    pocket = abs(turned) < 6 - CUTTER + CLOSE
    profile = np.array(polygon(6, 28, angle=30).buffer(CUTTER, 200).exterior.coords)
    outside = distances(points, profile) < CLOSE
    assert (hole | pocket | outside)[z < 0].all()
    assert [round(z[where].min(), 2) for where in (hole, pocket, outside)] == [-6, -3, -4]
    for place in HOLES:
        assert z[abs(turned - place) < CLOSE].min() < -5.99
    assert distances(profile, points[outside & (z < -3.99)]).max() < 2 * CLOSE
    assert abs(turned)[pocket & (z < -2.99)].max() > 6 - CUTTER - CLOSE
