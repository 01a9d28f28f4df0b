# SPDX-License-Identifier: GPL-2.0-or-later
"""verify on sample programs of every dialect, on words with expressions, on sabotaged cycles."""

import json

import pytest

from g12.tools import units
from g12.tools.errors import ProgramError
from g12.tools.machine.ini import read_ini
from g12.tools.verify.proof import prove
from g12.tools.verify.report import as_json, as_text
from support.sim_machines import PROGRAMS, SIM, copy_of_machines

INCH = 25.4


def ini(name):
    return read_ini(SIM / f"{name}_headless.ini")


def proof_of(program, machine, **options):
    return prove(PROGRAMS / program, ini(machine), **options)


def proof_of_text(tmp_path, lines, machine="mill_mm", changed=None, **options):
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*lines, "M2", ""]))
    return prove(program, ini(machine).replaced(changed or {}), **options)


def radii_of(proof):
    return [facts.commanded.wall.radius for facts in proof.pockets]


MM = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6 S3000 M3"]  # a 10 mm cutter


# ---------------------------------------------------------------- the manual's pockets


@pytest.fixture(scope="module", params=["O60121", "O60131"])
def manual(request):
    expected = json.loads((PROGRAMS / "haas" / f"{request.param}.json").read_text())
    tools = {int(tool): size for tool, size in expected["tools"].items()}
    return expected, proof_of(f"haas/{request.param}.ngc", "mill_inch", tools=tools)


def test_every_pocket_is_found_and_comes_out_as_printed(manual):
    expected, proof = manual
    assert len(proof.pockets) == len(expected["pockets"])
    for printed, facts in zip(expected["pockets"], proof.pockets):
        assert facts.line == printed["line"]
        assert facts.code == printed["code"]
        assert facts.values["reached"] == pytest.approx(printed["finished"] * INCH, abs=1e-6)
        assert facts.values["rings"] == pytest.approx(
            [ring * INCH for ring in printed["rings"]], abs=1e-5
        )
        depths = [facts.commanded.wall.height(depth) / INCH for depth in facts.commanded.depths]
        assert depths == pytest.approx(printed["depths"], abs=1e-4)
        assert facts.commanded.wall.origin[:2] / INCH == pytest.approx(printed["centre"])
        assert facts.deviation < 1e-6


# ---------------------------------------------------------------- other dialects


@pytest.mark.parametrize("clearing", ["rings", "spiral"])
@pytest.mark.parametrize(("distance", "repeats"), [("G90", ""), ("G91", "L3")])
def test_a_pocket_without_z_is_cut_where_the_tool_stands(distance, repeats, clearing, tmp_path):
    rough, finish = "G13 I7 K20 Q6 Z-3 D4", f"{distance} G13 I20.5 {repeats} D4"
    lines = [*MM, "G0 X3 Y4 Z1", rough, finish, "G90 G0 Z1"]
    proof = proof_of_text(tmp_path, lines, changed={"G12": {"CLEARING": clearing}})
    assert proof.findings == []
    depths = [facts.commanded.wall.height(facts.commanded.deepest) for facts in proof.pockets]
    assert depths == pytest.approx([-3, -3])


# ---------------------------------------------------------------- words and modes


def test_expressions_loops_and_skipped_blocks(tmp_path):
    lines = [
        *MM,
        "#<r> = 12 #2 = 0",
        "o100 while [#2 LT 3]",
        "G0 Z1",
        "X[#2 * 60] Y[0 - #2]",
        "N5 G12 I[#<r> + #2] Z-[1 + 1] D4 (X99 Y99)",
        "/G13 I8 Z-2 D4",
        "#2 = [#2 + 1]",
        "o100 endwhile",
    ]
    proof = proof_of_text(tmp_path, lines)
    assert radii_of(proof) == pytest.approx([12, 13, 14])
    assert [facts.commanded.wall.origin[0] for facts in proof.pockets] == pytest.approx(
        [0, 60, 120]
    )
    assert {facts.line for facts in proof.pockets} == {7}
    assert proof.findings == []


