# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges between contours: the tool, while it machines one, cuts deep into the wall of another.

That is refused only where it must be a mistake:

- the contour that is cut closes, and is not cut all round;
- the pass that cuts it is no lead and no ramp, and lies at one of its own Z levels;
- neither contour enters the other one's material anywhere, as a finishing pass does, a slot across
  a boss or a step; nor does a third contour where it cuts the same point;
- the cut is deeper than an allowance for finishing can be: a deliberately larger offset makes the
  channel between two contours narrower by twice the allowance.

All other cuts between contours are for ``g12 verify`` to report. Program units.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property, partial
from math import ceil, inf

from g12.compensation.compensated import CompensatedContour, Pass, WallPoint, is_low
from g12.compensation.contour import Contour, PlaneMove
from g12.errors import number
from g12.geometry.boxes import BoxTree, apart

ALLOWANCE = 0.5  # of the tool's radius: no finishing pass cuts deeper
ENTERED = 2.0  # tolerances: a contour deeper in a wall's material enters it
CHECK_STEP = 16.0  # tolerances: distance between the points at which a contour is checked
SAMPLE_COUNT = 2  # passes of another contour: one of these mostly enters, if any does


def check_neighbours(contour: Contour, contours: Sequence[CompensatedContour]) -> None:
    """Refuse a contour along which the tool cuts deep into another, closed one."""
    walled = [each for each in contours if each.walls]
    section = _SectionPasses(walled)
    for wall in walled:
        others = [other for other in walled if wall.closing.closed and _may_cut(other, wall)]
        found = _Neighbourhood(wall, others, section).deepest() if others else None
        if found:
            point, cutting = found
            lines = sorted((wall.moves[point.move_index].line, cutting.move.line))
            contour.refuse(
                lines[1],
                f"the tool of radius {number(wall.radius)} cannot follow both lines "
                f"{lines[0]} and {lines[1]}: beside one of them it cuts into the other",
            )


def _may_cut(other: CompensatedContour, wall: CompensatedContour) -> bool:
    """Return whether contours share a Z level, and a sample of ``other`` does not enter ``wall``.

    Without the sample a hundred concentric roughing passes would take minutes.
    """
    if other is wall or wall.levels.isdisjoint(other.levels):
        return False
    if apart(wall.wall_tree.box, other.tree.box, other.radius):
        return False
    some = other.passes[:: len(other.passes) // SAMPLE_COUNT + 1]
    return not enters(some, other, wall, inf)


class _SectionPasses:
    """The passes of all contours of a section, each with its contour, and one tree of them."""

    def __init__(self, contours: Sequence[CompensatedContour]) -> None:
        self._contours = contours

    @cached_property
    def passes(self) -> list[tuple[CompensatedContour, Pass]]:
        """The passes in the order of the contours."""
        return [(contour, each) for contour in self._contours for each in contour.passes]

    @cached_property
    def tree(self) -> BoxTree:
        """The passes, for a search by position."""
        return BoxTree([each.move.curve for _, each in self.passes])


class _Neighbourhood:
    """A contour that closes, and others of its section that may cut into it."""

    def __init__(
        self,
        wall: CompensatedContour,
        others: Sequence[CompensatedContour],
        section: _SectionPasses,
    ) -> None:
        self._wall, self._others = wall, others
        self._passes, self._tree = section.passes, section.tree
        self._ids = {id(other) for other in others}
        self._intended: dict[int, bool] = {}

    def deepest(self) -> tuple[WallPoint, Pass] | None:
        """Return the wall's point with the deepest unintended cut, and the pass that cuts it.

        Of points that are cut equally deep it is the last.
        """
        found, depth = None, ALLOWANCE * max(other.radius for other in self._others)
        points = list(self._wall.points())
        every = 1 + int(depth / self._wall.spacing)
        around = depth + every * self._wall.spacing
        sampled = (self._tree.nearest(p.point, around, self._is_other) for p in points[::every])
        if all(k is None for _, k in sampled):
            return None
        for point in reversed(points):
            away, k = self._tree.nearest(point.point, depth, partial(self._cuts, point))
            if k is not None:
                depth, found = away, (point, self._passes[k][1])
        return found

    def _is_other(self, k: int) -> bool:
        return id(self._passes[k][0]) in self._ids

    def _cuts(self, point: WallPoint, k: int) -> bool:
        """Return whether a pass in range cuts a point and is not intended to."""
        other, (index, move, levels) = self._passes[k]
        if (
            not self._is_other(k)
            or self._intended.get(id(other))
            or self._wall.levels.isdisjoint(levels)
        ):
            return False
        if not is_low(move, self._level(point)):
            return False
        share = move.curve.share_of(point.point)
        centre = move.curve.point(share)
        if abs(centre - point.point) >= ALLOWANCE * other.radius or other.is_lead(index, centre):
            return False
        return not self._is_intended(other) and not self._is_removed(point)

    def _level(self, point: WallPoint) -> float:
        return self._wall.walls[point.move_index].z0

    def _is_intended(self, other: CompensatedContour) -> bool:
        """Return whether the cut is on purpose: one contour enters the other, or cuts all of it."""
        if id(other) not in self._intended:
            wall = self._wall
            self._intended[id(other)] = (
                enters(other.passes, other, wall, CHECK_STEP)
                or enters(wall.passes, wall, other, CHECK_STEP)
                or all(self._is_cut(point, other) for point in wall.points())
            )
        return self._intended[id(other)]

    def _is_cut(self, point: WallPoint, other: CompensatedContour) -> bool:
        level = self._level(point)
        passes = other.passes
        found = other.tree.nearest(
            point.point,
            other.gouge_distance,
            lambda k: is_low(passes[k].move, level),
        )
        return found[1] is not None

    def _is_removed(self, point: WallPoint) -> bool:
        """Return whether a contour that enters the material cuts the point, too."""
        level = self._level(point)
        return any(
            enters([each], other, self._wall, CHECK_STEP)
            for other, each in self._passes
            if id(other) in self._ids
            and is_low(each.move, level)
            and each.move.curve.distance(point.point) < other.gouge_distance
        )


def enters(
    passes: Iterable[Pass], other: CompensatedContour, wall: CompensatedContour, step: float
) -> bool:
    """Return whether passes of ``other`` that cut a wall machine ``other`` in its material.

    They are checked at points ``step`` tolerances apart.
    """
    levels = [each.z0 for each in wall.walls.values()]
    for each in passes:
        curve = each.move.curve
        if apart(curve.box, wall.wall_tree.box, other.gouge_distance):
            continue
        low = partial(_is_as_low, each.move, levels)
        count = max(1, ceil(curve.length / (step * wall.tolerance)))
        for share in (k / count for k in range(count + 1)):
            if wall.wall_tree.nearest(curve.point(share), other.gouge_distance, low)[1] is None:
                continue
            clearance, at_end = wall.clearance(each.contact(share, other.offset))
            if at_end or clearance < -ENTERED * wall.tolerance:
                return True
    return False


def _is_as_low(move: PlaneMove, levels: Sequence[float], index: int) -> bool:
    return is_low(move, levels[index])
