# SPDX-License-Identifier: GPL-2.0-or-later
"""The part's view of a path: points, polylines, swept areas, tool tables."""

import cmath
import math
import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.tools.path import part
from g12.tools.path.part import Part
from support.growth import growth
from support.made_moves import Hand

MILL, FACE = Part(turning=False), Part(turning=True)


@given(radius=st.floats(0.01, 500), sweep=st.floats(0.01, 2 * math.pi), error=st.floats(1e-5, 0.1))
def test_chords_of_an_arc_stay_within_the_error(radius, sweep, error):
    segments = part.arc_segments(radius, sweep, error)
    sagitta = radius * (1 - math.cos(sweep / segments / 2))
    assert sagitta <= error * (1 + 1e-6)


def turned(place, degrees):
    """Return a position turned about Z."""
    x, y, *others = place
    at = complex(x, y) * cmath.rect(1.0, math.radians(degrees))
    return (at.real, at.imag, *others)


@pytest.mark.parametrize("plane", [17, 18, 19])
def test_the_points_of_an_arc_turn_with_the_work_coordinate_system(plane):
    hand = Hand().rapid(x=9, y=8, z=7)
    hand.arc(-2, 3, 4, plane=plane, x=2, y=1, z=5, c=30)
    move, fractions = hand.moves[-1], np.linspace(0, 1, 9)
    start, end, centre = (turned(place, 25.0) for place in (move.start, move.end, move.centre))
    rotated = move._replace(start=start, end=end, centre=centre, rotation=25.0)
    points = part.arc_points(move, fractions)
    assert np.allclose(points[:, 5], 30.0 * fractions)
    expected = [turned(point, 25.0) for point in points]
    assert np.allclose(part.arc_points(rotated, fractions), expected, atol=1e-12)


@given(x=st.floats(-60, 60), turn=st.floats(-170, 170), start=st.floats(0, 60))
def test_chords_of_a_spiral_stay_within_the_error(x, turn, start):
    move = Hand().rapid(x=start).line(x=x, c=turn).moves[1]
    line = FACE.polyline(move)[:, :2] @ [1, 1j]
    share = (np.arange(len(line) - 1) + 0.5) / (len(line) - 1)
    middle = (start + (x - start) * share) * np.exp(1j * np.radians(turn) * share)
    assert np.abs(middle - (line[1:] + line[:-1]) / 2).max() < 1.5 * part.CHORD_ERROR


def test_paths_join_moves_and_break_at_gaps():
    hand = Hand().line(x=10).line(x=10, y=10).rapid(x=50).line(x=60)
    cutting = [move for move in hand.moves if move.kind != "rapid"]
    assert [len(line) for line in part.paths(MILL, cutting)] == [3, 2]


def ring(radius):
    return MILL.polyline(Hand().rapid(x=radius).arc(1, 0, 0).moves[1])


@pytest.mark.parametrize(
    ("line", "radius", "area"),
    [
        ([[0, 0, 0], [100, 0, 0]], 5, 100 * 10 + math.pi * 25),
        ([[7, 7, 0], [7, 7, -5.0]], 2, math.pi * 4),  # a plunge
        (ring(20), 3, math.pi * (23**2 - 17**2)),
        *((ring(radius), 5, math.pi * (radius + 5) ** 2) for radius in (0.1, 2.4, 4.9)),  # no core
    ],
)
def test_what_a_cutter_sweeps(line, radius, area):
    assert part.swept([np.array(line, float)], radius).area == pytest.approx(area, rel=1e-3)


def test_the_area_of_lines_that_cross_takes_as_long_as_there_are_lines():
    def crossing(count):
        chance = random.Random(3)
        line = np.array([[chance.uniform(0, 300), chance.uniform(0, 300), 0] for _ in range(count)])
        return lambda: part.swept([line], 3.0)

    assert growth(crossing, 100) < 10


def test_c_stands_where_the_face_is_left_beside_the_centre_for_it():
    """From a point on the face to X0 of the slide: what C of the axes is there is no turn of it."""
    c = np.array([0.0, 270.7, 270.7, 280.7])
    angles = part.spindle_angles(np.array([0.002 - 0.173j, 0.0, 0.0, 0.0]), c)
    assert np.allclose(np.diff(angles), [0.0, 0.0, 10.0])
    angles = part.spindle_angles(np.array([3.0, 3.0j, -3.0, -4.0]), np.zeros(4))
    assert np.allclose(np.diff(angles), [90.0, 90.0, 0.0])
    points, c = np.array([1.0, 1.0j, -1.0, 1.0, 1.0]), np.array([0, 0, 0, 900, 905])
    beyond = part.spindle_angles(points, c)
    assert np.allclose(np.diff(beyond), [90.0, 90.0, 0.0, 5.0])
