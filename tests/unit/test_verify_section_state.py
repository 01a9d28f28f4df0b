# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section does besides moving, and what it leaves, made by hand."""

from types import SimpleNamespace

import pytest

from g12.tools.preview.moves import Event
from g12.tools.verify.expected.contour import Act, Element, SectionContour
from g12.tools.verify.sections.section_state import OffAct, act_off, left_by_section

ELEMENTS = tuple(Element(line, 0j, 1 + 0j, 0, False, 0.0) for line in (7, 9))
MOVES = [SimpleNamespace(line=line) for line in (4, 7, 7, 9)]
COOLANT, PAUSE = Act(8, "M8 on", 1), Act(10, "dwell 0.5", 2)
STATE = {"_metric": 1.0, "_x": 20.0, "_z": 2.0, "_c": 30.0, "_feed": 500.0, "_motion_mode": 10.0}


def section(told=(), **options):
    events = tuple(Event(at, 0, text) for at, text in told)
    return SectionContour(5, 12, 1, 4, "G12.1", 20.0, ELEMENTS, told=events, **options)


@pytest.mark.parametrize(
    ("told", "off"),
    [
        ([(3, "M8 on"), (4, "dwell 0.5")], None),
        ([(1, "dwell 0"), (2, "G61"), (3, "M8 on"), (4, "dwell 0.5"), (4, "G64 P0 Q0")], None),
        ([(3, "M8 on")], OffAct(10, "dwell 0.5", None, 9)),
        ([(4, "dwell 0.5")], OffAct(8, "M8 on", None, 7)),
        ([(1, "M8 on"), (4, "dwell 0.5")], OffAct(8, "M8 on", 0, 7)),
        ([(3, "M8 on"), (3, "dwell 0.5")], OffAct(10, "dwell 0.5", 7, 9)),
        ([(3, "M8 on"), (4, "dwell 0.25")], OffAct(10, "dwell 0.5", None, 9)),
        ([(2, "M3"), (3, "M8 on"), (4, "dwell 0.5")], OffAct(7, "M3", 7, None)),
        ([(3, "M8 on"), (4, "dwell 0.5"), (4, "M5")], OffAct(9, "M5", 9, None)),
    ],
)
def test_acts_come_in_their_places(told, off):
    assert act_off(section(told, acts=(COOLANT, PAUSE)), MOVES) == off


def test_an_element_that_made_no_move_is_no_place():
    moves = [move for move in MOVES if move.line != 9]
    found = section([(3, "M8 on"), (3, "dwell 0.5")], acts=(COOLANT, PAUSE))
    assert act_off(found, moves + moves[-1:]) is None


@pytest.mark.parametrize(
    ("left", "names"),
    [
        ({}, []),
        ({"_c": 390.0, "_x": 20.004}, []),
        ({"_c": 31.0}, ["_c"]),
        ({"_x": 20.01, "_feed": 600.0}, ["_x", "_feed"]),
        ({"_motion_mode": 0.0}, ["_motion_mode"]),
    ],
)
def test_what_a_section_leaves_is_compared(left, names):
    found = left_by_section(section(leaves=STATE, left={**STATE, **left}))
    assert [one.name for one in found] == names
