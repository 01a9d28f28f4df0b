# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs of a section as LinuxCNC plans them itself, in X and Y of the face."""

from __future__ import annotations

import cmath
from typing import NamedTuple

from g12.compensation.contour import PlaneMove, Plunge
from g12.geometry.curve import Arc, Line, angle_of
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

    ``segments`` are places that the machine passes, X (radius value), C in degrees and Z: the last
    is the end, and no axis goes farther than they tell.
    """

    line: int
    move: PlaneMove | Plunge
    segments: list[tuple[float, float, float]]


def flows_into(move: object, following: object) -> bool:
    """Return whether an arc goes on in its own direction: nothing stops or is blended there."""
    if not isinstance(move, PlaneMove) or not isinstance(following, PlaneMove):
        return False
    turned = move.curve.direction(1.0).conjugate() * following.curve.direction(0.0)
    same = turned.real > 0.0 and abs(turned.imag) <= SAME_DIRECTION
    return same and isinstance(move.curve, Arc)


def in_face(move: PlaneMove | Plunge, angle: float) -> PlaneMove | Plunge:
    """Return a move of the plane in X and Y of a face whose X axis is at ``angle``, radians."""
    if isinstance(move, Plunge):
        return move
    curve, back = move.curve, cmath.rect(1.0, -angle)
    if isinstance(curve, Line):
        return move._replace(curve=Line(curve.start * back, curve.end * back))
    return move._replace(curve=Arc(curve.start * back, curve.centre * back, curve.sweep))


def passed(move: PlaneMove, angle: float, beside: float = 0.0) -> list[tuple[float, float, float]]:
    """Return places that a move passes: where the slide stands, C's angle in radians, Z.

    The farthest one and the end are among them. ``angle`` is that at the start; the angles go on
    from there without a jump.
    """
    curve, (_, before) = move.curve, stand(move.start, beside)
    places = []
    for share in looks(curve) if isinstance(curve, Arc) else (1.0,):
        slide, direction = stand(curve.point(share), beside)
        angle += angle_of(direction * before.conjugate())
        places.append((slide, angle, move.level(share)))
        before = direction
    return places
