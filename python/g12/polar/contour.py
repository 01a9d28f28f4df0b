# SPDX-License-Identifier: GPL-2.0-or-later
"""The programmed contour: lines and arcs in the flat X-C plane, each with the block it comes from.

X is the distance from the spindle's centre line (a radius value, whatever the X words meant), C the length
at right angles to it; both and Z in program units, with their origin in the spindle's centre. An angle grows
from +X to +C; a positive sweep is counterclockwise (G3).
"""

from __future__ import annotations

from typing import NamedTuple


class Line(NamedTuple):
    """A straight move of the programmed point; with equal X and C at both ends it is a move of Z alone.

    ``offset`` is the compensation in force: the tool's radius, above zero with the tool on the left of the
    path (G41), below zero on its right (G42), 0 without. ``feed`` is the tool centre's speed in program
    units per minute.
    """

    line: int
    feed: float
    offset: float
    x0: float
    c0: float
    z0: float
    x1: float
    c1: float
    z1: float


class Arc(NamedTuple):
    """A circular move of the programmed point about (``cx``, ``cc``); ``sweep`` in radians, signed.

    ``z0`` and ``z1`` differ on a helix. The other members are those of :class:`Line`.
    """

    line: int
    feed: float
    offset: float
    x0: float
    c0: float
    z0: float
    x1: float
    c1: float
    z1: float
    cx: float
    cc: float
    sweep: float


class Mark(NamedTuple):
    """A block without motion; ``action`` is the caller's, and comes back from the plan in its place."""

    line: int
    action: object


class Contour:
    """Collects the blocks of one section, in order, and refuses those that cannot be a contour.

    ``x`` (radius value, above zero), ``c`` and ``z`` are the programmed position, readable at any time; a
    section starts at C0, wherever the C axis stands. ``code`` names the section in messages; ``diameter``
    tells whether the program's X words are diameters: the values passed in are always radius values, but a
    message has to say which reading was meant.
    """

    def __init__(self, x: float, z: float, *, code: str = "G12.1", diameter: bool = False) -> None: ...

    @property
    def side(self) -> int:
        """The compensation in force: 40, 41 or 42."""

    def line(self, x=None, c=None, z=None, *, line: int, feed: float) -> None:
        """Add a G1 to the absolute point given; a coordinate left out stays."""

    def arc(self, turn: int, x=None, c=None, z=None, *, i=None, j=None, radius=None,
            line: int, feed: float) -> None:
        """Add a G2 (``turn`` -1) or G3 (``turn`` +1) to the absolute point given.

        Either ``i`` and/or ``j``: the centre from the arc's start, or ``radius``: negative for the arc over
        a half turn. The start as end point, or no end point, is a full circle with ``i``/``j``.
        """

    def compensation(self, side: int, radius: float, *, line: int) -> None:
        """Switch to G40, G41 or G42 (``side`` 40, 41, 42) with the next block, which must be a G1.

        Call it before the :meth:`line` of the same block. ``radius`` is the tool's, and may be 0.
        """

    def mark(self, action: object, *, line: int) -> None:
        """Add a block without motion."""
