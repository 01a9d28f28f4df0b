# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs of a section as LinuxCNC plans them itself, in X and Y of the face."""

from __future__ import annotations

from math import atan2, cos, sin
from typing import NamedTuple

from g12.compensation.contour import Arc, Line, Plunge, end_direction, start_direction
from g12.compensation.intersect import height_at, place_at
from g12.polar.beside import stand
from g12.polar.follow import looks

SAME_DIRECTION = 1e-6  # radians


class FaceSwitch(NamedTuple):
    """Going to the face (``on``), or back, where the machine stands at ``place``."""

    line: int
    on: bool
    place: tuple[float, float, float]  # X (radius value), C in degrees, Z
    share: float = 1.0  # of the INI's accelerations of X and Y, until the way back
    override: float = 1.0  # so far the operator may turn the feed up there


class FaceMove(NamedTuple):
    """A move on the face, in its X and Y: C's zero line is where C stood at the switch.

    ``pieces`` are places that the machine passes, X (radius value), C in degrees and Z: the last
    is the end, and no axis goes farther than they tell.
    """

    line: int
    move: Line | Arc | Plunge
    pieces: list[tuple[float, float, float]]


def flows_into(move: object, following: object) -> bool:
    """Return whether an arc goes on in its own direction: nothing stops or is blended there."""
    if not isinstance(move, Arc) or not isinstance(following, (Line, Arc)):
        return False
    (x0, c0), (x1, c1) = end_direction(move), start_direction(following)
    return x0 * x1 + c0 * c1 > 0.0 and abs(x0 * c1 - c0 * x1) <= SAME_DIRECTION


def in_face(move: Line | Arc | Plunge, angle: float) -> Line | Arc | Plunge:
    """Return a move of the plane in X and Y of a face whose X axis is at ``angle``, radians."""
    if isinstance(move, Plunge):
        return move
    (x0, c0), (x1, c1) = (
        _turned(*place, -angle) for place in ((move.x0, move.c0), (move.x1, move.c1))
    )
    if isinstance(move, Line):
        return move._replace(x0=x0, c0=c0, x1=x1, c1=c1)
    cx, cc = _turned(move.cx, move.cc, -angle)
    return move._replace(x0=x0, c0=c0, x1=x1, c1=c1, cx=cx, cc=cc)


def _turned(x: float, c: float, angle: float) -> tuple[float, float]:
    return x * cos(angle) - c * sin(angle), x * sin(angle) + c * cos(angle)


def passed(move: Line | Arc, angle: float, beside: float = 0.0) -> list[tuple[float, float, float]]:
    """Return places that a move passes: where the slide stands, C's angle in radians, Z.

    The farthest one and the end are among them. ``angle`` is that at the start; the angles go on
    from there without a jump.
    """
    places, (_, before) = [], stand((move.x0, move.c0), beside)
    for part in looks(move) if isinstance(move, Arc) else (1.0,):
        slide, (x, c) = stand(place_at(move, part), beside)
        angle += atan2(before[0] * c - before[1] * x, before[0] * x + before[1] * c)
        places.append((slide, angle, height_at(move, part)))
        before = x, c
    return places
