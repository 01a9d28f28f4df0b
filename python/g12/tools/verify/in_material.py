# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its material: rapids through it, plunges, and what remains of a bar.

Lengths are mm, areas mm², in machine coordinates; on a lathe those of the part's face. Only
cutters with a diameter count, on a lathe those that cut polar sections.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import split, unary_union

from g12.tools.material.material import ALLOWED, LEAST_AREA, SAME_LEVEL
from g12.tools.path.follow import Followed
from g12.tools.path.part import Part, Z, is_sideways
from g12.tools.preview.moves import Move
from g12.tools.verify.closed_contour import as_points, is_closed, trimmed
from g12.tools.verify.compare.section_plane import Plane
from g12.tools.verify.contour_side import SAME, area_within
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.reading.block_words import BlockInMm
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.section_size import stretches_of
from g12.tools.verify.workpiece import Circles, Workpiece

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock
BEYOND = 10.0  # bars: how far an open contour's ends are drawn on
PROBE = 1e-3  # mm beside a contour


@dataclass(frozen=True)
class Program:
    """A program's moves, its circles and its polar sections, and its motion if it ran."""

    moves: Sequence[Move]
    part: Part
    circles: Circles
    sections: Sequence[SectionContour]
    real: Followed | None = None

    def points(self, index: int) -> np.ndarray:
        """Return the tool's points (n, 3) along a move, as programmed or as they were."""
        if self.real:
            return self.real.points[self.real.during(index)]
        return self.part.polyline(self.moves[index])

    def line(self, index: int) -> int:
        """Return the program's line of a move; a cycle's own lines are in its subroutine."""
        move = self.moves[index]
        in_section = move.remap and any(move.remap == each.code for each in self.sections)
        return move.line if in_section else move.block

    def place(self, index: int) -> tuple[float, ...]:
        """Return where a move ends."""
        return tuple(map(float, self.part.points(np.array(self.moves[index].end))[0]))


def rapids_through(program: Program, piece: Workpiece, own: Sequence[int]) -> Iterator[Finding]:
    """Yield the rapids, among moves by their indices, that go through material."""
    moves = program.moves
    unknown, first = set(unknown_levels(program)), first_down(moves)
    for index in own:
        if moves[index].kind != "rapid" or index in unknown or index < first:
            continue
        points = program.points(index)
        begun = index > first and index - 1 not in unknown
        points = points if begun else points[-1:]
        touch = len(points) and piece.material.touched(points, piece.cutters.radius(index), index)
        if touch:
            at, to = (tuple(map(float, point)) for point in touch.points[[0, -1]])
            values = {"at": at, "to": to, "area": touch.area, "path": touch.points}
            code = "rapid-through" if at[:2] != to[:2] else "rapid-into"
            yield Finding(code, program.line(index), values, at)


def first_way(program: Program, piece: Workpiece) -> Iterator[Finding]:
    """Yield that the way of a first rapid that ends in a part is not judged."""
    first = first_down(program.moves)
    if program.moves and program.moves[first].kind == "rapid":
        place = program.place(first)
        if place[2] < piece.material.top - SAME_LEVEL:
            yield Finding("first-rapid", program.line(first), {"at": place}, place)


def judged_moves(program: Program, piece: Workpiece) -> Sequence[int]:
    """Return the moves whose cutter has a diameter, by their indices."""
    own = range(len(program.moves))
    return [index for index in own if piece.cutters.radius(index)]


def unknown_levels(program: Program) -> Iterator[int]:
    """Yield the moves at a level that only a work offset would tell: by G53, G28, G30."""
    if any(abs(target.wall.face) > SAME_LEVEL for _, target in program.circles):
        return
    unknown = False
    for index, move in enumerate(program.moves):
        if move.start[Z] != move.end[Z]:
            unknown = move.by_machine
        if unknown:
            yield index


def first_down(moves: Sequence[Move]) -> int:
    """Return the first move that changes Z: before it the tool is wherever a trace begins."""
    return next((i for i, move in enumerate(moves) if move.start[Z] != move.end[Z]), 0)


def assumptions(piece: Workpiece) -> Iterator[Finding]:
    """Yield one note of the holes that are assumed."""
    if piece.holes:
        line, place = piece.holes[0]
        lines = ", ".join(
            str(each) for each in sorted({hole.line for hole in piece.holes} - {line})
        )
        more = f" (also in line {lines})" if lines else ""
        yield Finding("bored-assumed", line, {"at": place, "more": more}, place)


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
    if piece.stock:
        judge = InStock(program, piece)
        judged = (*judge.findings(), *judge.notes(), *first_way(program, piece))
        return MaterialFacts(judged, piece)
    hits = rapids_through(program, piece, judged_moves(program, piece))
    return MaterialFacts((*hits, *assumptions(piece), *first_way(program, piece)), piece)


