# SPDX-License-Identifier: GPL-2.0-or-later
"""What verify says of programs: sentences, runs, clamps, subs of other files, manuals' pockets."""

import json

import numpy as np
import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.units import MM
from g12.tools.verify import judge
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.report import as_text
from support.clamped import with_clamp
from support.growth import growth
from support.judged_programs import prove, prove_lines
from support.made_moves import samples_of
from support.sim_machines import PROGRAMS, SIM, copy_of_machines

INCH = 25.4
MILL = ["G21 G17 G40 G49 G90 G94 F600", "T4 M6 G43", "S3000 M3", "G0 X0 Y0 Z1"]
LATHE = ["G21 G18 G7 G40 G90 G94", "T1 M6", "S3000 M3", "G0 X60 Z2 C0"]
P = ["G13 I7 K20 Q6 Z-3 D4", "G0 Z30"]
FLAT = ["G12.1", "G1 C25 F2000", "G41 X27 F1000", "Z-5", "C-25", "G40 X60 F2000", "G13.1", "G0 Z2"]
SIDES = ["C-7.7942", "X0 C-15.5885", "X-27 C-7.7942", "C7.7942", "X0 C15.5885", "X27 C7.7942", "C0"]
HEXAGON = ["G0 X70", "G12.1", "G1 G41 X27 F1000", "Z-5", *SIDES, "G40 X70", "Z2", "G13.1"]
POLYGON = "o<polar_polygon> call [6] [24] [4] [30] [0] [2] [.3] [600] [300] [0]"
ON_FACE = "o<face_holes> call [3] [30] [20] [-9999] [8] [2] [120] [3] [.5] [0]"


@pytest.mark.parametrize("name", ["O60121", "O60131"])
def test_every_pocket_is_found_and_comes_out_as_printed(name):
    expected = json.loads((PROGRAMS / "haas" / f"{name}.json").read_text())
    tools = {int(tool): size for tool, size in expected["tools"].items()}
    ini = read_ini(SIM / "mill_inch_headless.ini")
    proof = prove(PROGRAMS / "haas" / f"{name}.ngc", ini, tools=tools)
    assert len(proof.pockets) == len(expected["pockets"])
    for printed, pocket in zip(expected["pockets"], proof.pockets):
        values = pocket.values
        assert (pocket.line, pocket.code) == (printed["line"], printed["code"])
        assert values["reached"] == pytest.approx(printed["finished"] * INCH, abs=1e-6)
        assert values["rings"] == pytest.approx([r * INCH for r in printed["rings"]], abs=1e-5)
        depths = [depth / INCH for depth in values["depths"]]
        assert depths == pytest.approx(printed["depths"], abs=1e-4)
        assert values["centre"] == pytest.approx([at * INCH for at in printed["centre"]])
        assert pocket.deviation < 1e-6


SAID = [  # a machine, its blocks, its stock, a part of the report
    ("mill_mm", [*MILL, "G13 I18 K20.2 Q3 Z-4 D4", "G0 Z9"], "",
     "line 5: a core of 48.379 mm² remains in its middle [core]"),
    ("mill_mm", [*MILL, "G10 L2 P1 X2 Y3 R90", "G0 X0 Y0", P[0], "G0 X40", "Z9"], "",
     "line 8: a rapid goes through 238.532 mm² of material, at X15.309 Y0 Z−3 to X40 Y0 Z−3"),
    ("mill_mm", [*MILL, "Z-3", *P], "", "was it bored before? (--stock 'bore DIAMETER') [rapid]"),
    ("mill_mm", [*MILL, *P], "100x80x0.5 bore 12", "it goes 2.5 mm below the block [below-stock]"),
    ("mill_mm", [MILL[0], "T4 M6 G43", "M3", "G0 X0 Y0 Z1", *P], "", "S is missing [spindle]"),
    ("mill_yasnac_mm", [*MILL, "G13 I20 D4", "G0 Z9"], "", "part: no move down to the depth"),
    ("mill_mm", [*MILL, *P], "100x80x20", "stock: 100x80x20, its top at Z0\n"),
    ("lathe_mm", [*LATHE, *FLAT, *FLAT], "",
     "line 13: C is where line 5 left it, −39.806°: the zero line is turned"),
    ("lathe_mm", [*LATHE, *FLAT], "", "assumed: solid below Z0, a bar of ⌀ 56.824; the tool"),
    ("lathe_mm", [*LATHE, *HEXAGON], "", "speed           C "),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "blocks", "stock", "said"), SAID)
def test_what_a_report_says(machine, blocks, stock, said, tmp_path):
    judgement = prove_lines(tmp_path, blocks, machine, stock=stock).judgement
    assert said in as_text(judgement, MM, full=True)


@pytest.mark.parametrize("stock", ["", "300x300x20"])
def test_a_long_program_of_plain_moves_takes_a_pass_for_each_line(stock, tmp_path):
    program, ini = tmp_path / "long.ngc", read_ini(SIM / "mill_mm_headless.ini")

    def judged(lines):
        body = [f"G1 X{n % 200 / 2:g} Y{n // 200 / 2:g} F600" for n in range(lines)]
        program.write_text("\n".join([*MILL, "G1 Z-1", *body, "G0 Z30", "M2", ""]))
        traced = TracedProgram(program, ini, judge.traced(program, ini))
        given = StockText(stock) if stock else None
        return lambda: judge.judge_trace(traced, stock=given)

    assert growth(judged, 3_000) < 10


