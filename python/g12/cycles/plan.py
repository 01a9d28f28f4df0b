# SPDX-License-Identifier: GPL-2.0-or-later
"""What the planners of cycles share: their result, the descent, a hole.

The helix of a pocket consists of half turns with the same fall each. The slope of the last few
decreases, so that the toolpath has no corner where it reaches the level. One full circle at that
level follows. The helix ends at the angle where it began. Lengths are in program units.
"""

from math import atan, ceil, cos, pi, radians, sin, tan
from typing import NamedTuple

from g12.cut_report import PlannedCut
from g12.errors import number
from g12.request import CLEARED, COUNTERCLOCKWISE, Cutter, Words
from g12.settings import Settings


class EventPlanes(NamedTuple):
    """The circle mill's modal reference planes W and O; None where no event has commanded one."""

    first: float | None = None
    second: float | None = None


NO_PLANES = EventPlanes()


class CyclePlan(NamedTuple):
    """A checked cycle: ``locals`` are the named locals of its sub, which its .ngc file explains.

    Lengths and feeds are in program units. ``cut`` is what is reported, ``message`` is for the
    operator, never a refusal. ``planes`` are those that an event gives for later ones.
    """

    locals: dict[str, float]
    cut: PlannedCut
    cutter: Cutter | None
    message: str | None = None
    planes: EventPlanes = NO_PLANES


LEAST_CORNER = radians(0.99)  # greatest change of slope from one half turn to the next
MOST_HELIX_HALF_TURNS = 2000  # a helix of more has a wrong I or Z


def pocket_descent(
    words: Words, settings: Settings, first: float, cutter: float, heights: tuple[float, float]
) -> dict[str, float]:
    """Return the locals of the descent in a pocket, or refuse a helix of too many turns.

    ``first`` is the radius of the first ring of the tool's centre, ``cutter`` the cutter's, and
    ``heights`` are those of the first level and of each further one.
    """
    feed, is_helix = words.context.feed, settings.entry == "helix"
    slope = tan(radians(settings.entry_angle))
    radius = min(first, CLEARED * cutter) if cutter else first
    last = ceil(atan(slope) / LEAST_CORNER) - 1  # half turns of decreasing slope
    turns, next_turns = (
        half_turns(height / (pi * radius * slope), last) if is_helix else 0 for height in heights
    )
    if turns > MOST_HELIX_HALF_TURNS:
        raise words.refuse(too_narrow(radius, slope, heights[0], turns, cutter))
    numbers = {
        "restart": heights[1] != 0 and not next_turns,
        "turns": turns,
        "feed": feed,
        "plunge_feed": feed * (settings.plunge_feed / 100.0),
    }
    if not turns:
        return numbers
    return numbers | {
        "fall": heights[0] / (turns + 0.5 * last),
        "next_turns": next_turns,
        "next_fall": heights[1] / (next_turns + 0.5 * last) if next_turns else 0.0,
        "last_turns": last,
        "helix_radius": radius,
        "side": -1 if first > radius else 1,
    }


def half_turns(steepest: float, last: int) -> int:
    """Return the half turns before the ``last`` ones of a helix, in whole turns with these.

    ``steepest`` would be enough at the full slope, the last ones have half of it.
    """
    if steepest <= 0.0:
        return 0
    turns = max(1, ceil(steepest - 0.5 * last))
    return turns + (turns + last) % 2


def too_narrow(radius: float, slope: float, height: float, turns: int, cutter: float) -> str:
    """Return the rule against a helix so narrow that it needs too many half turns."""
    least = height / (pi * slope * (MOST_HELIX_HALF_TURNS - 2))
    if cutter and least > CLEARED * cutter:
        fits = f"{number(height * CLEARED * cutter / least)} down fits at most"
    else:
        fits = f"I from {number(cutter + least)} fits"
    return (
        f"a helix of radius {number(radius)} needs {turns // 2} turns for {number(height)}, "
        f"the most is {MOST_HELIX_HALF_TURNS // 2}: {fits}, or [G12] ENTRY = plunge"
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
