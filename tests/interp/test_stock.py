# SPDX-License-Identifier: GPL-2.0-or-later
"""The bar and the block: read from a text, plunged into, run into, left standing."""

import json
import math

import pytest

from g12.tools.commands.main import main
from g12.tools.errors import UsageError
from g12.tools.material.stock import read_stock
from g12.tools.units import MM, UNITS
from g12.tools.verify.report import STOCK, rows_of
from support.sim_machines import PROGRAMS, SIM

MILL, LATHE = (str(SIM / f"{name}_headless.ini") for name in ("mill_mm", "lathe_mm"))
HEAD = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6"]  # a 10 mm cutter
FACE = ["G21 G18 G7 G40 G90 G94", "T1 M6", "G0 X60 Z2 C0"]  # a 12 mm cutter
FLAT = ["G12.1", "G1 C25 F2000", "G41 X27 F1000", "Z-5", "C-25", "G40 X60 F2000", "G13.1", "G0 Z2"]
INCH = 25.4
KINDS = "notes", "findings"
CODES = ("plunge-into-stock", "no-stock-met", "cylinder-aside", "below-block", "rapid-through",
         "rapid-into", "bar-remains")  # fmt: skip


@pytest.mark.parametrize(
    ("text", "turning", "found"),
    [
        ("40", True, (40, None, None, 0)),
        ("bar 1.5in", True, (1.5 * INCH, None, None, 0)),
        ("100x80x20", False, (0, (100, 80, 20), None, 0)),
        ("100×80×20@-10,-5 mm", False, (0, (100, 80, 20), (-10, -5), 0)),
        ("4x3x.5@0,0 bore 1.2in", False, (0, (101.6, 76.2, 12.7), (0, 0), 30.48)),
        ("bore 30", False, (0, None, None, 30)),
    ],
)
def test_a_stock_is_read_as_it_is_said(text, turning, found):
    for value, wanted in zip(read_stock(text, turning, MM)[1:], found):
        assert value == wanted or value == pytest.approx(wanted)


def test_a_number_without_a_unit_is_in_the_one_shown():
    assert read_stock("2", True, UNITS["inch"]).diameter == 2 * INCH


@pytest.mark.parametrize(
    ("text", "turning"),
    [("100x80x20", True), ("0", True), ("40", False), ("", False), ("100x80", False),
     ("bore 0", False), ("1x2x0", False), ("40 ft", True), ("-40", True)],
)  # fmt: skip
def test_what_is_no_stock_is_refused_with_the_forms(text, turning):
    with pytest.raises(UsageError, match="diameter: 40" if turning else "100x80x20"):
        read_stock(text, turning, MM)


def test_an_empty_stock_is_refused(tmp_path, capsys):
    (tmp_path / "program.ngc").write_text("\n".join([*HEAD, "G13 I9 Z-1 D4", "M2", ""]))
    assert main(["verify", str(tmp_path / "program.ngc"), "--ini", MILL, "--stock", ""]) == 2
    assert "--stock ''" in capsys.readouterr().err


@pytest.fixture
def told(tmp_path, capsys):
    """Return the exit code, and notes and findings about the stock."""

    def tell(stock, *lines, ini=MILL):
        program = tmp_path / "program.ngc"
        program.write_text("\n".join([*lines, "M2", ""]))
        code = main(["verify", str(program), "--ini", ini, "--stock", stock, "--json"])
        proof = json.loads(capsys.readouterr().out)
        said = ([each for each in proof[kind] if each["code"] in CODES] for kind in KINDS)
        return code, *([f"line {each['line']}: {each['text']}" for each in some] for some in said)

    return tell


@pytest.mark.parametrize(
    ("stock", "found"),
    [
        ("100x80x20", ["line 4: it plunges with 100 % of the cutter into the stock, at X0 Y0"]),
        ("100x80x20@0,0", ["line 4: it plunges with 25 % of the cutter into the stock, at X0 Y0"]),
        ("100x80x20 bore 12", []),
        ("bore 12", []),
        ("bore 8", ["line 4: it plunges with 36 % of the cutter into the stock, at X0 Y0"]),
        ("100x80x2 bore 12", ["line 4: the lowest cut is 1 mm below the block"]),
    ],
)
def test_a_plunge_into_the_block_is_told(stock, found, told):
    assert told(stock, *HEAD, "G0 X0 Y0 Z1", "G13 I7 K20 Q6 Z-3 D4") == (0, found, [])


def test_a_rapid_into_the_block_is_found(told):
    lines = ["G0 X80 Y0 Z1", "Z-3", "X30", "G0 Z1", "X0", "G13 I7 K20 Q6 Z-3 D4", "G0 Z1"]
    code, _, (text,) = told("100x80x20", *HEAD, *lines)
    assert code == 1 and text.startswith("line 5: a rapid goes through material, from X54.752 Y0 ")
    assert told("60x80x20@-30,-40 bore 12", *HEAD, "G0 X36", *lines[:2], *lines[3:])[0] == 0


def test_a_rapid_into_a_hole_that_is_bored_is_good(told):
    lines = ["G0 X0 Y0 Z1", "Z-3", "G13 I7 K20 Q6 Z-3 D4", "G0 Z1"]
    assert told("100x80x20 bore 12", *HEAD, *lines) == (0, [], [])
    code, _, found = told("100x80x20", *HEAD, *lines)
    assert code == 1 and "line 4: a rapid goes down into 76.969 mm² of material" in found[0]


