# SPDX-License-Identifier: GPL-2.0-or-later
"""Spacing: the fewest segments along an element, with its deviation shared equally.

An element is described by one parameter, its place, and by a density: how many segments of full
length fit into a unit of it. The integral of the density, rounded up, is the number of segments;
equal steps of that integral give them equal deviations.

The inner ends of segments are moved off the path by the deviation, to the side that the segments do
not bulge to. That lets the segments bulge by more than the deviation, and so be longer. How much
more is limited by LinuxCNC's blending, which cuts the corners between segments: where they are too
short for the programmed speed, it cuts by up to 4/3 of the bulge (measured), so the bulge may be
3/2 of the deviation, and less where an end of an element is exactly on the path.

An element is divided at its apsides, the points nearest to the pole and farthest from it, which are
ends of segments: X turns round there, and a segment across would move C alone, or hardly any X.

              o             o             o      off the path by the deviation
           .    .         .   .         .
    x----.--------.-----.-------.-----.------    the path; x, its end, is exactly on it
      ' '           ' '           ' '            from o to o a segment bulges by 3/2 deviations
"""

from collections.abc import Callable
from math import ceil
from typing import NamedTuple

BULGE = 1.5  # deviations: of a segment between two ends moved off the path
WHOLE_BULGE = 0.75  # deviations: of a segment with both ends exactly on the path
LOSS = 0.18  # segments: what is lost where an element ends exactly on the path
WORTH_A_CUT = 0.5  # segments: an apsis nearer to an end of the element is left alone
MOST_SEGMENTS = 100_000  # of an element: more would take LinuxCNC's time and memory

Density = Callable[[float], tuple[float, float]]


class TooManySegments(Exception):
    """An element would need more segments than `MOST_SEGMENTS`."""


class Stretch(NamedTuple):
    """The places of an element: its ends, and the apsides, of which those between them count.

    ``nearness`` tells which of two places is nearer to the pole.
    """

    start: float
    end: float
    apsides: list[float]
    nearness: Callable[[float], float]


class _Part(NamedTuple):
    """A part of an element between two cuts, and one step after the other along it.

    ``places`` begin at the end nearer to the pole, and end beyond the other; ``shares`` are those
    between two of them. ``number`` segments would do. ``losses`` are those at the start and at the
    end of the part, ``cut`` is its start.
    """

    cut: float
    places: list[float]
    shares: list[float]
    number: float
    backwards: bool
    losses: tuple[float, float]


def spaced(stretch: Stretch, density: Density) -> tuple[list[float], list[float]]:
    """Return the places of the ends of an element's segments, and how far each is off the path.

    ``density`` gives for a place the segments per unit, and the part of the deviation, with the
    sign of the side, that they use. The distances are returned as parts of the deviation, too.
    Raises `TooManySegments`.
    """
    parts = _parts(stretch, density)
    _check_count(sum(part.number for part in parts))
    ends = [(stretch.start, 0.0)]
    for part in parts:
        lost = sum(part.losses)
        segments = ceil(part.number + lost - 1e-9)
        length = part.number / (segments - lost)
        if part.losses[0] == 0.0:
            ends.append((part.cut, length**2 * density(part.cut)[1]))
        ends.extend(_inner_ends(part, segments, length))
    places, shares = zip(*ends, (stretch.end, 0.0))
    return list(places), list(shares)


def _parts(stretch: Stretch, density: Density) -> list[_Part]:
    start, end = stretch.start, stretch.end
    apsides = [
        apsis
        for apsis in stretch.apsides
        if min(apsis - start, end - apsis) * density(apsis)[0] > WORTH_A_CUT
    ]
    cuts = [start, *apsides, end]
    losses = [LOSS, *(0.0 for _ in apsides), LOSS]
    return [
        _part(cuts[k], cuts[k + 1], (losses[k], losses[k + 1]), stretch, density)
        for k in range(len(cuts) - 1)
    ]


def _part(
    a: float, b: float, losses: tuple[float, float], stretch: Stretch, density: Density
) -> _Part:
    """Return the part between two cuts, measured in steps from its end nearer to the pole.

    The step in front of one tells where its middle will be. Near the pole the steps are shortest:
    measured from there they grow, and none is taken too far.
    """
    backwards = stretch.nearness(b) < stretch.nearness(a)
    place, far = (b, a) if backwards else (a, b)
    unit = 1.0 if far > place else -1.0
    places, shares = [place], list[float]()
    step = unit / density(place)[0]
    while not shares or (far - place) * unit > 0.0:
        segments, share = density(place + 0.5 * step)
        step = unit / segments
        place += step
        places.append(place)
        shares.append(share)
        _check_count(len(shares))
    number = len(shares) - (place - far) / step
    return _Part(a, places, shares, number, backwards, losses)


def _check_count(segments: float) -> None:
    if segments > MOST_SEGMENTS:
        raise TooManySegments


def _inner_ends(part: _Part, segments: int, length: float) -> list[tuple[float, float]]:
    """Return the ends of segments inside a part, in the sense of the motion.

    ``length`` is that of each segment, in segments of full length; the deviation goes with its
    square.
    """
    table, square = part.places, length * length
    shares = [part.shares[0], *part.shares, part.shares[-1]]
    near = part.losses[1 if part.backwards else 0]
    ends = []
    for k in range(1, segments):
        steps = length * (k - near)
        j = int(steps)
        place = table[j] + (steps - j) * (table[j + 1] - table[j])
        middle = int(steps + 0.5)
        share = shares[middle] + (steps + 0.5 - middle) * (shares[middle + 1] - shares[middle])
        ends.append((place, square * share))
    return ends[::-1] if part.backwards else ends
