# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program is cut from: a stock that is given, or what its pockets and sections assume.

Each view of the part has a material of its own: the plane XY of a mill or the face of a lathe, and
every cylinder whose unrolled surface is cut. Lengths are mm in machine coordinates.
"""

import math
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import groupby
from operator import itemgetter
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, box
from shapely.geometry.base import BaseGeometry

from g12.tools.material.material import SAME_LEVEL, Material, Touch
from g12.tools.material.stock import Stock, StockText, read_stock
from g12.tools.path.follow import Followed
from g12.tools.path.part import Part, X, Z, disc, is_sideways, part_of
from g12.tools.path.surface import Surface
from g12.tools.preview.moves import Move
from g12.tools.units import unit_of
from g12.tools.verify.commanded import Commanded
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.words import BlockInMm, SubCall
from g12.tools.verify.subject import Subject
from g12.tools.verify.walls import (
    FAR,
    WALL,
    AssumedHole,
    Circles,
    add_circles,
    add_sections,
    approach_to,
    holes_entered,
    holes_of_words,
    surface_key,
)

FLAT = 17  # the plane whose arcs keep their level
CHUNK = 32  # moves of a lathe whose area is worked out at once
SAMPLED = 1e-4  # how far a run's motion may be off, drawn with fewer points


@dataclass(frozen=True)
class Program:
    """What cuts: a program's moves on its part, its circles, sections, cutters and holes.

    ``real`` is its motion if it ran.
    """

    moves: Sequence[Move]
    part: Part
    circles: Circles
    sections: Sequence[SectionContour]
    diameters: Mapping[int, float]
    real: Followed | None = None
    holes: Sequence[SubCall] = ()

    def points(self, index: int, part: Part) -> np.ndarray:
        """Return the tool's points (n, 3) along a move, as programmed or as they were."""
        sampled = self.real.positions[self.real.during(index)] if self.real else ()
        return part.points(sampled) if len(sampled) else part.polyline(self.moves[index])

    def line(self, index: int) -> int:
        """Return the program's line of a move, of one in another file the line that calls it.

        A cycle's own lines are in its subroutine, those of a section may be in a sub's own file.
        """
        move = self.moves[index]
        own = (each for each in self.sections if each.at <= index < each.end and not each.file)
        return move.line if any(move.remap == each.code for each in own) else move.block

    def radius(self, index: int) -> float:
        """Return the radius of a move's cutter: the loaded one's, else D's; 0 if none is known."""
        loaded = self.diameters.get(self.moves[index].tool, 0.0) / 2
        return loaded or self._named.get(index, 0.0)

    def end(self, index: int) -> tuple[float, float, float]:
        """Return where a move ends on the part."""
        x, y, z = map(float, self.part.points(np.array(self.moves[index].end))[0])
        return x, y, z

    @cached_property
    def _named(self) -> dict[int, float]:
        return {
            index: target.cutter.radius
            for block, target in self.circles
            for index in range(block.at, block.end)
        }

    @cached_property
    def points_sideways(self) -> list[bool | None]:
        """Whether the tool of each move points at the axis, as in its cuts before and after.

        Next to a cut it points as in that one. None where cuts differ, and for a tool that cuts
        neither a section nor a hole.
        """
        cuts = [(each.at, each.end, each.surface > 0.0) for each in self.sections]
        cuts += [(each.moves.start, each.moves.stop, each.is_side) for each in self.holes]
        of_tool: dict[int, list[tuple[int, int, bool]]] = {}
        for cut in sorted(cuts):
            of_tool.setdefault(self.moves[cut[0]].tool, []).append(cut)
        found: list[bool | None] = []
        for index, move in enumerate(self.moves):
            own = of_tool.get(move.tool, [])
            last = bisect_right(own, index, key=itemgetter(0)) - 1
            following = bisect_right(own, index, key=itemgetter(1))
            near = own[max(last, 0) : following + 1]
            beside = {side for at, end, side in near if index in (at - 1, end)}
            sides = beside or {side for *_, side in near}
            found.append(sides.pop() if len(sides) == 1 else None)
        return found

    @cached_property
    def widest(self) -> float:
        """The largest radius of a cutter."""
        return max((self.radius(index) for index in range(len(self.moves))), default=0.0)

    @property
    def on_face(self) -> list[SectionContour]:
        """The sections on the face."""
        return [section for section in self.sections if not section.surface]

    def zero(self) -> np.ndarray:
        """Return the program's zero where it first cuts; on a lathe X is that of the spindle.

        A section on a cylinder does not define it.
        """
        for section in self.on_face:
            return np.array([0.0, 0.0, self.moves[section.at].start[Z] - section.height])
        for block, _ in self.circles:
            return BlockInMm(block, self.moves[block.at]).zero()
        for call in self.holes:
            return np.array([0.0, 0.0, call.zero[1]])
        return np.zeros(3)

    def face(self) -> float:
        """Return the program's Z0 where it first cuts, on a cylinder where it cuts nothing else."""
        if self.sections and not (self.on_face or self.circles or self.holes):
            first = self.sections[0]
            return self.moves[first.at].start[Z] - first.start.imag
        return float(self.zero()[Z])


