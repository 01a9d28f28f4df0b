# SPDX-License-Identifier: GPL-2.0-or-later
"""Boxes round moves: what is outside of one is nowhere near the move."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.flat.contour import Arc, Line
from g12.flat.nearby import apart, box_of

BARE = (1, 100.0, 0.0)
coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)


def arc(centre, start, sweep):
    end = centre + (start - centre) * cmath.rect(1.0, sweep)
    ends = (start.real, start.imag, 0.0, end.real, end.imag, 0.0)
    return Arc(*BARE, *ends, centre.real, centre.imag, sweep)


@given(point, point, st.floats(-6.28, 6.28).filter(lambda sweep: abs(sweep) > 0.01))
def test_an_arc_is_in_its_box_which_is_no_larger_than_it_may_be(centre, start, sweep):
    low_x, low_c, high_x, high_c = box_of(arc(centre, start, sweep))
    radius = abs(start - centre)
    for k in range(101):
        place = centre + (start - centre) * cmath.rect(1.0, sweep * k / 100)
        assert low_x - 1e-9 <= place.real <= high_x + 1e-9
        assert low_c - 1e-9 <= place.imag <= high_c + 1e-9
    rise = radius * (1.0 - math.cos(min(abs(sweep), math.pi) / 2))
    assert high_x - low_x <= 2 * (radius + rise) + 1e-9
    assert high_c - low_c <= 2 * (radius + rise) + 1e-9


def test_a_flat_arc_has_a_flat_box():
    # 100 mm radius, a chord of 20 mm along X: it rises by half a millimetre
    half = math.asin(0.1)
    start = 100 * cmath.rect(1.0, math.pi / 2 - half)
    rise = 100 * (1 - math.cos(half))
    low_x, low_c, high_x, high_c = box_of(arc(0j, start, 2 * half))
    assert (low_x, high_x) == pytest.approx((-10 - rise, 10 + rise))
    assert (low_c, high_c) == pytest.approx((start.imag - rise, 100.0))


@pytest.mark.parametrize("ends", [(1.0, 2.0, 5.0, -3.0), (5.0, -3.0, 1.0, 2.0)])
def test_the_box_of_a_line_is_that_of_its_ends(ends):
    x0, c0, x1, c1 = ends
    assert box_of(Line(*BARE, x0, c0, 0.0, x1, c1, 0.0)) == (1.0, -3.0, 5.0, 2.0)


@pytest.mark.parametrize(
    "beside", [(12, 0, 20, 10), (-10, 0, -2, 10), (0, 12, 10, 20), (0, -9, 10, -2)]
)
def test_boxes_are_apart_by_more_than_a_reach(beside):
    for one, other in (((0, 0, 10, 10), beside), (beside, (0, 0, 10, 10))):
        assert apart(one, other, 1.9) and not apart(one, other, 2.0)
