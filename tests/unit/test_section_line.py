# SPDX-License-Identifier: GPL-2.0-or-later
"""One line of a section: splitting and rewriting of raw lines, meaning of parsed blocks."""

import pytest

from g12.errors import LONGEST_BLOCK
from g12.polar.polar_section import POLAR_WORDS
from g12.section.block_rules import SectionBlock, alone, m_code_alone
from g12.section.effects import (
    SectionModes,
    action_text,
    comment_text,
    modes_after,
)
from g12.section.line import split_line, split_words

MODES = SectionModes(incremental=False, per_revolution=False, feed=100.0, speed=500.0, motion=10)


def block(*, g=(), m=(), motion=-1, **words):
    """Return a block with G codes (times ten) and M codes given by modal group."""
    by_group = [[-1] * 17, [-1] * 11]
    for codes, given in zip(by_group, (dict(g), dict(m))):
        for group, code in given.items():
            codes[group] = code
    return SectionBlock(tuple(by_group[0]), tuple(by_group[1]), motion, words)


@pytest.mark.parametrize(
    "raw",
    ["", " ", "G0 X1", "G12.1", "G1.5", "G10", "G9 X1", "U1", "H1", "Y1", "X#1", "X[1]", "X1 (a)",
     "X1;a", "/X1", "O1 sub", "M3", "#1=2", "%", "G13 X1", "G1G91X1", "S5", "K1", "@1", "X٣"],
)  # fmt: skip
def test_lines_that_are_not_plain(raw):
    assert not POLAR_WORDS.plain(raw)


@pytest.mark.parametrize(
    ("raw", "text"),
    [
        ("g1y3", "g1c3"),
        ("G1 U[#<yh u>*2]", "g1x[#<yhu>*2]"),
        ("G1 Uexp[1]Hfup[#1]", "g1xexp[1]cfup[#1]"),
        ("G1 Uatan[1]/[2]H##3", "g1xatan[1]/[2]c##3"),
        ("G1 U-#<a>H- 2 . 5", "g1x-#<a>c-2.5"),
        ("G9 G1 U1", "g1x1"),
        ("G09. G90 G9.0", "g90"),
        ("#<u>=3 G1 U#<h> #2=[1+#1]", "#<u>=3g1x#<h>#2=[1+#1]"),
        ("/ N5 G1 U1", "/n5g1x1"),
        ("G1 U#<_ini[axis_x]home>", "g1x#<_ini[axis_x]home>"),
        ("G1 U1 (h u y) ; y", "g1x1"),
    ],
)
def test_what_the_parser_does_not_know_is_rewritten(raw, text):
    line = split_line(raw, POLAR_WORDS)
    assert line.text == text
    assert line.rewritten


def test_parts_of_a_line():
    line = split_line(
        "/#1=2 G9 M3 S[#1] $1 #<ab>=sin[30] (one) X1 (two; three) ; (four)", POLAR_WORDS
    )
    assert line.comments == ("one", "two; three")
    assert line.assignments == "#1=2#<ab>=sin[30]"
    assert line.spindle == "$1"
    assert line.exact_stop and line.deletable and not line.empty
    assert line.letters == ("#", "G", "M", "S", "$", "#", "X")


O_WORDS = {
    "if": ["o100 if [#1 EQ 2]", "o[#<n>+1] if [1]"],
    "call": ["O<a b> Call [1] [2]", "M98 P100", "o#<_global n> call [#<n>] [1]", "o##1 call",
             "o abs[#1] call"],
    "endwhile": ["N5 o1 endwhile"],
    "else": ["/o1 else"],
    "repeat": ["o#1 repeat [3]", "o[atan[1]/[2]] repeat [2]"],
    "sub": ["o[#1+2] sub"],
    "return": ["m 9 9", "M099", "o<x> return [1]"],
    "program": ["O200"],
    "": ["M980", "M3", "G1 X1", "M9 M98"],
}  # fmt: skip


@pytest.mark.parametrize(("kind", "lines"), O_WORDS.items())
def test_o_words(kind, lines):
    assert [split_line(raw, POLAR_WORDS).control for raw in lines] == [kind] * len(lines)


def test_words_are_split_at_their_values():
    text = "g1x-[1+[2*3]]c#<_x>i##1j-sin[30]katan[1]/[2]$0@5#1=[2]"
    assert list(split_words(text)) == [
        ("g", "1"), ("x", "-[1+[2*3]]"), ("c", "#<_x>"), ("i", "##1"), ("j", "-sin[30]"),
        ("k", "atan[1]/[2]"), ("$", "0"), ("@", "5"), ("#", "1=[2]"),
    ]  # fmt: skip
    assert list(split_words("gx1")) == [("g", ""), ("x", "1")]  # no value hides nothing


