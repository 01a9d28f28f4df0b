# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges: points of a contour's walls that the tool cuts while it machines that same contour.

A point is cut where the tool's centre comes nearer than the radius, less the tolerance, at its Z
level or below. That is valid

- beyond the point where the contour closes: leads are no walls (`closing`);
- where another portion of the contour runs deeper in the material, in the same direction: a spiral,
  a finishing pass. Which of the two comes first is not checked: a lead-out may be a spiral, too;
- where the contour runs through the air between two plunges.

Everything else is refused, and so is a contour of such passes that crosses itself. Two cases are
only reported: leads that cross each other, and an open contour's first or last move that a later
pass cuts from its far side. `neighbours` checks the other contours of the section.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, groupby
from math import inf
from typing import NamedTuple, NoReturn

from g12.compensation.compensated import (
    MEETING,
    RAMP,
    CompensatedContour,
    Pass,
    PathOfMove,
    Sweep,
    WallPoint,
    compensated_contours,
    in_plane,
)
from g12.compensation.contour import Contour
from g12.compensation.neighbours import check_neighbours
from g12.errors import Refusal
from g12.geometry.crossing import common_points

SAME_DIRECTION_COSINE = 0.9  # cosine: passes in the same direction differ by less than this angle
CROSSED = 0.02  # of the tool's radius: a contour that goes farther to both sides crosses itself
# of the tool's radius: distances from the crossing at which that is checked
BESIDE_CROSSING = (0.125, 0.25, 0.5, 1.0)


class LeadRefusal(Refusal):
    """The tool gouges a closed contour on its lead-in or lead-out."""


class _Gouge(NamedTuple):
    """A cut into the contour by the pass for the move of ``line``.

    ``lead``: that move, or the one that is cut, may be a lead-in or lead-out. ``ramp``: that move
    is the one with G40, G41 or G42.
    """

    line: int
    lead: bool
    ramp: bool


def check_gouges(contour: Contour, cuts: Sequence[PathOfMove], tolerance: float) -> None:
    """Refuse contours that the tool gouges by more than the tolerance.

    Reports that are no refusal go to the contour's ``notes``. Program units.
    """
    found = compensated_contours(contour, cuts, tolerance)
    cut = [each for each in found if each.radius > tolerance]
    for each in {signature(each): each for each in reversed(cut)}.values():
        _OwnWalls(contour, each).check()
    check_neighbours(cut)


