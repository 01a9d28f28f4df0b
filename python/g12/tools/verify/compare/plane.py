# SPDX-License-Identifier: GPL-2.0-or-later
"""The plane of a contour: the face of a part, or the unrolled surface of a cylinder.

Its points are complex, its levels are square to it; mm.
"""

import cmath
import math
from typing import NamedTuple

import numpy as np

from g12.tools.path.part import C, X, Z
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import Point


class Plane(NamedTuple):
    """A plane on a part, whose points are those of `Part.points` or `Surface.points`.

    ``zero`` is its zero on the part, ``axis`` the direction of its first axis there (of length 1),
    ``base`` the part's level where the program has its 0. ``surface`` is the radius of the cylinder
    that it unrolls, 0 of a face: to the right is the direction around it, Z upwards.
    """

    zero: complex
    axis: complex
    base: float
    surface: float = 0.0

    @property
    def face(self) -> float:
        """The level of the part's face, or of the cylinder's surface, in machine coordinates."""
        return self.base + self.surface

    def points(self, on_part: np.ndarray) -> np.ndarray:
        """Return the points (complex) of points (n, 3) of the part."""
        return (on_part[:, 0] + 1j * on_part[:, 1] - self.zero) * self.axis.conjugate()

    def on_part(self, points: np.ndarray) -> np.ndarray:
        """Return points as points (complex) of the part."""
        return points * self.axis + self.zero

    def place(self, at: Point) -> tuple[float, float, float]:
        """Return a point and its level as a point of the part."""
        there = complex(self.on_part(at[0]))
        return there.real, there.imag, at[1] + self.base

    def words(self, at: Point, diameters: bool) -> tuple[tuple[str, float | str], ...]:
        """Return a point and its level as a program writes it: letters with mm, or with text."""
        (point, level), factor = at, 2 if diameters else 1
        if not self.surface:
            return ("X", factor * point.real), ("C", point.imag), ("Z", level)
        angle = plain(math.degrees(point.real / self.surface), 3)
        return ("X", factor * level), ("C", angle), ("Z", point.imag)

    def sizes(self, points: np.ndarray) -> np.ndarray:
        """Return how far points are from the spindle's centre, on a cylinder where along Z."""
        return points.imag if self.surface else np.abs(points)


def x0_of(section: SectionContour, first: Move) -> float:
    """Return where X0, the spindle's axis, is for a section, in machine coordinates."""
    return first.start[X] - (section.height if section.surface else section.start.real)


def plane_of(section: SectionContour, first: Move) -> Plane:
    """Return the plane of a section's contour; ``first`` is its first move."""
    base, angle = first.start[section.third] - section.height, math.radians(first.start[C])
    if not section.surface:
        return turned_plane(angle, base)
    begin = complex(angle * section.surface, first.start[Z])
    return Plane(begin - section.start, 1 + 0j, base, section.surface)


def turned_plane(angle: float, base: float) -> Plane:
    """Return a plane on the face that is turned with the part by an angle (radians)."""
    return Plane(0j, cmath.rect(1.0, angle), base)
