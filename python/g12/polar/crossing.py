# SPDX-License-Identifier: GPL-2.0-or-later
"""Where two moves cross, and how far along a move a place lies. Program units."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

from g12.polar.contour import Arc, Line, Point, arc_radius, path_length, start_direction

REACH = 1e-6  # program units: as exact as a program is written
PARALLEL = 1e-9  # sine of an angle that is none


def crossing(a: Line | Arc, b: Line | Arc) -> Point | None:
    """Return where ``a`` is left for ``b``: their crossing nearest to the corner, if any."""
    length, best, nearest = path_length(a), None, 0.0
    for place in _crossings(a, b):
        leave, meet = along_end(a, place), along_start(b, place)
        on_both = -REACH <= leave <= length + REACH and -REACH <= meet <= path_length(b) + REACH
        if on_both and (best is None or length - leave + meet < nearest):
            best, nearest = place, length - leave + meet
    return best


def cross_inside(a: Line | Arc, b: Line | Arc, margin: float) -> bool:
    """Return whether two moves cross farther than ``margin`` from the ends of both."""
    return any(
        all(margin < along_start(move, place) < path_length(move) - margin for move in (a, b))
        for place in _crossings(a, b)
    )


def place_at(move: Line | Arc, part: float) -> Point:
    """Return the place at a part of a move, 0 at its start and 1 at its end."""
    if isinstance(move, Line):
        return move.x0 + part * (move.x1 - move.x0), move.c0 + part * (move.c1 - move.c0)
    angle = part * move.sweep
    x, c = move.x0 - move.cx, move.c0 - move.cc
    sine, cosine = sin(angle), cos(angle)
    return move.cx + x * cosine - c * sine, move.cc + x * sine + c * cosine


def distance_from(move: Line | Arc, place: Point) -> float:
    """Return the distance of a place from a move."""
    along, length = along_start(move, place), path_length(move)
    if not 0.0 <= along <= length:
        to_start = hypot(place[0] - move.x0, place[1] - move.c0)
        return min(to_start, hypot(place[0] - move.x1, place[1] - move.c1))
    if isinstance(move, Arc):
        return abs(hypot(place[0] - move.cx, place[1] - move.cc) - arc_radius(move))
    return sqrt(max(0.0, (place[0] - move.x0) ** 2 + (place[1] - move.c0) ** 2 - along * along))


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
    if distance <= REACH:
        return []
    ux, uc = (b.cx - a.cx) / distance, (b.cc - a.cc) / distance
    radius = arc_radius(a)
    along = 0.5 * (distance + (radius - arc_radius(b)) * (radius + arc_radius(b)) / distance)
    half = _half_chord(abs(along), radius)
    return [(a.cx + along * ux - h * uc, a.cc + along * uc + h * ux) for h in half]


def _half_chord(distance: float, radius: float) -> tuple[float, ...]:
    """Return half the chord at a distance from a circle's centre, with both signs, if any."""
    if distance > radius + REACH:
        return ()
    half = sqrt(max(0.0, (radius - distance) * (radius + distance)))
    return (half, -half)