class PartView(NamedTuple):
    """The part as some tools cut it, all without ``tools``, and its material there.

    ``surface`` is the radius of a cylinder, 0 of a plane. The material is known for the moves up to
    ``until``; ``whole`` is it without what cuts of another view may have removed, if there are any.
    """

    part: Part
    material: Material
    tools: frozenset[int] | None = None
    surface: float = 0.0
    until: float = math.inf
    whole: Material | None = None

    def judges(self, program: Program, index: int) -> bool:
        """Tell whether a move is one of its tools', while they point at it from this side."""
        if self.tools is None:
            return True
        sideways = program.points_sideways[index]
        return program.moves[index].tool in self.tools and sideways is (self.surface > 0.0)


@dataclass(frozen=True)
class Workpiece:
    """The material that a program cuts, and the holes that were assumed in it.

    ``shape`` and ``top`` are those of the given ``stock``.
    """

    program: Program
    views: Sequence[PartView]
    holes: Sequence[AssumedHole] = ()
    stock: Stock | None = None
    shape: BaseGeometry | None = None
    top: float = 0.0

    @property
    def material(self) -> Material:
        """The material in the plane XY, or of a lathe's face."""
        return self.views[0].material

    @cached_property
    def known(self) -> dict[int, None]:
        """The moves, in order, that end where the program says: a trace begins anywhere.

        Where the program's zero is that of the machine, only a work offset would tell where G53,
        G28 and G30 lead.
        """
        moves, axes = self.program.moves, (X, Z) if self.program.part.turning else (Z,)
        offset = any(abs(target.wall.face) > SAME_LEVEL for _, target in self.program.circles)
        lost = {a: any(move.start[a] != move.end[a] for move in moves) for a in axes}
        found: dict[int, None] = {}
        for index, move in enumerate(moves):
            moved = [axis for axis in axes if move.start[axis] != move.end[axis]]
            lost |= dict.fromkeys(moved, move.by_machine and not offset)
            if not any(lost.values()):
                found[index] = None
        return found

    def touched(self, view: PartView, index: int) -> Touch | None:
        """Return the material that a rapid goes through; of the first known one, at its end."""
        points = self.program.points(index, view.part)
        if index - 1 not in self.known:
            points = points[-1:]
        return view.material.touched(points, self.program.radius(index), index)

    @property
    def bottom(self) -> float | None:
        """The level of a block's bottom, None if it is not known."""
        return self.top - self.stock.size[Z] if self.stock and self.stock.size else None


