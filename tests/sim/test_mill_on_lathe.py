# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a running lathe: opened on one that was installed for it."""

from g12.tools.commands import main
from support.cam_parts import PARTS, mill_program
from support.sim_machines import copy_of_machines

FEATURES = ("polar", "polar-shapes", "programs-mill-on-face")


def test_a_mills_program_runs_on_the_face(tmp_path, capsys):
    ini = copy_of_machines(tmp_path) / "lathe_mm.ini"
    ini.write_text(ini.read_text().replace("[FILTER]\n", "[OLD_FILTER]\n"))
    assert main.main(["install", str(ini), "--with", *FEATURES]) == 0
    program = tmp_path / "pocket.nc"
    program.write_text(
        mill_program(PARTS["pocket"]._replace(feed=3000)).replace("Z1.0000", "Z2.0000")
    )
    assert main.main(["run", str(program), "--ini", str(ini)]) == 0
    assert "ends at X6 Z5 C" in capsys.readouterr().out
