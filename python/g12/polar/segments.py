# SPDX-License-Identifier: GPL-2.0-or-later
"""Splitting: straight moves of X and C along a line or an arc, as long as the deviation allows.

A straight move of X and C draws a spiral r = r0 + k (angle - angle0) in the plane. Where the path
makes the angle p with the radius, the spiral has the curvature sin p (1 + cos(p)**2) / r. A segment
of length L bulges from a path of another curvature by |difference| L**2 / 8. So a unit of length
needs sqrt(|difference| / (8 bulge)) segments.

The speed along the part is not constant inside a segment: it changes by the fraction
sin(p)**2 dr / r. Where r grows by more than e times these approximations fail: segments are
shorter.

                       r  . ' * point                             * point
                     . '     |                         r  . '   /
                . '          | s = d u                  . '     / R
           . '               |                     . '         / a
    pole +-------------------+ foot           pole +----------+- - - - a = 0
                  d                                   e R      centre

Line: its position is u, the tangent of the angle from the foot of the perpendicular d to the pole;
along it s = d u and r = d sqrt(m) with m = 1 + u**2, and the curvature of the spirals is
(1 + 2 u**2) / (d m**2).

Arc of radius R about a centre e R from the pole: its position is the angle a about that centre, in
the sense of the motion, 0 where it is farthest from the pole; r = R sqrt(m) with m = 1 + e**2 + 2 e
cos a = (1 - e)**2 + 4 e cos(a / 2)**2. With w = 1 + e cos a = (m + 1 - e**2) / 2 the sine of p is w
/ sqrt(m), and the curvatures differ by (m**2 - w (2 m - w**2)) / (R m**2).
"""

from __future__ import annotations

from math import atan, atan2, copysign, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

from g12.geometry.curve import Arc, Curve, Line, angle_of
from g12.moves.feed import Split
from g12.moves.spacing import BULGE, WHOLE_BULGE, Density, Stretch, spaced

RADIAL = 1e-9  # program units: a line that close to the pole is a radius


class Law(NamedTuple):
    """What limits the length of a segment, program units.

    ``deviation`` from the path; ``ripple``: how far the speed may be from its mean within a
    segment, relative. For an even speed segments are not made shorter than 1 / ``x_hold`` or 1 / (r
    ``c_hold``): on shorter ones the machine would not reach the speed.
    """

    deviation: float
    ripple: float
    x_hold: float
    c_hold: float


def split_move(curve: Curve, law: Law) -> Split:
    """Return the segments of a move of the tool's centre that does not run through the pole."""
    return _split_line(curve, law) if isinstance(curve, Line) else _split_arc(curve, law)


def _split_line(line: Line, law: Law) -> Split:
    length = line.length
    started = line.start.conjugate() * line.direction()  # along the line, and across it
    distance = started.imag
    r0, r1 = abs(line.start), abs(line.end)
    if abs(distance) <= RADIAL:
        angle = angle_of(line.start if r0 > r1 else line.end)
        return Split([r0, r1], [angle, angle], [0.0, length])
    turn = 1.0 if distance > 0.0 else -1.0
    distance = abs(distance)
    deviation = min(law.deviation, 0.5 * distance)  # less than the distance to the pole
    u0 = started.real / distance
    u1 = u0 + length / distance
    foot = angle_of(line.start) - turn * atan(u0)
    if _is_one_segment(u0, u1, distance, deviation, abs(r1 - r0) / (r0 + r1), law.ripple):
        return Split([r0, r1], [foot + turn * atan(u0), foot + turn * atan(u1)], [0.0, length])
    density = _line_density(distance, deviation, law)
    positions, shares = spaced(Stretch(u0, u1, [0.0], abs), density)
    moved = [distance - deviation * share for share in shares]
    radii = [d * sqrt(1.0 + u * u) for d, u in zip(moved, positions)]
    radii[0], radii[-1] = r0, r1
    return Split(
        radii,
        [foot + turn * atan(u) for u in positions],
        [d * u - distance * u0 for d, u in zip(moved, positions)],
    )


