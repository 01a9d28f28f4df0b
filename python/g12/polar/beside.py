# SPDX-License-Identifier: GPL-2.0-or-later
"""A tool that stands beside the X line: its slide does not pass the spindle's centre line.

The tool is at ``beside`` (POLAR_TOOL_OFFSET, Fanuc's parameter 5464) from the line on which the
slide moves it, above zero on the side to which C words grow. For the tool to be at the distance r
from the pole the slide has to stand at s, and C to be turned by less than the place's own angle:

                       . * tool           s = sqrt(r**2 - beside**2)
                r . '    |
             . '         | beside         the slide's direction e is turned from the radius
        . '              |                by -asin(beside / r)
    pole +---------------+---> e
                 s

A place nearer to the pole than ``beside`` cannot be reached at all, and none is tried: the path is
farther from it by the tolerance, and pieces are off the path by less.

Where the path makes the angle p with e, a straight move of X and C has the curvature

    sin p (1 + cos(p)**2 + beside / s cos p sin p) / s

to the left, and the slide moves by cos p + beside / s sin p per unit of the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, copysign, hypot, pi, sqrt

from g12.compensation.contour import (
    Arc,
    Contour,
    Element,
    Line,
    Point,
    arc_radius,
    direction_at,
    is_move,
    path_length,
)
from g12.compensation.intersect import distance_from, place_at
from g12.errors import number
from g12.moves.feed import Split
from g12.moves.spacing import BULGE, Density, Stretch, spaced
from g12.polar.pieces import Law
from g12.polar.pole import POLE


def stand(place: Point, beside: float) -> tuple[float, Point]:
    """Return where the slide stands for a place of the plane, and its direction in the plane."""
    x, c = place
    square = x * x + c * c
    if not square:
        return 0.0, (1.0, 0.0)
    slide = sqrt(max(0.0, square - beside * beside))
    return slide, ((slide * x + beside * c) / square, (slide * c - beside * x) / square)


def along_and_around(direction: Point, slide_direction: Point) -> Point:
    """Return the parts of a direction along the slide's and to its left."""
    (tx, tc), (ex, ec) = direction, slide_direction
    return tx * ex + tc * ec, ex * tc - ec * tx


def check_reach(contour: Contour, path: Sequence[Element], beside: float, tolerance: float) -> None:
    """Refuse a path that comes nearer to the pole than the tool can."""
    least = abs(beside) + tolerance
    for move in filter(is_move, path):
        nearest = distance_from(move, POLE)
        if nearest < least:
            contour.refuse(
                move.line,
                f"the tool's centre would come to {number(nearest)} from the spindle's centre: it "
                f"stands {number(abs(beside))} beside X's line (POLAR_TOOL_OFFSET) and comes no "
                f"nearer than {number(least)}",
            )


def split_beside(move: Line | Arc, law: Law, beside: float) -> Split:
    """Return the pieces of a move of a tool beside the X line: where the slide stands, and C."""
    length = path_length(move)

    def radius(at: float) -> float:
        return hypot(*place_at(move, at / length))

    stretch = Stretch(0.0, length, _apsides(move, length), radius)
    places, shares = spaced(stretch, _density(move, law, beside))
    stands = [
        stand(_moved(move, at / length, law.deviation * share), beside)
        for at, share in zip(places, shares)
    ]
    return Split([slide for slide, _ in stands], _angles(stands), places)


def _moved(move: Line | Arc, part: float, leftwards: float) -> Point:
    """Return a place of a move, moved to its left."""
    x, c = place = place_at(move, part)
    tx, tc = direction_at(move, place)
    return x - leftwards * tc, c + leftwards * tx


def _angles(stands: list[tuple[float, Point]]) -> list[float]:
    """Return the angles of the slide's directions, without a jump."""
    ex, ec = stands[0][1]
    angles = [atan2(ec, ex)]
    for _, (x, c) in stands[1:]:
        angles.append(angles[-1] + atan2(ex * c - ec * x, ex * x + ec * c))
        ex, ec = x, c
    return angles


def _apsides(move: Line | Arc, length: float) -> list[float]:
    """Return the places of a move, or beyond its ends, nearest to the pole or farthest from it."""
    if isinstance(move, Line):
        dx, dc = (move.x1 - move.x0) / length, (move.c1 - move.c0) / length
        foot = -(move.x0 * dx + move.c0 * dc)
        return [foot]
    turn = copysign(1.0, move.sweep)
    from_start = atan2(move.cc, move.cx) - atan2(move.c0 - move.cc, move.x0 - move.cx)
    first = turn * from_start % pi
    return [arc_radius(move) * (first + half) for half in (0.0, pi)]


def _density(move: Line | Arc, law: Law, beside: float) -> Density:
    """Return the pieces per unit of length, and the part of the deviation they use, to the left."""
    length, even = path_length(move), 0.5 / law.ripple
    own = copysign(1.0 / arc_radius(move), move.sweep) if isinstance(move, Arc) else 0.0
    bulging, flat = 1.0 / (8.0 * BULGE * law.deviation), 1.0 / (18.0 * BULGE * law.deviation)

    def density(at: float) -> tuple[float, float]:
        place = place_at(move, min(max(at / length, 0.0), 1.0))
        slide, way = stand(place, beside)
        along, around = along_and_around(direction_at(move, place), way)
        bend, change = _curvature(slide, along, around, beside, own)
        wanted = sqrt(bulging * abs(bend - own))
        growth, turning = abs(along + beside / slide * around) / slide, abs(around) / slide
        pieces = max(wanted, growth, turning, (flat * abs(change)) ** (1.0 / 3.0), 1.0 / length)
        smooth = even * growth * around * around
        if smooth > pieces:
            pieces = max(pieces, min(smooth, law.x_hold, law.c_hold * slide))
        return pieces, copysign((wanted / pieces) ** 2, bend - own)

    return density


def _curvature(slide: float, along: float, around: float, beside: float, own: float) -> Point:
    """Return the curvature of a straight move of X and C, and how it changes along the path.

    The path has the curvature ``own``, the directions are as of `along_and_around`.
    """
    share, square = beside / slide, around * around
    per_slide = -around * (1.0 + along * along + 2.0 * share * along * around) / slide
    per_angle = along * (1.0 + along * along - 2.0 * square)
    per_angle += share * around * (2.0 * along * along - square)
    bend = around * (1.0 + along * along + share * along * around) / slide
    change = per_slide * (along + share * around) + per_angle * (own - around / slide)
    return bend, change / slide
