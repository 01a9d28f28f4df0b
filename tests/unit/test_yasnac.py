# SPDX-License-Identifier: GPL-2.0-or-later
"""The Yasnac planner by itself: signs, rules, spiral and messages, without LinuxCNC."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.yasnac import plan_circle
from g12.errors import Refusal
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import BAD_MODES, MM, reported, words_of


def plan(words, **found):
    values = words_of(words) if isinstance(words, str) else words
    return plan_circle(Words("G12", values), MM._replace(**found))


def spiral_radii(circle):
    """Walk the half turns as the NGC body does."""
    positions, grow = [circle.first], circle.growth
    for left in range(circle.half_turns, 0, -1):
        positions.append(-positions[-1] - grow)
        grow = (left == 3) * circle.shrink * grow - grow
    return positions


def test_the_circle_on_the_side_of_i():
    circle = plan("I50 J40 D2", x=3.0, y=-4.0)
    assert (circle.approach, circle.first, circle.radius) == (30, 40, 40)
    assert (circle.half_turns, circle.circles, circle.x, circle.y) == (0, 1, 3.0, -4.0)


def test_the_smallest_circle():
    assert plan("I.00508").radius == 0.00508


def test_an_approach_that_only_misses_the_centre_by_rounding_is_no_fast_move():
    assert plan("I50 R10 D2", tool_in_table={2: Tool(2, 10 - 1e-11)}.get).approach == 0


def test_the_spiral_grows_from_the_smallest_arc_to_the_finished_circle():
    found = spiral_radii(plan("I50 R20 K20.00508 Q60 D2"))
    assert found == pytest.approx([10.00508, -25.00254, 40], abs=1e-12)


WITH_D, NO_D = "tool radius 10, D2", "no D"


def beyond(word, at, tool, rule, to):
    return f"{word} puts the tool centre at X{at} from the circle's centre ({tool}): {rule} {to}"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("I0", "I0 must not be 0"),
        ("I-5 R-6 D2", "I-5 must exceed the tool radius 10 (D2) in size"),
        (
            "I50 R50 D2",
            beyond("R50", 40, WITH_D, "it must be from 0 to less than", "X40, where I50 puts it"),
        ),
        (
            "I30 R29.99746",
            beyond("R29.99746", 29.99746, NO_D, "only 0.00254 from", "X30, where I30 puts it")
            + "; the smallest arc needs 0.00508",
        ),
        (
            "I50 R20 K20.004 Q1 D2",
            beyond("K20.004", 10.004, WITH_D, "only 0.004 from", "X10, where the cut begins")
            + "; the smallest arc needs 0.00508",
        ),
        (
            "I-50 R-20 K-49.999 Q1",
            beyond("K-49.999", -49.999, NO_D, "only 0.001 from", "X-50, where I-50 puts it")
            + "; the smallest arc needs 0.00508",
        ),
        ("I50 R20 J20", "R and J are the same word: give one of them"),
        ("I50 K20", "K20 needs Q as well"),
        (
            "I50 K50 Q1",
            beyond("K50", 50, NO_D, "it must be between", "X0 and X50, where I50 puts it"),
        ),
        (
            "I50 R30 K30 Q1 D2",
            beyond("K30", 20, WITH_D, "it must be between", "X20 and X40, where I50 puts it"),
        ),
        ("I50 L0", "L0 must be at least 1"),
        ("I50 D3", "D3 has the negative diameter -4 in the tool table"),
        ("I50 K10 Q.0001", "K, Q and L make 800001 circles, the most is 100000"),
        ("I50 Z-1", "Z-1 is not a word of this cycle, which knows I R (or J) K Q L D F"),
    ],
)
def test_a_bad_block_is_refused_by_name(words, rule):
    assert reported(plan, words) == f"G12: {rule}"


@pytest.mark.parametrize(
    ("modes", "rule"),
    [
        *BAD_MODES,
        (dict(plane="G18"), "needs the XY plane G17, but G18 is active"),
        (dict(offset_pending=True), "the tool is still offset: after G40 move in X or Y first"),
    ],
)
def test_a_mode_that_cannot_work_is_refused(modes, rule):
    assert reported(plan, "I50", **modes) == f"G12: {rule}"


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
        circle = plan(words)
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
