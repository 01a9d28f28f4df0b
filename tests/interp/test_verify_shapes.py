# SPDX-License-Identifier: GPL-2.0-or-later
"""verify tells of the shapes that a program calls, also from the files of its forms."""

import json

import pytest

from g12.tools.commands.main import main
from g12.tools.machine.ini import read_ini
from support.judged_programs import prove
from support.sim_machines import PROGRAMS, SIM

LATHES = {unit: SIM / f"lathe_{unit}_headless.ini" for unit in ("mm", "inch")}
PROGRAM = str(PROGRAMS / "polar" / "shapes.ngc")
FORMS = {  # the entries of a form after its first six
    "form_polygon_mm": [6, 20, 3, 26, 1, 2, 0.3, 600, 0, 15],
    "form_slot_inch": [0.5, 1, 0.1, 0, 0.01, 20, 10, 30],
    "form_face_pocket_mm": [8, 3, 12, 2, 0, 0, 600, 0],
}


def test_a_report_has_each_shape_and_how_far_off_its_toolpath_is(capsys):
    ini = str(LATHES["mm"])
    assert main(["verify", PROGRAM, "--ini", ini]) == 1  # it has no M3
    cuts = capsys.readouterr().out.split("\n\n")[0].splitlines()
    assert "  polar_polygon  cutter ⌀ 6, to Z−4  " in cuts[0]
    assert [line.split()[1] for line in cuts] == ["9", "10", "11"]  # once, not its section too
    assert cuts[0].endswith("(0.005 allowed)  53.4 s")
    assert main(["verify", PROGRAM, "--ini", ini, "--full"]) == 1
    text = capsys.readouterr().out
    assert "line 9: polar_polygon\n  cutter          ⌀ 6\n  entries         sides 6, across" in text
    assert main(["verify", PROGRAM, "--ini", ini, "--json"]) == 1
    hexagon, slot, pocket = json.loads(capsys.readouterr().out)["shapes"]
    assert [each["code"] for each in (slot, pocket)] == ["polar_slot", "polar_pocket"]
    assert (hexagon["entries"]["across_flats"], hexagon["lowest"]) == (27, -4)
    assert max(each["deviation"] for each in (hexagon, slot, pocket)) < 0.01


@pytest.mark.parametrize("form", FORMS)
def test_a_shape_of_a_form_is_judged_in_the_form_s_file(form, tmp_path):
    program, unit = tmp_path / "form.ngc", form.rpartition("_")[2]
    values = [3, 3000, 33, 35, 9, 5 if unit == "mm" else 0.2, *FORMS[form]]
    call = " ".join(f"[{value}]" for value in values)
    program.write_text(
        f"{'G21' if unit == 'mm' else 'G20'} G18 G8\nG0 X5 Z5\no<{form}> call {call}\nM2\n"
    )
    proof = prove(program, read_ini(LATHES[unit]))
    assert proof.findings == []
    assert [facts.file for facts in proof.shapes] == [f"{form}.ngc"]
