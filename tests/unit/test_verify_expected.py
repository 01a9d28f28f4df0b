# SPDX-License-Identifier: GPL-2.0-or-later
"""Properties of the toolpaths that words ask for; programs prove the rest."""

import cmath
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from g12.tools.verify.expected import haas
from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import Element
from g12.tools.verify.expected.haas import HaasWords

RADIUS, TOLERANCE = 3.0, 0.005  # of the tool; mm


def gaps_of(path):
    """Return the distances from the end of each move to the start of the next."""
    return [abs(one.curve.end - other.curve.start) for one, other in zip(path, path[1:])]


def corners(path):
    """Return the changes of direction in the plane, degrees, between moves that stay at a level."""
    flat = [move for move in path if move.start_level == move.end_level]
    return [
        math.degrees(abs(cmath.phase(other.curve.direction(0.0) / one.curve.direction(1.0))))
        for one, other in zip(flat, flat[1:])
        if abs(one.curve.end - other.curve.start) < 1e-9 and one.end_level == other.end_level
    ]


@given(
    gaps=st.lists(st.floats(0.1, 9.0), min_size=1, max_size=5),
    pitch=st.sampled_from([0.0, 1.0, 4.0]),
    helix=st.sampled_from([0.0, 2.5]),
    turn=st.sampled_from([1, -1]),
)
def test_haas_turns_no_corner_at_a_level(gaps, pitch, helix, turn):
    rings = [3.0 + sum(gaps[:at]) for at in range(len(gaps))]
    rings = [rings[0], rings[-1]] if pitch and len(rings) > 1 else rings
    words = HaasWords(
        0j, rings, (-2.0, -4.0), turn, 600.0, 60.0, pitch=pitch, helix=helix, angle=math.radians(3)
    )
    path = words.toolpath()
    assert max(gaps_of(path)) < 1e-9 and max(corners(path)) < 1e-6
    assert path[-1].curve.end == pytest.approx(0, abs=1e-9)
    assert all(move.curve.sweep * turn > 0 for move in path if hasattr(move.curve, "sweep"))


@given(
    height=st.floats(0.05, 40),
    radius=st.floats(0.3, 20),
    angle=st.floats(0.5, 15).map(math.radians),
)
def test_the_helix_falls_no_steeper_than_its_angle_and_flattens_out(height, radius, angle):
    falls = haas.falls_of(height, radius, angle)
    slopes = [math.atan2(fall, math.pi * radius) for fall in falls]
    assert sum(falls) == pytest.approx(height)
    assert len(falls) % 2 == 0 and max(slopes) <= angle * (1 + 1e-9)
    changes = [one - other for one, other in zip(slopes, [*slopes[1:], 0.0])]
    assert max(changes) < math.radians(1.0)
    shorter = len(falls) - 2
    eased = sum(fall / falls[0] for fall in falls if fall < falls[0] * (1 - 1e-12))
    steep = shorter - sum(fall < falls[0] * (1 - 1e-12) for fall in falls)
    if steep > 0:  # two half turns less would be too steep
        assert height / (steep + eased) > math.pi * radius * math.tan(angle) * (1 - 1e-9)


# ---------------------------------------------------------------- compensated contours


def element(line, start, end, **more):
    return Element(line, start, end, 1, False, -1.0, feed=100.0, **more)


def compensated(*elements):
    return [step.move for step in contour_path(elements, -1.0, RADIUS, TOLERANCE)]


@given(
    angles=st.lists(st.floats(0.3, 2.0), min_size=3, max_size=9),
    size=st.floats(5, 30),
)
def test_round_a_convex_polygon_it_is_the_parallel_of_the_area(angles, size):
    turns = [2 * math.pi * sum(angles[:k]) / sum(angles) for k in range(len(angles))]
    corners = [cmath.rect(size, -turn) for turn in turns]  # clockwise: G41 is outside
    start = (corners[-1] + corners[0]) / 2
    ends = [start, *corners, start]
    moves = compensated(*(element(10 + k, *pair) for k, pair in enumerate(zip(ends, ends[1:]))))
    outline = Polygon([(p.real, p.imag) for p in corners]).buffer(RADIUS, 512).exterior
    path = [move.curve.point(share / 40) for move in moves for share in range(41)]
    assert max(gaps_of(moves)) < TOLERANCE
    assert max(outline.distance(Point(place.real, place.imag)) for place in path) < 0.02
    assert sum(move.length for move in moves) == pytest.approx(outline.length, rel=1e-3)


def test_an_inside_arc_of_the_tool_radius_is_a_point_of_the_toolpath():
    arc = element(11, 3 + 0j, 3j, centre=0j, sweep=math.pi / 2)
    moves = compensated(element(10, 3 - 9j, 3 + 0j), arc, element(12, 3j, -9 + 3j))
    assert moves[0].curve.end == moves[-1].curve.start == pytest.approx(0j)
