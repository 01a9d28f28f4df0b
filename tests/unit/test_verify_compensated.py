# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that a compensated contour asks for, against the area's own parallel."""

import cmath
import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import Element

RADIUS, TOLERANCE = 3.0, 0.005


def element(line, start, end, side=1, ramp=False, depth=-1.0, **more):
    return Element(line, start, end, side, ramp, depth, feed=100.0, **more)


def lines(points, side=1):
    return [element(10 + k, a, b, side) for k, (a, b) in enumerate(pairwise(points))]


def steps(elements, height=-1.0):
    return [step.move for step in contour_path(elements, height, RADIUS, TOLERANCE)]


def points(moves):
    return [move.curve.point(share / 40) for move in moves for share in range(41)]


def assert_joined(moves):
    for before, after in pairwise(moves):
        assert after.curve.point(0.0) == pytest.approx(before.curve.point(1.0), abs=TOLERANCE)


@given(
    angles=st.lists(st.floats(0.3, 2.0), min_size=3, max_size=9),
    size=st.floats(5, 30),
)
def test_round_a_convex_polygon_it_is_the_parallel_of_the_area(angles, size):
    turns = [2 * math.pi * sum(angles[:k]) / sum(angles) for k in range(len(angles))]
    corners = [cmath.rect(size, -turn) for turn in turns]  # clockwise: G41 is outside
    start = (corners[-1] + corners[0]) / 2
    moves = steps(lines([start, *corners, start]))
    outline = Polygon([(p.real, p.imag) for p in corners]).buffer(RADIUS, 512).exterior
    path = points(moves)
    assert_joined(moves)
    assert max(outline.distance(Point(place.real, place.imag)) for place in path) < 0.02
    assert sum(move.length for move in moves) == pytest.approx(outline.length, rel=1e-3)


def test_inside_corners_end_where_parallels_cross():
    moves = steps(lines([0j, 10 + 0j, 10 + 10j]))
    assert [move.curve.end for move in moves] == pytest.approx([7 + 3j, 7 + 10j])


def test_an_outside_corner_is_part_of_the_element_that_follows():
    moves = steps(lines([0j, 10 + 0j, 10 - 10j]))
    assert [(move.name, move.line) for move in moves] == [
        ("contour", 10),
        ("corner", 11),
        ("contour", 11),
    ]
    assert moves[1].curve.centre == 10 and moves[1].curve.sweep == pytest.approx(-math.pi / 2)


def test_leads_are_square_to_the_contour_and_z_goes_down_where_the_centre_is():
    lead = element(8, -9 + 9j, 0j, 1, ramp=True, depth=2.0)
    down = element(9, 0j, 0j, 0, depth=-1.0)
    away = element(20, 10 + 0j, 20 + 9j, 0, ramp=True)
    moves = steps([lead, down, *lines([0j, 10 + 0j]), away], height=2.0)
    assert [move.name for move in moves] == ["ramp", "plunge", "contour", "ramp"]
    assert moves[0].curve.end == moves[1].curve.start == moves[1].curve.end == 3j
    assert moves[-1].curve.start == 10 + 3j
    assert [(move.start_level, move.end_level) for move in moves[:2]] == [(2, 2), (2, -1)]


@pytest.mark.parametrize("step", [0.03, 0.01, 0.002])
def test_short_lines_with_four_decimals_are_followed_within_the_tolerance(step):
    count = int(2 * math.pi * 8 / step)
    circle = [cmath.rect(8.0, -2 * math.pi * k / count) for k in range(count // 8)]
    moves = steps(lines([complex(round(p.real, 4), round(p.imag, 4)) for p in circle]))
    assert max(abs(abs(point) - 11.0) for point in points(moves)) < TOLERANCE
    assert_joined(moves)


def test_an_arc_whose_radius_is_the_tools_is_turned_about_in_place():
    arc = element(11, 3 + 0j, 3j, 1, centre=0j, sweep=math.pi / 2)
    moves = steps([element(10, 3 - 9j, 3 + 0j), arc, element(12, 3j, -9 + 3j)])
    assert moves[0].curve.end == moves[-1].curve.start == pytest.approx(0j)