CLAMPED = [  # M10 closes the clamp of C, M11 opens it: a program, and C_CLAMP_SHAPES
    (["M10", "G0 C90", "C180", "M11", "C0"], "clamp-closed 6"),
    (["M10", "G0 X70", "M11", "C90"], ""),
    (["M10", *FLAT, "M11"], "clamp-closed 7"),
    (["G0 Z5", "M10", POLYGON, "M11"], "clamp-closed 7"),
    (["M10", "G0 Z10", ON_FACE, "G0 C0"], ""),
    (["M10", *FLAT, "G0 C0"], "", "M10"),
    (["G0 Z5", "M10", POLYGON], "", "M12"),
]


@pytest.mark.parametrize("case", CLAMPED)
def test_c_turns_only_where_its_clamp_is_open(case, tmp_path):
    blocks, expected, *drag = case
    settings = {"C_CLAMP_SHAPES": drag[0]} if drag else {}
    changed = with_clamp("lathe_mm", tmp_path, **settings)
    codes = prove_lines(tmp_path, [*LATHE, *blocks], "lathe_mm", changed).codes
    assert ", ".join(code for code in codes.split(", ") if "clamp" in code) == expected


RUNS = [  # a program, the axis along which a run is beside its path, what is found
    ("mill_mm", [*MILL, *P], "Y", "run-off 5, wall 5"),  # within P of its G64
    ("lathe_mm", [*LATHE, *HEXAGON], "X", "off 11"),
]


@pytest.mark.parametrize(("machine", "blocks", "axis", "found"), RUNS)
def test_a_run_beside_its_path_is_found(machine, blocks, axis, found, tmp_path):
    axes = "XYZ" if machine == "mill_mm" else "XZC"
    samples = samples_of(prove_lines(tmp_path, blocks, machine).program.path, 8000, axes=axes)
    assert prove_lines(tmp_path, blocks, machine, samples=samples).codes == ""
    samples.axes[axis] += 0.03
    assert prove_lines(tmp_path, blocks, machine, samples=samples).codes == found


def test_a_run_that_rounds_the_corner_of_a_retract_is_found_if_it_cuts(tmp_path):
    blocks = [*MILL, "G13 I17 K17.5 Q1 Z-3 D4", "G0 Z2", "X100"]
    program = prove_lines(tmp_path, blocks, "mill_mm").program
    samples = samples_of(program.path, 8000)
    leaving = samples.time > program.path.time[program.path.vertices(len(program.moves) - 1).start]
    samples.axes["Z"] -= leaving * np.clip(5 - samples.axes["X"] / 3, 0, 5)
    codes = prove_lines(tmp_path, blocks, "mill_mm", samples=samples).codes
    assert "core 5" in codes and "rapid 7" in codes


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


@pytest.mark.parametrize(
    ("name", "body", "call"),
    [
        ("hole", ["o<hole> sub", "G0 Z1", "G12 I#1 Z-2 D4", "o<hole> endsub"], "o<hole> call [9]"),
        ("77", ["O77", "G0 Z1", "G[12] I#1 Z-2 D4", "M99"], "M98 P77"),
    ],
)
def test_a_pocket_in_a_sub_of_another_file_is_judged(name, body, call, with_sub):
    proof = with_sub(name, body, *MILL, "#1 = 9", call, "G12 I11 Z-3 D4", "G0 Z9")
    assert [pocket.values["radius"] for pocket in proof.pockets] == pytest.approx([9, 11])
    assert [(cut.line, cut.file) for cut in proof.pockets] == [(3, f"{name}.ngc"), (7, "")]
    assert proof.findings == []


@pytest.mark.parametrize(
    ("name", "begin", "call", "end"),
    [("out", "o<out> sub", "o<out> call", "o<out> endsub"), ("78", "O78", "M98 L1 P0078", "M99")],
)
def test_a_rapid_in_a_sub_of_another_file_is_told_in_the_line_of_the_call(
    name, begin, call, end, with_sub
):
    proof = with_sub(name, [begin, *[""] * 9, "G0 X90", end], *MILL, P[0], "G0 Z-1", call, "Z9")
    assert proof.codes == "rapid 7"


def test_a_rapid_in_a_sub_of_m98_in_the_same_file_is_told_in_its_own_line(tmp_path):
    calls = [P[0], "G0 Z-1", "M98 L1 P0078", "Z9", "M2"]
    proof = prove_lines(tmp_path, [*MILL, *calls, "N8 O78", "G0 X90", "M99"], "mill_mm")
    assert proof.codes == "rapid 11"


def test_a_section_in_a_sub_of_another_file_is_judged(with_sub):
    body = ["o<flat> sub", "G12.1", "G1 X#1 F500", "Z-1", "C5", "Z2", "G13.1", "o<flat> endsub"]
    calls = ["o<flat> call [20]", "G0 X60 C0", "o<flat> call [15]"]
    proof = with_sub("flat", body, *LATHE, *calls, machine="lathe_mm")
    report = as_text(proof.judgement, MM, full=True).splitlines()
    titles = [line for line in report if line.startswith("lines ")]
    assert titles == ["lines 2 to 7 of flat.ngc: G12.1"] * 2
    assert proof.findings == []


def test_a_sub_that_linuxcnc_finds_elsewhere_is_judged(tmp_path):
    here = copy_of_machines(tmp_path)
    (here / "hole.ngc").write_text("o<hole> sub\nG12 I9 Z-2 D4\no<hole> endsub\nM2\n")
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*MILL, "o<hole> call", "G0 Z9", "M2", ""]))
    proof = prove(program, read_ini(here / "mill_mm_headless.ini"))
    assert [(cut.line, cut.file) for cut in proof.pockets] == [(2, "hole.ngc")]
    assert proof.codes == ""
