# SPDX-License-Identifier: GPL-2.0-or-later
"""A stretch of a contour with the tool on one side: its shape, and what leads to it.

Where its end meets its beginning it is closed, and what sticks out there is a lead. Points are
complex, lengths mm.

A tool that comes from outside of a closed contour is to stay outside of it; one that comes to an
open contour is to stay on the side from which it comes, unless it goes over a face to the side away
from the spindle's centre.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import groupby, permutations, product

import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points, substring

from g12.geometry.curve import Curve, Line
from g12.tools.verify.expected.compensated import ContourStep
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.expected.toolpath import NO_LENGTH
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL

STEP = 0.05  # mm between points of an arc
LEADS = 3  # elements at either end of a contour that may be there to lead in or out
MEETS = 1e-3
MITRE = 2  # shapely's number
NEAR = 1e-2  # mm: a contour's end is met, not passed
SIDES = {1: ("G41", "G42"), -1: ("G42", "G41")}  # the code in force, and the other one
ENTERED = 2.0  # tolerances: a contour that is so deep in the part enters it


class Outline:
    """A stretch of elements with the tool on one ``side``: +1 is left, 0 on the contour.

    ``line`` is the shape, ``leads`` what sticks out of a closed one, ``depth`` is the lowest.
    """

    def __init__(self, stretch: Sequence[Element]) -> None:
        self.side = stretch[0].side
        self.depth = min(element.depth for element in stretch)
        lines = [drawn(element.curve) for element in stretch]
        whole = joined(lines)
        first, last = closing(lines) if self.side else (0.0, whole.length)
        self.line = substring(whole, first, last)
        ends = substring(whole, 0.0, first), substring(whole, last, whole.length)
        self.leads = [lead for lead in ends if lead.length > NO_LENGTH]

    @cached_property
    def points(self) -> np.ndarray:
        return complex_points(self.line)

    @cached_property
    def _area(self) -> float:
        """Twice the area that it encloses, positive counterclockwise."""
        return float((self.points.conj() * np.roll(self.points, -1)).imag.sum())

    @property
    def is_closed(self) -> bool:
        """Tell whether the shape ends where it begins; one that goes there and back is not."""
        meets = abs(self.points[0] - self.points[-1]) < 2 * MEETS
        return meets and abs(self._area) > MEETS * self.line.length

    @property
    def tool_is_inside(self) -> bool:
        """Tell whether the tool is inside of a closed shape."""
        return (self._area > 0.0) == (self.side > 0)

    def part(self, width: float) -> BaseGeometry:
        """Return the part beside it, as far as a width; nothing without a side.

        All within a closed shape is part where the tool is outside.
        """
        if not self.side:
            return Polygon()
        if not self.is_closed:
            return self.line.buffer(-self.side * width, single_sided=True, join_style=MITRE)
        area = Polygon(self.line.coords).buffer(0)
        return area.buffer(width).difference(area) if self.tool_is_inside else area


def stretches_of(section: SectionContour) -> list[list[Element]]:
    """Return a section's elements by side, those on which compensation is switched apart."""
    longer = (element for element in section.elements if element.length > NO_LENGTH)
    return [list(own) for _, own in groupby(longer, lambda each: (each.side, each.ramp))]


def outlines_of(section: SectionContour) -> list[Outline]:
    """Return the outlines of a section, ramps aside."""
    return [Outline(stretch) for stretch in stretches_of(section) if not stretch[0].ramp]


def closing(lines: Sequence[LineString]) -> tuple[float, float]:
    """Return the lengths along lines in a row between which they are closed; else the whole length.

    The first of them meets one of the last ones where they join: of neighbours the later half of
    the second counts.
    """
    ends, count = np.cumsum([0.0, *(line.length for line in lines)]), len(lines)
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        if j > i:
            skipped = lines[j].length / 2 if j == i + 1 else 0.0
            other = substring(lines[j], skipped, lines[j].length)
            if lines[i].distance(other) < MEETS:
                here, there = nearest_points(lines[i], other)
                return ends[i] + lines[i].project(here), ends[j] + skipped + other.project(there)
    return 0.0, ends[-1]


def drawn(curve: Curve) -> LineString:
    """Return a curve as a polyline, its ends included."""
    count = 1 if isinstance(curve, Line) else max(1, int(curve.length / STEP))
    return LineString(vectors([curve.point(index / count) for index in range(count + 1)]))


def joined(lines: Sequence[LineString]) -> LineString:
    """Return polylines in a row as one."""
    return LineString([point for line in lines for point in line.coords])


def complex_points(line: LineString) -> np.ndarray:
    """Return the points (complex) of a polyline."""
    return np.array(line.coords) @ (1, 1j)


def vectors(points: Sequence[complex] | np.ndarray) -> list[tuple[float, float]]:
    """Return complex points as pairs."""
    return [(point.real, point.imag) for point in points]


