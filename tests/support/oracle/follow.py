# SPDX-License-Identifier: GPL-2.0-or-later
"""Lay the actual motion along the expected toolpath, in order, and name the first difference.

A cursor goes along the expected moves and never back. Each actual point takes it to a point within
reach, which is as far as the tool can have come since the point before: to the one where neither
the actual point nor what the cursor passes on the way is farther from the actual motion than need
be. So it follows a path that crosses, repeats or retraces itself, a missing move is a difference,
and the number of segments of a move does not matter. After a difference of the path nothing is
compared.

Lengths are mm, in the frame of the expected moves.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import accumulate
from typing import Self

from g12.geometry.curve import Arc, Curve, Line
from g12.tools.preview.moves import Move
from support.oracle.toolpath import Difference, Expected, Point, distance

SLACK = 0.25  # mm that a point may be ahead: at a corner that is blended
TIE = 1e-7  # mm: of two points as near as that the earlier one counts
ON_ARC = (0.25, 0.5, 0.75)  # shares of an arc that are compared
ARC_STEP = math.radians(30)  # an arc that was made is followed in steps of this
COINCIDENT = 1e-4  # mm: a move that is no farther off as a whole is the expected one
SAME_FEED = 1e-5  # relative; a trace prints feeds with nine decimals
OFF, MISSING, EXTRA = "path-off", "path-missing", "path-extra"
RAPID, FEED, FEED_MODE = "rapid", "feed", "feed-mode"


@dataclass(frozen=True)
class Made:
    """An actual move: its points, the first of them its start, and how it was commanded.

    Between its points it follows ``curve``, straight lines without one; of a curve the start and
    the end suffice. ``index`` is that of the move in the trace. ``feed`` is in mm per minute, or
    per revolution if ``per_rev``; None where it is not to be compared.
    """

    index: int
    points: Sequence[Point]
    curve: Curve | None = None
    feed: float | None = None
    rapid: bool = False
    per_rev: bool = False

    @classmethod
    def of(cls, index: int, move: Move, points: Sequence[Point], curve: Curve | None) -> Self:
        """Return an emitted move with its feed."""
        rapid = move.kind == "rapid"
        feed = None if rapid else move.feed
        return cls(index, points, curve, feed, rapid, move.feed_mode == "G95")

    def steps(self) -> Iterator[tuple[Point, Point]]:
        """Yield the segments of the move, those of an arc short enough to be followed."""
        points = self.points
        if isinstance(self.curve, Arc) and len(points) == 2:
            points = _along_the_arc(self.curve, *points)
        return zip(points, points[1:])

    def off_as_a_whole(self, expected: Expected) -> float:
        """Return how far the move is at most off an expected one, from its start to its end.

        Infinite where the two are not of one kind.
        """
        curve, other = self.curve, expected.curve
        if curve is None or type(curve) is not type(other):
            return math.inf
        (start, start_level), (end, end_level) = self.points[0], self.points[-1]
        off = max(abs(start_level - expected.start_level), abs(end_level - expected.end_level))
        if isinstance(curve, Arc) and isinstance(other, Arc):
            turned = abs(curve.sweep - other.sweep) * other.radius
            moved = 2 * abs(curve.centre - other.centre) + abs(curve.start - other.start)
            return off + turned + moved + abs(end - curve.end)
        return off + max(abs(start - other.start), abs(end - other.end))

    def distance(self, point: Point, first: Point, last: Point) -> float:
        """Return how far a point is from the motion between two of the points."""
        curve = self.curve or Line(first[0], last[0])
        _, level = _on_chord(point, first, last)
        return abs(complex(curve.distance(point[0]), point[1] - level))


def _on_chord(point: Point, first: Point, last: Point) -> Point:
    """Return the point of a chord nearest to a point."""
    chord = Expected("", Line(first[0], last[0]), first[1], last[1])
    return chord.point(chord.nearest(point))


def _along_the_arc(arc: Arc, start: Point, end: Point) -> list[Point]:
    """Return points of an arc that climbs, short steps apart."""
    count = math.ceil(abs(arc.sweep) / ARC_STEP) + 1
    shares = [step / count for step in range(1, count)]
    rise = end[1] - start[1]
    return [start, *((arc.point(share), start[1] + share * rise) for share in shares), end]


@dataclass(frozen=True)
class PathDifference:
    """The first difference of a kind: OFF, MISSING, EXTRA, RAPID, FEED or FEED_MODE.

    ``size`` is the distance of OFF in mm, of FEED the actual one; ``expected`` is None of EXTRA.
    """

    kind: str
    expected: Expected | None
    size: float = 0.0

    @property
    def code(self) -> str:
        if self.kind == RAPID and self.expected.rapid:
            return "not-rapid"
        return "feed-rev" if self.kind == FEED and self.expected.per_rev else self.kind

    @property
    def text(self) -> str:
        """What is wrong, of the move of the page."""
        what = self.expected.name if self.expected else "an extra move"
        return (
            f"the {what} is {self.size:.6g} mm off" if self.kind == OFF else f"{self.code}: {what}"
        )


@dataclass(frozen=True)
class Span:
    """The span of a toolpath along a move: from a share of one expected move to another's."""

    index: int
    share: float
    last: int
    last_share: float


