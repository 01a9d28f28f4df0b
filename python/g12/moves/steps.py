# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of a planned section, in the order of the program: their number and their F words.

LinuxCNC in G94 takes F for the linear axes of a move, or for degrees per minute where only a rotary
axis moves. Every segment gets the F that makes it last as long as its portion of the path at the
programmed feed.

Debian's 2.9.0~pre1 runs a segment too fast that moves a slide by next to nothing together with a
rotary axis. So a segment that would move it by less than ``least`` leaves the slide where it is, to
the last digit; the next segment adds the remainder.

An element has the fewest segments, which share its deviation equally. One parameter describes it,
the position along it, and a density: how many segments of full length fit into a unit of the
parameter. The integral of the density, rounded up, is the number of segments; equal steps of that
integral give them equal deviations.

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

Lengths are in program units.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import ceil, degrees, hypot
from typing import NamedTuple

from g12.compensation.contour import Motion, PlaneMove, Start
from g12.section.effects import Action, BlockEnd

BULGE = 1.5  # deviations: of a segment between two ends moved off the path
LOSS = 0.18  # segments: lost where an element ends exactly on the path
WORTH_DIVIDING = 0.5  # segments: at an apsis nearer to an end the element is not divided
MOST_SEGMENTS_OF_MOVE = 100_000  # of an element: more would cost LinuxCNC too much time and memory

Density = Callable[[float], tuple[float, float]]


class TooManySegments(Exception):
    """An element would need more segments than `MOST_SEGMENTS_OF_MOVE`."""


def spaced(
    length: float,
    density: Density,
    apsides: Sequence[float] = (),
    distance: Callable[[float], float] = lambda _: 0.0,
) -> tuple[list[float], list[float]]:
    """Return the ends of an element's segments, as positions from 0 to ``length``, and deviations.

    ``density`` returns for a position the segments per unit, and the share of the allowed deviation
    that they use, with the sign of the side. The deviations are returned as such shares, too.
    ``distance`` is that of a position from the pole, ``apsides`` lie inside the element.
    Raises `TooManySegments`.
    """
    divisions = [
        apsis
        for apsis in apsides
        if min(apsis, length - apsis) * density(apsis)[0] > WORTH_DIVIDING
    ]
    ends = [(0.0, 0.0)]
    for start, end in pairwise((0.0, *divisions, length)):
        backwards = distance(end) < distance(start)
        near, far = (end, start) if backwards else (start, end)
        portion = _stepped(near, far, density)
        lost_near, lost_far = (0.0 if at in divisions else LOSS for at in (near, far))
        lost = lost_near + lost_far
        segments = ceil(portion.number + lost - 1e-9)
        used = portion.number / (segments - lost)
        if start in divisions:
            ends.append((start, used**2 * density(start)[1]))
        inner = _inner_ends(portion, segments, used, lost_near)
        ends += reversed(inner) if backwards else inner
    if len(ends) > MOST_SEGMENTS_OF_MOVE:
        raise TooManySegments
    positions, shares = zip(*ends, (length, 0.0))
    return list(positions), list(shares)


class _Steps(NamedTuple):
    """Steps of one segment of full length each, from one position to another and past it.

    ``shares`` are the shares of the deviation between two ``positions``; ``number`` segments
    suffice.
    """

    positions: list[float]
    shares: list[float]
    number: float


def _stepped(near: float, far: float, density: Density) -> _Steps:
    """Return the steps of a portion from its end that is nearer to the pole.

    The middle of a step is predicted by the step before it. Near the pole the steps are shortest:
    from there they grow, so that none is predicted too long.
    """
    position, unit = near, 1.0 if far > near else -1.0
    positions, shares = [near], list[float]()
    step = unit / density(near)[0]
    while not shares or (far - position) * unit > 0.0:
        segments, share = density(position + 0.5 * step)
        step = unit / segments
        position += step
        positions.append(position)
        shares.append(share)
        if len(shares) > MOST_SEGMENTS_OF_MOVE:
            raise TooManySegments
    return _Steps(positions, shares, len(shares) - (position - far) / step)


