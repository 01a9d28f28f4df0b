# SPDX-License-Identifier: GPL-2.0-or-later
"""How near to a corner the tool's way is looked at for gouges. Every way is drawn by hand."""

import math

import pytest

from g12.errors import Refusal
from g12.flat.contour import Arc, Contour, Line
from g12.flat.gouge import Cut, refuse_gouges

TOLERANCE = 0.005
RADIUS = 2.0
FAR = 1000.0


def line(x0, c0, x1, c1, number=1):
    return Line(number, 100.0, RADIUS, x0, c0, 0.0, x1, c1, 0.0)


def arc(cx, cc, radius, number=1):
    """Return the upper half of a circle, counterclockwise."""
    ends = (cx + radius, cc, 0.0, cx - radius, cc, 0.0)
    return Arc(number, 100.0, RADIUS, *ends, cx, cc, math.pi)


def is_refused(*cuts, tolerance=TOLERANCE):
    try:
        refuse_gouges(Contour(10.0, 0.0), cuts, tolerance)
    except Refusal as refusal:
        assert "cannot follow both lines" in str(refusal)
        return True
    return False


@pytest.mark.parametrize(("beyond", "refused"), [(1.9, False), (2.1, True)])
def test_ways_that_cross_within_two_tolerances_of_their_corner_are_one_corner(beyond, refused):
    beyond *= TOLERANCE
    first = Cut(arc(FAR, 0, 5), None, line(-10, 0, beyond, 0))
    second = Cut(arc(-FAR, 0, 5), None, line(0, -beyond, 0, 10))
    assert is_refused(first, second) is refused


@pytest.mark.parametrize(("x", "refused"), [(-5.9, False), (-60.0, False), (-4.1, True)])
def test_a_way_is_looked_at_for_two_radii_in_front_of_its_corner(x, refused):
    """The arc behind the corner stands ``x`` along the way, no more than the radius beside it."""
    first = Cut(line(-100, -RADIUS, 0, -RADIUS), None, line(-100, 0, 0, 0))
    second = Cut(arc(x, -1.95, 0.05, 2), None, None)
    assert is_refused(first, second) is refused


@pytest.mark.parametrize(("x", "refused"), [(5.9, False), (60.0, False), (4.1, True)])
def test_and_for_two_radii_behind_it(x, refused):
    first = Cut(arc(x, -1.95, 0.05), None, None)
    second = Cut(line(0, -RADIUS, 100, -RADIUS, 2), None, line(0, 0, 100, 0))
    assert is_refused(first, second) is refused
