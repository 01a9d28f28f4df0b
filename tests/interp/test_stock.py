# SPDX-License-Identifier: GPL-2.0-or-later
"""The bar and the block, read from a text and shown; how they are judged: test_verify_codes.py."""

import pytest

from g12.tools.commands.main import main
from g12.tools.errors import UsageError
from g12.tools.material.stock import read_stock
from g12.tools.units import MM, UNITS
from support.sim_machines import PROGRAMS, SIM

MILL, LATHE = (str(SIM / f"{name}_headless.ini") for name in ("mill_mm", "lathe_mm"))
HEAD = ["G21 G17 G40 G49 G54 G80 G90 G94 F600", "T4 M6"]  # a 10 mm cutter
INCH = 25.4


@pytest.mark.parametrize(
    ("text", "turning", "found"),
    [
        ("40", True, (40, None, None, 0)),
        ("bar 1.5in", True, (1.5 * INCH, None, None, 0)),
        ("100x80x20", False, (0, (100, 80, 20), None, 0)),
        ("100×80×20@-10,-5 mm", False, (0, (100, 80, 20), (-10, -5), 0)),
        ("4x3x.5@0,0 bore 1.2in", False, (0, (101.6, 76.2, 12.7), (0, 0), 30.48)),
        ("100x80x20@-10,-5,-3", False, (0, (100, 80, 20), (-10, -5), 0, 17)),
        ("bore 30", False, (0, None, None, 30)),
    ],
)
def test_a_stock_is_read_as_it_is_said(text, turning, found):
    for value, expected in zip(read_stock(text, turning, MM)[1:], found):
        assert value == expected or value == pytest.approx(expected)


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
