# SPDX-License-Identifier: GPL-2.0-or-later
"""The material of a part: solid below a top, less what cutters have swept, each down to a level.

It is known at every move of a program, and queries may come in any order. The plane and the levels
are those of the points that come in: X, Y and Z of a mill, the face of a lathe, or the unrolled
surface of a cylinder, whose level is the radius; that has a ``period``.

The area of a sweep is computed at its first use. Lengths are mm.
"""

import math
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from shapely.affinity import translate
from shapely.geometry import MultiLineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union
from shapely.prepared import PreparedGeometry, prep

from g12.tools.path.part import disc, swept

SAME_LEVEL = 1e-3
SAME_CENTRE = 1e-3
CHORD = 1e-3  # of a full circle
ALLOWED = 0.05  # depth of a rapid into material that counts as none: blended corners of a run
LEAST_AREA = 0.05  # mm²: a smaller area touched by a rapid counts as none
RAPID_STEP = 0.5  # between the evaluated points of a rapid
BAND, MOST_BANDS = 0.25, 40  # levels into which a descending move is divided
NEXT = 1e-6  # mm: a cut that is repeated is this near to itself
NOTHING = Polygon()


class Portion(NamedTuple):
    """A portion of a toolpath (n, 3), with its lowest and highest level; ``line``: in the plane."""

    points: np.ndarray
    low: float
    high: float

    @property
    def line(self) -> np.ndarray:
        return self.points[:, :2]


class Touch(NamedTuple):
    """Material that a move goes through: its area, and the tool's points (n, 3) there."""

    area: float
    points: np.ndarray


@dataclass(frozen=True, eq=False)
class Sweep:
    """What a cutter of a radius removes along a line (n, 2) down to a level, in a move."""

    line: np.ndarray
    radius: float
    level: float
    move: int

    @cached_property
    def shape(self) -> BaseGeometry:
        return swept([self.line], self.radius)

    @property
    def bounds(self) -> Sequence[float]:
        ends = self.line.min(axis=0) - self.radius, self.line.max(axis=0) + self.radius
        return np.concatenate(ends)

    def farthest(self, point: Sequence[float]) -> np.ndarray:
        """Return where on its line the cutter is farthest from a point."""
        return self.line[np.hypot(*(self.line - point).T).argmax()]


@dataclass(frozen=True, eq=False)
class Ring:
    """What a cutter of a radius removes along a full circle, whose radius is ``around``."""

    centre: tuple[float, float]
    around: float
    radius: float
    level: float
    move: int

    @cached_property
    def shape(self) -> BaseGeometry:
        inner, outer = (disc(self.centre, edge, CHORD) for edge in self.edges)
        return outer.difference(inner)

    @property
    def edges(self) -> tuple[float, float]:
        return max(self.around - self.radius, 0.0), self.around + self.radius

    @property
    def bounds(self) -> Sequence[float]:
        (x, y), reach = self.centre, self.edges[1]
        return x - reach, y - reach, x + reach, y + reach

    def farthest(self, point: Sequence[float]) -> np.ndarray:
        """Return where on its circle the cutter is farthest from a point."""
        away = np.subtract(self.centre, point)
        length = math.hypot(*away)
        along = away / length if length > 0 else np.array([1.0, 0.0])
        return np.array(self.centre) + self.around * along


Removed = Sweep | Ring


