# SPDX-License-Identifier: GPL-2.0-or-later
"""The material that a program assumes where no stock is given, and the holes in it.

A pocket has a wall around it, a perimeter a boss inside. Both are solid below the program's Z0, or,
where the program first goes below that by rapid and feeds down from there, below that level; with a
Z0 that lies lower, below the lowest level from which a circle is fed down to. Where it is not known
how the tool comes down, nothing is.

On a lathe's face a compensated contour has its part on the side away from the tool: all within a
closed contour that is cut from outside, else a wall beside it. A section without compensation is
cut into a face as large as its toolpath, the cutter's own width aside. A cylinder is solid where
grooves are cut, and a wall farther along Z, but not in front of the program's Z0 where they run out
there. All of it is solid below the program's Z0 (the surface), or below the level from which a
section is fed down to where that is lower.

Lengths are mm in machine coordinates; of sections places are those of the face or of the unrolled
surface.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import split, transform, unary_union

from g12.tools.material.material import SAME_LEVEL, Material
from g12.tools.path.part import X, Z, disc, is_sideways
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.plane import Plane, plane_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.reading.circles import Target
from g12.tools.verify.sections.outline import LENGTHLESS, Outline, outlines_of, vectors

WALL = 2.0  # how thick the wall of a pocket is, at least
SAME_PLACE = 0.05
BEYOND = 10.0  # bars: how far an open contour's ends are drawn on
PROBE = 1e-3  # mm beside a contour
FAR = 1e6  # round a cylinder

Circles = Sequence[tuple[Block, Target]]
Radius = Callable[[int], float]  # of the cutter of a move
Solids = Iterator[tuple[BaseGeometry, float]]


class AssumedHole(NamedTuple):
    """A hole that is assumed: the line that does and why, where it is entered to, its radius."""

    line: int
    place: tuple[float, float, float]
    radius: float
    why: str


class Approach(NamedTuple):
    """How the tool comes down to a circle: where from, where it begins to feed, to which floor.

    ``move`` is its last rapid straight down, None without one. A level is None where nothing is
    fed down.
    """

    came: float
    fed: float | None
    floor: float
    move: int | None


def add_circles(material: Material, circles: Circles, approaches: Sequence[Approach]) -> None:
    """Make solid what circles are cut in."""
    faces: dict[float, float] = {}
    for (_, target), approach in zip(circles, approaches):
        face = target.wall.face
        known = approach.came > approach.floor + SAME_LEVEL
        if known and face not in faces and approach.floor < face - SAME_LEVEL:
            below = approach.fed is not None and approach.floor < approach.fed - SAME_LEVEL
            faces[face] = min(face, approach.fed) if below else face
    starts = sorted(each.came if each.fed is None else each.fed for each in approaches)
    for (_, target), approach in zip(circles, approaches):
        wall, floor = target.wall, approach.floor + SAME_LEVEL
        top = faces.get(wall.face, -math.inf)
        top = top if floor < top else next((start for start in starts if start > floor), None)
        if top is not None:
            material.add(disc(wall.origin, wall.radius + (WALL if wall.inside else 0.0)), top)


def approach_to(block: Block, moves: Sequence[Move]) -> Approach:
    """Return how the tool comes down to a circle, in its block or before it."""
    sideways = [
        i for i in range(block.at, block.end) if moves[i].kind != "rapid" and is_sideways(moves[i])
    ]
    first = next(iter(sideways), block.end)
    floor = min((moves[index].end[Z] for index in sideways), default=math.inf)
    floor = floor if floor < moves[block.at].start[Z] + SAME_LEVEL else math.inf  # it is fed up to
    begin = first
    while begin and not is_sideways(moves[begin - 1]):
        begin -= 1
    down = [i for i in range(begin, block.end) if moves[i].end[Z] < moves[i].start[Z] - SAME_LEVEL]
    fed = next((moves[i].start[Z] for i in down if moves[i].kind != "rapid"), None)
    rapid = next((i for i in reversed(down) if i < first and moves[i].kind == "rapid"), None)
    came = max(moves[i].start[Z] for i in range(begin, min(first, len(moves) - 1) + 1))
    return Approach(came, fed, floor, rapid)


def holes_of_words(circles: Circles) -> Iterator[AssumedHole]:
    """Yield the holes that words say there are: R of Yasnac."""
    for _, target in circles:
        if target.wall.bore:
            x, y, z = map(float, target.wall.origin)
            yield AssumedHole(target.line, (x, y, z), target.wall.bore, "the word R names it")


def holes_entered(
    circles: Circles,
    approaches: Sequence[Approach],
    moves: Sequence[Move],
    material: Material,
    radius: Callable[[int], float],
) -> list[AssumedHole]:
    """Return the holes that a program comes down into by rapid, if it does so at its first circle.

    ``radius`` gives that of a move's cutter.
    """
    found: list[AssumedHole] = []
    positions: list[complex] = []
    for (_, target), approach in zip(circles, approaches):
        place, index = complex(*target.wall.origin[:2]), approach.move
        if any(abs(place - other) < SAME_PLACE for other in positions):
            continue
        positions.append(place)
        if index is not None:
            end = np.array([moves[index].end[:3]])
            below = not found and end[0, Z] < min(target.wall.face, approach.came) - SAME_LEVEL
            if below or material.touched(end, radius(index), 0):
                x, y, z = map(float, end[0])
                line, why = moves[index].block, "a rapid goes into it"
                found.append(AssumedHole(line, (x, y, z), radius(index), why))
        if not found:
            break
    return found


class SurfaceKey(NamedTuple):
    """A part's surface: a cylinder's radius and where it is along X, or 0 and a face's Z."""

    radius: float
    face: float


