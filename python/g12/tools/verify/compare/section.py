# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's moves, or those of a run, laid along the toolpath that its words ask for.

All are points of the contour's plane with their heights, lengths in mm: `section_plane.Plane` makes
them of machine positions. The feed of a segment is what it makes of the toolpath in the time that
its F gives it: how far the segment itself goes off the toolpath is not asked.
"""

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C, X, Y, Z
from g12.tools.path.surface import Surface
from g12.tools.path.track import Track, feed_length, rate
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.compare.path import (
    OFF,
    Laid,
    Made,
    PathDifference,
    Point,
    Span,
    judge_path,
    lay,
)
from g12.tools.verify.expected.compensated import ContourStep
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import FEED, JOINT


class Plane:
    """Turns machine positions into points of a polar contour's plane.

    ``axes`` are those that move the tool across the plane, ``third`` is the one at right angles to
    it, and ``base`` where the program has its 0.
    """

    axes: tuple[int, ...] = (X, Y, C)
    third = Z

    def __init__(self, section: SectionContour, first: Move) -> None:
        self._centre = x0_of(section, first)
        self._angle = first.start[C]
        self.base = first.start[Z] - section.height

    @property
    def face(self) -> float:
        """The level of the part's face, or of a cylinder's surface, in machine coordinates."""
        return self.base

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        angle = np.radians(positions[:, C] - self._angle)
        return (positions[:, X] - self._centre + 1j * positions[:, Y]) * np.exp(1j * angle)

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """Return how far points of the plane are from the spindle's centre."""
        return np.abs(points)

    def of_part(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return X (radius), C and Z in the plane of a point of the part."""
        there = complex(*point[:2]) * cmath.rect(1.0, -math.radians(self._angle))
        return there.real, there.imag, point[2]

    def words(self, at: Point, diameters: bool) -> tuple[tuple[str, float | str], ...]:
        """Return a point and its level as a program writes it: letters with mm, or with text."""
        (point, level), factor = at, 2 if diameters else 1
        return ("X", factor * point.real), ("C", point.imag), ("Z", level)

    def place(self, at: Point) -> tuple[float, float, float]:
        """Return a point and its level as a point of the part."""
        there = self.on_part(at[0])
        return there.real, there.imag, at[1] + self.base

    def on_part(self, points: np.ndarray) -> np.ndarray:
        """Return points (complex) of the contour as points (complex) of the part."""
        return points * cmath.rect(1.0, math.radians(self._angle))


class FacePlane(Plane):
    """Turns machine positions into points of a program's own plane: X0, Z0 and C0 are its zero."""

    def __init__(self, x: float, z: float, c: float) -> None:
        self._centre, self.base, self._angle = x, z, c


class SurfacePlane(Plane):
    """Turns machine positions into points of a cylinder's unrolled surface.

    To the right is the way round it, Z upwards.
    """

    axes, third = (C, Z), X

    def __init__(self, section: SectionContour, first: Move) -> None:
        self._part = Surface(turning=True, radius=section.surface)
        self._shift = complex(*self._part.points(first.start)[0, :2]) - section.start
        self.base = first.start[X] - section.height

    @property
    def face(self) -> float:
        """The level of the surface in machine coordinates."""
        return self.base + self._part.radius

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        points = self._part.points(positions)
        return points[:, 0] + 1j * points[:, 1] - self._shift

    def words(self, at: Point, diameters: bool) -> tuple[tuple[str, float | str], ...]:
        """Return a point and its level as a program writes it; C is an angle."""
        (point, level), factor = at, 2 if diameters else 1
        angle = plain(math.degrees(point.real / self._part.radius), 3)
        return ("X", factor * level), ("C", angle), ("Z", point.imag)

    def on_part(self, points: np.ndarray) -> np.ndarray:
        """Return points (complex) of the contour as points (complex) of the surface."""
        return points + self._shift

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """Return where points of the plane are along Z."""
        return points.imag

    def of_part(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return X (radius), C in degrees and Z of a point of the unrolled surface."""
        there = complex(*point[:2]) - self._shift
        x = point[2] - self.base
        return x, math.degrees(there.real / self._part.radius), there.imag


def x0_of(section: SectionContour, first: Move) -> float:
    """Return where X0, the spindle's axis, is for a polar section, in machine coordinates."""
    return first.start[X] - section.start.real


def plane_of(section: SectionContour, first: Move) -> Plane:
    """Return the plane of a section's contour; ``first`` is its first move."""
    return (SurfacePlane if section.surface else Plane)(section, first)


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
) -> Iterator[Finding]:
    """Yield where it is off the toolpath, and the first feed that is not the words'.

    ``diameters``: X words are; ``slower`` are the moves that may be slower: see ``feed_off``;
    ``line`` is that of a move that the words do not ask for.
    """

    def words(at: Point) -> Sequence[tuple[str, float | str]]:
        return plane.words(at, diameters)

    yield from judge_path(found.laid, line, plane.place, words)
    off = feed_off(found, moves, slower)
    if off:
        end = off.expected.point(1.0)
        values = {"what": off.expected.name, "made": off.made, "expected": off.asked}
        values, place = {**values, "at": words(end)}, plane.place(end)
        yield Finding("feed", off.expected.line or line, values, place)


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
    for index, span in found.emitted.spans.items():
        parts = span_parts(found.expected, span)
        length, asked = sum(length for _, length in parts), seconds_of(parts)
        move = moves[index]
        speed = 0.0 if move.kind == "rapid" else rate(move, 0.0)
        given = speed and (move.length if move.kind == "arc" else feed_length(move)) / speed
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


def seconds_of(parts: Iterable[tuple[Expected, float]]) -> float:
    """Return the time that lengths of moves take at their feeds, 0 if one is not known."""
    found = [60.0 * length / move.feed if move.feed else 0.0 for move, length in parts]
    return sum(found) if all(found) else 0.0
