# SPDX-License-Identifier: GPL-2.0-or-later
"""The ways of the tool's centre in a polar section, in the contour's plane, with their heights.

What the cutter does in the air is no gouge: above the part's face, which is the program's Z0 if
the contour is cut below that; else above the highest level at which the contour is cut.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C, X, Z
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.contour_distance import Shape
from g12.tools.verify.wanted_contour import Element, Section

SAME_LEVEL = 1e-3


class Way(NamedTuple):
    """A way of the tool's centre: points of the plane, complex, and their heights."""

    points: np.ndarray
    heights: np.ndarray


class Plane:
    """Turns machine positions into points of the contour's plane; ``face`` is the program's Z0."""

    def __init__(self, section: Section, first: Move) -> None:
        self._shift = first.start[X] - section.x
        self._angle = first.start[C]
        self.face = first.start[Z] - section.z

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        angle = np.radians(positions[:, C] - self._angle)
        return (positions[:, X] - self._shift) * np.exp(1j * angle)

    def of_part(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return X (radius), C and Z in the plane of a point of the part."""
        radius, angle = math.hypot(*point[:2]), math.atan2(point[1], point[0])
        there = cmath.rect(radius - self._shift, angle - math.radians(self._angle))
        return there.real, there.imag, point[2]

    def way(self, index: int, path: Track, real: Followed | None) -> Way:
        """Return the tool centre's way during a move: emitted, or as it was."""
        whole = path.positions[path.vertices(index)]
        positions = whole if real is None else real.positions[real.during(index)]
        return Way(self.points(positions), positions[:, Z])


def goes_across(move: Move) -> bool:
    """Tell whether a move changes X or C."""
    return move.start[X] != move.end[X] or move.start[C] != move.end[C]


class Ways:
    """The tool centre's ways during a section, each with the line of its block, and plunges."""

    def __init__(self, ways: Iterable[tuple[int, Way]], plunges: Way, face: float) -> None:
        self._ways: dict[int, list[Way]] = {}
        self._plunges = plunges
        self._face = face
        self._shapes: dict[float, Shape] = {}
        for line, way in ways:
            if len(way.points) > 1:
                self._ways.setdefault(line, []).append(way)

    def of(self, line: int) -> list[np.ndarray]:
        """Return the ways of a line, as points."""
        return [way.points for way in self._ways.get(line, [])]

    def level(self, run: Sequence[Element]) -> float:
        """Return the highest level at which a contour is cut: below the face, if it is anywhere."""
        lines = {element.line for element in run}
        ways = (way for line in lines for way in self._ways.get(line, []))
        heights = np.concatenate([way.heights for way in ways])
        below = heights[heights < self._face - SAME_LEVEL]
        return float(max(below if len(below) else heights)) + SAME_LEVEL

    def solid(self, run: Sequence[Element]) -> float:
        """Return the height below which there is material about a contour."""
        level = self.level(run)
        return max(level, self._face - SAME_LEVEL) if level < self._face else level

    def distances(self, points: np.ndarray, level: float) -> np.ndarray:
        """Return how far points are from the ways that lie not above a level, plunges included."""
        away = self.below(level).distances(points)
        down = self._plunges.points[self._plunges.heights <= level]
        return np.minimum.reduce([away, *(np.abs(points - plunge) for plunge in np.unique(down))])

    def below(self, level: float) -> Shape:
        """Return the ways that lie not above a level, to measure distances from."""
        if level not in self._shapes:
            every = [way for ways in self._ways.values() for way in ways]
            self._shapes[level] = shape_of_ways(every, level)
        return self._shapes[level]


def ways_of(
    plane: Plane,
    cutting: Sequence[int],
    moves: Sequence[Move],
    path: Track,
    real: Followed | None,
) -> Ways:
    """Return the ways of moves at feed, given by their indices."""
    across = [index for index in cutting if goes_across(moves[index])]
    ways = (
        (block, joined([plane.way(index, path, real) for index in stretch]))
        for block, stretch in groupby(across, key=lambda index: moves[index].block)
    )
    downward = [plane.way(index, path, real) for index in cutting if index not in set(across)]
    plunges = [Way(way.points[-1:], way.heights[-1:]) for way in downward]
    return Ways(ways, connected(plunges), plane.face)


def connected(ways: Sequence[Way]) -> Way:
    """Return ways one behind the other."""
    nothing = (np.zeros(0, complex), np.zeros(0))
    return Way(*(np.concatenate(column) for column in zip(nothing, *ways)))


def joined(ways: Sequence[Way]) -> Way:
    """Return the ways of moves that follow each other as one, no point twice in a row."""
    points, heights = connected(ways)
    kept = np.append(True, np.abs(np.diff(points)) > 0.0)[: len(points)]
    return Way(points[kept], heights[kept])


def shape_of_ways(ways: Sequence[Way], level: float) -> Shape:
    """Return polylines as a shape, as far as they lie not above a level."""
    return Shape(
        [
            Element(0, start, end, 0, False, 0.0)
            for points, heights in ways
            for start, end, low in zip(points, points[1:], np.minimum(heights[:-1], heights[1:]))
            if low <= level
        ]
    )