def _is_one_segment(
    u0: float, u1: float, distance: float, deviation: float, rise: float, ripple: float
) -> bool:
    """Return whether a line is so short that it is one segment wherever its density is greatest.

    ``rise`` is the change of the radius relative to twice its mean.
    """
    nearest = 0.0 if u0 < 0.0 < u1 else min(abs(u0), abs(u1))
    m = 1.0 + nearest * nearest
    span = u1 - u0
    return (
        span * span * distance * (2.0 * m - 1.0) <= m * m * 8.0 * WHOLE_BULGE * deviation
        and rise <= m * ripple
    )


def _line_density(distance: float, deviation: float, law: Law) -> Density:
    """Return the segments per unit of u, and the share of the deviation that they use."""
    bulging = sqrt(distance / (8.0 * BULGE * deviation))
    even = 0.5 / law.ripple
    x_hold, c_hold = law.x_hold * distance, law.c_hold * distance * distance

    def density(u: float) -> tuple[float, float]:
        v = u * u
        m = 1.0 + v
        by_bulge = bulging * sqrt(m + v) / m
        growth = abs(u) / m
        segments = max(by_bulge, growth)
        smooth = even * growth / m
        if smooth > segments:
            segments = max(segments, min(smooth, x_hold, c_hold * sqrt(m)))
        return segments, (by_bulge / segments) ** 2

    return density


def _split_arc(arc: Arc, law: Law) -> Split:
    radius, away = arc.radius, abs(arc.centre)
    turn = 1.0 if arc.sweep > 0.0 else -1.0
    outward = angle_of(arc.centre)
    a0 = turn * (angle_of(arc.start - arc.centre) - outward)
    a0 = (a0 + pi) % (2 * pi) - pi
    a1 = a0 + abs(arc.sweep)
    r0, r1 = abs(arc.start), abs(arc.end)
    nearest = abs(radius - away) if a0 <= pi <= a1 else min(r0, r1)
    deviation = min(law.deviation, 0.5 * nearest)
    positions, shares = [a0, a1], [0.0, 0.0]
    if 2.0 * away > deviation:
        e = away / radius
        density = _arc_density(radius, e, deviation, law)
        positions, shares = spaced(Stretch(a0, a1, [0.0, pi, 2 * pi], cos), density)
    radii, angles = _arc_polar(radius, away, deviation, positions, shares)
    radii[0], radii[-1] = r0, r1
    return Split(
        radii, [outward + turn * angle for angle in angles], [radius * (a - a0) for a in positions]
    )


def _arc_density(radius: float, e: float, deviation: float, law: Law) -> Density:
    """Return the segments per radian, and the share of the deviation, above zero outside the arc.

    Where the curvatures are equal, the length is that of a segment which begins there.
    """
    bulging = sqrt(radius / (8.0 * BULGE * deviation))
    flat = (min(e, 1.0) * radius / (18.0 * BULGE * deviation)) ** (1.0 / 3.0)
    even = 0.5 / law.ripple
    x_hold, c_hold = law.x_hold * radius, law.c_hold * radius * radius
    nearest, inside = (1.0 - e) ** 2, (1.0 - e) * (1.0 + e)

    def density(a: float) -> tuple[float, float]:
        half = cos(0.5 * a)  # unlike cos a it tells positions beside the pole from each other
        m = nearest + 4.0 * e * half * half
        w = 0.5 * (m + inside)
        p = m * m - w * (2.0 * m - w * w)
        by_bulge = bulging * sqrt(abs(p)) / m
        growth = e * abs(sin(a)) / m
        segments = max(by_bulge, growth, flat)
        smooth = even * growth * w * w / m
        if smooth > segments:
            segments = max(segments, min(smooth, x_hold, c_hold * sqrt(m)))
        return segments, copysign((by_bulge / segments) ** 2, p)

    return density


def _arc_polar(
    radius: float, away: float, deviation: float, positions: list[float], shares: list[float]
) -> tuple[list[float], list[float]]:
    """Return radii, and angles from the arc centre's direction, of positions off the arc."""
    radii, angles = [], []
    for a, share in zip(positions, shares):
        moved = radius + deviation * share
        x, c = moved * cos(a), moved * sin(a)
        radii.append(hypot(away + x, c))
        if away < radius:
            angles.append(a - atan2(away * sin(a), moved + away * cos(a)))
        else:
            angles.append(atan2(c, away + x))
    return radii, angles
