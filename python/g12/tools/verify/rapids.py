# SPDX-License-Identifier: GPL-2.0-or-later
"""Rapids that go through material: a forgotten retract, or a retract blended into the next rapid.

The stock is not known, but a pocket has a wall, and perhaps a core. So: where a rapid passes
through a pocket, all of it that lies lower than the pocket's top must stay in what the program
has cleared down to that height before.

A rapid straight down is one of them too, but where the program came down to its first cycle by a
rapid: there it takes the part for bored.

A pocket's top is the height from which the tool was fed down to it (the lowest such height of all
pockets that still is above its first floor), or the program's Z0 if that is between this floor and
the height at which the tool came. Circles cut from outside and those of other planes than XY have
no such wall.

Lengths are millimetres, areas square millimetres, in machine coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby

import numpy as np
from shapely.geometry import Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union
from shapely.prepared import PreparedGeometry, prep

from g12.tools.path.follow import Followed
from g12.tools.path.part import disc, is_sideways, swept
from g12.tools.path.track import Track
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.circles import Target

SAME_HEIGHT = 1e-3
CHORD = 5e-3
STEP = 0.5  # between points of a rapid that are looked at
ALLOWED = 0.05  # that a rapid may go into a wall: the rounding of a run's corners
LEAST_AREA = 0.05
MOST_POINTS = 300  # of a rapid that are looked at

Circles = Sequence[tuple[Block, Target]]
Box = tuple[float, float, float, float]  # least X and Y, greatest X and Y


@dataclass(frozen=True)
class Collision:
    """A rapid, by its move's index and line, that goes through ``area`` of material.

    ``path`` (n, 3) is its tool's path where it does.
    """

    move: int
    line: int
    area: float
    path: np.ndarray


class Cleared:
    """What a program has cleared, at any of its moves and any height."""

    def __init__(self, asked: Circles, moves: Sequence[Move], path: Track, diameters: dict) -> None:
        self._moves, self._path, self._diameters = moves, path, diameters
        self._cutters = {
            index: target.cutter.radius
            for block, target in asked
            for index in range(block.at, block.end)
        }
        self._bores = [(block.at, target.wall) for block, target in asked if target.wall.bore]
        self._swept_by: dict[int, BaseGeometry] = {}
        self._floors: dict[int, np.ndarray] = {}
        self._before: dict[tuple, BaseGeometry] = {}

    def radius(self, index: int) -> float:
        """Return the radius of a move's cutter; in a pocket D's if the tool has none."""
        loaded = self._diameters.get(self._moves[index].tool, 0.0) / 2
        return loaded or self._cutters.get(index, 0.0)

    def before(self, index: int, height: float, box: Box | None = None) -> BaseGeometry:
        """Return the area cleared down to a height before a move; within a box it is all there."""
        if index not in self._floors:
            self._floors[index] = self._floors_before(index)
        floors = self._floors[index]
        key = (index, int(np.searchsorted(floors, height + SAME_HEIGHT, side="right")), box)
        if key not in self._before:
            self._before[key] = self._area(index, floors[key[1] - 1] if key[1] else -np.inf, box)
        return self._before[key]

    def _floors_before(self, index: int) -> np.ndarray:
        """Return the heights, upward, at which more has been cleared before a move."""
        bored = [wall.origin[2] for first, wall in self._bores if first <= index]
        return np.unique(np.concatenate([self._lowest[:index], bored]))

    def _area(self, index: int, height: float, box: Box | None) -> BaseGeometry:
        cut = self._lowest[:index] <= height
        if box:
            cut &= meeting(self._boxes[:index], box)
        bored = [
            disc(wall.origin, wall.bore)
            for first, wall in self._bores
            if first <= index and wall.origin[2] <= height
        ]
        return unary_union([*map(self._swept, np.flatnonzero(cut)), *bored]).buffer(ALLOWED)

    def of(self, indices: Sequence[int]) -> BaseGeometry:
        """Return the area that moves sweep."""
        return unary_union([self._swept(index) for index in indices])

    @cached_property
    def _lowest(self) -> np.ndarray:
        """The lowest height of each move at feed; a rapid clears nothing."""
        lowest = self._least(np.minimum)[:, 2]
        return np.where([move.kind != "rapid" for move in self._moves], lowest, np.inf)

    @cached_property
    def _boxes(self) -> np.ndarray:
        """Bounds (n, 4) of what the moves sweep."""
        reach = CHORD + ALLOWED + np.array(list(map(self.radius, range(len(self._moves)))))
        least, most = (self._least(function)[:, :2] for function in (np.minimum, np.maximum))
        return np.hstack([least - reach[:, None], most + reach[:, None]])

    def _least(self, function: np.ufunc) -> np.ndarray:
        """Return the least (n, 3) of the points of each move, or the greatest."""
        owner, points = self._path.move, self._path.points
        ends = np.append(0, np.flatnonzero(np.diff(owner)) + 1)
        starts = self._path.part.points(np.array([move.start for move in self._moves]))
        return function(function.reduceat(points, ends), starts)

    def _swept(self, index: int) -> BaseGeometry:
        if index not in self._swept_by:
            line = self._path.part.polyline(self._moves[index], CHORD)
            self._swept_by[index] = swept([line], max(self.radius(index), CHORD))
        return self._swept_by[index]


@dataclass(frozen=True)
class Opening:
    """A pocket from its first move on: its top, its first floor, and the moves that cut it.

    ``box`` are bounds of its area.
    """

    first: int
    top: float
    floor: float
    cut: Sequence[int]
    box: Box
    cleared: Cleared

    @cached_property
    def area(self) -> PreparedGeometry:
        """The area that is cut."""
        return prep(self.cleared.of(self.cut))


def collisions(
    asked: Circles,
    moves: Sequence[Move],
    path: Track,
    diameters: dict[int, float],
    real: Followed | None = None,
) -> list[Collision]:
    """Return the rapids that go through material; those of a run if there is one."""
    cleared = Cleared(asked, moves, path, diameters)
    openings = list(openings_of(asked, moves, cleared, path))
    bored = bored_places(asked, moves, openings)
    has_zero = any(abs(target.wall.face) > SAME_HEIGHT for _, target in asked)
    unknown = [] if has_zero else nowhere(moves)
    found: dict[int, Collision] = {}
    for chain in chains_of(moves, openings):
        points, owner = path_along(chain, moves, path, real)
        risky = risky_points(points, owner, moves, bored)
        risky &= ~np.isin(owner, unknown)
        for opening in met_by(points[risky], openings):
            for stretch in stretches_in(opening, points, owner):
                stretch = stretch[~np.isin(owner[stretch], unknown)]
                for hit in hits(points[stretch], owner[stretch], moves, cleared, bored):
                    known = found.get(hit.move)
                    found[hit.move] = hit if known is None or known.area < hit.area else known
    return [found[move] for move in sorted(found)]


def nowhere(moves: Sequence[Move]) -> list[int]:
    """Return the moves at a height that only a work offset would tell: by G53, G28, G30."""
    found, unknown = [], False
    for index, move in enumerate(moves):
        if move.start[2] != move.end[2]:
            unknown = move.by_machine
        if unknown:
            found.append(index)
    return found


def openings_of(
    asked: Circles, moves: Sequence[Move], cleared: Cleared, path: Track
) -> Iterator[Opening]:
    """Yield the pockets that rapids can leave through a wall; one that is fed up to cuts air."""
    walled = [each for each in asked if each[1].wall.inside and each[1].wall.plane == 2]
    came = np.array([height_before(block, moves, target) for block, target in walled])
    fed = np.array([height_of_feed(block, moves) for block, _ in walled])
    for (block, target), begun in zip(walled, fed):
        wall, (highest, lowest) = target.wall, floors_of(target)
        least = highest + SAME_HEIGHT
        if np.any(came > least) and begun > highest - SAME_HEIGHT:
            top = min(came[came > least])
            face = highest < wall.face < top
            top = wall.face if face else min(fed[fed > least], default=top)
            cut = cutting(block, moves)
            yield Opening(block.at, top, lowest, cut, bounds_of_cut(cut, path, cleared), cleared)


def bounds_of_cut(cut: Sequence[int], path: Track, cleared: Cleared) -> Box:
    """Return bounds of the area that moves which follow each other cut."""
    points = path.points[path.vertices(cut[0]).start : path.vertices(cut[-1]).stop, :2]
    reach = max(map(cleared.radius, cut)) + CHORD
    return (*(points.min(axis=0) - reach), *(points.max(axis=0) + reach))


def met_by(points: np.ndarray, openings: Sequence[Opening]) -> Iterator[Opening]:
    """Yield the openings below whose top some points come, within their bounds."""
    low = points[points[:, 2] < max((opening.top for opening in openings), default=-np.inf)]
    for opening in openings if len(low) else ():
        if (in_box(low, opening.box) & (low[:, 2] < opening.top)).any():
            yield opening


def cutting(block: Block, moves: Sequence[Move]) -> list[int]:
    """Return the moves of a block that cut sideways."""
    own = range(block.at, block.end)
    return [i for i in own if moves[i].kind != "rapid" and is_sideways(moves[i])]


def floors_of(target: Target) -> tuple[float, float]:
    """Return the highest and the lowest floor of a pocket."""
    return target.wall.height(target.depths[0]), target.wall.height(target.depths[-1])


def height_before(block: Block, moves: Sequence[Move], target: Target) -> float:
    """Return the height from which the tool came down to a pocket, its own plunge included."""
    highest, _ = floors_of(target)
    index = block.at
    if moves[index].start[2] <= highest + SAME_HEIGHT:
        while index and not is_sideways(moves[index - 1]):
            index -= 1
    return moves[index].start[2]


def height_of_feed(block: Block, moves: Sequence[Move]) -> float:
    """Return the height at which the first feed of a block begins, behind its own rapids."""
    own = (moves[index] for index in range(block.at, block.end))
    return next((move.start[2] for move in own if move.kind != "rapid"), -np.inf)


def chains_of(moves: Sequence[Move], openings: Sequence[Opening]) -> Iterator[list[int]]:
    """Yield the rapids that follow each other without a cut, once there is a pocket."""
    first = min((opening.first for opening in openings), default=len(moves))
    for rapid, group in groupby(range(first, len(moves)), lambda i: moves[i].kind == "rapid"):
        if rapid:
            yield list(group)


def path_along(
    chain: Sequence[int], moves: Sequence[Move], path: Track, real: Followed | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return points (n, 3) along moves, as programmed or as they were, and the move of each."""
    paths = [real.points[real.during(i)] if real else dense(path, moves[i]) for i in chain]
    owner = np.concatenate([np.full(len(points), index) for index, points in zip(chain, paths)])
    return np.concatenate(paths), owner


