# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the tool of one contour cuts into another: verify reports it, what is meant it does not."""

import math

import pytest

from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import Element
from g12.tools.verify.sections.outline import neighbour_cuts

TOOL, TOLERANCE, UP = 3.0, 0.005, 5.0
SQUARE = [10 + 0j, 10 - 10j, -10 - 10j, -10 + 10j, 10 + 10j, 10 + 0j]


def contour(corners, depth=-5.0, side=1, line=1):
    """Return the elements of lines from corner to corner, with ramps square to its ends."""
    first, last = corners[1] - corners[0], corners[-1] - corners[-2]
    start = corners[0] + 6j * side * first / abs(first)
    end = corners[-1] + 6j * side * last / abs(last)
    points = [start, *corners, end]
    return [
        Element(line + k, *pair, side, k in (0, len(points) - 2), depth)
        for k, pair in enumerate(zip(points, points[1:]))
    ]


def circle(centre, radius, depth=-5.0, side=1, line=20):
    """Return the elements of a clockwise circle, with ramps."""
    start = centre + radius
    away = start + 6 * side
    ramps = [
        Element(line, away, start, side, True, depth),
        Element(line + 2, start, away, side, True, depth),
    ]
    around = Element(line + 1, start, start, side, False, depth, complex(centre), -2 * math.pi)
    return [ramps[0], around, ramps[1]]


def found(*contours):
    """Return line, other line and depth of what is cut, the deepest first."""
    elements = [element for each in contours for element in each]
    cuts = neighbour_cuts(contour_path(elements, UP, TOOL, TOLERANCE), TOOL, TOLERANCE, 0.0)
    return sorted(
        ((each.line, each.values["line"], each.values["size"]) for each in cuts),
        key=lambda cut: -cut[2],
    )


@pytest.mark.parametrize(("gap", "depth"), [(6.0, 0), (5.99, 0.01), (3.2, 2.8)])
def test_a_passage_narrower_than_the_tool_is_cut_wider(gap, depth):
    """Both contours are cut, each on the way along the other one."""
    cuts = found(contour(SQUARE), circle(15 + gap, 5.0))
    sides = {(21, 2), (2, 21), (21, 6), (6, 21)}  # the square begins where it is nearest
    assert {cut[:2] for cut in cuts} <= sides
    assert [cut[2] for cut in cuts] == pytest.approx([depth, depth] if depth else [], abs=TOLERANCE)


def test_what_is_meant_is_not_reported():
    """A finishing pass, a slot across, a pocket in a boss, an equal contour deeper down."""
    rough = contour([1.2 * corner for corner in SQUARE])
    assert found(rough, contour(SQUARE, line=20)) == []
    across = [-40 - 2j, 40 - 2j, 40 + 4j, -40 + 4j]
    assert found(contour(SQUARE), contour(across, line=20)) == []
    assert found(contour(SQUARE), circle(0j, 6.0, side=-1)) == []
    assert found(contour(SQUARE), contour(SQUARE, -6.0, line=20)) == []


def test_a_wall_in_a_pocket_and_an_open_contour_are_cut_alike():
    pocket = contour([2 * corner for corner in SQUARE], side=-1)  # the tool is inside of it
    pin = circle(10.5 + 0j, 5.0)
    assert [cut[2] for cut in found(pocket, pin)] == pytest.approx([1.5, 1.5], abs=TOLERANCE)
    beyond = contour([14 + 20j, 14 - 20j], line=20)
    assert found(contour(SQUARE), beyond) == []
    facing = contour([14 - 20j, 14 + 20j], line=20)
    cuts = [cut[2] for cut in found(contour(SQUARE), facing)]
    assert cuts == pytest.approx([2.0, 2.0], abs=TOLERANCE)
