# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs of a section in X and Y of the face, which LinuxCNC's own planner executes."""

from __future__ import annotations

import cmath
from typing import NamedTuple

from g12.compensation.contour import PlaneMove, Plunge
from g12.geometry.curve import Arc, Line, angle_of
from g12.polar.follow import shares_to_check
from g12.polar.pole import slide_at

SAME_DIRECTION = 1e-6  # radians


class FaceSwitch(NamedTuple):
    """The switch to the face (``on``), or back, at the machine's ``position``."""

    line: int
    on: bool
    position: tuple[float, float, float]  # X (radius value), C in degrees, Z
    share: float = 1.0  # of the INI's accelerations of X and Y, until the switch back
    override: float = 1.0  # the highest feed override that is followed there


class FaceMove(NamedTuple):
    """A move on the face, in its X and Y: C's zero line is the angle of C at the switch.

    ``segments`` are positions on the move, X (radius value), C in degrees and Z. The last is the
    end, and they include the extremes of every axis.
    """

    line: int
    move: PlaneMove | Plunge
    segments: list[tuple[float, float, float]]


def blending_halves(move: PlaneMove | Plunge, following: PlaneMove | Plunge) -> bool:
    """Return whether LinuxCNC would halve an arc's acceleration to blend the two moves.

    It does so where it can put no arc between them: where an arc continues tangentially, and where
    one of the moves is an arc, and they are not in one plane.
    """
    if isinstance(move, PlaneMove) and isinstance(following, PlaneMove):
        turned = move.curve.direction(1.0).conjugate() * following.curve.direction(0.0)
        if turned.real > 0.0 and abs(turned.imag) <= SAME_DIRECTION:
            return isinstance(move.curve, Arc)
    is_flat = move.z0 == move.z1 and following.z0 == following.z1
    return not is_flat and (is_arc(move) or is_arc(following))


def is_arc(move: PlaneMove | Plunge) -> bool:
    return isinstance(move, PlaneMove) and isinstance(move.curve, Arc)


def in_face(move: PlaneMove | Plunge, angle: float) -> PlaneMove | Plunge:
    """Return a move of the plane in X and Y of a face whose X axis is at ``angle``, radians."""
    if isinstance(move, Plunge):
        return move
    curve, back = move.curve, cmath.rect(1.0, -angle)
    if isinstance(curve, Line):
        return move._replace(curve=Line(curve.start * back, curve.end * back))
    return move._replace(curve=Arc(curve.start * back, curve.centre * back, curve.sweep))


def positions_along(
    move: PlaneMove, angle: float, beside: float = 0.0
) -> list[tuple[float, float, float]]:
    """Return positions on a move: of the slide, of C in radians, of Z.

    The farthest one and the end are among them. ``angle`` is C's at the start; the angles continue
    from it without a jump.
    """
    curve, (_, before) = move.curve, slide_at(move.start, beside)
    points = []
    for share in shares_to_check(curve) if isinstance(curve, Arc) else (1.0,):
        slide, direction = slide_at(curve.point(share), beside)
        angle += angle_of(direction * before.conjugate())
        points.append((slide, angle, move.level(share)))
        before = direction
    return points
