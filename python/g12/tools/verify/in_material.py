# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: rapids through it, plunges, and what remains of a bar.

Lengths are mm, areas mm². Places are those of the part: on a lathe's face they turn with C, on a
cylinder they are those of its unrolled surface. Only cutters with a diameter count, on a lathe
those that cut sections.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, SAME_LEVEL
from g12.tools.path.part import Part, X, Z, is_sideways
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.section_plane import Plane, plane_of
from g12.tools.verify.expected.calls import SubCall
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.pocket_walls import Circles
from g12.tools.verify.reading.block_words import BlockInMm
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.section_walls import beyond
from g12.tools.verify.sections.section_size import stretches_of
from g12.tools.verify.workpiece import PartView, Program, Workpiece, face_sections

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock


class MaterialFacts(NamedTuple):
    """What is said of a program in its material: findings and notes."""

    judged: Sequence[Finding] = ()
    piece: Workpiece | None = None

    @property
    def given(self) -> Workpiece | None:
        """The material of a stock that was given, None if it is assumed."""
        return self.piece if self.piece and self.piece.stock else None

    @property
    def rapids(self) -> list[Finding]:
        """The rapids that go through material."""
        return [each for each in self.judged if "path" in each.values]


def material_facts(program: Program, piece: Workpiece) -> MaterialFacts:
    """Return what a program does to what it is cut from."""
    found = [
        *once_a_line(rapids_through(program, piece)),
        *first_way(program, piece),
        *inside_surfaces(program, piece),
    ]
    if piece.stock:
        found += InStock(program, piece).judged()
    return MaterialFacts((*found, *assumptions(piece)), piece)


def once_a_line(found: Iterator[Finding]) -> list[Finding]:
    """Return the first finding of each line."""
    return list({each.line: each for each in reversed(list(found))}.values())[::-1]


def rapids_through(program: Program, piece: Workpiece) -> Iterator[Finding]:
    """Yield the rapids that go through material."""
    moves = program.moves
    unknown, first = unknown_places(program), first_known(program)
    rapids = [i for i, move in enumerate(moves) if move.kind == "rapid" and i >= first]
    for view in piece.views:
        for index in rapids:
            if not view.judges(moves[index]) or index in unknown:
                continue
            points = program.points(index, view.part)
            if index == first or index - 1 in unknown:
                points = points[-1:]
            yield from touched(program, piece, view, index, points)


def touched(
    program: Program, piece: Workpiece, view: PartView, index: int, points: np.ndarray
) -> Iterator[Finding]:
    """Yield that a rapid goes through material along points (n, 3)."""
    touch = len(points) and view.material.touched(points, piece.cutters.radius(index), index)
    if touch:
        at, to = (tuple(map(float, point)) for point in touch.points[[0, -1]])
        values = {
            "at": words_of(program, view, at),
            "to": words_of(program, view, to),
            "area": touch.area,
            "path": touch.points,
            "surface": view.surface,
        }
        code = "rapid-through" if at[:2] != to[:2] else "rapid-into"
        yield Finding(code, program.line(index), values, at)


def words_of(
    program: Program, view: PartView, point: Sequence[float]
) -> tuple[tuple[str, float], ...]:
    """Return a place of the part as words: X Y Z of a mill, X C Z of a lathe."""
    if not view.part.turning:
        return tuple(zip("XYZ", point))
    double = 2 if any(section.diameters for section in program.sections) else 1
    if view.surface:
        around, along, level = point
        x, c, z = level - view.part.centre, math.degrees(around / view.surface), along
    else:
        x, z, c = math.hypot(*point[:2]), point[2], math.degrees(math.atan2(point[1], point[0]))
    return ("X", double * x), ("C", c), ("Z", z)


