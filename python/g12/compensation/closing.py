# SPDX-License-Identifier: GPL-2.0-or-later
"""Where a contour closes: what sticks out beyond leads in or out, and is no contour.

A contour closes where one of its first moves meets one of its last: the one ends on the other, or
both are long enough to cross, as leads that overrun a corner do. Program units.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import accumulate, product
from math import hypot
from typing import NamedTuple

from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Line,
    Point,
    direction_at,
    end_direction,
    path_length,
    start_direction,
)
from g12.compensation.intersect import (
    along_end,
    along_start,
    common_places,
    nearest_place,
    part_of_move,
)

LEADS = 3  # moves at either end of a contour among which it may close
CROSSING = 2  # of these: so far from the end may be the moves that cross
LEAST_SHARE = 0.5  # of a lead's length: so long is a contour at least, or
LEAST_TURN = 4.0  # tool radii
LEAST_SINE = 0.05  # of the angle at which moves cross
LEAST_CONTOUR = 5  # moves of a contour with more than one move for a lead that crosses


class Closing(NamedTuple):
    """The contour from a length along its move ``first`` to one along its move ``last``.

    ``closed`` is False for an open contour, which is all there is. ``crossing``: leads stick out
    on both sides.
    """

    first: int
    start: float
    last: int
    end: float
    closed: bool
    crossing: bool

    def part(self, index: int, move: Line | Arc) -> tuple[float, float]:
        """Return the part of a move that belongs to the contour, 0 to 1 at most; else (0, 0)."""
        if not self.first <= index <= self.last:
            return 0.0, 0.0
        length = path_length(move)
        start = self.start if index == self.first else 0.0
        end = self.end if index == self.last else length
        return (start / length, end / length) if end - start > SAME_PLACE else (0.0, 0.0)


def closing_of(moves: Sequence[Line | Arc], near: float) -> Closing:
    """Return where a contour closes; places up to ``near`` apart meet.

    What is much shorter than the leads and the tool is a spur of an open contour.
    """
    count, ends = len(moves), [0.0, *accumulate(map(path_length, moves))]
    enough = LEAST_TURN * abs(moves[0].offset)
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        ways = [way for way in _meetings(moves, i, j, near) if way.allowed] if j > i else []
        if ways:
            start, end, crossing, _ = max(ways, key=lambda way: way.start - way.end)
            lead = max(ends[i] + start, ends[-1] - ends[j] - end)
            if ends[j] + end - ends[i] - start >= min(LEAST_SHARE * lead, enough):
                return Closing(i, start, j, end, True, crossing)
    (x, c), length = _end(moves[-1]), path_length(moves[-1])
    round_about = hypot(moves[0].x0 - x, moves[0].c0 - c) <= near
    return Closing(0, 0.0, count - 1, length, round_about, False)


class _Meeting(NamedTuple):
    """Lengths along two moves at which they meet."""

    start: float
    end: float
    crossing: bool
    allowed: bool


def _meetings(moves: Sequence[Line | Arc], i: int, j: int, near: float) -> Iterator[_Meeting]:
    """Yield how the moves with two indices meet; neighbours do so behind their joint."""
    one, other, count = moves[i], moves[j], len(moves)
    skipped = 0.5 if j == i + 1 else 0.0
    if skipped:
        other = part_of_move(other, skipped, 1.0)
    length, rest = path_length(one), path_length(other)
    outer = (i, j) == (0, count - 1)
    leads = count >= LEAST_CONTOUR and i < CROSSING and j >= count - CROSSING
    for a, b in _places(one, other, near):
        start = min(max(along_start(one, a), 0.0), length)
        end = min(max(along_end(other, b), 0.0), rest)
        inside = near < start < length - near, near < end < rest - near
        joints = _joint(moves, i, start), _joint(moves, j, end)
        crossing = all(inside) or any(
            within and joint and _goes_through(joint, move, place)
            for within, joint, move, place in zip(inside[::-1], joints, (other, one), (b, a))
        )
        passed = skipped * path_length(moves[j])
        yield _Meeting(start, passed + end, crossing, outer or leads or not crossing)


def _joint(moves: Sequence[Line | Arc], k: int, along: float) -> tuple[Point, ...]:
    """Return the directions in front of and behind the nearer end of a move, if others join it."""
    at_end = along > 0.5 * path_length(moves[k])
    first = k if at_end else k - 1
    if not 0 <= first < len(moves) - 1:
        return ()
    return end_direction(moves[first]), start_direction(moves[first + 1])


def _goes_through(joint: tuple[Point, ...], move: Line | Arc, place: Point) -> bool:
    """Return whether what is joined at a place of another move is on both sides of that."""
    tx, tc = direction_at(move, place)
    sines = [tx * c - tc * x for x, c in joint]
    return min(sines) > LEAST_SINE or max(sines) < -LEAST_SINE


def _places(one: Line | Arc, other: Line | Arc, near: float) -> Iterator[tuple[Point, Point]]:
    """Yield places on two moves that are at most ``near`` apart."""
    for place in common_places(one, other):
        yield place, place
    ends = [(end, nearest_place(other, end)) for end in (_start(one), _end(one))]
    ends += [(nearest_place(one, end), end) for end in (_start(other), _end(other))]
    for a, b in ends:
        if hypot(a[0] - b[0], a[1] - b[1]) <= near:
            yield a, b


def _start(move: Line | Arc) -> Point:
    return move.x0, move.c0


def _end(move: Line | Arc) -> Point:
    return move.x1, move.c1
