# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the tool has to stop: corners that the trajectory planner would round by too much.

LinuxCNC blends two straight moves by starting the second while the first slows down, each with
half the acceleration a. Where the path turns by the angle d at the speed v that takes t = 2 v / a,
and the tool passes the corner at the distance |v2 - v1| t / 8 = sin(d / 2) v**2 / (2 a). The second
move gathers speed as fast as its own axes can, so the distance is greater where these are quicker
than those of the first, up to 2.2 times. With a C axis in motion the P of G64 limits none of it.

               * corner
           . ' | ' .            The velocity turns from v1 to v2 in the time t at the even rate
     v1  .     |    .  v2       (v2 - v1) / t. That is a parabola from t / 2 in front of the corner
       .   . - + - .   .        to t / 2 behind it. It passes the corner at |v2 - v1| t / 8, and
     .  . '         ' .  .      |v2 - v1| is 2 v sin(d / 2).

A stop costs v / a in time, about as much as the blending.
"""

from __future__ import annotations

from math import hypot, inf, sqrt

from g12.flat.contour import (
    Arc,
    Line,
    Mark,
    Plunge,
    Point,
    end_direction,
    path_length,
    start_direction,
)
from g12.polar.pole import POLE

TANGENT = 1e-4  # half the angle between two directions that are one
MOST_UNEQUAL = 2.2  # rounding where the second move is much quicker, relative to equal ones


def stops(path: list, rounding: float, x_acceleration: float, c_acceleration: float) -> list[bool]:
    """Return for each element of the tool centre's path whether the tool must stop at its end.

    That is at the path's end, at the pole, and where the blending would leave the path by more
    than ``rounding``. Accelerations in program units per second squared and radians per second
    squared.
    """
    marked = [False] * len(path)
    following, stopping = None, True
    for k in range(len(path) - 1, -1, -1):
        element = path[k]
        if isinstance(element, Mark):
            continue
        if following is not None:
            corner = _corner(element, following, x_acceleration, c_acceleration, stopping)
            stopping = corner > rounding
        marked[k] = stopping
        following = element
    return marked


def _corner(a, b, x_acceleration: float, c_acceleration: float, stopping: bool) -> float:
    """Return the distance at which blending would pass the corner between two elements.

    ``stopping``: at the end of ``b``; such a move is not blended, and has all the acceleration.
    """
    place = _place(a, b)
    if place == POLE:
        return inf
    leave, meet = _direction(a, end_direction), _direction(b, start_direction)
    half_sine = 0.5 * sqrt(sum((p - q) ** 2 for p, q in zip(leave, meet)))
    if half_sine < TANGENT:
        return 0.0
    from_a = _acceleration(leave, place, x_acceleration, c_acceleration)
    from_b = _acceleration(meet, place, x_acceleration, c_acceleration)
    speed = max(a.feed, b.feed) / 60.0
    square = min(speed * speed, from_a * _length(a), from_b * _length(b))
    unequal = from_b * (1.0 + stopping) / from_a
    return half_sine * square / (2.0 * from_a) * max(1.0, min(unequal, MOST_UNEQUAL))


def _place(a, b) -> Point:
    """Return where two elements meet in the plane; anywhere between two plunges."""
    if not isinstance(a, Plunge):
        return a.x1, a.c1
    return (1.0, 0.0) if isinstance(b, Plunge) else (b.x0, b.c0)


def _direction(element: Line | Arc | Plunge, in_plane) -> tuple[float, float, float]:
    """Return the unit vector (X, C, Z) of an element where ``in_plane`` gives its direction."""
    if isinstance(element, Plunge):
        return 0.0, 0.0, 1.0 if element.z1 > element.z0 else -1.0
    x, c = in_plane(element)
    if element.z0 == element.z1:
        return x, c, 0.0
    length, z = path_length(element), element.z1 - element.z0
    whole = hypot(length, z)
    return x * length / whole, c * length / whole, z / whole


def _length(element: Line | Arc | Plunge) -> float:
    """Return the length of an element in space."""
    along = 0.0 if isinstance(element, Plunge) else path_length(element)
    return hypot(along, element.z1 - element.z0)


def _acceleration(direction, place: Point, x_acceleration: float, c_acceleration: float) -> float:
    """Return the acceleration along a direction at a place that neither axis exceeds."""
    radius = hypot(*place)
    radial = abs(direction[0] * place[0] + direction[1] * place[1]) / radius
    around = abs(direction[1] * place[0] - direction[0] * place[1]) / radius
    slide = max(radial, abs(direction[2])) / x_acceleration
    return 1.0 / max(slide, around / (radius * c_acceleration))
