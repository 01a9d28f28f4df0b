# SPDX-License-Identifier: GPL-2.0-or-later
"""Roughing of a contour, G71 along Z and G72 along X: straight cuts, level after level.

1. from the start point by rapid to each level, a depth of cut below the one before
2. along the level at the feed, as far as the contour with its allowance is below it
3. off at 45 degrees by the retract, back by rapid; pockets are entered straight down at the feed
4. at last along the contour with its allowance, then back to the start point

The contour may go up and down across the cuts (type II), but never back along them. The cuts have
coordinates of their own, (along, depth): they run to smaller ``along``, levels go down.
"""

from cmath import phase, rect
from collections.abc import Callable, Sequence
from math import floor, pi, sqrt
from typing import NamedTuple

from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.turning.contour import SAME, ContourMove, offset_by
from g12.tools.translate.turning.moves import CycleMove, feed_to, moves_along, rapid_to

MOST_LEVELS = 5000


class RoughCuts(NamedTuple):
    """What G71 or G72 is given: depth of cut, retract, allowance.

    ``along_x`` is G72; ``approach`` the code by which the tool goes to a level, that of P's block.
    """

    depth: float
    retract: float
    allowance: complex
    along_x: bool
    approach: str = "G0"


class CutView(NamedTuple):
    """The coordinates of the cuts: the signs of along and depth, and which axis is which."""

    along: int
    depth: int
    along_x: bool

    def local(self, point: complex) -> complex:
        """Return along + depth * 1j."""
        turned = complex(point.imag, point.real) if self.along_x else point
        return complex(self.along * turned.real, self.depth * turned.imag)

    def real(self, along: float, depth: float) -> complex:
        """Return the point of the program."""
        point = complex(self.along * along, self.depth * depth)
        return complex(point.imag, point.real) if self.along_x else point


def rough(start: complex, contour: Sequence[ContourMove], given: RoughCuts) -> list[CycleMove]:
    """Return the moves of a roughing cycle; the first segment leads from the start to the part."""
    contour = _without_retreat(contour)
    view = _view_of(start, contour, given)
    allowed = offset_by(contour, given.allowance)
    allowed[0] = allowed[0]._replace(start=start)
    portions = [portion for segment in allowed[1:] for portion in _portions(segment, view)]
    _check_direction(portions, view)
    at = view.local(start)
    top = max(at.imag, *(p.imag for portion in portions for p in portion.ends))
    lowest = min(p.imag for portion in portions for p in portion.ends)
    count = floor((at.imag - lowest) / given.depth - SAME)
    if count > MOST_LEVELS:
        raise NotTranslated(f"{count} cuts: the depth of cut is too small")
    moves: list[CycleMove] = []
    for number in range(1, count + 1):
        level = at.imag - number * given.depth
        moves += _level(portions, level, at, top, given, view)
    end = view.local(allowed[-1].end)
    back = [view.real(end.real, top), view.real(at.real, top), start]
    return [*moves, rapid_to(start), *moves_along(allowed), *map(rapid_to, back)]


def _without_retreat(contour: Sequence[ContourMove]) -> Sequence[ContourMove]:
    cuts = [number for number, segment in enumerate(contour) if segment.motion != "G0"]
    return contour[: cuts[-1] + 1] if cuts else contour


def _view_of(start: complex, contour: Sequence[ContourMove], given: RoughCuts) -> CutView:
    plain = CutView(1, 1, given.along_x)
    first, last = (plain.local(contour[n].end) - plain.local(start) for n in (0, -1))
    depth = plain.local(start).imag - plain.local(contour[0].end).imag
    axes = "XZ" if given.along_x else "ZX"
    if abs(depth) < SAME or len(contour) < 2:
        raise NotTranslated(f"the block of P must move in {axes[1]}, from the start to the part")
    along = last.real - first.real
    if abs(along) < SAME:
        raise NotTranslated(f"the contour goes nowhere in {axes[0]}")
    view = CutView(-1 if along > 0 else 1, 1 if depth > 0 else -1, given.along_x)
    allowance = view.local(given.allowance)
    if allowance.imag < 0 or allowance.real < 0:
        raise NotTranslated("the allowance U or W has the sign that would cut into the contour")
    return view


