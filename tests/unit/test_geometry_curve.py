# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs against shapely's fine polylines, and each method against the others."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely.geometry import LineString, Point

from g12.geometry.curve import Arc, Line, angle_of, recentred, sweep_between

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


@given(CURVE, SHARE)
def test_a_curve_reversed_is_the_same_the_other_way(curve, share):
    back = curve.reversed()
    assert (back.start, back.end) == (near(curve.end), near(curve.start))
    assert back.point(share) == near(curve.point(1.0 - share))
    assert back.direction(share) == near(-curve.direction(1.0 - share))


@given(CURVE, st.floats(0.0, 0.4))
def test_the_curvature_is_the_turn_to_the_left_by_the_length(curve, share):
    length = min(0.1, 0.5 * curve.length)
    turned = curve.direction(share + length / curve.length) / curve.direction(share)
    assert curve.curvature * length == near(angle_of(turned))


@given(CURVE, st.floats(0.0, 0.4), st.floats(0.6, 1.0))
def test_a_portion_lies_between_two_shares(curve, first, last):
    part = curve.portion(first, last)
    assert (part.start, part.end) == (near(curve.point(first)), near(curve.point(last)))
    assert part.length == pytest.approx((last - first) * curve.length)
    assert part.point(0.5) == near(curve.point((first + last) / 2))


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
