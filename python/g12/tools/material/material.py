# SPDX-License-Identifier: GPL-2.0-or-later
"""The material of a part: solid below a top, less the areas cut to a level or below it.

A part is made of solids, each an area of the plane and the top below which it is material. Each cut
removes material: it has an area, the level down to which that is free, and its move. So the
remaining material is known at every move of a program, and queries may come in any order. The plane
and the levels are those of the points that come in: X, Y and Z of a mill, the face of a lathe, or
the unrolled surface of a cylinder, whose level is the radius; that has a ``period``.

Areas are computed at their first use, once for equal toolpaths. Lengths are mm.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from shapely.affinity import translate
from shapely.geometry import Point, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.path.part import swept

SAME_LEVEL = 1e-3
ALLOWED = 0.05  # depth of a rapid into material that counts as none: blended corners of a run
LEAST_AREA = 0.05  # mm²: a smaller area touched by a rapid counts as none
RAPID_STEP = 0.5  # between the evaluated points of a rapid
BAND, MOST_BANDS = 0.25, 40  # levels into which a descending move is divided
NOTHING = Polygon()
ALWAYS = -1  # move number of what exists before the program

Bounds = Sequence[float]  # least and greatest of both coordinates of the plane
Levels = tuple[float, float]  # the lowest and the highest
Drawn = Callable[[], np.ndarray]  # points (n, 2) along a path


class Portion(NamedTuple):
    """A portion of a toolpath (n, 3), with its lowest and highest level; ``line``: in the plane."""

    points: np.ndarray
    low: float
    high: float

    @property
    def line(self) -> np.ndarray:
        return self.points[:, :2]


class Course(NamedTuple):
    """How a cutter of a radius went along a line: down to which level, in which move."""

    radius: float
    level: float
    move: float

    def clears(self, other: "Course") -> bool:
        """Return whether another, along the same line, has nothing left to remove."""
        return other.radius <= self.radius and self.level <= other.level and self.move < other.move


class Touch(NamedTuple):
    """Material that a move goes through: its area, and the tool's points (n, 3) there."""

    area: float
    points: np.ndarray


class Solid(NamedTuple):
    """An area that is material below a ``level``, for the moves after one and up to another."""

    shape: BaseGeometry
    level: float
    since: int = ALWAYS
    until: float = math.inf


class Opening(NamedTuple):
    """An area that is free down to a ``level``, for the moves after one.

    ``perhaps`` says that material may remain there.
    """

    shape: BaseGeometry
    level: float = -math.inf
    since: int = ALWAYS
    perhaps: bool = False


class _Sweep:
    """The area that a cutter sweeps along a path, computed at its first use."""

    def __init__(self, draw: Drawn, radius: float, known: dict) -> None:
        self._draw, self._radius, self._known = draw, radius, known

    @cached_property
    def shape(self) -> BaseGeometry:
        """The area; that of an equal path elsewhere is translated."""
        line = self._draw()
        start = line[0]
        shifted = line - start
        key = (round(self._radius, 6), _key(shifted))
        if key not in self._known:
            self._known[key] = swept([shifted], self._radius)
        return translate(self._known[key], *start)


Area = Solid | Opening | _Sweep


class _Near(NamedTuple):
    """Areas that may meet a region, and those of them that may cover it."""

    areas: Sequence[Area]
    wider: Sequence[Area]

    def within(self, region: BaseGeometry) -> BaseGeometry:
        """Return what of the region lies in them; one that covers it saves their union."""
        if self._one_covers(region):
            return region
        return region.intersection(self._union()) if self.areas else NOTHING

    def without(self, region: BaseGeometry) -> BaseGeometry:
        """Return what of the region lies in none; one that covers it saves their union."""
        if self._one_covers(region):
            return NOTHING
        return region.difference(self._union()) if self.areas else region

    def _one_covers(self, region: BaseGeometry) -> bool:
        return any(area.shape.covers(region) for area in self.wider)

    def _union(self) -> BaseGeometry:
        return unary_union([area.shape for area in self.areas])


