# SPDX-License-Identifier: GPL-2.0-or-later
"""Where two moves cross, how near they come, and where a place lies along one. Program units."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Line,
    Point,
    arc_radius,
    path_length,
    start_direction,
)

PARALLEL = 1e-9  # sine of an angle that is none


def crossing(a: Line | Arc, b: Line | Arc) -> Point | None:
    """Return where ``a`` is left for ``b``: their crossing nearest to the corner, if any."""
    length, best, nearest = path_length(a), None, 0.0
    for place in _crossings(a, b):
        leave, meet = along_end(a, place), along_start(b, place)
        on_both = (
            -SAME_PLACE <= leave <= length + SAME_PLACE
            and -SAME_PLACE <= meet <= path_length(b) + SAME_PLACE
        )
        if on_both and (best is None or length - leave + meet < nearest):
            best, nearest = place, length - leave + meet
    return best


def common_places(a: Line | Arc, b: Line | Arc) -> list[Point]:
    """Return the places at which two moves cross or touch; none where they run on each other."""
    return [
        place
        for place in _crossings(a, b)
        if all(
            hypot(place[0] - x, place[1] - c) <= SAME_PLACE
            for x, c in (nearest_place(move, place) for move in (a, b))
        )
    ]


def place_at(move: Line | Arc, part: float) -> Point:
    """Return the place at a part of a move: 0 is its very start and 1 its very end."""
    if part in (0.0, 1.0):
        return (move.x1, move.c1) if part else (move.x0, move.c0)
    if isinstance(move, Line):
        return move.x0 + part * (move.x1 - move.x0), move.c0 + part * (move.c1 - move.c0)
    angle = part * move.sweep
    x, c = move.x0 - move.cx, move.c0 - move.cc
    sine, cosine = sin(angle), cos(angle)
    return move.cx + x * cosine - c * sine, move.cc + x * sine + c * cosine


def part_of_move(move: Line | Arc, first: float, last: float) -> Line | Arc:
    """Return a move from one part of it to a later one, Z included."""
    z0, z1 = height_at(move, first), height_at(move, last)
    (x0, c0), (x1, c1) = place_at(move, first), place_at(move, last)
    cut = move._replace(x0=x0, c0=c0, z0=z0, x1=x1, c1=c1, z1=z1)
    return cut if isinstance(move, Line) else cut._replace(sweep=(last - first) * move.sweep)


def height_at(move: Line | Arc, part: float) -> float:
    """Return Z at a part of a move."""
    return move.z0 + part * (move.z1 - move.z0)


def least_distance(a: Line | Arc, b: Line | Arc) -> float:
    """Return how near two moves come to each other."""
    if any(_is_beside(a, place) and _is_beside(b, place) for place in _crossings(a, b)):
        return 0.0
    ends = min(distance_from(a, end) for end in ((b.x0, b.c0), (b.x1, b.c1)))
    places = [(a.x0, a.c0), (a.x1, a.c1), *_facing(a, b)]
    return min(ends, *(distance_from(b, place) for place in places))


def _facing(a: Line | Arc, b: Line | Arc) -> list[Point]:
    """Return the places on ``a`` where its normal may be one of ``b``: square to it, or radial."""
    if isinstance(a, Line) and isinstance(b, Line):
        return []
    if isinstance(a, Line):
        tx, tc = start_direction(a)
        along = (b.cx - a.x0) * tx + (b.cc - a.c0) * tc
        return [(a.x0 + along * tx, a.c0 + along * tc)] if 0.0 < along < path_length(a) else []
    if isinstance(b, Line):
        tx, tc = start_direction(b)
        nx, nc = -tc, tx
    else:
        apart = hypot(b.cx - a.cx, b.cc - a.cc)
        if apart <= SAME_PLACE:
            return []
        nx, nc = (b.cx - a.cx) / apart, (b.cc - a.cc) / apart
    radius = arc_radius(a)
    places = [(a.cx + side * nx, a.cc + side * nc) for side in (radius, -radius)]
    return [place for place in places if _is_beside(a, place)]


def distance_from(move: Line | Arc, place: Point) -> float:
    """Return the distance of a place from a move."""
    x, c = nearest_place(move, place)
    return hypot(place[0] - x, place[1] - c)


def nearest_place(move: Line | Arc, place: Point) -> Point:
    """Return the place on a move that is nearest to another."""
    x, c = place
    if isinstance(move, Line):
        tx, tc = move.x1 - move.x0, move.c1 - move.c0
        part = ((x - move.x0) * tx + (c - move.c0) * tc) / (tx * tx + tc * tc)
        if 0.0 < part < 1.0:
            return move.x0 + part * tx, move.c0 + part * tc
        return (move.x0, move.c0) if part <= 0.0 else (move.x1, move.c1)
    away = hypot(x - move.cx, c - move.cc)
    if away and _is_beside(move, place):
        scale = arc_radius(move) / away
        return move.cx + (x - move.cx) * scale, move.cc + (c - move.cc) * scale
    to_start, to_end = hypot(x - move.x0, c - move.c0), hypot(x - move.x1, c - move.c1)
    return (move.x0, move.c0) if to_start <= to_end else (move.x1, move.c1)


def _is_beside(move: Line | Arc, place: Point) -> bool:
    """Return whether the nearest place of a move's line or circle is on the move."""
    if isinstance(move, Arc):
        return _arc_angle(move, place) <= abs(move.sweep)
    return 0.0 <= along_start(move, place) <= path_length(move)


