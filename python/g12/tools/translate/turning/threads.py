# SPDX-License-Identifier: GPL-2.0-or-later
"""Threads: one pass (G92 of system A), and all of them (G76), each as G33.

LinuxCNC's own G76 has another rule for the depth of its passes; G33 is exact. Its K is the travel
along the path for each revolution, the lead of these controls that along Z (or X, if steeper).
"""

from itertools import count
from math import radians, sqrt, tan
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.turning.contour import SAME
from g12.tools.translate.turning.moves import CycleMove, rapid_to

MOST_THREAD_PASSES = 1000


class Thread(NamedTuple):
    """A thread: where it ends at full depth, its lead, its taper, how it runs out.

    ``taper`` is the radius at the start less that at the end, ``chamfer`` the length over which the
    tool leaves at 45 degrees, ``turn`` the angle at which it starts.
    """

    end: complex
    lead: float
    taper: float = 0.0
    chamfer: float = 0.0
    turn: float = 0.0


class Infeed(NamedTuple):
    """How the passes of G76 go in: thread's height, first depth, least depth, the last ones.

    ``allowance`` remains for the first of ``finishing`` passes, ``angle`` that of the thread along
    whose flank the tool goes in.
    """

    height: float
    first: float
    least: float = 0.0
    allowance: float = 0.0
    finishing: int = 1
    angle: float = 0.0


def thread_pass(start: complex, thread: Thread, up: float = 0.0) -> list[CycleMove]:
    """Return one pass; ``up`` is how much higher than the thread's full depth it is."""
    side = 1 if start.imag > thread.end.imag else -1
    shifted = complex(thread.lead * thread.turn / 360, side * up)
    begin = complex(start.real, thread.end.imag + thread.taper) + shifted
    end = complex(thread.end.real, thread.end.imag + side * up)
    path = end - begin
    if abs(path.real) < SAME:
        raise NotTranslated("the thread has no length in Z")
    pitch = pitch_along(path, thread.lead)
    chamfer = min(thread.chamfer, abs(path.real))
    turning = end - path / abs(path.real) * chamfer
    moves = [rapid_to(begin), CycleMove("G33", turning, None, pitch)]
    if chamfer > SAME:
        out = complex(end.real, turning.imag + side * chamfer)
        moves.append(CycleMove("G33", out, None, pitch_along(out - turning, thread.lead)))
    last = moves[-1].end
    clear = side * max(side * start.imag, side * last.imag)
    back = (complex(last.real, clear), complex(start.real, clear), start)
    return [*moves, *map(rapid_to, back)]


def pitch_along(path: complex, lead: float) -> float:
    """Return the travel along the path for each revolution."""
    longer = max(abs(path.real), abs(path.imag))
    return lead * abs(path) / longer


def _depths(infeed: Infeed) -> list[float]:
    """Return the depth of each pass, roughing passes first."""
    full, least = infeed.height - infeed.allowance, infeed.least
    if infeed.first <= 0 or full <= 0:
        raise NotTranslated("the thread's height and the depth of its first pass must be above 0")
    found: list[float] = []
    for number in count(1):
        last = found[-1] if found else 0.0
        depth = infeed.first if number == 1 else max(infeed.first * sqrt(number), last + least)
        if depth > full - SAME:
            break
        found.append(depth)
        if number > MOST_THREAD_PASSES:
            raise NotTranslated(
                f"more than {MOST_THREAD_PASSES} passes: the first depth is too small"
            )
    finishing = infeed.finishing if infeed.allowance > SAME else infeed.finishing - 1
    return [*found, full, *[infeed.height] * max(finishing, 0)]


def all_passes(start: complex, thread: Thread, infeed: Infeed) -> list[CycleMove]:
    """Return the passes of G76; shallower ones are shifted along the flank, away from the end."""
    moves: list[CycleMove] = []
    away = 1 if start.real > thread.end.real else -1
    for depth in _depths(infeed):
        up = infeed.height - depth
        aside = away * up * tan(radians(infeed.angle / 2))
        shifted = thread._replace(end=thread.end + aside)
        one = thread_pass(start + aside, shifted, up)
        moves += [*one[:-1], rapid_to(start)]
    return moves