class _Areas:
    def __init__(self) -> None:
        self._areas: list[Area] = []
        self._rows: list[tuple[float, ...]] = []

    def add(
        self, area: Area, bounds: Bounds, level: float, since: int, until: float = math.inf
    ) -> None:
        if bounds:  # an empty area has none
            self._areas.append(area)
            self._rows.append((*bounds, level, since, until))
            self.__dict__.pop("_table", None)

    @cached_property
    def _table(self) -> np.ndarray:
        return np.ascontiguousarray(np.array(self._rows).reshape(-1, 7).T)

    def near(self, region: BaseGeometry, levels: Levels, move: float | None) -> _Near:
        """Return the areas that may meet a region, between levels, at a move or at any."""
        if region.is_empty:
            return _Near([], [])
        low_x, low_y, high_x, high_y = region.bounds
        x0, y0, x1, y1, level, since, until = self._table
        found = np.flatnonzero((x0 <= high_x) & (x1 >= low_x))
        found = found[(y0[found] <= high_y) & (y1[found] >= low_y)]
        found = found[(levels[0] <= level[found]) & (level[found] <= levels[1])]
        if move is not None:
            found = found[(since[found] < move) & (move <= until[found])]
        wider = (x0[found] <= low_x) & (x1[found] >= high_x)
        wider &= (y0[found] <= low_y) & (y1[found] >= high_y)
        return _Near(*([self._areas[index] for index in own] for own in (found, found[wider])))


