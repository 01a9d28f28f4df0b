# SPDX-License-Identifier: GPL-2.0-or-later
"""Lay what was made along the expected toolpath, in order, and name the first difference.

A cursor goes along the expected moves and never back. Each point that was made takes it to the
nearest point within reach: as far as the tool can have come since the point before. What the cursor
passes on the way is compared with what was made between the two points. So a path that crosses,
repeats or retraces itself is followed, a move that is left out is a difference, and into how many
segments a move was split does not matter. Emitted moves and the samples of a run are laid alike.
After the first difference nothing more is known of the rest.

Lengths are mm, in the frame of the expected moves.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from g12.geometry.curve import Curve, Line
from g12.tools.verify.expected.toolpath import Expected

Point = tuple[complex, float]  # in the plane, and the level
SLACK = 0.25  # mm that a point may be ahead: at a corner that is blended
TIE = 1e-7  # mm: of two points as near as that the earlier one counts
ON_ARC = (0.25, 0.5, 0.75)  # shares of an arc that are compared
SAME_FEED = 1e-5  # relative; a trace tells feeds with nine decimals
OFF, MISSING, EXTRA, RAPID, FEED, FEED_MODE = "off", "missing", "extra", "rapid", "feed", "mode"


class Made(NamedTuple):
    """A move that was made: its points, the first of them its start, and how it was commanded.

    Between its points it follows ``curve``, straight lines without one. ``index`` is that of the
    move in the trace. ``feed`` is in mm per minute, or per revolution if ``per_rev``; None where it
    is not to be compared.
    """

    index: int
    points: Sequence[Point]
    curve: Curve | None = None
    feed: float | None = None
    rapid: bool = False
    per_rev: bool = False

    def distance(self, point: Point, first: Point, last: Point) -> float:
        """Return how far a point is from what was made between two of the points."""
        curve = self.curve or Line(first[0], last[0])
        chord = Expected("", Line(first[0], last[0]), first[1], last[1])
        _, level = chord.point(chord.share_of(*point))
        return abs(complex(curve.distance(point[0]), point[1] - level))


class PathDifference(NamedTuple):
    """The first thing that is not as expected.

    ``kind`` is OFF, MISSING, EXTRA, RAPID, FEED or FEED_MODE; ``size`` is the distance of OFF in
    mm, of FEED the one commanded; ``at`` the point that was made, or that is missing; ``index`` the
    move that was made, None of MISSING; ``expected`` is None of EXTRA.
    """

    kind: str
    expected: Expected | None
    at: Point
    size: float = 0.0
    index: int | None = None


@dataclass
class Laid:
    """What was made along an expected toolpath.

    ``deviation`` is the greatest distance (mm) in front of the first ``difference``, ``moves`` are
    the indices of the moves made along each expected one.
    """

    moves: list[list[int]]
    deviation: float = 0.0
    difference: PathDifference | None = None


def lay(
    path: Sequence[Expected], made: Iterable[Made], tolerance: float, slack: float = SLACK
) -> Laid:
    """Lay what was made along a toolpath; farther off than ``tolerance`` (mm) is a difference."""
    laid = Laid([[] for _ in path])
    cursor = _Cursor(path, slack)
    for move in made:
        laid.difference = _lay_move(cursor, move, tolerance, laid)
        if laid.difference:
            return laid
    missing = next(cursor.missing(tolerance), None)
    if missing:
        laid.difference = PathDifference(MISSING, missing, missing.point(1.0))
    return laid


def _lay_move(cursor: _Cursor, move: Made, tolerance: float, laid: Laid) -> PathDifference | None:
    """Take the cursor along a move; return how the move differs."""
    if not cursor.path or not any(cursor.missing(tolerance)):
        return _beyond_the_end(cursor, move, tolerance)
    farthest, where = 0.0, move.points[-1]
    for first, last in zip(move.points, move.points[1:]):
        off, at = cursor.advance(move, first, last)
        if off > farthest:
            farthest, where = off, at
    expected = cursor.path[cursor.index]
    if farthest > tolerance:
        return PathDifference(OFF, expected, where, farthest, move.index)
    laid.moves[cursor.index].append(move.index)
    laid.deviation = max(laid.deviation, farthest)
    return _otherwise(expected, move)


def _beyond_the_end(cursor: _Cursor, move: Made, tolerance: float) -> PathDifference | None:
    """Return what a move does after the whole toolpath is made: nothing, if it stays there."""
    end = cursor.path[-1].point(1.0) if cursor.path else move.points[0]
    at = max(move.points, key=lambda point: _apart(point, end))
    return (
        PathDifference(EXTRA, None, at, index=move.index) if _apart(at, end) > tolerance else None
    )


def _otherwise(expected: Expected, move: Made) -> PathDifference | None:
    """Return how a move differs in rapid or feed from the expected one that it is made along."""
    at, index = move.points[-1], move.index
    if expected.rapid != move.rapid:
        return PathDifference(RAPID, expected, at, index=index)
    if expected.rapid or None in (expected.feed, move.feed):
        return None
    if expected.per_rev != move.per_rev:
        return PathDifference(FEED_MODE, expected, at, index=index)
    if abs(move.feed - expected.feed) > SAME_FEED * expected.feed:
        return PathDifference(FEED, expected, at, move.feed, index)
    return None


def _apart(one: Point, other: Point) -> float:
    return abs(complex(abs(one[0] - other[0]), one[1] - other[1]))


@dataclass
class _Cursor:
    """A place on a toolpath: the index of an expected move, and the share of it that is made."""

    path: Sequence[Expected]
    slack: float
    index: int = 0
    share: float = 0.0
    _lengths: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._lengths = [move.length for move in self.path]

    def advance(self, move: Made, first: Point, last: Point) -> tuple[float, Point]:
        """Go to the point nearest to ``last``; return the greatest distance, and where it is."""
        found = list(self._candidates(last, _apart(first, last)))
        nearest = min(off for off, _, _ in found)
        off, index, share = next(each for each in found if each[0] <= nearest + TIE)
        passed = [(move.distance(at, first, last), at) for at in self._passed(index, share)]
        self.index, self.share = index, share
        return max([(off, last), *passed], key=lambda each: each[0])

    def _candidates(self, point: Point, step: float) -> Iterator[tuple[float, int, float]]:
        """Yield the nearest point of each move within reach: its distance, move and share."""
        reach, share = 2 * step + self.slack, self.share
        for index in range(self.index, len(self.path)):
            expected, length = self.path[index], self._lengths[index]
            most = min(1.0, share + reach / length) if length else 1.0
            nearest = expected.nearest(point, share, most)
            yield expected.distance(*point, nearest), index, nearest
            reach, share = reach - (1.0 - share) * length, 0.0
            if reach <= 0.0:
                return

    def _passed(self, index: int, share: float) -> Iterator[Point]:
        """Yield points of the toolpath between the cursor and a place ahead.

        They are the ends of moves and some points of arcs: of what is straight the ends suffice.
        """
        begin = self.share
        for at in range(self.index, index + 1):
            expected, end = self.path[at], share if at == index else 1.0
            if not isinstance(expected.curve, Line):
                yield from (expected.point(begin + part * (end - begin)) for part in ON_ARC)
            if at < index:
                yield expected.point(end)
            begin = 0.0

    def missing(self, tolerance: float) -> Iterator[Expected]:
        """Yield the expected moves of which more than the tolerance is not made yet."""
        share = self.share
        for index in range(self.index, len(self.path)):
            if (1.0 - share) * self._lengths[index] > tolerance:
                yield self.path[index]
            share = 0.0
