# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges between contours: the tool, while it machines one, cuts deep into the wall of another.

That is refused only where it must be a mistake:

- the contour that is cut closes, and is not cut all round;
- the pass that cuts it is no lead and no ramp, and lies at one of its own Z levels;
- neither contour enters the other one's material anywhere, as a finishing pass does, a slot across
  a boss or a step; nor does a third contour remove what is cut there;
- the cut is deeper than an allowance for finishing can be: a deliberately larger offset makes the
  channel between two contours narrower by twice the allowance.

All other cuts between contours are for ``g12 verify`` to report. Program units.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial
from math import ceil, inf

from g12.compensation.compensated import CompensatedContour, Pass, Sweep, WallPoint
from g12.errors import Refusal
from g12.geometry.boxes import apart

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
            raise Refusal(wall.gouge_text(wall.moves[point.move_index].line, cutting.move.line))


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
    levels, distance = [each.z0 for each in wall.walls.values()], wall.gouge_distance
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
