# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the tool, on its way along one compensated contour, cuts into the part beside another.

Contours are what lies between two ramps. The part is on the side away from the tool, as far as the
tool reaches. A cut is meant where the other contour itself goes into that part: a finishing pass, a
slot across a boss, a step. A pass above a contour's own level cuts nothing of it. Points are
complex, lengths mm.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import groupby, permutations
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from g12.tools.verify.expected.compensated import ContourStep
from g12.tools.verify.result.tolerances import LEVEL
from g12.tools.verify.sections.outline import Outline, drawn_points

ENTERED = 2.0  # tolerances: a contour that is so deep in the part enters it
LENGTHLESS = 1e-6


class NeighbourCut(NamedTuple):
    """The line on whose way the tool cuts, the line of the contour that it cuts, and how deep."""

    line: int
    other: int
    size: float
    at: complex


class _Side:
    """A compensated contour: what is cut, and where the tool's centre goes."""

    def __init__(self, steps: Sequence[ContourStep], tool: float) -> None:
        self.moves = [step.move for step in steps if step.move.curve.length > LENGTHLESS]
        elements = {id(step.element): step.element for step in steps}
        longer = (each for each in elements.values() if each.length > LENGTHLESS)
        self.elements, self._tool = list(longer), tool
        levels = [level for move in self.moves for level in (move.start_level, move.end_level)]
        self.lowest, self.highest = min(levels, default=0.0), max(levels, default=0.0)

    @cached_property
    def contour(self) -> LineString:
        """The contour as a polyline."""
        return line_through([drawn_points(each.curve) for each in self.elements])

    @cached_property
    def path(self) -> LineString:
        """The path of the tool's centre as a polyline."""
        return line_through([drawn_points(move.curve) for move in self.moves])

    @cached_property
    def part(self) -> BaseGeometry:
        """The part beside the contour, as far as the tool reaches."""
        outline = Outline(self.elements)
        line = line_through([outline.points])
        if not outline.is_closed:
            return line.buffer(-2 * outline.side * self._tool, single_sided=True)
        area = Polygon(line.coords).buffer(0)
        return area.buffer(2 * self._tool).difference(area) if outline.tool_is_inside else area


def neighbour_cuts(
    steps: Sequence[ContourStep], tool: float, tolerance: float
) -> list[NeighbourCut]:
    """Return the deepest cut of each contour into each other one that is not meant."""
    runs = groupby(steps, key=lambda step: (step.element.side, step.element.ramp))
    sides = [_Side(list(run), tool) for (side, ramp), run in runs if side and not ramp]
    found: dict[tuple[int, int], NeighbourCut] = {}
    for one, other in permutations([each for each in sides if each.moves], 2):
        if other.lowest <= one.highest + LEVEL and one.contour.distance(other.path) < tool:
            cuts = cuts_into(one, other, tool, tolerance)
            deepest = max(cuts, key=lambda each: each.size, default=None)
            if deepest:
                found.setdefault((deepest.line, deepest.other), deepest)
    return list(found.values())


def cuts_into(one: _Side, other: _Side, tool: float, tolerance: float) -> Iterator[NeighbourCut]:
    """Yield where the tool cuts one contour's part along another contour that does not enter it."""
    swept = other.path.buffer(tool - tolerance).intersection(one.part)
    entering = other.contour.intersection(one.part.buffer(-ENTERED * tolerance))
    for region in getattr(swept, "geoms", [swept]):
        wall = one.contour.intersection(region.buffer(tolerance / 2))
        if wall.is_empty or region.area < tolerance**2:
            continue
        if not entering.is_empty and entering.distance(region) < 2.0 * tolerance:
            continue
        point, _ = nearest_points(wall, other.path)
        at, size = complex(point.x, point.y), tool - wall.distance(other.path)
        line = min(other.moves, key=lambda move: move.curve.distance(at)).line
        cut = min(one.elements, key=lambda each: each.curve.distance(at)).line
        yield NeighbourCut(line, cut, size, at)


def line_through(points: Sequence[np.ndarray]) -> LineString:
    """Return a polyline through complex points."""
    every = np.concatenate(points)
    return LineString(np.column_stack([every.real, every.imag]))
