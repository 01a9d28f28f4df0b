# SPDX-License-Identifier: GPL-2.0-or-later
"""The width of a contour between its parallel sides, as a caliper measures it.

Points are complex, lengths mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from g12.tools.verify.contour_distance import SAME
from g12.tools.verify.wanted_contour import Element

PARALLEL = 1e-4  # radians between parallel sides
ON_SIDE = 1e-6  # mm


def across_flats(
    contour: Sequence[Element], nearest: np.ndarray, wall: np.ndarray
) -> list[tuple[float, float]]:
    """Return the width, programmed and reached, between the outermost sides of each direction.

    ``wall`` are points that the cutter reaches, ``nearest`` those of the contour next to them.
    """
    found = []
    for forward, backward in parallel_sides(contour):
        outward = forward.normal(0.0)
        sides = (points_of(side, nearest, wall) for side in (forward, backward))
        one, other = (along(outward, points) for points in sides)
        if len(one) and len(other):
            asked = abs(along(outward, forward.start - backward.start))
            found.append((float(asked), float(abs(one.mean() - other.mean()))))
    return sorted(found, reverse=True)


def parallel_sides(contour: Sequence[Element]) -> Iterator[tuple[Element, Element]]:
    """Yield the two sides farthest apart of each direction in which there are two."""
    for sides in groups_by_direction(contour):
        outward = sides[0].normal(0.0)
        order = sorted(sides, key=lambda side: along(outward, side.start))
        if along(order[0].normal(0.0), order[-1].normal(0.0)) < 0.0:
            yield order[-1], order[0]


def groups_by_direction(contour: Sequence[Element]) -> list[list[Element]]:
    """Return the straight sides of a contour, those that are parallel together."""
    lines = [side for side in contour if side.centre is None and side.length > SAME]
    angles = np.array([np.angle((side.end - side.start) ** 2) / 2 for side in lines])
    groups: list[list[Element]] = []
    last = -math.inf
    for index in np.argsort(angles):
        if angles[index] - last > PARALLEL:
            groups.append([])
        groups[-1].append(lines[index])
        last = angles[index]
    if len(groups) > 1 and angles.min() + math.pi - last < PARALLEL:
        groups[0] += groups.pop()
    return groups


def along(direction: complex, points: np.ndarray | complex) -> np.ndarray | float:
    """Return how far points lie in a direction of length 1."""
    return (np.conj(direction) * points).real


def points_of(side: Element, nearest: np.ndarray, wall: np.ndarray) -> np.ndarray:
    """Return the points of the wall next to a side."""
    outward, forward = side.normal(0.0), (side.end - side.start) / side.length
    off, on = along(outward, nearest - side.start), along(forward, nearest - side.start)
    return wall[(np.abs(off) < ON_SIDE) & (on > 0.0) & (on < side.length)]
