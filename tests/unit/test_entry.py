# SPDX-License-Identifier: GPL-2.0-or-later
"""The way down into a pocket by itself: how many half turns, how much each falls."""

import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.plan import (
    STRAIGHT_DOWN,
    Descent,
    Helix,
    PocketEntry,
    helix_of,
    pocket_descent,
)
from g12.errors import Refusal
from g12.request import Words
from support.planner_context import MM

HELIX = PocketEntry(helix=True, angle=3.0)


@given(
    radius=st.floats(0.01, 100),
    slope=st.floats(0.01, 0.5),
    last=st.integers(0, 20),
    height=st.floats(0.001, 100),
)
def test_whole_turns_no_steeper_than_the_slope_make_the_height(radius, slope, last, height):
    turns, fall = Helix(radius, slope, last).descent(height)
    assert turns >= 1 and (turns + last) % 2 == 0
    # those of the end fall less and less, by half of that in the middle
    assert turns * fall + last * fall / 2 == pytest.approx(height)
    assert fall <= math.pi * radius * slope * (1 + 1e-9)
    if turns > 2:
        assert height / (turns - 2 + last / 2) > math.pi * radius * slope * (1 - 1e-9)


def test_no_helix_goes_straight_down_and_nothing_up():
    assert Helix().descent(5.0) == Descent(0, 0.0)
    assert Helix(10.0, 0.1, 2).descent(0.0) == Helix(10.0, 0.1, 2).descent(-1.0) == Descent(0, 0.0)
    assert STRAIGHT_DOWN == (False, 3.0, 100.0)
    assert helix_of(STRAIGHT_DOWN, 3.0, 5.0) == Helix(0.0, 0.0, 0)


def down(first, heights, entry=HELIX):
    words = Words("G13", {}, MM._replace(feed=600.0))
    return pocket_descent(words, entry, first, 5.0, heights)


@pytest.mark.parametrize(("first", "side"), [(3.0, 1), (8.0, -1)])
def test_what_the_subroutine_is_told(first, side):
    passed, helix = down(first, (3.0, 2.0)), helix_of(HELIX, first, 5.0)
    assert passed["side"] == side
    assert passed["helix_radius"] == min(first, 4.5)
    assert (passed["turns"], passed["fall"]) == helix.descent(3.0)
    assert (passed["next_turns"], passed["next_fall"]) == helix.descent(2.0)
    assert passed["last_turns"] == 3
    assert not passed["restart"]


def test_straight_down_is_at_its_share_of_the_feed():
    passed = down(3.0, (3.0, 2.0), PocketEntry(feed=40.0))
    assert passed == {"restart": True, "turns": 0, "feed": 600.0, "plunge_feed": 240.0}


def test_a_helix_of_a_thousand_turns_is_refused_by_the_first_level_alone():
    each = math.pi * 0.01 * math.tan(math.radians(3.0))
    down(0.01, (1990 * each, 9999 * each))
    with pytest.raises(Refusal, match=r"0\.01 needs 1004 turns for .*, the most is 1000: "):
        down(0.01, (2010 * each, each))


@pytest.mark.parametrize(
    ("cutter", "height", "advice"),
    [
        (5.0, 100.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (0.0, 100.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (5.0, 2000.0, r"([\d.]+) down fits at most, or \[G12\] ENTRY = plunge"),
    ],
)
def test_the_advice_of_a_refused_helix_holds(cutter, height, advice):
    """With D0 no size of the cutter limits the helix."""

    def narrow(first, deep):
        pocket_descent(Words("G13", {}, MM), HELIX, first, cutter, (deep, 1.0))

    with pytest.raises(Refusal) as refused:
        narrow(0.01, height)
    advised = float(re.search(f"{advice}$", refused.value.message)[1])
    if advice.startswith("I"):
        narrow(advised - cutter + 1e-4, height)
        with pytest.raises(Refusal):
            narrow(advised - cutter - 0.005, height)
    else:
        narrow(100.0, advised - 1e-2)
        with pytest.raises(Refusal):
            narrow(100.0, advised * 1.005)