def long_block(start, length):
    """Return a block that has a length and ends in an expression whose value is 10."""
    return f"{start}[10{'+0' * ((length - len(start) - len('[10]')) // 2)}]"


HOLE = ["o<hole> sub", "G0 Z1", "G12 I#1 Z#2 D4", "G0 Z1", "o<hole> endsub"]
AT_0 = "G0 X0 Y0 Z1"


@pytest.mark.parametrize(
    ("lines", "radii"),
    [
        ([*HOLE, *MM, "o<hole> call [9] [-2]", "G0 X40", "o<hole> call [11] [-3]"], [9, 11]),
        ([*MM, AT_0, "G12 I7 K20 Q6 Z-2 D4 M2"], [20]),  # a cycle in the last block
        # in inches a spring pass does not move down again
        ([*MM, "G20 G0 X0 Y0 Z.1", "G12 I.3 K.8 Q.2 Z-.1 L3 D4 F20"], [0.8 * INCH]),
        ([*MM, "#5 = 12", AT_0, "G[10 + 2] I7 K20 Q6 Z-2 D4"], [20]),
        ([*MM, "#5 = 12", AT_0, "G#5 I7 K20 Q6 Z-2 D4"], [20]),
        ([*MM, AT_0, long_block("G12Z-2I", 235)], [10]),
        ([*MM, AT_0, long_block("G12Z-2I", 251)], [10]),  # as long as LinuxCNC reads it
        ([*MM, "G20 G0 X0 Y0 Z.1", "G21 G13 I8 K40 Q5 Z-12 D4 F500"], [40]),
        ([*MM, "G64 P.02", "G0 X0 Y0 Z3", "G20 G13 I.3 K1. Q.3 Z-.5 D4 F20"], [INCH]),
        ([*MM, "G64 P.02", "G0 X0 Y0 Z3", "G20 G13.2 X0 Y0 Z-.2 I.1 R1. D1 H1 F20"], [INCH]),
    ],
)
def test_pockets_that_are_written_in_other_ways(lines, radii, tmp_path):
    proof = proof_of_text(tmp_path, lines)
    assert radii_of(proof) == pytest.approx(radii) and proof.findings == []


@pytest.mark.parametrize(
    ("place", "cut", "height"),
    [
        ("Z.1 C0", ["G1 Z[.5-.49991]", "X1", "Z-.1", "X2"], 0.1),
        ("Z.00009 C-.00009", ["G1 Z-.1", "X1", "Z.00009", "X2 C-.00009"], 0.00009),
    ],
)
def test_next_to_zero_is_not_zero(place, cut, height, tmp_path):
    """LinuxCNC 2.9 tells that less than 0.0001 is 0."""
    lines = ["G20 G18 G8 G40 G90 G94 F10", "T1 M6 S1000 M3", f"G0 X2 {place}", "G12.1", *cut]
    proof = proof_of_text(tmp_path, [*lines, "G13.1"], "lathe_inch")
    (facts,) = proof.sections
    assert facts.commanded.height == pytest.approx(height * INCH, abs=1e-9)
    assert proof.findings == []


@pytest.fixture
def with_sub(tmp_path):
    """Return the proof of a program on a machine that has a sub in a file of its own."""

    def proof(name, body, *lines, machine="mill_mm"):
        folder = tmp_path / "subs"
        folder.mkdir()
        (folder / f"{name}.ngc").write_text("\n".join([*body, ""]))
        path = f"{ini(machine).get('RS274NGC', 'SUBROUTINE_PATH')}:{folder}"
        return proof_of_text(tmp_path, lines, machine, {"RS274NGC": {"SUBROUTINE_PATH": path}})

    return proof


