# SPDX-License-Identifier: GPL-2.0-or-later
"""Pieces with their F words.

LinuxCNC in G94 takes F for the X and Z part of a move, or for degrees per minute where only C
moves. Every piece gets the F that makes it last as long as its part of the path at the programmed
feed.

Debian's 2.9.0~pre1 runs a piece too fast that moves X by next to nothing together with C. So a
piece that would move X by less than ``least_x`` keeps it, to the last digit, and the next one
takes the rest over.
"""

from __future__ import annotations

from math import degrees, hypot
from typing import NamedTuple

from g12.polar.pieces import Split

LEAST_TURN = 1e-9  # degrees: no turn at all


class Position(NamedTuple):
    """Where the machine stands: X radius value, C in degrees, Z."""

    x: float
    c: float
    z: float


def pieces_with_feed(
    split: Split, start: Position, move, entry: float, least_x: float
) -> list[tuple]:
    """Return the pieces ``(x, c, z, F)`` of a move that the machine makes from ``start`` on.

    ``entry`` is the C angle in degrees at the plane's zero angle; ``least_x`` in program units.
    """
    x, c, z = start
    rise = (move.z1 - move.z0) / split.lengths[-1]
    feed = move.feed / hypot(1.0, rise)
    pieces, done = [], 0.0
    for radius, angle, length in zip(split.radii[1:], split.angles[1:], split.lengths[1:]):
        to_c = entry + degrees(angle)
        turn = abs(to_c - c)
        if turn < LEAST_TURN:
            to_c, turn = c, 0.0
        step = abs(radius - x)
        if step < least_x and turn:
            radius, step = x, 0.0
        if rise:
            to_z = move.z0 + rise * length
            step = hypot(step, to_z - z)
            z = to_z
        distance = step or turn
        if distance:
            pieces.append((radius, to_c, z, feed * distance / (length - done)))
            x, c, done = radius, to_c, length
    return pieces
