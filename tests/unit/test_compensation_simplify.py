# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves that are rounding, and moves too short to matter, do not spoil a contour."""

import cmath
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Point

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import Contour
from g12.errors import Refusal
from support.planned_cuts import cuts, path
from support.random_contours import TOLERANCE, as_shapely, polygon
from support.section_starts import polar


def programmed(*points, side=40, radius=0.0, start=(30.0, -30.0)):
    """Return the contour through points of the plane (None: Z), ramps included."""
    contour = Contour(start[0], 0.0, 0.0)
    contour.straight(second=start[1], at=1, feed=600.0)
    contour.compensate(side, radius, at=2)
    for line, (x, c) in enumerate(points[:-1], 2):
        contour.straight(x, c, at=line, feed=600.0)
    contour.compensate(40, 0.0, at=90)
    contour.straight(*points[-1], at=90, feed=600.0)
    return contour


def refused(contour):
    """Return whether the contour is refused."""
    try:
        polar().plan(contour)
    except Refusal:
        return True
    return False


def tool_points(contour, lines):
    """Return the planned path of the tool's centre on some lines, as complex numbers."""
    made = cuts(contour, polar().plan(contour))
    return path([cut for cut in made if cut.line in lines])


def depth(contour, walls, radius, lines):
    """Return how much deeper than its radius the tool cuts into walls."""
    outline = LineString([(z.real, z.imag) for z in tool_points(contour, lines)])
    return radius - outline.distance(LineString(walls))


@pytest.mark.parametrize("side", [41, 42])
@pytest.mark.parametrize(("radius", "chord"), [(40, 0.025), (12, 0.02)])
def test_fine_points_with_few_decimals_are_cut(side, radius, chord):
    count = int(math.pi * radius / chord)
    arc = [radius * cmath.exp(-1j * math.pi * k / count) for k in range(count + 1)]
    points = [(round(z.real, 3), round(z.imag, 3)) for z in arc]
    outside = side == 41
    start = (radius + 8.0, 0.0) if outside else (radius - 5.5, 0.0)
    away = (-radius - 8.0, 0.0) if outside else (-radius + 5.5, 0.0)
    contour = programmed(*points, away, side=side, radius=5.0, start=start)
    made = abs(tool_points(contour, range(3, 80)))
    expected = radius + 5.0 if outside else radius - 5.0
    assert abs(made - expected).max() < 0.005 + 0.0008


size = st.floats(0.0001, 1.6).map(lambda value: round(value, 4))
angle = st.floats(0.0, 2 * math.pi)


@settings(max_examples=300)
@given(extra=st.lists(st.tuples(size, angle), min_size=1, max_size=3))
def test_short_moves_in_a_corner_are_cut_right_or_refused(extra):
    walls = [30 - 30j, 30 + 10j]
    for length, direction in extra:
        walls.append(walls[-1] + length * cmath.exp(1j * direction))
    walls.append(walls[-1] - 30)
    points = [(z.real, z.imag) for z in walls]
    contour = programmed(*points, (points[-1][0], -20), side=41, radius=5.0, start=(20.0, -40.0))
    if not refused(contour):
        near = range(3, 3 + len(points) - 1)
        assert depth(contour, points, 5.0, near) < 0.012


# Fillets of the tool's radius.


def in_thousandths(point):
    return complex(round(point.real, 3), round(point.imag, 3))


def with_fillets(turned, radius):
    """Return a pocket of five sides, its fillets as round as the tool, and their centres.

    All words have three decimals, also I and J: hardly a fillet has quite that radius.
    """
    corners = [cmath.rect(20.0, turned + 0.4 * math.pi * k) for k in range(5)]
    sides, contour = polygon(corners), Contour(0.0, 0.0, 0.0, radius_tolerance=0.01)
    contour.compensate(41, radius, at=1)
    contour.straight(sides[0].start.real, sides[0].start.imag, at=1, feed=100.0)
    centres = [side.end * (1.0 - radius / math.cos(math.pi / 5) / 20.0) for side in sides[:5]]
    cut = radius * math.tan(math.pi / 5)
    for line, (side, after, centre) in enumerate(zip(sides, sides[1:], centres), 2):
        start = in_thousandths(side.end - cut * side.direction())
        end = in_thousandths(side.end + cut * after.direction())
        arm = in_thousandths(centre - start)
        contour.straight(start.real, start.imag, at=line, feed=100.0)
        contour.arc(1, end.real, end.imag, i=arm.real, j=arm.imag, at=line, feed=100.0)
    contour.straight(sides[0].start.real, sides[0].start.imag, at=90, feed=100.0)
    contour.compensate(40, 0.0, at=91)
    contour.straight(0.0, 0.0, at=91, feed=100.0)
    return contour, centres


@pytest.mark.parametrize("radius", [1.0, 3.0])
def test_a_fillet_of_the_tools_radius_is_cut_though_it_is_rounded(radius):
    for k in range(25):
        contour, centres = with_fillets(0.07 * k, radius)
        made, moved = centre_path(contour, TOLERANCE)
        assert 0.0 < moved < 0.0015
        way, wall = as_shapely(made[1:-1]), as_shapely(contour.elements[1:-1])
        assert radius - way.distance(wall) < TOLERANCE
        assert max(way.distance(Point(each.real, each.imag)) for each in centres) < 0.0015
