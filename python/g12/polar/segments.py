# SPDX-License-Identifier: GPL-2.0-or-later
"""Splitting: straight moves of X and C along a line or an arc, as long as the deviation allows.

The directions of a path are those of `pole`: p is its angle with the slide's direction e, s the
slide's position. A straight move of X and C has the curvature

    sin p (1 + cos(p)**2 + beside / s cos p sin p) / s

to the left, and the slide moves by cos p + beside / s sin p per unit of the path. A segment of
length L bulges from a path of another curvature by |difference| L**2 / 8. So a unit of length needs
sqrt(|difference| / (8 bulge)) segments.

The speed along the part is not constant inside a segment: it changes by the fraction
sin(p)**2 ds / s. Where s grows by more than e times these approximations fail: segments are
shorter.
"""

from __future__ import annotations

from cmath import rect
from math import copysign, pi
from typing import NamedTuple

from g12.geometry.curve import Arc, Curve, Line, angle_of
from g12.moves.steps import BULGE, Density, Split, Stretch, spaced
from g12.polar.pole import POLE, along_and_around, slide_at

RADIAL = 1e-9  # program units: a line that close to the pole is a radius
FEWEST = 0.5  # segments along a whole move, as a density: it is one segment


class Law(NamedTuple):
    """What limits the length of a segment, program units.

    ``deviation`` from the path; ``ripple``: how far the speed may be from its mean within a
    segment, relative. For an even speed segments are not made shorter than 1 / ``x_hold`` or 1 / (s
    ``c_hold``): on shorter ones the machine would not reach the speed.
    """

    deviation: float
    ripple: float
    x_hold: float
    c_hold: float


def split_move(curve: Curve, law: Law, beside: float = 0.0) -> Split:
    """Return the segments of a move of the tool's centre that does not run through the pole.

    They are positions of the slide, and C, of a tool ``beside`` the X line.
    """
    length = curve.length
    if not beside and isinstance(curve, Line) and _is_radial(curve):
        return _radius(curve)
    deviation = min(law.deviation, 0.5 * curve.distance(POLE))
    if isinstance(curve, Arc) and 2.0 * abs(curve.centre) <= deviation:
        return _circle(curve, beside)
    stretch = Stretch(0.0, length, _apsides(curve), lambda at: abs(curve.point(at / length)))
    lengths, shares = spaced(stretch, _density(curve, law._replace(deviation=deviation), beside))
    slides = [
        slide_at(_moved(curve, at / length, deviation * used), beside)
        for at, used in zip(lengths, shares)
    ]
    return Split([slide for slide, _ in slides], _angles(slides), lengths)


def _is_radial(line: Line) -> bool:
    return abs((line.start.conjugate() * line.direction()).imag) <= RADIAL


def _radius(line: Line) -> Split:
    """Return the one segment of a line towards the pole or away from it."""
    r0, r1 = abs(line.start), abs(line.end)
    angle = angle_of(line.start if r0 > r1 else line.end)
    return Split([r0, r1], [angle, angle], [0.0, line.length])


def _circle(arc: Arc, beside: float) -> Split:
    """Return the one segment of an arc about the pole."""
    (s0, before), (s1, after) = (slide_at(point, beside) for point in (arc.start, arc.end))
    angle, uneven = angle_of(before), angle_of(after * (before * rect(1.0, arc.sweep)).conjugate())
    return Split([s0, s1], [angle, angle + arc.sweep + uneven], [0.0, arc.length])


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
    fewest = FEWEST / length

    def density(at: float) -> tuple[float, float]:
        share = min(max(at / length, 0.0), 1.0)
        slide, slide_direction = slide_at(curve.point(share), beside)
        along, around = along_and_around(curve.direction(share), slide_direction)
        bend, change = _curvature(slide, along, around, beside, own)
        by_bulge = (bulging * abs(bend - own)) ** 0.5
        growth = abs(along + beside / slide * around) / slide
        segments = max(by_bulge, growth, (flat * abs(change)) ** (1.0 / 3.0), fewest)
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
