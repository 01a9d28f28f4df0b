# SPDX-License-Identifier: GPL-2.0-or-later
"""A stretch of a contour with the tool on one side: its shape, and what leads to it.

Where its end meets its beginning it is closed, and what sticks out there is a lead. Points are
complex, lengths mm.

A tool that comes from outside of a closed contour is meant to stay outside of it; one that comes
to an open contour is meant to stay on the side from which it comes, unless it goes over a face to
the side away from the spindle's centre.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import groupby, permutations, product

import numpy as np
from shapely.geometry import LineString, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import nearest_points

from g12.geometry.curve import Curve, Line
from g12.tools.verify.expected.compensated import ContourStep
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LEVEL

STEP = 0.05  # mm between points of an arc
LEADS = 3  # elements at either end of a contour that may be there to lead in or out
MEETS = 1e-3
MITRE = 2  # shapely's number
NEAR = 1e-2  # mm: a contour's end is met, not passed
SIDES = {1: ("G41", "G42"), -1: ("G42", "G41")}  # the code in force, and the other one
ENTERED = 2.0  # tolerances: a contour that is so deep in the part enters it
LENGTHLESS = 1e-6


class Outline:
    """A stretch of elements with the tool on one ``side``: +1 is left, 0 on the contour.

    ``curves`` are the shape's, ``leads`` what sticks out of a closed one, ``depth`` is the lowest.
    """

    def __init__(self, stretch: Sequence[Element]) -> None:
        whole = [element.curve for element in stretch]
        self.side = stretch[0].side
        self.depth = min(element.depth for element in stretch)
        kept = shares_kept(whole) if self.side else [(0.0, 1.0)] * len(whole)
        self.curves = curve_portions(whole, kept)
        self.leads = curve_portions(whole, [(0.0, first) for first, _ in kept])
        self.leads += curve_portions(whole, [(last, 1.0) for _, last in kept])

    @cached_property
    def points(self) -> np.ndarray:
        """Points (complex) along the shape."""
        return np.concatenate([np.zeros(0), *map(drawn_points, self.curves)])

    @property
    def is_closed(self) -> bool:
        """Tell whether the shape ends where it begins."""
        return abs(self.curves[0].start - self.curves[-1].end) < 2 * MEETS

    @property
    def tool_is_inside(self) -> bool:
        """Tell whether the tool is inside of a closed shape."""
        area = (self.points.conj() * np.roll(self.points, -1)).imag.sum()
        return (area > 0.0) == (self.side > 0)

    def part(self, width: float) -> BaseGeometry:
        """Return the part beside it, as far as a width; nothing without a side.

        All within a closed shape is part where the tool is outside.
        """
        if not self.side or not self.curves:
            return Polygon()
        points = vectors(self.points)
        if not self.is_closed:
            line = LineString(points)
            return line.buffer(-self.side * width, single_sided=True, join_style=MITRE)
        area = Polygon(points).buffer(0)
        return area.buffer(width).difference(area) if self.tool_is_inside else area


def stretches_of(section: SectionContour) -> list[list[Element]]:
    """Return a section's elements by side, those on which compensation is switched apart."""
    longer = (element for element in section.elements if element.length > LENGTHLESS)
    return [list(own) for _, own in groupby(longer, lambda each: (each.side, each.ramp))]


def outlines_of(section: SectionContour) -> list[Outline]:
    """Return the outlines of a section, ramps aside."""
    return [Outline(stretch) for stretch in stretches_of(section) if not stretch[0].ramp]


def curve_portions(curves: Sequence[Curve], shares: Sequence[tuple[float, float]]) -> list[Curve]:
    """Return the portions of curves between shares that have a length."""
    found = (curve.portion(*ends) for curve, ends in zip(curves, shares))
    return [portion for portion in found if portion.length > LENGTHLESS]


def shares_kept(curves: Sequence[Curve]) -> list[tuple[float, float]]:
    """Return between which shares each curve is part of the shape."""
    ends = np.cumsum([0.0, *(curve.length for curve in curves)])
    closed = np.array(closing(curves, ends))
    return [
        tuple((np.clip(closed, start, end) - start) / (end - start))
        for start, end in zip(ends, ends[1:])
    ]


def closing(curves: Sequence[Curve], ends: np.ndarray) -> tuple[float, float]:
    """Return the lengths along curves between which they are closed; else the whole length."""
    count = len(curves)
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        if j > i:
            # Neighbours meet where they join: the later half of the second is looked at.
            skipped = 0.5 if j == i + 1 else 0.0
            one, other = as_line(curves[i]), as_line(curves[j].portion(skipped, 1.0))
            if one.distance(other) < MEETS:
                here, there = nearest_points(one, other)
                passed = ends[j] + skipped * curves[j].length
                return ends[i] + one.project(here), passed + other.project(there)
    return 0.0, ends[-1]


def as_line(curve: Curve) -> LineString:
    """Return a curve as a polyline."""
    return LineString(vectors(drawn_points(curve)))


def drawn_points(curve: Curve) -> np.ndarray:
    """Return points along a curve, its ends included."""
    count = 1 if isinstance(curve, Line) else max(1, int(curve.length / STEP))
    return np.array([curve.point(index / count) for index in range(count + 1)])


def vectors(points: np.ndarray) -> list[tuple[float, float]]:
    """Return complex points as pairs."""
    return [(point.real, point.imag) for point in points]


def judge_side(section: SectionContour, tool: float) -> Iterator[Finding]:
    """Yield each compensation that takes the tool (a radius) to the side it does not come from."""
    stretches = stretches_of(section) if tool else []
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
    beside = outline.curves[0].start + 1j * outline.curves[0].direction() * ramp.side * tool
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
        return Outline(self.elements).part(2 * self._tool)


def neighbour_cuts(
    steps: Sequence[ContourStep], tool: float, tolerance: float
) -> Iterator[Finding]:
    """Yield the deepest cut of each contour into each other one that is not meant."""
    runs = groupby(steps, key=lambda step: (step.element.side, step.element.ramp))
    sides = [_Side(list(run), tool) for (side, ramp), run in runs if side and not ramp]
    told: set[tuple[int, int]] = set()
    for one, other in permutations([each for each in sides if each.moves], 2):
        if other.lowest <= one.highest + LEVEL and one.contour.distance(other.path) < tool:
            size, line, cut = max(cuts_into(one, other, tool, tolerance), default=(0.0, 0, 0))
            if size and (line, cut) not in told:
                told.add((line, cut))
                yield Finding("cuts-contour", line, {"size": size, "line": cut})


def cuts_into(
    one: _Side, other: _Side, tool: float, tolerance: float
) -> Iterator[tuple[float, int, int]]:
    """Yield where the tool cuts one contour's part along another contour that does not enter it.

    How deep, the line on whose way it does, and the line of the contour that is cut.
    """
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
        yield size, line, cut


def line_through(points: Sequence[np.ndarray]) -> LineString:
    """Return a polyline through complex points."""
    every = np.concatenate(points)
    return LineString(np.column_stack([every.real, every.imag]))