@dataclass
class Laid:
    """The actual motion along an expected toolpath.

    ``deviation`` is the greatest distance (mm) as far as the path was followed, ``spans`` are those
    of the actual moves, by index. ``differences`` are the first of each kind; OFF, MISSING and
    EXTRA are the last.
    """

    deviation: float = 0.0
    spans: dict[int, Span] = field(default_factory=dict)
    differences: list[PathDifference] = field(default_factory=list)

    @property
    def difference(self) -> PathDifference | None:
        return self.differences[0] if self.differences else None

    def add(self, difference: PathDifference | None) -> None:
        """Add a difference if it is the first of its kind."""
        if difference and all(known.kind != difference.kind for known in self.differences):
            self.differences.append(difference)


@dataclass
class _Cursor:
    """A point of a toolpath: the index of an expected move, and the share of it that is done."""

    path: Sequence[Expected]
    index: int = 0
    share: float = 0.0
    _nearest_end: tuple[int, float] = (-1, math.inf)  # a move, the least distance from its end
    _lengths: list[float] = field(default_factory=list)
    _ends: list[float] = field(default_factory=list)  # lengths of the path up to each move's end

    def __post_init__(self) -> None:
        self._lengths = [move.length for move in self.path]
        self._ends = list(accumulate(self._lengths))

    @property
    def remaining(self) -> float:
        """The length of the rest of the toolpath."""
        return self._ends[-1] - self._ends[self.index] + self._rest() if self.path else 0.0

    def next_move(self) -> Expected:
        """Return the first move with a rest beyond rounding, the last one without any."""
        at = self.index if self._rest() > TIE else self.index + 1
        return self.path[min(at, len(self.path) - 1)]

    def follow(self, move: Made) -> tuple[float, Point]:
        """Go along a move; return how far it is off at most, and where."""
        off = self._take_whole(move)
        if off is not None:
            return off, move.points[-1]
        steps = (self.advance(move, *step) for step in move.steps())
        return max(steps, key=_size, default=(0.0, move.points[-1]))

    def _take_whole(self, move: Made) -> float | None:
        """Go to the end of the next expected move if this is it; return how far it is off."""
        length = self._lengths[self.index]
        index = self.index + (self._rest() <= COINCIDENT)
        if index == len(self.path) or (index == self.index and self.share * length > COINCIDENT):
            return None
        off = move.off_as_a_whole(self.path[index])
        if off > COINCIDENT:
            return None
        self.index, self.share = index, 1.0
        return off

    def advance(self, move: Made, first: Point, last: Point) -> tuple[float, Point]:
        """Go to the point nearest to ``last`` that passes nothing far from the actual motion.

        Return the greatest distance, and its point.
        """
        best = (math.inf, last), self.index, self.share
        for worst, index, share in self._candidates(move, first, last):
            if worst[0] < best[0][0] - TIE:
                best = worst, index, share
        worst, self.index, self.share = best
        return worst

    def _candidates(
        self, move: Made, first: Point, last: Point
    ) -> Iterator[tuple[tuple[float, Point], int, float]]:
        """Yield the nearest point to ``last`` of each move within reach: how far off, move, share.

        How far off is the greatest distance of it and of what is passed before it; the search ends
        where that alone is greater than for a move before.
        """
        reach, share = 2 * distance(first, last) + SLACK, self.share
        passed, least = (0.0, last), math.inf
        for index in range(self.index, len(self.path)):
            expected, length = self.path[index], self._lengths[index]
            most = min(1.0, share + reach / length) if length else 1.0
            nearest = expected.nearest(last, share, most)
            off = distance(last, expected.point(nearest))
            if off < least:
                within = self._within(move, (first, last), index, share, nearest)
                worst = max(passed, (off, last), within, key=_size)
                least = min(least, worst[0])
                yield worst, index, nearest
            reach -= (1.0 - share) * length
            if reach <= 0.0:
                return
            within = self._within(move, (first, last), index, share, 1.0)
            end = expected.point(1.0)
            missed = self._missed(index, move.distance(end, first, last))
            passed = max(passed, within, (missed, end), key=_size)
            if passed[0] > least:
                return
            share = 0.0

    def _missed(self, index: int, missed: float) -> float:
        """Return how far a move's end is from the actual motion, of the present one up to here.

        A blended corner comes nearest to it before the motion turns away.
        """
        if index != self.index:
            return missed
        nearest = self._nearest_end[1] if self._nearest_end[0] == index else math.inf
        self._nearest_end = index, min(nearest, missed)
        return self._nearest_end[1]

    def _within(
        self, move: Made, ends: tuple[Point, Point], index: int, begin: float, end: float
    ) -> tuple[float, Point]:
        """Return the farthest point of an arc between two shares: of a line its ends suffice.

        A motion that cuts a corner meets the two ends alone: it is as far off as the arc is from
        the chord between them.
        """
        expected = self.path[index]
        if isinstance(expected.curve, Line) or begin == end:
            return 0.0, ends[1]
        chord = expected.point(begin), expected.point(end)
        points = (expected.point(begin + part * (end - begin)) for part in ON_ARC)
        away = (
            (min(move.distance(at, *ends), distance(at, _on_chord(at, *chord))), at)
            for at in points
        )
        return max(away, key=_size)

    def _rest(self) -> float:
        return (1.0 - self.share) * self._lengths[self.index]