class Material:
    def __init__(self, shape: BaseGeometry, top: float, period: float = 0.0) -> None:
        self.shape, self.top, self._period = shape, top, period
        self._sweeps: list[Removed] = []
        self._effective: list[Removed] = []
        self._deepest: dict[bytes, float] = {}  # level of a line and a radius

    def cut(self, move: int, points: np.ndarray, radius: float) -> None:
        """Remove the area swept by a cutter of a radius along points (n, 3), after those before."""
        if points[:, 2].min() >= self.top:
            return
        if _goes_along_z(points):
            points = points[points[:, 2].argmin()][None]
        for portion in _portions(points):
            if portion.low < self.top:
                for line in self._unrolled(portion.line, radius):
                    self._add(Sweep(line, radius, portion.low, move), line)

    def cut_ring(self, ring: Ring) -> None:
        """Remove what a full circle sweeps, after what was removed before."""
        if ring.level < self.top:
            self._add(ring, np.array([*ring.centre, ring.around]))

    def _add(self, sweep: Removed, line: np.ndarray) -> None:
        """Add a sweep; one that an equal line made as deep before has no effect."""
        self._sweeps.append(sweep)
        key = np.append(line, sweep.radius).round(5).tobytes()
        if sweep.level < self._deepest.get(key, math.inf):
            self._deepest[key] = sweep.level
            self._effective.append(sweep)
            self.__dict__.pop("_table", None)

    @cached_property
    def _table(self) -> np.ndarray:
        """The bounds, the level and the move of each effective sweep: rows (6, n)."""
        rows = [(*sweep.bounds, sweep.level, sweep.move) for sweep in self._effective]
        return np.ascontiguousarray(np.array(rows, float).reshape(-1, 6).T)

    def sweeps_of(self, moves: range) -> list[Removed]:
        """Return what a range of moves removes, if that stands."""
        return _of_moves(self._sweeps, moves)

    def removes(self, moves: range) -> bool:
        """Return whether a range of moves removes anything that stands before them."""
        sweeps = _of_moves(self._effective, moves)
        return any(self._removes(each, moves.start) for each in sweeps)

    def _removes(self, sweep: Removed, before: int) -> bool:
        near, _ = self._near(sweep.bounds, sweep.level + SAME_LEVEL, before)
        if not near and self._whole.contains(box(*sweep.bounds)):
            return True
        return self._standing(sweep.shape, sweep.level, before).area > LEAST_AREA

    @cached_property
    def _whole(self) -> PreparedGeometry:
        return prep(self.shape)

    def has_cleared(
        self, centre: Sequence[float], edges: tuple[float, float], level: float
    ) -> bool:
        """Return whether full circles about a centre removed all between two radii."""
        (x, y), (reached, outer) = centre, edges
        near, _ = self._near((x - outer, y - outer, x + outer, y + outer), level, math.inf)
        rings = (ring for ring in near if isinstance(ring, Ring))
        own = (ring.edges for ring in rings if math.dist(ring.centre, centre) < SAME_CENTRE)
        for low, high in sorted(own):
            reached = max(reached, high) if low <= reached else reached
        return reached >= outer

    def is_under(self, line: np.ndarray, radius: float) -> bool:
        """Return whether a cutter along a line (n, 2) is over or in what was material at first."""
        lines = MultiLineString([each.tolist() for each in self._unrolled(line, radius)])
        away = self.shape.distance(lines) if not self.shape.is_empty else math.inf
        return away < radius - ALLOWED

    def standing(
        self, region: BaseGeometry, level: float, before: float = math.inf
    ) -> BaseGeometry:
        """Return the material in a region just below a level, before a move."""
        if not self._period:
            return self._standing(region, level, before)
        found = [
            translate(self._standing(portion, level, before), away)
            for portion, away in self._turned(region)
        ]
        return unary_union([NOTHING, *found])

    def _standing(self, region: BaseGeometry, level: float, before: float) -> BaseGeometry:
        if self.top < level + SAME_LEVEL or region.is_empty:
            return NOTHING
        near, wider = self._near(region.bounds, level + SAME_LEVEL, before)
        covers = (s.shape.equals_exact(region, NEXT) or s.shape.covers(region) for s in wider)
        if any(covers):  # saves their union
            return NOTHING
        region = region.intersection(self.shape)
        return region.difference(unary_union([each.shape for each in near])) if near else region

    def _near(
        self, bounds: Sequence[float], level: float, before: float
    ) -> tuple[list[Removed], list[Removed]]:
        """Return the sweeps before a move that may meet bounds, and those that may cover them."""
        low_x, low_y, high_x, high_y = bounds
        x0, y0, x1, y1, levels, move = self._table
        found = np.flatnonzero((x0 <= high_x) & (x1 >= low_x) & (levels <= level) & (move < before))
        found = found[(y0[found] <= high_y) & (y1[found] >= low_y)]
        wider = found[(x0[found] <= low_x + NEXT) & (x1[found] >= high_x - NEXT)]
        wider = wider[(y0[wider] <= low_y + NEXT) & (y1[wider] >= high_y - NEXT)]
        return [self._effective[n] for n in found], [self._effective[n] for n in wider]

    def _unrolled(self, line: np.ndarray, radius: float) -> list[np.ndarray]:
        """Return a path (n, 2) for each turn of a surface that it cuts, moved to the first turn."""
        if not self._period:
            return [line]
        turns = self._turns(line[:, 0].min() - radius, line[:, 0].max() + radius)
        return [line - (turn * self._period, 0.0) for turn in turns]

    def _turned(self, region: BaseGeometry) -> list[tuple[BaseGeometry, float]]:
        """Return a region for each turn of a surface that it covers, moved to the first turn.

        With each comes how far away from there it is.
        """
        if not self._period or region.is_empty:
            return [(region, 0.0)]
        low, high = region.bounds[1] - 1.0, region.bounds[3] + 1.0
        first_turn = box(0.0, low, self._period, high)
        ways = [turn * self._period for turn in self._turns(region.bounds[0], region.bounds[2])]
        return [(translate(region, -away).intersection(first_turn), away) for away in ways]

    def _turns(self, least: float, most: float) -> range:
        """Return the turns of a surface between two positions around it."""
        return range(math.floor(least / self._period), math.floor(most / self._period) + 1)

    def surrounds(self, region: BaseGeometry, level: float) -> bool:
        """Return whether a portion of a region was material above a level, or in a hole of it."""
        if self.shape.is_empty or level + SAME_LEVEL > self.top:
            return False
        return any(self._without_holes.intersects(each) for each, _ in self._turned(region))

    def beyond(self, region: BaseGeometry) -> float:
        """Return the area of a region that was never material, nor a hole of it."""
        portions = (portion for portion, _ in self._turned(region))
        return sum(portion.difference(self._without_holes).area for portion in portions)

    @cached_property
    def _without_holes(self) -> BaseGeometry:
        polygons = getattr(self.shape, "geoms", [self.shape])
        return unary_union([Polygon(each.exterior) for each in polygons])

    def touched(self, points: np.ndarray, radius: float, before: float) -> Touch | None:
        """Return the material that a cutter goes through along points (n, 3), None if none."""
        found, where = [], []
        for portion in _below(self.top, points) if radius > ALLOWED else ():
            region = swept([portion.line], radius - ALLOWED)
            area = self.standing(region, portion.high, before)
            if area.area > LEAST_AREA:
                found.append(area)
                where += _points_in(area, portion, radius)
        return Touch(unary_union(found).area, np.array(where)) if where else None


