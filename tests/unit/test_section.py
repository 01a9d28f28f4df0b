# SPDX-License-Identifier: GPL-2.0-or-later
"""One line of a section: its parts, what its words mean, which codes have a place and why not."""

import pytest

from g12.errors import Refusal
from g12.machine_ini import remap_from_value
from g12.polar.polar_section import POLAR_WORDS
from g12.section.block_rules import (
    SectionBlock,
    check_block,
    check_codes,
    check_letters,
    m_code_alone,
)
from g12.section.effects import (
    SectionModes,
    action_text,
    codes_of_section,
    modes_after,
)
from g12.section.line import BlockLocation, split_line, split_words

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


def test_a_remapped_m_code_has_its_own_words_beside_it_and_nothing_else():
    assert m_code_alone(block(m={10: 410}, P=3.0), 410)
    assert not m_code_alone(block(m={10: 410}, X=3.0), 410)
    assert not m_code_alone(block(m={10: 410, 8: 8}), 410)


# Every G code of LinuxCNC by its modal group: which have a place in a section, and why not.

HERE = BlockLocation("G12.1", 7)
# By modal group as LinuxCNC's interp_array.cc numbers them.
TAKEN = {0: "4", 1: "1 2 3", 2: "17 18", 3: "90 91", 4: "91.1", 5: "94 95", 7: "40 41 42",
         10: "98 99", 13: "61 61.1 64", 14: "97"}  # fmt: skip
ORIGIN = "the origin must stay in the spindle's centre"
REFERENCE = "the reference point is not in the plane"
MOTION = "only G1, G2 and G3 move inside the section"
RADIUS = "the radius is that of the loaded tool: G41 or G42 without D"
LENGTH = "the tool length offset cannot change inside the section"
DIAMETER = "X cannot change between diameter and radius inside the section"
CYCLES = "80 81 82 83 84 85 86 87 88 89"
REFUSED = [
    (0, "10", "offsets cannot change inside the section"),
    (0, "28 28.1 30 30.1", REFERENCE),
    (0, "53", "machine coordinates are not those of the plane"),
    (0, "52 92 92.1 92.2 92.3", ORIGIN),
    (1, "5 5.1 5.2 5.3 33 33.1 38.2 38.3 38.4 38.5 70 71 71.1 71.2 72 72.1 72.2", MOTION),
    (1, f"73 74 76 {CYCLES}", MOTION),
    (2, "17.1 18.1 19 19.1", "the section's plane is X-C"),
    (4, "90.1", "I and J are always incremental inside the section"),
    (5, "93", "the feed of a section is G94 or G95 (G98 or G99)"),
    (6, "20 21", "the units cannot change inside the section"),
    (7, "41.1 42.1", RADIUS),
    (8, "43 43.1 43.2 49", LENGTH),
    (12, "54 55 56 57 58 59 59.1 59.2 59.3", ORIGIN),
    (14, "96", "the spindle keeps its speed inside the section (G97)"),
    (15, "7 8", DIAMETER),
]
RAPID = (
    "a rapid leaves the contour. Is the section's end missing above? "
    "Else use G1 with a high F, or set [G12] POLAR_G0 = feed"
)


def tenths(codes):
    return [round(float(code) * 10) for code in codes.split()]


def refusal(check, given, *arguments):
    """Return why something is refused, None if it is not."""
    try:
        check(given, POLAR_WORDS, *arguments, HERE)
    except Refusal as refused:
        return refused.message.removeprefix("G12.1 line 7: ")
    return None


@pytest.mark.parametrize(("group", "codes"), TAKEN.items())
def test_codes_that_a_section_takes(group, codes):
    for code in tenths(codes):
        assert refusal(check_codes, [("G", code)], False) is None
        assert refusal(check_block, block(g={group: code}), False) is None


@pytest.mark.parametrize(("group", "codes", "why"), REFUSED)
def test_codes_that_it_refuses(group, codes, why):
    """By the text, before the words are judged, and as the parser gives them."""
    for code, name in zip(tenths(codes), codes.split()):
        assert refusal(check_codes, [("G", code)], True) == f"G{name} is refused: {why}"
        assert refusal(check_block, block(g={group: code}), True) == f"G{name} is refused: {why}"


def test_a_rapid_is_refused_unless_it_is_allowed():
    for check, given in ((check_codes, [("G", 0)]), (check_block, block(g={1: 0}))):
        assert refusal(check, given, False) == f"G0 is refused: {RAPID}"
        assert refusal(check, given, True) is None


@pytest.mark.parametrize(("group", "code"), [(16, 115), (9, 1), (1, 123)])
def test_codes_that_nobody_knows(group, code):
    """A code remapped into a group, and groups that have none: what is not listed is refused."""
    assert refusal(check_codes, [("G", code)], False) is None  # left to the parser
    assert f"G{code / 10:g} is refused: " in refusal(check_block, block(g={group: code}), False)