def workpiece_of(subject: Subject, commanded: Commanded, stock: StockText | None) -> Workpiece:
    """Return what a program is cut from, assumed where no stock is given.

    Raises UsageError for a text that is no stock of the machine's.
    """
    trace, circles, sections = subject.trace, commanded.circles, commanded.sections
    real, holes = subject.real, commanded.holes
    cuts = (circles, sections, trace.diameters, real, holes)
    program = Program(trace.moves, subject.part, *cuts)
    if stock is None:
        return assumed_workpiece(program)
    unit = unit_of(trace.modes.gcodes, stock.units)
    return _given_workpiece(program, read_stock(stock.text, part_of(subject.ini).turning, unit))


def assumed_workpiece(program: Program) -> Workpiece:
    """Return what a program's words assume that it is cut from."""
    material, moves = Material(), program.moves
    walls = [(block, target) for block, target in program.circles if target.wall.plane == Z]
    approaches = [approach_to(block, moves) for block, _ in walls]
    add_circles(material, walls, approaches)
    add_sections(material, program.on_face, moves, program.radius)
    _add_drilled(material, program)
    bores = list(holes_of_words(walls))
    entered = holes_entered(walls, approaches, moves, material, program.radius)
    for hole in bores:
        material.open(disc(hole.place, hole.radius), hole.place[Z])
    for hole in entered:
        material.open(disc(hole.place, hole.radius))
    views = _views_of(program, material, _face_tools(program))
    return Workpiece(program, views, [*bores, *entered])


def _add_drilled(material: Material, program: Program) -> None:
    """Make solid what holes are drilled in: the face round them."""
    for call in (each for each in program.holes if not each.is_side):
        face = call.zero[1]
        for index in call.moves:
            move = program.moves[index]
            if move.kind != "rapid" and move.end[Z] < min(face, move.start[Z]):
                place = program.part.points(np.array(move.end))[0]
                material.add(disc(place, program.radius(index) + WALL), face)


def _given_workpiece(program: Program, stock: Stock) -> Workpiece:
    """Return the stock; of a bore alone the pockets are known to be in something."""
    material, zero = Material(), program.zero()
    flat = [(block, target) for block, target in program.circles if target.wall.plane == Z]
    pockets = [(wall.origin, wall.radius) for wall in (t.wall for _, t in flat) if wall.inside]
    shape = stock.shape(zero, pockets)
    if stock.diameter or stock.size:
        material.add(shape, float(zero[Z]))
    else:
        add_circles(material, flat, [approach_to(block, program.moves) for block, _ in flat])
        for _, target in flat:
            material.open(disc(target.wall.origin, stock.bore / 2))
    views = _views_of(program, material, _face_tools(program) if stock.diameter else None)
    if stock.diameter:
        views.append(_bar_from_side(program, stock.diameter / 2, program.face()))
    return Workpiece(program, views, (), stock, shape, float(zero[Z]))


def _views_of(program: Program, material: Material, tools: frozenset[int] | None) -> list[PartView]:
    """Return the views of the part with what the program cuts of each."""
    views = [PartView(program.part, material, tools), *_cylinders(program)]
    for view in views:
        _add_cuts(view, program)
    return views


def _face_tools(program: Program) -> frozenset[int] | None:
    """Return the tools that cut sections and holes on a face, None for all of a mill's."""
    is_mill = not program.sections and not program.part.turning
    return None if is_mill else tools_of(program, side=False)


def tools_of(program: Program, side: bool) -> frozenset[int]:
    """Return the tools that cut sections and holes on the face, or round the side."""
    cuts = [(section.at, section.surface > 0.0) for section in program.sections]
    cuts += [(call.moves.start, call.is_side) for call in program.holes]
    return frozenset(program.moves[at].tool for at, its in cuts if its is side)


