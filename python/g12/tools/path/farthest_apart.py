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
MOST_DISTANCES, BATCH = 3_000_000, 20_000


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
    known = [axis in ("XYZC" if part.turning else "XYZ") for axis in AXIS_LETTERS]
    ends = np.array([(move.start, move.end) for move in [*moves, *others]])
    beyond = (ends[:, 0] != ends[:, 1]) & np.logical_not(known)
    for chord_error in (CHORD_ERROR, ROUGH) if not beyond.any() else ():
        lines = [paths(part, some, chord_error) for some in (moves, others)]
        counts = [sum(map(len, some)) for some in lines]
        if counts[0] * counts[1] <= MOST_DISTANCES:
            return max(_farthest(*lines), _farthest(*lines[::-1]), key=lambda gap: gap.size)
    return None


def _farthest(lines: Sequence[np.ndarray], others: Sequence[np.ndarray]) -> Gap:
    """Return the point of polylines (n, 3) that is farthest from the others."""
    starts = np.concatenate([line[:-1] for line in others])
    along = np.concatenate([np.diff(line, axis=0) for line in others])
    points, gaps = np.concatenate(lines), []
    for batch in np.array_split(points, len(points) * len(starts) // BATCH + 1):
        near = on_segments(batch[:, None], starts, along)
        away = np.linalg.norm(batch[:, None] - near, axis=2)
        worst = int(away.min(axis=1).argmax())
        nearest = int(away[worst].argmin())
        gaps.append(Gap(float(away[worst, nearest]), batch[worst], near[worst, nearest]))
    return max(gaps, key=lambda gap: gap.size)
