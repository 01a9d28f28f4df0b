# SPDX-License-Identifier: GPL-2.0-or-later
"""A tool beside the X line: its slide does not pass the spindle's centre line.

The tool is ``beside`` (POLAR_TOOL_OFFSET, Fanuc's parameter 5464) away from the line on which the
slide moves it, above zero on the side to which C words grow. For the tool to be at the distance r
from the pole the slide has to be at s, and C at less than the angle of the point:

                       . * tool           s = sqrt(r**2 - beside**2)
                r . '    |
             . '         | beside         the slide's direction e is turned from the radius
        . '              |                by -asin(beside / r)
    pole +---------------+---> e
                 s

No point nearer to the pole than ``beside`` can be reached, and none is commanded:
`check_pole_distance` refuses a path within the tolerance of that circle, and segments deviate by
less.

Where the path makes the angle p with e, a straight move of X and C has the curvature

    sin p (1 + cos(p)**2 + beside / s cos p sin p) / s

to the left, and the slide moves by cos p + beside / s sin p per unit of the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, pi, sqrt

from g12.compensation.contour import Contour, PathElement, PlaneMove
from g12.errors import number
from g12.geometry.curve import Curve, Line, angle_of
from g12.moves.feed import Split
from g12.moves.spacing import BULGE, Density, Stretch, spaced
from g12.polar.pole import POLE
from g12.polar.segments import Law


def slide_at(point: complex, beside: float) -> tuple[float, complex]:
    """Return the slide's position for a point of the plane, and its direction in the plane."""
    square = (point * point.conjugate()).real
    if not square:
        return 0.0, 1 + 0j
    slide = sqrt(max(0.0, square - beside * beside))
    return slide, point * complex(slide, -beside) / square


def along_and_around(direction: complex, slide_direction: complex) -> tuple[float, float]:
    """Return the components of a direction along the slide's and to its left."""
    turned = direction * slide_direction.conjugate()
    return turned.real, turned.imag


def check_pole_distance(
    contour: Contour, path: Sequence[PathElement], beside: float, tolerance: float
) -> None:
    """Refuse a path that comes nearer to the pole than the tool can."""
    least = abs(beside) + tolerance
    for move in (element for element in path if isinstance(element, PlaneMove)):
        nearest = move.curve.distance(POLE)
        if nearest < least:
            contour.refuse(
                move.line,
                f"the tool's centre would come to {number(nearest)} from the spindle's centre: it "
                f"is {number(abs(beside))} beside X's line (POLAR_TOOL_OFFSET) and comes no "
                f"nearer than {number(least)}",
            )


def split_beside(curve: Curve, law: Law, beside: float) -> Split:
    """Return the segments of a move of a tool beside the X line: positions of the slide, and C."""
    length = curve.length

    def radius(at: float) -> float:
        return abs(curve.point(at / length))

    stretch = Stretch(0.0, length, _apsides(curve), radius)
    lengths, shares = spaced(stretch, _density(curve, law, beside))
    slides = [
        slide_at(_moved(curve, at / length, law.deviation * used), beside)
        for at, used in zip(lengths, shares)
    ]
    return Split([slide for slide, _ in slides], _angles(slides), lengths)


def _moved(curve: Curve, share: float, leftwards: float) -> complex:
    return curve.point(share) + 1j * leftwards * curve.direction(share)


def _angles(slides: list[tuple[float, complex]]) -> list[float]:
    """Return the angles of the slide's directions, without a jump."""
    before = slides[0][1]
    angles = [angle_of(before)]
    for _, direction in slides[1:]:
        angles.append(angles[-1] + angle_of(direction * before.conjugate()))
        before = direction
    return angles


def _apsides(curve: Curve) -> list[float]:
    """Return the lengths along a move, also outside it, of its apsides about the pole."""
    if isinstance(curve, Line):
        return [curve.length_to(POLE)]
    turn = copysign(1.0, curve.sweep)
    from_start = angle_of(curve.centre) - angle_of(curve.start - curve.centre)
    first = turn * from_start % pi
    return [curve.radius * (first + half) for half in (0.0, pi)]


def _density(curve: Curve, law: Law, beside: float) -> Density:
    """Return the segments per unit of length, and their share of the deviation (+ is left)."""
    length, own, even = curve.length, curve.curvature, 0.5 / law.ripple
    bulging, flat = 1.0 / (8.0 * BULGE * law.deviation), 1.0 / (18.0 * BULGE * law.deviation)

    def density(at: float) -> tuple[float, float]:
        share = min(max(at / length, 0.0), 1.0)
        slide, slide_direction = slide_at(curve.point(share), beside)
        along, around = along_and_around(curve.direction(share), slide_direction)
        bend, change = _curvature(slide, along, around, beside, own)
        by_bulge = sqrt(bulging * abs(bend - own))
        growth, turning = abs(along + beside / slide * around) / slide, abs(around) / slide
        segments = max(by_bulge, growth, turning, (flat * abs(change)) ** (1.0 / 3.0), 1.0 / length)
        smooth = even * growth * around * around
        if smooth > segments:
            segments = max(segments, min(smooth, law.x_hold, law.c_hold * slide))
        return segments, copysign((by_bulge / segments) ** 2, bend - own)

    return density


def _curvature(
    slide: float, along: float, around: float, beside: float, own: float
) -> tuple[float, float]:
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
