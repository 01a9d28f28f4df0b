# SPDX-License-Identifier: GPL-2.0-or-later
"""One expected move of the tool's centre, and how a list of them is written down.

Lengths are mm. The plane is that of the cut: of a pocket, seen from its centre along the axes of
its plane; of a polar section, the part's face; on a cylinder, its unrolled surface. The level is
measured at right angles to it.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from g12.geometry.curve import Arc, Curve, Line

NO_LENGTH = 1e-6  # mm
TOUCHING = 0.01  # mm: two rings that overlap by this leave no material between them
FULL = 2 * math.pi - 1e-9

Point = tuple[complex, float]  # in the plane, and the level


class Expected(NamedTuple):
    """One move: its curve in the plane, its levels at start and end, and how fast it goes.

    ``name`` is what the move is for, as the page calls it: plunge, lead-in, ring, stepover.
    ``feed`` is in mm per minute, or per revolution if ``per_rev``; None where the words do not say.
    ``line`` is that of its block.
    """

    name: str
    curve: Curve
    start_level: float
    end_level: float
    feed: float | None = None
    rapid: bool = False
    per_rev: bool = False
    line: int = 0

    @property
    def length(self) -> float:
        return abs(complex(self.curve.length, self.end_level - self.start_level))

    @property
    def sweep(self) -> float:
        """The signed angle of an arc in radians, 0 of a line."""
        return getattr(self.curve, "sweep", 0.0)

    @property
    def radius(self) -> float:
        """The radius of an arc, 0 of a line."""
        return getattr(self.curve, "radius", 0.0)

    @property
    def is_circle(self) -> bool:
        return abs(self.sweep) > FULL

    def point(self, share: float) -> Point:
        rise = share * (self.end_level - self.start_level)
        return self.curve.point(share), self.start_level + rise

    def nearest(self, point: Point, least: float = 0.0, most: float = 1.0) -> float:
        """Return the share nearest to a point between two shares.

        An arc that climbs is followed across the plane, a straight move in space.
        """
        if isinstance(self.curve, Line):
            found = self._share_in_space(*point)
        else:
            found = self.curve.share_between(point[0], least, most)
        return min(most, max(least, found))

    def _share_in_space(self, point: complex, level: float) -> float:
        along, rise = self.curve.end - self.curve.start, self.end_level - self.start_level
        square = abs(along) ** 2 + rise * rise
        across = ((point - self.curve.start) * along.conjugate()).real
        return (across + (level - self.start_level) * rise) / square if square else 0.0


def distance(one: Point, other: Point) -> float:
    return abs(complex(abs(one[0] - other[0]), one[1] - other[1]))


class Writer:
    """Writes down a toolpath from where the tool is; leaves out what has no length.

    ``line`` is that of the block, ``per_rev`` says that its feeds are per revolution.
    """

    def __init__(self, at: complex, level: float, line: int = 0, per_rev: bool = False) -> None:
        self.at, self.level = at, level
        self.path: list[Expected] = []
        self._how = {"line": line, "per_rev": per_rev}

    def straight(
        self, name: str, end: complex, feed: float | None = None, fall: float = 0.0, **how: bool
    ) -> None:
        """Add a line across the plane that falls by ``fall``; ``how`` is ``rapid``, ``per_rev``."""
        self._add(name, Line(self.at, end), self.level - fall, feed, how)

    def vertical(self, name: str, level: float, feed: float | None = None, **how: bool) -> None:
        self._add(name, Line(self.at, self.at), level, feed, how)

    def arc(
        self,
        name: str,
        centre: complex,
        sweep: float,
        feed: float | None = None,
        fall: float = 0.0,
        **how: bool,
    ) -> None:
        """Add an arc about a centre that falls by ``fall``."""
        self._add(name, Arc(self.at, centre, sweep), self.level - fall, feed, how)

    def _add(self, name: str, curve: Curve, level: float, feed: float | None, how: dict) -> None:
        move = Expected(name, curve, self.level, level, feed, **{**self._how, **how})
        if move.length > NO_LENGTH:
            self.path.append(move)
            self.at, self.level = curve.end, level


@dataclass(frozen=True, kw_only=True)
class CircleWords:
    """The words of a block that cuts a circle, where its dialect has no others."""

    line: int = 0
    per_rev: bool = False

    @property
    def inside(self) -> bool:
        return True

    @property
    def stepover(self) -> float | None:
        """The distance between neighbouring passes, None with one ring."""
        return None

    def bore(self, cutter: float) -> float:
        """Return the radius of the hole that was there before; ``cutter`` is a radius."""
        return 0.0

    def writer(self, start: complex = 0j) -> Writer:
        """Return a writer whose level 0 is where the tool is; ``start`` is from the centre."""
        return Writer(start, 0.0, self.line, self.per_rev)


def core_within(ring: float, cutter: float, cleared: float = 0.0) -> float:
    """Return the radius of the core that one ring along a wall leaves by design.

    ``cutter`` is a radius. The cutter begins in the centre, or on a circle of the radius
    ``cleared`` there: a ring that touches that leaves nothing.
    """
    inner = ring - cutter
    return inner if inner > cleared + cutter - TOUCHING else 0.0
