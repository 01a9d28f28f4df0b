# SPDX-License-Identifier: GPL-2.0-or-later
"""Mistakes in programs that are cut as they are written, and verify tells by name."""

import pytest

from g12.tools.commands.main import main
from g12.tools.machine.ini import read_ini
from g12.tools.material.stock import StockText
from g12.tools.plot.scene import scene_of_proof
from g12.tools.units import MM
from g12.tools.verify.proof import prove
from g12.tools.verify.report import as_text, paragraph_of
from support.sim_machines import SIM

MILL = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6", "G0 X0 Y0 Z1"]  # a 10 mm cutter
LATHE = ["G21 G18 G7 G40 G90 G94", "T1 M6"]  # a 12 mm cutter
LEAD_IN, LEAD_OUT = ["G12.1", "G1 C25 F2000", "G41 X27 F1000", "Z-5"], ["G40 X60 F2000", "G13.1"]
FLAT = [*LEAD_IN, "C-25", *LEAD_OUT, "G0 Z2"]
HEXAGON = ["C-7.7942", "X0 C-15.5885", "X-27 C-7.7942", "C7.7942", "X0 C15.5885", "X27 C7.7942"]
SLOT = ["G12.1", "G1 Z-1 F800", "X-18", "X18", "Z2", "G13.1"]


@pytest.fixture
def proof_of(tmp_path):
    """Return the proof of a program on a machine that knows o<turn>, which turns C to 0."""

    def proof(*lines, machine="mill_mm", **more):
        (tmp_path / "turn.ngc").write_text("o<turn> sub\nG0 C0\no<turn> endsub\nM2\n")
        program = tmp_path / "program.ngc"
        program.write_text("\n".join([*lines, "M2", ""]))
        ini = read_ini(SIM / f"{machine}_headless.ini")
        path = f"{ini.get('RS274NGC', 'SUBROUTINE_PATH')}:{tmp_path}"
        ini = ini.replaced({"RS274NGC": {"SUBROUTINE_PATH": path}})
        return prove(program, ini, **more)

    return proof


OF_TOOLS = ("length-not-used",)  # of which most of these programs have one


def told(proof):
    return [text for _, text in proof.findings]


def notes(proof):
    return [each.text() for each in proof.judged if each.is_note and each.code not in OF_TOOLS]


# ---------------------------------------------------------------- where C stands

FORGOTTEN = "C stands where line 10 left it, turned by −39.8° against that section: G0 C0 missing?"


@pytest.mark.parametrize(
    ("between", "found"),
    [
        ([], [FORGOTTEN]),
        (["G0 X60 Z5 (C0)"], [FORGOTTEN]),
        (["G0 C0"], []),
        (["G0 C180"], []),
        (["G0 C-39.805571"], []),
        (["G92 C0"], []),
        (["G10 L20 P1 C0"], []),
        (["o<turn> call"], []),
        (["o1 if [1]", "G0 X60 C[10 - 10]", "o1 endif"], []),
    ],
)
def test_a_forgotten_zero_line_is_found(between, found, proof_of):
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", *FLAT, *between, *FLAT, machine="lathe_mm")
    assert (told(proof), notes(proof)) == (found, [])


def test_two_sections_that_begin_at_the_same_angle_need_no_c(proof_of):
    lines = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X18 Z2 C0"]
    proof = proof_of(*lines, *SLOT, *SLOT, machine="lathe_mm")
    assert len(proof.sections) == 2 and (told(proof), notes(proof)) == ([], RUBS * 2)


def test_a_first_section_without_a_c_word_is_noted(proof_of):
    proof = proof_of(*LATHE, "G0 X60 Z2", *FLAT, machine="lathe_mm")
    assert told(proof) == []
    assert notes(proof) == [
        "no C word comes before the section: its zero line is where C stands, at 0°"
    ]


# ---------------------------------------------------------------- at the centre

RUBS = ["C turns in place at the centre, by 360° in all: there the tool rubs for 1 s"]


def test_how_long_a_tool_rubs_at_the_centre(proof_of):
    lines = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X18 Z2 C0"]
    proof = proof_of(*lines, *SLOT, machine="lathe_mm")
    assert (told(proof), notes(proof)) == ([], RUBS)


