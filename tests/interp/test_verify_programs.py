# SPDX-License-Identifier: GPL-2.0-or-later
"""What verify reads of programs: the manual's pockets, numbers near zero, subs of other files."""

import json

import pytest

from g12.tools.errors import ProgramError
from g12.tools.machine.ini import read_ini
from g12.tools.units import MM
from g12.tools.verify.proof import prove
from g12.tools.verify.report import as_json, as_text
from support.judged_programs import prove_lines
from support.sim_machines import PROGRAMS, SIM, copy_of_machines

INCH = 25.4
MILL = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6 S3000 M3"]  # a 10 mm cutter
LATHE = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X30 Z2 C40"]


# ---------------------------------------------------------------- the manual's pockets


@pytest.mark.parametrize("name", ["O60121", "O60131"])
def test_every_pocket_is_found_and_comes_out_as_printed(name):
    expected = json.loads((PROGRAMS / "haas" / f"{name}.json").read_text())
    tools = {int(tool): size for tool, size in expected["tools"].items()}
    ini = read_ini(SIM / "mill_inch_headless.ini")
    proof = prove(PROGRAMS / "haas" / f"{name}.ngc", ini, tools=tools)
    assert len(proof.pockets) == len(expected["pockets"])
    for printed, facts in zip(expected["pockets"], proof.pockets):
        wall, rings = facts.commanded.wall, [ring * INCH for ring in printed["rings"]]
        assert (facts.line, facts.code) == (printed["line"], printed["code"])
        assert facts.values["reached"] == pytest.approx(printed["finished"] * INCH, abs=1e-6)
        assert facts.values["rings"] == pytest.approx(rings, abs=1e-5)
        depths = [wall.height(depth) / INCH for depth in facts.commanded.depths]
        assert depths == pytest.approx(printed["depths"], abs=1e-4)
        assert wall.origin[:2] / INCH == pytest.approx(printed["centre"])
        assert facts.deviation < 1e-6


# ---------------------------------------------------------------- numbers


@pytest.mark.parametrize(
    ("place", "cut", "height"),
    [
        ("Z.1 C0", ["G1 Z[.5-.49991]", "X1", "Z-.1", "X2"], 0.1),
        ("Z.00009 C-.00009", ["G1 Z-.1", "X1", "Z.00009", "X2 C-.00009"], 0.00009),
    ],
)
def test_next_to_zero_is_not_zero(place, cut, height, tmp_path):
    """LinuxCNC 2.9 reports that less than 0.0001 is 0."""
    lines = ["G20 G18 G8 G40 G90 G94 F10", "T1 M6 S1000 M3", f"G0 X2 {place}", "G12.1", *cut]
    proof = prove_lines(tmp_path, [*lines, "G13.1"], "lathe_inch")
    assert proof.findings == []
    assert proof.sections[0].commanded.height == pytest.approx(height * INCH, abs=1e-9)


def test_a_program_that_moves_by_its_line_numbers_is_refused_in_one_line(tmp_path):
    lines = [*MILL, "G0 X0 Y0 Z1", "G12 I20 Z-1 D4", "o1 if [#<_line> GT 6]", "G0 X5", "o1 endif"]
    with pytest.raises(ProgramError, match="moves differently with reports between its lines"):
        prove_lines(tmp_path, lines, "mill_mm")


# ---------------------------------------------------------------- subs in files of their own


@pytest.fixture
def with_sub(tmp_path):
    """Return the proof of a program on a machine that has a sub in a file of its own."""

    def proof(name, body, *lines, machine="mill_mm"):
        folder = tmp_path / "subs"
        folder.mkdir()
        (folder / f"{name}.ngc").write_text("\n".join([*body, ""]))
        own = read_ini(SIM / f"{machine}_headless.ini").get("RS274NGC", "SUBROUTINE_PATH")
        changed = {"RS274NGC": {"SUBROUTINE_PATH": f"{own}:{folder}"}}
        return prove_lines(tmp_path, lines, machine, changed)

    return proof


def radii_of(proof):
    return [facts.commanded.wall.radius for facts in proof.pockets]


