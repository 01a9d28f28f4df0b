# SPDX-License-Identifier: GPL-2.0-or-later
"""The common points of curves, and of the straight lines and circles on which they lie.

A circle that misses another curve by less than ``TOUCHES`` counts as tangent: the gap is rounding.
"""

from __future__ import annotations

import math

from g12.geometry.curve import Arc, Curve, Line

PARALLEL_SINE = 1e-9  # sine of the angle between lines that are parallel
TOUCHES = 1e-6  # as SAME_POINT of a contour


def crossings(one: Curve, other: Curve) -> list[complex]:
    """Return the points common to the lines or circles on which two curves lie, at most two."""
    if isinstance(one, Line):
        return _line_line(one, other) if isinstance(other, Line) else _line_circle(one, other)
    return _line_circle(other, one) if isinstance(other, Line) else _circle_circle(one, other)


def common_points(one: Curve, other: Curve) -> list[complex]:
    """Return the points at which two curves cross or touch; none along a common portion."""
    return [
        point
        for point in crossings(one, other)
        if one.distance(point) <= TOUCHES and other.distance(point) <= TOUCHES
    ]


def _line_line(one: Line, other: Line) -> list[complex]:
    along, across = one.direction(), other.direction()
    sine = (along.conjugate() * across).imag
    if abs(sine) <= PARALLEL_SINE:
        return []
    return [one.start + ((other.start - one.start).conjugate() * across).imag / sine * along]


def _line_circle(line: Line, circle: Arc) -> list[complex]:
    along = line.direction()
    foot = line.start + ((circle.centre - line.start) * along.conjugate()).real * along
    return [foot + half * along for half in _halves(abs(circle.centre - foot), circle.radius)]


def _circle_circle(one: Arc, other: Arc) -> list[complex]:
    apart = abs(other.centre - one.centre)
    if apart <= TOUCHES:
        return []
    along = (other.centre - one.centre) / apart
    foot = (apart + (one.radius - other.radius) * (one.radius + other.radius) / apart) / 2
    return [one.centre + (foot + 1j * half) * along for half in _halves(abs(foot), one.radius)]


def _halves(distance: float, radius: float) -> tuple[float, ...]:
    """Return half the chord at a distance from a circle's centre, with both signs."""
    if distance > radius + TOUCHES:
        return ()
    half = math.sqrt(max(0.0, (radius - distance) * (radius + distance)))
    return (half, -half)
