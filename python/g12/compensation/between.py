# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges between contours: the tool, on its way along one, cuts into what another leaves standing.

The contours of a section, each from its G41 or G42 to its G40, are compared with each other. Cut
places of a contour that follow each other are a run. It is meant where the other contour itself
enters the first one's material: a finishing pass, a slot across a boss, a step. Else both leave
standing what the tool of one takes away. That is refused where

- neither of them enters the other one's material anywhere;
- the contour that is cut closes, and is not cut from end to end;
- what cuts it is no lead and no ramp, and at a height at which it is cut itself;
- the cut is deeper than an allowance for finishing can be: an offset that is too large on purpose
  makes a way between two contours narrower by twice the allowance.

Otherwise it is only told with its greatest depth, one line for each two contours, and another one
where a ramp cuts deeper. Program units.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, partial
from math import hypot
from typing import NamedTuple

from g12.compensation.compared import ComparedContour, ball_round
from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Contour,
    Line,
    Point,
    direction_at,
    path_length,
)
from g12.compensation.gouge import (
    RAMP,
    Cut,
    in_plane,
    places_along,
    stretches,
)
from g12.compensation.intersect import (
    distance_from,
    least_distance,
    nearest_place,
    part_of_move,
    place_at,
)
from g12.compensation.nearby import Box, Boxes, near_passes
from g12.errors import number

ALLOWANCE = 0.5  # of the tool's radius: what is cut deeper is none that a finishing pass takes off
ENTERED = 2.0  # tolerances: so deep is what enters the material
BESIDE_LAST = 3  # passes: so many on either side of the one that cut the last place are tried first
FINEST = 8.0  # tolerances: in steps twice as long a contour is followed into the material
MOST = 15_000  # pairs of a move and a pass; what would need more is not compared
EACH = 10  # pairs: so long takes the look for them in two contours


class _Hit(NamedTuple):
    """A place of a contour's move that a pass of another contour cuts.

    ``order``: the places of a contour in their order. ``by``: where the pass stands among others.
    """

    order: int
    index: int
    place: Point
    by: int


class _Verdict(NamedTuple):
    """A run that is not meant: the lines of both moves, how deep, and whether it is refused.

    ``ramp``: the other move is one with G40, G41 or G42.
    """

    line: int
    by: int
    deep: float
    ramp: bool
    refused: bool


def check_contours(contour: Contour, cuts: Sequence[Cut], tolerance: float) -> None:
    """Refuse a contour on whose way the tool cuts into another one, or tell it in the ``notes``."""
    followed = _in_plane_once(
        ComparedContour(contour, stretch, ramps, tolerance) for stretch, ramps in stretches(cuts)
    )
    followed = [one for one in followed if one.heights and one.radius > tolerance]
    if len(followed) < 2:
        return
    told: dict[tuple[int, int, bool], _Verdict] = {}
    for one, other, verdict in _verdicts(followed):
        lines = sorted((verdict.line, verdict.by))
        if verdict.refused:
            contour.refuse(
                lines[1],
                f"the tool of radius {number(followed[one].radius)} cannot follow both lines "
                f"{lines[0]} and {lines[1]}: beside one of them it cuts into the other",
            )
        pair = min(one, other), max(one, other), verdict.ramp
        if pair not in told or told[pair].deep < verdict.deep:
            told[pair] = verdict
    for verdict in told.values():
        text = f"{contour.code} line {verdict.by}: the tool cuts {number(verdict.deep)} into the "
        _note(contour, f"{text}contour of line {verdict.line}")


def _note(contour: Contour, text: str) -> None:
    if text not in contour.notes:
        contour.notes.append(text)


def _in_plane_once(followed: Iterator[ComparedContour]) -> list[ComparedContour]:
    """Return contours without those that repeat another one at other heights."""
    kept: dict[tuple, ComparedContour] = {}
    for one in followed:
        if one.signature in kept:
            kept[one.signature].add_level(one)
        else:
            kept[one.signature] = one
    return list(kept.values())