def test_a_turn_above_the_face_rubs_nothing(proof_of):
    lines = ["G21 G18 G8 G40 G90 G94", "T3 M6", "G0 X18 Z2 C0", "G12.1", "G1 X-18 F800"]
    proof = proof_of(*lines, "Z-1", "X-10", "G13.1", "G0 Z2", machine="lathe_mm")
    assert (told(proof), notes(proof)) == ([], [])


# ---------------------------------------------------------------- the wrong side


def test_compensation_on_the_wrong_side_of_a_part_is_named(proof_of):
    lead = ["G12.1", "G1 C0 F2000", "G42 X60 F1000", "Z-5"]
    square = ["C-30", "X-60", "C30", "X60", "C0", "Z2", "G40 X100", "G13.1"]
    proof = proof_of(*LATHE, "G0 X100 Z2 C0", *lead, *square, machine="lathe_mm")
    assert told(proof)[0] == (
        "the tool is inside the closed contour, it comes from outside: G41? "
        "(else go inside before the line with G42)"
    )


def test_compensation_on_the_wrong_side_of_a_flat_is_named(proof_of):
    lead = [line.replace("G41", "G42") for line in FLAT]
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", *lead, machine="lathe_mm")
    assert told(proof)[0] == "the tool crosses the contour on its way in: G41?"
    (sign,) = (each for each in scene_of_proof(proof).seen.signs if each.code == "side-crossed")
    assert sign.place == pytest.approx((30, 0, 2))


OVER = ["Z2", "G40 X-70", "G13.1"]


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (["G1 G41 X-27 C-25 F1000", "Z-5", "C25", *OVER], False),
        ([*LEAD_IN[1:], "C-25", "Z2", "G40 X60", "G41 X-27 C-25", "Z-5", "C25", *OVER], False),
        (["G1 Z-5 F1000", "G41 X-27 C-25", "C25", *OVER], True),
    ],
)
def test_a_flat_that_is_approached_above_the_face(lines, found, proof_of):
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", "G12.1", *lines, machine="lathe_mm")
    assert ("the tool crosses the contour" in " ".join(told(proof))) == found


def test_the_inside_of_a_closed_contour_from_inside_is_good(proof_of):
    square = ["C20", "X-40", "C-20", "X40", "C0"]
    lines = ["G12.1", "G1 X10 F1000", "Z-1", "G41 X40", *square, "G40 X10", "Z2", "G13.1"]
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", *lines, machine="lathe_mm")
    assert told(proof) == []


# ---------------------------------------------------------------- sizes


def rows(text):
    """Return a paragraph's rows as a dictionary."""
    return dict(line.strip().split(None, 1) for line in text.splitlines()[1:-1])


def test_the_size_of_a_contour_is_its_own_without_its_leads(proof_of):
    lead = ["G12.1", "G1 C12 F2000", "G41 X27 F1000", "Z-5"]
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", *lead, *HEXAGON, *LEAD_OUT, machine="lathe_mm")
    told = paragraph_of("sections", proof.sections[0], proof, MM)
    assert "  from centre     programmed 13.5 to 15.58" in told
    assert "  across flats    programmed 27, reached 27" in told


def test_a_flat_alone_has_no_width(proof_of):
    proof = proof_of(*LATHE, "G0 X60 Z2 C0", *FLAT, machine="lathe_mm")
    assert "across flats" not in paragraph_of("sections", proof.sections[0], proof, MM)


def test_a_single_ring_tells_of_its_core(proof_of):
    proof = proof_of(*MILL, "G13 I20 Z-3 D4", "G13 I9 Z-3 D4", "G13 I6 K20 Q4 Z-3 D4")
    first, second, third = (paragraph_of("pockets", facts, proof, MM) for facts in proof.pockets)
    assert "  core            radius 10 mm, by design of a single ring" in first
    assert "  core  " not in second and "  left inside     0 mm²" in third


# ---------------------------------------------------------------- depth


@pytest.mark.parametrize(
    ("head", "block", "found"),
    [
        ([], "G13 I9 Z3 D4", "3 lies above Z1"),
        (["G0 Z-4"], "G13 I9 Z-3 D4", "−3 lies above Z−4"),
        (["G91"], "G13 I9 Z3 D4", "4 lies above Z1"),
    ],
)
def test_a_lost_minus_sign_is_found(head, block, found, proof_of):
    text = f"its depth Z{found}, where the tool comes from: it cuts air (a lost minus sign?)"
    proof = proof_of(*MILL, *head, block)
    assert told(proof) == [text]
    assert [each.code for each in scene_of_proof(proof).seen.signs] == ["cuts-air"]


