# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections on a lathe: moves laid along the toolpath, and their feeds.

All are points of the contour's plane with their levels: of the face, which turns with the part, or
of the unrolled surface. The feed of a segment is the length of toolpath that it makes in the time
that its F gives it. Lengths are mm.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

from g12.tools.path.face_follow import face_demand
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Move
from support.oracle.follow import Made, judge_path, lay
from support.oracle.toolpath import NO_LENGTH, Difference, Expected

C = 5
LAST_DECIMAL = 0.0005  # added: arcs whose words are rounded do not close any better
JOINT = 0.001  # of what a segment makes of a toolpath: its ends lie so near to their places
FEED = 0.002  # relative: a trace prints nine decimals of feeds beside C in degrees
LESS_ON_FACE, LEAST_ON_FACE = 0.86, 0.05  # of the feed: what C cannot follow is made at between
FEED_STEP, NEARLY = 0.8, 0.95  # a portion may be made at so much less than can be followed


@dataclass(frozen=True)
class LatheCut:
    """A cut as its part sees it: the expected toolpath, which of the moves are its ``own``.

    ``path`` is that of the moves on the part; ``zero`` is the plane's zero there, ``axis`` the
    direction of its first axis, ``base`` its level 0.
    """

    line: int
    last_line: int
    expected: Sequence[Expected]
    own: range
    moves: Sequence[Move]
    path: Track
    axes: LatheAxes
    zero: complex
    axis: complex
    base: float
    surface: float
    tolerance: float

    @property
    def on_face(self) -> bool:
        """Whether it is made by the kinematics of the face."""
        return bool(self.axes.face) and not self.surface

    @cached_property
    def found(self):
        made = []
        for index in self.own:
            points = self.path.points[self.path.vertices(index)]
            if len(points):
                flat = (points[:, 0] + 1j * points[:, 1] - self.zero) * self.axis.conjugate()
                levels = (points[:, 2] - self.base).tolist()
                rapid = self.moves[index].kind == "rapid"
                made.append(Made(index, list(zip(flat.tolist(), levels)), rapid=rapid))
        return lay(self.expected, made, self.tolerance + LAST_DECIMAL)


def judge_lathe_cut(cut: LatheCut) -> Iterator[Difference]:
    """Yield the first of each kind of difference: path, feed."""
    yield from judge_path(cut.found, cut.last_line)
    yield from islice(judge_feed(cut), 1)


def judge_feed(cut: LatheCut) -> Iterator[Difference]:
    for index, span in cut.found.spans.items():
        parts = list(span_parts(cut.expected, span))
        length, expected = sum(length for _, length in parts), seconds_of(parts)
        given = seconds_given(cut.moves[index])
        if not expected or not given or length < JOINT:
            continue
        share, rounding, least = expected / given, JOINT / length, 1.0 - FEED
        if share < least - rounding and may_be_slower(cut, index, parts):
            least *= LEAST_ON_FACE
        if not least - rounding <= share <= 1.0 + FEED + rounding:
            what, line = parts[0][0].name, parts[0][0].line or cut.line
            yield Difference("feed", line, f"{what}: {60 * length / given:.6g} mm/min")


def may_be_slower(cut: LatheCut, index: int, parts: Sequence[tuple[Expected, float]]) -> bool:
    """Tell whether a move on the face may be slower than its feed.

    It is nearly as fast as the axes can follow, or as a planner with their limits is.
    """
    move = cut.moves[index]
    if not cut.on_face or move.start[C] != move.end[C]:
        return False
    quicker = face_demand(cut.path, index, cut.axes, 1.0 / FEED_STEP)
    slow = cut.path.part_feed(index) <= LESS_ON_FACE * max(move.feed or 0.0 for move, _ in parts)
    return slow and (quicker is None or max(quicker) > NEARLY)


def seconds_given(move: Move) -> float:
    """Return the time that a move's F gives it, 0 of a rapid."""
    speed = 0.0 if move.kind == "rapid" else rate(move, 0.0)
    return speed and (move.length if move.kind == "arc" else feed_length(move)) / speed


def span_parts(path, span) -> Iterator[tuple[Expected, float]]:
    """Yield the moves of a span of a toolpath, each with the length of it that is made."""
    for at in range(span.index, span.last + 1):
        begin = span.share if at == span.index else 0.0
        end = span.last_share if at == span.last else 1.0
        length = (end - begin) * path[at].length
        if length > NO_LENGTH:
            yield path[at], length


def seconds_of(parts) -> float:
    """Return the time that lengths of moves take at their feeds, 0 if one is not known."""
    found = [60.0 * length / move.feed if move.feed else 0.0 for move, length in parts]
    return sum(found) if all(found) else 0.0
