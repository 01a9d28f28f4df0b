# SPDX-License-Identifier: GPL-2.0-or-later
"""The way of a shape's tool over the face, as emitted or as it was in a run.

Lengths are millimetres, heights those above the face.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import Z
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.shapes.wanted_shape import ShapeAsked

SAME_LEVEL = 1e-3
TINY = 1e-6


class ShapeWay(NamedTuple):
    """The feed moves of a shape, by indices, and where the tool's centre is along them."""

    asked: ShapeAsked
    moves: Sequence[Move]
    path: Track
    real: Followed | None

    def points(self, index: int) -> np.ndarray:
        """Return the tool centre's points (complex) along a move, as it was, else as emitted.

        A run has no sample of a very short one.
        """
        found = self.path.points[self.path.vertices(index)]
        if self.real is not None:
            sampled = self.real.points[self.real.during(index)]
            found = sampled if len(sampled) else found
        return found[:, 0] + 1j * found[:, 1]

    def along(self, indices: Sequence[int]) -> list[np.ndarray]:
        """Return points (complex) along moves, one array for those that follow each other."""
        gaps = [at for at in range(1, len(indices)) if indices[at] != indices[at - 1] + 1]
        runs = (indices[a:b] for a, b in zip([0, *gaps], [*gaps, len(indices)]))
        return [np.concatenate([self.points(index) for index in run]) for run in runs if run]

    def heights(self, index: int) -> tuple[float, float]:
        """Return where a move begins and ends above the face."""
        move, face = self.moves[index], self.asked.zero[1]
        return move.start[Z] - face, move.end[Z] - face

    @property
    def fed(self) -> list[int]:
        """The moves at a feed."""
        return [index for index in self.asked.moves if self.moves[index].kind != "rapid"]

    @property
    def falling(self) -> list[int]:
        """The moves at a feed that go down, or up."""
        return [i for i in self.fed if abs(np.subtract(*self.heights(i))) > TINY]

    def at(self, level: float) -> list[int]:
        """Return the moves that go across at a height."""
        runs = (run for height, run in self.flat() if abs(height - level) < SAME_LEVEL)
        return [index for run in runs for index in run]

    def flat(self) -> list[tuple[float, list[int]]]:
        """Return the heights below the face at which the tool goes across, and the moves of each.

        They come in the order of the moves; a height may come more than once.
        """
        found: list[tuple[float, list[int]]] = []
        for index in self.fed:
            start, end = self.heights(index)
            if end > -SAME_LEVEL or abs(start - end) > TINY or self.path.part_length(index) < TINY:
                continue
            if not found or abs(found[-1][0] - end) > SAME_LEVEL:
                found.append((end, []))
            found[-1][1].append(index)
        return found

    def turned(self, indices: Sequence[int]) -> np.ndarray:
        """Return the angles, radians, that moves go about the shape's centre from point to point.

        Only those where the cutter touches a standing shape's bar count.
        """
        form = self.asked.form
        reach = math.inf if form.inside else form.stock + self.asked.cutter
        found = [np.zeros(0)]
        for line in self.along(indices):
            touching = (np.abs(line[1:]) < reach) & (np.abs(line[:-1]) < reach)
            around = line - form.centre
            found.append(np.angle(around[1:] * around[:-1].conj())[touching])
        return np.concatenate(found)

    def crossings(self, indices: Sequence[int], direction: complex) -> list[float]:
        """Return how far from the centre moves cross a ray from it, in their order."""
        found: list[float] = []
        for line in self.along(indices):
            seen = (line - self.asked.form.centre) * direction.conjugate()
            before, after = seen[:-1], seen[1:]
            crossed = (before.imag < 0.0) != (after.imag < 0.0)
            before, after = before[crossed], after[crossed]
            share = before.imag / (before.imag - after.imag)
            radii = before.real + share * (after.real - before.real)
            found += radii[radii > 0.0].tolist()
        return found

    def times_along(self, indices: Sequence[int], tolerance: float) -> int:
        """Return how often moves go along what they reach at last."""
        counts = []
        inside = self.asked.form.inside
        for direction in self.asked.form.rays:
            radii = np.array(self.crossings(indices, direction))
            last = radii.max(initial=0.0) if inside else radii.min(initial=math.inf)
            counts.append(int((np.abs(radii - last) < 2 * tolerance).sum()))
        return min(counts)
