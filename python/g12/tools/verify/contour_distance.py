# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs as arrays, for distances to many points at once; points are complex, in mm."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from g12.tools.path.nearest import on_segments
from g12.tools.verify.wanted_contour import Element

STEP = 0.05  # mm between points of the contour that are looked at
CHUNK = 64  # points that lie together have few elements near them
SAME = 1e-7
PLACES = 6  # decimals of mm: what is equal to them is the same element, cut once more


class ContourDistances:
    """The elements of a contour, to measure the distance of many points at once.

    What is cut in several laps is there once.
    """

    def __init__(self, elements: Sequence[Element]) -> None:
        self.elements = each_once([element for element in elements if element.length > SAME])
        self.start = np.array([element.start for element in self.elements])
        self.end = np.array([element.end for element in self.elements])
        arcs = [element.centre is not None for element in self.elements]
        self.arc = np.array(arcs, bool)
        self.centre = np.array([element.centre or 0.0 for element in self.elements], complex)
        self.sweep = np.array([element.sweep for element in self.elements])
        radius = np.where(self.arc, np.abs(self.start - self.centre), 0.0)
        middle = np.where(self.arc, self.centre, (self.start + self.end) / 2)
        self.middle = middle
        self.reach = np.where(self.arc, radius, np.abs(self.end - self.start) / 2)

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Points along the contour, the length each stands for, the directions to its left."""
        points, lengths, normals = [], [], []
        for element in self.elements:
            count = max(2, int(element.length / STEP))
            shares = (np.arange(count) + 0.5) / count
            points += [element.point(share) for share in shares]
            normals += [element.normal(share) for share in shares]
            lengths += [element.length / count] * count
        return np.array(points, complex), np.array(lengths), np.array(normals, complex)

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return the distance of points to the contour."""
        found = np.empty(len(points))
        for part in chunks(points):
            nearest = self._next_to(points[part], self._elements_near(points[part]))
            found[part] = np.abs(points[part, None] - nearest).min(axis=1)
        return found

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contour's point next to each point, and the side: above 0 is left of it."""
        found, side = np.empty(len(points), complex), np.empty(len(points))
        for part in chunks(points):
            found[part], side[part] = self._nearest(points[part])
        return found, side

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        near = self._elements_near(points)
        nearest = self._next_to(points, near)
        away = np.abs(points[:, None] - nearest)
        first = away.argmin(axis=1)[:, None]
        tied = away <= np.take_along_axis(away, first, axis=1) + SAME
        side = np.where(tied, self._sides(points, nearest, near), 0.0).sum(axis=1)
        return np.take_along_axis(nearest, first, axis=1)[:, 0], side

    def _next_to(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        """Return the points (n, m) of some elements that are next to points."""
        arc, found = self.arc[near], np.empty((len(points), len(near)), complex)
        for those, on in ((arc, self._on_arcs), (~arc, self._on_lines)):
            if those.any():
                found[:, those] = on(points, near[those])
        return found

    def _elements_near(self, points: np.ndarray) -> np.ndarray:
        """Return the elements that can be nearest to any of some points close together."""
        middle = (points[0] + points[-1]) / 2
        spread = np.abs(points - middle).max()
        between = np.abs(self.middle - middle)
        inner = np.maximum(0.0, between - self.reach) - spread
        farthest = (between + self.reach).min() + spread
        return np.flatnonzero(np.where(self.arc, 0.0, inner) <= farthest)

    def _on_lines(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        start, along = self.start[near], self.end[near] - self.start[near]
        found = on_segments(as_vectors(points)[:, None], as_vectors(start), as_vectors(along))
        return found.view(complex)[..., 0]

    def _on_arcs(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        centre, start = self.centre[near], self.start[near] - self.centre[near]
        sweep = self.sweep[near]
        from_centre = points[:, None] - centre
        turn = np.angle(from_centre / np.where(start == 0, 1.0, start)) * np.sign(sweep)
        on = np.where(turn < 0, turn + 2 * np.pi, turn) <= np.abs(sweep)
        away = np.abs(from_centre)
        outward = from_centre / np.maximum(away, SAME)
        towards = np.where(away > SAME, outward, start / np.abs(start + 1e-30))
        ring = centre + towards * np.abs(start)
        ends = np.stack(np.broadcast_arrays(self.start[near], self.end[near]))
        closer = np.abs(points[:, None] - ends[0]) < np.abs(points[:, None] - ends[1])
        return np.where(on, ring, np.where(closer, ends[0], ends[1]))

    def _sides(self, points: np.ndarray, nearest: np.ndarray, near: np.ndarray) -> np.ndarray:
        lines = self.end[near] - self.start[near]
        arcs = 1j * np.sign(self.sweep[near]) * (nearest - self.centre[near])
        along = np.where(self.arc[near], arcs, lines)
        along = along / np.maximum(np.abs(along), 1e-30)
        return (along.conj() * (points[:, None] - nearest)).imag


def chunks(points: np.ndarray) -> Iterator[slice]:
    """Yield the parts of points that are looked at together."""
    return (slice(first, first + CHUNK) for first in range(0, len(points), CHUNK))


def each_once(elements: Sequence[Element]) -> list[Element]:
    """Return elements without those that run where an earlier one did, in the same direction."""
    if len(elements) < 2:
        return list(elements)
    places = [(each.start, each.end, each.centre or 0.0, each.sweep) for each in elements]
    _, first = np.unique(np.round(np.array(places, complex), PLACES), axis=0, return_index=True)
    return [elements[index] for index in np.sort(first)]


def as_vectors(points: np.ndarray) -> np.ndarray:
    """Return complex points (n,) as vectors (n, 2)."""
    return np.ascontiguousarray(points).view(float).reshape(-1, 2)
