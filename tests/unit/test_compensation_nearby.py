# SPDX-License-Identifier: GPL-2.0-or-later
"""Boxes round moves: what is outside of one is nowhere near the move."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.compensation.contour import Arc, Line
from g12.compensation.nearby import Boxes, apart, box_of, straight_runs
from support.contour_geometry import Round, Straight

BARE = (1, 100.0, 2.0)
coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)


def arc(centre, start, sweep):
    end = centre + (start - centre) * cmath.rect(1.0, sweep)
    ends = (start.real, start.imag, 0.0, end.real, end.imag, 0.0)
    return Arc(*BARE, *ends, centre.real, centre.imag, sweep)


def line(start, end):
    return Line(*BARE, start.real, start.imag, 0.0, end.real, end.imag, 0.0)


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


@pytest.mark.parametrize("count", [1, 4, 5, 60])
@pytest.mark.parametrize("reach", [math.inf, 12.0])
def test_the_nearest_move_that_counts_is_found_among_many(count, reach):
    rng = np.random.default_rng(count)
    drawn = []
    for k in range(count):
        start, to = (complex(*rng.uniform(-20, 20, 2)) for _ in range(2))
        drawn.append(Round(start, start + 0.2 * to, 2.0) if k % 3 else Straight(start, to))
    moves = [
        arc(one.centre, one.start, one.sweep) if isinstance(one, Round) else line(*one)
        for one in drawn
    ]
    tree = Boxes([(-1 - k, move) for k, move in enumerate(moves)])
    found = 0
    for place in rng.uniform(-40, 40, (100, 2)):
        away = [one.distance(np.array([complex(*place)]))[0] for one in drawn[::2]]
        nearest = min(*away, reach)
        far, index = tree.nearest(tuple(place), reach, lambda k, move: counts(k, move, moves))
        assert far == pytest.approx(nearest)
        assert index == (-1 - 2 * away.index(nearest) if nearest < reach else None)
        found += index is not None
    assert found > 10


def counts(k, move, moves):
    """Return whether a move is every other one of some; it comes with its own number."""
    assert moves[-1 - k] is move
    return k % 2


@pytest.mark.parametrize(
    "beside", [(12, 0, 20, 10), (-10, 0, -2, 10), (0, 12, 10, 20), (0, -9, 10, -2)]
)
def test_boxes_are_apart_by_more_than_a_reach(beside):
    for one, other in (((0, 0, 10, 10), beside), (beside, (0, 0, 10, 10))):
        assert apart(one, other, 1.9) and not apart(one, other, 2.0)


# Runs of moves that cannot cut each other.


@st.composite
def contours(draw):
    """Draw moves one behind the other."""
    at, moves = 0j, []
    for to in draw(st.lists(point, min_size=1, max_size=9)):
        by, end = draw(st.sampled_from([0.0, 0.0, 1.0, -2.0, 4.0, -6.0])), at + to
        if abs(to) < 0.01:
            continue
        moves.append(Line(*BARE, at.real, at.imag, 0.0, end.real, end.imag, 0.0))
        if by:
            moves[-1] = arc(at + to, at, by)
            end = complex(moves[-1].x1, moves[-1].c1)
        at = end
    return moves


def headings(moves):
    """Return each move's own directions and those of the corner in front of it, without a jump."""
    found, last = [], None
    for move in moves:
        span, bend = complex(move.x1 - move.x0, move.c1 - move.c0), 0.0
        if isinstance(move, Arc):
            bend = move.sweep
            arm = complex(move.x0 - move.cx, move.c0 - move.cc)
            span = arm * 1j * math.copysign(1.0, bend)
        first = math.atan2(span.imag, span.real)
        last = first if last is None else last
        turn = (first - last + math.pi) % (2 * math.pi) - math.pi
        found.append([last, last + turn, last + turn + bend])
        last = found[-1][-1]
    return found


@given(contours())
def test_a_straight_run_goes_on_until_directions_are_half_a_turn_apart(moves):
    runs, angles = straight_runs(moves), headings(moves)
    assert len(runs) == len(moves)
    for first, last in enumerate(runs):
        spread = [np.ptp(np.concatenate(angles[first : k + 1])) for k in range(first, len(moves))]
        if all(abs(width - math.pi) > 0.002 for width in spread):
            assert last == first - 1 + sum(width < math.pi for width in spread)


@pytest.mark.parametrize("beside", [0.0, 0.0004, -0.0004])
def test_no_run_goes_beyond_a_turn_back(beside):
    """A corner of half a turn, or by a twentieth of a degree less, is no part of any run."""
    back = 10 - 5 * cmath.exp(1j * beside)
    ends = [(0, 0, 10, 0), (10, 0, back.real, back.imag), (back.real, back.imag, -5, back.imag)]
    moves = [Line(*BARE, x0, c0, 0.0, x1, c1, 0.0) for x0, c0, x1, c1 in ends]
    assert straight_runs(moves) == [0, 0, 2]
