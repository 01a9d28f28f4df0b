# SPDX-License-Identifier: GPL-2.0-or-later
"""What a shape's tool makes of the face: its levels, what stands and what is gouged at each.

Measured from the tool's way at each height alone: what a level leaves to a deeper one counts.
Lengths are millimetres, areas square millimetres, angles degrees, heights those above the face.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient
from shapely.ops import unary_union
from shapely.prepared import PreparedGeometry, prep

from g12.tools.path.part import disc, swept
from g12.tools.verify.shapes.shape_form import ShapeForm, Shift
from g12.tools.verify.shapes.shape_way import SAME_LEVEL, TINY, ShapeWay

CHORD = 2e-4  # of the polylines that stand for the tool's path
CORNERS = 48  # of a path whose area is worked out at once
EXPLAINS = 3.0  # times less off: so much better lies a shape where it is turned or away
NO_SHIFT = Shift(0.0, 0j)
LED = 0.6 * 2 * math.pi  # so far round does the way out to the finish round go at most
TELLING = 4.0  # times the tolerance: how much a finish round takes that can be told
NARROW = 0.0052  # a cutter that is as much narrower than a slot, on each side, goes along its line


class LevelFacts(NamedTuple):
    """What is at one level, when it is done and, behind the finish round, at the end.

    ``stands`` is by how much its extremes reach farther into the air than those of the shape.
    ``left`` and ``gouge`` are areas against the shape with its allowance.
    """

    height: float
    stands: tuple[float, ...]
    left: float
    gouge: float


@dataclass(frozen=True)
class ShapeAreas:
    """What a shape's way makes of the face.

    ``cut`` are the heights at which the tool goes across, in their order, ``lowest`` is the lowest
    of all. ``levels`` are those asked that are cut, ``end`` is the last one behind the finish
    round, None if it is not cut. ``rough`` are the moves of that level before this round.
    """

    cut: tuple[float, ...]
    lowest: float
    levels: tuple[LevelFacts, ...]
    end: LevelFacts | None
    rough: tuple[int, ...]


def measure_areas(way: ShapeWay, tolerance: float) -> ShapeAreas:
    """Return what a shape's way makes of the face."""
    asked, judge = way.asked, LevelJudge(way, tolerance)
    heights = [way.heights(index)[1] for index in way.fed]
    levels = {level: way.at(level) for level in asked.levels}
    *_, (deepest, whole) = levels.items()
    end = judge.facts(deepest, whole, 0.0) if whole else None
    rough = levels[deepest] = judge.rough(whole, end)
    finish = whole[len(rough) :]
    hidden = 0.0 < asked.allowance < TELLING * tolerance
    if hidden or way.times_along(finish, tolerance) > 1:  # no telling what is rough
        levels[deepest] = []
    facts = [judge.facts(level, own, asked.allowance) for level, own in levels.items() if own]
    cut = tuple(height for height, _ in way.flat())
    return ShapeAreas(cut, min(heights, default=0.0), tuple(facts), end, tuple(rough))


def shift_of(way: ShapeWay, tolerance: float) -> Shift:
    """Return how a shape lies otherwise on the part than asked, where that explains its walls."""
    form, whole = way.asked.form, way.at(way.asked.levels[-1])
    reached = LevelJudge(way, tolerance).reached(whole) if whole else None
    if reached is None:
        return NO_SHIFT
    stands = form.stands(corners_round(reached))
    shift = Shift(turn_of(form, reached), 0j)
    if not form.fold:
        sides = zip(form.extremes, stands)
        shift = Shift(0.0, sum(each.direction * more for each, more in sides) / 2)
    placed = form.placed(shift).stands(corners_round(reached))
    off, still_off = (max(map(abs, each)) for each in (stands, placed))
    return shift if off > max(tolerance, EXPLAINS * still_off) else NO_SHIFT


def turn_of(form: ShapeForm, reached: Polygon) -> float:
    """Return by how many degrees a form is turned: the angle of its outline's sides by length."""
    steps = np.diff(corners_round(orient(reached)))
    normals = -1j * steps / np.maximum(np.abs(steps), TINY)
    phase = cmath.phase(complex((np.abs(steps) * normals**form.fold).sum()))
    if not form.fold:
        return 0.0
    return math.remainder(math.degrees(phase) / form.fold - form.angle, 360.0 / form.fold)


