# SPDX-License-Identifier: GPL-2.0-or-later
"""How fast C and the slide can follow a move that LinuxCNC plans in X and Y of the face.

On the face LinuxCNC knows nothing of the C axis, nor of what the slide has to do. Where the tool
is at the distance r from the pole with the velocity u along the radius and w around the pole, and
the acceleration a along the radius and b around it, C and the slide need

    C's speed            w / r
    C's acceleration     (b - 2 u w / r) / r
    the slide's          a + w**2 / r

An arc needs v**2 / R towards its centre. What the planner has beside that it uses along the path,
up to speed or down, wherever the operator may stop the feed: so it counts all along. Of each axis'
acceleration a place asks a share p v**2 and a share q for a unit of acceleration along the path:

    p v**2 + q sqrt(A**2 - (v**2 / R)**2) <= 1

With the tool beside the X line by p, r is where the slide stands, u and a go along it and w and b
around it. The slide's speed is u + p w / r, b is more by p (w / r)**2, and the slide's acceleration
by p times C's.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, copysign, inf, pi, sqrt
from typing import NamedTuple

from g12.compensation.contour import SAME_PLACE, PlaneMove
from g12.geometry.curve import Arc, Curve, sweep_between
from g12.polar.beside import along_and_around, stand
from g12.polar.pole import POLE

LOOKS = 16  # places on a line, and on each quarter of an arc, that are looked at
OVERSHOOT = 0.002  # seconds until polar_xzc sees that the feed is turned up
LEAST_SPEED = 1e-3  # program units per second
MOST_TURNING = 1e6  # radians for a unit of length: at the pole
LEAST_SQUARE = 1e-12  # of p and q / R together: nothing is asked of an axis
SLACK = 1.0 + 1e-9  # rounding: X and Y together may have just what the slide has
SEGMENTS, SOFT = 1.2, 4.0  # how segments come near to their speed: measured on a circle


class FaceLimits(NamedTuple):
    """What a machine can do on its face; lengths in program units, times in seconds."""

    acceleration: float  # of X and Y together: the most that the planner uses in any direction
    round_acceleration: float  # the most that it uses on an arc
    slide_acceleration: float
    c_acceleration: float  # radians per second squared
    c_speed: float  # radians per second
    override: float  # the most that the operator may turn the feed up to
    segments_speed: float  # about what segments reach far from the pole
    slide_speed: float = inf
    beside: float = 0.0  # the X line is the tool, towards C+


class Demand(NamedTuple):
    """What a move asks of C and the slide at one of its places.

    ``part`` of the move lies in front of it. Of their speeds it asks for all at ``fastest``, of
    their accelerations p times the square of the speed and q times that along the path, ``axes``.
    ``slowness`` is the time that segments take about there, for a unit of length.
    """

    part: float
    fastest: float
    axes: tuple[tuple[float, float], ...]
    slowness: float


def demands_of(move: PlaneMove, limits: FaceLimits) -> Sequence[Demand]:
    """Return the places of a move that are looked at, its ends among them."""
    return [_seen(move, part, limits) for part in (0.0, *looks(move.curve))]


def followed(move: PlaneMove, place: Demand, limits: FaceLimits, share: float = 1.0) -> float:
    """Return the most speed that C and the slide can follow at a place, a minute's way.

    At that and at any below, with a share of the planner's acceleration in use; inf where the
    planner itself goes no faster.
    """
    bend, most = 0.0, share * limits.acceleration
    if isinstance(move.curve, Arc):
        bend, most = 1.0 / move.curve.radius, share * limits.round_acceleration
    square = place.fastest * place.fastest
    for p, q in place.axes:
        standing = q * most
        if standing > SLACK:
            return 0.0
        both = p * p + q * q * bend * bend
        under = p * p - both * (1.0 - standing * standing)
        if both > LEAST_SQUARE and under >= 0.0:
            square = min(square, max(0.0, p - sqrt(under)) / both)
    if square * bend >= most:
        return inf
    return 60.0 * max(0.0, sqrt(square) - OVERSHOOT * most)


def is_able(move: PlaneMove, limits: FaceLimits, share: float = 1.0) -> bool:
    """Return whether C and the slide can follow a move on the face, wherever it is stopped."""
    return are_able(move, demands_of(move, limits), limits, share)


def are_able(move: PlaneMove, places: Sequence[Demand], limits: FaceLimits, share: float) -> bool:
    """Return the same by the places of a move."""
    return all(SLACK * followed(move, place, limits, share) >= move.feed for place in places)


def _seen(move: PlaneMove, part: float, limits: FaceLimits) -> Demand:
    curve, beside = move.curve, limits.beside
    place = curve.point(part)
    slide, way = stand(place, beside)
    along, around = along_and_around(curve.direction(part), way)
    slowness = _slowness(min(MOST_TURNING, abs(around) / max(slide, SAME_PLACE)), move.feed, limits)
    if abs(place) <= abs(beside) + SAME_PLACE:
        return Demand(part, 0.0, (), slowness)
    bent = copysign(1.0 / curve.radius, curve.sweep) if isinstance(curve, Arc) else 0.0
    turning = around / slide
    sliding = along + beside * turning
    pushed = (bent * along - 2.0 * turning * sliding + beside * turning * turning) / slide
    lifted = turning * turning * slide - bent * around + beside * pushed
    slowest = max(abs(turning) / limits.c_speed, abs(sliding) / (limits.slide_speed * SLACK))
    axes = (
        (abs(pushed) / limits.c_acceleration, abs(turning) / limits.c_acceleration),
        (abs(lifted) / limits.slide_acceleration, abs(sliding) / limits.slide_acceleration),
    )
    return Demand(part, 1.0 / slowest if slowest else inf, axes, slowness)


def _slowness(turning: float, feed: float, limits: FaceLimits) -> float:
    """Return about how long segments take for a unit of length where C turns so much for it.

    ``segments_speed`` is that where C accelerates as quickly as the slide. Nearer to the pole the
    chords are shorter, with the root of the distance, and C is slower.
    """
    even = limits.slide_acceleration / limits.c_acceleration
    slowest: float = max(1.0, even * turning) ** 0.75 / (
        SEGMENTS * max(limits.segments_speed, LEAST_SPEED)
    )
    slowed: float = ((60.0 / feed) ** SOFT + slowest**SOFT) ** (1.0 / SOFT)
    return max(slowed, turning / limits.c_speed)


def looks(curve: Curve) -> list[float]:
    """Return the shares of a move to look at: evenly spaced, and where it may be nearest."""
    count = LOOKS
    if isinstance(curve, Arc):
        count *= ceil(abs(curve.sweep) / (pi / 2))
        special = [_share_towards(curve, place) for place in (POLE, 2 * curve.centre)]
    else:
        special = [curve.length_to(POLE) / curve.length]
        far = abs(curve.start) / curve.length
        if far > 2.0:  # seen from the pole a short line hardly turns
            count = ceil(2.0 * count / far)
    return sorted({k / count for k in range(1, count + 1)} | {k for k in special if 0.0 < k < 1.0})


def _share_towards(arc: Arc, place: complex) -> float:
    """Return the share of an arc at which it is in the direction of a point from its centre."""
    turn = 1 if arc.sweep > 0.0 else -1
    return sweep_between(arc.start, place, arc.centre, turn) / arc.sweep
