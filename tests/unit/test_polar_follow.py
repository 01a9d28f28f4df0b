# SPDX-License-Identifier: GPL-2.0-or-later
"""How fast C and the slide can follow moves on the face."""

from math import inf

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from g12.geometry.curve import Arc
from g12.polar.face import MoveDemands
from support.face_moves import LIMITS, arcs, lines, motion


def can_follow(move, limits):
    return MoveDemands(move, limits).can_be_followed()


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
    for axis, fastest, quickest in (
        (angle, limits.c_speed, limits.c_acceleration),
        (slide, limits.slide_speed, limits.slide_acceleration),
    ):
        rate, bend = abs(np.gradient(axis, step)), abs(np.gradient(np.gradient(axis, step), step))
        inner = slice(2, -2)
        shares += [speed * rate.max() / fastest, most * rate.max() / quickest]
        used = (slower * speed) ** 2 * bend + left * rate
        shares.append(used[:, inner].max() / quickest)
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
    assert can_follow(move, limits) == (share < 1.0) or 0.97 < share < 1.1
