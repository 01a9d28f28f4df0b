# SPDX-License-Identifier: GPL-2.0-or-later
"""The width of a contour between its parallel sides, as a caliper measures it.

Points are complex, lengths mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from g12.tools.verify.expected.contour import Element

PARALLEL = 1e-4  # radians between parallel sides
SAME = 1e-7  # mm


Side = tuple[Element, np.ndarray]  # a straight side, and what the cutter reaches along it


def across_flats(contour: Sequence[Side]) -> list[tuple[float, float]]:
    """Return the width, programmed and reached, between the outermost sides of each direction."""
    found = []
    for (forward, one), (backward, other) in parallel_sides(contour):
        outward = forward.normal(0.0)
        if len(one) and len(other):
            asked = abs(along(outward, forward.start - backward.start))
            reached = along(outward, one).mean() - along(outward, other).mean()
            found.append((float(asked), float(abs(reached))))
    return sorted(found, reverse=True)


def parallel_sides(contour: Sequence[Side]) -> Iterator[tuple[Side, Side]]:
    """Yield the two sides farthest apart of each direction in which there are two."""
    for sides in groups_by_direction(contour):
        outward = sides[0][0].normal(0.0)
        order = sorted(sides, key=lambda side: along(outward, side[0].start))
        if along(order[0][0].normal(0.0), order[-1][0].normal(0.0)) < 0.0:
            yield order[-1], order[0]


def groups_by_direction(contour: Sequence[Side]) -> list[list[Side]]:
    """Return the straight sides of a contour, those that are parallel together."""
    lines = [side for side in contour if side[0].centre is None and side[0].length > SAME]
    angles = np.array([np.angle((side.end - side.start) ** 2) / 2 for side, _ in lines])
    groups: list[list[Side]] = []
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
