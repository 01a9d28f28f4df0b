# SPDX-License-Identifier: GPL-2.0-or-later
"""What a move on the face asks of C and the slide, against what can be worked out by hand."""

import math

import pytest

from g12.tools.verify.sections.face_follow import (
    FollowLimits,
    derivatives,
    follow_off,
    is_slow_enough,
)
from support.made_moves import Hand

LIMITS = FollowLimits(plane=700.0, slide=1000.0, c=60.0)


def line(distance, reach=50.0, centre=0.0):
    """Return a line that passes the spindle at a distance."""
    return Hand().rapid(x=centre - reach, y=distance).line(x=centre + reach).moves[-1]


@pytest.mark.parametrize("centre", [0.0, 30.0])
def test_a_line_turns_c_most_where_it_is_nearest_and_pushes_it_most_beside_that(centre):
    slide, angle = derivatives(line(5.0, centre=centre), centre, 0.0)
    assert max(abs(angle[0])) == pytest.approx(1 / 5.0, rel=1e-3)
    assert max(abs(angle[1])) == pytest.approx(3 * math.sqrt(3) / 8 / 5.0**2, rel=1e-3)
    assert max(abs(slide[1])) == pytest.approx(1 / 5.0, rel=1e-3)


def test_a_circle_about_the_spindle_turns_c_evenly():
    arc = Hand().rapid(x=20.0).arc(1, 0.0, 0.0).moves[-1]
    slide, angle = derivatives(arc, 0.0, 0.0)
    assert angle[0] == pytest.approx(1 / 20.0, rel=1e-6)
    assert max(abs(slide[0])) < 1e-6


def test_beside_the_x_line_the_slide_stands_nearer_than_the_tool():
    slide, _ = derivatives(line(13.0), 0.0, 5.0)
    assert max(abs(slide[1])) == pytest.approx(1 / 12.0, rel=1e-3)  # 13, 12, 5


@pytest.mark.parametrize(
    ("distance", "speed", "c", "told"),
    [
        (20.0, 20.0, 60.0, None),
        (5.0, 1.0, 60.0, ("C", 700 / 5 / 60)),
        (20.0, 200.0, 600.0, ("the slide", 2.0)),  # 200**2 / 20 / 1000
    ],
)
def test_what_c_and_the_slide_cannot_do_is_told(distance, speed, c, told):
    found = follow_off(line(distance), speed, 0.0, 0.0, LIMITS._replace(c=c))
    assert (found and found.axis) == (told and told[0])
    assert not told or found.times == pytest.approx(told[1], rel=0.1)


@pytest.mark.parametrize("rounding", [0.0, 1e-15, -1.7e-15])
def test_a_line_into_the_centre_turns_no_c(rounding):
    move = Hand().rapid(x=7.0).line(x=rounding).moves[-1]
    assert follow_off(move, 5.0, 0.0, 0.0, LIMITS) is None


@pytest.mark.parametrize(
    ("share", "enough"), [(0.5, False), (0.75, False), (0.83, True), (0.97, True)]
)
def test_a_move_slower_than_c_can_follow_is_told(share, enough):
    """At 10 mm from the spindle C is at its speed with 20 mm/s."""
    limits = LIMITS._replace(plane=1e-3, c_speed=2.0, slide=1e9, c=1e9)
    assert is_slow_enough(line(10.0), share * 20.0, 0.0, 0.0, limits) is enough
