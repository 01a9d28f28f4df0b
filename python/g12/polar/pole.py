# SPDX-License-Identifier: GPL-2.0-or-later
"""The pole: the spindle's centre, where the C axis has no angle of its own.

A path that comes closer to the pole than ``pole_radius`` is led through it exactly: in along a
radius, a rotation of C at the pole, out along another. A line is such a radius nearly; of an arc
the part beside the pole is replaced that a radius leaves by a fifth of ``pole_radius`` at most.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import asin, hypot, sqrt

from g12.compensation.contour import (
    Arc,
    Contour,
    Element,
    Line,
    Plunge,
    arc_radius,
    is_move,
    sweep_between,
)
from g12.compensation.intersect import height_at, part_of_move, place_at

POLE = (0.0, 0.0)
FLAT_SHARE = 0.2  # of pole_radius: how far the radii that replace an arc may be from it


def through_pole(
    contour: Contour, path: Sequence[Element], pole_radius: float, refused: bool
) -> list[Element]:
    """Return the path with each move that comes within ``pole_radius`` of the pole led into it."""
    led: list[Element] = []
    for move in path:
        parts = _led(move, pole_radius) if is_move(move) else None
        if parts is None:
            led.append(move)
        elif refused:
            contour.refuse(
                move.line,
                "the path of the tool's centre runs through the spindle's centre "
                "(POLAR_POLE = refuse)",
            )
        else:
            led.extend(parts)
    return led


def _led(move: Line | Arc, pole_radius: float) -> list[Element] | None:
    """Return what replaces a move within ``pole_radius`` of the pole, None for others."""
    r0, r1 = hypot(move.x0, move.c0), hypot(move.x1, move.c1)
    ends = [float(k) for k, radius in enumerate((r0, r1)) if radius <= pole_radius]
    if isinstance(move, Line):
        return _replaced(move, ends[:1] or _line_passes(move, pole_radius), 1.0, pole_radius)
    radius = arc_radius(move)
    half = 2.0 * asin(min(0.5, sqrt(2.0 * FLAT_SHARE * pole_radius / radius))) / abs(move.sweep)
    inside = [
        part
        for part in _arc_passes(move, radius, pole_radius)
        if all(abs(part - end) > half for end in ends)
    ]
    return _replaced(move, sorted(ends + inside), half, pole_radius)


def _line_passes(move: Line, pole_radius: float) -> list[float]:
    """Return the part of a line at which it passes the pole, if it does within ``pole_radius``."""
    dx, dc = move.x1 - move.x0, move.c1 - move.c0
    length = hypot(dx, dc)
    part = -(move.x0 * dx + move.c0 * dc) / (length * length)
    distance = abs(move.x0 * dc - move.c0 * dx) / length
    return [part] if 0.0 < part < 1.0 and distance <= pole_radius else []


def _arc_passes(move: Arc, radius: float, pole_radius: float) -> list[float]:
    """Return the part of an arc at which it passes the pole, if it does within ``pole_radius``."""
    centre, turn = (move.cx, move.cc), 1 if move.sweep > 0.0 else -1
    if abs(hypot(*centre) - radius) > pole_radius:
        return []
    part = sweep_between((move.x0, move.c0), POLE, centre, turn) / move.sweep
    return [part] if part < 1.0 else []


def _replaced(
    move: Line | Arc, passes: list[float], half: float, pole_radius: float
) -> list[Element] | None:
    """Return the move with its parts up to ``half`` beside each pass replaced by radii."""
    if not passes:
        return None
    moves, done = list[Element](), 0.0
    for part in passes:
        if part - half > done:
            moves.append(part_of_move(move, done, part - half))
            done = part - half
        moves.extend(_radius(move, done, part, pole_radius))
        done = min(part + half, 1.0)
        moves.extend(_radius(move, done, part, pole_radius, outwards=True))
    if done < 1.0:
        moves.append(part_of_move(move, done, 1.0))
    return moves


def _radius(
    move: Line | Arc, part: float, at_pole: float, pole_radius: float, outwards: bool = False
) -> list[Element]:
    """Return the radius between a place of a move and the pole: nothing where it is there."""
    place, height = place_at(move, part), height_at(move, part)
    pole_height = height_at(move, at_pole)
    ends = (*place, height, *POLE, pole_height)
    if outwards:
        ends = (*POLE, pole_height, *place, height)
    if hypot(*place) > pole_radius:
        return [Line(move.line, move.feed, move.offset, *ends)]
    return [] if height == pole_height else [Plunge(move.line, move.feed, ends[2], ends[5])]