def _verdicts(followed: list[ComparedContour]) -> Iterator[tuple[int, int, _Verdict]]:
    """Yield what is not meant, with the numbers of the contour that is cut and the other one."""
    meant, rest = {}, []  # runs, by the numbers of both contours
    for one, other, meeting in _meetings(followed):
        for run in meeting.runs():
            if meeting.is_meant(run):
                meant.setdefault((one, other), set()).update(hit.order for hit in run)
            else:
                rest.append((one, other, meeting, run))
    for one, other, meeting, run in rest:
        gone = set().union(*(orders for (wall, _), orders in meant.items() if wall == one))
        left = [hit for hit in run if hit.order not in gone]
        if left:
            apart = (one, other) not in meant and (other, one) not in meant
            yield from ((one, other, verdict) for verdict in meeting.verdicts(left, apart))


def _meetings(followed: list[ComparedContour]) -> Iterator[tuple[int, int, _Meeting]]:
    """Yield the contours that are near to each other, as long as it takes no long time."""
    rest = MOST
    for one, others in _near_contours(followed):
        for other in others:
            meeting = _Meeting(followed[one], followed[other])
            yield one, other, meeting
            rest -= meeting.pairs + EACH
            if rest <= 0:
                return


def _near_contours(followed: list[ComparedContour]) -> Iterator[tuple[int, list[int]]]:
    """Yield each contour's number with those of the others whose tool may come near to it."""
    walls = Boxes([(k, _diagonal(one.walls.box)) for k, one in enumerate(followed)])
    passes = Boxes([(-1 - k, _diagonal(one.passes.box)) for k, one in enumerate(followed)])
    reach = max(one.radius for one in followed)
    for one, near in near_passes(walls, [passes], reach, (), lambda _: False):
        yield one, sorted(-1 - other for other, _ in near if other != -1 - one)


def _diagonal(box: Box) -> Line:
    low_x, low_c, high_x, high_c = box
    return Line(0, 0.0, 0.0, low_x, low_c, 0.0, high_x, high_c, 0.0)


