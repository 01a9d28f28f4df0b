# SPDX-License-Identifier: GPL-2.0-or-later
"""Every G code of LinuxCNC, by its modal group: which have a place in a section, and why not."""

import pytest

from g12.errors import Refusal
from g12.polar.polar_section import POLAR_WORDS
from g12.section.block_rules import SectionBlock, check_block, check_codes, check_letters
from g12.section.line import BlockLocation, split_line

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


def block(group=None, code=-1, *, m=(), motion=-1, **words):
    g = [-1] * 17
    if group is not None:
        g[group] = code
    return SectionBlock(tuple(g), tuple(m) + (-1,) * (11 - len(m)), motion, words)


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
        assert refusal(check_block, block(group, code), False) is None


@pytest.mark.parametrize(("group", "codes", "why"), REFUSED)
def test_codes_that_it_refuses(group, codes, why):
    """By the text, before the words are judged, and as the parser gives them."""
    for code, name in zip(tenths(codes), codes.split()):
        assert refusal(check_codes, [("G", code)], True) == f"G{name} is refused: {why}"
        assert refusal(check_block, block(group, code), True) == f"G{name} is refused: {why}"


def test_a_rapid_is_refused_unless_it_is_allowed():
    for check, given in ((check_codes, [("G", 0)]), (check_block, block(1, 0))):
        assert refusal(check, given, False) == f"G0 is refused: {RAPID}"
        assert refusal(check, given, True) is None


@pytest.mark.parametrize(("group", "code"), [(16, 115), (9, 1), (1, 123)])
def test_codes_that_nobody_knows(group, code):
    """A code remapped into a group, and groups that have none: what is not listed is refused."""
    assert refusal(check_codes, [("G", code)], False) is None  # left to the parser
    assert f"G{code / 10:g} is refused: " in refusal(check_block, block(group, code), False)


@pytest.mark.parametrize("code", [6, 61])
def test_no_tool_changes(code):
    why = f"M{code} is refused: the tool cannot change inside the section"
    assert refusal(check_codes, [("M", 10 * code)], False) == why
    assert refusal(check_block, block(m=(code,)), False) == why


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
        found = refusal(check_block, block(m=(code,), **words), False)
        assert found == (why and f"M{code} needs {why}")


@pytest.mark.parametrize("motion", [20, 30])
def test_an_arc_has_no_turns(motion):
    why = "P is refused: an arc inside the section has no turns"
    for word in ("X", "C", "Z", "I", "J"):
        assert refusal(check_block, block(motion=motion, P=1.0, **{word: 2.0}), False) == why
    assert refusal(check_block, block(motion=10, P=1.0, X=2.0), False) is None
    assert refusal(check_block, block(0, 40, motion=motion, P=1.0), False) is None  # a dwell


@pytest.mark.parametrize(("first", "second"), [(940, 990), (950, 980)])
def test_one_kind_of_feed(first, second):
    both = block(5, first)._replace(g=(-1,) * 5 + (first,) + (-1,) * 4 + (second,) + (-1,) * 6)
    why = "G94 and G98 are feed per minute, G95 and G99 per revolution: not both"
    assert refusal(check_block, both, False) == why


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
