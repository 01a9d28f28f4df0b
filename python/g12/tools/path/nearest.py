# SPDX-License-Identifier: GPL-2.0-or-later
"""Points of straight segments next to points, for arrays of both at once."""

import numpy as np

POINT_LENGTH_SQUARED = 1e-30  # squared length: a shorter segment is a point


def on_segments(points: np.ndarray, starts: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return the points of segments next to points.

    The arguments are arrays (..., d) of points, segment starts and segment vectors; they are
    broadcast.
    """
    return starts + shares_along(points, starts, along)[..., None] * along


def shares_along(points: np.ndarray, starts: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return the shares of segments, 0 to 1, at their nearest points; see ``on_segments``."""
    squares = np.maximum(np.einsum("...i,...i->...", along, along), POINT_LENGTH_SQUARED)
    return np.clip(np.einsum("...i,...i->...", points - starts, along) / squares, 0.0, 1.0)
