# SPDX-License-Identifier: GPL-2.0-or-later
"""Splitting: the fewest straight moves of X and C that stay within a deviation of a line or an
arc.

A straight move of X and C draws a spiral r = r0 + k (angle - angle0) in the plane. Where the path
makes the angle p with the radius, the spiral has the curvature sin p (1 + cos(p)**2) / r. A piece
of length L leaves a path of another curvature by |difference| L**2 / 8. Two things follow.

- The number of pieces per unit of length is sqrt(|difference| / (8 deviation)). Its integral over
  the element, rounded up, is the least number of pieces; equal steps of that integral share the
  deviation equally.
- With the inner ends of the pieces moved off the path by the deviation, to the side the spirals do
  not bulge to, the bulge may be twice as high and the pieces longer by sqrt(2). Only the first and
  the last piece of an element, with one end exactly on the path, are shorter.

The point of an element nearest to the pole, or farthest from it, gets an end of a piece: X turns
round there, and a piece across it would move C alone, or hardly any X.

In a line the place is u = tan(angle from the foot of the perpendicular d), so s = d u and r = d
sqrt(1 + u**2). In an arc of radius R about a centre at the distance e R from the pole it is the
angle a about that centre, in the sense of the motion, 0 in the direction away from the pole; r**2
= R**2 m with m = 1 + e**2 + 2 e cos a.
"""

from __future__ import annotations

from math import acos, atan, atan2, ceil, copysign, cos, floor, hypot, pi, sin, sqrt
from typing import NamedTuple

from g12.polar.contour import Arc, Line
from g12.polar.offset import arc_radius
from g12.polar.pole import POLE

LOSS = 0.1464  # of a piece, at an end exactly on the path: such a piece may bulge by (3 + 2 sqrt 2) / 8 only
GAIN = 0.8  # of a piece more fits on either side of a point where path and spirals have the same curvature
FINE = 64.0  # deviations from the pole: the pieces of an arc about a centre that near are few, and uneven
WHOLE = sqrt(0.5)  # of a piece is left of one with both ends on the path
STRAIGHT = 1e-9  # program units from the pole: a line that close is a radius


class Law(NamedTuple):
    """What limits the length of a piece, program units.

    ``deviation`` from the path; ``ripple``: how far the speed may be from its mean within a piece,
    relative. Pieces are not made shorter than 1 / min(``x_hold``, radius * ``c_hold``) for an even
    speed: on shorter ones the machine would not reach the speed at all.
    """

    deviation: float
    ripple: float
    x_hold: float
    c_hold: float


class Split(NamedTuple):
    """The ends of an element's pieces, its start first: radius, angle (continuous, radians), path
    length.
    """

    radii: list[float]
    angles: list[float]
    lengths: list[float]


def split(move: Line | Arc, law: Law) -> Split:
    """Return the pieces of a move of the tool's centre that does not run through the pole."""
    return _split_line(move, law) if isinstance(move, Line) else _split_arc(move, law)


def _split_line(move: Line, law: Law) -> Split:
    x0, c0, x1, c1 = move.x0, move.c0, move.x1, move.c1
    length = hypot(x1 - x0, c1 - c0)
    tx, tc = (x1 - x0) / length, (c1 - c0) / length
    distance = x0 * tc - c0 * tx
    r0, r1 = hypot(x0, c0), hypot(x1, c1)
    if abs(distance) <= STRAIGHT:
        angle = atan2(c0, x0) if r0 > r1 else atan2(c1, x1)
        return Split([r0, r1], [angle, angle], [0.0, length])
    turn = 1.0 if distance > 0.0 else -1.0
    distance = abs(distance)
    law = law._replace(deviation=min(law.deviation, 0.5 * distance))
    u0 = (x0 * tx + c0 * tc) / distance
    u1 = u0 + length / distance
    foot = atan2(c0, x0) - turn * atan(u0)
    if _is_one_piece(u0, u1, distance, r0, r1, law):
        return Split([r0, r1], [foot + turn * atan(u0), foot + turn * atan(u1)], [0.0, length])
    apsis = [0.0] if u0 < 0.0 < u1 else []
    places, shares = _spread(_line_density(distance, law), u0, u1, apsis, [], abs)
    deviation = law.deviation
    radii = [(distance - deviation * share) * sqrt(1.0 + u * u) for u, share in zip(places, shares)]
    radii[0], radii[-1] = r0, r1
    return Split(
        radii, [foot + turn * atan(u) for u in places], [distance * (u - u0) for u in places]
    )