@pytest.mark.parametrize("code", [6, 61])
def test_no_tool_changes(code):
    why = f"M{code} is refused: the tool cannot change inside the section"
    assert refusal(check_codes, [("M", 10 * code)], False) == why
    assert refusal(check_block, block(m={5: code}), False) == why


OUTPUT, ANALOG = "P, the number of the output", "E, the number of the output"
ANALOG_WAIT = "L0 with E: only a digital input can be waited for"
INPUT, WAIT = "either P or E, the number of the input", "Q above zero, the longest wait in seconds"


@pytest.mark.parametrize(
    ("codes", "words", "why"),
    [
        ((62, 63, 64, 65), {}, OUTPUT),
        ((62, 63, 64, 65), {"P": -1.0}, OUTPUT),
        ((62, 63, 64, 65), {"P": 0.0}, None),
        ((67, 68), {"Q": 1.0}, ANALOG),
        ((67, 68), {"E": -1.0}, ANALOG),
        ((67, 68), {"E": 0.0, "Q": -5.0}, None),
        ((19,), {"R": 1.0, "Q": 0.0}, WAIT),
        ((19,), {}, None),
        ((19,), {"Q": 0.01}, None),
        ((66,), {}, INPUT),
        ((66,), {"P": 0.0, "E": 0.0}, INPUT),
        ((66,), {"P": 0.0}, None),
        ((66,), {"E": 0.0, "L": 0.0}, None),
        ((66,), {"E": 1.0, "L": 1.0, "Q": 1.0}, ANALOG_WAIT),
        ((66,), {"P": 1.0, "L": 3.0}, WAIT),
        ((66,), {"P": 1.0, "L": 1.0, "Q": 0.0}, WAIT),
        ((66,), {"P": 1.0, "L": 5.0, "Q": 1.0}, "L from 0 to 4"),
        *(((66,), {"P": 0.0, "L": wait, "Q": 0.01}, None) for wait in (1.0, 2.0, 3.0, 4.0)),
    ],
)
def test_what_linuxcnc_would_refuse_between_the_moves(codes, words, why):
    for code in codes:
        found = refusal(check_block, block(m={5: code}, **words), False)
        assert found == (why and f"M{code} needs {why}")


@pytest.mark.parametrize("motion", [20, 30])
def test_an_arc_has_no_turns(motion):
    why = "P is refused: an arc inside the section has no turns"
    for word in ("X", "C", "Z", "I", "J"):
        assert refusal(check_block, block(motion=motion, P=1.0, **{word: 2.0}), False) == why
    assert refusal(check_block, block(motion=10, P=1.0, X=2.0), False) is None
    assert refusal(check_block, block(g={0: 40}, motion=motion, P=1.0), False) is None  # a dwell


@pytest.mark.parametrize(("first", "second"), [(940, 990), (950, 980)])
def test_one_kind_of_feed(first, second):
    why = "G94 and G98 are feed per minute, G95 and G99 per revolution: not both"
    assert refusal(check_block, block(g={5: first, 10: second}), False) == why


AXES = "the section's words are X, C (or Y), Z, U and H"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        *((f"G1 {letter}1", f"{letter} is refused: {AXES}") for letter in "ABVW@^"),
        ("T1", "T is refused: the tool cannot change inside the section"),
        ("G41 D1", "D is refused: the radius is that of the loaded tool"),
        ("G2 X1 K1", "K is refused: the centre of an arc in the X-C plane is I and J"),
        ("U1 X1", "X and U both move X: only one of them"),
        ("H1 Y1 X1", "Y and H both move C: only one of them"),
    ],
)
def test_words_that_are_refused(text, why):
    assert refusal(check_letters, split_line(text, POLAR_WORDS)) == why


# Which codes begin and end a section: the user's choice.

PAIR = ("G12.1 modalgroup=1 python=polar_on", "G13.1 modalgroup=1 python=polar_off")
OTHER = ("G12.3 modalgroup=1 py=polar_on", "G13.3 modalgroup=1 py=polar_off")


def codes(code, *lines):
    return codes_of_section(
        code, [remap_from_value(line) for line in lines], "polar_on", "polar_off"
    )


def test_every_code_of_the_handler_ends_a_section_and_the_partner_is_named():
    found = codes("G12.3", *PAIR, *OTHER)
    assert (found.on, found.off, found.off_code) == ({121, 123}, {131, 133}, "G13.3")


def test_m_codes_to_subs_and_to_python():
    found = codes("G12.1", *PAIR, "M33 modalgroup=10 n=m33", "M400 modalgroup=10 python=mine")
    assert found.remapped == {33: True, 400: False}
