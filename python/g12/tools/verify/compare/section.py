# SPDX-License-Identifier: GPL-2.0-or-later
"""A cut's moves, and those of a run, laid along the toolpath that its words command.

All are points of the contour's plane with their levels, lengths in mm. The feed of a segment is the
length of toolpath that it makes in the time that its F gives it: how far the segment itself goes
off the toolpath does not count.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from g12.tools.path.face_follow import face_demand
from g12.tools.path.follow import Followed
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.part import C
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import OFF, Laid, Made, PathDifference, Span, judge_path, lay
from g12.tools.verify.compare.plane import Plane
from g12.tools.verify.expected.toolpath import NO_LENGTH, Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import FEED, JOINT

LESS_ON_FACE, LEAST_ON_FACE = 0.86, 0.05  # of the feed: what C cannot follow is made at between
FEED_STEP = 0.8  # of a feed: a portion of a move may be made at so much less than can be followed
NEARLY = 0.95  # of a limit


@dataclass(frozen=True)
class LaidMoves:
    """Moves laid along an expected toolpath, and the motion of a run where they do not differ."""

    emitted: Laid
    run: Laid | None = None

    @property
    def laid(self) -> Laid:
        """What was laid: the moves if they differ or nothing ran, else the run."""
        return self.emitted if self.emitted.difference or not self.run else self.run

    @property
    def difference(self) -> PathDifference | None:
        return self.laid.difference

    @property
    def off(self) -> float:
        """The greatest distance from where it should be, inf if part is missing; mm."""
        if self.difference is None:
            return max(laid.deviation for laid in (self.emitted, self.run) if laid)
        return self.difference.size if self.difference.kind == OFF else math.inf


@dataclass(frozen=True)
class ToolpathView:
    """A cut as its part sees it: the expected toolpath, which of the moves are its ``own``.

    ``path`` is that of the moves on the part, ``real`` the motion of a run there. ``allowed`` is
    how far off the moves may be, and the motion, which rounds corners; mm. ``diameters``: X words
    are; ``last`` is the line of a move that the words do not command.
    """

    expected: Sequence[Expected]
    plane: Plane
    own: range
    moves: Sequence[Move]
    path: Track
    real: Followed | None
    axes: LatheAxes
    allowed: tuple[float, float]
    diameters: bool
    last: int

    @property
    def on_face(self) -> bool:
        """Whether it is made by the kinematics of the face."""
        return bool(self.axes.face) and not self.plane.surface

    def points(self, index: int) -> np.ndarray:
        """Return the points (n, 3) of the part along a move as emitted."""
        return self.path.points[self.path.vertices(index)]

    def motion(self, index: int) -> np.ndarray:
        """Return the points (n, 3) of the part along a move as in the run, if there is one."""
        return self.real.points[self.real.during(index)] if self.real else self.points(index)

    @cached_property
    def found(self) -> LaidMoves:
        """The moves and the motion along the toolpath."""
        emitted = lay(self.expected, self._made(self.points), self.allowed[0])
        if self.real is None or emitted.difference:
            return LaidMoves(emitted)
        run = lay(self.expected, self._made(self.motion, sampled=True), self.allowed[1])
        return LaidMoves(emitted, run)

    def _made(
        self, points_of: Callable[[int], np.ndarray], sampled: bool = False
    ) -> Iterator[Made]:
        for index in self.own:
            points = points_of(index)
            if len(points):
                levels = (points[:, 2] - self.plane.base).tolist()
                made = list(zip(self.plane.points(points).tolist(), levels))
                rapid = self.moves[index].kind == "rapid"
                yield Made(index, made, rapid=rapid, sampled=sampled)

    def may_be_slower(self, index: int, feed: float) -> bool:
        """Tell whether a move on the face may be slower than a feed.

        It is nearly as fast as the axes can follow, or as a planner with their limits is.
        """
        if not self.on_face or turns(self.moves[index]):
            return False
        quicker = face_demand(self.path, index, self.axes, 1.0 / FEED_STEP)
        slow = self.path.part_feed(index) <= LESS_ON_FACE * feed
        return slow and (quicker is None or max(quicker) > NEARLY)


def turns(move: Move) -> bool:
    return move.start[C] != move.end[C]


def judge_toolpath(view: ToolpathView) -> Iterator[Finding]:
    """Yield where it is off the toolpath, and the first feed that is not the words'."""

    def words(at: tuple[complex, float]) -> Sequence[tuple[str, float | str]]:
        return view.plane.words(at, view.diameters)

    yield from judge_path(view.found.laid, view.last, view.plane.place, words)
    for index, span in view.found.emitted.spans.items():
        parts = list(span_parts(view.expected, span))
        length, expected = sum(length for _, length in parts), seconds_of(parts)
        given = _seconds_given(view.moves[index])
        if not expected or not given or length < JOINT:
            continue
        share, rounding = expected / given, JOINT / length
        least = 1.0 - FEED
        if share < least - rounding:
            feed = max(move.feed or 0.0 for move, _ in parts)
            least *= LEAST_ON_FACE if view.may_be_slower(index, feed) else 1.0
        if not least - rounding <= share <= 1.0 + FEED + rounding:
            move, end = parts[0][0], parts[0][0].point(1.0)
            feeds = {"made": 60.0 * length / given, "expected": 60.0 * length / expected}
            values = {"what": move.name, **feeds, "at": words(end)}
            yield Finding("feed", move.line or view.last, values, view.plane.place(end))
            return


def _seconds_given(move: Move) -> float:
    """Return the time that a move's F gives it, 0 of a rapid."""
    speed = 0.0 if move.kind == "rapid" else rate(move, 0.0)
    return speed and (move.length if move.kind == "arc" else feed_length(move)) / speed


def span_parts(path: Sequence[Expected], span: Span) -> Iterator[tuple[Expected, float]]:
    """Yield the moves of a span of a toolpath, each with the length of it that is made.

    A span may begin at the end of the move before, but for rounding.
    """
    for at in range(span.index, span.last + 1):
        begin = span.share if at == span.index else 0.0
        end = span.last_share if at == span.last else 1.0
        length = (end - begin) * path[at].length
        if length > NO_LENGTH:
            yield path[at], length


def seconds_of(parts: Iterable[tuple[Expected, float]]) -> float:
    """Return the time that lengths of moves take at their feeds, 0 if one is not known."""
    found = [60.0 * length / move.feed if move.feed else 0.0 for move, length in parts]
    return sum(found) if all(found) else 0.0
