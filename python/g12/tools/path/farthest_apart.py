# SPDX-License-Identifier: GPL-2.0-or-later
"""The greatest distance between two paths on the part, and its position.

Lengths are millimetres.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.nearest import on_segments
from g12.tools.path.part import CHORD_ERROR, Part, paths
from g12.tools.preview.moves import Move

ROUGH = 0.005  # coarser chord error, where the finer one gives too many points
MOST_DISTANCES = 3_000_000
BATCH = 200_000


class Gap(NamedTuple):
    """The point of one path that is farthest from another, and the nearest point there."""

    size: float
    point: np.ndarray
    nearest: np.ndarray


def gap_between(part: Part, moves: Sequence[Move], others: Sequence[Move]) -> Gap | None:
    """Return the point where two paths are farthest apart.

    None where the distance has no meaning, as for axes that the part does not know, or takes too
    long.
    """
    few = len(moves) * len(others) <= MOST_DISTANCES
    if not few or any(_is_beyond(part, move) for move in [*moves, *others]):
        return None
    for chord_error in (CHORD_ERROR, ROUGH):
        lines = [paths(part, some, chord_error) for some in (moves, others)]
        if _count(lines[0]) * _count(lines[1]) <= MOST_DISTANCES:
            return max(_farthest(*lines), _farthest(*lines[::-1]), key=lambda gap: gap.size)
    return None


def _is_beyond(part: Part, move: Move) -> bool:
    known = "XYZC" if part.turning else "XYZ"
    ends = zip(AXIS_LETTERS, move.start, move.end)
    return any(a != b for axis, a, b in ends if axis not in known)


def _count(lines: Sequence[np.ndarray]) -> int:
    return sum(map(len, lines))


def _farthest(lines: Sequence[np.ndarray], others: Sequence[np.ndarray]) -> Gap:
    """Return the point of polylines (n, 3) that is farthest from the others."""
    starts = np.concatenate([line[:-1] for line in others])
    along = np.concatenate([np.diff(line, axis=0) for line in others])
    points = np.concatenate(lines)
    size = max(1, BATCH // len(starts))
    batches = (points[first : first + size] for first in range(0, len(points), size))
    return max((_in_batch(batch, starts, along) for batch in batches), key=lambda gap: gap.size)


def _in_batch(points: np.ndarray, starts: np.ndarray, along: np.ndarray) -> Gap:
    near = on_segments(points[:, None], starts, along)
    distances = np.linalg.norm(points[:, None] - near, axis=2)
    nearest = distances.argmin(axis=1)
    sizes = distances[np.arange(len(points)), nearest]
    worst = int(sizes.argmax())
    return Gap(float(sizes[worst]), points[worst], near[worst, nearest[worst]])