@pytest.mark.parametrize(
    ("name", "body", "call"),
    [
        (
            "hole",
            ["o<hole> sub", "G0 Z1", "G12 I#1 Z-2 D4", "o<hole> endsub"],
            "o<hole> call",
        ),
        ("77", ["o77 sub", "G0 Z1", "G12 I[#1] Z-2 D4", "o77 endsub"], "o77 call"),
        ("77", ["O77", "G0 Z1", "G[12] I#1 Z-2 D4", "M99"], "M98 P77"),
    ],
)
def test_a_pocket_in_a_sub_of_another_file_is_measured(name, body, call, with_sub):
    lines = ["#1 = 9", call if "98" in call else f"{call} [9]", "G12 I11 Z-3 D4"]
    proof = with_sub(name, body, *MM, *lines)
    assert radii_of(proof) == pytest.approx([9, 11])
    assert [(cut.line, cut.file) for cut in proof.pockets] == [(3, f"{name}.ngc"), (5, "")]
    assert proof.findings == []


def test_an_event_in_a_sub_that_a_sub_calls_is_measured(with_sub):
    body = [
        "o<event> sub",
        "o<circle_mill> call [7] [0] [0] [-2] [1] [-9999] [#1] [0] [2] [-9999] [-9999] [-9999]"
        " [-9999] [-9999] [-9999]",
        "o<event> endsub",
        "M2",
    ]
    own = ["o<way> sub", "o<event> call [#1]", "o<way> endsub"]
    proof = with_sub("event", body, *own, *MM, "G0 Z1", "o<way> call [20]", "o<way> call [30]")
    assert radii_of(proof) == pytest.approx([20, 30])
    assert proof.findings == []


def test_a_sub_that_linuxcnc_finds_elsewhere_than_the_copy_is_a_finding(tmp_path):
    here = copy_of_machines(tmp_path)
    (here / "hole.ngc").write_text("o<hole> sub\nG12 I9 Z-2 D4\no<hole> endsub\nM2\n")
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*MM, "G0 Z1", "o<hole> call", "M2", ""]))
    proof = prove(program, read_ini(here / "mill_mm_headless.ini"))
    assert (proof.pockets, proof.lines_with("not-measured")) == ([], [(4, "G12")])


@pytest.mark.parametrize("body", [["G41 D6 G1 X40 F100", "Y-30", "G40 X80"], ["G41 D6", "G40"]])
def test_a_d_that_a_sub_in_its_own_file_commanded_is_remembered(body, with_sub):
    body = ["o<offset> sub", *body, "o<offset> endsub"]
    proof = with_sub("offset", body, *MM, "G0 Z1", "o<offset> call", "G0 X0 Y0", "G12 I30 Z-2")
    (facts,) = proof.pockets
    assert (facts.commanded.cutter.named, facts.commanded.cutter.radius) == (6, 10)
    assert "the toolpath" not in str(proof.findings)


def test_a_section_in_a_sub_of_another_file_is_measured(with_sub):
    body = ["o<flat> sub", "G12.1", "G1 X#1 F500", "C5", "G13.1", "o<flat> endsub"]
    lines = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X30 Z2 C40", "o<flat> call [20]"]
    lines += ["G0 X30 C0", "o<flat> call [15]"]
    proof = with_sub("flat", body, *lines, machine="lathe_mm")
    assert [facts.commanded.elements[0].end for facts in proof.sections] == [20, 15]
    assert [(facts.line, facts.last) for facts in proof.sections] == [(2, 5)] * 2
    assert proof.findings == []
    report = as_text(proof, units.MM, full=True).splitlines()
    titles = [line for line in report if line.startswith("lines ")]
    assert titles == [f"lines 2 to 5 of flat.ngc, called in line {line}: G12.1" for line in (4, 6)]
    assert json.loads(as_json(proof))["sections"][0]["file"] == "flat.ngc"