def _is_one_piece(u0: float, u1: float, distance: float, r0: float, r1: float, law: Law) -> bool:
    """Return whether a line is so short that it is one piece wherever its densities are greatest."""
    nearest = 0.0 if u0 < 0.0 < u1 else min(abs(u0), abs(u1))
    m = 1.0 + nearest * nearest
    span = u1 - u0
    return (
        span * span * distance * (2.0 * m - 1.0) <= m * m * 8.0 * law.deviation
        and span <= 0.6 * m
        and abs(r1 - r0) <= (r0 + r1) * m * law.ripple
    )


def _chord_density(radius: float, deviation: float, nearest: float) -> float:
    """Return the pieces per radian of an arc of that radius whose path comes as near to the pole
    as ``nearest``.

    Near the pole pieces bulge more than the curvature says: the longest piece across the foot of a
    line turns by 4 atan(sqrt(deviation / nearest)).
    """
    excess = sqrt(deviation / max(nearest, deviation))
    return sqrt(radius / (16.0 * deviation)) * excess / atan(excess)


def _line_density(distance: float, law: Law):
    """Return the function of u that gives pieces per unit of u, and the share of the deviation
    they use.
    """
    chord = _chord_density(distance, law.deviation, distance)
    even = 0.5 / law.ripple
    x_hold, c_hold = law.x_hold * distance, law.c_hold * distance * distance

    def density(u: float) -> tuple[float, float]:
        v = u * u
        m = 1.0 + v
        wanted = chord * sqrt(m + v) / m
        pieces = wanted
        smooth = even * abs(u) / (m * m)
        if smooth > pieces:
            pieces = max(pieces, min(smooth, x_hold, c_hold * sqrt(m)))
        return pieces, (wanted / pieces) ** 2

    return density


def _split_arc(move: Arc, law: Law) -> Split:
    radius, away = arc_radius(move), hypot(move.cx, move.cc)
    start, end = (move.x0, move.c0), (move.x1, move.c1)
    turn = 1.0 if move.sweep > 0.0 else -1.0
    outward = atan2(move.cc, move.cx)
    if POLE in (start, end):
        away = radius
    a0 = turn * (atan2(move.c0 - move.cc, move.x0 - move.cx) - outward)
    a0 = -pi if start == POLE else (a0 + pi) % (2 * pi) - pi
    a1 = pi if end == POLE else a0 + abs(move.sweep)
    places, shares = [a0, a1], [0.0, 0.0]
    if away != radius:
        law = law._replace(deviation=min(law.deviation, 0.5 * abs(radius - away)))
    if 2.0 * away > law.deviation:
        density = _arc_density(radius, away / radius, law)
        apsides = [k * pi for k in range(floor(a0 / pi) + 1, ceil(a1 / pi))]
        fine = 3 if away < FINE * law.deviation else 1
        inflections = _inflections(a0, a1, away / radius)
        places, shares = _spread(density, a0, a1, apsides, inflections, cos, fine)
    radii, angles = _arc_polar(radius, away, law.deviation, places, shares)
    radii[0], radii[-1] = hypot(*start), hypot(*end)
    return Split(
        radii, [outward + turn * angle for angle in angles], [radius * (a - a0) for a in places]
    )


def _inflections(a0: float, a1: float, e: float) -> list[float]:
    """Return the angles between two others at which an arc and the spirals have the same
    curvature.
    """
    if e >= 1.0:
        return []
    low, high = -1.0, 0.0
    while high - low > 1e-3:
        q = 0.5 * (low + high)
        if _curvature_difference(q, e) < 0.0:
            low = q
        else:
            high = q
    angle = acos(high)
    places = (sign * angle + turn for turn in (-2 * pi, 0.0, 2 * pi) for sign in (-1, 1))
    return sorted(a for a in places if a0 < a < a1)


def _arc_polar(radius: float, away: float, deviation: float, places, shares):
    """Return radii and angles, from the direction of the arc's centre on, of places moved off the
    arc.
    """
    radii, angles = [], []
    for a, share in zip(places, shares):
        moved = radius + deviation * share
        x, c = moved * cos(a), moved * sin(a)
        radii.append(hypot(away + x, c))
        if away < radius:
            angles.append(a - atan2(away * sin(a), moved + away * cos(a)))
        elif away == radius and abs(a) == pi:
            angles.append(0.5 * a)
        else:
            angles.append(atan2(c, away + x))
    return radii, angles