def _size(found: tuple[float, Point]) -> float:
    return found[0]


def lay(path: Sequence[Expected], made: Iterable[Made], tolerance: float) -> Laid:
    """Lay actual moves along a toolpath; farther off than ``tolerance`` (mm) is a difference."""
    laid, cursor = Laid(), _Cursor(path)
    for move in made:
        off = _lay_move(cursor, move, tolerance, laid)
        if off:
            laid.add(off)
            return laid
    if cursor.remaining > tolerance:
        missing = cursor.next_move()
        laid.add(PathDifference(MISSING, missing))
    return laid


def _lay_move(cursor: _Cursor, move: Made, tolerance: float, laid: Laid) -> PathDifference | None:
    """Take the cursor along a move; return how the move leaves the toolpath."""
    if not cursor.path or cursor.remaining <= tolerance:
        return _beyond_the_end(cursor, move, tolerance)
    before, due = (cursor.index, cursor.share), cursor.next_move()
    farthest = cursor.follow(move)[0]
    if farthest > tolerance:
        return PathDifference(OFF, due, farthest)
    laid.spans[move.index] = Span(*before, cursor.index, cursor.share)
    laid.deviation = max(laid.deviation, farthest)
    laid.add(_difference_of_feed(cursor.path[cursor.index], move))
    return None


def _beyond_the_end(cursor: _Cursor, move: Made, tolerance: float) -> PathDifference | None:
    """Return how a move leaves the end of the toolpath, None if it stays there."""
    end = cursor.path[-1].point(1.0) if cursor.path else move.points[0]
    at = max(move.points, key=lambda point: distance(point, end))
    off = distance(at, end) > tolerance
    return PathDifference(EXTRA, None) if off else None


def _difference_of_feed(expected: Expected, move: Made) -> PathDifference | None:
    """Return how a move differs in rapid or feed from the expected one along which it is."""
    compared = not expected.rapid and None not in (expected.feed, move.feed)
    kind, size = "", 0.0
    if expected.rapid != move.rapid:
        kind = RAPID
    elif compared and expected.per_rev != move.per_rev:
        kind = FEED_MODE
    elif compared and abs(move.feed - expected.feed) > SAME_FEED * expected.feed:
        kind, size = FEED, move.feed
    return PathDifference(kind, expected, size) if kind else None


def judge_path(laid: Laid, line: int) -> Iterator[Difference]:
    """Yield the differences of a toolpath."""
    for each in laid.differences:
        yield Difference(each.code, (each.expected and each.expected.line) or line, each.text)
