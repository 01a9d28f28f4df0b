# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that judges sections: round convex polygons it is shapely's parallel."""

import cmath
import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from support.toolpath import Element, contour_path

RADIUS = 3.0  # of the tool, mm


def element(line, start, end, **more):
    return Element(line, start, end, 1, False, -1.0, feed=100.0, **more)


def compensated(*elements):
    return contour_path(elements, -1.0, RADIUS)


@given(angles=st.lists(st.floats(0.3, 2.0), min_size=3, max_size=9), size=st.floats(5, 30))
def test_round_a_convex_polygon_it_is_the_parallel_of_the_area(angles, size):
    turns = [2 * math.pi * sum(angles[:k]) / sum(angles) for k in range(len(angles))]
    corners = [cmath.rect(size, -turn) for turn in turns]  # clockwise: G41 is outside
    start = (corners[-1] + corners[0]) / 2
    path = compensated(*(element(1, *ends) for ends in pairwise([start, *corners, start])))
    outline = Polygon([(p.real, p.imag) for p in corners]).buffer(RADIUS, 512).exterior
    places = [Point(x, y) for step in path for x, y, _ in step.points()[::20]]
    assert max(map(outline.distance, places)) < 0.02
    assert sum(step.length for step in path) == pytest.approx(outline.length, rel=1e-3)


def test_an_inside_arc_of_the_tool_radius_is_a_point_of_the_toolpath():
    arc = element(11, 3 + 0j, 3j, centre=0j, sweep=math.pi / 2)
    path = compensated(element(10, 3 - 9j, 3 + 0j), arc, element(12, 3j, -9 + 3j))
    assert path[0].curve.end == path[-1].curve.start == pytest.approx(0j)