def test_modes_act_as_they_are_read():
    after = modes_after(MODES, block(g={1: 20, 3: 910}, F=5.0), 7.0)
    assert after == SectionModes(True, False, 5.0, 7.0, 20)
    assert modes_after(after, block(), 7.0) == after


@pytest.mark.parametrize(
    ("codes", "words", "expected"),
    [
        ({10: 990}, {"F": 0.2}, (True, 0.2)),
        ({5: 950}, {}, (True, 0.0)),
        ({10: 980}, {}, (False, 100.0)),
        ({5: 940, 10: 980}, {"F": 9.0}, (False, 9.0)),
    ],
)
def test_feed_modes(codes, words, expected):
    after = modes_after(MODES, block(g=codes, **words), 500.0)
    assert (after.per_revolution, after.feed) == expected


@pytest.mark.parametrize(
    ("given", "text"),
    [
        ({"g": {1: 10}, "X": 5.0, "F": 3.0}, ""),
        ({"g": {0: 40}, "P": 0.25}, "G4P0.25"),
        ({"g": {1: 10, 13: 640}, "P": 0.01, "X": 1.0}, "G64P0.01"),
        ({"m": {7: 3, 8: 8}, "S": 1000.0}, "M3M8S1000"),
        ({"m": {7: 19}, "R": 90.0, "Q": 1.0}, "M19Q1R90"),
        ({"g": {1: 20}, "m": {8: 8}, "R": 9.0, "X": 1.0}, "M8"),
        ({"m": {4: 0}}, ""),
        ({"m": {5: 66}, "P": 1.0, "L": 3.0, "Q": 1e-5}, "M66P1Q0.00001L3"),
        ({"m": {5: 67}, "E": 2.0, "Q": 0.5}, "M67Q0.5E2"),
        ({"g": {14: 970, 2: 180, 3: 900, 7: 400, 10: 980}}, "G97"),
    ],
)
def test_what_is_no_motion(given, text):
    assert action_text(block(**given), split_line("", POLAR_WORDS)) == text


def test_the_spindle_word_goes_along_with_a_code():
    assert action_text(block(m={7: 3}, S=5.0), split_line("M3 S5 $-1", POLAR_WORDS)) == "M3S5$-1"
    assert action_text(block(g={1: 10}, X=1.0), split_line("G1 X1 $0", POLAR_WORDS)) == ""
    for code in (70, 71, 72, 73):  # saved modes are the section's own
        assert action_text(block(m={7: code, 8: 8}), split_line(f"m{code}m8", POLAR_WORDS)) == "M8"


VALUES = {"1": 2.0, "5420": 12.5, "_x": -3.25, "ab": 7.0}


@pytest.mark.parametrize(
    ("comment", "text"),
    [
        ("DEBUG,x #1", "(DEBUG,x 2.000000)"),
        (" print, %d#5420 %f#<_x> %.2f#<A B>", "( print, 12 -3.2500 7.00)"),
        ("log,#<none> and #9", "(log,###### and ###### )"),
        ("abort,#1 is wrong", "(abort,2.000000 is wrong)"),
        ("MSG, #1", "(MSG, #1)"),
        ("debug,100% #1", "(debug,100% 2.000000)"),
    ],
)
def test_reports_are_filled_in(comment, text):
    assert comment_text(comment, VALUES.get) == text


def test_a_report_is_cut_to_a_line_that_linuxcnc_reads_and_no_shorter():
    """A blank after a # at its end, or a parameter would begin there."""
    assert len(comment_text("print," + "#" * 300, VALUES.get)) == LONGEST_BLOCK
    assert len(comment_text("print," + "x" * 300, VALUES.get)) == LONGEST_BLOCK - 1


def test_codes_are_g_and_m_with_a_plain_number():
    assert split_line("g1x2m3f4", POLAR_WORDS).codes == (("G", 10), ("M", 30))
    assert split_line("g#1m[2]g91.1", POLAR_WORDS).codes == (("G", 911),)


@pytest.mark.parametrize("text", ["o1if[1]", ";py,1", "g1(a", "m98p1"])
def test_a_line_that_is_not_split_says_nothing_of_its_words(text):
    line = split_line(text, POLAR_WORDS)
    assert (line.letters, line.codes, line.assignments, line.spindle) == ((), (), "", "")
    assert (line.rewritten, line.relative, line.exact_stop) == (False, "", False)


def test_alone():
    assert alone(block(g={1: 131}))
    assert not alone(block(g={1: 131, 3: 900}))
    assert not alone(block(g={1: 131}, m={8: 8}))
    assert not alone(block(g={1: 131}, X=1.0))
    assert m_code_alone(block(m={10: 410}, P=3.0), 410)
    assert not m_code_alone(block(m={10: 410}, X=3.0), 410)
    assert not m_code_alone(block(m={10: 410, 8: 8}), 410)
