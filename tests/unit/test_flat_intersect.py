# SPDX-License-Identifier: GPL-2.0-or-later
"""How near two moves come to each other, against shapely's distance of fine polylines."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString

from g12.flat.contour import Arc, Line
from g12.flat.intersect import least_distance

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
