# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves in X and Y of the face, which LinuxCNC plans itself, and what C and the slide can follow.

On the face LinuxCNC knows nothing of the C axis, nor of what the slide has to do. Where the tool
is at the distance r from the pole with the velocity u along the radius and w around the pole, and
the acceleration a along the radius and b around it, C and the slide need

    C's speed            w / r
    C's acceleration     (b - 2 u w / r) / r
    the slide's          a + w**2 / r

An arc needs v**2 / R towards its centre. The planner uses the rest of its acceleration along the
path, wherever the operator holds the feed or releases it: so it is assumed everywhere. Of each
axis's acceleration a point needs a share p v**2, and a share q for a unit of acceleration along the
path:

    p v**2 + q sqrt(A**2 - (v**2 / R)**2) <= 1

With the tool beside the X line by p, r is the slide's position; u and a are along the slide, w and
b around it. The slide's speed is u + p w / r, b is more by p (w / r)**2, and the slide's
acceleration by p times C's.
"""

from __future__ import annotations

import cmath
from math import ceil, inf, pi, sqrt
from typing import NamedTuple

from g12.compensation.contour import SAME_POINT, PlaneMove, Plunge
from g12.geometry.curve import Arc, Curve, Line, angle_of
from g12.polar.pole import POLE, along_and_around, slide_at

CHECKED = 16  # points evaluated on a line, and on each quarter of an arc
OVERSHOOT = 0.002  # seconds until polar_xzc notices a higher override
LEAST_SPEED = 1e-3  # program units per second
MOST_TURNING = 1e6  # radians for a unit of length: at the pole
NO_TURNING = 1e-6  # likewise: along a radius
LEAST_SQUARE = 1e-12  # of p and q / R together: the axis does not accelerate
FOLLOW_SLACK = 1.0 + 1e-9  # rounding: X and Y together may have just what the slide has
SEGMENTS, SOFT = 1.2, 4.0  # measured on a circle: how far segments fall short of their speed


class FaceLimits(NamedTuple):
    """What a machine can do on its face; lengths in program units, times in seconds."""

    acceleration: float  # of X and Y together: the planner's greatest in any direction
    round_acceleration: float  # the planner's greatest on an arc
    slide_acceleration: float
    c_acceleration: float  # radians per second squared
    c_speed: float  # radians per second
    override: float  # the highest feed override
    segments_speed: float  # the approximate speed of segments far from the pole
    slide_speed: float = inf
    beside: float = 0.0  # from the X line to the tool, towards C+


class Demand(NamedTuple):
    """What a move demands of C and the slide at one of its points, ``at`` this share of it.

    At the speed ``fastest`` an axis is at its own limit. ``axes`` are p and q of C and of the
    slide: the shares of their accelerations for the square of the speed, and for the acceleration
    along the path. ``slowness`` is the approximate time of segments there, for a unit of length.
    """

    at: float
    fastest: float
    axes: tuple[tuple[float, float], ...]
    slowness: float


class MoveDemands:
    """What a move on the face demands at the ``points`` that are checked, its ends among them."""

    def __init__(self, move: PlaneMove, limits: FaceLimits) -> None:
        curve = move.curve
        self._feed, self._bend = move.feed, abs(curve.curvature)
        self._most = limits.round_acceleration if self._bend else limits.acceleration
        self.points = [_demand(move, at, limits) for at in (0.0, *shares_to_check(curve))]

    def highest_feed(self, point: Demand, share: float = 1.0) -> float:
        """Return the highest feed per minute that C and the slide can follow at a point.

        They can follow any lower feed too. ``share`` is the share of the planner's acceleration
        that is in use. The feed is inf where the planner itself limits it.
        """
        bend, most = self._bend, share * self._most
        square = point.fastest * point.fastest
        for p, q in point.axes:
            at_rest = q * most
            if at_rest > FOLLOW_SLACK:
                return 0.0
            both = p * p + q * q * bend * bend
            under = p * p - both * (1.0 - at_rest * at_rest)
            if both > LEAST_SQUARE and under >= 0.0:
                square = min(square, max(0.0, p - sqrt(under)) / both)
        if square * bend >= most:
            return inf
        return 60.0 * max(0.0, sqrt(square) - OVERSHOOT * most)

    def can_be_followed(self, share: float = 1.0) -> bool:
        """Return whether C and the slide can follow the move, wherever it is stopped."""
        return all(
            FOLLOW_SLACK * self.highest_feed(point, share) >= self._feed for point in self.points
        )


def _demand(move: PlaneMove, at: float, limits: FaceLimits) -> Demand:
    curve, beside = move.curve, limits.beside
    point = curve.point(at)
    slide, slide_direction = slide_at(point, beside)
    along, around = along_and_around(curve.direction(at), slide_direction)
    slowness = _slowness(min(MOST_TURNING, abs(around) / max(slide, SAME_POINT)), move.feed, limits)
    if abs(point) <= abs(beside) + SAME_POINT:
        return Demand(at, 0.0, (), slowness)
    bent, turning = curve.curvature, around / slide
    sliding = along + beside * turning
    pushed = (bent * along - 2.0 * turning * sliding + beside * turning * turning) / slide
    lifted = turning * turning * slide - bent * around + beside * pushed
    slowest = max(abs(turning) / limits.c_speed, abs(sliding) / (limits.slide_speed * FOLLOW_SLACK))
    axes = (
        (abs(pushed) / limits.c_acceleration, abs(turning) / limits.c_acceleration),
        (abs(lifted) / limits.slide_acceleration, abs(sliding) / limits.slide_acceleration),
    )
    return Demand(at, 1.0 / slowest if slowest else inf, axes, slowness)


def _slowness(turning: float, feed: float, limits: FaceLimits) -> float:
    """Return the approximate time of segments for a unit of length in which C turns so much.

    ``segments_speed`` applies where C accelerates as quickly as the slide. Nearer to the pole the
    chords are shorter, with the root of the distance, and C is slower. Where C does not turn, a
    segment has any length.
    """
    if turning < NO_TURNING:
        return 60.0 / feed
    even = limits.slide_acceleration / limits.c_acceleration
    slowest: float = max(1.0, even * turning) ** 0.75 / (
        SEGMENTS * max(limits.segments_speed, LEAST_SPEED)
    )
    slowed: float = ((60.0 / feed) ** SOFT + slowest**SOFT) ** (1.0 / SOFT)
    return max(slowed, turning / limits.c_speed)


def shares_to_check(curve: Curve) -> list[float]:
    """Return the shares of a move to check: evenly spaced, and those nearest to the pole."""
    count = CHECKED
    if isinstance(curve, Arc):
        count *= ceil(abs(curve.sweep) / (pi / 2))
        special = [curve.share_towards(point) for point in (POLE, 2 * curve.centre)]
    else:
        special = [curve.length_to(POLE) / curve.length]
        far = abs(curve.start) / curve.length
        if far > 2.0:  # C hardly turns on a short line far from the pole
            count = ceil(2.0 * count / far)
    return sorted({k / count for k in range(1, count + 1)} | {k for k in special if 0.0 < k < 1.0})


SAME_DIRECTION = 1e-6  # radians


def blending_halves(move: PlaneMove | Plunge, following: PlaneMove | Plunge) -> bool:
    """Return whether LinuxCNC would halve an arc's acceleration to blend the two moves.

    It does so where it can put no arc between them: where an arc continues tangentially, and where
    one of the moves is an arc, and they are not in one plane.
    """
    if isinstance(move, PlaneMove) and isinstance(following, PlaneMove):
        turned = move.curve.direction(1.0).conjugate() * following.curve.direction(0.0)
        if turned.real > 0.0 and abs(turned.imag) <= SAME_DIRECTION:
            return isinstance(move.curve, Arc)
    is_flat = move.h0 == move.h1 and following.h0 == following.h1
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