def _curvature_difference(q: float, e: float) -> float:
    """Return a number with the sign of the difference between the curvatures of arc and spiral, q
    = cos a.
    """
    return e * e * e + q * (1.0 + 2.0 * e * e + e * q * (3.0 + e * q))


def _arc_density(radius: float, e: float, law: Law):
    """Return the function of a that gives pieces per radian, and the share of the deviation they
    use.

    The curvatures of arc and spiral differ by p / (R m**2), with p below.
    """
    chord = _chord_density(radius, law.deviation, radius * abs(1.0 - e))
    even = 0.5 * e / law.ripple
    x_hold, c_hold = law.x_hold * radius, law.c_hold * radius * radius
    flat = (min(e, 1.0) * radius / (36.0 * law.deviation)) ** (1.0 / 3.0)
    m0 = 1.0 + e * e

    def density(a: float) -> tuple[float, float]:
        q = cos(a)
        m = m0 + 2.0 * e * q
        p = e * _curvature_difference(q, e)
        wanted = chord * sqrt(abs(p)) / m
        pieces = max(wanted, flat)
        smooth = even * abs(sin(a)) * (1.0 + e * q) ** 2 / (m * m)
        if smooth > pieces:
            pieces = max(pieces, min(smooth, x_hold, c_hold * sqrt(m)))
        return pieces, copysign((wanted / pieces) ** 2, p)

    return density


class _Part(NamedTuple):
    """A part of an element between two cuts, and one longest piece of it after the other.

    ``places``, ``fine`` of them in a piece, begin at the end nearer to the pole, and end beyond
    the other; ``count`` pieces would do. ``losses`` are those at the start and at the end of the
    part.
    """

    places: list[float]
    shares: list[float]
    count: float
    fine: int
    backwards: bool
    losses: tuple[float, float]


def _march(density, a: float, b: float, nearness, losses: tuple[float, float], fine: int) -> _Part:
    backwards = nearness(b) < nearness(a)
    place, far = (b, a) if backwards else (a, b)
    sign = (1.0 if far > place else -1.0) / fine
    places, shares = [place], []
    step = sign / density(place)[0]
    while (far - place) * sign > 0.0:
        pieces, share = density(place + 0.5 * step)
        step = sign / pieces
        place += step
        places.append(place)
        shares.append(share)
    count = (len(shares) - (place - far) / step) / fine
    return _Part(places, shares, count, fine, backwards, losses)


def _spread(
    density, start, end, apsides, inflections, nearness, fine=1
) -> tuple[list[float], list[float]]:
    """Return the ends of the fewest pieces, and how much of the deviation each is moved off the
    path.

    ``nearness`` tells which of two places is nearer to the pole.
    """
    apsides = [a for a in apsides if min(a - start, end - a) * density(a)[0] > 0.5]
    loss = (
        dict.fromkeys(inflections, -GAIN) | dict.fromkeys(apsides, 0.0) | {start: LOSS, end: LOSS}
    )
    cuts = sorted(loss)
    parts = [
        _march(density, a, b, nearness, (loss[a], loss[b]), fine) for a, b in zip(cuts, cuts[1:])
    ]
    if sum(part.count for part in parts) <= WHOLE:
        return [start, end], [0.0, 0.0]
    inner, before = [(start, 0.0)], 0.0
    for cut, part in zip(cuts, parts):
        pieces = max(0 if -GAIN in part.losses else 1, ceil(part.count + sum(part.losses) - 1e-9))
        length = part.count / (pieces - sum(part.losses))
        if cut in apsides:
            inner.append((cut, max(before, length) ** 2 * density(cut)[1]))
        inner.extend(_inner(part, pieces, length))
        before = length
    places, shares = zip(*inner, (end, 0.0))
    return list(places), list(shares)


def _inner(part: _Part, pieces: int, length: float) -> list[tuple[float, float]]:
    """Return places and shares of the ends of pieces inside a part, in the sense of the motion."""
    table, square = part.places, length * length
    near, far = part.losses[::-1] if part.backwards else part.losses
    inner = []
    for k in range(near >= 0.0, pieces + (far < 0.0)):
        count = part.fine * length * (k - near)
        j = int(count)
        place = table[j] + (count - j) * (table[j + 1] - table[j])
        inner.append((place, square * part.shares[j]))
    return inner[::-1] if part.backwards else inner
