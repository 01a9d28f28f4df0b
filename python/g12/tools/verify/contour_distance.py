# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs as arrays, for distances to many points at once; points are complex, in mm."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from g12.tools.verify.wanted_contour import Element

STEP = 0.05  # mm between points of the contour that are looked at
CHUNK = 256
SAME = 1e-7


class Shape:
    """Elements of a contour as arrays, for distances to many points at once."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self.elements = [element for element in elements if element.length > SAME]
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
        return np.abs(points - self.nearest(points)[0])

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contour's point next to each point, and the side: above 0 is left of it."""
        found, side = np.empty(len(points), complex), np.empty(len(points))
        for first in range(0, len(points), CHUNK):
            part = slice(first, first + CHUNK)
            found[part], side[part] = self._nearest(points[part])
        return found, side

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        near = self._near(points)
        nearest = np.where(
            self.arc[near], self._on_arcs(points, near), self._on_lines(points, near)
        )
        away = np.abs(points[:, None] - nearest)
        first = away.argmin(axis=1)[:, None]
        tied = away <= np.take_along_axis(away, first, axis=1) + SAME
        side = np.where(tied, self._sides(points, nearest, near), 0.0).sum(axis=1)
        return np.take_along_axis(nearest, first, axis=1)[:, 0], side

    def _near(self, points: np.ndarray) -> np.ndarray:
        """Return the elements that can be nearest to any of some points close together."""
        middle = (points[0] + points[-1]) / 2
        spread = np.abs(points - middle).max()
        between = np.abs(self.middle - middle)
        inner = np.maximum(0.0, between - self.reach) - spread
        farthest = (between + self.reach).min() + spread
        return np.flatnonzero(np.where(self.arc, 0.0, inner) <= farthest)

    def _on_lines(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        start, along = self.start[near], self.end[near] - self.start[near]
        square = np.maximum(np.abs(along) ** 2, 1e-30)
        share = ((points[:, None] - start) * along.conj()).real / square
        return start + along * np.clip(share, 0.0, 1.0)

    def _on_arcs(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        centre, start = self.centre[near], self.start[near] - self.centre[near]
        sweep = self.sweep[near]
        way = points[:, None] - centre
        turn = np.angle(way / np.where(start == 0, 1.0, start)) * np.sign(sweep)
        on = np.where(turn < 0, turn + 2 * np.pi, turn) <= np.abs(sweep)
        away = np.abs(way)
        towards = np.where(away > SAME, way / np.maximum(away, SAME), start / np.abs(start + 1e-30))
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