@pytest.mark.parametrize(
    ("z", "found"),
    [("Z5", ["its contour at Z5 lies above Z2"]), ("Z2", []), ("Z-5", [])],
)
def test_a_lost_minus_sign_of_a_section_is_found(z, found, proof_of):
    flat = [z if line == "Z-5" else line for line in FLAT]
    texts = told(proof_of(*LATHE, "G0 X60 Z2 C0", *flat, machine="lathe_mm"))
    assert [text.partition(",")[0] for text in texts] == found


def test_a_section_at_the_depth_it_begins_at_is_good(proof_of):
    flat = [line for line in FLAT if line != "Z-5"]
    lines = ["G0 X60 Z2 C0", "G1 Z-5 F1000", *flat[:-2], "Z2", "G13.1"]
    assert told(proof_of(*LATHE, *lines, machine="lathe_mm")) == []


def test_a_section_in_a_sub_names_the_line_that_calls_it(proof_of):
    lines = ["o100 sub", *FLAT, "o100 endsub", *LATHE, "G0 X60 Z2 C0", "o100 call"]
    proof = proof_of(*lines, machine="lathe_mm")
    title = paragraph_of("sections", proof.sections[0], proof, MM).splitlines()[0]
    assert title == "lines 2 to 8, called in line 14: G12.1"


def test_a_pocket_at_the_present_depth_is_good(proof_of):
    assert told(proof_of(*MILL, "G0 Z-4", "G13 I9 Z-4 D4", "G0 Z1")) == []


# ---------------------------------------------------------------- the travel


@pytest.mark.parametrize(
    ("second", "found"),
    [
        ("G0 X3000", ["the X axis would go to 3004, its limit is 500 mm"]),
        ("G55 G0 X3000", []),
        ("G0 X300", []),
    ],
)
def test_pockets_farther_apart_than_the_travel_are_found(second, found, proof_of):
    block = "G13 I9 Z-3 D4"
    assert told(proof_of(*MILL, block, "G0 Z1", second, block, "G0 Z1")) == found


def test_no_rapid_goes_through_a_pocket_that_cuts_air(proof_of):
    lines = ["G0 X9 Z30", "X0 Y0", "Z1", "G13 I9 Z5 D4", "G0 Z1", "X40", "G13 I9 Z-2", "G0 Z1"]
    assert ["lost minus" in text for text in told(proof_of(*MILL[:2], *lines))] == [True]


# ---------------------------------------------------------------- work offsets

X0 = "X0, the spindle's axis, is at machine X10\n"
AT = "positions below are the machine's; the program's zero is at machine"
MOVED = f"{AT} X2 Y0 Z−30"


@pytest.mark.parametrize(
    ("lines", "first"),
    [
        (["G10 L2 P1 X2 Z-30", "G0 X0 Y0 Z1", "G13 I9 Z-2 D4"], MOVED),
        (["G92 X-2 Y0 Z31", "G13 I9 Z-2 D4"], MOVED),
        (["G13 I9 Z-2 D4"], "line 4  G13 (haas)"),
    ],
)
def test_where_the_programs_zero_is_is_said(lines, first, proof_of):
    assert as_text(proof_of(*MILL, *lines), MM).startswith(first)


@pytest.mark.parametrize(
    ("lines", "first"),
    [
        (SLOT, f"{AT} Z−90; {X0}"),
        (["G7.1 C20", "G1 Z-40 C60 F250", "G7.1 C0"], X0),
    ],
)
def test_where_the_zero_of_a_face_is_is_said(lines, first, proof_of):
    moved = ["G10 L2 P1 X20 Z-90 C30", "G0 X18 Z2 C0"]
    proof = proof_of(*LATHE, *moved, *lines, machine="lathe_mm")
    assert as_text(proof, MM).startswith(first)


# ---------------------------------------------------------------- in a picture


def test_the_picture_of_a_proof_shows_what_stands_and_another_cutter(proof_of):
    seen = scene_of_proof(proof_of(*MILL, "G12 I7 K40 Q15 Z-3 D5", "G0 Z1")).seen
    assert [(each.code, each.line) for each in seen.signs] == [("wrong-cutter", 4)]
    assert [each.line for each in seen.uncut] == [4] and seen.uncut[0].values["shape"].area > 100


