# SPDX-License-Identifier: GPL-2.0-or-later
"""What was made, laid along an expected toolpath."""

import cmath
import math
from itertools import pairwise

import pytest

from g12.geometry.curve import Arc, Line
from g12.tools.verify.compare.path import MISSING, OFF, Made, lay
from g12.tools.verify.expected.toolpath import Expected

TOLERANCE = 0.005
LEVEL, FEED = -1.0, 100.0


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


def test_a_small_circle_that_is_skipped_is_off_or_missing():
    small = Arc(10 + 0j, 10.02 + 0j, 2 * math.pi)
    before, after = lines(0, 10, 20)
    path = expected(before, small, after)
    off = lay(path, made(before, after), TOLERANCE).difference
    assert (off.kind, off.size) == (OFF, pytest.approx(0.02, abs=1e-3))
    missing = lay(path, segments(0, 10, 20), TOLERANCE).difference
    assert (missing.kind, missing.expected) == (MISSING, path[1])


def test_of_a_dip_in_segments_the_deepest_point_is_reported():
    path, dip = expected(*lines(0, 10)), segments(0, 4 + 0.01j, 5 + 0.3j, 6 + 0.1j, 10)
    off = lay(path, dip, TOLERANCE).difference
    assert (off.size, off.at[0]) == (pytest.approx(0.3), pytest.approx(5 + 0.3j))


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


TIP, AHEAD = 1 + 0j, cmath.rect(1.0, math.radians(150))
STRAIGHT = lines(0, TIP, TIP + AHEAD)
ROUND = [Arc(TIP, TIP + 20j, -0.05).reversed(), Arc(TIP, TIP + 20j * AHEAD, 0.05)]


@pytest.mark.parametrize("curves", [STRAIGHT, ROUND])
@pytest.mark.parametrize(("missed", "kind"), [(0.008, None), (0.02, OFF)])
def test_a_blended_corner_of_a_sharp_reversal_is_followed(curves, missed, kind):
    begins, ends = curves[0].portion(0.0, 1.0 - missed), curves[1].portion(missed, 1.0)
    points = [curve.point(step / 1000) for curve in (begins, ends) for step in range(1001)]
    run = Made(0, [(point, LEVEL) for point in points], sampled=True)
    laid = lay(expected(*curves), [run], 0.01)
    assert (laid.difference and laid.difference.kind) == kind
