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
from collections.abc import Callable
from math import atan2, copysign, pi, remainder, sqrt
from typing import NamedTuple

from g12.geometry.curve import FULL_TURN, Arc, Curve, Line, angle_of
from g12.moves.steps import BULGE, Density, Split, spaced

RADIAL = 1e-9  # program units: a line that close to the pole is a radius
FEWEST = 0.5  # segments along a whole move, as a density: it is one segment
SHORT = 0.1  # of the distance from the pole: the density along such a move is even, and
WHOLE = 0.7  # segments by the bulge are one: with both ends on the path it is 3/4 of the deviation

Seen = Callable[[float], complex]  # a path as `_seen_from_pole` returns it


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
    seen, length = _seen_from_pole(curve), curve.length
    start = seen(0.0)
    if isinstance(curve, Line) and not beside and abs(start.imag) <= RADIAL:
        return _radius(curve)
    apsides = _apsides(curve, start)
    nearest = min(map(abs, [start, seen(length), *map(seen, apsides)]))
    deviation = min(law.deviation, 0.5 * nearest)
    density = _density(seen, length, curve.curvature, deviation, law, beside)
    if _is_one_segment(curve, start, deviation, density, beside):
        lengths, shares = [0.0, length], [0.0, 0.0]
    else:
        lengths, shares = spaced(length, density, apsides, lambda at: abs(seen(at)))
    slides: list[float] = []
    angles: list[float] = []
    angle, before, bend = angle_of(curve.direction(0.0)), 0.0, curve.curvature
    square = beside * beside
    for at, share in zip(lengths, shares):
        there = seen(at)
        x, y = there.real, there.imag - deviation * share
        slide = sqrt(x * x + y * y - square)
        phase = atan2(y * slide + x * beside, x * slide - y * beside)  # of motion against slide
        angle -= remainder(phase - before, FULL_TURN)
        before = phase
        slides.append(slide)
        angles.append(angle + bend * at)
    return Split(slides, angles, lengths)


def _radius(line: Line) -> Split:
    """Return the one segment of a line towards the pole or away from it."""
    r0, r1 = abs(line.start), abs(line.end)
    angle = angle_of(line.start if r0 > r1 else line.end)
    return Split([r0, r1], [angle, angle], [0.0, line.length])


def _seen_from_pole(curve: Curve) -> Seen:
    """Return a function of the length along a move: its direction as seen from the pole.

    The angle is that with the radius, the absolute value is the distance from the pole.
    """
    direction, bend = curve.direction(0.0), curve.curvature
    start = direction * curve.start.conjugate()
    if isinstance(curve, Line):
        return start.__add__
    centre = direction * curve.centre.conjugate()
    return lambda at: start + centre * (rect(1.0, bend * at) - 1.0)


def _apsides(curve: Curve, start: complex) -> list[float]:
    """Return the lengths along a move to its apsides about the pole.

    ``start`` is its start as seen from the pole.
    """
    length = curve.length
    if isinstance(curve, Line):
        return [-start.real] if 0.0 < -start.real < length else []
    turn = copysign(1.0, curve.sweep)
    from_start = angle_of(curve.centre) - angle_of(curve.start - curve.centre)
    first = turn * from_start % pi
    both = (curve.radius * (first + half) for half in (0.0, pi))
    return [at for at in both if 0.0 < at < length]


def _is_one_segment(
    curve: Curve, start: complex, deviation: float, density: Density, beside: float
) -> bool:
    """Return whether a move is an arc about the pole, or so short that its density is even."""
    if isinstance(curve, Arc) and 2.0 * abs(curve.centre) <= deviation:
        return True
    length = curve.length
    if length >= SHORT * (abs(start) - abs(beside)):
        return False
    segments, share = density(0.5 * length)
    return length * segments <= 1.0 and length * segments * sqrt(abs(share)) < WHOLE


def _density(
    seen: Seen, length: float, own: float, deviation: float, law: Law, beside: float
) -> Density:
    """Return the segments per unit of length, and their share of the deviation (+ is left).

    ``seen`` is the path from the pole, ``own`` its curvature.
    """
    even, fewest = 0.5 / law.ripple, FEWEST / length
    bulging, flat = 1.0 / (8.0 * BULGE * deviation), 1.0 / (18.0 * BULGE * deviation)
    beside_square = beside * beside

    def density(at: float) -> tuple[float, float]:
        there = seen(0.0 if at < 0.0 else at if at < length else length)
        x, y = there.real, there.imag
        square = x * x + y * y
        slide_square = square - beside_square
        slide = sqrt(slide_square)
        along, around = (x * slide - y * beside) / square, (y * slide + x * beside) / square
        sliding, turning, growth = x / slide, around / slide, abs(x) / slide_square
        bulge = bulging * (turning * (1.0 + along * sliding) - own)
        segments = sqrt(abs(bulge))
        if growth > segments:
            segments = growth
        if fewest > segments:
            segments = fewest
        if own or beside:  # the curvatures may be equal
            change = (3.0 * along * along - 1.0) * own - 2.0 * along * turning * (along + sliding)
            cube = flat * growth * abs(change)
            if cube > segments * segments * segments:
                segments = cube ** (1.0 / 3.0)
        smooth = even * growth * around * around
        if smooth > segments:
            segments = max(segments, min(smooth, law.x_hold, law.c_hold * slide))
        return segments, bulge / (segments * segments)

    return density