@pytest.mark.parametrize(
    ("name", "body", "call"),
    [
        ("hole", ["o<hole> sub", "G0 Z1", "G12 I#1 Z-2 D4", "o<hole> endsub"], "o<hole> call [9]"),
        ("77", ["o77 sub", "G0 Z1", "G12 I[#1] Z-2 D4", "o77 endsub"], "o77 call [9]"),
        ("77", ["O77", "G0 Z1", "G[12] I#1 Z-2 D4", "M99"], "M98 P77"),
    ],
)
def test_a_pocket_in_a_sub_of_another_file_is_measured(name, body, call, with_sub):
    proof = with_sub(name, body, *MILL, "#1 = 9", call, "G12 I11 Z-3 D4")
    assert radii_of(proof) == pytest.approx([9, 11])
    assert [(cut.line, cut.file) for cut in proof.pockets] == [(3, f"{name}.ngc"), (5, "")]
    assert proof.findings == []


def test_an_event_in_a_sub_that_a_sub_calls_is_measured(with_sub):
    event = "[7] [0] [0] [-2] [1] [-9999] [#1] [0] [2]" + " [-9999]" * 6
    body = ["o<event> sub", f"o<circle_mill> call {event}", "o<event> endsub", "M2"]
    own = ["o<way> sub", "o<event> call [#1]", "o<way> endsub"]
    proof = with_sub("event", body, *own, *MILL, "G0 Z1", "o<way> call [20]", "o<way> call [30]")
    assert radii_of(proof) == pytest.approx([20, 30])
    assert proof.findings == []


def test_a_sub_that_linuxcnc_finds_elsewhere_than_the_copy_is_a_finding(tmp_path):
    here = copy_of_machines(tmp_path)
    (here / "hole.ngc").write_text("o<hole> sub\nG12 I9 Z-2 D4\no<hole> endsub\nM2\n")
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*MILL, "G0 Z1", "o<hole> call", "M2", ""]))
    proof = prove(program, read_ini(here / "mill_mm_headless.ini"))
    assert (proof.pockets, proof.lines_with("not-measured")) == ([], [(4, "G12")])


def test_a_d_that_a_sub_in_its_own_file_commanded_is_remembered(with_sub):
    body = ["o<offset> sub", "G41 D6 G1 X40 F100", "Y-30", "G40 X80", "o<offset> endsub"]
    proof = with_sub("offset", body, *MILL, "G0 Z1", "o<offset> call", "G0 X0 Y0", "G12 I30 Z-2")
    (facts,) = proof.pockets
    assert (facts.commanded.cutter.named, facts.commanded.cutter.radius) == (6, 10)
    assert "the toolpath" not in str(proof.findings)


def test_a_section_in_a_sub_of_another_file_is_measured(with_sub):
    body = ["o<flat> sub", "G12.1", "G1 X#1 F500", "C5", "G13.1", "o<flat> endsub"]
    calls = ["o<flat> call [20]", "G0 X30 C0", "o<flat> call [15]"]
    proof = with_sub("flat", body, *LATHE, *calls, machine="lathe_mm")
    assert [facts.commanded.elements[0].end for facts in proof.sections] == [20, 15]
    assert [(facts.line, facts.last) for facts in proof.sections] == [(2, 5)] * 2
    assert proof.findings == []
    report = as_text(proof, MM, full=True).splitlines()
    titles = [line for line in report if line.startswith("lines ")]
    assert titles == [f"lines 2 to 5 of flat.ngc, called in line {line}: G12.1" for line in (4, 6)]
    assert json.loads(as_json(proof))["sections"][0]["file"] == "flat.ngc"


def test_a_section_of_another_file_that_asks_for_a_position_is_in_doubt(with_sub):
    body = ["o<flat> sub", "G12.1", "G1 X[#<_x> - 5] F500", "G13.1", "o<flat> endsub"]
    proof = with_sub("flat", body, *LATHE, "o<flat> call", machine="lathe_mm")
    assert [facts.commanded.doubt for facts in proof.sections] == ["line 3 asks for a position"]
