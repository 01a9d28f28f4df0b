# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a compensated contour begins and ends, which moves repeat each other."""

import math

import pytest

from g12.compensation.compensated import (
    CompensatedContour,
    PathOfMove,
    compensated_contours,
    in_plane,
)
from g12.compensation.contour import Contour
from support.planned_moves import arc, line

TOLERANCE, RADIUS = 0.005, 3.0


@pytest.mark.parametrize(
    ("under_compensation", "expected"),
    [
        ("", []),
        ("---", []),
        ("--++--", [((2, 3), {1, 4})]),
        ("-+--++-", [((1,), {0, 2}), ((4, 5), {3, 6})]),
        ("+-+", [((0,), {1}), ((2,), {1})]),
    ],
)
def test_a_contour_is_what_lies_between_two_ramps(under_compensation, expected):
    made = [line(k, 0.0, k + 1.0, 0.0, number=k, offset=RADIUS) for k in range(7)]
    cuts = [PathOfMove(move, (move,), sign == "+") for move, sign in zip(made, under_compensation)]
    found = [
        (tuple(move.line for move in each.moves), {ramp.move.line for ramp in each.ramps})
        for each in compensated_contours(Contour(50.0, 0.0), cuts, TOLERANCE)
    ]
    assert found == expected


def test_moves_are_one_in_the_plane_if_ends_centre_and_sweep_are_the_same():
    moves = [line(0.0, 0.0, 1.0, 0.0), line(0.0, 0.0, 0.0, 1.0), line(0.0, 0.0, 1.0, 1e-5)]
    moves += [line(1.0, 0.0, 0.0, 0.0), line(0.0, 1e-5, 1.0, 0.0)]
    moves += [arc(centre, 0j, 2 * math.pi) for centre in (2 + 0j, -2 + 0j, 2j)]
    moves += [arc(2 + 0j, 0j, -2 * math.pi)]
    assert len(set(map(in_plane, moves))) == len(moves)
    for move in moves:
        near = move.curve._replace(start=move.start + 1e-9)
        again = move._replace(line=7, feed=1.0, offset=-2.0, z0=3.0, z1=5.0, curve=near)
        assert in_plane(again) == in_plane(move)


def test_beyond_the_ends_of_an_open_contour_nobody_knows():
    """Before, after and beside an angle, and on its own lines."""
    moves = line(0, 10, 0, 0, offset=RADIUS), line(0, 0, 20, 0, offset=RADIUS)
    cuts = [PathOfMove(move, (), True) for move in moves]
    angle = CompensatedContour(Contour(50.0, 0.0), cuts, [], TOLERANCE)
    beyond = [11j, 3 + 11j, -3 + 11j, 21 + 0j, 21 + 3j, 21 - 3j]
    assert [angle.clearance(point)[1] for point in beyond] == [True] * 6
    heights = {3 + 9j: 3.0, -3 + 9j: -3.0, 3 + 2j: 2.0, -3 - 4j: -5.0, 19 + 1j: 1.0, 19 - 1j: -1.0}
    for point, clearance in heights.items():
        assert angle.clearance(point) == (pytest.approx(clearance), False)
