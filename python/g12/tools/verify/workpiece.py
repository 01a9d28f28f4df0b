# SPDX-License-Identifier: GPL-2.0-or-later
"""The material that a program is cut from: a stock that is given, or what its pockets assume.

Without a stock each circle is in solid material: a wall stands round a pocket, a boss inside a
perimeter. It is solid below the program's Z0, or, where the program first goes below that by rapid
and feeds down from there, below that height; with a Z0 that lies lower, below the lowest height
from which a circle is fed down to. Holes are assumed where the words have one (R of Yasnac) and,
where the program comes down to its first circle by rapid, wherever it comes down to one by rapid.

Lengths are mm in machine coordinates.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import groupby
from typing import NamedTuple

import numpy as np
from shapely.geometry.base import BaseGeometry

from g12.tools.material.material import SAME_LEVEL, Material
from g12.tools.material.stock import Stock
from g12.tools.path.part import Part, Z, disc, is_sideways
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.circles import Target

WALL = 2.0  # how thick the wall of a pocket is, at least
SAME_PLACE = 0.05
FLAT = 17  # the plane whose arcs keep their level

Circles = Sequence[tuple[Block, Target]]


class Hole(NamedTuple):
    """A hole that is assumed: the line that does, its place at the level it is entered to."""

    line: int
    place: tuple[float, float, float]


class Approach(NamedTuple):
    """How the tool comes down to a circle: where from, where it begins to feed, to which floor.

    ``move`` is its last rapid straight down, None without one. A level is None where nothing is
    fed down.
    """

    came: float
    fed: float | None
    floor: float
    move: int | None


class Cutters:
    """The radius of the cutter of each move: the loaded tool's, in a cycle D's if it has none."""

    def __init__(self, circles: Circles, moves: Sequence[Move], diameters: Mapping) -> None:
        self._moves, self._diameters = moves, diameters
        self._named = {
            index: target.cutter.radius
            for block, target in circles
            for index in range(block.at, block.end)
        }

    def radius(self, index: int) -> float:
        """Return the radius of a move's cutter, 0 if nothing tells it."""
        loaded = self._diameters.get(self._moves[index].tool, 0.0) / 2
        return loaded or self._named.get(index, 0.0)

    @cached_property
    def widest(self) -> float:
        """The largest radius of the program."""
        return max((self.radius(index) for index in range(len(self._moves))), default=0.0)


@dataclass(frozen=True)
class Workpiece:
    """The material of a program, and what was assumed of it.

    ``shape`` and ``top`` are those of the given ``stock``.
    """

    material: Material
    cutters: Cutters
    holes: Sequence[Hole] = ()
    stock: Stock | None = None
    shape: BaseGeometry | None = None
    top: float = 0.0

    @property
    def bottom(self) -> float | None:
        """The level of a block's bottom, None if it is not known."""
        return self.top - self.stock.size[Z] if self.stock and self.stock.size else None


def assumed_workpiece(
    circles: Circles, moves: Sequence[Move], part: Part, diameters: Mapping[int, float]
) -> Workpiece:
    """Return the material that a program's circles assume."""
    cutters = Cutters(circles, moves, diameters)
    walls = [(block, target) for block, target in circles if target.wall.plane == Z]
    approaches = [approach_to(block, moves) for block, _ in walls]
    material = walled_in(walls, approaches)
    bores = [
        (target.source.line, target.wall.origin, target.wall.bore)
        for _, target in walls
        if target.wall.bore
    ]
    entered = rapid_bores(walls, approaches, moves, material, cutters)
    for _, place, radius in bores:
        material.open(disc(place, radius), place[Z])
    for _, place, radius in entered:
        material.open(disc(place, radius))
    add_cuts(material, moves, part, cutters)
    holes = tuple(Hole(line, tuple(map(float, place))) for line, place, _ in (*bores, *entered))
    return Workpiece(material, cutters, holes)


def given_workpiece(
    stock: Stock,
    zero: np.ndarray,
    circles: Circles,
    moves: Sequence[Move],
    part: Part,
    diameters: Mapping[int, float],
) -> Workpiece:
    """Return the material of a stock; of a bore alone the pockets are known to be in something."""
    cutters = Cutters(circles, moves, diameters)
    flat = [(block, target) for block, target in circles if target.wall.plane == Z]
    pockets = [(wall.origin, wall.radius) for wall in (t.wall for _, t in flat) if wall.inside]
    shape = stock.shape(zero, pockets)
    if stock.diameter or stock.size:
        material = Material()
        material.add(shape, float(zero[Z]))
    else:
        material = walled_in(flat, [approach_to(block, moves) for block, _ in flat])
        for _, target in flat:
            material.open(disc(target.wall.origin, stock.bore / 2))
    add_cuts(material, moves, part, cutters)
    return Workpiece(material, cutters, (), stock, shape, float(zero[Z]))


def walled_in(circles: Circles, approaches: Sequence[Approach]) -> Material:
    """Return a material in which circles are cut, before anything is."""
    material = Material()
    for (_, target), top in zip(circles, tops_of(circles, approaches)):
        if top is not None:
            wall = target.wall
            material.add(disc(wall.origin, wall.radius + (WALL if wall.inside else 0.0)), top)
    return material