def judge_side(section: SectionContour, tool: float) -> Iterator[Finding]:
    """Yield each compensation that takes the tool (a radius) to the side it does not come from."""
    stretches = stretches_of(section) if tool > 0.0 else []
    for before, stretch in zip(stretches, stretches[1:]):
        if before[-1].ramp and before[-1].side and not stretch[0].ramp:
            outline = Outline(stretch)
            if np.abs(outline.points - before[-1].start).min() > NEAR:
                if outline.is_closed:
                    yield from closed_side(section.line, before[-1], outline)
                else:
                    yield from open_side(section, before[-1], outline, tool)


def closed_side(line: int, ramp: Element, outline: Outline) -> Iterator[Finding]:
    """Yield that the tool comes from the other side of a closed contour."""
    away = outline.points - ramp.start
    turns = np.angle(np.roll(away, -1) / away).sum() / (2 * np.pi)
    if outline.tool_is_inside != (abs(turns) > 0.5):
        code, instead = SIDES[ramp.side]
        here, there = ("inside", "outside")[:: 1 if outline.tool_is_inside else -1]
        values = {"here": here, "there": there, "code": code, "instead": instead}
        yield Finding("side-other", line, values)


def open_side(
    section: SectionContour, ramp: Element, outline: Outline, tool: float
) -> Iterator[Finding]:
    """Yield that the tool crosses an open contour; on a face it may go over the part."""
    beside = Line(*outline.points[:2]).offset(ramp.side * tool).start
    over = not section.surface and ramp.depth > outline.depth + NEAR
    over = over and crosses(0j, beside, outline.points)
    if crosses(ramp.start, beside, outline.points) and not over:
        yield Finding("side-crossed", section.line, {"instead": SIDES[ramp.side][1]})


def crosses(start: complex, end: complex, points: np.ndarray) -> bool:
    """Tell whether a line ends on the other side of a polyline than it starts."""
    along = points[[1, -1]] - points[[0, -2]]
    ends = points[[0, -1]] + along / np.abs(along) * (-NEAR, NEAR)
    contour = LineString(vectors([ends[0], *points, ends[1]]))
    met = contour.intersection(LineString(vectors([start, end])))
    return len(getattr(met, "geoms", [met] * (not met.is_empty))) % 2 == 1


class CutContour:
    """A contour that is cut: its ``line``, the ``path`` of the tool's centre."""

    def __init__(self, steps: Sequence[ContourStep]) -> None:
        self.side = steps[0].element.side
        self.moves = [step.move for step in steps]
        self.elements = list({id(step.element): step.element for step in steps}.values())
        levels = [level for move in self.moves for level in (move.start_level, move.end_level)]
        self.lowest, self.highest = min(levels), max(levels)
        self.line = joined([drawn(each.curve) for each in self.elements])
        self.path = joined([drawn(move.curve) for move in self.moves])


def neighbour_cuts(
    steps: Sequence[ContourStep], tool: float, tolerance: float, zero: float
) -> Iterator[Finding]:
    """Yield the deepest cut into each compensated contour that is not commanded.

    Another contour may enter it. A toolpath without compensation that does so is a slot, or a
    retract is missing. ``zero`` is the level of the part's face or surface.
    """
    across = (step for step in steps if step.move.curve.length > NO_LENGTH)
    cuts = [CutContour(list(run)) for (ramp, *_), run in groupby(across, _kind_of_run) if not ramp]
    cuts = [cut for cut in cuts if cut.side or cut.lowest < zero - LEVEL]
    reported: set[tuple[int, int]] = set()
    for one, other in permutations(cuts, 2):
        is_low = one.side and other.lowest <= one.highest + LEVEL
        if is_low and one.line.distance(other.path) < tool:
            size, line, cut = max(cuts_into(one, other, tool, tolerance), default=(0.0, 0, 0))
            if size and (line, cut) not in reported:
                reported.add((line, cut))
                yield Finding("cuts-contour", line, {"size": size, "line": cut})


def _kind_of_run(step: ContourStep) -> tuple[float, ...]:
    """Return what the steps of one contour share; without compensation also their level."""
    move, element = step
    levels = () if element.side else (move.start_level, move.end_level)
    return element.ramp, element.side, *levels


def cuts_into(
    one: CutContour, other: CutContour, tool: float, tolerance: float
) -> Iterator[tuple[float, int, int]]:
    """Yield where the tool cuts one contour's part along another contour that does not enter it.

    How deep, the line along which it does, and the line of the contour that is cut.
    """
    part = Outline(one.elements).part(2 * tool)
    swept = other.path.buffer(tool - tolerance).intersection(part)
    entering = Polygon()
    if other.side:
        entering = other.line.intersection(part.buffer(-ENTERED * tolerance))
    for region in getattr(swept, "geoms", [swept]):
        wall = one.line.intersection(region.buffer(tolerance / 2))
        if wall.is_empty or region.area < tolerance**2:
            continue
        if not entering.is_empty and entering.distance(region) < 2.0 * tolerance:
            continue
        point, _ = nearest_points(wall, other.path)
        at, size = complex(point.x, point.y), tool - wall.distance(other.path)
        line = min(other.moves, key=lambda move: move.curve.distance(at)).line
        cut = min(one.elements, key=lambda each: each.curve.distance(at)).line
        yield size, line, cut