class LevelJudge:
    """Judges the levels of one shape; areas of equal ways are worked out once."""

    def __init__(self, way: ShapeWay, tolerance: float) -> None:
        self._way, self._asked, self._form = way, way.asked, way.asked.form
        self._tolerance = tolerance
        self._swept: dict[bytes, BaseGeometry] = {}

    def facts(self, height: float, indices: Sequence[int], allowance: float) -> LevelFacts:
        """Return what moves at a height leave of a shape with an allowance on its walls."""
        area = self.swept(indices)
        wanted = self._form.moved(allowance)
        slack = self._tolerance + (NARROW if self._is_narrow(allowance) else 0.0)
        if self._form.inside:
            left = wanted.buffer(-slack).difference(area)
            gouge = self._all_of(height, indices).difference(wanted.buffer(self._tolerance))
        else:
            around = self._bar.difference(wanted).buffer(-slack)
            left, gouge = around.difference(area), area.intersection(wanted.buffer(-slack))
        reached = self.reached(indices)
        stands = self._form.stands(corners_round(reached)) if reached else ()
        return LevelFacts(height, stands, left.area, gouge.area)

    def rough(self, indices: Sequence[int], end: LevelFacts | None) -> list[int]:
        """Return the moves of the last level before the finish round and the way out to it.

        That begins where the tool first comes to the wall of the ``end``.
        """
        allowance, outward = self._asked.allowance, self._form.outward
        last = min((more * outward for more in end.stands), default=0.0) if end else 0.0
        if allowance - last < TELLING * self._tolerance:
            return list(indices)
        finishing = self._beside(last + 2 * self._tolerance)
        whole = self._until(indices, finishing, True)
        for wall in (allowance, allowance + last):
            touching = self._beside(wall - self._tolerance)
            led = self._until(whole[::-1], touching, False)
            if np.abs(self._way.turned(led[::-1])).sum() < LED:
                return whole[: len(whole) - len(led)]
        return whole

    def _beside(self, distance: float) -> PreparedGeometry:
        """Return where the tool's centre is when its edge is that far off the shape's wall."""
        return prep(self._form.moved(distance + self._asked.cutter))

    def _until(self, indices: Sequence[int], zone: PreparedGeometry, entered: bool) -> list[int]:
        """Return the moves before the first that comes nearer than a zone, or that does not."""
        return list(takewhile(lambda index: self._is_in(index, zone) != entered, indices))

    def _is_in(self, index: int, zone: PreparedGeometry) -> bool:
        """Tell whether a move comes nearer to the material than the edge of a zone."""
        places = (Point(p.real, p.imag) for p in self._way.points(index))
        return any(zone.contains(place) != self._form.inside for place in places)

    def swept(self, indices: Sequence[int]) -> BaseGeometry:
        """Return the area that the cutter sweeps along moves."""
        lines = self._way.along(indices)
        key = b"".join(np.round(line, 6).tobytes() for line in lines)
        if key not in self._swept:
            self._swept[key] = area_swept(lines, self._asked.cutter)
        return self._swept[key]

    @cached_property
    def _bar(self) -> BaseGeometry:
        return disc((0.0, 0.0), self._form.stock)

    def _is_narrow(self, allowance: float) -> bool:
        """Tell whether the cutter is as wide as what there is to cut."""
        if not self._form.inside:
            return False
        width = min(extreme.reach for extreme in self._form.extremes)
        return width - allowance - self._asked.cutter < NARROW

    def _all_of(self, height: float, indices: Sequence[int]) -> BaseGeometry:
        """Return the area of a level and of the ways down below the face to it."""
        way = self._way
        ends = ((index, way.heights(index)[1]) for index in way.falling)
        above = [each for each in self._asked.levels if each > height + SAME_LEVEL] or [0.0]
        down = [index for index, end in ends if height - TINY < end < above[-1] + TINY]
        return unary_union([self.swept(indices), self.swept(down)]) if down else self.swept(indices)

    def reached(self, indices: Sequence[int]) -> Polygon | None:
        """Return what moves make of a shape: what stands, or what is cut away."""
        area = self.swept(indices)
        shape = area if self._form.inside else self._bar.difference(area)
        parts = [part for part in getattr(shape, "geoms", [shape]) if part.area > TINY]
        return max(parts, key=lambda part: part.area, default=None)


def corners_round(area: Polygon) -> np.ndarray:
    """Return the corners (complex) of an area's outline."""
    x, y = np.array(area.exterior.coords).T[:2]
    return x + 1j * y


def area_swept(lines: Sequence[np.ndarray], cutter: float) -> BaseGeometry:
    """Return the area that a cutter of a radius sweeps along polylines (complex)."""
    return swept((part for line in lines for part in polylines_of(line)), cutter)


def polylines_of(line: np.ndarray) -> Iterator[np.ndarray]:
    """Yield a polyline (complex) in parts (n, 2), for a whole one takes long to work out."""
    corners = np.column_stack([line.real, line.imag])
    if np.abs(np.diff(line)).sum() < TINY:
        yield corners[:1]
        return
    corners = np.array(LineString(corners).simplify(CHORD).coords)
    for first in range(0, len(corners) - 1, CORNERS):
        yield corners[first : first + CORNERS + 1]
