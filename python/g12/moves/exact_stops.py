# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact stops: corners that the trajectory planner would blend by more than is allowed.

LinuxCNC blends two straight moves by starting the second while the first slows down, each with
half the acceleration a. Where the path turns by the angle d at the speed v that takes t = 2 v / a,
and the tool passes the corner at the distance |v2 - v1| t / 8 = sin(d / 2) v**2 / (2 a). The second
move accelerates as fast as its own axes can, so the distance is greater where these are quicker
than those of the first, up to 2.2 times. With a C axis in motion the P of G64 limits it only where
X reverses or is at rest, as LinuxCNC takes the angle of X, Y and Z alone: so it is not relied on.

               * corner
           . ' | ' .            The velocity turns from v1 to v2 in the time t at the even rate
     v1  .     |    .  v2       (v2 - v1) / t. That is a parabola from t / 2 before the corner
       .   . - + - .   .        to t / 2 after it. It passes the corner at |v2 - v1| t / 8, and
     .  . '         ' .  .      |v2 - v1| is 2 v sin(d / 2).

A stop costs v / a in time, about as much as the blending.
"""

from collections.abc import Callable, Sequence
from math import hypot, inf, sqrt

from g12.compensation.contour import Motion, PathElement, PlaneMove, Plunge

Direction = tuple[float, float, float]  # unit vector: first and second axis of the plane, height
TANGENT = 1e-4  # half the angle below which two directions are the same
MOST_UNEQUAL = 2.2  # rounding where the second move is much quicker, relative to equal ones


def stops(
    path: Sequence[PathElement],
    rounding: float,
    acceleration: Callable[[Direction, complex], float],
) -> list[bool]:
    """Return for each element of the tool centre's path whether the tool must stop at its end.

    That is at the path's end, and where the blending would leave the path by more than
    ``rounding``. ``acceleration`` gives for a direction and a point in the plane how quick the axes
    are, in program units per second squared; where that is 0 they have to stop.
    """
    marked = [False] * len(path)
    following: Motion | None = None
    stopping = True
    for k in range(len(path) - 1, -1, -1):
        element = path[k]
        if not isinstance(element, Motion):
            continue
        if following is not None:
            corner = _blending_distance(element, following, acceleration, stopping)
            stopping = corner > rounding
        marked[k] = stopping
        following = element
    return marked


def _blending_distance(
    a: Motion,
    b: Motion,
    acceleration: Callable[[Direction, complex], float],
    stopping: bool,
) -> float:
    """Return the distance at which blending would pass the corner between two elements.

    ``stopping``: the tool stops at the end of ``b``. Then ``b`` counts with all of its
    acceleration, which it has into a G61. Into a G4 P0, by which blended segments stop, it has
    half of it, so the rounding there is less than this estimate.
    """
    point = _corner_point(a, b)
    from_direction, to_direction = _direction(a, 1.0), _direction(b, 0.0)
    from_a, from_b = acceleration(from_direction, point), acceleration(to_direction, point)
    if not from_a:
        return inf
    half_sine = 0.5 * sqrt(sum((p - q) ** 2 for p, q in zip(from_direction, to_direction)))
    if half_sine < TANGENT:
        return 0.0
    speed = max(a.feed, b.feed) / 60.0
    square = min(speed * speed, from_a * _length(a), from_b * _length(b))
    unequal = from_b * (1.0 + stopping) / from_a
    return half_sine * square / (2.0 * from_a) * max(1.0, min(unequal, MOST_UNEQUAL))


def _corner_point(a: Motion, b: Motion) -> complex:
    """Return where two elements meet in the plane; anywhere between two plunges."""
    if isinstance(a, PlaneMove):
        return a.end
    return b.start if isinstance(b, PlaneMove) else 1 + 0j


def _direction(element: Motion, share: float) -> Direction:
    """Return the unit vector of an element at a share of it."""
    if isinstance(element, Plunge):
        return 0.0, 0.0, 1.0 if element.h1 > element.h0 else -1.0
    along = element.curve.direction(share)
    if element.h0 == element.h1:
        return along.real, along.imag, 0.0
    length, rise = element.length, element.h1 - element.h0
    whole = hypot(length, rise)
    return along.real * length / whole, along.imag * length / whole, rise / whole


def _length(element: Motion) -> float:
    along = element.length if isinstance(element, PlaneMove) else 0.0
    return hypot(along, element.h1 - element.h0)
