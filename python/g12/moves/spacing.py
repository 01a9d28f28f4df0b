# SPDX-License-Identifier: GPL-2.0-or-later
"""Spacing: the fewest segments along an element, with its deviation shared equally.

An element is described by one parameter, the position along it, and by a density: how many
segments of full length fit into a unit of the parameter. The integral of the density, rounded up,
is the number of segments; equal steps of that integral give them equal deviations.

The inner ends of segments are moved off the path by the deviation, to the side that the segments do
not bulge to. That lets the segments bulge by more than the deviation, and so be longer. How much
more is limited by LinuxCNC's blending, which cuts the corners between segments: where they are too
short for the programmed speed, it cuts by up to 4/3 of the bulge (measured), so the bulge may be
3/2 of the deviation, and less where an end of an element is exactly on the path.

An element is divided at its apsides, the points nearest to the pole and farthest from it, which are
ends of segments: X reverses there, and a segment across would move C alone, or hardly any X.

              o             o             o      off the path by the deviation
           .    .         .   .         .
    x----.--------.-----.-------.-----.------    the path; x, its end, is exactly on it
      ' '           ' '           ' '            from o to o a segment bulges by 3/2 deviations
"""

from collections.abc import Callable
from math import ceil
from typing import NamedTuple

BULGE = 1.5  # deviations: of a segment between two ends moved off the path
LOSS = 0.18  # segments: lost where an element ends exactly on the path
WORTH_DIVIDING = 0.5  # segments: at an apsis nearer to an end the element is not divided
MOST_SEGMENTS_OF_MOVE = 100_000  # of an element: more would cost LinuxCNC too much time and memory

Density = Callable[[float], tuple[float, float]]


class TooManySegments(Exception):
    """An element would need more segments than `MOST_SEGMENTS_OF_MOVE`."""


class Stretch(NamedTuple):
    """The ends of an element, as positions along it, and its apsides; those outside it are ignored.

    ``nearness`` is a sort key: the smaller, the nearer a position is to the pole.
    """

    start: float
    end: float
    apsides: list[float]
    nearness: Callable[[float], float]


class _Portion(NamedTuple):
    """The portion of an element between two of its divisions, in steps of one segment each.

    ``positions`` begin at the end nearer to the pole and run past the other one. ``shares`` are the
    shares of the deviation between two of them. ``number`` segments suffice. ``losses`` are those
    at the ends of the portion, ``start`` is its first position.
    """

    start: float
    positions: list[float]
    shares: list[float]
    number: float
    backwards: bool
    losses: tuple[float, float]


def spaced(stretch: Stretch, density: Density) -> tuple[list[float], list[float]]:
    """Return the ends of an element's segments, as positions along it, and their deviations.

    ``density`` returns for a position the segments per unit, and the share of the allowed deviation
    that they use, with the sign of the side. The deviations are returned as such shares, too.
    Raises `TooManySegments`.
    """
    portions = _portions(stretch, density)
    _check_count(sum(portion.number for portion in portions))
    ends = [(stretch.start, 0.0)]
    for portion in portions:
        lost = sum(portion.losses)
        segments = ceil(portion.number + lost - 1e-9)
        length = portion.number / (segments - lost)
        if portion.losses[0] == 0.0:
            ends.append((portion.start, length**2 * density(portion.start)[1]))
        ends.extend(_inner_ends(portion, segments, length))
    positions, shares = zip(*ends, (stretch.end, 0.0))
    return list(positions), list(shares)


def _portions(stretch: Stretch, density: Density) -> list[_Portion]:
    start, end = stretch.start, stretch.end
    apsides = [
        apsis
        for apsis in stretch.apsides
        if start < apsis < end
        and min(apsis - start, end - apsis) * density(apsis)[0] > WORTH_DIVIDING
    ]
    divisions = [start, *apsides, end]
    losses = [LOSS, *(0.0 for _ in apsides), LOSS]
    return [
        _portion(divisions[k], divisions[k + 1], (losses[k], losses[k + 1]), stretch, density)
        for k in range(len(divisions) - 1)
    ]


def _portion(
    a: float, b: float, losses: tuple[float, float], stretch: Stretch, density: Density
) -> _Portion:
    """Return the portion between two divisions, stepped from its end nearer to the pole.

    The middle of a step is predicted by the step before it. Near the pole the steps are shortest:
    from there they grow, so that none is predicted too long.
    """
    backwards = stretch.nearness(b) < stretch.nearness(a)
    position, far = (b, a) if backwards else (a, b)
    unit = 1.0 if far > position else -1.0
    positions, shares = [position], list[float]()
    step = unit / density(position)[0]
    while not shares or (far - position) * unit > 0.0:
        segments, share = density(position + 0.5 * step)
        step = unit / segments
        position += step
        positions.append(position)
        shares.append(share)
        _check_count(len(shares))
    number = len(shares) - (position - far) / step
    return _Portion(a, positions, shares, number, backwards, losses)


def _check_count(segments: float) -> None:
    if segments > MOST_SEGMENTS_OF_MOVE:
        raise TooManySegments


def _inner_ends(portion: _Portion, segments: int, length: float) -> list[tuple[float, float]]:
    """Return the ends of segments inside a portion, in the direction of motion.

    ``length`` is that of each segment, in segments of full length; the deviation goes with its
    square.
    """
    table, square = portion.positions, length * length
    shares = [portion.shares[0], *portion.shares, portion.shares[-1]]
    near = portion.losses[1 if portion.backwards else 0]
    ends = []
    for k in range(1, segments):
        steps = length * (k - near)
        j = int(steps)
        position = table[j] + (steps - j) * (table[j + 1] - table[j])
        middle = int(steps + 0.5)
        share = shares[middle] + (steps + 0.5 - middle) * (shares[middle + 1] - shares[middle])
        ends.append((position, square * share))
    return ends[::-1] if portion.backwards else ends
