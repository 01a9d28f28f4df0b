# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a compensated contour begins and ends, and where it closes beside its leads."""

import cmath
import math

import pytest

from g12.compensation.compensated import (
    PathOfMove,
    closing_of,
    compensated_contours,
)
from g12.compensation.contour import Contour
from support.contour_geometry import Round, Straight, lines
from support.planned_moves import line
from support.random_contours import closed

NEAR = 0.02
SQUARE = [10 + 10j, 10 - 10j, -10 - 10j, -10 + 10j]


def closing(shapes, radius=3.0):
    """Return where shapes that are cut one after the other close."""
    return closing_of(shapes, radius, NEAR)


def ends_of(shapes, radius=3.0):
    """Return whether shapes close, and from which point to which they are a contour."""
    found = closing(shapes, radius)
    points = (
        shapes[at].point(along / shapes[at].length)
        for at, along in ((found.first, found.start), (found.last, found.end))
    )
    return found.closed, *(complex(round(at.real, 3), round(at.imag, 3)) for at in points)


def rolled(on, off, overlap):
    """Return the square with an arc to lead on and one to lead off, and lines beyond them."""
    start, end = 10 + 0j, 10 - 1j * overlap
    arc_on = Round(start + 5 + 5j, start + 5, 0.5 * math.pi)
    arc_off = Round(end, end + 5, 0.5 * math.pi)
    corners = [start, *SQUARE[1:], SQUARE[0], end]
    far, near = arc_on.start, arc_off.end
    front = [Straight(far + 4 * k + 4, far + 4 * k) for k in reversed(range(on - 1))]
    after = [Straight(near + 4 * k, near + 4 * k + 4) for k in range(off - 1)]
    return [*front, arc_on, *lines(*corners), arc_off, *after]


@pytest.mark.parametrize("overlap", [0.0, 2.0])
@pytest.mark.parametrize(
    ("on", "off", "closes"), [(1, 3, True), (3, 2, True), (1, 4, False), (4, 1, False)]
)
def test_leads_have_up_to_three_moves(on, off, closes, overlap):
    shapes = rolled(on, off, overlap)
    assert closing(shapes).closed is closes
    if closes and not overlap:
        assert ends_of(shapes) == (True, 10 + 0j, 10 + 0j)


@pytest.mark.parametrize("after", [False, True])
@pytest.mark.parametrize(
    ("lead", "radius", "closes"),
    [(39.0, 6.0, True), (41.0, 6.0, False), (41.0, 4.9, True), (41.0, 5.1, False)],
)
def test_a_contour_is_half_as_long_as_its_leads_or_four_tool_radii(lead, radius, closes, after):
    """The square is 20 round; anything shorter is the spur of an open contour."""
    corners = [5 + 0j, 0j, 5j, 5 + 5j]
    first, second, third, last = closed(corners)
    if after:
        last = Straight(last.start, last.end - 1j * lead)
    else:
        first = Straight(first.start + lead, first.end)
    assert closing([first, second, third, last], radius).closed is closes


def test_of_a_contour_that_does_not_close_all_is_contour():
    zigzag = lines((0, 0), (20, 0), (20, 20), (45, 20))
    found = closing(zigzag)
    assert found == (0, 0.0, 2, 25.0, False, False)
    assert [found.shares(k, zigzag[0]) for k in (-1, 3)] == [(0.0, 0.0)] * 2


def crossing(shapes):
    """Return whether a contour closes where it crosses itself."""
    return closing(shapes).closed and closing(shapes).crossing


@pytest.mark.parametrize(
    ("on", "off", "corners", "closes"),
    [
        *((0, 0, 3, True), (1, 1, 3, True), (1, 1, 4, True), (2, 2, 3, False), (2, 2, 4, False)),
        *((0, 1, 4, True), (1, 0, 4, True), (1, 2, 4, False), (2, 1, 4, False)),
    ],
)
def test_leads_may_cross_with_one_move_beyond_them(on, off, corners, closes):
    ring = [20 * cmath.exp(-2j * math.pi * k / corners) for k in range(corners)]
    first, *others, last = closed(ring)
    overrun = 0.2
    sides = [first.portion(-overrun, 1.0), *others, last.portion(0.0, 1.0 + overrun)]
    for _ in range(on):
        sides = [Straight(1.1 * sides[0].start, sides[0].start), *sides]
    for _ in range(off):
        sides = [*sides, Straight(sides[-1].end, 1.1 * sides[-1].end)]
    assert crossing(sides) is closes


@pytest.mark.parametrize(("slope", "through"), [(0.06, True), (0.04, False), (-1.0, False)])
@pytest.mark.parametrize(("turned", "size"), [(0.0, 1.0), (0.7, 1.0), (2.5, 0.025)])
def test_a_side_goes_through_where_two_others_join(slope, through, turned, size):
    """A lead comes to the corner from beyond the last side: from this side it does not cross it."""
    first, *others, last = closed(SQUARE)
    on = Straight(first.start + 20 + 20j * slope, first.start)
    over = Straight(last.start, last.end + 5)
    around = cmath.rect(size, turned)
    assert crossing([s.turned(around) for s in (on, first, *others, over)]) is through
    flipped = [Straight(s.end * 1j, s.start * 1j) for s in (over, *reversed(others), first, on)]
    flipped = [Straight(s.start.conjugate(), s.end.conjugate()) for s in flipped]
    assert crossing([s.turned(around) for s in flipped]) is through


@pytest.mark.parametrize(
    ("under_compensation", "expected"),
    [
        ("--++--", [((2, 3), {1, 4})]),
        ("-+--++-", [((1,), {0, 2}), ((4, 5), {3, 6})]),
        ("+-+", [((0,), {1}), ((2,), {1})]),
    ],
)
def test_a_contour_is_what_lies_between_two_ramps(under_compensation, expected):
    made = [line(k, 0.0, k + 1.0, 0.0, number=k, offset=3.0) for k in range(7)]
    cuts = [PathOfMove(move, (move,), sign == "+") for move, sign in zip(made, under_compensation)]
    found = [
        (tuple(move.line for move in each.moves), {ramp.move.line for ramp in each.ramps})
        for each in compensated_contours(Contour(50.0, 0.0, 0.0), cuts, NEAR)
    ]
    assert found == expected