def _inner_ends(
    portion: _Steps, segments: int, used: float, lost: float
) -> list[tuple[float, float]]:
    """Return the ends of the segments inside a portion, from the end nearer to the pole.

    ``used`` is the length of each, in segments of full length; the deviation goes with its square.
    ``lost`` are those at the nearer end.
    """
    table, square = portion.positions, used * used
    shares = [portion.shares[0], *portion.shares, portion.shares[-1]]
    ends = []
    for k in range(1, segments):
        steps = used * (k - lost)
        j = int(steps)
        position = table[j] + (steps - j) * (table[j + 1] - table[j])
        middle = int(steps + 0.5)
        share = shares[middle] + (steps + 0.5 - middle) * (shares[middle + 1] - shares[middle])
        ends.append((position, square * share))
    return ends


LEAST_TURN = 1e-9  # degrees: less is no turn

# The end of a segment: the plane's slide, the rotary axis in degrees, the height; and its F.
Segment = tuple[float, float, float, float]


class MachinePosition(NamedTuple):
    """The machine's position: the plane's slide (X as a radius), the rotary axis, the height.

    The angle is in degrees, continuous over the section: it may leave 0..360.
    """

    slide: float
    turn: float
    height: float


class Segments(NamedTuple):
    """G1 moves of one block, one after the other, all in G90 and G94.

    ``axes`` are the words to write, as "XC", "ZCX" or "Z". F is as G94 takes it. It may be small:
    write it with six significant digits. A segment that does not move a slide repeats the same
    number. With ``stop`` the last segment must end in an exact stop, because LinuxCNC would round
    the corner by more than the tolerance.
    """

    line: int
    axes: str
    segments: list[Segment]
    stop: bool


class FaceSwitch(NamedTuple):
    """The switch to the part's face (``on``), or back, at the machine's ``position``."""

    line: int
    on: bool
    position: MachinePosition
    share: float = 1.0  # of the INI's accelerations of X and Y, until the switch back
    override: float = 1.0  # the highest feed override that is followed there


class FaceMove(NamedTuple):
    """A move on the face, in its X and Y: C's zero line is the angle of C at the switch.

    ``segments`` are positions on the move. The last is the end, and they include the extremes of
    every axis.
    """

    line: int
    move: Motion
    segments: list[MachinePosition]


Step = Segments | FaceMove | FaceSwitch | Action | BlockEnd


class SectionPlan(NamedTuple):
    """The moves of a section."""

    steps: list[Step]
    end: Start  # the machine's position after them
    notes: list[str]  # messages for the operator


class Split(NamedTuple):
    """The ends of an element's segments, its start first.

    Per end: the position of the plane's slide, the angle of the rotary axis in radians, continuous
    over the element, and the length of the path up to it.
    """

    slides: list[float]
    angles: list[float]
    lengths: list[float]


def has_short_slide_move(split: Split, least: float) -> bool:
    """Return whether a segment turns and moves the slide, but by less than ``least``."""
    slides, angles = split.slides, split.angles
    return any(
        abs(x1 - x0) < least and x1 != x0 and abs(a1 - a0) > LEAST_TURN
        for x0, x1, a0, a1 in zip(slides, slides[1:], angles, angles[1:])
    )


def segments_with_feed(
    split: Split, start: MachinePosition, move: PlaneMove, zero: float, least: float
) -> list[Segment]:
    """Return the segments of a move that the machine makes from ``start``.

    ``zero`` is the angle in degrees of the rotary axis where that of the split is 0.
    """
    slide, turn, height = start
    rise = (move.h1 - move.h0) / split.lengths[-1]
    feed = move.feed / hypot(1.0, rise)
    segments, done = [], 0.0
    for to_slide, angle, length in zip(split.slides[1:], split.angles[1:], split.lengths[1:]):
        to_turn = zero + degrees(angle)
        turned = abs(to_turn - turn)
        if turned < LEAST_TURN:
            to_turn, turned = turn, 0.0
        to_height = move.h0 + rise * length if rise else height
        distance = hypot(to_slide - slide, to_height - height)
        if turned and abs(to_slide - slide) < least:
            to_slide, distance = slide, abs(to_height - height)
            if distance < least:
                to_height, distance = height, turned
        if distance:
            segments.append((to_slide, to_turn, to_height, feed * distance / (length - done)))
            slide, turn, height, done = to_slide, to_turn, to_height, length
    return segments
