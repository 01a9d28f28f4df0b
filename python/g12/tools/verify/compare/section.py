# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's moves, or those of a run, laid along the toolpath that its words ask for.

All are points of the contour's plane with their heights, lengths in mm: `section_plane.Plane` makes
them of machine positions. The feed of a segment is what it makes of the toolpath in the time that
its F gives it: how far the segment itself goes off the toolpath is not asked.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import OFF, Laid, Made, PathDifference, Point, Span, lay
from g12.tools.verify.compare.path_judge import judge_path
from g12.tools.verify.compare.section_plane import Plane
from g12.tools.verify.expected.compensated import ContourStep
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import FEED, JOINT


class SectionPath(NamedTuple):
    """An expected toolpath, the section's moves laid along it, and the motion of a run, if any.

    ``elements`` are what the expected moves cut.
    """

    expected: list[Expected]
    elements: list[Element]
    emitted: Laid
    run: Laid | None = None

    @property
    def deviation(self) -> float:
        """The greatest distance from the toolpath, as far as it was followed; mm."""
        return max(laid.deviation for laid in (self.emitted, self.run) if laid)

    @property
    def laid(self) -> Laid:
        """What was laid: the moves if they differ or nothing ran, else the run."""
        return self.emitted if self.emitted.difference or not self.run else self.run

    @property
    def difference(self) -> PathDifference | None:
        """The first difference."""
        return self.laid.difference

    @property
    def off(self) -> float:
        """The greatest distance from where it should be, inf if part is missing; mm."""
        difference = self.difference
        if difference is None:
            return self.deviation
        return difference.size if difference.kind == OFF else math.inf


def lay_section(
    section: SectionContour,
    steps: Sequence[ContourStep],
    plane: Plane,
    moves: Sequence[Move],
    path: Track,
    allowed: tuple[float, float],
    real: Followed | None = None,
) -> SectionPath:
    """Lay a section's moves, and a run's motion, along its expected toolpath.

    ``allowed`` is how far off the moves may be, and the motion, which rounds corners.
    """
    expected, elements = [step.move for step in steps], [step.element for step in steps]
    own = range(section.at, section.end)
    segments = ((index, path.positions[path.vertices(index)]) for index in own)
    emitted = lay(expected, made_of(segments, moves, plane), allowed[0])
    if real is None or emitted.difference:
        return SectionPath(expected, elements, emitted)
    sampled = ((index, real.positions[real.during(index)]) for index in own)
    seen = [(index, positions) for index, positions in sampled if len(positions)]
    run = (replace(made, sampled=True) for made in made_of(seen, moves, plane))
    return SectionPath(expected, elements, emitted, lay(expected, run, allowed[1]))


def made_of(
    segments: Iterable[tuple[int, np.ndarray]], moves: Sequence[Move], plane: Plane
) -> Iterator[Made]:
    """Yield what was made: of each move its index and its machine positions (n, 9)."""
    for index, positions in segments:
        heights = positions[:, plane.third] - plane.base
        points = list(zip(plane.points(positions).tolist(), heights.tolist()))
        yield Made(index, points, rapid=moves[index].kind == "rapid")


def judge_toolpath(
    found: SectionPath,
    plane: Plane,
    diameters: bool,
    moves: Sequence[Move],
    slower: dict[int, float],
    line: int,
    file: str = "",
) -> Iterator[Finding]:
    """Yield where it is off the toolpath, and the first feed that is not the words'.

    ``diameters``: X words are; ``slower`` are the moves that may be slower: see ``feed_off``;
    ``line`` is that of a move that the words do not ask for.
    """

    def words(at: Point) -> Sequence[tuple[str, float | str]]:
        return plane.words(at, diameters)

    yield from judge_path(found.laid, line, file, plane.place, words)
    off = feed_off(found, moves, slower)
    if off:
        end = off.expected.point(1.0)
        values = {"what": off.expected.name, "made": off.made, "expected": off.asked}
        values, place = {**values, "at": words(end)}, plane.place(end)
        yield Finding("feed", off.expected.line or line, values, place, file)


@dataclass(frozen=True)
class OffFeed:
    """A move (index) whose feed along the toolpath is not the words'; mm/min."""

    index: int
    expected: Expected
    made: float
    asked: float


def feed_off(
    found: SectionPath, moves: Sequence[Move], slower: dict[int, float] | None = None
) -> OffFeed | None:
    """Return the first feed that is not the words'.

    ``slower`` tells by index of a move that may be slower, down to which share of its feed.
    """
    ends = np.cumsum([0.0, *(move.length for move in found.expected)])
    for index, span in found.emitted.spans.items():
        parts = span_parts(found.expected, span)
        length, asked = span_length(span, ends, found.expected), seconds_of(parts)
        given = seconds_given(moves[index])
        if not asked or not given or length < JOINT:
            continue
        least = (slower or {}).get(index, 1.0) * (1.0 - FEED)
        rounding = JOINT / length
        if not least - rounding <= asked / given <= 1.0 + FEED + rounding:
            feed = 60.0 * length / asked
            return OffFeed(index, parts[0][0], 60.0 * length / given, feed)
    return None


def span_parts(path: Sequence[Expected], span: Span) -> list[tuple[Expected, float]]:
    """Return the moves of a span of a toolpath, each with the length of it that is made."""
    found, share = [], span.share
    for at in range(span.index, span.last + 1):
        end = span.last_share if at == span.last else 1.0
        length = (end - share) * path[at].length
        if length > 0.0:
            found.append((path[at], length))
        share = 0.0
    return found


def span_length(span: Span, ends: np.ndarray, path: Sequence[Expected]) -> float:
    """Return the length of a span; ``ends`` are the lengths of the toolpath up to each move."""
    first, last = (
        ends[at] + share * path[at].length
        for at, share in ((span.index, span.share), (span.last, span.last_share))
    )
    return float(last - first)


def seconds_of(parts: Iterable[tuple[Expected, float]]) -> float:
    """Return the time that lengths of moves take at their feeds, 0 if one is not known."""
    found = [60.0 * length / move.feed if move.feed else 0.0 for move, length in parts]
    return sum(found) if all(found) else 0.0


def seconds_given(move: Move) -> float:
    """Return the time that a move's F gives it, whatever the axes can do; 0 of a rapid."""
    programmed = move.length if move.kind == "arc" else feed_length(move)
    speed = rate(move, 0.0)
    return programmed / speed if speed and move.kind != "rapid" else 0.0
