# SPDX-License-Identifier: GPL-2.0-or-later
"""The paths of the tool's centre in a section, in the contour's plane, with their heights.

What the cutter does in the air is no gouge: above the part's face, which is the program's Z0 (on a
cylinder its surface) if the contour is cut below that; else above the highest level at which the
contour is cut.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterable, Sequence
from itertools import chain, groupby
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C, X, Y, Z, spindle_angles
from g12.tools.path.surface import Surface
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.contour_distance import ContourDistances
from g12.tools.verify.wanted_contour import Element, SectionContour

SAME_LEVEL = 1e-3


class ToolPath(NamedTuple):
    """A path of the tool's centre: points of the plane, complex, and their heights."""

    points: np.ndarray
    heights: np.ndarray


class Plane:
    """Turns machine positions into points of a polar contour's plane.

    ``face`` is the program's Z0, ``axes`` are those that move the tool across the plane, and
    ``third`` is the one at right angles to it.
    """

    axes, third = (X, Y, C), Z

    def __init__(self, section: SectionContour, first: Move) -> None:
        self._centre = x0_of(section, first)
        self._angle = first.start[C]
        self.face = first.start[Z] - section.height

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        angle = np.radians(positions[:, C] - self._angle)
        return self.on_face(positions) * np.exp(1j * angle)

    def on_face(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions, seen from the face that C turns."""
        return positions[:, X] - self._centre + 1j * positions[:, Y]

    def angles(self, positions: np.ndarray, beside: float) -> np.ndarray:
        """Return where the C axis stands, degrees, for a tool ``beside`` the X line."""
        return spindle_angles(self.on_face(positions), positions[:, C], beside)

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """Return how far points of the plane are from the spindle's centre."""
        return np.abs(points)

    def of_part(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return X (radius), C and Z in the plane of a point of the part."""
        there = complex(*point[:2]) * cmath.rect(1.0, -math.radians(self._angle))
        return there.real, there.imag, point[2]

    def on_part(self, points: np.ndarray) -> np.ndarray:
        """Return points (complex) of the contour as points (complex) of the part."""
        return points * cmath.rect(1.0, math.radians(self._angle))

    def tool_path(self, index: int, path: Track, real: Followed | None) -> ToolPath:
        """Return the tool centre's path during a move: emitted, or as it was."""
        whole = path.positions[path.vertices(index)]
        positions = whole if real is None else real.positions[real.during(index)]
        return ToolPath(self.points(positions), positions[:, self.third])

    def goes_across(self, move: Move) -> bool:
        """Tell whether a move goes across the plane; the start of a full circle is its end."""
        return move.kind == "arc" or any(move.start[axis] != move.end[axis] for axis in self.axes)


class SurfacePlane(Plane):
    """Turns machine positions into points of a cylinder's unrolled surface.

    To the right is the way round it, Z upwards; ``face`` is X of the surface.
    """

    axes, third = (C, Z), X

    def __init__(self, section: SectionContour, first: Move) -> None:
        self._part = Surface(turning=True, radius=section.surface)
        self._shift = complex(*self._part.points(first.start)[0, :2]) - section.start
        self.face = first.start[X] - section.height + section.surface

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        points = self._part.points(positions)
        return points[:, 0] + 1j * points[:, 1] - self._shift

    def angles(self, positions: np.ndarray, beside: float) -> np.ndarray:
        """Return where the C axis stands at machine positions, degrees."""
        return positions[:, C]

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """Return where points of the plane are along Z."""
        return points.imag

    def of_part(self, point: Sequence[float]) -> tuple[float, float, float]:
        """Return X (radius), C in degrees and Z of a point of the unrolled surface."""
        there = complex(*point[:2]) - self._shift
        x = point[2] - self.face + self._part.radius
        return x, math.degrees(there.real / self._part.radius), there.imag


def x0_of(section: SectionContour, first: Move) -> float:
    """Return where X0, the spindle's axis, is for a polar section, in machine coordinates."""
    return first.start[X] - section.start.real


def plane_of(section: SectionContour, first: Move) -> Plane:
    """Return the plane of a section's contour; ``first`` is its first move."""
    return (SurfacePlane if section.surface else Plane)(section, first)


class ToolPaths:
    """The tool centre's paths during a section, each with the line of its block, and plunges.

    ``measured``: they are those of a run.
    """

    def __init__(
        self,
        tool_paths: Iterable[tuple[int, ToolPath]],
        plunges: ToolPath,
        face: float,
        sizes: Callable[[np.ndarray], np.ndarray] = np.abs,
        measured: bool = False,
    ) -> None:
        self._tool_paths: dict[int, list[ToolPath]] = {}
        self._plunges = plunges
        self._face = face
        self.sizes, self.measured = sizes, measured
        self._distances: dict[float, ContourDistances] = {}
        for line, tool_path in tool_paths:
            if len(tool_path.points) > 1:
                self._tool_paths.setdefault(line, []).append(tool_path)

    def of(self, line: int) -> list[np.ndarray]:
        """Return the paths of a line, as points."""
        return [tool_path.points for tool_path in self._tool_paths.get(line, [])]

    def level(self, stretch: Sequence[Element]) -> float:
        """Return the highest level at which a contour is cut: below the face, if it is anywhere."""
        lines = {element.line for element in stretch}
        tool_paths = (tool_path for line in lines for tool_path in self._tool_paths.get(line, []))
        heights = np.concatenate([tool_path.heights for tool_path in tool_paths])
        below = heights[heights < self._face - SAME_LEVEL]
        return float(max(below if len(below) else heights)) + SAME_LEVEL

    def solid(self, stretch: Sequence[Element]) -> float:
        """Return the height below which there is material about a contour."""
        level = self.level(stretch)
        return max(level, self._face - SAME_LEVEL) if level < self._face else level

    def distances(self, points: np.ndarray, level: float) -> np.ndarray:
        """Return how far points are from the paths that lie not above a level, plunges included."""
        away = self.below(level).distances(points)
        down = self._plunges.points[self._plunges.heights <= level]
        return np.minimum.reduce([away, *(np.abs(points - plunge) for plunge in np.unique(down))])

    def below(self, level: float) -> ContourDistances:
        """Return the paths that lie not above a level, to measure distances from."""
        if level not in self._distances:
            every = chain.from_iterable(self._tool_paths.values())
            self._distances[level] = distances_to(every, level)
        return self._distances[level]


def tool_paths_of(
    plane: Plane,
    cutting: Sequence[int],
    moves: Sequence[Move],
    path: Track,
    real: Followed | None,
) -> ToolPaths:
    """Return the paths of moves at feed, given by their indices."""
    across = [index for index in cutting if plane.goes_across(moves[index])]
    down = sorted(set(cutting) - set(across))
    tool_paths = (
        (line, as_one_path([plane.tool_path(index, path, real) for index in stretch]))
        for line, stretch in groupby(across, key=lambda index: moves[index].line)
    )
    downward = [plane.tool_path(index, path, real) for index in down]
    plunges = [ToolPath(tool_path.points[-1:], tool_path.heights[-1:]) for tool_path in downward]
    return ToolPaths(tool_paths, connected(plunges), plane.face, plane.sizes, real is not None)


def connected(tool_paths: Sequence[ToolPath]) -> ToolPath:
    """Return paths one behind the other."""
    nothing = (np.zeros(0, complex), np.zeros(0))
    return ToolPath(*(np.concatenate(column) for column in zip(nothing, *tool_paths)))


def as_one_path(tool_paths: Sequence[ToolPath]) -> ToolPath:
    """Return the paths of moves that follow each other as one, no point twice in a row."""
    points, heights = connected(tool_paths)
    kept = np.append(True, np.abs(np.diff(points)) > 0.0)[: len(points)]
    return ToolPath(points[kept], heights[kept])


def distances_to(tool_paths: Iterable[ToolPath], level: float) -> ContourDistances:
    """Return polylines to measure distances from, as far as they lie not above a level."""
    return ContourDistances(
        [
            Element(0, start, end, 0, False, 0.0)
            for points, heights in tool_paths
            for start, end, low in zip(points, points[1:], np.minimum(heights[:-1], heights[1:]))
            if low <= level
        ]
    )
