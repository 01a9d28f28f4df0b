# SPDX-License-Identifier: GPL-2.0-or-later
"""The oracle of the planners itself: properties of its toolpaths, moves laid on them."""

import cmath
import math
from itertools import pairwise
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from g12.cut_report import CutReport, PocketCut, ProgramFrame, UsedCutter
from g12.geometry.curve import Arc, Line
from support.oracle.circles import BlockInMm, falls_of, haas_path
from support.oracle.contour import Element, contour_path
from support.oracle.follow import OFF, Made, lay
from support.oracle.toolpath import Expected

RADIUS, TOLERANCE = 3.0, 0.005  # of the tool; mm
LEVEL, FEED = -1.0, 100.0


def gaps_of(path):
    """Return the distances from the end of each move to the start of the next."""
    return [abs(one.curve.end - other.curve.start) for one, other in pairwise(path)]


def corners_of(path):
    """Return the changes of direction in the plane, degrees, between moves that stay at a level."""
    flat = [move for move in path if move.start_level == move.end_level]
    return [
        math.degrees(abs(cmath.phase(other.curve.direction(0.0) / one.curve.direction(1.0))))
        for one, other in pairwise(flat)
        if abs(one.curve.end - other.curve.start) < 1e-9 and one.end_level == other.end_level
    ]


@given(
    first=st.floats(0.2, 9.0),
    more=st.floats(0.1, 20.0),
    step=st.floats(0.1, 9.0),
    clearing=st.sampled_from(["rings", "spiral"]),
    entry=st.sampled_from(["plunge", "helix"]),
    code=st.sampled_from(["G12", "G13"]),
)
def test_a_haas_path_turns_no_corner_at_a_level(first, more, step, clearing, entry, code):
    words = {"I": RADIUS + first, "K": RADIUS + first + more, "Q": step, "Z": -2.0, "L": 2.0}
    frame, cutter = ProgramFrame(1.0, (0.0, 0.0, 0.0, 0.0), 0.0, False), UsedCutter(RADIUS, "D", 1)
    cut = PocketCut("G17", (0.0, 0.0, -2.0), 0.0, 0.0, 0.0, 0.0, (), cutter)
    report = CutReport(code, 1, "", frame, (0.0, 0.0, 0.0, 0.0), 600.0, False, True, words, cut)
    settings = SimpleNamespace(clearing=clearing, entry=entry, entry_angle=3.0, plunge_feed=10)
    path = haas_path(BlockInMm(report, RADIUS, settings))
    assert max(gaps_of(path)) < 1e-9 and max(corners_of(path)) < 1e-6
    assert path[-1].point(1.0) == pytest.approx((0j, -4.0), abs=1e-9)
    turn = {"G12": -1, "G13": 1}[code]
    assert all(move.curve.sweep * turn > 0 for move in path if isinstance(move.curve, Arc))
    outermost = max(abs(move.curve.point(share)) for move in path for share in (0, 0.5, 1))
    assert outermost == pytest.approx(first + more)


@given(
    height=st.floats(0.05, 40),
    radius=st.floats(0.3, 20),
    angle=st.floats(0.5, 15).map(math.radians),
)
def test_the_helix_falls_no_steeper_than_its_angle_and_flattens_out(height, radius, angle):
    falls = falls_of(height, radius, angle)
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
    return [step.move for step in contour_path(elements, -1.0, RADIUS)]


@given(
    angles=st.lists(st.floats(0.3, 2.0), min_size=3, max_size=9),
    size=st.floats(5, 30),
)
def test_round_a_convex_polygon_it_is_the_parallel_of_the_area(angles, size):
    turns = [2 * math.pi * sum(angles[:k]) / sum(angles) for k in range(len(angles))]
    corners = [cmath.rect(size, -turn) for turn in turns]  # clockwise: G41 is outside
    start = (corners[-1] + corners[0]) / 2
    moves = compensated(
        *(element(10 + k, *pair) for k, pair in enumerate(pairwise([start, *corners, start])))
    )
    outline = Polygon([(p.real, p.imag) for p in corners]).buffer(RADIUS, 512).exterior
    path = [move.curve.point(share / 40) for move in moves for share in range(41)]
    assert max(gaps_of(moves)) < TOLERANCE
    assert max(outline.distance(Point(place.real, place.imag)) for place in path) < 0.02
    assert sum(move.length for move in moves) == pytest.approx(outline.length, rel=1e-3)


def test_an_inside_arc_of_the_tool_radius_is_a_point_of_the_toolpath():
    arc = element(11, 3 + 0j, 3j, centre=0j, sweep=math.pi / 2)
    moves = compensated(element(10, 3 - 9j, 3 + 0j), arc, element(12, 3j, -9 + 3j))
    assert moves[0].curve.end == moves[-1].curve.start == pytest.approx(0j)


# ---------------------------------------------------------------- moves along a toolpath


def expected(*curves):
    return [Expected("move", curve, LEVEL, LEVEL, FEED) for curve in curves]


def lines(*points):
    return [Line(*ends) for ends in pairwise(points)]


def made(*curves):
    """Return moves along curves."""
    return [
        Made(index, [(curve.point(i / 8), LEVEL) for i in range(9)], curve, FEED)
        for index, curve in enumerate(curves)
    ]


def segments(*points):
    """Return straight moves of which only the points are known."""
    return [
        Made(index, [(point, LEVEL) for point in ends], feed=FEED)
        for index, ends in enumerate(pairwise(points))
    ]


@pytest.mark.parametrize("skipping", [made(*lines(0, 10, 20)), segments(0, 10, 20)])
def test_a_small_circle_that_is_skipped_is_off(skipping):
    small = Arc(10 + 0j, 10.02 + 0j, 2 * math.pi)
    before, after = lines(0, 10, 20)
    off = lay(expected(before, small, after), skipping, TOLERANCE).difference
    assert (off.kind, off.size) == (OFF, pytest.approx(0.02, abs=1e-3))


def test_a_rounded_corner_is_off_by_what_it_misses():
    rounded = made(*lines(0, 9.9, 10 + 0.1j, 10 + 10j))
    laid = lay(expected(*lines(0, 10, 10 + 10j)), rounded, 0.2)
    assert laid.difference is None
    assert laid.deviation == pytest.approx(0.1 / math.sqrt(2), abs=1e-3)


def test_a_corner_that_is_cut_too_far_between_two_moves_is_off():
    corner = [
        Made(0, [(0j, LEVEL), (9.9 + 0j, LEVEL)]),
        Made(1, [(10 + 0.1j, LEVEL), (10 + 10j, LEVEL)]),
    ]
    off = lay(expected(*lines(0, 10, 10 + 10j)), corner, 0.05).difference
    assert (off.kind, off.size) == (OFF, pytest.approx(0.1, abs=1e-3))
