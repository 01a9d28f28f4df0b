# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges: points of a contour's walls that the tool cuts while it machines that same contour.

A point is cut where the tool's centre comes nearer than the radius, less the tolerance, at its Z
level or below. That is valid

- beyond the point where the contour closes: leads are no walls (`closing_of`);
- where another portion of the contour runs deeper in the material, in the same direction: a spiral,
  a finishing pass. Which of the two comes first is not checked: a lead-out may be a spiral, too;
- where the contour runs through the air between two plunges.

Everything else is refused, and so is a contour of such passes that crosses itself. Two cases are
only reported: leads that cross each other, and an open contour's first or last move that a later
pass cuts from its far side.

Gouges between contours, where the tool that machines one cuts deep into the wall of another, are
refused only where they must be a mistake:

- the contour that is cut closes, and is not cut all round;
- the pass that cuts it is no lead and no ramp, and lies at one of its own Z levels;
- neither contour enters the other one's material anywhere, as a finishing pass does, a slot across
  a boss or a step; nor does a third contour remove what is cut there;
- the cut is deeper than an allowance for finishing can be: a deliberately larger offset makes the
  channel between two contours narrower by twice the allowance.

All other cuts between contours may be meant. Program units.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from itertools import chain, groupby
from math import ceil, inf
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
from g12.errors import Refusal
from g12.geometry.curve import apart, common_points

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
        raise (LeadRefusal if is_lead else Refusal)(*own.gouge(one, other))

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
    z = moves[0].h0
    levels = [round(level - z, 6) for move in moves for level in (move.h0, move.h1)]
    return contour.offset, *map(in_plane, moves), *levels


ALLOWANCE = 0.5  # of the tool's radius: no finishing pass cuts deeper
ENTERED = 2.0  # tolerances: a contour deeper in a wall's material enters it
CHECK_STEP = 16.0  # tolerances: distance between the points at which a contour is checked
SAMPLE_COUNT = 2  # passes of another contour: one of these mostly enters, if any does


def check_neighbours(contours: Sequence[CompensatedContour]) -> None:
    """Refuse a contour along which the tool cuts deep into another, closed one."""
    walled = [each for each in contours if each.walls]
    section = Sweep(each for other in walled for each in other.passes)
    for wall in (each for each in walled if each.closing.closed):
        others = [other for other in walled if _may_cut(other, wall)]
        found = _Neighbourhood(wall, others, section).deepest() if others else None
        if found:
            point, cutting = found
            raise Refusal(*wall.gouge(wall.moves[point.move_index].line, cutting.move.line))


def _may_cut(other: CompensatedContour, wall: CompensatedContour) -> bool:
    """Return whether contours share a Z level, and a sample of ``other`` does not enter ``wall``.

    Without the sample a hundred concentric roughing passes would take minutes.
    """
    if other is wall or wall.levels.isdisjoint(other.levels):
        return False
    if apart(wall.wall_tree.box, other.sweep.box, other.radius):
        return False
    return not enters(other.passes[:: len(other.passes) // SAMPLE_COUNT + 1], wall, inf)


class _Neighbourhood:
    """A contour that closes, and others of its section that may cut into it."""

    def __init__(
        self, wall: CompensatedContour, others: Iterable[CompensatedContour], section: Sweep
    ) -> None:
        self._wall, self._section = wall, section
        self._others = Sweep(each for other in others for each in other.passes)
        self._intended: dict[int, bool] = {}

    def deepest(self) -> tuple[WallPoint, Pass] | None:
        """Return the wall's point with the deepest unintended cut, and the pass that cuts it.

        Of points that are cut equally deep it is the last.
        """
        found, depth = None, (1.0 - ALLOWANCE) * self._wall.radius
        for point in reversed(list(self._wall.points())):
            depth, cutting = self._others.deepest(point, depth, partial(self._cuts, point))
            found = (point, cutting) if cutting else found
        return found

    def _cuts(self, point: WallPoint, cutting: Pass) -> bool:
        """Return whether a pass in range cuts a point and is not intended to."""
        other, curve = cutting.contour, cutting.move.curve
        if self._intended.get(id(other)) or self._wall.levels.isdisjoint(cutting.levels):
            return False
        centre = curve.point(curve.share_of(point.point))
        if other.is_lead(cutting.move_index, centre):
            return False
        return not self._is_intended(other) and not self._is_removed(point, centre)

    def _is_intended(self, other: CompensatedContour) -> bool:
        """Return whether the cut is on purpose: one contour enters the other, or cuts all of it."""
        if id(other) not in self._intended:
            wall = self._wall
            self._intended[id(other)] = (
                enters(other.passes, wall, CHECK_STEP)
                or enters(wall.passes, other, CHECK_STEP)
                or all(other.sweep.cuts(point, wall.gouge_distance) for point in wall.points())
            )
        return self._intended[id(other)]

    def _is_removed(self, point: WallPoint, centre: complex) -> bool:
        """Return whether a contour that enters the material removes what the tool cuts at a point.

        An allowance may remain behind what it removes. ``centre`` is the tool's.
        """
        wall = self._wall
        inward = -1j * wall.side * point.direction
        deep = point._replace(point=centre + (1.0 - ALLOWANCE) * wall.radius * inward)
        removed = deep if wall.clearance(deep.point)[0] < 0.0 else point  # a fin: air behind it
        return any(
            enters([each], wall, CHECK_STEP)
            for each in self._section.cutting(removed, wall.radius + wall.tolerance)
            if each.contour is not wall
        )


def enters(passes: Iterable[Pass], wall: CompensatedContour, step: float) -> bool:
    """Return whether passes that cut a wall machine their own contour in its material.

    They are checked at points ``step`` tolerances apart.
    """
    levels, distance = [each.h0 for each in wall.walls.values()], wall.gouge_distance
    for each in passes:
        curve = each.move.curve
        if apart(curve.box, wall.wall_tree.box, distance):
            continue
        low = partial(_is_as_low, each, levels)
        count = max(1, ceil(curve.length / (step * wall.tolerance)))
        for share in (k / count for k in range(count + 1)):
            if wall.wall_tree.nearest(curve.point(share), distance, low)[1] is None:
                continue
            clearance, at_end = wall.clearance(each.contact(share))
            if at_end or clearance < -ENTERED * wall.tolerance:
                return True
    return False


def _is_as_low(cutting: Pass, levels: Sequence[float], index: int) -> bool:
    return cutting.is_low(levels[index])
