# SPDX-License-Identifier: GPL-2.0-or-later
"""The least time in which a slide and a C axis can make a path: what no planner goes below.

Time-optimal path parametrisation: with z the square of the speed along the path and u half its
change, an axis q(s) has the acceleration q' u + q'' z. Backwards along the path the greatest z is
found from which the rest can still be made; forwards the greatest of these that can be reached.
"""

import numpy as np

HALVINGS = 80


def least_seconds(points, speed, slide, spindle):
    """Return the least time of a path of points (complex), from standing to standing.

    ``speed`` is the programmed one; ``slide`` and ``spindle`` are (velocity, acceleration), of C in
    radians. The points lie evenly along the path, and not in the centre.
    """
    step = abs(np.diff(points)).mean()
    axes = np.abs(points), np.unwrap(np.angle(points))
    slopes = [np.gradient(axis, step) for axis in axes]
    bends = [np.gradient(slope, step) for slope in slopes]
    most = np.full(len(points), float(speed) ** 2)
    for slope, (velocity, _) in zip(slopes, (slide, spindle)):
        most = np.minimum(most, (velocity / np.maximum(np.abs(slope), 1e-12)) ** 2)
    limits = [
        list(zip(slope, bend, np.full(len(points), limit)))
        for slope, bend, (_, limit) in zip(slopes, bends, (slide, spindle))
    ]
    limits = list(zip(*limits))
    reach = np.zeros(len(points))
    for at in range(len(points) - 2, -1, -1):
        reach[at] = _greatest(limits[at], most[at], reach[at + 1], step)
    squares = np.zeros(len(points))
    for at in range(len(points) - 1):
        _, high = _changes(limits[at], squares[at])
        squares[at + 1] = min(squares[at] + 2 * step * high, reach[at + 1])
    speeds = np.sqrt(np.maximum(squares, 0.0))
    return float((2 * step / np.maximum(speeds[1:] + speeds[:-1], 1e-9)).sum())


def _changes(limits, square):
    """Return the least and the greatest change that the axes allow at a speed's square."""
    low, high = -1e12, 1e12
    for slope, bend, most in limits:
        if abs(slope) < 1e-9:
            continue
        ends = sorted((sign * most - bend * square) / slope for sign in (-1, 1))
        low, high = max(low, ends[0]), min(high, ends[1])
    return low, high


def _greatest(limits, most, behind, step):
    """Return the greatest square of the speed from which the next place's is not too great."""
    slowest, fastest = 0.0, most
    for _ in range(HALVINGS):
        tried = 0.5 * (slowest + fastest)
        low, high = _changes(limits, tried)
        if low <= high and tried + 2 * step * low <= behind:
            slowest = tried
        else:
            fastest = tried
    return slowest
