# SPDX-License-Identifier: GPL-2.0-or-later
"""The material that a program's circles assume, and the holes that it comes down into by rapid.

A wall stands round a pocket, a boss inside a perimeter. They are solid below the program's Z0, or,
where the program first goes below that by rapid and feeds down from there, below that level; with a
Z0 that lies lower, below the lowest level from which a circle is fed down to. Where it is not known
how the tool comes down, nothing is.

Lengths are mm in machine coordinates.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from g12.tools.material.material import SAME_LEVEL, Material
from g12.tools.path.part import Z, disc, is_sideways
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.circles import Target

WALL = 2.0  # how thick the wall of a pocket is, at least
SAME_PLACE = 0.05

Circles = Sequence[tuple[Block, Target]]


class AssumedHole(NamedTuple):
    """A hole that is assumed: the line that does, where it is entered to, its radius."""

    line: int
    place: tuple[float, float, float]
    radius: float


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
    for (_, target), top in zip(circles, tops_of(circles, approaches)):
        if top is not None:
            wall = target.wall
            material.add(disc(wall.origin, wall.radius + (WALL if wall.inside else 0.0)), top)


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


def holes_of_words(circles: Circles) -> Iterator[AssumedHole]:
    """Yield the holes that words say there are: R of Yasnac."""
    for _, target in circles:
        if target.wall.bore:
            x, y, z = map(float, target.wall.origin)
            yield AssumedHole(target.source.line, (x, y, z), target.wall.bore)


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
    seen: list[complex] = []
    for (_, target), approach in zip(circles, approaches):
        place, index = complex(*target.wall.origin[:2]), approach.move
        if any(abs(place - other) < SAME_PLACE for other in seen):
            continue
        seen.append(place)
        if index is not None:
            end = np.array([moves[index].end[:3]])
            below = not found and end[0, Z] < min(target.wall.face, approach.came) - SAME_LEVEL
            if below or material.touched(end, radius(index), 0):
                x, y, z = map(float, end[0])
                found.append(AssumedHole(moves[index].block, (x, y, z), radius(index)))
        if not found:
            break
    return found