class Monotone(NamedTuple):
    """A portion of a segment along which neither coordinate turns back, as the cuts see it."""

    ends: tuple[complex, complex]
    at_depth: Callable[[float], float]
    line: int


def _portions(segment: ContourMove, view: CutView) -> list[Monotone]:
    points = [view.local(p) for p in _turning_points(segment)]
    line, centre = segment.block.line, segment.centre
    if centre is None:
        return [Monotone((a, b), _on_line(a, b), line) for a, b in zip(points, points[1:])]
    middle, radius = view.local(centre), abs(segment.start - centre)
    return [
        Monotone((a, b), _on_arc(middle, radius, (a + b).real / 2), line)
        for a, b in zip(points, points[1:])
    ]


def _turning_points(segment: ContourMove) -> list[complex]:
    """Return a segment's ends, and where an arc reverses in Z or X."""
    if segment.centre is None:
        return [segment.start, segment.end]
    centre, sense = segment.centre, segment.sense
    begin = phase(segment.start - centre)
    sweep = (phase(segment.end - centre) - begin) * sense % (2 * pi)
    sweep = sweep if sweep > SAME else 2 * pi
    quarters = [(quarter * pi / 2 - begin) * sense % (2 * pi) for quarter in range(4)]
    radius = abs(segment.start - centre)
    between = sorted(angle for angle in quarters if SAME < angle < sweep - SAME)
    return [
        segment.start,
        *(centre + rect(radius, begin + sense * angle) for angle in between),
        segment.end,
    ]


def _on_line(a: complex, b: complex) -> Callable[[float], float]:
    rise = b.imag - a.imag
    return lambda depth: a.real + (b.real - a.real) * (depth - a.imag) / rise


def _on_arc(middle: complex, radius: float, near: float) -> Callable[[float], float]:
    side = 1 if near > middle.real else -1
    return lambda depth: middle.real + side * sqrt(max(0.0, radius**2 - (depth - middle.imag) ** 2))


def _check_direction(portions: Sequence[Monotone], view: CutView) -> None:
    for portion in portions:
        if portion.ends[1].real > portion.ends[0].real + SAME:
            axis = "X" if view.along_x else "Z"
            raise NotTranslated(
                f"line {portion.line}: the contour goes back in {axis}: a cut cannot follow it"
            )


def _gaps_at(portions: Sequence[Monotone], level: float, start: float) -> list[tuple[float, float]]:
    """Return the intervals in which the contour is below a level, in cutting direction."""
    gaps = []
    begun = start if portions[0].ends[0].imag < level else None
    for portion in portions:
        below = [end.imag < level for end in portion.ends]
        if below[0] and not below[1]:
            gaps.append((begun, portion.at_depth(level)))
            begun = None
        elif below[1] and not below[0]:
            begun = portion.at_depth(level)
    if begun is not None:
        gaps.append((begun, portions[-1].ends[1].real))
    return [gap for gap in gaps if gap[0] - gap[1] > SAME]


def _level(
    portions: Sequence[Monotone],
    level: float,
    at: complex,
    top: float,
    given: RoughCuts,
    view: CutView,
) -> list[CycleMove]:
    moves: list[CycleMove] = []
    for begin, end in _gaps_at(portions, level, at.real):
        is_open = begin == at.real
        off = given.retract if is_open else min(given.retract, (begin - end) / 2)
        lifted = view.real(min(begin, end + off), level + off)
        if is_open:
            moves += [CycleMove(given.approach, view.real(begin, level))]
            moves += [feed_to(view.real(end, level)), rapid_to(lifted)]
            moves.append(rapid_to(view.real(begin, level + off)))
        else:
            near = min(top, level + given.depth + given.retract)
            up = view.real(view.local(lifted).real, top)
            points = [(at.real, top), (begin, top), (begin, near)]
            moves += [rapid_to(view.real(*point)) for point in points]
            moves += [feed_to(view.real(begin, level)), feed_to(view.real(end, level))]
            moves += [rapid_to(lifted), rapid_to(up), rapid_to(view.real(at.real, top))]
    return moves
