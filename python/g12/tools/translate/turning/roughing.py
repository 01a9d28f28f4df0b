# SPDX-License-Identifier: GPL-2.0-or-later
"""Roughing of a contour, G71 along Z and G72 along X: straight cuts, level after level.

1. from the start point by rapid to each level, a depth of cut below the one before
2. along the level at the feed, as far as the contour with its allowance is below it
3. off at 45 degrees by the retract, back by rapid; pockets are entered straight down at the feed
4. at last along the contour with its allowance, then back to the start point

The contour may go up and down across the cuts (type II), but never back along them. It is turned
into the coordinates of the cuts, along + depth * 1j: they run to smaller ``along``, levels go down.
"""

from collections.abc import Callable, Sequence
from math import floor, sqrt
from typing import NamedTuple

from g12.geometry.curve import Arc, sweep_between
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.turning.moves import (
    SAME,
    CycleMove,
    feed_to,
    limited,
    offset_by,
    rapid_to,
)


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

    def real(self, move: CycleMove) -> CycleMove:
        point = complex(self.along * move.end.real, self.depth * move.end.imag)
        return move._replace(end=complex(point.imag, point.real) if self.along_x else point)


def rough(start: complex, contour: Sequence[CycleMove], given: RoughCuts) -> list[CycleMove]:
    """Return the moves of a roughing cycle; the first segment leads from the start to the part."""
    contour = _without_retreat(contour)
    view = _view_of(start, contour, given)
    allowed = offset_by(contour, given.allowance)
    allowed[0] = allowed[0]._replace(start=start)
    portions = [portion for move in allowed[1:] for portion in _portions(move, view)]
    for portion in portions:
        if portion.ends[1].real > portion.ends[0].real + SAME:
            axis = "X" if view.along_x else "Z"
            raise NotTranslated(
                f"line {portion.line}: the contour goes back in {axis}: a cut cannot follow it"
            )
    at, depths = view.local(start), [end.imag for portion in portions for end in portion.ends]
    top = max(at.imag, *depths)
    count = limited(floor((at.imag - min(depths)) / given.depth - SAME), "cuts")
    cuts: list[CycleMove] = []
    for number in range(1, count + 1):
        cuts += _level(portions, at.imag - number * given.depth, at, top, given)
    end = view.local(allowed[-1].end)
    back = [rapid_to(complex(along, top)) for along in (end.real, at.real)]
    moves = [view.real(move) for move in cuts], [view.real(move) for move in back]
    return [*moves[0], rapid_to(start), *allowed, *moves[1], rapid_to(start)]


def _without_retreat(contour: Sequence[CycleMove]) -> Sequence[CycleMove]:
    """Return the moves of a contour up to its last cut; blocks of other words alone are none."""
    moves = [move for move in contour if move.end != move.start or move.centre is not None]
    cuts = [number for number, move in enumerate(moves) if move.code != "G0"]
    return moves[: cuts[-1] + 1] if cuts else moves


def _view_of(start: complex, contour: Sequence[CycleMove], given: RoughCuts) -> CutView:
    plain = CutView(1, 1, given.along_x)
    first, last = (plain.local(contour[n].end - start) for n in (0, -1))
    axes = "XZ" if given.along_x else "ZX"
    if abs(first.imag) < SAME or len(contour) < 2:
        raise NotTranslated(f"the block of P must move in {axes[1]}, from the start to the part")
    along = last.real - first.real
    if abs(along) < SAME:
        raise NotTranslated(f"the contour goes nowhere in {axes[0]}")
    view = CutView(-1 if along > 0 else 1, 1 if first.imag < 0 else -1, given.along_x)
    allowance = view.local(given.allowance)
    if allowance.imag < 0 or allowance.real < 0:
        raise NotTranslated("the allowance U or W has the sign that would cut into the contour")
    return view


class Monotone(NamedTuple):
    """A portion of a segment along which neither coordinate turns back."""

    ends: tuple[complex, complex]
    at_depth: Callable[[float], float]
    line: int


def _portions(move: CycleMove, view: CutView) -> list[Monotone]:
    points = [view.local(point) for point in _turning_points(move)]
    centre = None if move.centre is None else view.local(move.centre)
    return [
        Monotone((a, b), _along_at(a, b, centre), move.line) for a, b in zip(points, points[1:])
    ]


def _turning_points(move: CycleMove) -> list[complex]:
    """Return a move's ends, and where an arc reverses in a coordinate."""
    if move.centre is None:
        return [move.start, move.end]
    turn = 1 if move.code == "G3" else -1
    arc = Arc(move.start, move.centre, sweep_between(move.start, move.end, move.centre, turn))
    shares = sorted(arc.share_towards(arc.centre + axis) for axis in (1, 1j, -1, -1j))
    between = [arc.point(share) for share in shares if SAME < share < 1 - SAME]
    return [move.start, *between, move.end]


def _along_at(a: complex, b: complex, centre: complex | None) -> Callable[[float], float]:
    """Return along as a function of depth between two points of a line or an arc."""
    if centre is None:
        return lambda depth: a.real + (b.real - a.real) * (depth - a.imag) / (b.imag - a.imag)
    square, side = abs(a - centre) ** 2, 1 if (a + b).real / 2 > centre.real else -1
    return lambda depth: centre.real + side * sqrt(max(0.0, square - (depth - centre.imag) ** 2))


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
    portions: Sequence[Monotone], level: float, at: complex, top: float, given: RoughCuts
) -> list[CycleMove]:
    moves: list[CycleMove] = []
    for begin, end in _gaps_at(portions, level, at.real):
        is_open = begin == at.real
        off = given.retract if is_open else min(given.retract, (begin - end) / 2)
        lifted = complex(min(begin, end + off), level + off)
        cut = [feed_to(complex(end, level)), rapid_to(lifted)]
        if is_open:
            moves.append(CycleMove(given.approach, complex(begin, level)))
            moves += [*cut, rapid_to(complex(begin, level + off))]
        else:
            near = min(top, level + given.depth + given.retract)
            points = [(at.real, top), (begin, top), (begin, near)]
            moves += [rapid_to(complex(*point)) for point in points]
            moves += [feed_to(complex(begin, level)), *cut]
            moves += [rapid_to(complex(along, top)) for along in (lifted.real, at.real)]
    return moves