def dense(path: Track, move: Move) -> np.ndarray:
    """Return points (n, 3) along a rapid."""
    count = max(2, int(np.ceil(move.length / STEP)) + 1)
    return path.part.points(np.linspace(move.start, move.end, count))


def stretches_in(opening: Opening, points: np.ndarray, owner: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the stretches of a path (indices) below an opening's top that pass through it."""
    low = (points[:, 2] < opening.top - SAME_HEIGHT) & (owner >= opening.first)
    for below, group in groupby(np.arange(len(points)), lambda index: low[index]):
        stretch = np.array(list(group))
        inside = points[stretch[points[stretch, 2] > opening.floor - SAME_HEIGHT], :2]
        if below and any(map(opening.area.contains, map(Point, inside))):
            yield stretch


def risky_points(
    points: np.ndarray, owner: np.ndarray, moves: Sequence[Move], bored: Sequence[complex]
) -> np.ndarray:
    """Tell which points (n, 3) are those of rapids that go sideways or plunge."""
    risky = np.zeros(len(points), bool)
    for index in np.unique(owner):
        own = owner == index
        risky[own] = is_across(points[own]) or plunges(moves[index], bored)
    return risky


def is_across(points: np.ndarray) -> bool:
    """Tell whether a path goes sideways."""
    return bool(np.ptp(points[:, :2], axis=0).max() > ALLOWED)


def meeting(boxes: np.ndarray, box: Box) -> np.ndarray:
    """Tell which boxes (n, 4) have a place in common with a box."""
    return (boxes[:, :2] <= box[2:]).all(axis=1) & (boxes[:, 2:] >= box[:2]).all(axis=1)


def in_box(points: np.ndarray, bounds: Box) -> np.ndarray:
    """Tell which points (n, 3) lie within bounds."""
    x, y = points[:, 0], points[:, 1]
    return (bounds[0] <= x) & (x <= bounds[2]) & (bounds[1] <= y) & (y <= bounds[3])


def hits(
    points: np.ndarray,
    owner: np.ndarray,
    moves: Sequence[Move],
    cleared: Cleared,
    bored: Sequence[complex],
) -> Iterator[Collision]:
    """Yield the collisions along points, one for each move."""
    for index in np.unique(owner):
        own, radius = points[owner == index], cleared.radius(index)
        if not is_across(own):
            if not plunges(moves[index], bored):
                continue
            own = own[np.argmin(own[:, 2])][None]
        hit = bites_of(own, index, radius, cleared)
        area = unary_union([piece for _, piece in hit]).area if hit else 0.0
        if area > LEAST_AREA:
            yield Collision(index, moves[index].block, area, np.array([at for at, _ in hit]))


def plunges(move: Move, bored: Sequence[complex]) -> bool:
    """Tell whether a rapid goes down where the program does not take the part for bored."""
    place = complex(*move.end[:2])
    return move.end[2] < move.start[2] and all(abs(place - hole) > ALLOWED for hole in bored)


def bored_places(
    asked: Circles, moves: Sequence[Move], openings: Sequence[Opening]
) -> list[complex]:
    """Return where a program comes down to a first cycle by a rapid below the top of its pocket.

    There is a hole, or the rapid would have met the part: it goes deeper later on as well.
    """
    tops = {opening.first: opening.top for opening in openings}
    seen: list[complex] = []
    bored: list[complex] = []
    for block, target in asked:
        before = block.at - 1
        place = complex(*moves[block.at].start[:2])
        if target.wall.bore:
            bored.append(place)
        if before >= 0 and all(abs(place - other) > ALLOWED for other in seen):
            down = moves[before]
            below = down.end[2] < min(down.start[2], tops.get(block.at, -np.inf)) - SAME_HEIGHT
            if below and down.kind == "rapid":
                bored.append(place)
        seen.append(place)
    return bored


def bites_of(points: np.ndarray, index: int, radius: float, cleared: Cleared) -> list:
    """Return the points of a rapid at which the cutter is in material, each with the area there."""
    found = []
    box = (*(points[:, :2].min(axis=0) - radius), *(points[:, :2].max(axis=0) + radius))
    for point in points[:: len(points) // MOST_POINTS + 1]:
        cutter = Point(point[:2]).buffer(radius)
        piece = cutter.difference(cleared.before(index, point[2], box))
        if piece.area > LEAST_AREA:
            found.append((point, piece))
    return found
