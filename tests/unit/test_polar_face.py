# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves in X and Y of the face: which of a section, how fast C and the slide follow, how made."""

from math import hypot, inf, pi, radians

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Plunge
from g12.geometry.curve import Arc
from g12.polar.face import FaceLimits, MoveDemands, blending_halves
from g12.polar.quickest import quickest
from g12.section.effects import Action
from support import planned_moves
from support.face_moves import LIMITS, arc, arcs, line, lines, motion


@pytest.mark.parametrize(
    ("following", "halved"),
    [
        (line((20, 10), (0, 10)), True),
        (line((20, 10), (0, 10.1)), False),
        (line((20, 10), (0, 10 + 20 * 0.9e-6)), True),
        (line((20, 10), (0, 10 - 20 * 1.1e-6)), False),
        (line((20, 10), (40, 10)), False),
        (arc((20, 0), 10, pi / 2, 1), True),
        (arc((20, 20), 10, -pi / 2, -1), True),
        (arc((20, 20), 10, -pi / 2, 1), False),
        (Plunge(1, 100.0, 0.0, -1.0), True),
    ],
)
def test_an_arc_whose_acceleration_blending_would_halve(following, halved):
    assert blending_halves(arc((20, 0), 10, 0, pi / 2), following) is halved


# How fast C and the slide can follow.


def share_of_limits(move, limits):
    """Return how much of the limits a move takes, in numbers, wherever it goes on, stops or starts.

    C and the slide are where they have to be for 2,000 places; how they change from one to the next
    tells their speeds and accelerations, those along the path included.
    """
    points, speed = motion(move, limits)
    slide = np.sqrt(abs(points) ** 2 - limits.beside**2)
    angle = np.unwrap(np.angle(points) - np.arctan2(limits.beside, slide))
    most, curving = limits.acceleration, 0.0
    if isinstance(move.curve, Arc):
        most = limits.round_acceleration
        curving = speed**2 / move.curve.radius
    step, slower = abs(points[1] - points[0]), np.linspace(0.0, 1.0, 20)[:, None] ** 0.5
    left = np.sqrt(np.maximum(0.0, most**2 - (slower**2 * curving) ** 2))
    shares = []
    for axis, fastest, most_quick in (
        (angle, limits.c_speed, limits.c_acceleration),
        (slide, limits.slide_speed, limits.slide_acceleration),
    ):
        rate, bend = abs(np.gradient(axis, step)), abs(np.gradient(np.gradient(axis, step), step))
        inner = slice(2, -2)
        shares += [speed * rate.max() / fastest, most * rate.max() / most_quick]
        used = (slower * speed) ** 2 * bend + left * rate
        shares.append(used[:, inner].max() / most_quick)
    return max(shares)


@settings(max_examples=300)
@given(
    st.one_of(lines, arcs),
    st.sampled_from([0.0, 0.0, 3.0, -10.0]),
    st.sampled_from([inf, 60.0]),
    st.floats(0.2, 5.0),
)
def test_a_move_is_able_if_its_place_that_asks_the_most_is(move, beside, slide_speed, quick):
    limits = LIMITS._replace(
        beside=beside, slide_speed=slide_speed, c_acceleration=quick * LIMITS.c_acceleration
    )
    assume(abs(motion(move)[0]).min() > abs(beside) + 0.5)
    share = share_of_limits(move, limits)
    assert MoveDemands(move, limits).can_be_followed() == (share < 1.0) or 0.97 < share < 1.1


# What is made on the face, and with which acceleration: as it is made soonest.

QUICK = FaceLimits(1000.0, 707.0, 1000.0, radians(3600.0), radians(360.0), 1.0, 20.0)
SLOW = FaceLimits(1500.0, 1060.0, 1500.0, radians(1200.0), radians(90.0), 1.5, 35.0)


def circle(radius, off, feed, sweep=2 * pi):
    return planned_moves.arc(off + 0j, off + radius + 0j, sweep, feed=feed)


def length_of(path):
    return sum(part.length for part in path)


def made_of(path, limits, stop=False):
    """Return the divided path, its stops, and the share of each move's stretch, 0 in segments."""
    made = list(quickest(path, [stop] * len(path), limits))
    moves, stops = ([each[k] for each in made] for k in (0, 1))
    return moves, stops, [stretch.share if stretch else 0.0 for _, _, stretch in made]


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
@example([circle(28, 26.75, 463.0)], QUICK)  # C accelerates most between two points
def test_all_of_the_path_is_made_and_followed(path, limits):
    made, _, shares = made_of(path, limits)
    assert length_of(made) == pytest.approx(length_of(path))
    for move, share in zip(made, shares):
        assert not share or MoveDemands(move, limits).can_be_followed(share)
        assert share or move.feed in [one.feed for one in path]


def test_in_front_of_the_pole_and_after_it_a_line_is_on_the_face():
    path, stopping, shares = made_of([line((-90, 0.5), (90, 0.5), feed=3000.0)], QUICK, stop=True)
    there, *beside, back = shares
    assert there == back > 0.0 in beside
    assert stopping == [*[False] * (len(path) - 1), True]
    in_segments = [part for part, share in zip(path, shares) if not share]
    assert [part.feed for part in in_segments] == [3000.0]
    assert in_segments[0].length < 40
    for before, after in zip(path, path[1:]):
        assert before.end == pytest.approx(after.start)


SHORT = line((1e-4, -1), (1e-4, 1), feed=1000.0)


MARK = Action(2, "M8", None)


@pytest.mark.parametrize(("seconds", "worth"), [(0.0995, False), (0.1005, True)])
def test_a_tenth_of_a_second_is_worth_the_way_to_the_face(seconds, worth):
    far = line((40, 0), (40, 10 * seconds), feed=600.0)
    *_, shares = made_of([SHORT, far, MARK, SHORT], QUICK)
    assert [*map(bool, shares)] == [False, worth, worth, False]


def test_where_c_is_too_slow_the_feed_is_what_it_can_follow():
    path, _, shares = made_of([circle(10, 20, 2000.0)], SLOW)
    feeds = [part.feed for part, share in zip(path, shares) if share]
    assert 2000.0 == max(feeds) > min(feeds)
    assert abs(path[-1].end) == pytest.approx(30.0)