# ---------------------------------------------------------------- the spindle

STANDS = "the spindle does not turn here"
POCKET = "G13 I9 Z-2 D4 "


@pytest.mark.parametrize(
    ("lines", "stands"),
    [
        ([POCKET], True),
        (["S900 M3", POCKET], False),
        ([POCKET + "S900 M3"], False),
        (["S900 M3", "M5", POCKET], True),
        (["S900 M3", "T4 M6", POCKET], True),
        (["S900 M3", POCKET, "M5"], False),
        (["M3", POCKET], True),
        (["S900 M3", "M5", "M3", "G0 X1", POCKET], False),
        (["M103 P1", POCKET], False),  # a user's code may turn a spindle
    ],
)
def test_a_pocket_whose_spindle_stands_is_noted(lines, stands, proof_of):
    proof = proof_of(*MILL, *lines)
    assert told(proof) == []
    assert [each.code for each in proof.judged if each.is_note] == [
        "length-not-used",
        *["spindle-stands"] * stands,
    ]


def test_nothing_is_said_of_the_spindle_where_there_are_several(tmp_path):
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*MILL, "S900 M3 $1", POCKET, "M2", ""]))
    ini = read_ini(SIM / "mill_mm_headless.ini").replaced({"TRAJ": {"SPINDLES": "2"}})
    assert "spindle-stands" not in [each.code for each in prove(program, ini).judged]


def test_plot_says_once_that_the_spindle_stands(tmp_path, capsys):
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*MILL, POCKET, POCKET, "M2", ""]))
    words = ["--ini", str(SIM / "mill_mm_headless.ini"), "-o", str(tmp_path / "picture.svg")]
    assert main(["plot", str(program), *words]) == 0
    said = capsys.readouterr().out.splitlines()
    assert [line[:13] for line in said if STANDS in line] == ["note, line 4:"]


# ---------------------------------------------------------------- tool length, feeds, levels

AT_ONE = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "S900 M3"]  # T1 is 25.4 long, T3 25, T4 30
WITH_LENGTH = ["T4 M6", "G43 H4", "G0 X0 Y0 Z1"]


DEEPER = ["length-deeper"]


def codes(proof):
    judged = (each.code for each in proof.judged if each.is_finding or each.is_note)
    return [code for code in judged if code != "spindle-stands"]  # M6 stops it


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ([*WITH_LENGTH, POCKET], []),
        ([*WITH_LENGTH, POCKET, "G0 Z50", "T4 M6", "G43", "G0 X60 Z1", POCKET], []),
        (["T4 M6", "G43 H0", "G0 X0 Y0 Z1", POCKET], []),  # the loaded tool's, in LinuxCNC
        (["T4 M6", "G43 H1", "G0 X0 Y0 Z1", POCKET], ["length-deeper"]),
        (["T4 M6", "G43 H6", "G0 X0 Y0 Z1", POCKET], ["length-higher"]),
        (["T4 M6", "G0 X0 Y0 Z1", POCKET], ["length-not-used"]),
        (["T1 M6", "G43", "G0 Z1", "G12 I5 Z-1", "G0 Z50", "T4 M6", "G0 Z1", POCKET], DEEPER),
        ([*WITH_LENGTH, "G49", "G0 Z1", POCKET], ["length-not-used"]),
        (["G10 L1 P4 Z20 R5", "T4 M6", "G43", "G0 X0 Y0 Z1", POCKET], []),
    ],
)
def test_the_length_in_force_is_compared_with_the_loaded_tools(lines, found, proof_of):
    assert codes(proof_of(*AT_ONE, *lines)) == found


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (["G95 F60", POCKET, "G94"], ["feed-per-revolution"]),
        (["F.2", POCKET], ["feed-per-minute"]),
        (["F20000", POCKET], ["feed-cut-down"]),
        (["G13 I9 D4"], ["above-zero"]),
        (["S900 M4", POCKET], ["spindle-m4"]),
    ],
)
def test_what_no_cut_means_is_noted(lines, found, proof_of):
    assert codes(proof_of(*AT_ONE, *WITH_LENGTH, *lines)) == found


