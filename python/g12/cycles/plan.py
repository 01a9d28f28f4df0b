# SPDX-License-Identifier: GPL-2.0-or-later
"""What the planners of cycles share: their result, the descent, a hole.

The helix of a pocket consists of half turns with the same fall each. The slope of the last few
decreases, so that the toolpath has no corner where it reaches the level. One full circle at that
level follows. The helix ends at the angle where it began. Lengths are in program units.
"""

from collections.abc import Callable
from math import atan, ceil, cos, pi, radians, sin, tan
from typing import NamedTuple

from g12.cut_report import PlannedCut
from g12.errors import Refusal, number
from g12.request import CLEARED, COUNTERCLOCKWISE, Cutter, Words


class EventPlanes(NamedTuple):
    """The circle mill's modal reference planes W and O; None where no event has commanded one."""

    first: float | None = None
    second: float | None = None


NO_PLANES = EventPlanes()


class CyclePlan(NamedTuple):
    """A checked cycle: ``locals`` are the named locals of its sub, which its .ngc file explains.

    Lengths and feeds are in program units. ``cut`` returns what is reported, ``message`` is for the
    operator, never a refusal. ``planes`` are those that an event gives for later ones.
    """

    locals: dict[str, float]
    cut: Callable[[], PlannedCut]
    cutter: Cutter | None
    message: str | None = None
    planes: EventPlanes = NO_PLANES


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

    radius: float
    slope: float
    last: int

    def descent(self, height: float) -> Descent:
        """Return the descent by a height, at most as steep as the slope, in whole turns."""
        if height <= 0.0:
            return Descent()
        rest = 0.5 * self.last
        turns = max(1, ceil(height / (pi * self.radius * self.slope) - rest))
        turns += (turns + self.last) % 2
        return Descent(turns, height / (turns + rest))


def helix_of(entry: PocketEntry, first: float, cutter: float) -> Helix:
    """Return the helix for a first ring of the tool's centre and a cutter, both by their radius."""
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
    feed = words.context.feed
    numbers = {
        "restart": heights[1] != 0,
        "turns": 0,
        "feed": feed,
        "plunge_feed": feed * (entry.feed / 100.0),
    }
    if not entry.helix:
        return numbers
    helix = helix_of(entry, first, cutter)
    check_helix(words, helix, heights[0], cutter)
    to_first, further = map(helix.descent, heights)
    numbers["restart"] = heights[1] != 0 and not further.turns
    if not to_first.turns:
        return numbers
    return numbers | {
        "turns": to_first.turns,
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
    raise Refusal(
        f"a helix of radius {number(helix.radius)} needs {turns // 2} turns for {number(height)}, "
        f"the most is {MOST_HELIX_HALF_TURNS // 2}: {fits}, or [G12] ENTRY = plunge",
        words.code,
    )


CLEARANCE_MM, CLEARANCE_INCH = 1.0, 0.04  # of the rapid down, above the top
WHOLE_TURN = 1e-5  # a smaller part of a turn is rounding: its arc would be a full circle


class Hole(NamedTuple):
    """Centre, the Z where the block begins, the end of the rapid down, top and floor."""

    x: float
    y: float
    start: float
    clear: float
    top: float
    z: float

    @property
    def depth(self) -> float:
        return self.top - self.z


def hole_of(words: Words, top: float | None = None) -> Hole:
    """Return where the cycle cuts; under G91 its Z counts from the top, which is R or ``top``."""
    context = words.context
    x, y = words.take_centre()
    depth = words.require("Z", "the depth")
    if top is None:
        given = words.take("R")
        top = words.absolute(given, context.z)
        if given is not None and top > context.z + context.rounding:
            rule = f"puts the top above the tool at Z{number(context.z)}: retract first"
            raise words.refuse_word("R", given, rule)
    z = top + depth if context.incremental else depth
    if z >= top - context.smallest_ring:
        raise words.refuse_word("Z", depth, f"must be below the top, Z{number(top)}")
    clearance = CLEARANCE_INCH if context.inch else CLEARANCE_MM
    return Hole(x, y, context.z, min(context.z, top + clearance), top, z)


def turns_of(height: float, pitch: float, arc: int) -> dict[str, float]:
    """Return the locals of one helix from +X: turns begun, direction of its end from the centre."""
    turns = height / pitch
    if abs(turns - round(turns)) < WHOLE_TURN:
        turns = max(1, round(turns))
    angle = 2 * pi * (turns % 1) * (1 if arc == COUNTERCLOCKWISE else -1)
    return {"rounds": ceil(turns), "turn_x": cos(angle), "turn_y": sin(angle)}
