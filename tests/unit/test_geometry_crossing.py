# SPDX-License-Identifier: GPL-2.0-or-later
"""Where lines and circles meet: on both of them, and as often as shapely has it."""

import cmath
import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely.geometry import LineString, Point

from g12.geometry.curve import Arc, Line, common_points, crossings

NUMBER = st.floats(-20, 20).map(lambda value: round(value, 3))
PLACE = st.builds(complex, NUMBER, NUMBER)
CIRCLE = st.builds(
    lambda centre, radius: Arc(centre + radius, centre, 2 * math.pi), PLACE, st.floats(0.5, 15)
)
LINE = st.builds(Line, PLACE, PLACE).filter(lambda line: line.length > 0.1)


def drawn(curve):
    """Return what a curve lies on: a long straight line, or a polygon about a circle."""
    if isinstance(curve, Line):
        along = 1000 * curve.direction()
        return LineString([(p.real, p.imag) for p in (curve.start - along, curve.start + along)])
    return Point(curve.centre.real, curve.centre.imag).buffer(curve.radius, 4096).exterior


def off(curve, place):
    """Return how far a place is from what a curve lies on."""
    if isinstance(curve, Arc):
        return abs(abs(place - curve.centre) - curve.radius)
    return abs(((place - curve.start) * curve.direction().conjugate()).imag)


@given(one=st.one_of(LINE, CIRCLE), other=st.one_of(LINE, CIRCLE))
def test_crossings_are_on_both_and_all_there_are(one, other):
    found = crossings(one, other)
    assert all(max(off(one, place), off(other, place)) < 2e-3 for place in found)
    met = drawn(one).intersection(drawn(other))
    places = [complex(p.x, p.y) for p in getattr(met, "geoms", [met]) if p.geom_type == "Point"]
    assume(not met.is_empty and met.geom_type in ("Point", "MultiPoint"))
    apart = min((abs(a - b) for a in places for b in places if a != b), default=math.inf)
    assume(apart > 0.1)
    assume(not isinstance(one, Arc) or not isinstance(other, Arc) or one.centre != other.centre)
    for place in (place for place in places if abs(place) < 500):
        assert min(abs(place - each) for each in found) < 0.05


ARC = st.builds(Arc, PLACE, PLACE, st.sampled_from([-6.0, -3.0, -1.0, 0.5, 2.0, 5.0]))


@given(st.one_of(LINE, ARC.filter(lambda arc: arc.radius > 0.1)), LINE)
def test_common_points_are_the_crossings_on_both_curves(one, other):
    for pair in ((one, other), (other, one)):
        found = common_points(*pair)
        assert all(curve.distance(point) < 2e-6 for curve in pair for point in found)
        beside = [point for point in crossings(*pair) if point not in found]
        assert all(max(curve.distance(point) for curve in pair) > 1e-6 for point in beside)


@pytest.mark.parametrize(
    "pair",
    [
        (Line(0j, 5 + 0j), Line(1j, 5 + 1j)),
        (Arc(3 + 0j, 0j, 1.0), Arc(20 + cmath.rect(3, 1), 20 + 0j, 1.0)),
    ],
)
def test_what_does_not_meet_has_no_crossing(pair):
    assert crossings(*pair) == []
