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

Lengths are mm in machine coordinates; of sections points are those of the face or of the unrolled
surface.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import split, transform, unary_union

from g12.tools.material.material import ALWAYS, SAME_LEVEL, Material, Opening, Solid
from g12.tools.path.part import X, Z, disc, is_sideways
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.plane import Plane, plane_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import NO_LENGTH
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.reading.circles import Target
from g12.tools.verify.sections.outline import Outline, outlines_of, vectors
from g12.tools.verify.subject import Subject

WALL = 2.0  # how thick the wall of a pocket is, at least
BEYOND = 10.0  # bars: how far an open contour's ends are drawn on
PROBE = 1e-3  # mm beside a contour
DECIMALS = 3  # of a hole's position
FAR = 1e6  # round a cylinder
NAMED = "its word R or J names it"

Areas = Iterator[tuple[BaseGeometry, float]]  # each with the level of its top
Approached = Sequence[tuple[Target, "Approach"]]


class Approach(NamedTuple):
    """How the tool comes down to a circle: where from, where it begins to feed, to which floor.

    ``move`` is its last rapid straight down, None without one. A level is None where nothing is
    fed down.
    """

    came: float
    fed: float | None
    floor: float
    move: int | None


class AssumedHole(NamedTuple):
    """A hole that is assumed: the line that does and why, the point that is entered."""

    line: int
    place: tuple[float, float, float]
    radius: float
    why: str


class SurfaceKey(NamedTuple):
    """A part's surface: a cylinder's radius and where it is along X, or 0 and a face's Z."""

    radius: float
    face: float


def flat_circles(subject: Subject) -> list[tuple[Block, Target]]:
    """Return the circles in the plane XY, each with its block."""
    return [each for each in subject.commanded.circles if each[1].wall.plane == Z]


def approached(subject: Subject) -> Approached:
    """Return the circles in the plane XY, each with how the tool comes down to it."""
    moves, drilled = subject.moves, _drilled(subject.moves)
    return [
        (target, _approach(range(block.at, block.end), moves, drilled))
        for block, target in flat_circles(subject)
    ]


def _drilled(moves: Sequence[Move]) -> dict[tuple[float, ...], int]:
    """Return the first move that feeds straight down at each position in the plane XY."""
    found: dict[tuple[float, ...], int] = {}
    for index, move in enumerate(moves):
        if move.kind != "rapid" and move.end[Z] < move.start[Z] and not is_sideways(move):
            found.setdefault(_position(move), index)
    return found


def _position(move: Move) -> tuple[float, ...]:
    return tuple(round(each, DECIMALS) for each in move.start[:Z])


def _approach(
    own: range, moves: Sequence[Move], drilled: Mapping[tuple[float, ...], int]
) -> Approach:
    """Return how the tool comes down to a cut, in its ``own`` moves or before them.

    It is fed down from where a hole there was ``drilled`` before.
    """
    sideways = [i for i in own if moves[i].kind != "rapid" and is_sideways(moves[i])]
    first = next(iter(sideways), own.stop)
    floor = min((moves[index].end[Z] for index in sideways), default=math.inf)
    floor = floor if floor < moves[own.start].start[Z] + SAME_LEVEL else math.inf  # it is fed up to
    begin = first
    while begin and not is_sideways(moves[begin - 1]):
        begin -= 1
    down = [i for i in range(begin, own.stop) if moves[i].end[Z] < moves[i].start[Z] - SAME_LEVEL]
    hole = drilled.get(_position(moves[begin]), own.stop)
    feeds = [i for i in (hole, *down) if i < own.stop and moves[i].kind != "rapid"]
    fed = moves[min(feeds)].start[Z] if feeds else None
    rapid = next((i for i in reversed(down) if i < first and moves[i].kind == "rapid"), None)
    came = max(moves[i].start[Z] for i in range(begin, min(first, len(moves) - 1) + 1))
    return Approach(came, fed, floor, rapid)


