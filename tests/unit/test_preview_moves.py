# SPDX-License-Identifier: GPL-2.0-or-later
"""Geometry of a traced move, against complex numbers and finite differences."""

import cmath
import math

import numpy as np
import pytest

from g12.tools.path.part import arc_points
from g12.tools.preview.moves import Move

REST = (0.0,) * 6
PLANES = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}  # first, second, third axis


def arc(start, end, centre, turns, plane=17, rotation=0.0):
    return Move(
        *("arc", 1, 1, (*start, *REST), (*end, *REST), 100.0, "G94", plane, 1, (0.0,) * 9),
        centre=centre,
        turns=turns,
        rotation=rotation,
    )


def near(values):
    return pytest.approx(values, abs=1e-9)


@pytest.mark.parametrize(
    ("end", "turns", "degrees"),
    [
        ((0.0, 1.0, 0.0), -1, -270),
        ((1.0, 1e-9, 0.0), 1, 360),
        ((1.0, 1e-9, 0.0), -1, -360),
        ((0.0, 1.0, 3.0), 3, 810),
    ],
)
def test_sweep_of_an_arc_about_the_origin(end, turns, degrees):
    move = arc((1.0, 0.0, 0.0), end, (0.0, 0.0, 0.0), turns)
    assert math.degrees(move.sweep) == pytest.approx(degrees, abs=1e-6)


@pytest.mark.parametrize("plane", PLANES)
@pytest.mark.parametrize("turns", [1, -1])
def test_points_of_a_helix_lie_on_the_circle_of_its_plane(plane, turns):
    one, two, three = PLANES[plane]
    start, end, centre = [0.0] * 3, [0.0] * 3, [0.0] * 3
    centre[one], centre[two], centre[three] = 5.0, -3.0, 1.0
    start[one], start[two], start[three] = 7.0, -3.0, 1.0
    end[one], end[two], end[three] = 5.0, -1.0, 2.0
    move = arc(start, end, tuple(centre), turns, plane)
    angle = math.pi / 2 if turns > 0 else -1.5 * math.pi
    fractions = np.array([0.0, 0.25, 0.5, 0.9, 1.0])
    for fraction, point in zip(fractions, arc_points(move, fractions)):
        expected = complex(5.0, -3.0) + 2.0 * cmath.exp(1j * angle * fraction)
        assert complex(point[one], point[two]) == near(expected)
        assert point[three] == near(1.0 + fraction)
    assert move.length == near(math.hypot(2.0 * angle, 1.0))


def test_an_arc_whose_radius_grows_ends_where_it_should():
    move = arc((1.0, 0.0, 0.0), (0.0, 1.001, 0.0), (0.0, 0.0, 0.0), 1)
    assert move.radius == near(1.0)
    assert arc_points(move, np.ones(1))[0, :3] == near((0.0, 1.001, 0.0))
