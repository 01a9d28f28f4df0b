# SPDX-License-Identifier: GPL-2.0-or-later
"""What was made, laid along an expected toolpath."""

import cmath
import math
from dataclasses import replace
from itertools import pairwise

import pytest

from g12.geometry.curve import Arc, Line
from g12.tools.verify.compare.path import EXTRA, FEED, MISSING, OFF, RAPID, Made, lay
from g12.tools.verify.expected.toolpath import Expected

TOLERANCE = 0.005
SQUARE = [0j, 10 + 0j, 10 + 10j, 10j, 0j]


def expected(*curves, feed=100.0):
    return [Expected("move", curve, -1.0, -1.0, feed) for curve in curves]


def lines(points):
    return [Line(*ends) for ends in zip(points, points[1:])]


def along(curve, index=0, count=8, feed=100.0, level=-1.0):
    points = [(curve.point(i / count), level) for i in range(count + 1)]
    return Made(index, points, curve, feed)


def made(curves, **how):
    return [along(curve, index, **how) for index, curve in enumerate(curves)]


def test_what_is_made_as_expected_has_no_difference():
    laid = lay(expected(*lines(SQUARE)), made(lines(SQUARE)), TOLERANCE)
    assert laid.difference is None
    assert laid.deviation < 1e-9
    assert laid.moves == [[0], [1], [2], [3]]


def test_segments_of_an_arc_are_laid_on_it():
    circle = Arc(10 + 0j, 0j, 2 * math.pi)
    chords = lines([cmath.rect(10.0, i * math.pi / 90) for i in range(181)])
    laid = lay(expected(circle), [Made(0, [(c.start, -1.0), (c.end, -1.0)]) for c in chords], 0.01)
    assert laid.difference is None
    assert laid.deviation == pytest.approx(10 * (1 - math.cos(math.pi / 180)), rel=1e-3)


def test_a_small_circle_that_is_skipped_is_off():
    small = Arc(10 + 0j, 10.02 + 0j, 2 * math.pi)
    way = [Line(0j, 10 + 0j), Line(10 + 0j, 20 + 0j)]
    laid = lay(expected(way[0], small, way[1]), made(way), TOLERANCE)
    assert laid.difference.kind == OFF
    assert laid.difference.size == pytest.approx(0.02, abs=1e-3)


def segments(points, level=-1.0):
    """Return straight moves of which only the points are known."""
    return [
        Made(i, [(a, level), (b, level)], feed=100.0) for i, (a, b) in enumerate(pairwise(points))
    ]


def test_segments_that_pass_a_move_by_leave_it_out():
    small = Arc(10 + 0j, 10.02 + 0j, 2 * math.pi)
    path = expected(Line(0j, 10 + 0j), small, Line(10 + 0j, 20 + 0j))
    laid = lay(path, segments([0j, 10 + 0j, 20 + 0j]), TOLERANCE)
    assert (laid.difference.kind, laid.difference.expected) == (MISSING, path[1])


def test_of_a_dip_in_segments_the_deepest_point_is_told():
    dip = [0j, 4 + 0.01j, 5 + 0.3j, 6 + 0.1j, 10 + 0j]
    laid = lay(expected(Line(0j, 10 + 0j)), segments(dip), TOLERANCE)
    assert laid.difference.size == pytest.approx(0.3)
    assert laid.difference.at[0] == pytest.approx(5 + 0.3j)


CIRCLE = Arc(10 + 0j, 0j, 2 * math.pi)


@pytest.mark.parametrize(
    ("programmed", "curves", "kind"),
    [
        ([CIRCLE, CIRCLE], [CIRCLE], MISSING),
        ([CIRCLE], [CIRCLE, CIRCLE], EXTRA),
        ([CIRCLE], [CIRCLE.reversed()], OFF),
    ],
)
def test_passes_too_few_or_too_many_or_the_other_way_round(programmed, curves, kind):
    assert lay(expected(*programmed), made(curves), TOLERANCE).difference.kind == kind


def test_feeds_and_rapids_are_compared():
    path, curves = expected(*lines(SQUARE)), lines(SQUARE)
    assert lay(path, made(curves, feed=101.0), TOLERANCE).difference.kind == FEED
    rapid = [replace(move, rapid=True) for move in made(curves)]
    assert lay(path, rapid, TOLERANCE).difference.kind == RAPID
    unknown = [replace(move, feed=None) for move in made(curves)]
    assert lay(path, unknown, TOLERANCE).difference is None


def test_a_rounded_corner_is_off_by_what_it_misses():
    path = [0j, 9.9 + 0j, 10 + 0.1j, 10 + 10j]
    laid = lay(expected(*lines(SQUARE[:3])), made(lines(path)), 0.2)
    assert laid.difference is None
    assert laid.deviation == pytest.approx(0.1 / math.sqrt(2), abs=1e-3)


@pytest.mark.parametrize(("missed", "kind"), [(0.008, None), (0.02, OFF)])
def test_a_blended_corner_of_a_sharp_reversal_is_followed(missed, kind):
    tip, ahead = 1 + 0j, cmath.rect(1.0, math.radians(150))
    begin, end = tip - missed, tip + missed * ahead
    points = [begin * step / 1000 for step in range(1001)]
    points += [end + (tip + ahead - end) * step / 1000 for step in range(1001)]
    run = Made(0, [(point, -1.0) for point in points], sampled=True)
    laid = lay(expected(*lines([0j, tip, tip + ahead])), [run], 0.01)
    assert (laid.difference and laid.difference.kind) == kind


def test_a_helix_is_followed_round_and_down():
    helix = Expected("helix", Arc(5 + 0j, 0j, 4 * math.pi), 0.0, -2.0, 100.0)
    points = [(cmath.rect(5.0, i * math.pi / 20), -2.0 * i / 80) for i in range(81)]
    laid = lay([helix], [Made(0, points)], 0.02)
    assert laid.difference is None
    flat = [(point, 0.0) for point, _ in points]
    assert lay([helix], [Made(0, flat)], 0.02).difference.kind == OFF
