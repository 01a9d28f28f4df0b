# SPDX-License-Identifier: GPL-2.0-or-later
"""The plane of a section's contour: what machine positions and points are in it."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from g12.tools.path.part import C, X, Y, Z, spindle_angles
from g12.tools.path.surface import Surface
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.compare.path import Point
from g12.tools.verify.expected.contour import SectionContour


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

    def goes_across(self, move: Move) -> bool:
        """Tell whether a move goes across the plane; the start of a full circle is its end."""
        return move.kind == "arc" or any(move.start[axis] != move.end[axis] for axis in self.axes)


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

    def angles(self, positions: np.ndarray, beside: float) -> np.ndarray:
        """Return where the C axis stands at machine positions, degrees."""
        return positions[:, C]

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
