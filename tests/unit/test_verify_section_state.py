# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section does besides moving, and what it leaves, made by hand."""

from types import SimpleNamespace

import pytest

from g12.tools.preview.moves import Event
from g12.tools.verify.compare.state import judge_acts, judge_section_state
from g12.tools.verify.expected.contour import Act, Element, SectionContour

ELEMENTS = tuple(Element(line, 0j, 1 + 0j, 0, False, 0.0) for line in (7, 9))
MOVES = [SimpleNamespace(line=line) for line in (4, 7, 7, 9)]
COOLANT, PAUSE = Act(8, "M8 on", 1), Act(10, "dwell 0.5", 2)
STATE = {"_metric": 1.0, "_x": 20.0, "_z": 2.0, "_c": 30.0, "_feed": 500.0, "_motion_mode": 10.0}


def section(reported=(), **options):
    events = tuple(Event(at, 0, text) for at, text in reported)
    return SectionContour(5, 12, 1, 4, "G12.1", 20.0, ELEMENTS, events=events, **options)


@pytest.mark.parametrize(
    ("reported", "off"),
    [
        ([(3, "M8 on"), (4, "dwell 0.5")], ""),
        ([(1, "dwell 0"), (2, "G61"), (3, "M8 on"), (4, "dwell 0.5"), (4, "G64 P0 Q0")], ""),
        ([(3, "M8 on")], "10: dwell 0.5 does not come"),
        ([(4, "dwell 0.5")], "8: M8 on does not come"),
        ([(1, "M8 on"), (4, "dwell 0.5")], "8: M8 on comes at the start, not after line 7"),
        ([(3, "M8 on"), (3, "dwell 0.5")], "10: dwell 0.5 comes after line 7, not after line 9"),
        ([(3, "M8 on"), (4, "dwell 0.25")], "10: dwell 0.5 does not come"),
        ([(2, "M3"), (3, "M8 on"), (4, "dwell 0.5")], "7: M3 comes after line 7, where"),
        ([(3, "M8 on"), (4, "dwell 0.5"), (4, "M5")], "9: M5 comes after line 9, where"),
    ],
)
def test_acts_come_in_their_places(reported, off):
    found = judge_acts(section(reported, acts=(COOLANT, PAUSE)), MOVES)
    assert " ".join(f"{each.line}: {each.text()}" for each in found).startswith(off)
    assert off or not list(judge_acts(section(reported, acts=(COOLANT, PAUSE)), MOVES))


def test_an_element_that_made_no_move_is_no_place():
    moves = [move for move in MOVES if move.line != 9]
    found = section([(3, "M8 on"), (3, "dwell 0.5")], acts=(COOLANT, PAUSE))
    assert list(judge_acts(found, moves + moves[-1:])) == []


@pytest.mark.parametrize(
    ("left", "texts"),
    [
        ({}, []),
        ({"_c": 390.0, "_x": 20.004}, []),
        ({"_c": 31.0}, ["C31, not C30"]),
        ({"_x": 20.01, "_feed": 600.0}, ["X20.01, not X20", "F600, not F500"]),
        ({"_motion_mode": 0.0}, ["G0, not G1"]),
    ],
)
def test_what_a_section_leaves_is_compared(left, texts):
    found = judge_section_state(section(expected_state=STATE, state_after={**STATE, **left}), MOVES)
    assert [each.text() for each in found] == [f"it leaves {text}" for text in texts]
