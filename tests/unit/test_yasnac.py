# SPDX-License-Identifier: GPL-2.0-or-later
"""The Yasnac planner by itself: signs, rules, spiral and messages, without LinuxCNC."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.yasnac import plan_circle
from g12.errors import Refusal
from g12.request.common import SMALLEST_RING_MM
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import BAD_MODES, MM


def plan(found=MM, **values):
    return plan_circle(Words("G12", values), found)


def spiral_radii(circle):
    """Walk the half turns as the NGC body does."""
    positions, grow = [circle.first], circle.growth
    for left in range(circle.half_turns, 0, -1):
        positions.append(-positions[-1] - grow)
        grow = (left == 3) * circle.shrink * grow - grow
    return positions


@pytest.mark.parametrize(
    ("words", "approach", "radius"),
    [
        (dict(I=50.0, R=40.0, D=2), 30.0, 40.0),
        (dict(I=-50.0, R=-40.0, D=2), -30.0, -40.0),
        (dict(I=50.0, J=40.0, D=2), 30.0, 40.0),
        (dict(I=50.0, D=2), 0.0, 40.0),
        (dict(I=50.0), 0.0, 50.0),
        (dict(I=50.0, D=0), 0.0, 50.0),
        (dict(I=50.0, R=10.0, D=2), 0.0, 40.0),
        (dict(I=50.0, R=0.0), 0.0, 50.0),
        (dict(I=50.0, R=49.0, D=2), 39.0, 40.0),
        (dict(I=10.5, D=2), 0.0, 0.5),
        (dict(I=0.00508), 0.0, 0.00508),
    ],
)
def test_the_circle_on_the_side_of_i(words, approach, radius):
    circle = plan(**words)
    assert (circle.approach, circle.first, circle.radius) == (approach, radius, radius)
    assert (circle.half_turns, circle.circles) == (0, 1)


@pytest.mark.parametrize("side", [1, -1])
def test_r_may_be_nearer_to_i_than_two_of_the_smallest_arcs(side):
    traverse = side * (30 - 1.5 * SMALLEST_RING_MM)
    assert plan(I=30.0 * side, R=traverse).approach == traverse


def test_right_after_g40_no_circle_begins():
    with pytest.raises(Refusal) as refused:
        plan(found=MM._replace(offset_pending=True), I=50.0, R=20.0, D=2)
    message = "G12: the tool still stands offset: after G40 move in X or Y first"
    assert refused.value.message == message


def test_arcs_as_small_as_a_refusal_says_that_they_may_be():
    circle = plan(I=50.0, R=20.0, K=20.0 + SMALLEST_RING_MM, Q=1.0, D=2)
    assert circle.first - circle.approach == pytest.approx(SMALLEST_RING_MM)


@pytest.mark.parametrize("rounding", [1e-11, -1e-11])
def test_an_approach_that_only_misses_the_centre_by_rounding_is_no_fast_move(rounding):
    found = MM._replace(tool_in_table={2: Tool(2, 10 + rounding)}.get)
    assert plan(found=found, I=50.0, R=10.0, D=2).approach == 0


def test_the_centre_is_where_the_tool_stands():
    circle = plan(found=MM._replace(x=3.0, y=-4.0), I=50.0, D=2)
    assert (circle.x, circle.y) == (3.0, -4.0)


def test_l_repeats_the_finished_circle():
    assert plan(I=50.0, L=3).circles == 3


@pytest.mark.parametrize(
    ("words", "positions"),
    [
        (dict(I=50.0, K=46.0, Q=2.0), [46, -47, 48, -49, 50]),
        (dict(I=-50.0, K=-46.0, Q=2.0), [-46, 47, -48, 49, -50]),
        (dict(I=50.0, R=20.0, K=46.0, Q=2.0, D=2), [36, -37, 38, -39, 40]),
        (dict(I=50.0, K=45.0, Q=2.0), [45, -46, 47, -48, 49, -49.5, 50]),
        (dict(I=50.0, K=49.0, Q=2.0), [49, -49.5, 50]),
        (dict(I=50.0, K=48.0, Q=2.0), [48, -49, 50]),
    ],
)
def test_the_spiral_grows_to_the_finished_circle_in_whole_turns(words, positions):
    assert spiral_radii(plan(**words)) == pytest.approx(positions, abs=1e-12)


def test_rounding_of_the_increment_makes_no_turn_of_its_own():
    assert plan(I=0.7, K=0.1, Q=0.1).half_turns == 12
    assert plan(I=1.0, K=1 / 3, Q=1 / 3).half_turns == 4


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (dict(R=40.0), "G12: I is missing: the radius of the finished circle"),
        (dict(I=0.0), "G12: I0 must not be 0"),
        (dict(I=10.0, D=2), "G12: I10 must exceed the tool radius 10 (D2) in size"),
        (dict(I=-5.0, R=-6.0, D=2), "G12: I-5 must exceed the tool radius 10 (D2) in size"),
        (
            dict(I=50.0, R=50.0, D=2),
            "G12: R50 puts the tool centre at X40 from the circle's centre (tool radius 10, D2):"
            " it must be from 0 to less than X40, where I50 puts it",
        ),
        (
            dict(I=50.0, R=60.0, D=2),
            "G12: R60 puts the tool centre at X50 from the circle's centre (tool radius 10, D2):"
            " it must be from 0 to less than X40, where I50 puts it",
        ),
        (
            dict(I=50.0, R=5.0, D=2),
            "G12: R5 puts the tool centre at X-5 from the circle's centre (tool radius 10, D2):"
            " it must be from 0 to less than X40, where I50 puts it",
        ),
        (
            dict(I=-50.0, R=40.0, D=2),
            "G12: R40 puts the tool centre at X50 from the circle's centre (tool radius 10, D2):"
            " it must be from 0 to less than X-40, where I-50 puts it",
        ),
        (
            dict(I=50.0, J=55.0),
            "G12: J55 puts the tool centre at X55 from the circle's centre (no D):"
            " it must be from 0 to less than X50, where I50 puts it",
        ),
        (
            dict(I=30.0, R=30.0 - 0.5 * SMALLEST_RING_MM),
            "G12: R29.99746 puts the tool centre at X29.99746 from the circle's centre (no D):"
            " only 0.00254 from X30, where I30 puts it; the smallest arc needs 0.00508",
        ),
        (
            dict(I=50.0, R=20.0, K=20.004, Q=1.0, D=2),
            "G12: K20.004 puts the tool centre at X10.004 from the circle's centre (tool radius 10,"
            " D2): only 0.004 from X10, where the cut begins; the smallest arc needs 0.00508",
        ),
        (
            dict(I=-50.0, R=-20.0, K=-49.999, Q=1.0),
            "G12: K-49.999 puts the tool centre at X-49.999 from the circle's centre (no D):"
            " only 0.001 from X-50, where I-50 puts it; the smallest arc needs 0.00508",
        ),
        (
            dict(R=0.5, Z=-1.0),
            "G12: Z-1 is not a word of this cycle, which knows I R (or J) K Q L D F",
        ),
        (dict(I=50.0, R=20.0, J=20.0), "G12: R and J are the same word: give one of them"),
        (dict(I=50.0, K=20.0), "G12: K20 needs Q as well"),
        (dict(I=50.0, Q=2.0), "G12: Q2 needs K as well"),
        (dict(I=50.0, K=20.0, Q=0.0), "G12: Q0 must be greater than 0"),
        (dict(I=50.0, K=20.0, Q=-1.0), "G12: Q-1 must be greater than 0"),
        (
            dict(I=50.0, K=50.0, Q=1.0),
            "G12: K50 puts the tool centre at X50 from the circle's centre (no D):"
            " it must be between X0 and X50, where I50 puts it",
        ),
        (
            dict(I=50.0, R=30.0, K=30.0, Q=1.0, D=2),
            "G12: K30 puts the tool centre at X20 from the circle's centre (tool radius 10, D2):"
            " it must be between X20 and X40, where I50 puts it",
        ),
        (
            dict(I=-50.0, K=20.0, Q=1.0),
            "G12: K20 puts the tool centre at X20 from the circle's centre (no D):"
            " it must be between X0 and X-50, where I-50 puts it",
        ),
        (dict(I=50.0, L=0), "G12: L0 must be at least 1"),
        (dict(I=50.0, D=-1), "G12: D-1 must be at least 0"),
        (dict(I=50.0, D=1.5), "G12: D1.5 must be a whole number"),
        (dict(I=50.0, D=77), "G12: D77 is not in the tool table"),
        (dict(I=50.0, D=3), "G12: D3 has the negative diameter -4 in the tool table"),
        (
            dict(I=50.0, Z=-1.0),
            "G12: Z-1 is not a word of this cycle, which knows I R (or J) K Q L D F",
        ),
        (
            dict(I=50.0, X=1.0),
            "G12: X1 is not a word of this cycle, which knows I R (or J) K Q L D F",
        ),
        (
            dict(I=50.0, K=10.0, Q=0.0001),
            "G12: K, Q and L make 800001 circles, the most is 100000",
        ),
    ],
)
def test_a_bad_block_is_refused_by_name(words, message):
    with pytest.raises(Refusal) as refused:
        plan(**words)
    assert refused.value.message == message


@pytest.mark.parametrize(
    ("modes", "rule"),
    [*BAD_MODES, (dict(plane="G18"), "needs the XY plane G17, but G18 is active")],
)
def test_a_mode_that_cannot_work_is_refused(modes, rule):
    with pytest.raises(Refusal) as refused:
        plan(found=MM._replace(**modes), I=50.0)
    assert refused.value.message == f"G12: {rule}"


LENGTHS = st.floats(0.01, 60.0)


@given(
    finished=LENGTHS,
    traverse=st.none() | LENGTHS,
    first=st.none() | LENGTHS,
    pitch=st.floats(0.1, 20.0),
    tool=st.sampled_from([None, 0, 1, 2]),
    side=st.sampled_from([1, -1]),
)
def test_a_block_is_refused_or_keeps_the_rules(finished, traverse, first, pitch, tool, side):
    offset = {None: 0.0, 0: 0.0, 1: 6.0, 2: 10.0}[tool]
    words = {"I": side * finished}
    words |= {} if traverse is None else {"R": side * traverse}
    words |= {} if first is None else {"K": side * first, "Q": pitch}
    words |= {} if tool is None else {"D": tool}
    inner = 0.0 if traverse is None else traverse - offset
    sound = 0 <= inner < finished - offset
    sound = sound and (first is None or inner < first - offset < finished - offset)
    try:
        circle = plan(**words)
    except Refusal:
        near = [inner, finished - offset] + ([] if first is None else [first - offset])
        close = min(abs(a - b) for a in near for b in [*near, 0.0] if a is not b)
        assert not sound or close < 0.003
        return
    assert sound or abs(inner) < 1e-5
    positions = spiral_radii(circle)
    assert abs(positions[-1]) == pytest.approx(finished - offset)
    growth = [abs(b) - abs(a) for a, b in zip(positions, positions[1:])]
    assert all(0 < step <= pitch / 2 + 1e-6 for step in growth)
