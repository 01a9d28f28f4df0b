# SPDX-License-Identifier: GPL-2.0-or-later
"""What all cycles share: words and their numbers, counts of steps, the tool of D, travel."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.lengths import LARGEST, MM_PER_INCH
from g12.request import Words, steps_between
from g12.state import Tool
from support.planner_context import MM, reported

# ---------------------------------------------------------------- words


def words(**values):
    return Words("G12", values, MM)


def test_whole_numbers_are_those_of_linuxcnc():
    for value in (1.00009, 0.99991):
        assert words(L=value).take_whole("L", least=1) == 1
    for value in (1.001, 0.9989):
        rule = f"G12: L{value} must be a whole number"
        assert reported(words(L=value).take_whole, "L", least=0) == rule
    assert reported(words(D=-1.0).take_whole, "D", least=0) == "G12: D-1 must be at least 0"
    assert words(D=3.0).take_whole("D", least=3, most=3) == 3
    assert words().take_whole("D", least=1, default=7) == 7


@pytest.mark.parametrize("value", [1.001e6, float("nan")])
def test_a_number_beyond_any_machine_is_refused_at_once(value):
    assert reported(words, X=value).endswith("is beyond 1000000")
    assert words(X=LARGEST, Y=-LARGEST).take("Y") == -LARGEST


# ---------------------------------------------------------------- steps

TOLERANCE = 1e-6


@given(first=st.floats(0, 50), way=st.floats(0.01, 50), step=st.floats(0.001, 50))
def test_the_steps_are_enough_and_one_less_would_not_be(first, way, step):
    count = steps_between(first, first + way, step, TOLERANCE)
    assert count * step >= way - 2 * TOLERANCE
    assert (count - 1) * step < way


def test_a_quotient_beyond_all_counting_is_still_a_count():
    for step in (1e-300, 1e-310):
        assert steps_between(0.0, 1e6, step, TOLERANCE) == 1_000_000_000
        assert steps_between(0.0, step, step, TOLERANCE) == 0


# ---------------------------------------------------------------- the tool of D

LOADED = MM._replace(spindle_tool=Tool(1, 6.0))


@pytest.mark.parametrize(
    ("found", "d_word", "last", "message"),
    [
        (LOADED, None, 6.4, "the D last commanded, diameter 12.8; the loaded tool T1 has 12"),
        (LOADED._replace(inch=True), 2.0, 6.0, "D2, diameter 20 in; the loaded tool T1 has 12 in"),
        (LOADED, None, 5.8, None),  # wear
        (LOADED, None, None, None),
        (LOADED, 0.0, 9.0, None),
        (LOADED, 4.0, 9.0, None),  # no diameter, as D0
        (MM, 2.0, None, None),  # nothing is loaded
        (MM._replace(spindle_tool=Tool(4, 0.0)), 2.0, None, None),
    ],
)
def test_another_cutter_than_the_loaded_one_is_reported(found, d_word, last, message):
    state = found._replace(last_cutter=None if last is None else Tool(0, last))
    block = Words("G12", {} if d_word is None else {"D": d_word}, state)
    assert block.chosen_cutter().other == (message and f"G12: the cycle uses {message}")


# ---------------------------------------------------------------- travel

SHIFTED = MM._replace(
    shifts={"X": 10.0, "Y": 0.0, "Z": -1.0},
    rotation=90.0,
    offsets={"X": 110.0, "Y": 50.0, "Z": 19.0},
)


AXES = {"X": (-100.0, 300.0), "Y": (-200.0, 200.0), "Z": (-50.0, 60.0)}
INCHES = MM._replace(inch=True)  # on a machine in mm
METRIC = MM._replace(machine_mm=MM_PER_INCH)  # the other way round


@pytest.mark.parametrize(
    ("centre", "radius", "heights", "state", "rule"),
    [
        ((0, 0, 0), 5, (2, -51, -3), MM, "Z axis would go to -51 mm, beyond its limit -50 mm"),
        ((0, 0, 0), 5, (2, 61, -3), MM, "Z axis would go to 61 mm, beyond its limit 60 mm"),
        ((30, 7, 2), 111, (), SHIFTED, "Y axis would go to 201 mm, beyond its limit 200 mm"),
        ((14, 0, 0), 1, (), INCHES,
         "X axis would go to 381 mm, beyond its limit 300 mm (G20 is active)"),
        ((7645, 0, 0), 1, (), METRIC,
         "X axis would go to 301.023622 in, beyond its limit 300 in (G21 is active)"),
    ],
)  # fmt: skip
def test_a_circle_that_leaves_the_limits_is_refused(centre, radius, heights, state, rule):
    block = Words("G12", {}, state._replace(travel=AXES))
    assert reported(block.check_travel, centre, radius, heights) == f"G12: the {rule}"


def test_offsets_rotation_and_tool_are_those_of_the_machine():
    assert SHIFTED.point_on_machine((30.0, 7.0, 2.0)) == pytest.approx((100 - 7, 50 + 40, 21))


@pytest.mark.parametrize(("plane", "along"), [("G17", (0, 1)), ("G18", (2, 0)), ("G19", (1, 2))])
@pytest.mark.parametrize("rotation", [0, 30, 200])
def test_the_limits_are_those_of_every_point_of_the_circle(plane, along, rotation):
    state = SHIFTED._replace(plane=plane, rotation=rotation, machine_mm=MM_PER_INCH)
    centre, points = (7.0, 8.0, 9.0), []
    for turn in range(3600):
        point = list(centre)
        point[along[0]] += 25.0 * math.cos(math.radians(turn / 10))
        point[along[1]] += 25.0 * math.sin(math.radians(turn / 10))
        points.append(state.point_on_machine(point))
    reached = {axis: (min(there), max(there)) for axis, there in zip("XYZ", zip(*points))}
    exact = {axis: (low - 1e-5, high + 1e-5) for axis, (low, high) in reached.items()}
    Words("G12", {}, state._replace(travel=exact)).check_travel(centre, 25.0)
    for axis, (low, high) in reached.items():
        for limits in ((low + 1e-4, high + 1), (low - 1, high - 1e-4)):
            block = Words("G12", {}, state._replace(travel={**exact, axis: limits}))
            assert f"the {axis} axis would go to" in reported(block.check_travel, centre, 25.0)
