# SPDX-License-Identifier: GPL-2.0-or-later
"""The count of steps by itself: enough of them, none too long, no sliver."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles import circle_mill, haas, mitsubishi, yasnac
from g12.errors import Refusal
from g12.request.common import other_cutter, steps_between
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import MM

TOLERANCE = 1e-6
OTHER_UNITS = MM._replace(unit="mm", spindle_tool=Tool(1, 6.0))  # G21 on an inch machine


@given(first=st.floats(0, 50), way=st.floats(0.01, 50), step=st.floats(0.001, 50))
def test_the_steps_are_enough_and_one_less_would_not_be(first, way, step):
    count = steps_between(first, first + way, step, TOLERANCE)
    assert count * step >= way - 2 * TOLERANCE
    assert (count - 1) * step < way


def test_a_quotient_beyond_all_counting_is_still_a_count():
    for step in (1e-300, 1e-310):
        assert steps_between(0.0, 1e6, step, TOLERANCE) == 1_000_000_000


def planned(planner, context, words, *more):
    """Return what the operator is told."""
    try:
        return planner(Words("G12", words), context, *more).message
    except Refusal as refusal:
        return refusal.message


@pytest.mark.parametrize(
    ("planner", "words", "more", "reported"),
    [
        (haas.plan_pocket, dict(I=0.5, D=1), (), "greater than the tool radius 6{} (D1)"),
        (haas.plan_pocket, dict(I=6.001, D=1), (), "must exceed the tool radius 6{} (D1) by"),
        (haas.plan_pocket, dict(I=7, K=30, Q=13, D=1), (), "tool diameter 12{}: material is left"),
        (haas.plan_pocket, dict(I=19, K=30, Q=9, D=1), (), "x the tool diameter 12{}: a core"),
        (yasnac.plan_circle, dict(I=0.5, D=1), (), "must exceed the tool radius 6{} (D1) in size"),
        (yasnac.plan_circle, dict(I=9, R=1, D=1), (), "centre (tool radius 6{}, D1): it must be"),
        (mitsubishi.plan_circle, dict(I=0.5, D=1), (), "greater than the tool radius 6{} (D1) by"),
        (
            circle_mill.plan_code,
            dict(X=0, Y=0, Z=-1, I=1, H=2, R=0.5),
            (None, True),
            "greater than the tool radius 6{} (T1)",
        ),
        (
            circle_mill.plan_code,
            dict(X=0, Y=0, Z=-1, I=1, H=2, R=60, J=13.5),
            (None, True),
            "than the tool diameter 12{}: material is left",
        ),
    ],
)
def test_a_tools_size_has_its_unit_where_the_machines_is_another(planner, words, more, reported):
    """The table's numbers are the machine's: 0.5 may look right to who does not see the G21."""
    assert reported.format(" mm") in planned(planner, OTHER_UNITS, words, *more)
    same = OTHER_UNITS._replace(unit="")
    assert reported.format("") in planned(planner, same, words, *more)


LOADED = MM._replace(spindle_tool=Tool(1, 6.0))


@pytest.mark.parametrize(
    ("found", "d_word", "last", "reported"),
    [
        (LOADED, None, 6.4, "the D last commanded, diameter 12.8; the loaded tool T1 has 12"),
        (LOADED._replace(unit="in"), 2.0, 6.0, "D2, diameter 20 in; the loaded tool T1 has 12 in"),
        (LOADED, None, 5.8, None),  # wear
        (LOADED, None, None, None),
        (LOADED, 0.0, 9.0, None),
        (LOADED, 4.0, 9.0, None),  # no diameter, as D0
        (LOADED, 77.0, 9.0, None),  # refused elsewhere
        (MM, 2.0, None, None),  # nothing is loaded
        (MM._replace(spindle_tool=Tool(4, 0.0)), 2.0, None, None),
    ],
)
def test_another_cutter_than_the_loaded_one_is_reported(found, d_word, last, reported):
    text = other_cutter("G12", d_word, found, last)
    assert text == (reported and f"G12: the cycle uses {reported}")