def _of_moves(sweeps: list[Removed], moves: range) -> list[Removed]:
    first, last = (
        bisect_left(sweeps, move, key=lambda sweep: sweep.move)
        for move in (moves.start, moves.stop)
    )
    return sweeps[first:last]


def _below(top: float, points: np.ndarray) -> Iterator[Portion]:
    """Yield the portions of a toolpath (n, 3) that lie below a top."""
    if points[:, 2].min() <= top - SAME_LEVEL:
        yield from (p for p in _portions(_going(points)) if p.high <= top - SAME_LEVEL)


def _goes_along_z(points: np.ndarray) -> bool:
    return bool(np.ptp(points[:, :2], axis=0).max() < ALLOWED)


def _going(points: np.ndarray) -> np.ndarray:
    """Return the points (n, 3) that can meet new material: of a vertical path the lowest."""
    if not _goes_along_z(points):
        return points
    lowest = int(points[:, 2].argmin())
    return points[lowest : lowest + 1] if lowest or len(points) == 1 else points[:0]


def _portions(points: np.ndarray) -> Iterator[Portion]:
    """Yield a toolpath (n, 3) in portions, each within a narrow band of levels."""
    if len(points) < 2 or np.ptp(points[:, 2]) < SAME_LEVEL:
        if len(points):
            yield Portion(points, points[:, 2].min(), points[:, 2].max())
        return
    band = max(BAND, np.ptp(points[:, 2]) / MOST_BANDS)
    points = _with_levels(points, band)
    low = np.minimum(points[:-1, 2], points[1:, 2])
    ends = 1 + np.flatnonzero(np.diff(np.floor(low / band + 1e-6)))
    for first, last in zip([0, *ends], [*ends, len(points) - 1]):
        own = points[first : last + 1]
        yield Portion(own, own[:, 2].min(), own[:, 2].max())


def _with_levels(points: np.ndarray, band: float) -> np.ndarray:
    """Return a toolpath (n, 3) with points inserted to limit the fall from one to the next."""
    counts = np.maximum(1, np.ceil(np.abs(np.diff(points[:, 2])) / band - 1e-9)).astype(int)
    indices = np.repeat(np.arange(len(counts)), counts)
    share = np.concatenate([np.arange(count) / count for count in counts])
    indices = np.append(indices + share, len(counts))
    return np.stack([np.interp(indices, np.arange(len(points)), axis) for axis in points.T], axis=1)


def _points_in(area: BaseGeometry, portion: Portion, radius: float) -> list[np.ndarray]:
    """Return the tool's points (3,) along a portion at which it touches an area."""
    steps = np.append(0.0, np.cumsum(np.hypot(*np.diff(portion.line, axis=0).T)))
    indices = np.linspace(0.0, steps[-1], 2 + int(steps[-1] / RAPID_STEP))
    points = np.stack([np.interp(indices, steps, axis) for axis in portion.points.T], axis=1)
    return [point for point in points if area.distance(Point(point[:2])) < radius - ALLOWED]
