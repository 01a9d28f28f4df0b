# SPDX-License-Identifier: GPL-2.0-or-later
"""Segments with their F words.

LinuxCNC in G94 takes F for the X and Z part of a move, or for degrees per minute where only C
moves. Every segment gets the F that makes it last as long as its portion of the path at the
programmed feed.

Debian's 2.9.0~pre1 runs a segment too fast that moves a slide by next to nothing together with C.
So a segment that would move it by less than ``least`` leaves the slide where it is, to the last
digit; the next segment adds the remainder.
"""

from math import degrees, hypot
from typing import NamedTuple

from g12.compensation.contour import PlaneMove

# The end of a segment, X, C and Z (or Z, C and X), and its F.
Segment = tuple[float, float, float, float]
LEAST_TURN = 1e-9  # degrees: less is no turn of C


class Split(NamedTuple):
    """The ends of an element's segments, its start first.

    Per end: the position of the plane's slide, the angle of C in radians, continuous over the
    element, and the length of the path up to it.
    """

    slides: list[float]
    angles: list[float]
    lengths: list[float]


def has_short_slide_move(split: Split, least: float) -> bool:
    """Return whether a segment turns C and moves the slide, but by less than ``least``."""
    slides, angles = split.slides, split.angles
    return any(
        abs(x1 - x0) < least and x1 != x0 and abs(a1 - a0) > LEAST_TURN
        for x0, x1, a0, a1 in zip(slides, slides[1:], angles, angles[1:])
    )


def segments_with_feed(
    split: Split, start: tuple[float, float, float], move: PlaneMove, entry: float, least: float
) -> list[Segment]:
    """Return the segments ``(slide, c, other, F)`` of a move that the machine makes from ``start``.

    ``start`` is the machine's position: the plane's slide, C in degrees, and the other slide, which
    makes the move's z. ``entry`` is the C angle in degrees at the plane's zero angle.
    """
    x, c, z = start
    rise = (move.z1 - move.z0) / split.lengths[-1]
    feed = move.feed / hypot(1.0, rise)
    segments, done = [], 0.0
    for slide, angle, length in zip(split.slides[1:], split.angles[1:], split.lengths[1:]):
        to_c = entry + degrees(angle)
        turn = abs(to_c - c)
        if turn < LEAST_TURN:
            to_c, turn = c, 0.0
        to_z = move.z0 + rise * length if rise else z
        if abs(slide - x) < least and turn:
            slide = x
        if hypot(slide - x, to_z - z) < least and turn:
            to_z = z
        distance = hypot(slide - x, to_z - z) or turn
        if distance:
            segments.append((slide, to_c, to_z, feed * distance / (length - done)))
            x, c, z, done = slide, to_c, to_z, length
    return segments
