# SPDX-License-Identifier: GPL-2.0-or-later
"""How near two moves come to each other, against shapely's distance of fine polylines."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point

from g12.compensation.contour import Arc, Line
from g12.compensation.intersect import (
    along_end,
    along_start,
    common_places,
    crossing,
    least_distance,
    part_of_move,
)

SAGITTA = 2e-4

place = st.builds(complex, *[st.integers(-8, 8)] * 2)
sweep = st.sampled_from([-2, -1.5, -1, -0.3, 0.2, 0.5, 1.9, 2]).map(lambda turn: turn * math.pi)


@st.composite
def moves(draw):
    """Draw a line or an arc."""
    start, other = draw(place), draw(place)
    if start == other:
        other += 1
    if draw(st.booleans()):
        return Line(1, 1.0, 0.0, start.real, start.imag, 0.0, other.real, other.imag, 0.0)
    turned = draw(sweep)
    end = other + (start - other) * cmath.exp(1j * turned)
    ends = (start.real, start.imag, 0.0, end.real, end.imag, 0.0)
    return Arc(1, 1.0, 0.0, *ends, other.real, other.imag, turned)


def polyline(move):
    """Return a move as a polyline that is off it by less than SAGITTA."""
    if isinstance(move, Line):
        return LineString([(move.x0, move.c0), (move.x1, move.c1)])
    centre, start = complex(move.cx, move.cc), complex(move.x0, move.c0)
    step = 2 * math.acos(1 - SAGITTA / abs(start - centre))
    turned = np.linspace(0, move.sweep, int(abs(move.sweep) / step) + 2)
    points = centre + (start - centre) * np.exp(1j * turned)
    return LineString(np.column_stack([points.real, points.imag]))


@settings(deadline=None, max_examples=500)
@given(moves(), moves())
def test_least_distance(one, other):
    expected = polyline(one).distance(polyline(other))
    assert least_distance(one, other) == pytest.approx(expected, abs=3 * SAGITTA)
    assert least_distance(other, one) == pytest.approx(expected, abs=3 * SAGITTA)


def runs_on(one, other):
    """Return whether two moves lie on one line, or on circles about one centre."""
    if type(one) is not type(other):
        return False
    if isinstance(one, Arc):
        return (one.cx, one.cc) == (other.cx, other.cc)
    a, b = (complex(m.x1 - m.x0, m.c1 - m.c0) for m in (one, other))
    return abs((a.conjugate() * b).imag) < 1e-9


@settings(deadline=None, max_examples=300)
@given(moves(), moves())
def test_common_places(one, other):
    places = [Point(place) for place in common_places(one, other)]
    drawn = polyline(one), polyline(other)
    assert all(line.distance(place) <= 2 * SAGITTA for line in drawn for place in places)
    met = drawn[0].intersection(drawn[1])
    if runs_on(one, other) or met.is_empty:
        assert not runs_on(one, other) or not places
        return
    for place in getattr(met, "geoms", [met]):  # where they touch, chords cross beside it
        assert min(place.distance(known) for known in places) < 0.15


@given(moves(), st.floats(0.0, 0.4), st.floats(0.6, 1.0))
def test_a_part_of_a_move_is_on_its_way_and_at_its_height(move, first, last):
    part = part_of_move(move._replace(z0=1.0, z1=-3.0), first, last)
    assert (part.z0, part.z1) == pytest.approx((1.0 - 4.0 * first, 1.0 - 4.0 * last))
    whole, cut = polyline(move), polyline(part)
    assert cut.length == pytest.approx((last - first) * whole.length, rel=1e-3)
    for place, at in (((part.x0, part.c0), first), ((part.x1, part.c1), last)):
        expected = whole.interpolate(at, normalized=True)
        assert Point(place).distance(expected) < 0.02


def arc_of(sweep, radius=3.0, centre=2 - 1j, first=0.4):
    """Return an arc, and what gives the place at an angle behind its start, in its sense."""
    turn = math.copysign(1.0, sweep)

    def place(angle):
        at = centre + radius * cmath.exp(1j * (first + turn * angle))
        return at.real, at.imag

    ends = (*place(0.0), 0.0, *place(abs(sweep)), 0.0)
    return Arc(1, 1.0, 0.0, *ends, centre.real, centre.imag, sweep), place


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize(("sweep", "beside"), [(0.3, 1.5), (1.0, 1.0), (3.0, 1.0)])
def test_places_along_an_arc_and_beside_its_ends(sweep, beside, turn):
    arc, place = arc_of(turn * sweep)
    for angle in (0.0, 0.5 * sweep, sweep):
        assert along_start(arc, place(angle)) == pytest.approx(3 * angle, abs=1e-9)
        assert along_end(arc, place(angle)) == pytest.approx(3 * angle, abs=1e-9)
    assert along_start(arc, place(-beside)) == pytest.approx(-3 * beside)
    assert along_end(arc, place(sweep + beside)) == pytest.approx(3 * (sweep + beside))


@pytest.mark.parametrize("sweep", [2 * math.pi, -2 * math.pi])
def test_a_place_in_front_of_a_circle_or_behind_it(sweep):
    """The half radian next to an end belongs to what lies beyond it."""
    arc, place = arc_of(sweep)
    assert along_start(arc, place(-0.4)) == pytest.approx(-1.2)
    assert along_start(arc, place(-0.6)) == pytest.approx(3 * (2 * math.pi - 0.6))
    assert along_end(arc, place(0.4)) == pytest.approx(3 * (2 * math.pi + 0.4))
    assert along_end(arc, place(0.6)) == pytest.approx(1.8)


def test_of_two_crossings_the_one_nearest_to_the_corner():
    """A line and an arc of radius 3 about the origin that meet at the left, half way up."""
    left = (pytest.approx(-math.sqrt(9 - 2.25)), pytest.approx(1.5))
    ends = (-3.0, 0.0, 0.0, 0.0, -3.0, 0.0)
    assert (
        crossing(
            Line(1, 1.0, 0.0, 10.0, 1.5, 0.0, -3.0, 1.5, 0.0),
            Arc(1, 1.0, 0.0, *ends, 0.0, 0.0, -1.5 * math.pi),
        )
        == left
    )
    ends = (3.0, 0.0, 0.0, 3 * math.cos(3.0), 3 * math.sin(3.0), 0.0)
    assert (
        crossing(
            Arc(1, 1.0, 0.0, *ends, 0.0, 0.0, 3.0),
            Line(1, 1.0, 0.0, -3.0, 1.5, 0.0, 10.0, 1.5, 0.0),
        )
        == left
    )


def test_moves_that_meet_end_to_start_cross_there():
    to = Line(1, 1.0, 0.0, 3.0, -2.0, 0.0, 5.0, 1.0, 0.0)
    for end in ((9.0, 2.0), (5.0, -7.0), (3.0, 4.0)):
        on = Line(2, 1.0, 0.0, 5.0, 1.0, 0.0, *end, 0.0)
        assert crossing(to, on) == pytest.approx((5.0, 1.0))


def test_moves_that_miss_each_other_have_no_crossing():
    line = Line(1, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)
    beyond = Line(1, 1.0, 0.0, 1.1, 1.0, 0.0, 1.1, -1.0, 0.0)
    assert crossing(line, beyond) is None
    assert crossing(beyond, line) is None
    along = Line(1, 1.0, 0.0, 1.0, 1.0, 0.0, 2.0, 1.0, 0.0)
    assert crossing(line, along) is None