def test_a_section_of_another_file_that_asks_for_a_position_is_in_doubt(with_sub):
    body = ["o<flat> sub", "G12.1", "G1 X[#<_x> - 5] F500", "G13.1", "o<flat> endsub"]
    lines = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X30 Z2 C40", "o<flat> call"]
    proof = with_sub("flat", body, *lines, machine="lathe_mm")
    assert [facts.commanded.doubt for facts in proof.sections] == ["line 3 asks for a position"]


@pytest.mark.parametrize("mode", ["G90", "G91"])
def test_the_call_form_goes_from_the_tool_in_incremental_mode(mode, tmp_path):
    call = "o<circle_mill> call [7] [50] [7] [-6] [2] [10] [40] [2] [2] [3] [-9999] [.3] [150]"
    lines = [*MM, "G0 X10 Y10 Z5", mode, f"{call} [800] [400]"]
    proof = proof_of_text(tmp_path, lines)
    (facts,) = proof.pockets
    centre, depth = ([60, 17], -4) if mode == "G91" else ([50, 7], -6)
    assert facts.commanded.wall.origin[:2] == pytest.approx(centre)
    assert facts.commanded.wall.height(facts.commanded.deepest) == pytest.approx(depth)
    assert proof.findings == []


@pytest.mark.parametrize("modes", ["G20", "G91", "G20 G91", "G90.1", "G64 P0.1"])
@pytest.mark.parametrize("offset", ["", "G10 L2 P1 X7 Y-3 Z2 R30", "G92 X4 Y5 Z1"])
def test_modes_and_work_coordinates_do_not_matter(modes, offset, tmp_path):
    unit = INCH if "G20" in modes else 1.0
    depth = -3 / unit if "G91" in modes else -2 / unit
    lines = [
        *MM,
        offset,
        "G0 X10 Y20 Z1",
        modes,
        f"G13 X{5 / unit:.9f} Y{-2 / unit:.9f} I{7 / unit:.9f} K{20 / unit:.9f} Q{5 / unit:.9f}"
        f" Z{depth:.9f} D4 F{600 / unit}",
    ]
    proof = proof_of_text(tmp_path, lines)
    (facts,) = proof.pockets
    assert proof.findings == []
    assert facts.commanded.wall.radius == pytest.approx(20, abs=1e-6)


FACE = ["G21 G18 G8 G40 G90 G94 G64", "T3 M6", "S1000 M3", "G0 X30 Z2 C0"]
ROUND_A_FLAT = ["G0 X30 Z2 C0", "G12.1", "G1 X20 C3 F900", "G42 X14 C0 F600", "Z-1 F200"]
ROUND_A_FLAT += ["C10 F600", "X-10", "C-10", "X14", "C0", "G40 X20 C-3", "Z2", "G13.1"]


@pytest.mark.parametrize("units", ["", "G20"])
@pytest.mark.parametrize(
    "offset", ["G10 L2 P1 X4 Z-3 C20", "G10 L2 P1 X-9", "G10 L20 P1 X35 Z4", "G55 G10 L2 P2 X70 C9"]
)
def test_the_spindle_is_where_x0_is(offset, units, tmp_path):
    last = units and "G20"  # X0 is told in the units of the end
    lines = [*FACE[:3], "G0 X31 Z9 C0", offset, *ROUND_A_FLAT, last]
    proof = proof_of_text(tmp_path, lines, "lathe_mm")
    assert proof.findings == [] and len(proof.sections) == 1
    (facts,), moves = proof.sections, proof.subject.trace.moves
    assert facts.values["lowest_feed"] == pytest.approx(600, rel=0.01)
    x0 = moves[facts.commanded.at].start[0] - facts.commanded.start.real
    assert proof.subject.part.centre == pytest.approx(x0)