def first_way(program: Program, piece: Workpiece) -> Iterator[Finding]:
    """Yield that the way of a first rapid that ends in a part is not judged."""
    first, view = first_known(program), piece.views[0]
    if program.moves and program.moves[first].kind == "rapid":
        place = place_after(program, first)
        if place[2] < view.material.top - SAME_LEVEL:
            values = {"at": words_of(program, view, place)}
            yield Finding("first-rapid", program.line(first), values, place)


def place_after(program: Program, index: int) -> tuple[float, float, float]:
    """Return where a move ends on the part."""
    return tuple(map(float, program.part.points(np.array(program.moves[index].end))[0]))


def axes_known(part: Part) -> tuple[int, ...]:
    """Return the axes that must have been commanded before it is known where the tool is."""
    return (X, Z) if part.turning else (Z,)


def unknown_places(program: Program) -> set[int]:
    """Return the moves at a place that only a work offset would tell: by G53, G28, G30."""
    if any(abs(target.wall.face) > SAME_LEVEL for _, target in program.circles):
        return set()
    found, unknown = set(), dict.fromkeys(axes_known(program.part), False)
    for index, move in enumerate(program.moves):
        for axis in unknown:
            if move.start[axis] != move.end[axis]:
                unknown[axis] = move.by_machine
        if any(unknown.values()):
            found.add(index)
    return found


def first_known(program: Program) -> int:
    """Return the move from which on it is known where the tool is; a trace begins anywhere."""
    axes, moves = axes_known(program.part), program.moves
    changes = (first_change(moves, axis) for axis in axes)
    return max(changes, default=0)


def first_change(moves: Sequence[Move], axis: int) -> int:
    """Return the first move that changes an axis, 0 if none does."""
    return next((i for i, move in enumerate(moves) if move.start[axis] != move.end[axis]), 0)


def inside_surfaces(program: Program, piece: Workpiece) -> Iterator[Finding]:
    """Yield the sections on a cylinder that begin inside of its surface, where nothing is cut."""
    for section in program.sections:
        first = program.moves[section.at]
        inside = (
            section.surface and plane_of(section, first).base + section.surface - first.start[X]
        )
        if inside > SAME_LEVEL and not is_cut_before(section, program, piece):
            values = {"code": section.code, "radius": section.surface, "inside": inside}
            yield Finding("inside-surface", section.line, values, first.start[:3])


def is_cut_before(section: SectionContour, program: Program, piece: Workpiece) -> bool:
    """Tell whether something is cut where a section begins."""
    view = next(view for view in piece.views if view.surface == round(section.surface, 6))
    point = view.part.points(np.array(program.moves[section.at].start))[0]
    region = Point(point[:2]).buffer(piece.cutters.radius(section.at) or ALLOWED)
    return view.material.is_cut(region, point[2], section.at)


