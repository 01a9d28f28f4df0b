# SPDX-License-Identifier: GPL-2.0-or-later
"""A contour whose end meets its beginning: what of it is the shape, and what leads to it.

Points are complex, lengths mm.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from shapely.geometry import LineString
from shapely.ops import nearest_points

from g12.tools.verify.expected.contour import Element

STEP = 0.05  # mm between points of an arc
LEADS = 3  # elements at either end of a contour that may be there to lead in or out
MEETS = 1e-3


def trimmed(stretch: Sequence[Element]) -> list[Element]:
    """Return a contour without what sticks out where its end meets its beginning.

    Elements that stick out as a whole are there with no length.
    """
    first, last = closing(stretch)
    ends = np.concatenate([[0.0], np.cumsum([element.length for element in stretch])])
    return [
        element.part(*(np.clip((first, last), start, end) - start) / (end - start))
        for element, start, end in zip(stretch, ends, ends[1:])
    ]


def closing(stretch: Sequence[Element]) -> tuple[float, float]:
    """Return the lengths along a contour between which it is closed; else its whole length."""
    ends = np.concatenate([[0.0], np.cumsum([element.length for element in stretch])])
    count = len(stretch)
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        if j > i:
            # Neighbours meet where they join: the later half of the second is looked at.
            skipped = 0.5 if j == i + 1 else 0.0
            one, other = as_line(stretch[i]), as_line(stretch[j].part(skipped, 1.0))
            if one.distance(other) < MEETS:
                here, there = nearest_points(one, other)
                passed = ends[j] + skipped * stretch[j].length
                return ends[i] + one.project(here), passed + other.project(there)
    return 0.0, ends[-1]


def as_line(element: Element) -> LineString:
    """Return an element as a polyline."""
    return LineString([(point.real, point.imag) for point in as_points(element)])


def is_closed(shape: Sequence[Element]) -> bool:
    """Tell whether a trimmed contour ends where it begins."""
    return abs(shape[0].start - shape[-1].end) < 2 * MEETS


def as_points(element: Element) -> np.ndarray:
    """Return points along an element, its ends included."""
    count = max(1, int(element.length / STEP)) if element.centre is not None else 1
    return np.array([element.point(index / count) for index in range(count + 1)])
