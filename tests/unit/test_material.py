# SPDX-License-Identifier: GPL-2.0-or-later
"""The material knows where a cutter went before: along the same line, and beside it."""

import numpy as np
import pytest
from shapely.geometry import box

from g12.tools.material.material import Material, Ring

PERIOD = 40.0
AGAIN = {"plane": 0.0, "other turns": PERIOD}  # by how much cuts are shifted, a rapid back


def line(level, shift=0.0):
    return np.array([[5.0 + shift, 0.0, level], [25.0 + shift, 0.0, level]])


@pytest.mark.parametrize("surface", AGAIN)
@pytest.mark.parametrize(
    ("radius", "level", "move", "is_free"),
    [
        (3.0, -2.0, 6, True),
        (3.0, -1.0, 6, True),
        (2.0, -2.0, 6, True),
        (3.2, -2.0, 6, False),
        (3.0, -2.1, 6, False),
        (3.0, -2.0, 5, False),
        (4.0, -2.0, 8, True),
        (3.0, -4.0, 9, True),
        (4.0, -4.0, 9, False),
    ],
)
def test_a_rapid_along_the_line_of_a_cut(radius, level, move, is_free, surface):
    cuts = [(5, -2.0, 3.0), (6, -2.0, 2.0), (7, -2.0, 4.0), (8, -4.0, 3.0)]
    solid = box(-100.0, -100.0, 100.0, 100.0)
    material = Material(solid, 0.0, period=PERIOD if AGAIN[surface] else 0.0)
    for index, depth, cutter in cuts:
        material.cut(index, line(depth, AGAIN[surface]), cutter)
    rapid = line(level, -AGAIN[surface])
    for way in (rapid, rapid[::-1]):  # the second is no line of a cut
        assert (material.touched(way, radius, move) is None) == is_free
    beside = material.touched(np.add(rapid, [0.0, 10.0, 0.0]), radius, 9)
    assert beside.area == pytest.approx(20.0 * 2 * radius + np.pi * radius**2, rel=0.1)


def test_a_falling_rapid_touches_on_its_line():
    material = Material(box(0.0, -50.0, 100.0, 50.0), 0.0)
    rapid = np.array([[-10.0, 0.0, 1.0], [30.0, 0.0, -9.0]])
    x, _, z = material.touched(rapid, 3.0, 0).points.T
    assert z == pytest.approx(-1.5 - x / 4)


def test_what_a_repeated_cut_removes():
    material = Material(box(-100.0, -100.0, 100.0, 100.0), 0.0)
    for move, level in enumerate((-2.0, -1.0, -2.0, -3.0, -3.0)):
        material.cut(move, line(level), 3.0)
    removing = [material.removes(range(move, move + 1)) for move in range(5)]
    assert removing == [True, False, False, True, False]
    assert [len(material.sweeps_of(range(move, 5))) for move in range(6)] == [5, 4, 3, 2, 1, 0]


def test_full_circles_clear_what_they_overlap():
    material = Material(box(-100.0, -100.0, 100.0, 100.0), 0.0)
    for move, around in enumerate((2.0, 6.0, 10.0, 16.0)):  # a ring stands from 12.5 to 13.5
        material.cut_ring(Ring((1.0, 2.0), around, 2.5, -2.0, move))
    for edges, level, is_cleared in (
        ((0.0, 12.5), -2.0, True),
        ((0.0, 18.5), -2.0, False),
        ((13.5, 18.5), -2.0, True),
        ((0.0, 12.5), -2.1, False),
    ):
        assert material.has_cleared((1.0, 2.0), edges, level) == is_cleared
    assert material.removes(range(3, 4)) and material.sweeps_of(range(3, 4))[0].shape.area == (
        pytest.approx(np.pi * (18.5**2 - 13.5**2), rel=1e-3)
    )