def _bar_from_side(program: Program, radius: float, face: float) -> PartView:
    """Return a bar as the tools see it that point at its axis.

    What tools along Z cut may be all of the bar down to there; of others nothing is known.
    """
    period, centre = 2 * math.pi * radius, program.part.centre
    material, whole = Material(period=period), Material(period=period)
    for each in (material, whole):
        each.add(box(-FAR, -FAR, FAR, face), centre + radius)
    others = [
        index
        for index, move in enumerate(program.moves)
        if move.kind != "rapid"
        and not program.points_sideways[index]
        and move.end[Z] < face - SAME_LEVEL
        if math.hypot(*program.end(index)[:2]) - program.radius(index) < radius - SAME_LEVEL
    ]
    until = next((index for index in others if not program.radius(index)), math.inf)
    lowest = face
    for index in others:
        level = min(program.moves[index].start[Z], program.moves[index].end[Z])
        if level < lowest - SAME_LEVEL:
            material.open(box(-FAR, level, FAR, FAR), since=index)
            lowest = level
    part = Surface(turning=True, centre=centre, radius=radius)
    view = PartView(part, material, tools_of(program, side=True), radius, until, whole)
    _add_cuts(view, program)
    _add_cuts(view._replace(material=whole), program)
    return view


def _cylinders(program: Program) -> Iterator[PartView]:
    """Yield a view of each cylinder that sections are cut on."""
    moves, sections = program.moves, [each for each in program.sections if each.surface]
    for surface in dict.fromkeys(surface_key(section, moves) for section in sections):
        material = Material(period=2 * math.pi * surface.radius)
        add_sections(material, sections, moves, program.radius, surface)
        own = (each for each in sections if surface_key(each, moves) == surface)
        tools = frozenset(moves[section.at].tool for section in own)
        part = Surface(turning=True, radius=surface.radius)
        yield PartView(part, material, tools, surface.radius)


def _add_cuts(view: PartView, program: Program) -> None:
    """Cut what moves at feed sweep; a cutter nobody knows is as wide as the widest."""
    moves = program.moves
    for (rapid, level, *_), group in groupby(range(len(moves)), partial(_kind_of_cut, view, moves)):
        own = list(group)
        if rapid or (view.surface and not view.judges(program, own[0])):
            continue
        radius = program.radius(own[0]) or program.widest
        points = partial(_points_along, program, view.part, own)
        if level is None:
            view.material.cut(own[-1], points(), radius)
        else:
            bounds = _bounds_of_level([moves[index] for index in own])
            draw = partial(across, points, program.real is not None)
            view.material.cut_level(own[-1], bounds, level, draw, radius)


def _kind_of_cut(view: PartView, moves: Sequence[Move], index: int) -> tuple:
    """Return what the moves of one cut have in common: rapid or not, their level, and more.

    The level is None where it may change.
    """
    move = moves[index]
    rapid = move.kind == "rapid"
    if view.part.turning:
        return rapid, None, move.tool, is_sideways(move), index // CHUNK, move.block
    if move.start[Z] != move.end[Z] or move.plane != FLAT:
        return rapid, None, index
    return rapid, move.end[Z], move.tool, move.block


def _points_along(program: Program, part: Part, own: Sequence[int]) -> np.ndarray:
    """Return the tool's points (n, 3) along moves that follow each other."""
    return np.concatenate([program.points(index, part) for index in own])


def across(points: partial, sampled: bool) -> np.ndarray:
    """Return drawn points without their level, of a run no more than are needed."""
    drawn = points()[:, :2]
    many = sampled and len(drawn) > 2
    return np.array(LineString(drawn).simplify(SAMPLED).coords) if many else drawn


def _bounds_of_level(moves: Sequence[Move]) -> tuple[float, ...]:
    """Return the bounds of moves in the plane XY; an arc counts as its circle."""
    ends = [place[:2] for move in moves for place in (move.start, move.end)]
    for move in moves:
        if move.kind == "arc":
            x, y, _ = move.centre
            reach = max(move.radius, math.dist(move.end[:2], (x, y)))
            ends += [(x - reach, y - reach), (x + reach, y + reach)]
    low, high = np.min(ends, axis=0), np.max(ends, axis=0)
    return (*map(float, low), *map(float, high))