def assumptions(piece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    if piece.holes:
        line, place, _ = piece.holes[0]
        others = sorted({hole.line for hole in piece.holes} - {line})
        more = f" (also in line {', '.join(map(str, others))})" if others else ""
        values = {"at": tuple(zip("XYZ", place)), "more": more}
        yield Finding("bored-assumed", line, values, place)


class InStock:
    """A program in the stock that a user gives."""

    def __init__(self, program: Program, piece: Workpiece) -> None:
        self._program, self._piece, self._view = program, piece, piece.views[0]
        moves, first = program.moves, first_known(program)
        self._own = [
            index
            for index in range(first, len(moves))
            if piece.cutters.radius(index) and self._view.judges(moves[index])
        ]

    def judged(self) -> list[Finding]:
        """Return plunges, what meets no stock, cuts below a block, and what remains of a bar."""
        plunges = filter(None, (self._plunge(index) for index in self._own))
        remaining = self._remaining() if self._piece.stock.diameter else ()
        found = [*once_a_line(plunges), *self._missing(), *self._below(), *remaining]
        return [*found, *self._in_the_bar()]

    def _in_the_bar(self) -> Iterator[Finding]:
        """Yield the holes in the side whose tool goes by rapid to where the bar is."""
        bar = self._piece.stock.diameter or 0.0
        for call in (each for each in self._program.holes if each.is_side):
            level = call.length("surface_diameter") + 2 * call.length("retract")
            if level < bar - SAME_LEVEL:
                values = {"level": level, "bar": bar}
                yield Finding("in-the-bar", call.line, values, file=call.file)

    def _plunge(self, index: int) -> Finding | None:
        move = self._program.moves[index]
        if move.kind == "rapid" or is_sideways(move) or move.end[Z] >= move.start[Z]:
            return None
        place = place_after(self._program, index)
        cutter = Point(place[:2]).buffer(self._piece.cutters.radius(index))
        share = self._view.material.standing(cutter, place[Z], index).area / cutter.area
        if share <= LEAST_SHARE:
            return None
        of = " of the face" if self._piece.stock.diameter else ""
        values = {"share": 100 * share, "at": tuple(zip("XY", place)), "of": of}
        return Finding("plunge-into-stock", self._program.line(index), values, place)

    def _missing(self) -> Iterator[Finding]:
        """Yield the cycles and sections that meet nothing of the stock."""
        cuts = [(each.line, each) for each in face_sections(self._program)]
        cuts += [(target.source.line, block) for block, target in self._program.circles]
        for line, each in cuts:
            if not any(map(self._meets, range(each.at, each.end))):
                yield Finding("no-stock-met", line)

    def _meets(self, index: int) -> bool:
        radius, move = self._piece.cutters.radius(index), self._program.moves[index]
        if not radius or move.end[Z] >= self._piece.top:
            return False
        points = self._program.part.polyline(move)[:, :2]
        line = LineString(points) if len(points) > 1 else Point(points[0])
        return line.distance(self._piece.shape) < radius - SAME_LEVEL

    def _below(self) -> Iterator[Finding]:
        moves, bottom = self._program.moves, self._piece.bottom
        at_feed = [index for index in self._own if moves[index].kind != "rapid"]
        if bottom is None or not at_feed:
            return
        lowest = min(at_feed, key=lambda index: moves[index].end[Z])
        below = bottom - moves[lowest].end[Z]
        if below > SAME_LEVEL:
            line, place = self._program.line(lowest), place_after(self._program, lowest)
            yield Finding("below-block", line, {"size": below}, place)

    def _remaining(self) -> Iterator[Finding]:
        """Yield what remains of a bar beyond a contour that it is to be cut away to."""
        top, moves = self._piece.top, self._program.moves
        for section in face_sections(self._program):
            level = min(moves[index].end[Z] for index in range(section.at, section.end))
            plane = Plane(section, moves[section.at])
            wanted = (beyond(each, plane, self._piece.shape) for each in stretches_of(section))
            wanted = unary_union([area for area in wanted if area])
            if level < top - SAME_LEVEL:
                wanted = without_slivers(self._view.material.standing(wanted, level))
            if wanted.area > LEAST_AREA:
                place = (*wanted.representative_point().coords[0], level)
                values = {"area": wanted.area, "level": level - top, "shape": wanted}
                yield Finding("bar-remains", section.line, values, place)


def without_slivers(area: BaseGeometry) -> BaseGeometry:
    """Return an area without what is so thin that it is but the rounding of a contour."""
    return area.buffer(-ALLOWED).buffer(ALLOWED)


def zero_of(
    circles: Circles,
    sections: Sequence[SectionContour],
    moves: Sequence[Move],
    holes: Sequence[SubCall] = (),
) -> np.ndarray:
    """Return the program's zero where it first cuts; on a lathe X is that of the spindle.

    A section on a cylinder tells nothing of it.
    """
    for section in (each for each in sections if not each.surface):
        return np.array([0.0, 0.0, moves[section.at].start[Z] - section.height])
    for block, _ in circles:
        return BlockInMm(block, moves[block.at]).zero()
    for call in holes:
        return np.array([0.0, 0.0, call.zero[1]])
    return np.zeros(3)
