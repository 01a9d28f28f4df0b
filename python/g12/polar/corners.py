# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the tool has to stop: corners that the trajectory planner would round by too much.

LinuxCNC blends two straight moves by starting the second while the first slows down, each with
half the acceleration a. Where a path turns by the angle d at the speed v this takes t = 2 v / a,
and the tool passes the corner at the distance |v2 - v1| t / 8 = sin(d / 2) v**2 / (2 a). With a C
axis in motion the P of G64 does not limit that. A stop costs v / a in time, about as much as the
blending.
"""

from __future__ import annotations

from math import hypot, inf, sqrt

from g12.polar.contour import Arc, Line, Mark, Plunge
from g12.polar.offset import end_direction, path_length, start_direction

TANGENT = 1e-4  # half the angle between two directions that are one


def stops(path: list, rounding: float, x_acceleration: float, c_acceleration: float) -> list[bool]:
    """Return for each element of the tool centre's path whether the tool must stop at its end.

    That is at the path's end, at the pole, and where the blending would leave the path by more than
    ``rounding``. Accelerations in program units per second squared and radians per second squared.
    """
    moving = [k for k, element in enumerate(path) if not isinstance(element, Mark)]
    marked = [False] * len(path)
    for k, following in zip(moving, moving[1:]):
        marked[k] = _rounded_by(path[k], path[following], x_acceleration, c_acceleration) > rounding
    if moving:
        marked[moving[-1]] = True
    return marked


def _rounded_by(a, b, x_acceleration: float, c_acceleration: float) -> float:
    """Return the distance at which blending would pass the corner between two elements."""
    place = _corner_place(a, b)
    if place == (0.0, 0.0):
        return inf
    leave, meet = _direction(a, end_direction), _direction(b, start_direction)
    half_sine = 0.5 * sqrt(sum((p - q) ** 2 for p, q in zip(leave, meet)))
    if half_sine < TANGENT:
        return 0.0
    speed = max(a.feed, b.feed) / 60.0
    acceleration = min(
        _acceleration(direction, place, x_acceleration, c_acceleration)
        for direction in (leave, meet)
    )
    return half_sine * speed * speed / (2.0 * acceleration)


def _corner_place(a, b) -> tuple[float, float]:
    """Return where two elements meet in the plane; anywhere between two plunges."""
    if not isinstance(a, Plunge):
        return a.x1, a.c1
    return (1.0, 0.0) if isinstance(b, Plunge) else (b.x0, b.c0)


def _direction(element: Line | Arc | Plunge, of_plane) -> tuple[float, float, float]:
    """Return the unit vector (X, C, Z) of an element where ``of_plane`` gives its direction in the
    plane.
    """
    if isinstance(element, Plunge):
        return 0.0, 0.0, 1.0 if element.z1 > element.z0 else -1.0
    x, c = of_plane(element)
    if element.z0 == element.z1:
        return x, c, 0.0
    z = element.z1 - element.z0
    length = path_length(element)
    whole = hypot(length, z)
    return x * length / whole, c * length / whole, z / whole


def _acceleration(direction, place, x_acceleration: float, c_acceleration: float) -> float:
    """Return the acceleration along a direction at a place that neither axis exceeds."""
    radius = hypot(*place)
    radial = abs(direction[0] * place[0] + direction[1] * place[1]) / radius
    around = abs(direction[1] * place[0] - direction[0] * place[1]) / radius
    return 1.0 / max(
        max(radial, abs(direction[2])) / x_acceleration, around / (radius * c_acceleration)
    )