def test_g43_in_a_block_of_its_own_is_no_rapid_into_the_part(proof_of):
    begin = [*AT_ONE, "T4 M6", "S900 M3", "G43", "G0 X0 Y0", "Z1"]
    change = ["G53 G0 Z0", "T3 M6", "G43", "S900 M3", "G0 X60", "Z1"]
    assert codes(proof_of(*begin, POCKET, *change, POCKET.replace("D4", "D3"))) == []


@pytest.mark.parametrize("change", [["T4 M6", "G43"], ["T4 M6 G43"], ["G43 H4", "T4 M6"]])
@pytest.mark.parametrize("system", ["G54", "G55"])
def test_with_a_work_offset_no_z_is_known_before_the_first_one(system, change, proof_of):
    offsets = {5220: 1} | {first + axis: -99.7 for first in (5221, 5241) for axis in range(3)}
    lines = [system, *change, "S900 M3", "G0 X0 Y0", "X5", "Z1", "X0"]
    proof = proof_of("G21 G17 G90 G94 F600", *lines, POCKET, parameters=offsets)
    assert codes(proof) == []


@pytest.mark.parametrize(
    ("feed", "found"), [("G95 F9", ["feed-cut-down"]), ("F.9", ["feed-per-minute"])]
)
def test_feeds_of_a_section_that_no_cut_means_are_noted(feed, found, proof_of):
    section = ["G0 X60 Z2 C0", "G12.1", "G1 X27", "Z-5", "C-25", "X60", "G13.1"]
    assert codes(proof_of(*LATHE, "S2000 M3", feed, *section, machine="lathe_mm")) == found


def test_a_compensated_line_that_goes_straight_back_is_noted(proof_of):
    lost = [word.replace("X-27", "X27") for word in HEXAGON]
    for hexagon, count in ((HEXAGON, 0), (lost, 2)):
        lines = ["G0 X60 Z2 C0", *LEAD_IN, *hexagon, *LEAD_OUT]
        found = codes(proof_of(*LATHE, *lines, machine="lathe_mm"))
        assert found.count("goes-back") == count  # GEOS's version tells whether it has an inside


def test_return_levels_and_c_beside_x_are_noted_on_a_lathe(proof_of):
    lines = ["G99 F.3", "G0 X60 Z2 C0", "G1 X50 C90 F500", *FLAT]
    proof = proof_of(*LATHE, *lines, machine="lathe_mm")
    assert codes(proof) == ["return-level", "native-c"]
    (native,) = (each for each in proof.judged if each.code == "native-c")
    assert native.line == 5 and native.values["most"] > 1000


@pytest.mark.parametrize(
    ("machine", "stored", "noted"),
    [("lathe_mm", "", True), ("lathe_mm", "5163\t-12.5\n", False), ("mill_mm", "", False)],
)
def test_a_g28_whose_place_was_never_set_is_noted_on_a_lathe(machine, stored, noted, tmp_path):
    (tmp_path / "own.var").write_text(stored)
    (tmp_path / "a.ngc").write_text("G21 G90 G94\nG28\nG28\nM2\n")
    values = {"RS274NGC": {"PARAMETER_FILE": str(tmp_path / "own.var")}}
    proof = prove(tmp_path / "a.ngc", read_ini(SIM / f"{machine}_headless.ini").replaced(values))
    assert [each.line for each in proof.judged if each.code == "place-not-set"] == [2] * noted


def test_a_g28_1_in_the_program_sets_the_place(tmp_path):
    (tmp_path / "a.ngc").write_text("G21 G90 G94\nG28.1\nG28\nG30\nM2\n")
    values = {"RS274NGC": {"PARAMETER_FILE": str(tmp_path / "own.var")}}
    ini = read_ini(SIM / "lathe_mm_headless.ini").replaced(values)
    (tmp_path / "own.var").write_text("")
    judged = prove(tmp_path / "a.ngc", ini).judged
    assert [each.line for each in judged if each.code == "place-not-set"] == [4]


# ---------------------------------------------------------------- what is cut, and where