def test_a_program_that_moves_by_its_line_numbers_is_told_in_one_line(tmp_path):
    condition = ["o1 if [#<_line> GT 6]", "G0 X5", "o1 endif"]
    lines = [*MM, "G0 X0 Y0 Z1", "G12 I20 Z-1 D4", *condition]
    with pytest.raises(ProgramError, match="moves differently with reports between its lines"):
        proof_of_text(tmp_path, lines)


# ---------------------------------------------------------------- polar sections


@pytest.mark.parametrize("machine", ["lathe_mm", "lathe_mm_kinematics"])
def test_short_segments_close_by_the_centre_are_longer_than_their_line(machine, tmp_path):
    lines = ["G21 G18 G7 G90 G94 G64 P0.01", "G0 X120 Z5 C0", "G12.1", "F1008.844"]
    lines += ["G1 X-57.93351 C0.11121", "G13.1"]
    assert not proof_of_text(tmp_path, lines, machine).findings


FLATS = ["o100 sub", "G0 C#1", "G12.1", "G1 C25 F2000", "G41 X#2 F1000", "Z-5",
         "C-25", "G40 X60 F2000", "G13.1", "G0 Z2", "o100 endsub", "G21 G18 G7 G40 G90 G94",
         "T1 M6", "G0 X60 Z2 C0", "o100 call [0] [27]", "o100 call [180] [30]"]  # fmt: skip


def test_a_section_in_a_sub_is_measured_at_every_call(tmp_path):
    proof = proof_of_text(tmp_path, FLATS, "lathe_mm")
    assert [facts.line for facts in proof.sections] == [3, 3]
    assert proof.findings == []
    assert [facts.values["radii"][0] for facts in proof.sections] == pytest.approx([13.5, 15])
    assert all(0 < facts.deviation < proof.tolerances.polar for facts in proof.sections)
    assert {facts.values["lowest_feed_line"] for facts in proof.sections} <= {4, 5, 7, 8}


# ---------------------------------------------------------------- the machine's travel


def test_a_pocket_wider_than_the_travel_fits_nowhere(tmp_path):
    changed = {"AXIS_Y": {"MIN_LIMIT": 0, "MAX_LIMIT": 25}}
    proof = proof_of_text(tmp_path, [*MM, "G0 Z1", "G12 I20 Z-1 D4"], changed=changed)
    assert [text for _, text in proof.findings] == ["the Y axis would go to −15, its limit is 0 mm"]


def test_what_a_program_starts_with_can_be_given(tmp_path):
    lines = [*MM, "G0 X0 Y0 Z1", "G12 I#31 Z-1 D4"]
    proof = proof_of_text(tmp_path, lines, parameters={31: 20, 5221: 490})
    assert proof.pockets[0].commanded.wall.radius == 20
    assert [text for _, text in proof.findings] == [
        "the X axis would go to 505, its limit is 500 mm"
    ]


def test_a_part_on_the_face_may_be_slower_where_c_could_not_follow_it(tmp_path):
    lines = ["G21 G18 G8 G90 G94 G64", "G0 X30 Z2 C0", "G12.1", "G1 X10 C-30 F5000", "C30",
             "G13.1"]  # fmt: skip
    proof = proof_of_text(tmp_path, lines, "lathe_mm_kinematics")
    own = [move for move in proof.subject.trace.moves if move.line == 5]
    assert min(move.feed for move in own if move.start[5] == move.end[5]) < 4999
    assert proof.findings == []


def test_a_line_on_the_face_may_be_slower_however_near_it_comes(tmp_path):
    lines = ["G21 G18 G8 G90 G94 G64 P0.01", "T1 M6", "G0 X60 Z5 C-45", "G12.1", "F6637.24"]
    lines += ["G1 X-15.50263 C-22.13613", "X-8 C-12", "X-20 F200", "G13.1"]
    proof = proof_of_text(tmp_path, lines, "lathe_mm_kinematics")
    own = [move for move in proof.subject.trace.moves if move.line == 6]
    assert min(move.feed for move in own) < 5000 and len(own) < 10
    assert proof.findings == []