def along_start(move: Line | Arc, place: Point) -> float:
    """Return how far along a move a place near its start lies; below zero in front of it."""
    if isinstance(move, Line):
        tx, tc = start_direction(move)
        return (place[0] - move.x0) * tx + (place[1] - move.c0) * tc
    angle = _arc_angle(move, place)
    before = max(pi - 0.5 * abs(move.sweep), 0.5)
    return arc_radius(move) * (angle if angle < 2 * pi - before else angle - 2 * pi)


def along_end(move: Line | Arc, place: Point) -> float:
    """Return how far along a move a place near its end lies; more than its length beyond it."""
    if isinstance(move, Line):
        return along_start(move, place)
    behind = abs(move.sweep) + max(pi - 0.5 * abs(move.sweep), 0.5)
    return arc_radius(move) * (behind - (behind - _arc_angle(move, place)) % (2 * pi))


def _arc_angle(move: Arc, place: Point) -> float:
    """Return the angle from an arc's start to a place, in its sense, 0 to a full turn."""
    ax, ac = move.x0 - move.cx, move.c0 - move.cc
    bx, bc = place[0] - move.cx, place[1] - move.cc
    angle = atan2(ax * bc - ac * bx, ax * bx + ac * bc)
    return (angle if move.sweep > 0.0 else -angle) % (2 * pi)


def _crossings(a: Line | Arc, b: Line | Arc) -> list[Point]:
    """Return the places common to the lines or circles that two moves lie on."""
    if isinstance(a, Arc):
        return _circle_circle(a, b) if isinstance(b, Arc) else _line_circle(b, a)
    return _line_circle(a, b) if isinstance(b, Arc) else _line_line(a, b)


def _line_line(a: Line, b: Line) -> list[Point]:
    ax, ac = start_direction(a)
    bx, bc = start_direction(b)
    sine = ax * bc - ac * bx
    if abs(sine) <= PARALLEL:
        return []
    along = ((b.x0 - a.x0) * bc - (b.c0 - a.c0) * bx) / sine
    return [(a.x0 + along * ax, a.c0 + along * ac)]


def _line_circle(line: Line, arc: Arc) -> list[Point]:
    tx, tc = start_direction(line)
    along = (arc.cx - line.x0) * tx + (arc.cc - line.c0) * tc
    foot = (line.x0 + along * tx, line.c0 + along * tc)
    half = _half_chord(hypot(arc.cx - foot[0], arc.cc - foot[1]), arc_radius(arc))
    return [(foot[0] + h * tx, foot[1] + h * tc) for h in half]


def _circle_circle(a: Arc, b: Arc) -> list[Point]:
    distance = hypot(b.cx - a.cx, b.cc - a.cc)
    if distance <= SAME_PLACE:
        return []
    ux, uc = (b.cx - a.cx) / distance, (b.cc - a.cc) / distance
    radius = arc_radius(a)
    along = 0.5 * (distance + (radius - arc_radius(b)) * (radius + arc_radius(b)) / distance)
    half = _half_chord(abs(along), radius)
    return [(a.cx + along * ux - h * uc, a.cc + along * uc + h * ux) for h in half]


def _half_chord(distance: float, radius: float) -> tuple[float, ...]:
    """Return half the chord at a distance from a circle's centre, with both signs, if any."""
    if distance > radius + SAME_PLACE:
        return ()
    half = sqrt(max(0.0, (radius - distance) * (radius + distance)))
    return (half, -half)
