# SPDX-License-Identifier: GPL-2.0-or-later
"""One expected move of the tool's centre, and how a list of them is written down.

Lengths are mm. The plane is that of the cut: of a pocket, seen from its centre along the axes of
its plane; of a polar section, the part's face; on a cylinder, its unrolled surface. The level is
measured at right angles to it.
"""

from typing import NamedTuple

from g12.geometry.curve import Arc, Curve, Line

NO_LENGTH = 1e-6  # mm
TOUCHING = 0.01  # mm: so far over each other two rings leave nothing


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
        """Return the length in space."""
        return abs(complex(self.curve.length, self.end_level - self.start_level))

    def point(self, share: float) -> tuple[complex, float]:
        """Return the point of the plane and the level at a share of the move."""
        rise = share * (self.end_level - self.start_level)
        return self.curve.point(share), self.start_level + rise

    def share_of(self, point: complex, level: float) -> float:
        """Return the share of the move's point nearest to a point."""
        return self.nearest((point, level), 0.0, 1.0)

    def nearest(self, point: tuple[complex, float], least: float, most: float) -> float:
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

    def distance(self, point: complex, level: float, share: float) -> float:
        """Return the distance in space between a point and the move's point at a share."""
        there, height = self.point(share)
        return abs(complex(abs(point - there), level - height))


class Writer:
    """Writes down a toolpath from where the tool stands; what has no length is left out.

    ``line`` is that of the block, ``per_rev`` says that its feeds are per revolution.
    """

    def __init__(self, at: complex, level: float, line: int = 0, per_rev: bool = False) -> None:
        self.at, self.level = at, level
        self.path: list[Expected] = []
        self._line, self._per_rev = line, per_rev

    def straight(
        self,
        name: str,
        end: complex,
        feed: float | None = None,
        fall: float = 0.0,
        **how: bool,
    ) -> None:
        """Add a line across the plane that falls by some height; ``how`` is ``rapid`` or so."""
        self._add(name, Line(self.at, end), self.level - fall, feed, **how)

    def vertical(self, name: str, level: float, feed: float | None = None, **how: bool) -> None:
        """Add a move to another level."""
        self._add(name, Line(self.at, self.at), level, feed, **how)

    def arc(
        self,
        name: str,
        centre: complex,
        sweep: float,
        feed: float | None = None,
        fall: float = 0.0,
        **how: bool,
    ) -> None:
        """Add an arc about a centre that falls by some height."""
        self._add(name, Arc(self.at, centre, sweep), self.level - fall, feed, **how)

    def _add(
        self,
        name: str,
        curve: Curve,
        level: float,
        feed: float | None,
        rapid: bool = False,
        per_rev: bool | None = None,
    ) -> None:
        per_rev = self._per_rev if per_rev is None else per_rev
        move = Expected(name, curve, self.level, level, feed, rapid, per_rev, line=self._line)
        if move.length > NO_LENGTH:
            self.path.append(move)
            self.at, self.level = curve.end, level


class CircleWords:
    """What a block that cuts a circle says, where its dialect does not say otherwise."""

    @property
    def inside(self) -> bool:
        """Tell whether the cutter works inside the wall."""
        return True

    @property
    def stepover(self) -> float | None:
        """Return the distance between neighbouring passes, None with one ring."""
        return None

    def bore(self, cutter: float) -> float:
        """Return the radius of the hole that was there before; ``cutter`` is a radius."""
        return 0.0


def core_within(ring: float, cutter: float, begun: float = 0.0) -> float:
    """Return the radius of what one ring along a wall leaves standing by design.

    The cutter, by its radius, begins in the centre, or on a circle of radius ``begun`` there: a
    ring that touches what it clears there leaves nothing.
    """
    inner = ring - cutter
    return inner if inner > begun + cutter - TOUCHING else 0.0
