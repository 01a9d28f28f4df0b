# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs against shapely's fine polylines, and each method against the others."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely.geometry import LineString, Point

from g12.geometry.curve import (
    Arc,
    Line,
    angle_of,
    common_points,
    crossings,
    recentred,
    sweep_between,
)

SAGITTA = 2e-4
NUMBER = st.integers(-800, 800).map(lambda hundredths: hundredths / 100)
POINT = st.builds(complex, NUMBER, NUMBER)
SWEEP = st.sampled_from([-2, -1.5, -1, -0.3, 0.2, 0.5, 1.9, 2]).map(lambda turn: turn * math.pi)
LINE = st.builds(Line, POINT, POINT).filter(lambda line: line.length > 0.1)
ARC = st.builds(Arc, POINT, POINT, SWEEP).filter(lambda arc: arc.radius > 0.1)
CURVE = LINE | ARC
SHARE = st.floats(0.0, 1.0)


def drawn(curve):
    """Return a curve as a polyline that is off it by less than SAGITTA."""
    if isinstance(curve, Line):
        points = np.array(curve)
    else:
        step = 2 * math.acos(1 - SAGITTA / curve.radius)
        turned = np.linspace(0, curve.sweep, int(abs(curve.sweep) / step) + 2)
        points = curve.centre + (curve.start - curve.centre) * np.exp(1j * turned)
    return LineString(np.column_stack([points.real, points.imag]))


def as_point(point):
    return Point(point.real, point.imag)


def near(point):
    return pytest.approx(point, abs=1e-9)


@given(CURVE, POINT)
def test_the_distance_is_that_of_the_nearest_point(curve, point):
    away = drawn(curve).distance(as_point(point))
    assert curve.distance(point) == pytest.approx(away, abs=2 * SAGITTA)
    share = curve.share_of(point)
    assert 0.0 <= share <= 1.0
    assert abs(curve.point(share) - point) == near(curve.distance(point))


@given(CURVE, SHARE, st.sampled_from([-20.0, -2.5, -0.4, 0.3, 3.0, 15.0]))
def test_a_parallel_is_so_far_to_the_left(curve, share, distance):
    """Also where an arc is offset beyond its own centre; of less than that it runs the same way."""
    left = 1j * distance * curve.direction(share)
    parallel = curve.offset(distance)
    assert parallel.point(share) == near(curve.point(share) + left)
    inward = distance if getattr(curve, "sweep", 1.0) > 0.0 else -distance
    if isinstance(curve, Line) or inward < 0.9 * curve.radius:
        assert parallel.direction(share) == near(curve.direction(share))


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize(("sweep", "beside"), [(0.3, 1.5), (1.0, 1.0), (3.0, 1.0)])
def test_the_length_to_a_point_beyond_an_end(sweep, beside, turn):
    arc = Arc(5 - 1j, 2 - 1j, turn * sweep)
    for late in (False, True):
        assert arc.length_to(arc.point(-beside / sweep), late) == near(-3 * beside)
        assert arc.length_to(arc.point(1 + beside / sweep), late) == near(3 * (sweep + beside))
    line = Line(1 + 1j, 4 + 5j)
    assert (line.length_to(line.point(-1)), line.length_to(line.point(3))) == (near(-5), near(15))


@given(POINT, POINT, POINT)
def test_a_centre_is_moved_to_be_as_far_from_both_ends(start, end, centre):
    assume(abs(end - start) > 0.1)
    moved = recentred(start, end, centre)
    assert abs(moved - start) == near(abs(moved - end))
    assert ((moved - centre) * (1j * (end - start)).conjugate()).real == near(0.0)


@given(ARC, st.floats(0.01, 0.99))
def test_the_sweep_between_two_points_of_an_arc(arc, share):
    turn = 1 if arc.sweep > 0.0 else -1
    swept = sweep_between(arc.start, arc.point(share), arc.centre, turn)
    assert swept == near(share * arc.sweep)
    assert sweep_between(arc.start, arc.start, arc.centre, turn) == turn * 2 * math.pi


def test_a_vector_that_underflows_has_an_angle():
    assert angle_of(complex(2.0, 5e-324)) == 0.0


# ---------------------------------------------------------------- where two curves meet

CIRCLE = st.builds(
    lambda centre, radius: Arc(centre + radius, centre, 2 * math.pi), POINT, st.floats(0.5, 15)
)


def extended(curve):
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
    met = extended(one).intersection(extended(other))
    places = [complex(p.x, p.y) for p in getattr(met, "geoms", [met]) if p.geom_type == "Point"]
    assume(not met.is_empty and met.geom_type in ("Point", "MultiPoint"))
    apart = min((abs(a - b) for a in places for b in places if a != b), default=math.inf)
    assume(apart > 0.1)
    assume(not isinstance(one, Arc) or not isinstance(other, Arc) or one.centre != other.centre)
    for place in (place for place in places if abs(place) < 500):
        assert min(abs(place - each) for each in found) < 0.05


@given(CURVE, LINE)
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
