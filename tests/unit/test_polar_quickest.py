# SPDX-License-Identifier: GPL-2.0-or-later
"""What of a section is made on the face, with which acceleration: as it is made soonest."""

from itertools import groupby
from math import hypot, pi, radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.polar.face import FaceLimits, MoveDemands
from g12.polar.quickest import quickest
from g12.section.effects import Action
from support import planned_moves

QUICK = FaceLimits(1000.0, 707.0, 1000.0, radians(3600.0), radians(360.0), 1.0, 20.0)
SLOW = FaceLimits(1500.0, 1060.0, 1500.0, radians(1200.0), radians(90.0), 1.5, 35.0)


def line(*ends, feed):
    return planned_moves.line(*ends[0], *ends[1], feed=feed)


def circle(radius, off, feed, sweep=2 * pi):
    return planned_moves.arc(off + 0j, off + radius + 0j, sweep, feed=feed)


def length_of(path):
    return sum(part.length for part in path)


def made_of(path, limits):
    return quickest(path, [False] * len(path), limits)


def shares_of(made):
    return [stretch.share if stretch else 0.0 for stretch in made.stretches]


def test_in_front_of_the_pole_and_after_it_a_line_is_on_the_face():
    made = quickest([line((-90, 0.5), (90, 0.5), feed=3000.0)], [True], QUICK)
    there, *beside, back = shares_of(made)
    assert there == back > 0.0 in beside
    assert made.stopping == [*[False] * (len(made.path) - 1), True]
    in_segments = [part for part, share in zip(made.path, shares_of(made)) if not share]
    assert [part.feed for part in in_segments] == [3000.0]
    assert in_segments[0].length < 40
    for before, after in zip(made.path, made.path[1:]):
        assert before.end == pytest.approx(after.start)


SHORT = line((1e-4, -1), (1e-4, 1), feed=1000.0)
MARK = Action(2, "M8", None)


@pytest.mark.parametrize(("seconds", "worth"), [(0.0995, False), (0.1005, True)])
def test_a_tenth_of_a_second_is_worth_the_way_to_the_face(seconds, worth):
    far = line((40, 0), (40, 10 * seconds), feed=600.0)
    shares = shares_of(made_of([SHORT, far, MARK, SHORT], QUICK))
    assert [*map(bool, shares)] == [False, worth, worth, False]


ways = st.lists(
    st.tuples(st.floats(-60, 60), st.floats(-60, 60), st.floats(300, 6000)), min_size=2, max_size=4
).map(
    lambda corners: [
        line(a[:2], b[:2], feed=b[2])
        for a, b in zip(corners, corners[1:])
        if hypot(a[0] - b[0], a[1] - b[1]) > 0.5 and abs(a[0] * b[1] - a[1] * b[0]) > 1.0
    ]
)
circles = st.builds(
    circle, st.floats(1, 30), st.floats(3, 60), st.floats(300, 6000), st.sampled_from((2 * pi, -3))
).map(lambda move: [move])


@settings(max_examples=100)
@given(st.one_of(ways, circles), st.sampled_from([QUICK, SLOW]))
def test_all_of_the_path_is_made_and_followed(path, limits):
    made = made_of(path, limits)
    assert len(made.path) == len(made.stopping) == len(made.stretches)
    assert length_of(made.path) == pytest.approx(length_of(path))
    for share, run in groupby(zip(made.path, shares_of(made)), lambda one: one[1]):
        for move, _ in run:
            assert not share or MoveDemands(move, limits).can_be_followed(share)
            assert share or move.feed in [one.feed for one in path]


def test_where_c_is_too_slow_the_feed_is_what_it_can_follow():
    made = made_of([circle(10, 20, 2000.0)], SLOW)
    feeds = [part.feed for part, share in zip(made.path, shares_of(made)) if share]
    assert 2000.0 == max(feeds) > min(feeds)
    assert abs(made.path[-1].end) == pytest.approx(30.0)
