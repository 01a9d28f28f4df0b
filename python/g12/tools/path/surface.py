# SPDX-License-Identifier: GPL-2.0-or-later
"""The part as its unrolled surface, for a tool that points at a turning part's axis.

The coordinates are the length around it, which grows with C, Z, and X as the height above the axis.
Seen from outside, with Z upwards, C grows to the right.
"""

import math
from dataclasses import dataclass

import numpy as np

from g12.tools.path.part import C, Part, X, Z
from g12.tools.preview.moves import Move

LONGEST_SEGMENT, LEAST_SEGMENTS, MOST_SEGMENTS = 0.5, 4, 5000  # mm, of a move


@dataclass(frozen=True)
class Surface(Part):
    """The unrolled surface of a cylinder of ``radius``, mm.

    A move is straight there; points between its ends are for measuring.
    """

    radius: float = 0.0

    @property
    def letters(self) -> str:
        return "CZX"

    def points(self, positions: np.ndarray) -> np.ndarray:
        positions = np.atleast_2d(positions)
        around = np.radians(positions[:, C]) * self.radius
        return np.stack([around, positions[:, Z], positions[:, X]], axis=1)

    def _segments(self, move: Move, chord_error: float) -> int:
        if move.kind == "arc":
            return super()._segments(move, chord_error)
        start, end = self.points(np.array([move.start, move.end]))
        segments = math.ceil(np.linalg.norm(end - start) / LONGEST_SEGMENT)
        return min(max(LEAST_SEGMENTS, segments), MOST_SEGMENTS)