def add_sections(
    material: Material,
    sections: Sequence[SectionContour],
    moves: Sequence[Move],
    radius: Radius,
    surface: SurfaceKey | None = None,
) -> None:
    """Make solid what sections on a face are cut in, or those on one ``surface`` of a cylinder."""
    keys = [surface_key(section, moves) for section in sections]
    solids, axis = (_cylinder_solids, X) if surface else (_face_solids, Z)
    for section, key, span in zip(sections, keys, _spans(sections, keys, moves, axis)):
        if surface in (None, key):
            for area, top in solids(section, moves, radius(section.at)):
                material.add(area, top, *span)


def surface_key(section: SectionContour, moves: Sequence[Move]) -> SurfaceKey:
    """Return the surface of a section: a cylinder's radius, and where it is along X or Z."""
    face = plane_of(section, moves[section.at]).face
    return SurfaceKey(round(section.surface, 6), round(face, 6))


def _spans(
    sections: Sequence[SectionContour], keys: Sequence[SurfaceKey], moves: Sequence[Move], axis: int
) -> Iterator[tuple[int, float]]:
    """Yield the moves for which the material of each section counts: from it on.

    It is another part, or another end of it, where a section has another key: up to the retract
    before that.
    """
    for at, (section, key) in enumerate(zip(sections, keys)):
        others = (i for i in range(at + 1, len(sections)) if keys[i] != key)
        other = next(others, None)
        if other is None:
            yield section.at, math.inf
            continue
        last, begin = sections[other - 1].end, sections[other].at
        up = (i for i in range(last - 1, begin) if moves[i].end[axis] > key.face - SAME_LEVEL)
        yield section.at, next(up, begin)


def _face_solids(section: SectionContour, moves: Sequence[Move], cutter: float) -> Solids:
    """Yield what a section on a face is cut in, each area with its top."""
    plane = plane_of(section, moves[section.at])
    cut = [moves[i] for i in range(section.at, section.end) if moves[i].kind != "rapid"]
    lowest = min((move.end[Z] for move in cut), default=math.inf)
    falls = (move.start[Z] for move in cut if move.end[Z] < move.start[Z] - SAME_LEVEL)
    top = min(plane.base, next(falls, plane.base))
    if lowest > top - SAME_LEVEL:
        return
    for outline in outlines_of(section):
        if outline.depth < -SAME_LEVEL:
            yield _material_side(outline, plane), top
    if not any(element.side for element in section.elements):
        deep = [element for element in section.elements if element.depth < -SAME_LEVEL]
        ends = [abs(place) for element in deep for place in (element.start, element.end)]
        reach = max(ends, default=0.0) - cutter
        yield disc((0.0, 0.0), reach) if reach > 0.0 else Polygon(), top


def _cylinder_solids(section: SectionContour, moves: Sequence[Move], cutter: float) -> Solids:
    """Yield what a section on a cylinder is cut in, with its top."""
    first = moves[section.at]
    top = min(surface_key(section, moves).face, first.start[X])
    cut = [moves[i] for i in range(section.at, section.end) if moves[i].kind != "rapid"]
    levels = [move.end[Z] for move in cut if move.end[X] < top - SAME_LEVEL]
    if levels:
        zero = first.start[Z] - section.start.imag
        low, high = min(levels) - cutter - WALL, max(levels) + cutter + WALL
        high = min(high, zero) if min(levels) < zero else high
        yield box(-FAR, low, FAR, high), top


def _material_side(outline: Outline, plane: Plane) -> BaseGeometry:
    """Return what a compensated contour leaves of the part beside it, nothing without a side."""

    def on_part(xs: np.ndarray, ys: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        there = plane.on_part(np.asarray(xs) + 1j * np.asarray(ys))
        return there.real, there.imag

    area = outline.part(WALL)
    return area if area.is_empty else transform(on_part, area)


def beyond(outline: Outline, plane: Plane, bar: BaseGeometry) -> BaseGeometry:
    """Return what of a bar lies on the tool's side of a contour that it is to be cut away to.

    Nothing where the tool works inside of a closed contour, or without compensation.
    """
    if not outline.side:
        return Polygon()
    points = plane.on_part(outline.points)
    if outline.is_closed:
        shape = Polygon(vectors(points)).buffer(0)
        return Polygon() if outline.tool_is_inside else bar.difference(shape)
    points = points[np.append(True, np.abs(np.diff(points)) > LENGTHLESS)]
    along = np.diff(points) / np.abs(np.diff(points))
    middles = (points[:-1] + points[1:]) / 2 + 1j * outline.side * along * PROBE
    probe = middles[np.abs(middles).argmin()]
    reach = BEYOND * float(np.abs(np.array(bar.bounds)).max())
    ends = points[0] - along[0] * reach, points[-1] + along[-1] * reach
    edge = vectors(np.array([ends[0], *points, ends[1]]))
    regions = split(bar, LineString(edge)).geoms
    near = [region for region in regions if region.contains(Point(probe.real, probe.imag))]
    return unary_union(near) if len(regions) > 1 else Polygon()