class _Meeting:
    """A contour, and the passes along another one that may cut it."""

    def __init__(self, wall: ComparedContour, other: ComparedContour) -> None:
        self._wall, self._other = wall, other
        self._reach = other.radius - wall.tolerance
        self.pairs = 0  # that were looked at
        self._hits: list[_Hit] = []
        self._last = 0  # pass that cut the last place
        self._entered: dict[int, list[Line | Arc]] = {}  # parts of passes, by these
        self._air = (0.0, 0.0), 0.0  # a place and how far round it nothing is in the material

    def runs(self) -> list[list[_Hit]]:
        """Return the runs of the contour's places that the other one's passes cut."""
        wall, other = self._wall, self._other
        near = near_passes(wall.walls, [other.passes], self._reach, (), self._is_cut_on)
        for index, passes in near:
            self._cut(index, [-1 - number for number, _ in passes])
        runs: list[list[_Hit]] = []
        for hit in sorted(self._hits):
            if runs and hit.order == runs[-1][-1].order + 1:
                runs[-1].append(hit)
            else:
                runs.append([hit])
        around = wall.closing.closed and len(runs) > 1
        if around and runs[0][0].order == 0 and runs[-1][-1].order == wall.last_place:
            runs[0] = runs.pop() + runs[0]
        return runs

    def is_meant(self, run: list[_Hit]) -> bool:
        """Return whether the other contour enters the material anywhere in a run."""
        if any(self._covers(part, hit) for hit in run for part in self._entering(hit.by)):
            return True  # without a look at all of the other contour
        if any(self._is_inside_beside(hit) for hit in run):
            return True
        return any(
            self._covers(part, hit)
            for parts in self._inside
            for hit in run
            for _, part in parts.near((*hit.place, *hit.place), self._reach)
        )

    @cached_property
    def _inside(self) -> list[Boxes]:
        """All parts of passes near to the contour on which the other one is in the material."""
        near = self._other.passes.near(self._wall.walls.box, self._reach)
        order = sorted(-1 - number for number, _ in near)
        parts = [(0, part) for by in order for part in self._entering(by)]
        return [Boxes(parts)] if parts else []

    def _covers(self, part: Line | Arc, hit: _Hit) -> bool:
        """Return whether the tool cuts a place on a part of a pass."""
        low = _is_low(part, self._wall.heights[hit.index])
        return low and distance_from(part, hit.place) < self._reach

    def _entering(self, by: int) -> list[Line | Arc]:
        """Return on which parts of a pass the other contour is in the material."""
        if by not in self._entered:
            index, way = self._other.ways[by]
            self._entered[by] = [] if index == RAMP else list(self._parts_inside(way))
        return self._entered[by]

    def _parts_inside(self, way: Line | Arc) -> Iterator[Line | Arc]:
        """Yield the parts of a pass on which the tool touches its contour in the material."""
        waiting = [(0.0, 1.0)]
        while waiting:
            first, last = waiting.pop()
            inside = self._is_inside(way, first, last)
            if inside:
                yield part_of_move(way, first, last)
            elif inside is None:
                middle = 0.5 * (first + last)
                waiting += [(middle, last), (first, middle)]

    def _is_inside(self, way: Line | Arc, first: float, last: float) -> bool | None:
        """Return whether that is so on a part of a pass; None where it may change."""
        centre = place_at(way, 0.5 * (first + last))
        touch = _touch(way, centre, self._other.offset)
        half = 0.5 * (last - first) * _touched_length(way, touch)
        if self._is_clear(touch, half):
            return False
        height, inside = self._height(touch)
        if abs(height) - half > 2.0 * self._other.radius:
            return False  # from there the tool does not reach the contour
        if half <= FINEST * self._wall.tolerance or self._is_clear(touch, half):
            return inside
        all_in = self._wall.whole and height + half < -ENTERED * self._wall.tolerance
        return True if all_in else None

    def _is_inside_beside(self, hit: _Hit) -> bool:
        """Return whether the tool touches its contour in the material where a place is cut."""
        index, way = self._other.ways[hit.by]
        if index == RAMP:
            return False
        touch = _touch(way, nearest_place(way, hit.place), self._other.offset)
        return not self._is_clear(touch, 0.0) and self._height(touch)[1]

    def _height(self, touch: Point) -> tuple[float, bool]:
        """Return how far from the contour a place is, and whether it is in the material.

        Beyond the end of an open contour it may be.
        """
        wall = self._wall
        self.pairs += 1
        height, at_end = wall.height_of(touch)
        deep = -ENTERED * wall.tolerance
        if at_end:
            return abs(height), True
        if height >= deep and wall.whole:
            self._air = touch, height - deep
        return height, height < deep

    def _is_clear(self, touch: Point, half: float) -> bool:
        """Return whether all within a distance of a place is in the air that was seen last."""
        (x, c), radius = self._air
        return hypot(touch[0] - x, touch[1] - c) + half < radius

    def verdicts(self, run: list[_Hit], apart: bool) -> Iterator[_Verdict]:
        """Yield what to say of places that are not meant to be cut, of passes and of ramps.

        ``apart``: neither contour enters the other one's material anywhere.
        """
        wall, least = self._wall, ALLOWANCE * self._other.radius
        if apart and wall.closing.closed and len(run) < wall.count:
            for refused in self._deepest(run, least, self._may_be_refused):
                yield refused._replace(refused=True)
        least = wall.tolerance
        for counts in (self._is_pass, self._is_ramp):
            for told in self._deepest(run, least, counts):
                yield told
                least = told.deep

    def _deepest(
        self, run: list[_Hit], least: float, counts: Callable[[int, Point], bool]
    ) -> Iterator[_Verdict]:
        """Yield the deepest cut by a pass that counts, if it is deeper than ``least``."""
        other, found = self._other, None
        for hit in run:
            cuts = partial(self._cuts, counts, hit)
            away, number = other.passes.nearest(hit.place, other.radius - least, cuts)
            if number is not None:
                least, found = other.radius - away, hit._replace(by=-1 - number)
        if found:
            line = self._wall.moves[found.index].line
            index, way = other.ways[found.by]
            yield _Verdict(line, way.line, least, index == RAMP, False)

    def _cuts(self, counts: Callable, hit: _Hit, number: int, way: Line | Arc) -> bool:
        return _is_low(way, self._wall.heights[hit.index]) and counts(-1 - number, hit.place)

    def _may_be_refused(self, by: int, place: Point) -> bool:
        """Return whether a pass is no lead, at a height at which the contour is cut itself."""
        index, way = self._other.ways[by]
        if index == RAMP or self._other.leads(index, nearest_place(way, place)):
            return False
        return not self._wall.levels.isdisjoint(self._other.levels_of[in_plane(way)])

    def _is_ramp(self, by: int, _: Point) -> bool:
        return self._other.ways[by][0] == RAMP

    def _is_pass(self, by: int, _: Point) -> bool:
        return self._other.ways[by][0] != RAMP

    def _is_cut_on(self, index: int) -> bool:
        """Note the hits of a move if passes beside the one that cut last cut all of it."""
        if not self._hits:
            return False
        first = max(self._last - BESIDE_LAST, 0)
        beside = range(first, min(self._last + BESIDE_LAST + 1, len(self._other.ways)))
        order = sorted(beside, key=lambda by: abs(by - self._last))
        hits = list(self._hits_in(index, list(self._low(index, order))))
        if None in hits:
            return False
        self.pairs += 1
        self._hits += hits
        return True

    def _cut(self, index: int, passes: list[int]) -> None:
        """Note which places of a move some passes cut."""
        move = self._wall.parts[index]
        (x, c), ball = ball_round(move)
        near = []
        for by, way in self._low(index, passes):
            (wx, wc), other = self._other.balls[by]
            if hypot(wx - x, wc - c) < self._reach + ball + other:
                self.pairs += 1
                if least_distance(way, move) < self._reach:
                    near.append((by, way))
        if near:
            self._hits += filter(None, self._hits_in(index, near))

    def _low(self, index: int, passes: Iterable[int]) -> Iterator[tuple[int, Line | Arc]]:
        """Yield those of some passes that are not above a move."""
        height = self._wall.heights[index]
        for by in passes:
            way = self._other.ways[by][1]
            if _is_low(way, height):
                yield by, way

    def _hits_in(self, index: int, passes: list) -> Iterator[_Hit | None]:
        """Yield for each place of a move the hit by the first of some passes that cuts it."""
        places = places_along(self._wall.parts[index], self._wall.tolerance)
        for order, (at, *_) in enumerate(places, self._wall.first_places[index]):
            found = None
            for k, (by, way) in enumerate(passes):
                if distance_from(way, at) < self._reach:
                    found, self._last = _Hit(order, index, at, by), by
                    passes.insert(0, passes.pop(k))
                    break
            yield found


def _touch(way: Line | Arc, centre: Point, offset: float) -> Point:
    """Return where the tool touches its contour, at a place of a pass."""
    tx, tc = direction_at(way, centre)
    return centre[0] + offset * tc, centre[1] - offset * tx


def _touched_length(way: Line | Arc, touch: Point) -> float:
    """Return how long the way is on which the tool touches its contour on a pass."""
    if isinstance(way, Line):
        return path_length(way)
    return abs(way.sweep) * hypot(touch[0] - way.cx, touch[1] - way.cc)


def _is_low(way: Line | Arc, height: float) -> bool:
    """Return whether a pass is not above what is so high."""
    return min(way.z0, way.z1) <= height + SAME_PLACE