def tops_of(circles: Circles, approaches: Sequence[Approach]) -> Iterator[float | None]:
    """Yield the top of the material in which each circle is cut, None of one that cuts air."""
    faces: dict[float, float] = {}
    for (_, target), approach in zip(circles, approaches):
        face = target.wall.face
        known = approach.came > approach.floor + SAME_LEVEL
        if known and face not in faces and approach.floor < face - SAME_LEVEL:
            below = approach.fed is not None and approach.floor < approach.fed - SAME_LEVEL
            faces[face] = min(face, approach.fed) if below else face
    for (_, target), approach in zip(circles, approaches):
        top = faces.get(target.wall.face, -math.inf)
        yield top if approach.floor < top - SAME_LEVEL else lowest_start(approach.floor, approaches)


def lowest_start(floor: float, approaches: Sequence[Approach]) -> float | None:
    """Return the lowest height above a floor from which a circle is fed down to."""
    starts = [each.came if each.fed is None else each.fed for each in approaches]
    return min((start for start in starts if start > floor + SAME_LEVEL), default=None)


def approach_to(block: Block, moves: Sequence[Move]) -> Approach:
    """Return how the tool comes down to a circle, in its block or before it."""
    first = next(iter(cutting(block, moves)), block.end)
    begin = first
    while begin and not is_sideways(moves[begin - 1]):
        begin -= 1
    down = [i for i in range(begin, block.end) if moves[i].end[Z] < moves[i].start[Z] - SAME_LEVEL]
    fed = next((moves[i].start[Z] for i in down if moves[i].kind != "rapid"), None)
    rapid = next((i for i in reversed(down) if i < first and moves[i].kind == "rapid"), None)
    came = max(moves[i].start[Z] for i in range(begin, min(first, len(moves) - 1) + 1))
    return Approach(came, fed, floor_of(block, moves), rapid)


def cutting(block: Block, moves: Sequence[Move]) -> list[int]:
    """Return the moves of a block that cut sideways."""
    own = range(block.at, block.end)
    return [i for i in own if moves[i].kind != "rapid" and is_sideways(moves[i])]


def floor_of(block: Block, moves: Sequence[Move]) -> float:
    """Return the lowest level that a block cuts sideways; infinite for one that is fed up to."""
    floor = min((moves[index].end[Z] for index in cutting(block, moves)), default=math.inf)
    return floor if floor < moves[block.at].start[Z] + SAME_LEVEL else math.inf


def rapid_bores(
    circles: Circles,
    approaches: Sequence[Approach],
    moves: Sequence[Move],
    material: Material,
    cutters: Cutters,
) -> list[tuple[int, np.ndarray, float]]:
    """Return the holes that a program comes down into by rapid, if it does so at its first circle.

    Each by its line, its place and its radius.
    """
    found: list[tuple[int, np.ndarray, float]] = []
    seen: list[complex] = []
    for (_, target), approach in zip(circles, approaches):
        place, index = complex(*target.wall.origin[:2]), approach.move
        if any(abs(place - other) < SAME_PLACE for other in seen):
            continue
        seen.append(place)
        if index is not None:
            end, radius = np.array(moves[index].end[:3]), cutters.radius(index)
            into = not found and end[Z] < min(target.wall.face, approach.came) - SAME_LEVEL
            if into or material.touched(end[None], radius, 0):
                found.append((moves[index].block, end, radius))
        if not found:
            break
    return found


def add_cuts(material: Material, moves: Sequence[Move], part: Part, cutters: Cutters) -> None:
    """Cut what a program's moves at feed sweep; a cutter nobody knows is as wide as the widest."""
    for rapid, group in groupby(range(len(moves)), key=partial(kind_of_cut, moves, part)):
        if rapid[0]:
            continue
        own = list(group)
        radius = cutters.radius(own[0]) or cutters.widest
        points = partial(points_along, part, [moves[index] for index in own])
        if len(rapid) > 2:
            bounds = bounds_of_level([moves[index] for index in own])
            level = moves[own[0]].end[Z]
            material.cut_level(
                own[-1], bounds, level, lambda points=points: points()[:, :2], radius
            )
        else:
            material.cut(own[-1], points(), radius)


def kind_of_cut(moves: Sequence[Move], part: Part, index: int) -> tuple:
    """Return what the moves of one cut have in common; a move that falls is one of its own."""
    move = moves[index]
    if part.turning or move.start[Z] != move.end[Z] or move.plane != FLAT:
        return move.kind == "rapid", index
    return move.kind == "rapid", move.tool, move.block


def points_along(part: Part, moves: Sequence[Move]) -> np.ndarray:
    """Return the tool's points (n, 3) along moves that follow each other."""
    return np.concatenate([part.polyline(move) for move in moves])


def bounds_of_level(moves: Sequence[Move]) -> tuple[float, ...]:
    """Return the bounds of moves in the plane XY; an arc counts as its circle."""
    ends = [place[:2] for move in moves for place in (move.start, move.end)]
    for move in moves:
        if move.kind == "arc":
            (x, y, _), reach = (
                move.centre,
                max(move.radius, math.dist(move.end[:2], move.centre[:2])),
            )
            ends += [(x - reach, y - reach), (x + reach, y + reach)]
    low, high = np.min(ends, axis=0), np.max(ends, axis=0)
    return (*map(float, low), *map(float, high))
