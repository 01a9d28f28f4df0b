# SPDX-License-Identifier: GPL-2.0-or-later
"""The pole: the spindle's centre, where the C axis has no angle of its own.

A path that comes closer to the pole than ``reach`` is led through it exactly: in along a radius, a
turn of the C axis in place, out along another. Every move that touches the pole has an end there,
at exactly (0, 0).
"""

from __future__ import annotations

from math import copysign, hypot, pi

from g12.polar.contour import (
    Arc,
    Contour,
    Line,
    Plunge,
    Point,
    arc_radius,
    is_move,
    path_length,
    recentred,
    sweep_between,
)

POLE = (0.0, 0.0)


def through_pole(contour: Contour, path: list, reach: float, refused: bool) -> list:
    """Return the path with each move that comes within ``reach`` of the pole led into it."""
    led = []
    for move in path:
        if is_move(move) and _passes(move, reach):
            if refused:
                contour.refuse(
                    move.line,
                    "the path of the tool's centre runs through the spindle's centre "
                    "(POLAR_POLE = refuse)",
                )
            led.extend(_led(move, reach))
        else:
            led.append(move)
    return led


def _passes(move: Line | Arc, reach: float) -> bool:
    """Return whether a move comes within ``reach`` of the pole."""
    r0, r1 = hypot(move.x0, move.c0), hypot(move.x1, move.c1)
    if r0 + r1 - path_length(move) > 2.0 * reach:
        return False
    return r0 <= reach or r1 <= reach or _closest(move, reach) is not None


def _closest(move: Line | Arc, reach: float) -> float | None:
    """Return the fraction of a move at which it passes the pole, if it does within ``reach``."""
    if isinstance(move, Line):
        dx, dc = move.x1 - move.x0, move.c1 - move.c0
        square = dx * dx + dc * dc
        fraction = -(move.x0 * dx + move.c0 * dc) / square
        distance = abs(move.x0 * dc - move.c0 * dx) / square**0.5
    else:
        centre = (move.cx, move.cc)
        turn = 1 if move.sweep > 0.0 else -1
        fraction = sweep_between((move.x0, move.c0), POLE, centre, turn) / move.sweep
        distance = abs(hypot(*centre) - arc_radius(move))
    return fraction if 0.0 < fraction < 1.0 and distance <= reach else None


def _led(move: Line | Arc, reach: float) -> list:
    """Return the move, or its two halves, with the ends near the pole moved into it."""
    start, end = _snapped(move.x0, move.c0, reach), _snapped(move.x1, move.c1, reach)
    fraction = None if POLE in (start, end) else _closest(move, reach)
    if fraction is None:
        return _between(move, start, end, move.z0, move.z1, 1.0)
    z = move.z0 + fraction * (move.z1 - move.z0)
    return [
        *_between(move, start, POLE, move.z0, z, fraction),
        *_between(move, POLE, end, z, move.z1, 1.0 - fraction),
    ]


def _snapped(x: float, c: float, reach: float) -> Point:
    return POLE if hypot(x, c) <= reach else (x, c)


def _between(move: Line | Arc, start: Point, end: Point, z0: float, z1: float, part: float) -> list:
    """Return ``part`` of a move with new ends: one move, or none where nothing is left of it."""
    if isinstance(move, Line):
        if start != end:
            return [Line(move.line, move.feed, move.offset, *start, z0, *end, z1)]
    else:
        sweep = part * move.sweep
        if start != end or abs(sweep) > pi:
            return [_arc_between(move, start, end, z0, z1, sweep)]
    return [] if z0 == z1 else [Plunge(move.line, move.feed, z0, z1)]


def _arc_between(move: Arc, start: Point, end: Point, z0: float, z1: float, sweep: float) -> Arc:
    """Return an arc with new ends, its centre moved as little as that needs."""
    centre = (move.cx, move.cc)
    if start != end:
        centre = recentred(start, end, centre)
        exact = sweep_between(start, end, centre, 1 if sweep > 0.0 else -1)
        if abs(exact - sweep) > pi:
            exact += copysign(2 * pi, sweep - exact)
        sweep = exact
    return Arc(move.line, move.feed, move.offset, *start, z0, *end, z1, *centre, sweep)
