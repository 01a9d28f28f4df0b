# SPDX-License-Identifier: GPL-2.0-or-later
"""The part as its unrolled surface, for a tool that points at a turning part's axis.

The coordinates are the length around it, the length along its axis, and the height above the axis.
Seen from outside, with the axis upwards, the length around grows to the right.
"""

import math
from dataclasses import dataclass

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.part import Part
from g12.tools.preview.moves import Move

LONGEST_SEGMENT, LEAST_SEGMENTS, MOST_SEGMENTS = 0.5, 4, 5000  # mm, of a move


@dataclass(frozen=True)
class Surface(Part):
    """The unrolled surface of a cylinder of ``radius``, mm.

    A move is straight there; points between its ends are for measuring. ``sense`` is 1 where the
    length around grows with the angle.
    """

    radius: float = 0.0
    sense: float = 1.0

    @property
    def letters(self) -> str:
        return "".join(AXIS_LETTERS[axis] for axis in self.roles[:3])

    def points(self, positions: np.ndarray) -> np.ndarray:
        turn, along, height, _ = self.roles
        positions = np.atleast_2d(positions)
        around = np.radians(positions[:, turn]) * self.radius * self.sense
        return np.stack([around, positions[:, along], positions[:, height]], axis=1)

    def _segments(self, move: Move, chord_error: float) -> int:
        if move.kind == "arc":
            return super()._segments(move, chord_error)
        start, end = self.points(np.array([move.start, move.end]))
        segments = math.ceil(np.linalg.norm(end - start) / LONGEST_SEGMENT)
        return min(max(LEAST_SEGMENTS, segments), MOST_SEGMENTS)