def test_a_bore_alone_where_no_pocket_is_has_no_bounds_to_show():
    assert list(rows_of(STOCK, {"bounds": [], "top": 0.0}, MM)) == []


# ---------------------------------------------------------------- the bar


def test_a_plunge_beside_the_bar_is_good_and_nothing_stands(told):
    assert told("40", *FACE, *FLAT, ini=LATHE) == (0, [], [])


def test_a_plunge_into_the_bar_is_told_with_its_share(told):
    flat = [line.replace("C25", "C6") for line in FLAT]
    _, (note,), _ = told("40", *FACE, *flat, ini=LATHE)
    assert "line 7: it plunges with " in note and note.endswith("at X19.5 Y6 of the face")


def test_what_of_the_bar_stands_beyond_a_flat_is_found(told):
    code, _, (text,) = told("80", *FACE, *FLAT, ini=LATHE)
    segment = 40**2 * math.acos(13.5 / 40) - 13.5 * math.sqrt(40**2 - 13.5**2)
    area = float(text.split()[2])
    assert code == 1 and text.startswith("line 4: ") and text.endswith("at Z−5")
    assert segment - 50 * 12 - 450 < area < segment - 50 * 12  # the leads cut some of it


def test_a_section_above_the_bar_leaves_all_of_it(told):
    flat = [line for line in FLAT if line != "Z-5"]
    code, _, (text,) = told("40", *FACE, *flat, ini=LATHE)
    segment = 20**2 * math.acos(13.5 / 20) - 13.5 * math.sqrt(20**2 - 13.5**2)
    assert code == 1 and float(text.split()[2]) == pytest.approx(segment, rel=1e-3)


def test_a_rapid_into_the_bar_is_found(told):
    lines = [*FLAT, "G0 C180", "G12.1", "G1 C25 F2000", "G13.1", "G0 Z-3", "X20", "Z2"]
    code, _, found = told("40", *FACE, *lines, ini=LATHE)
    assert code == 1 and "line 17: a rapid goes through material" in found[0]


def test_the_hexagon_begins_beside_its_bar(capsys):
    program = str(PROGRAMS / "polar" / "hexagon.ngc")
    assert main(["verify", program, "--ini", LATHE, "--stock", "40", "--full"]) == 0
    out = capsys.readouterr().out
    assert "stock: 40" in out and "plunges" not in out


@pytest.mark.parametrize(
    ("program", "ini", "stock", "shown"),
    [
        ("polar/hexagon.ngc", LATHE, "40", "bar 40"),
        ("haas/O60131.ngc", str(SIM / "mill_inch_headless.ini"), "6x5x2", "stock 6x5x2"),
    ],
)
def test_a_stock_is_drawn(program, ini, stock, shown, tmp_path):
    picture = tmp_path / "picture.svg"
    words = [str(PROGRAMS / program), "--ini", ini, "--stock", stock, "-o", str(picture)]
    assert main(["plot", *words]) == 0
    text = picture.read_text()
    assert shown in text and text.count("stroke: #b39a6b") == (2 if "x" in stock else 1) + 1


def test_a_stock_that_is_none_ends_with_2(capsys):
    program = str(PROGRAMS / "polar" / "hexagon.ngc")
    assert main(["verify", program, "--ini", LATHE, "--stock", "40x40"]) == 2
    assert "'40x40' is not a bar's diameter: 40, 40mm, 1.5in" in capsys.readouterr().err


# ---------------------------------------------------------------- beside the stock

MISSED = "line 4: it meets nothing of the stock"
PLUNGES = "line 4: it plunges with 100 % of the cutter into the stock, at X40 Y0"
FAR = [line.replace("X27", "X44") for line in FLAT]


@pytest.mark.parametrize(
    ("stock", "lines", "ini", "found"),
    [
        ("40", [*FACE, *FLAT, "G0 C0", *FAR], LATHE, ["line 13: it meets nothing of the stock"]),
        ("40", [*FACE, *(line.replace("-5", "5") for line in FLAT)], LATHE, [MISSED]),
        ("20x20x9", [*HEAD, "G0 X40 Y0 Z1", "G12 I9 Z-1 D4"], MILL, [MISSED]),
        ("99x20x9", [*HEAD, "G0 X40 Y0 Z1", "G12 I9 Z-1 D4"], MILL, [PLUNGES]),
    ],
)
def test_what_meets_nothing_of_the_stock_is_told(stock, lines, ini, found, told):
    assert told(stock, *lines, ini=ini)[1] == found


def test_a_lathe_program_that_turns_nothing_has_a_bar_too(told):
    code, notes, _ = told("40", *FACE, "G12.1", "G1 Z-2 F300", "Z2", "G13.1", ini=LATHE)
    assert (code, notes) == (0, [MISSED])


GROOVE = ["G0 X44 Z-20", "G7.1 C20", "G1 X36 F500", "C90"]


@pytest.mark.parametrize(("end", "found"), [("G1 X44", []), ("G1 Z-19", ["line 10"])])
def test_a_section_on_a_cylinder_is_cut_into_it(end, found, told):
    _, notes, findings = told("40", *FACE, *GROOVE, end, "G7.1 C0", "G0 C0", ini=LATHE)
    assert notes == [] and [text.split(":")[0] for text in findings] == found
