# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges: points of a contour's walls that the tool cuts while it machines that same contour.

A point is cut where the tool's centre comes nearer than the radius, less the tolerance, at its Z
level or below. That is valid

- beyond the point where the contour closes: leads are no walls (`closing`);
- where a later portion of the contour runs deeper in the material, in the same direction: a spiral,
  a finishing pass;
- where the contour runs through the air between two plunges.

Everything else is refused, and so is a contour that crosses itself. Two cases are only reported:
leads that cross each other, and an open contour's first or last move that a later pass cuts from
its far side. `neighbours` checks the other contours of the section.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from itertools import groupby
from typing import NamedTuple, NoReturn

from g12.compensation.compensated import (
    MEETING,
    RAMP,
    CompensatedContour,
    PathOfMove,
    WallPoint,
    compensated_contours,
    in_plane,
    is_low,
)
from g12.compensation.contour import Contour
from g12.compensation.neighbours import check_neighbours
from g12.errors import Refusal, number
from g12.geometry.boxes import BoxTree
from g12.geometry.crossing import common_points

SAME_DIRECTION_COSINE = 0.9  # cosine: passes in the same direction differ by less than this angle
CROSSED = 0.02  # of the tool's radius: a contour that goes farther to both sides crosses itself
# of the tool's radius: distances from the crossing at which that is checked
BESIDE_CROSSING = (0.125, 0.25, 0.5, 1.0)
# How a pass cuts a point of a wall. FACING: the wall that the pass machines is on the tool's side
# of the point. DEEPER: it is deeper in the material. REPEATED: deeper, and machined in the same
# direction, as by a later pass.
FACING, DEEPER, REPEATED = "facing", "deeper", "repeated"


class LeadRefusal(Refusal):
    """The tool gouges a closed contour on its lead-in or lead-out."""


class _Gouge(NamedTuple):
    """A cut into the contour by the pass for the move of ``line``.

    ``lead``: that move, or the one that is cut, may be a lead-in or lead-out. ``ramp``: that move
    is the one with G40, G41 or G42.
    """

    line: int
    lead: bool
    ramp: bool = False


def check_gouges(contour: Contour, cuts: Sequence[PathOfMove], tolerance: float) -> None:
    """Refuse contours that the tool gouges by more than the tolerance.

    Reports that are no refusal go to the contour's ``notes``. Program units.
    """
    found = compensated_contours(contour, cuts, tolerance)
    cut = [each for each in found if each.radius > tolerance]
    for each in {signature(each): each for each in reversed(cut)}.values():
        _Sweep(contour, each).check()
    check_neighbours(contour, cut)