RING, CLEARED = "G13 I20 Z-4 D4", "G13 I7 K20 Q6 Z-4 D4"
SHALLOW = CLEARED.replace("Z-4", "Z-2")


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ([CLEARED, "G0 Z1", RING.replace("I20", "I20.2")], []),
        ([RING], ["core-stands"]),
        ([SHALLOW, "G0 Z1", RING.replace("I20", "I20.2")], ["core-stands"]),
        ([CLEARED, "G0 Z1", "X50", CLEARED], []),
        ([CLEARED, "G0 Z1", "X20", CLEARED], ["cuts-wall"]),
        ([CLEARED, "G0 Z1", "X2", SHALLOW.replace("K20", "K8")], ["cut-before"]),
        ([CLEARED, "G0 Z1", CLEARED], ["cut-before"]),
        ([SHALLOW, "G0 Z1", CLEARED], []),
        ([CLEARED, "G0 Z1", "o1 if [0]", CLEARED, "o1 endif"], ["never-run"]),
        ([CLEARED, "M2", CLEARED], ["never-run"]),
    ],
)
def test_pockets_that_meet_leave_a_core_or_are_not_run_are_noted(lines, found, proof_of):
    assert codes(proof_of(*AT_ONE, *WITH_LENGTH, *lines)) == found


def unjudged(proof):
    others = (each for each in proof.judged if each.is_not_judged)
    return [(each.code, each.line) for each in others if each.code != "travel-unplaced"]


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        (["G0 Z1", "X40", "Z-2", "Z1"], [("rapid-beside", 9)]),
        (["G0 Z-2", "Z1"], []),
        (["G0 Z-2", "G53 G0 X90 Z0"], [("rapid-by-machine", 8)]),
        (["G0 Z1", "G53 G0 X90 Z0"], []),
    ],
)
def test_rapids_within_the_part_that_cannot_be_judged_are_named(lines, found, proof_of):
    proof = proof_of(*AT_ONE, *WITH_LENGTH, CLEARED, *lines)
    assert unjudged(proof) == found and told(proof) == []


@pytest.mark.parametrize("start", ["", "S900 M3"])
def test_a_driven_tool_that_no_code_starts_is_not_judged(start, proof_of):
    proof = proof_of(*LATHE, start, "G0 X60 Z2 C0", *FLAT, machine="lathe_mm")
    assert unjudged(proof) == [("tool-spindle", 5)] * (not start)


def test_a_section_that_stays_outside_of_its_surface_is_noted(proof_of):
    lines = ["S900 M3", "G0 X46 Z-30 C0", "G7.1 C{}", "G1 X36 F200", "C90", "X46", "G7.1 C0"]
    for radius, found in ((20, []), (10, ["above-surface"])):
        text = "\n".join([*LATHE, *lines]).format(radius)
        assert codes(proof_of(text, machine="lathe_mm")) == found


FACE_HOLE = "o<face_hole_at> call [20] [0] [8] [2] [{}] [0] [0] [0]"


@pytest.mark.parametrize(
    ("feed", "after", "found"),
    [
        (120, "G0 Z10", []),
        (12000, "G0 Z10", ["feed-cut-down"]),
        (120, "G0 X20 Z-3\nX30", ["rapid-through"]),
    ],
)
def test_holes_on_the_face_stand_in_material(feed, after, found, proof_of):
    lines = ["S900 M3", "G0 X60 Z10 C0", FACE_HOLE.format(feed), after]
    assert codes(proof_of(*LATHE, *lines, machine="lathe_mm")) == found


def test_what_two_calls_of_a_sub_do_on_one_line_is_listed_as_often_as_counted(proof_of):
    section = ["G12.1", "G1 C25 F2000", "G42 X27 F1000", "Z-5", "C-25", *LEAD_OUT]
    sub = ["o7 sub", "G0 C#1", *section, "G0 Z2", "o7 endsub"]
    calls = ["S900 M3", "G0 X60 Z2", "o7 call [0]", "o7 call [180]"]
    text = as_text(proof_of(*LATHE, *sub, *calls, machine="lathe_mm"), MM)
    assert "line 5 (2 times): the tool crosses the contour on its way in: G41?" in text
    assert f"verdict: {2 * text.count('(2 times)')} findings" in text


def test_a_note_of_a_move_in_a_sub_of_a_file_names_the_line_that_calls_it(proof_of):
    polygon = "o<polar_polygon> call [6] [24] [4] [30] [0] [2] [.3] [600] [300] [0]"
    lines = [*LATHE, "S900 M3", "G0 X60 Z5 C0", polygon]
    found = proof_of(*lines, machine="lathe_mm", stock=StockText("40")).judged
    assert [each.line for each in found if each.code == "plunge-into-stock"] == [5]
