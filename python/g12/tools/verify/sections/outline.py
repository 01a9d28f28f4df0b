# SPDX-License-Identifier: GPL-2.0-or-later
"""A stretch of a contour with the tool on one side: its shape, and what leads to it.

Where its end meets its beginning it is closed, and what sticks out there is a lead. Points are
complex, lengths mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import groupby, product

import numpy as np
from shapely.geometry import LineString
from shapely.ops import nearest_points

from g12.geometry.curve import Curve, Line
from g12.tools.verify.expected.contour import Element, SectionContour

STEP = 0.05  # mm between points of an arc
LEADS = 3  # elements at either end of a contour that may be there to lead in or out
MEETS = 1e-3
LENGTHLESS = 1e-6


class Outline:
    """A stretch of elements with the tool on one ``side``: +1 is left, 0 on the contour.

    ``curves`` are the shape's, ``leads`` what sticks out of a closed one, ``depth`` is the lowest.
    """

    def __init__(self, stretch: Sequence[Element]) -> None:
        whole = [element.curve for element in stretch]
        self.side = stretch[0].side
        self.depth = min(element.depth for element in stretch)
        kept = shares_kept(whole) if self.side else [(0.0, 1.0)] * len(whole)
        self.curves = curve_portions(whole, kept)
        self.leads = curve_portions(whole, [(0.0, first) for first, _ in kept])
        self.leads += curve_portions(whole, [(last, 1.0) for _, last in kept])

    @cached_property
    def points(self) -> np.ndarray:
        """Points (complex) along the shape."""
        return np.concatenate([np.zeros(0), *map(drawn_points, self.curves)])

    @property
    def is_closed(self) -> bool:
        """Tell whether the shape ends where it begins."""
        return abs(self.curves[0].start - self.curves[-1].end) < 2 * MEETS

    @property
    def tool_is_inside(self) -> bool:
        """Tell whether the tool is inside of a closed shape."""
        area = (self.points.conj() * np.roll(self.points, -1)).imag.sum()
        return (area > 0.0) == (self.side > 0)


def stretches_of(section: SectionContour) -> list[list[Element]]:
    """Return a section's elements by side, those on which compensation is switched apart."""
    longer = (element for element in section.elements if element.length > LENGTHLESS)
    return [list(own) for _, own in groupby(longer, lambda each: (each.side, each.ramp))]


def outlines_of(section: SectionContour) -> list[Outline]:
    """Return the outlines of a section, ramps aside."""
    return [Outline(stretch) for stretch in stretches_of(section) if not stretch[0].ramp]


def curve_portions(curves: Sequence[Curve], shares: Sequence[tuple[float, float]]) -> list[Curve]:
    """Return the portions of curves between shares that have a length."""
    found = (curve.portion(*ends) for curve, ends in zip(curves, shares))
    return [portion for portion in found if portion.length > LENGTHLESS]


def shares_kept(curves: Sequence[Curve]) -> list[tuple[float, float]]:
    """Return between which shares each curve is part of the shape."""
    ends = np.cumsum([0.0, *(curve.length for curve in curves)])
    closed = np.array(closing(curves, ends))
    return [
        tuple((np.clip(closed, start, end) - start) / (end - start))
        for start, end in zip(ends, ends[1:])
    ]


def closing(curves: Sequence[Curve], ends: np.ndarray) -> tuple[float, float]:
    """Return the lengths along curves between which they are closed; else the whole length."""
    count = len(curves)
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        if j > i:
            # Neighbours meet where they join: the later half of the second is looked at.
            skipped = 0.5 if j == i + 1 else 0.0
            one, other = as_line(curves[i]), as_line(curves[j].portion(skipped, 1.0))
            if one.distance(other) < MEETS:
                here, there = nearest_points(one, other)
                passed = ends[j] + skipped * curves[j].length
                return ends[i] + one.project(here), passed + other.project(there)
    return 0.0, ends[-1]


def as_line(curve: Curve) -> LineString:
    """Return a curve as a polyline."""
    return LineString(vectors(drawn_points(curve)))


def drawn_points(curve: Curve) -> np.ndarray:
    """Return points along a curve, its ends included."""
    count = 1 if isinstance(curve, Line) else max(1, int(curve.length / STEP))
    return np.array([curve.point(index / count) for index in range(count + 1)])


def vectors(points: np.ndarray) -> list[tuple[float, float]]:
    """Return complex points as pairs."""
    return [(point.real, point.imag) for point in points]
