# SPDX-License-Identifier: GPL-2.0-or-later
"""The plunge of a cycle: straight down, or along a helix about its centre.

The helix consists of half turns with the same fall each. The slope of the last few decreases, so
that the toolpath has no corner where it reaches the level. One full circle at that level follows.
The helix ends at the angle where it began. Lengths are in program units.
"""

from math import atan, ceil, pi, radians, tan
from typing import NamedTuple

from g12.errors import number
from g12.request.common import CLEARED
from g12.request.words import Words

LEAST_CORNER = radians(0.99)  # greatest change of slope from one half turn to the next
MOST_HELIX_HALF_TURNS = 2000  # a helix of more has a wrong I or Z


class PocketEntry(NamedTuple):
    """The machine's settings [G12] ENTRY, ENTRY_ANGLE in degrees, PLUNGE_FEED in per cent of F."""

    helix: bool = False
    angle: float = 3.0
    feed: float = 100.0


STRAIGHT_DOWN = PocketEntry()


class Descent(NamedTuple):
    """A descent: ``turns`` half turns that fall by ``fall`` each, then the last ones of the helix.

    No turns: straight down.
    """

    turns: int = 0
    fall: float = 0.0


class Helix(NamedTuple):
    """Helices of one radius, whose ``last`` half turns have a decreasing slope."""

    radius: float = 0.0
    slope: float = 0.0
    last: int = 0

    def descent(self, height: float) -> Descent:
        """Return the descent by a height, at most as steep as the slope, in whole turns."""
        if not self.radius or height <= 0.0:
            return Descent()
        rest = 0.5 * self.last
        turns = max(1, ceil(height / (pi * self.radius * self.slope) - rest))
        turns += (turns + self.last) % 2
        return Descent(turns, height / (turns + rest))


def helix_of(entry: PocketEntry, first: float, cutter: float) -> Helix:
    """Return the helix for a first ring of the tool's centre and a cutter, both by their radius."""
    if not entry.helix:
        return Helix()
    slope = tan(radians(entry.angle))
    radius = min(first, CLEARED * cutter) if cutter else first
    return Helix(radius, slope, ceil(atan(slope) / LEAST_CORNER) - 1)


def pocket_descent(
    words: Words, entry: PocketEntry, first: float, cutter: float, heights: tuple[float, float]
) -> dict[str, float]:
    """Return the locals of the descent in a pocket, or refuse a helix of too many turns.

    ``first`` is the radius of the first ring of the tool's centre, ``cutter`` the cutter's, and
    ``heights`` are those of the first level and of each further one.
    """
    helix, feed = helix_of(entry, first, cutter), words.context.feed
    check_helix(words, helix, heights[0], cutter)
    to_first, further = map(helix.descent, heights)
    numbers = {
        "restart": heights[1] != 0 and not further.turns,
        "turns": to_first.turns,
        "feed": feed,
        "plunge_feed": feed * (entry.feed / 100.0),
    }
    if not to_first.turns:
        return numbers
    return numbers | {
        "fall": to_first.fall,
        "next_turns": further.turns,
        "next_fall": further.fall,
        "last_turns": helix.last,
        "helix_radius": helix.radius,
        "side": -1 if first > helix.radius else 1,
    }


def check_helix(words: Words, helix: Helix, height: float, cutter: float) -> None:
    """Refuse a helix so narrow that it needs too many turns; ``cutter`` is the cutter's radius."""
    turns = helix.descent(height).turns
    if turns <= MOST_HELIX_HALF_TURNS:
        return
    least = height / (pi * helix.slope * (MOST_HELIX_HALF_TURNS - 2))
    if cutter and least > CLEARED * cutter:
        fits = f"{number(height * CLEARED * cutter / least)} down fits at most"
    else:
        fits = f"I from {number(cutter + least)} fits"
    raise words.refuse(
        f"a helix of radius {number(helix.radius)} needs {turns // 2} turns for {number(height)}, "
        f"the most is {MOST_HELIX_HALF_TURNS // 2}: {fits}, or [G12] ENTRY = plunge"
    )