class Material:
    def __init__(
        self, solids: Iterable[Solid], openings: Iterable[Opening] = (), period: float = 0.0
    ) -> None:
        self._solids, self._cuts, self._perhaps_cut = _Areas(), _Areas(), _Areas()
        self._period = period
        self._known: dict = {}
        self._courses: dict[bytes, list[Course]] = {}  # by the lines along which they go
        self.top = -math.inf
        for solid in solids:
            self._solids.add(solid, solid.shape.bounds, *solid[1:])
            self.top = max(self.top, -math.inf if solid.shape.is_empty else solid.level)
        for each in openings:
            self.open(each)

    def open(self, opening: Opening) -> None:
        cuts = self._perhaps_cut if opening.perhaps else self._cuts
        cuts.add(opening, opening.shape.bounds, opening.level, opening.since)

    def cut(self, move: int, points: np.ndarray, radius: float) -> None:
        """Remove the area swept by a cutter of a radius along points (n, 3), after those before."""
        if points[:, 2].min() >= self.top:
            return
        if _goes_along_z(points):
            points = points[points[:, 2].argmin()][None]
        for portion in _portions(points):
            course = Course(radius, portion.low, move)
            if self._is_swept(portion.line, course):
                continue
            for line in self._unrolled(portion.line, radius):
                self._courses.setdefault(_key(line), []).append(course)
                bounds = (*line.min(axis=0), *line.max(axis=0))
                self.cut_level(move, bounds, portion.low, partial(np.asarray, line), radius)

    def _is_swept(self, line: np.ndarray, course: Course) -> bool:
        """Return whether a course clears what another would along a line (n, 2)."""
        lines = self._unrolled(line, course.radius)
        known = (self._courses.get(_key(each), ()) for each in lines)
        return all(any(each.clears(course) for each in along) for along in known)

    def cut_level(
        self, move: int, bounds: Bounds, level: float, draw: Drawn, radius: float
    ) -> None:
        """Remove the area swept by a cutter at a level along a path within bounds."""
        if level < self.top:
            x0, y0, x1, y1 = bounds
            within = (x0 - radius, y0 - radius, x1 + radius, y1 + radius)
            self._cuts.add(_Sweep(draw, radius, self._known), within, level, move)

    def standing(
        self, region: BaseGeometry, level: float, before: float = math.inf, perhaps: bool = False
    ) -> BaseGeometry:
        """Return the material in a region just below a level, before a move.

        With ``perhaps`` that which may remain counts.
        """
        found = [
            translate(self._standing(portion, level + SAME_LEVEL, before, perhaps), away)
            for portion, away in self._turned(region)
        ]
        return unary_union(found) if len(found) > 1 else found[0]

    def _standing(
        self, region: BaseGeometry, level: float, before: float, perhaps: bool
    ) -> BaseGeometry:
        region = self._solids.near(region, (level, math.inf), before).within(region)
        for cuts in (self._cuts,) if perhaps else (self._cuts, self._perhaps_cut):
            region = cuts.near(region, (-math.inf, level), before).without(region)
        return region

    def _unrolled(self, line: np.ndarray, radius: float) -> list[np.ndarray]:
        """Return a path (n, 2) for each turn of a surface that it cuts, moved to the first turn."""
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
        """Return the turns of a surface between two positions around it; of a plane one."""
        if not self._period:
            return range(1)
        return range(math.floor(least / self._period), math.floor(most / self._period) + 1)

    def is_cut(self, region: BaseGeometry, level: float, before: float) -> bool:
        """Return whether a portion of a region may be cut down to a level before a move."""
        levels = (-math.inf, level + SAME_LEVEL)
        return any(self._cuts.near(each, levels, before).areas for each, _ in self._turned(region))

    def was_solid(self, region: BaseGeometry, level: float, before: float) -> bool:
        """Return whether a portion of a region was material above a level."""
        found = self._solids_near(region, level, before)
        return any(solid.shape.intersects(portion) for portion, solid in found)

    def surrounds(self, region: BaseGeometry, level: float, before: float) -> bool:
        """Return whether a portion of a region was material above a level, or in a hole of it."""
        found = self._solids_near(region, level, before)
        return any(_filled(solid.shape).intersects(portion) for portion, solid in found)

    def _solids_near(
        self, region: BaseGeometry, level: float, before: float
    ) -> Iterator[tuple[BaseGeometry, Area]]:
        """Yield each portion of a region with a solid above a level that may meet it."""
        levels = (level + SAME_LEVEL, math.inf)
        for portion, _ in self._turned(region):
            for solid in self._solids.near(portion, levels, before).areas:
                yield portion, solid

    def is_cleared(self, region: BaseGeometry, level: float, before: float) -> bool:
        """Return whether a region was material above a level, of which nothing stands there."""
        known = self.was_solid(region, level, before)
        return known and self.standing(region, level, before).area <= LEAST_AREA

    def covers(self, points: np.ndarray, radius: float, before: float, top: float) -> bool:
        """Return whether all that a cutter sweeps below a top is solid, or was cut as low before.

        What is below a cut outside of the solids is not known.
        """
        for portion in _below(top, points):
            course = Course(radius, portion.high + SAME_LEVEL, before)
            if self._is_swept(portion.line, course):
                continue
            rest = [each for each, _ in self._turned(swept([portion.line], radius))]
            for areas, most, move in (
                (self._solids, math.inf, None),
                (self._cuts, course.level, before),
            ):
                rest = [areas.near(each, (-math.inf, most), move).without(each) for each in rest]
            if sum(each.area for each in rest) > LEAST_AREA:
                return False
        return True

    def touched(
        self, points: np.ndarray, radius: float, before: float, perhaps: bool = False
    ) -> Touch | None:
        """Return the material that a cutter goes through along points (n, 3), None if none.

        With ``perhaps`` it may go through it.
        """
        found, where = [], []
        for portion in _below(self.top, points) if radius > ALLOWED else ():
            if self._is_swept(portion.line, Course(radius, portion.high + SAME_LEVEL, before)):
                continue
            region = swept([portion.line], radius - ALLOWED)
            area = self.standing(region, portion.high, before, perhaps)
            if area.area > LEAST_AREA:
                found.append(area)
                where += _points_in(area, portion, radius)
        return Touch(unary_union(found).area, np.array(where)) if where else None


def _filled(shape: BaseGeometry) -> BaseGeometry:
    """Return an area without its holes."""
    polygons = [each for each in getattr(shape, "geoms", [shape]) if isinstance(each, Polygon)]
    return unary_union([Polygon(each.exterior) for each in polygons])


def _key(line: np.ndarray) -> bytes:
    return np.round(line, 6).tobytes()


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
