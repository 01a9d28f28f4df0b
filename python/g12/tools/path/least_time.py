# SPDX-License-Identifier: GPL-2.0-or-later
"""The least time of a path for a slide and a C axis, a lower bound for any planner.

Time-optimal path parametrisation: with z the square of the speed along the path and u half its
change, an axis q(s) has the acceleration q' u + q'' z. Backwards along the path, the greatest z is
found from which the rest can still be followed; forwards, the greatest of these that can be
reached.

An axis of acceleration A allows |u + w z| <= A / |q'|, with w = q'' / q'. That is a pair of
straight lines in the plane of u and z, so the greatest z is where two of them meet.
"""

import numpy as np

LEAST_SLOPE = 1e-9  # of an axis along the path: a smaller share counts as this
Rates = tuple[float, float]  # of an axis: speed and acceleration


def least_seconds(
    points: np.ndarray, speed: float | np.ndarray, slide: Rates, spindle: Rates
) -> float:
    """Return the least time of a path of points (complex), from stop to stop.

    ``speed`` is the programmed one, perhaps one for each point; ``spindle`` is in radians. The
    points are evenly spaced along the path, none of them in the centre.
    """
    step = float(abs(np.diff(points)).mean())
    most = np.square(np.broadcast_to(np.asarray(speed, float), points.shape))
    reserves, swings = [], []
    for axis, (velocity, acceleration) in (
        (np.abs(points), slide),
        (np.unwrap(np.angle(points)), spindle),
    ):
        slope = np.gradient(axis, step)
        bend = np.gradient(slope, step)
        slope = np.where(np.abs(slope) < LEAST_SLOPE, LEAST_SLOPE, slope)
        most = np.minimum(most, np.square(velocity / slope))
        reserves.append(2.0 * step * acceleration / np.abs(slope))
        swings.append(2.0 * step * bend / slope)
    apart = np.maximum(np.abs(swings[0] - swings[1]), LEAST_SLOPE**2)
    most = np.minimum(most, (reserves[0] + reserves[1]) / apart)
    limits = [*zip(*(zip(*each) for each in zip(reserves, swings)))]
    reachable = _reachable(most.tolist(), limits)
    return seconds_at(_gained(reachable, limits), step)


def seconds_at(squares: list[float], step: float) -> float:
    """Return the time of a path from the squares of the speed at points one step apart."""
    speeds = np.sqrt(np.maximum(squares, 0.0))
    return float((2.0 * step / np.maximum(speeds[1:] + speeds[:-1], 1e-9)).sum())


def _reachable(most: list[float], limits: list) -> list[float]:
    """Return the greatest squares of the speed from which the rest can be followed."""
    reachable = [0.0] * len(most)
    for at in range(len(most) - 2, -1, -1):
        greatest = most[at]
        for reserve, swing in limits[at]:
            if swing < 1.0:
                greatest = min(greatest, (reachable[at + 1] + reserve) / (1.0 - swing))
        reachable[at] = greatest
    return reachable


def _gained(reachable: list[float], limits: list) -> list[float]:
    """Return the greatest of these squares of the speed that can be reached from rest.

    An axis that brakes more at a higher speed is evaluated at the step's end: no step brakes below
    zero.
    """
    squares = [0.0]
    for axes, greatest in zip(limits, reachable[1:]):
        square = squares[-1]
        gained = (
            (square + reserve) / (1.0 + swing) if swing > 0.0 else square + reserve - swing * square
            for reserve, swing in axes
        )
        squares.append(min(*gained, greatest))
    return squares
