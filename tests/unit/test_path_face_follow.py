# SPDX-License-Identifier: GPL-2.0-or-later
"""The demand of a move on the face on C and the slide, against formulas and finite differences."""

import math

import numpy as np
import pytest

from g12.tools.path.face_follow import demand, followed_along
from g12.tools.path.lathe_axes import LatheAxes, Rates
from support.made_moves import Hand

QUICK = 1e9
SLIDE, C = Rates(QUICK, 1000.0), Rates(QUICK, 60.0)


def axes(slide=SLIDE, c=C):
    """Return axes with the limits of C in radians."""
    return LatheAxes(slide, slide, Rates(*map(math.degrees, c)), face=(700.0, 700.0))


def line(distance, reach=50.0, centre=0.0):
    """Return a line that passes the spindle at a distance."""
    return Hand().rapid(x=centre - reach, y=distance).line(x=centre + reach).moves[-1]


@pytest.mark.parametrize("centre", [0.0, 30.0])
def test_a_line_turns_c_most_where_it_is_nearest_and_pushes_it_most_beside_that(centre):
    slide, angle = followed_along(line(5.0, centre=centre), 0.0, centre, 0.0)
    assert max(abs(angle[0])) == pytest.approx(1 / 5.0, rel=1e-3)
    assert max(abs(angle[1])) == pytest.approx(3 * math.sqrt(3) / 8 / 5.0**2, rel=1e-3)
    assert max(abs(slide[1])) == pytest.approx(1 / 5.0, rel=1e-3)


@pytest.mark.parametrize("beside", [0.0, 3.0, -3.0])
def test_the_derivatives_are_those_of_slide_and_angle(beside):
    radius, step = 30.0, 1e-4
    arc = Hand().rapid(x=40.0).arc(1, 10.0, 0.0).moves[-1]
    (slide, slide_bent), (c, c_bent) = followed_along(arc, 1 / radius, 0.0, beside)
    angles = np.linspace(0.0, arc.sweep, len(c))
    points = [10 + radius * np.exp(1j * (angles + turn)) for turn in (-step, 0, step)]
    slides = [np.sqrt(abs(z) ** 2 - beside**2) for z in points]
    stands = [np.unwrap(np.angle(z / (r + 1j * beside))) for z, r in zip(points, slides)]
    for (one, two, three), first, second in ((slides, slide, slide_bent), (stands, c, c_bent)):
        assert (three - one) / (2 * step * radius) == pytest.approx(first, abs=1e-6)
        bent = (three - 2 * two + one) / (step * radius) ** 2
        assert bent == pytest.approx(second, abs=1e-5)


@pytest.mark.parametrize(
    ("distance", "speed", "c", "axis", "times"),
    [
        (5.0, 1.0, 60.0, "c", 700 / 5 / 60),
        (20.0, 200.0, 600.0, "slide", 2.0),  # 200**2 / 20 / 1000
    ],
)
def test_the_accelerations_of_c_and_the_slide(distance, speed, c, axis, times):
    found = demand(line(distance), speed, 0.0, axes(c=Rates(QUICK, c)))
    assert getattr(found, axis) == pytest.approx(times, rel=0.1)


@pytest.mark.parametrize("rounding", [0.0, 1e-15, -1.7e-15])
def test_a_line_into_the_centre_turns_no_c(rounding):
    move = Hand().rapid(x=7.0).line(x=rounding).moves[-1]
    assert demand(move, 5.0, 0.0, axes()).c == pytest.approx(0.0, abs=1e-9)


def test_the_speeds_of_c_and_the_slide():
    """At 10 mm from the spindle C is at its speed with 20 mm/s."""
    found = demand(line(10.0), 15.0, 0.0, axes(Rates(30.0, 1000.0), Rates(2.0, 60.0)))
    assert found.c_speed == pytest.approx(0.75, rel=1e-3)
    assert found.slide_speed == pytest.approx(0.5, rel=0.05)


def test_an_arc_is_no_faster_than_x_and_y_let_it_be():
    arc = Hand().rapid(x=7.0).arc(1, 0.0, 0.0).moves[-1]
    found = demand(arc, 1000.0, 0.0, axes(c=Rates(10.0, 60.0)))
    assert found.plane == pytest.approx(1000**2 / 7 / 700)
    assert found.c_speed == pytest.approx(math.sqrt(700 * 7) / 7 / 10)