class _Sweep:
    """The tool swept along a contour, against the contour's own walls."""

    def __init__(self, contour: Contour, own: CompensatedContour) -> None:
        self._contour, self._own = contour, own
        # At the ends of an open contour there may be no material: its ramps may cut there.
        self._passes = [*own.passes, *(own.ramps if own.closing.closed else ())]
        self._tree = BoxTree([each.move.curve for each in self._passes])
        self._of_move: dict[int, list[int]] = {}
        for k, each in enumerate(self._passes):
            self._of_move.setdefault(each.move_index, []).append(k)
        self._ahead = 0  # moves from the last point to the later pass that cut it
        self._is_repeated = False  # a later pass cuts a wall, or a pass may be a lead

    def check(self) -> None:
        """Refuse the gouges, or report them."""
        own, closing = self._own, self._own.closing
        if closing.crossing:
            first, last = own.moves[closing.first], own.moves[closing.last]
            self._note(
                first.line,
                last.line,
                "cross: taken for the leads of a contour that closes there",
            )
        for index, points in groupby(own.points(), key=lambda point: point.move_index):
            gouges = [hit for point in points for hit in self._gouges(point)]
            worst = min(gouges, key=lambda hit: (hit.lead, hit.ramp), default=None)
            line = own.moves[index].line
            if worst and not worst.lead:
                self._refuse(line, worst.line)
            if worst and not closing.crossing:
                self._note(line, worst.line, "cut into each other: one is taken for a lead")
        if self._is_repeated:
            self._check_crossings()

    def _refuse(self, one: int, other: int) -> NoReturn:
        """Refuse two lines; where one leads to or from a closed contour the side may be wrong."""
        moves, (one, other) = self._own.moves, sorted((one, other))
        is_lead = self._own.closing.closed and {moves[0].line, moves[-1].line} & {one, other}
        kind = LeadRefusal if is_lead else Refusal
        raise kind(
            f"{self._contour.code} line {other}: the tool of radius {number(self._own.radius)}"
            f" cannot follow both lines {one} and {other}: beside one of them it cuts into the"
            " other"
        )

    def _note(self, one: int, other: int, what: str) -> None:
        one, other = sorted((one, other))
        text = f"{self._contour.code} line {other}: lines {one} and {other} {what}"
        if text not in self._contour.notes:
            self._contour.notes.append(text)

    def _gouges(self, point: WallPoint) -> list[_Gouge]:
        """Return the gouges at a wall's point, none where a later pass cuts it (REPEATED)."""
        own, distance, at = self._own, self._own.gouge_distance, point.point
        low = partial(self._is_low, own.walls[point.move_index].z0)
        guess = self._of_move.get(point.move_index + self._ahead, ()) if self._is_repeated else ()
        if any(low(k) and self._kind(point, k) == REPEATED for k in guess):
            return []
        _, nearest = self._tree.nearest(at, distance, low)
        if nearest is None:
            return []
        gouges = []
        for k in filter(low, (nearest, *self._tree.near((at.real, at.imag) * 2, distance))):
            kind = self._kind(point, k)
            if kind == REPEATED:
                self._ahead = self._passes[k].move_index - point.move_index
                self._is_repeated = True
                return []
            if kind:
                gouges.append(self._gouge(point, k, kind))
        return gouges

    def _is_low(self, level: float, k: int) -> bool:
        return is_low(self._passes[k].move, level)

    def _kind(self, point: WallPoint, k: int) -> str | None:
        """Return how a pass cuts a point: FACING, DEEPER or REPEATED; None where it does not."""
        own, (index, move, _) = self._own, self._passes[k]
        share = move.curve.share_of(point.point)
        if abs(move.curve.point(share) - point.point) >= own.gouge_distance:
            return None
        if index == RAMP:
            return FACING
        beside = self._passes[k].contact(share, own.offset) - point.point
        turned = point.direction.conjugate()
        clearance = (turned * beside).imag * (1.0 if own.offset > 0.0 else -1.0)
        if clearance >= -own.tolerance:
            return FACING
        same_direction = (turned * move.curve.direction(share)).real > SAME_DIRECTION_COSINE
        return REPEATED if same_direction else DEEPER

    def _gouge(self, point: WallPoint, k: int, kind: str) -> _Gouge:
        """Return the gouge of a pass at a point."""
        own, closing, index = self._own, self._own.closing, point.move_index
        cutting, move, _ = self._passes[k]
        if closing.crossing:
            lead = all(k <= closing.first or k >= closing.last for k in (index, cutting))
        else:
            last = len(own.moves) - 1
            lead = not closing.closed and kind == DEEPER and index in (0, last)
        self._is_repeated |= lead
        corner_before = cutting == index > 0  # the corner before a move belongs to both
        line = own.moves[index - 1].line if corner_before else move.line
        return _Gouge(line, lead, cutting == RAMP)

    def _check_crossings(self) -> None:
        """Refuse a contour that goes from one side of itself to the other."""
        own, indices = self._own, list(self._own.walls)
        for index in indices:
            curve = own.walls[index].curve
            others = (indices[other] for other in own.wall_tree.near(curve.box, 0.0))
            for other in (other for other in others if other > index + 1):
                for point in common_points(curve, own.walls[other].curve):
                    if self._goes_through(index, other, point):
                        self._refuse(own.moves[index].line, own.moves[other].line)

    def _goes_through(self, index: int, other: int, point: complex) -> bool:
        """Return whether two moves with a common point cross each other there."""
        own = self._own
        here, there = (own.length_to(k, point) for k in (index, other))
        deep = max(MEETING * own.tolerance, CROSSED * own.radius)
        for share in BESIDE_CROSSING:
            away = share * own.radius
            before, after = (
                own.side(own.point_at(there + step), here, 2.0 * away) for step in (-away, away)
            )
            if min(before, after) < -deep and max(before, after) > deep:
                return True
        return False


def signature(contour: CompensatedContour) -> tuple[float | tuple[int, ...], ...]:
    """Return a key that is equal for contours that differ only by a shift along Z."""
    moves = [*contour.moves, *(each.move for each in contour.ramps)]
    z = moves[0].z0
    levels = [round(level - z, 6) for move in moves for level in (move.z0, move.z1)]
    return contour.offset, *map(in_plane, moves), *levels