def solids_of_circles(circles: Approached) -> Iterator[Solid]:
    """Yield what circles are cut in."""
    tops: dict[float, float] = {}  # by the program's Z0
    for target, (came, fed, floor, _) in circles:
        face = target.wall.face
        if face not in tops and floor < min(came, face) - SAME_LEVEL:
            tops[face] = min(face, fed) if fed is not None and floor < fed - SAME_LEVEL else face
    starts = sorted(each.came if each.fed is None else each.fed for _, each in circles)
    for target, approach in circles:
        wall, floor = target.wall, approach.floor + SAME_LEVEL
        top = tops.get(wall.face, -math.inf)
        top = top if floor < top else next((start for start in starts if start > floor), None)
        if top is not None:
            yield Solid(disc(wall.origin, wall.radius + (WALL if wall.inside else 0.0)), top)


def solids_of_holes(subject: Subject) -> Iterator[Solid]:
    """Yield what holes are drilled in: the face round each of them, once."""
    drilled: set[tuple[float, ...]] = set()
    for call in (each for each in subject.commanded.holes if not each.is_side):
        face = call.zero[1]
        for index in call.moves:
            move, (x, y, _) = subject.moves[index], subject.end(index)
            place = round(x, DECIMALS), round(y, DECIMALS), face, move.tool
            goes_down = move.kind != "rapid" and move.end[Z] < min(face, move.start[Z])
            if goes_down and place not in drilled:
                drilled.add(place)
                yield Solid(disc((x, y), subject.cutter(index) + WALL), face)


def assume_holes(subject: Subject, material: Material) -> list[AssumedHole]:
    """Return the holes of words (R of Yasnac), and those that cuts are entered into by rapid.

    Each opens the ``material``. Those by rapid are assumed if the first cut is entered so.
    """
    found = []
    for block, target in flat_circles(subject):
        x, y, z = map(float, target.wall.origin)
        radius = target.wall.bore
        if radius and not material.is_cleared(disc((x, y), radius), z, block.at):
            material.open(Opening(disc((x, y), radius), z))
            found.append(AssumedHole(target.line, (x, y, z), radius, NAMED))
    return found + list(_holes_entered(subject, material))


def _holes_entered(subject: Subject, material: Material) -> Iterator[AssumedHole]:
    for number, (index, top) in enumerate(_entries(subject)):
        if _is_entered(subject, material, index, -math.inf if number else top):
            x, y, z = end = subject.end(index)
            radius = subject.cutter(index)
            material.open(Opening(disc((x, y), radius), z))
            yield AssumedHole(subject.line(index), end, radius, "a rapid goes into it")
        elif not number:
            return


def _is_entered(subject: Subject, material: Material, index: int | None, top: float) -> bool:
    """Tell whether a rapid goes into material, or below a top; the end of G28 is not known."""
    if index is None or not subject.ends_known[index]:
        return False
    x, y, z = end = subject.end(index)
    radius = subject.cutter(index)
    if z < top - SAME_LEVEL and not material.is_cleared(disc((x, y), radius), z, index):
        return True
    return material.touched(np.array([end]), radius, index) is not None


def _entries(subject: Subject) -> Iterator[tuple[int | None, float]]:
    """Yield for each cut along Z its last rapid straight down, and what it is entered below.

    A section may begin below its face, where turning has cut before.
    """
    for target, (came, _, _, index) in approached(subject):
        yield index, min(target.wall.face, came)
    for section in subject.commanded.on_face:
        yield _approach(range(section.at, section.at), subject.moves, {}).move, -math.inf


class CutOnSurface(NamedTuple):
    """A section, or a call of holes in the side: its ``own`` moves, and what it is cut in."""

    own: range
    key: SurfaceKey
    areas: Sequence[tuple[BaseGeometry, float]]  # each with the level of its top


def solids_of_sections(subject: Subject) -> tuple[list[Solid], dict[SurfaceKey, list[Solid]]]:
    """Return what sections on the face are cut in, and what each surface of a cylinder is of.

    A surface has the sections on it and the holes in it.
    """
    commanded = subject.commanded
    sections = [_section_on_surface(subject, each) for each in commanded.sections]
    face = [cut for cut in sections if not cut.key.radius]
    around = [cut for cut in sections if cut.key.radius]
    around += [_holes_in_surface(subject, call) for call in commanded.holes if call.is_side]
    around.sort(key=lambda cut: cut.own.start)
    cylinders: dict[SurfaceKey, list[Solid]] = {}
    for cut, solids in _solids(around, subject.moves, X):
        cylinders.setdefault(cut.key, []).extend(solids)
    return [each for _, solids in _solids(face, subject.moves, Z) for each in solids], cylinders


