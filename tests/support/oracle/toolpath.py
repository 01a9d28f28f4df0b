# SPDX-License-Identifier: GPL-2.0-or-later
"""One expected move of the tool's centre, and how a list of them is written down.

Lengths are mm. The plane is that of the cut: of a pocket, seen from its centre along the axes of
its plane; of a polar section, the part's face; on a cylinder, its unrolled surface. The level is
measured at right angles to it.
"""

from math import copysign
from typing import NamedTuple

from g12.geometry.curve import DEGENERATE, FULL_TURN, Arc, Curve, Line, angle_of

NO_LENGTH = 1e-6  # mm

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
            found = _share_between(self.curve, point[0], least, most)
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


class Difference(NamedTuple):
    """What is not as expected: a code, the line, and what it is."""

    code: str
    line: int
    text: str = ""


def _share_between(arc: Arc, point: complex, least: float, most: float) -> float:
    """Return the share nearest to a point among those between two shares."""
    start, there = arc.start - arc.centre, point - arc.centre
    if not arc.sweep or abs(there) <= DEGENERATE or abs(start) <= DEGENERATE:
        return least
    turned = angle_of(there * start.conjugate()) * copysign(1.0, arc.sweep) % FULL_TURN
    shares = [(turned + turn) / abs(arc.sweep) for turn in (-FULL_TURN, 0.0, FULL_TURN)]
    within = [share for share in shares if least <= share <= most]
    ends = min((least, most), key=lambda share: abs(arc.point(share) - point))
    return within[0] if within else ends
