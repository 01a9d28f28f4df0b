# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program's text says: words as LinuxCNC reads them, codes as the INI gives them."""

from pathlib import Path

import pytest

from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import read_line
from g12.tools.verify.reading.codes import Codes


def codes_of(*remaps):
    """Return the codes of a machine with such REMAP lines."""
    return Codes(Ini(Path("x.ini"), ("[RS274NGC]", *(f"REMAP = {remap}" for remap in remaps))))


CODES = codes_of(
    "G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done",
    "G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done",
    "G12.1 modalgroup=1 python=polar_on",
    "G13.1 modalgroup=1 python=polar_off",
    "G7.1 modalgroup=1 python=cylinder_mode",
    "M6 modalgroup=6 ngc=change",
)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("n10g12i.5 z - 1. (a comment X9) d01; Y9", "N10 G12 I.5 Z-1. D01"),
        ("(only a comment)", ""),
        ("X[#1+[2*3]] Y#<a b> Z-#2", "X[#1+[2*3]] Y#<ab> Z-#2"),
        ("X sin[30] Y-atan[1]/[2]Z##3", "Xsin[30] Y-atan[1]/[2] Z##3"),
        ("%", ""),
    ],
)
def test_words_are_read_as_linuxcnc_reads_them(line, words):
    assert " ".join(letter + value for letter, value in read_line(1, line).words) == words


@pytest.mark.parametrize("line", ["o100 while [#1 LT 5]", "N5 o<sub> call [1]", "/o1 if"])
def test_control_lines_are_recognized(line):
    assert read_line(1, line).control


@pytest.mark.parametrize(
    ("line", "inside", "does"),
    [
        ("G12.1", False, "on"),
        ("N5 G13.1", True, "off"),
        ("G1 X5", False, ""),
        ("G7.1 C0.", False, "off"),
    ],
)
def test_a_code_begins_or_ends_a_section(line, inside, does):
    assert CODES.switch(read_line(1, line), inside) == does


def test_lines_whose_words_matter_are_those_with_a_code_of_the_package_or_compensation():
    lines = ["T1 M6", "G[13] I5", "G#5 I5", "G41 D1", "G12.1", "G41 X1", "G13.1"]
    texts = [read_line(number, line) for number, line in enumerate(lines)]
    assert {text.number for text in CODES.selected_in(texts)} == {1, 2, 3, 4, 6}
    known = [code for code in ("G13", "G12.1", "G2", "M6", "") if CODES.knows(code)]
    assert known == ["G13", "G12.1"]


def test_a_cycle_is_known_by_its_handler_or_its_sub():
    own = codes_of("G22 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done",
                   "G12 modalgroup=1 prolog=mine ngc=g12_haas",
                   "G13.2 modalgroup=1 prolog=mine ngc=g12_circle_mill")  # fmt: skip
    found = [own.cycle_of("", (code,)) for code in (22.0, 12.0)]
    assert [(cycle.dialect, cycle.turn) for cycle in found] == [("haas", -1), ("haas", 0)]
    assert own.cycle_of("", (13.2,)) is None and own.knows("G13.2")
    assert CODES.cycle_of("", (1.0,)) is None