def _solids(
    cuts: Sequence[CutOnSurface], moves: Sequence[Move], axis: int
) -> Iterator[tuple[CutOnSurface, list[Solid]]]:
    """Yield cuts with a tool along an axis, each with its material and for which moves it counts.

    On the face it does from the retract after the cut before: a cylinder may be a step of a shaft
    that no other cut shows. It is another part, or another end of it, where a cut has another key:
    up to the retract before that.
    """
    retracts = [
        _retract(moves, range(one.own.stop - 1, other.own.start), axis, other.key.face)
        for one, other in zip(cuts, cuts[1:])
    ]
    changes = zip(retracts, cuts, cuts[1:])
    ends = [retract for retract, one, other in changes if one.key != other.key]
    for cut, before in zip(cuts, [ALWAYS, *retracts]):
        since = cut.own.start if axis == X and before != ALWAYS else before
        until = next((end for end in ends if end >= cut.own.start), math.inf)
        yield cut, [Solid(area, top, since, until) for area, top in cut.areas]


def _retract(moves: Sequence[Move], between: range, axis: int, face: float) -> int:
    """Return the first move that ends above a face, of none the last."""
    up = (index for index in between if moves[index].end[axis] > face - SAME_LEVEL)
    return next(up, between.stop)


def _section_on_surface(subject: Subject, section: SectionContour) -> CutOnSurface:
    face = plane_of(section, subject.moves[section.at]).face
    key = SurfaceKey(round(section.surface, 6), round(face, 6))
    areas = _areas_on_cylinder if key.radius else _areas_on_face
    return CutOnSurface(range(section.at, section.end), key, list(areas(section, subject, face)))


def _holes_in_surface(subject: Subject, call: SubCall) -> CutOnSurface:
    """Return the ring that holes in the side are drilled in, not in front of Z0 unless they are."""
    x, zero, _ = call.zero
    z, aside = zero + call.length("z"), call.cutter + WALL
    key = SurfaceKey(round(call.surface, 6), round(x + call.surface, 6))
    ring = box(-FAR, z - aside, FAR, min(z + aside, max(z, zero)))
    return CutOnSurface(call.moves, key, [(ring, key.face)])


def _areas_on_face(section: SectionContour, subject: Subject, face: float) -> Areas:
    """Yield what a section on a face is cut in, each area with its top."""
    moves, cutter = subject.moves, subject.cutter(section.at)
    plane = plane_of(section, moves[section.at])
    cut = [moves[i] for i in range(section.at, section.end) if moves[i].kind != "rapid"]
    lowest = min((move.end[Z] for move in cut), default=math.inf)
    falls = (move.start[Z] for move in cut if move.end[Z] < move.start[Z] - SAME_LEVEL)
    top = min(face, next(falls, face))
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


def _areas_on_cylinder(section: SectionContour, subject: Subject, face: float) -> Areas:
    """Yield what a section on a cylinder is cut in, with its top."""
    moves, cutter = subject.moves, subject.cutter(section.at)
    first = moves[section.at]
    top = min(face, first.start[X])
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
    turned = area if area.is_empty else transform(on_part, area)
    return turned.buffer(0)  # by rounding, its edge may cross itself where two points coincide


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
    points = points[np.append(True, np.abs(np.diff(points)) > NO_LENGTH)]
    along = np.diff(points) / np.abs(np.diff(points))
    middles = (points[:-1] + points[1:]) / 2 + 1j * outline.side * along * PROBE
    probe = middles[np.abs(middles).argmin()]
    reach = BEYOND * float(np.abs(np.array(bar.bounds)).max())
    ends = points[0] - along[0] * reach, points[-1] + along[-1] * reach
    edge = vectors(np.array([ends[0], *points, ends[1]]))
    regions = split(bar, LineString(edge)).geoms
    near = [region for region in regions if region.contains(Point(probe.real, probe.imag))]
    return unary_union(near) if len(regions) > 1 else Polygon()
