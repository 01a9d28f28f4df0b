# SPDX-License-Identifier: GPL-2.0-or-later
"""Which moves of a long contour are near to which passes of the tool: trees of boxes.

A contour's stretch whose directions all lie within less than half a turn cannot be cut by the tool
on its way along that stretch, if its path never goes backwards: between a place of the tool and one
of the contour behind it lies the line along the steepest move between both. So of the many moves
near to a pass only those are looked at that a longer way round leads to.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from math import atan2, cos, hypot, pi
from operator import itemgetter

from g12.compensation.contour import Arc, Line, Point, arc_radius, end_direction, start_direction
from g12.compensation.intersect import distance_from

LEAF = 4  # moves in a box that is not divided
STRAIGHT = pi - 1e-3  # directions within that angle

Box = tuple  # least x, least c, greatest x, greatest c


def box_of(move: Line | Arc) -> Box:
    """Return a box round a move; for an arc it may be larger than need be."""
    low_x, high_x = (move.x0, move.x1) if move.x0 < move.x1 else (move.x1, move.x0)
    low_c, high_c = (move.c0, move.c1) if move.c0 < move.c1 else (move.c1, move.c0)
    if isinstance(move, Line):
        return low_x, low_c, high_x, high_c
    radius = arc_radius(move)
    if abs(move.sweep) > pi:
        return move.cx - radius, move.cc - radius, move.cx + radius, move.cc + radius
    rise = radius * (1.0 - cos(0.5 * move.sweep))
    return low_x - rise, low_c - rise, high_x + rise, high_c + rise


def apart(a: Box, b: Box, reach: float) -> bool:
    """Return whether two boxes are farther than ``reach`` from each other."""
    return a[0] - b[2] > reach or b[0] - a[2] > reach or a[1] - b[3] > reach or b[1] - a[3] > reach


class Boxes:
    """A tree of boxes round moves, each with an index that grows along the sequence."""

    def __init__(self, items: Sequence[tuple[int, Line | Arc]]) -> None:
        self.first, self.last, self.count = items[0][0], items[-1][0], len(items)
        self.items: list[tuple] = []
        self.halves: tuple[Boxes, ...] = ()
        if len(items) > LEAF:
            middle = len(items) // 2
            self.halves = Boxes(items[:middle]), Boxes(items[middle:])
            boxes = [half.box for half in self.halves]
        else:
            self.items = [(item, box_of(item[1])) for item in items]
            boxes = [box for _, box in self.items]
        low_x, low_c, high_x, high_c = zip(*boxes)
        self.box = min(low_x), min(low_c), max(high_x), max(high_c)

    def near(self, box: Box, reach: float) -> Iterator[tuple[int, Line | Arc]]:
        """Yield the moves whose boxes are within ``reach`` of a box."""
        waiting = [self]
        while waiting:
            node = waiting.pop()
            if not apart(node.box, box, reach):
                waiting.extend(node.halves)
                yield from (item for item, way in node.items if not apart(way, box, reach))

    def nearest(
        self, point: Point, reach: float, counts: Callable[[int, Line | Arc], bool]
    ) -> tuple[float, int | None]:
        """Return how far the nearest move that counts is from a point, and its index.

        The ``reach`` and None where none is nearer than that.
        """
        found, waiting = None, [(0.0, self)]
        while waiting:
            away, node = waiting.pop()
            if away >= reach:
                continue
            halves = [(_away(point, half.box), half) for half in node.halves]
            waiting.extend(sorted(halves, key=itemgetter(0), reverse=True))
            for (index, move), box in node.items:
                if _away(point, box) < reach:
                    away = distance_from(move, point)
                    if away < reach and counts(index, move):
                        reach, found = away, index
        return reach, found


def _away(point: Point, box: Box) -> float:
    """Return how far a point is from a box, 0 in it."""
    (x, c), (low_x, low_c, high_x, high_c) = point, box
    return hypot(max(low_x - x, x - high_x, 0.0), max(low_c - c, c - high_c, 0.0))


def near_passes(
    moves: Boxes,
    passes: Sequence[Boxes],
    reach: float,
    runs: Sequence[int],
    settled: Callable[[int], bool],
) -> Iterator[tuple[int, list[tuple]]]:
    """Yield each move's index with the passes within ``reach`` of its box that may cut it.

    ``runs`` are what `straight_runs` returns; an index below zero belongs to none of them. A move
    is not looked at if it is ``settled`` when its turn comes.
    """
    waiting = [(moves, list(passes))]
    while waiting:
        node, others = waiting.pop()
        others = _near(node, others, reach, runs)
        if others and node.halves:
            waiting.extend((half, others) for half in reversed(node.halves))
        elif others:
            for (index, _), box in node.items:
                if not settled(index):
                    yield index, _passes_near(index, box, others, reach, runs)


def _near(node: Boxes, others: list[Boxes], reach: float, runs: Sequence[int]) -> list[Boxes]:
    """Return which boxes, or which halves of larger ones, are near to a box."""
    near, waiting, count = [], others[:], node.count
    while waiting:
        other = waiting.pop()
        if apart(node.box, other.box, reach) or _in_one_run(node, other, runs):
            continue
        if other.halves and (other.count > count or not node.halves):
            waiting.extend(other.halves)
        else:
            near.append(other)
    return near


def _passes_near(
    index: int, box: Box, others: list[Boxes], reach: float, runs: Sequence[int]
) -> list[tuple]:
    """Return the passes in some boxes that are near to a move."""
    return [
        passed
        for other in others
        for passed, way in other.items
        if not apart(box, way, reach) and not _same_run(index, passed[0], runs)
    ]


def _in_one_run(one: Boxes, other: Boxes, runs: Sequence[int]) -> bool:
    first = one.first if one.first < other.first else other.first
    last = one.last if one.last > other.last else other.last
    return first >= 0 and runs[first] >= last


def _same_run(one: int, other: int, runs: Sequence[int]) -> bool:
    first, last = (one, other) if one < other else (other, one)
    return first >= 0 and runs[first] >= last


def straight_runs(moves: Sequence[Line | Arc]) -> list[int]:
    """Return for each move the last one up to which no directions are half a turn apart."""
    spans = _spans(moves)
    runs, end = [], 0
    lows: deque[int] = deque()  # moves whose least angle is the least from them on
    highs: deque[int] = deque()
    for first in range(len(moves)):
        while end < len(moves):
            low, high = spans[end]
            while lows and spans[lows[-1]][0] >= low:
                lows.pop()
            while highs and spans[highs[-1]][1] <= high:
                highs.pop()
            lows.append(end)
            highs.append(end)
            if spans[highs[0]][1] - spans[lows[0]][0] > STRAIGHT:
                break
            end += 1
        runs.append(end - 1)
        for window in (lows, highs):
            if window and window[0] == first:
                window.popleft()
        end = max(end, first + 1)
    return runs


def _spans(moves: Sequence[Line | Arc]) -> list[tuple[float, float]]:
    """Return the least and the greatest angle of each move, the turn in front of it included.

    The angles go on from move to move, without a jump.
    """
    spans, angle, before = [], 0.0, None
    for move in moves:
        angles = [angle]
        angle += _turn(before, move) if before else 0.0
        angles.append(angle)
        if isinstance(move, Arc):
            angle += move.sweep
            angles.append(angle)
        spans.append((min(angles), max(angles)))
        before = move
    return spans


def _turn(a: Line | Arc, b: Line | Arc) -> float:
    """Return the angle from the end of a move to the next."""
    ax, ac = end_direction(a)
    bx, bc = start_direction(b)
    return atan2(ax * bc - ac * bx, ax * bx + ac * bc)