class InStock:
    """A program in the stock that a user gives."""

    def __init__(self, program: Program, piece: Workpiece) -> None:
        self._program, self._piece, self._stock = program, piece, piece.stock
        moves = program.moves
        flat = [each for each in program.sections if not each.surface]
        tools = {moves[each.at].tool for each in flat}
        self.own = [
            index
            for index in range(first_down(moves), len(moves))
            if piece.cutters.radius(index)
            and (not self._stock.diameter or moves[index].tool in tools)
        ]
        self._flat = flat

    def findings(self) -> Iterator[Finding]:
        """Yield rapids into the stock, and what remains of a bar."""
        yield from rapids_through(self._program, self._piece, self.own)
        if self._stock.diameter:
            yield from self._remaining()

    def notes(self) -> Iterator[Finding]:
        """Yield what else a user should know: plunges, what meets no stock, cuts below a block."""
        plunges = (self._plunge(index) for index in self.own)
        yield from {plunge.line: plunge for plunge in reversed([*filter(None, plunges)])}.values()
        yield from self._missing()
        for each in self._program.sections:
            if each.surface:
                yield Finding("cylinder-aside", each.line)
        yield from self._below()

    def _bite(self, index: int, place: Sequence[float]) -> float:
        """Return the area that is under a move's cutter there, not cut before."""
        cutter = Point(place[:2]).buffer(self._piece.cutters.radius(index))
        return self._piece.material.standing(cutter, place[Z], index).area / cutter.area

    def _plunge(self, index: int) -> Finding | None:
        move = self._program.moves[index]
        if move.kind == "rapid" or is_sideways(move) or move.end[Z] >= move.start[Z]:
            return None
        place = self._program.place(index)
        share = self._bite(index, place)
        if share <= LEAST_SHARE:
            return None
        values = {"share": 100 * share, "at": place[:2], "of": self._of_face}
        return Finding("plunge-into-stock", self._program.line(index), values, place)

    @property
    def _of_face(self) -> str:
        return " of the face" if self._stock.diameter else ""

    def _missing(self) -> Iterator[Finding]:
        """Yield the cycles and sections that meet nothing of the stock."""
        cuts = [(each.line, each) for each in self._flat]
        cuts += [(target.source.line, block) for block, target in self._program.circles]
        for line, each in cuts:
            if not any(map(self._meets, range(each.at, each.end))):
                yield Finding("no-stock-met", line)

    def _meets(self, index: int) -> bool:
        radius, top = self._piece.cutters.radius(index), self._piece.top
        if not radius or self._program.moves[index].end[Z] >= top:
            return False
        points = self._program.part.polyline(self._program.moves[index])[:, :2]
        line = LineString(points) if len(points) > 1 else Point(points[0])
        return line.distance(self._piece.shape) < radius - SAME_LEVEL

    def _below(self) -> Iterator[Finding]:
        moves = self._program.moves
        if self._piece.bottom is None or not self.own:
            return
        at_feed = [index for index in self.own if moves[index].kind != "rapid"]
        lowest = min(at_feed, key=lambda index: moves[index].end[Z])
        below = self._piece.bottom - moves[lowest].end[Z]
        if below > SAME_LEVEL:
            place = self._program.place(lowest)
            yield Finding("below-block", self._program.line(lowest), {"size": below}, place)

    def _remaining(self) -> Iterator[Finding]:
        material, top = self._piece.material, self._piece.top
        for section in self._flat:
            moves = self._program.moves
            level = min(moves[index].end[Z] for index in range(section.at, section.end))
            plane = Plane(section, moves[section.at])
            wanted = (beyond(each, plane, self._piece.shape) for each in stretches_of(section))
            wanted = unary_union([area for area in wanted if area])
            in_air = level > top - SAME_LEVEL
            left = wanted if in_air else without_slivers(material.standing(wanted, level))
            if left.area > LEAST_AREA:
                place = (*left.representative_point().coords[0], level)
                values = {"area": left.area, "level": level - top, "shape": left}
                yield Finding("bar-remains", section.line, values, place)


def without_slivers(area: BaseGeometry) -> BaseGeometry:
    """Return an area without what is so thin that it is but the rounding of a contour."""
    return area.buffer(-ALLOWED).buffer(ALLOWED)


def zero_of(
    circles: Circles, sections: Sequence[SectionContour], moves: Sequence[Move]
) -> np.ndarray:
    """Return the program's zero where it first cuts; on a lathe X is that of the spindle.

    A section on a cylinder tells nothing of it.
    """
    for section in (each for each in sections if not each.surface):
        return np.array([0.0, 0.0, moves[section.at].start[Z] - section.height])
    for block, _ in circles:
        return BlockInMm(block, moves[block.at]).zero()
    return np.zeros(3)


def beyond(stretch: Sequence[Element], plane: Plane, bar: BaseGeometry) -> BaseGeometry | None:
    """Return what of a bar lies on the tool's side of a contour that it is to be cut away to.

    None where the tool works inside of a closed contour, or without compensation.
    """
    contour = [element for element in trimmed(stretch) if element.length > SAME]
    side = stretch[0].side
    if not side or not contour:
        return None
    points = plane.on_part(np.concatenate([as_points(element) for element in contour]))
    if is_closed(contour):
        inside = (area_within(points) > 0.0) == (side > 0)
        return None if inside else bar.difference(Polygon(vectors(points)).buffer(0))
    points = points[np.append(True, np.abs(np.diff(points)) > SAME)]
    along = np.diff(points) / np.abs(np.diff(points))
    middles = (points[:-1] + points[1:]) / 2 + 1j * side * along * PROBE
    probe = middles[np.abs(middles).argmin()]
    reach = BEYOND * float(np.abs(np.array(bar.bounds)).max())
    ends = points[0] - along[0] * reach, points[-1] + along[-1] * reach
    edge = vectors(np.array([ends[0], *points, ends[1]]))
    pieces = split(bar, LineString(edge)).geoms
    near = [piece for piece in pieces if piece.contains(Point(probe.real, probe.imag))]
    return unary_union(near) if len(pieces) > 1 else None


def vectors(points: np.ndarray) -> list[tuple[float, float]]:
    """Return complex points as pairs."""
    return [(point.real, point.imag) for point in points]
