# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of the shapes by themselves: whatever a call says is planned or refused by name."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.context import Tool
from g12.errors import Refusal
from g12.shapes import polygon, round_pocket, slot
from g12.shapes.entries import LEFT_OUT, ShapeEntries, ShapeMachine
from support.planner_context import MM

FOUND = MM._replace(z=5.0, spindle_tool=Tool(3, 3.0))
LATHE = ShapeMachine(False, 3.0, 1.0, 0.0025, False)
PLANS = {
    "polar_polygon": (polygon.ENTRIES, polygon.plan_polygon),
    "polar_slot": (slot.ENTRIES, slot.plan_slot),
    "polar_pocket": (round_pocket.ENTRIES, round_pocket.plan_round_pocket),
}
ANY = st.sampled_from([LEFT_OUT, 0.0, -1.0, 1e-9, 2.0, 1e9]) | st.floats(-5, 60)


def plan(shape, values, machine=LATHE):
    names, planned = PLANS[shape]
    return planned(ShapeEntries(shape, names, dict(zip(names, values))), FOUND, machine)


@pytest.mark.parametrize("shape", PLANS)
@given(values=st.lists(ANY, min_size=10, max_size=10))
def test_any_entries_are_planned_or_refused_by_name(shape, values):
    try:
        made = plan(shape, values)
    except Refusal as refusal:
        assert refusal.message.startswith(f"{shape}: ") and len(refusal.message) <= 255
    else:
        assert all(math.isfinite(value) for value in made.locals().values())
        low, high = zip(*made.extent())
        assert all(least <= most for least, most in zip(low, high)) and low[0] >= 0


def test_a_polygon_turns_c_once_with_every_round():
    made = plan("polar_polygon", [6, 27, 5, 40, LEFT_OUT, 2, 0.5, 400, LEFT_OUT, 0])
    turns = made.levels.levels * made.rounds.rounds + 1
    low, high = made.extent().c
    assert turns == 3 * 2 + 1
    assert 30 <= high < 90 and -360 * turns - 60 < low <= 30 - 360 * turns


def test_rounds_of_a_polygon_are_no_wider_than_three_quarters_of_the_cutter():
    for stock in (28, 36.1, 45, 80):
        made = plan("polar_polygon", [6, 27, 5, stock, *[LEFT_OUT] * 3, 400, LEFT_OUT, 0])
        assert 0 < made.rounds.step <= 4.5
        assert made.rounds.apothem - (made.rounds.rounds - 1) * made.rounds.step == pytest.approx(
            13.5 + 3
        )


def test_x_of_a_pocket_is_a_diameter_where_x_words_are():
    values = [20, 3, 14, 4, *[LEFT_OUT] * 2, 400, LEFT_OUT]
    assert plan("polar_pocket", values, LATHE._replace(diameters=True)).away == math.hypot(10, 3)
    assert plan("polar_pocket", values).away == math.hypot(20, 3)
