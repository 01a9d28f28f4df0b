# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine that runs makes no report of a cut, in AUTO or in MDI."""

from g12.tools.machine.ini import read_ini
from support.faulty_machines import with_fault
from support.operated_machine import Machine
from support.sim_machines import BRISK, SIM

POCKET = "G13 I5 Z-1 D1"


def test_a_running_machine_makes_no_report(tmp_path):
    """The reports' functions leave a file behind: they are called, and nobody asks for a record."""
    called, made = tmp_path / "called", tmp_path / "made"
    body = f"open({str(called)!r}, 'a').write('.'); found = original()"
    body += f"\nif found is not None: open({str(made)!r}, 'a').write('.')\nreturn found"
    ini = with_fault(read_ini(SIM / "mill_mm.ini"), "g12.host.messages.asked", body, tmp_path)
    overrides = {**BRISK, "PYTHON": {"TOPLEVEL": ini.get("PYTHON", "TOPLEVEL")}}
    with Machine(SIM / "mill_mm.ini", tools={1: 6.0}, overrides=overrides) as machine:
        machine.mdi("G21 G90 G94 F8000 T1 M6")
        machine.mdi("G0 Z2")
        machine.mdi(POCKET)
        run = machine.run_text(["G21 G17 G90 G94 F8000", "G0 Z2", POCKET, "G0 Z2", "M2"])
        assert run.error is None and machine.errors() == []
    assert called.read_text().count(".") >= 4 and not made.exists()