class _OwnWalls:
    def __init__(self, contour: Contour, own: CompensatedContour) -> None:
        self._contour, self._own = contour, own
        self._sweep = Sweep(_passes_that_cut(contour, own))
        self._repeating: Pass | None = None  # the one found last that repeats a wall's own pass
        self._has_leads = False

    def check(self) -> None:
        own, closing = self._own, self._own.closing
        if closing.crossing:
            first, last = own.moves[closing.first], own.moves[closing.last]
            self._note(
                first.line,
                last.line,
                "cross: taken for the leads of a contour that closes there",
            )
        points_of_walls = (point for point in own.points() if not self._is_at_seam(point))
        for index, points in groupby(points_of_walls, key=lambda point: point.move_index):
            gouges = [gouge for point in points for gouge in self._gouges(point)]
            worst = min(gouges, key=lambda gouge: (gouge.lead, gouge.ramp), default=None)
            line = own.moves[index].line
            if worst and not worst.lead:
                self._refuse(line, worst.line)
            if worst and not closing.crossing:
                self._note(line, worst.line, "cut into each other: one is taken for a lead")
        if self._repeating or self._has_leads:  # otherwise what crosses is not machined
            self._check_crossings()

    def _is_at_seam(self, point: WallPoint) -> bool:
        """Return whether a size correction's leads, from its other side, have to pass a point."""
        own = self._own
        if not (self._contour.mirrored and own.closing.closed):
            return False
        seam = own.point_at(0.0), own.point_at(inf)
        return min(abs(point.point - end) for end in seam) < 2.0 * own.radius

    def _refuse(self, one: int, other: int) -> NoReturn:
        """Refuse two lines; where one leads to or from a closed contour the side may be wrong."""
        own, moves = self._own, self._own.moves
        is_lead = own.closing.closed and {moves[0].line, moves[-1].line} & {one, other}
        raise (LeadRefusal if is_lead else Refusal)(own.gouge_text(one, other))

    def _note(self, one: int, other: int, what: str) -> None:
        one, other = sorted((one, other))
        text = f"{self._contour.code} line {other}: lines {one} and {other} {what}"
        if text not in self._contour.notes:
            self._contour.notes.append(text)

    def _gouges(self, point: WallPoint) -> list[_Gouge]:
        """Return the gouges at a wall's point, none where another pass repeats the wall's own."""
        distance, repeating = self._own.gouge_distance, self._repeating
        # The pass that repeated the last point mostly repeats this one: that saves the search.
        if repeating and repeating.cuts(point, distance) and self._repeats(repeating, point):
            return []
        _, deepest = self._sweep.deepest(point, distance)
        if deepest is None:
            return []
        gouges = []
        for each in chain([deepest], self._sweep.cutting(point, distance)):
            if self._repeats(each, point):
                self._repeating = each
                return []
            gouges.append(self._gouge(point, each))
        return gouges

    def _repeats(self, cutting: Pass, point: WallPoint) -> bool:
        """Return whether a pass cuts deeper into the material, in the wall's direction."""
        curve = cutting.move.curve
        along = point.direction.conjugate() * curve.direction(curve.share_of(point.point))
        return along.real > SAME_DIRECTION_COSINE and self._is_deeper(cutting, point)

    def _is_deeper(self, cutting: Pass, point: WallPoint) -> bool:
        """Return whether the wall that a pass machines is deeper in the material than a point."""
        own, share = self._own, cutting.move.curve.share_of(point.point)
        beside = point.direction.conjugate() * (cutting.contact(share) - point.point)
        return cutting.move_index != RAMP and beside.imag * own.side < -own.tolerance

    def _gouge(self, point: WallPoint, cutting: Pass) -> _Gouge:
        own, closing = self._own, self._own.closing
        index, by = point.move_index, cutting.move_index
        if closing.crossing:
            lead = all(k <= closing.first or k >= closing.last for k in (index, by))
        else:
            at_end = index in (0, len(own.moves) - 1)
            lead = not closing.closed and at_end and self._is_deeper(cutting, point)
        self._has_leads |= lead
        corner_before = by == index > 0  # the corner before a move belongs to both
        line = own.moves[index - 1].line if corner_before else cutting.move.line
        return _Gouge(line, lead, by == RAMP)

    def _check_crossings(self) -> None:
        """Refuse a contour that goes from one side of itself to the other."""
        own, indices = self._own, list(self._own.walls)
        for index in indices:
            curve = own.walls[index].curve
            others = (indices[other] for other in own.wall_tree.near(curve.box, 0.0))
            for other in (other for other in others if other > index):
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
                own.across(own.point_at(there + step), here, 2.0 * away) for step in (-away, away)
            )
            if min(before, after) < -deep and max(before, after) > deep:
                return True
        return False


def _passes_that_cut(contour: Contour, own: CompensatedContour) -> list[Pass]:
    """Return the passes that may gouge the contour's walls.

    At the ends of an open contour there may be no material: its ramps may cut there. With a size
    correction to the other side the leads come from there, as without one, across the contour.
    """
    if contour.mirrored:
        return [each for each in own.passes if each.move_index in own.walls]
    return [*own.passes, *(own.ramps if own.closing.closed else ())]


def signature(contour: CompensatedContour) -> tuple[float | tuple[int, ...], ...]:
    """Return a key that is equal for contours that differ only by a shift along Z."""
    moves = [*contour.moves, *(each.move for each in contour.ramps)]
    z = moves[0].z0
    levels = [round(level - z, 6) for move in moves for level in (move.z0, move.z1)]
    return contour.offset, *map(in_plane, moves), *levels
