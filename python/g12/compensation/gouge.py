# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges: places where the tool, on its way along a contour, cuts into that same contour.

Looked at is each stretch from the G41 or G42 to its G40, as a whole. A place of it is cut where the
tool's centre comes nearer than the radius, less the tolerance. That is right

- beyond the place where the contour closes: leads are no contour (`closing`);
- where the contour itself runs on behind the place, the same way: a spiral, a finishing pass;
- where the tool is above the place, or the contour runs through the air between two plunges.

Everything else is refused, and so is a contour that crosses itself. Only told are leads that cross
each other, and an open contour's first or last move that a later pass cuts from its far side.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from functools import reduce
from itertools import accumulate, groupby
from math import ceil, copysign, hypot, inf, sqrt
from typing import NamedTuple, NoReturn

from g12.compensation.closing import closing_of
from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Contour,
    Line,
    Plunge,
    Point,
    direction_at,
    is_move,
    path_length,
)
from g12.compensation.intersect import (
    along_start,
    common_places,
    least_distance,
    nearest_place,
    part_of_move,
    place_at,
)
from g12.compensation.nearby import Boxes, apart, box_of, near_passes, straight_runs
from g12.errors import Refusal, number

MEETING = 4.0  # tolerances: places so near to each other close a contour
SAME_WAY = 0.9  # cosine of the angle between passes behind each other, at least
CROSSED = 0.02  # of the tool's radius: so far a contour goes to both sides where it crosses itself
BESIDE_CROSSING = (0.125, 0.25, 0.5, 1.0)  # of the tool's radius: there that is looked at
RAMP = -1  # in place of an index
# How a pass cuts a place: it touches the contour on the place's own side, or behind the place, or
# there and goes the same way.
NOT, FACING, BEHIND, PASSED = "", "facing", "behind", "passed"
TURN_ON = 3  # moves: so many on either side of that which ran behind the last place are tried


class LeadRefusal(Refusal):
    """The tool cuts into a closed contour where it leads to or from it."""


class Cut(NamedTuple):
    """A move of the contour and the tool centre's ``path`` for it.

    ``cut`` tells that it is under compensation at both ends: it is no ramp.
    """

    move: Line | Arc
    path: tuple[Line | Arc | Plunge, ...]
    cut: bool


class ContourPlace(NamedTuple):
    """A place of the contour, its direction, and the unit vector to the tool's side."""

    place: Point
    way: Point
    normal: Point


class _Hit(NamedTuple):
    """The tool, on its way for the move of ``line``, cuts into the contour.

    ``lead``: that move, or the one it cuts, may be one to lead in or out. ``ramp``: that move is
    the one with G40, G41 or G42.
    """

    line: int
    lead: bool
    ramp: bool = False


def check_gouges(contour: Contour, cuts: Sequence[Cut], tolerance: float) -> None:
    """Refuse a contour along which the tool cuts deeper into it than the tolerance.

    What is only told goes to the contour's ``notes``. Program units.
    """
    for stretch, ramps in stretches(cuts):
        _Stretch(contour, stretch, tolerance).check(ramps)


def stretches(cuts: Sequence[Cut]) -> Iterator[tuple[list[Cut], list[Cut]]]:
    """Yield each contour between two ramps, and the ramps."""
    at = 0
    for cut, group in groupby(cuts, key=lambda cut: cut.cut):
        stretch = list(group)
        if cut:
            yield stretch, [*cuts[max(at - 1, 0) : at], *cuts[at + len(stretch) :][:1]]
        at += len(stretch)


class _Stretch:
    """A contour from one ramp to the next."""

    def __init__(self, contour: Contour, cuts: list[Cut], tolerance: float) -> None:
        self._contour, self._cuts, self._tolerance = contour, cuts, tolerance
        self._moves = [cut.move for cut in cuts]
        self._offset = self._moves[0].offset
        self._radius = abs(self._offset)
        self._closing = closing_of(self._moves, max(MEETING * tolerance, 2 * contour.closing))
        self._ends = [0.0, *accumulate(map(path_length, self._moves))]
        self._boxes = [box_of(move) for move in self._moves]
        self._heights = greatest_heights(self._moves)
        self._behind = 0  # by so many moves another pass ran behind the last place, if one did

    def check(self, ramps: list[Cut]) -> None:
        """Refuse the gouges of the stretch, or tell them."""
        closing = self._closing
        if closing.crossing:
            self._note(
                *self._lines(closing.first, self._moves[closing.last].line),
                "cross: taken for the leads of a contour that closes there",
            )
        for index, passes in self._candidates(ramps):
            hit = self._hit(index, passes)
            if hit:
                one, other = self._lines(index, hit.line)
                if not hit.lead:
                    self._refuse(one, other)
                if not closing.crossing:
                    self._note(one, other, "cut into each other: one is taken for a lead")

    def _refuse(self, one: int, other: int) -> NoReturn:
        """Refuse two lines; where one leads to or from a closed contour the side may be wrong."""
        ends = {self._moves[0].line, self._moves[-1].line}
        kind = LeadRefusal if self._closing.closed and ends & {one, other} else Refusal
        raise kind(
            f"{self._contour.code} line {other}: the tool of radius {number(self._radius)} cannot"
            f" follow both lines {one} and {other}: beside one of them it cuts into the other"
        )

    def _lines(self, index: int, line: int) -> tuple[int, int]:
        """Return two lines in their order, that of a move by its index."""
        one, other = sorted((self._moves[index].line, line))
        return one, other

    def _note(self, one: int, other: int, what: str) -> None:
        text = f"{self._contour.code} line {other}: lines {one} and {other} {what}"
        if text not in self._contour.notes:
            self._contour.notes.append(text)

    def _candidates(self, ramps: list[Cut]) -> Iterator[tuple[int, list[tuple]]]:
        """Yield the moves that the tool may cut, by their index, and its passes near to each."""
        moves = Boxes([(index, self._moves[index]) for index in sorted(self._heights)])
        passes = [Boxes(ways) for ways in self._passes(ramps)]
        runs = straight_runs(self._moves)
        for index, near in near_passes(moves, passes, self._radius, runs, self._is_behind):
            low = [passed for passed in near if self._is_low(passed[1], index)]
            about = index + self._behind
            yield index, sorted(low, key=lambda passed: abs(passed[0] - about))

    def _is_low(self, way: Line | Arc, index: int) -> bool:
        """Return whether a way of the tool is not above a move all along."""
        return min(way.z0, way.z1) <= self._heights[index] + SAME_PLACE

    def _is_behind(self, index: int) -> bool:
        """Return whether those passes run behind a move that did so, relative to it, before."""
        move = self._part(index) if self._behind else None
        if move is None:
            return False
        about = index + self._behind
        near = range(max(about - TURN_ON, 0), min(about + TURN_ON + 1, len(self._cuts)))
        passes = [
            (by, way)
            for by in sorted(near, key=lambda by: abs(by - about))
            for way in filter(is_move, self._cuts[by].path)
            if self._is_low(way, index)
        ]
        return all(self._is_passed(place, passes) for place in places_along(move, self._tolerance))

    def _is_passed(self, place: ContourPlace, passes: list[tuple]) -> bool:
        """Return whether one of some passes runs behind a place; the next is asked of it first."""
        for at, passed in enumerate(passes):
            if self._seen_from(place, passed) == PASSED:
                passes.insert(0, passes.pop(at))
                return True
        return False

    def _passes(self, ramps: list[Cut]) -> Iterator[list[tuple]]:
        """Yield the tool's ways along the contour, each with its move's index, then the ramps'.

        At the ends of an open contour there may be no material: its ramps may cut there.
        """
        yield without_repeats(
            (index, way) for index, cut in enumerate(self._cuts) for way in cut.path if is_move(way)
        )
        if self._closing.closed:
            for ramp in ramps:
                ways = [(RAMP, way) for way in ramp.path if is_move(way)]
                if ways:
                    yield ways

    def _part(self, index: int) -> Line | Arc | None:
        """Return what of a move belongs to the contour, None if it is all lead."""
        first, last = self._closing.part(index, self._moves[index])
        if last <= first:
            return None
        return part_of_move(self._moves[index], first, last)

    def _hit(self, index: int, passes: list[tuple]) -> _Hit | None:
        """Return one of the passes that cuts into a move where it must not, if any."""
        move = self._part(index)
        if move is None:
            return None
        for by, _ in passes:
            if by not in (RAMP, index) and self._cross(index, move, by):
                return _Hit(self._moves[by].line, False)
        nearest = self._radius - self._tolerance
        near = (passed for passed in passes if least_distance(passed[1], move) < nearest)
        passed = next(near, None)
        places = list(places_along(move, self._tolerance)) if passed else []
        hits: list[_Hit | None] = [None] * len(places)
        while places and passed:
            places, hits = self._after(index, passed, places, hits)
            passed = next(near, None)
        return reduce(_worse, hits, None)

    def _after(self, index: int, passed: tuple, places: list, hits: list) -> tuple[list, list]:
        """Return those places of a move that no pass runs behind, and what hits them."""
        kept_places, kept_hits = [], []
        for place, hit in zip(places, hits):
            seen = self._seen_from(place, passed)
            if seen == PASSED:
                self._behind = passed[0] - index
                continue
            if seen:
                hit = _worse(hit, self._hit_of(index, passed, seen == BEHIND))
            kept_places.append(place)
            kept_hits.append(hit)
        return kept_places, kept_hits

    def _hit_of(self, index: int, passed: tuple, behind: bool) -> _Hit:
        """Return the hit of a move by a pass that touches behind it, or does not."""
        closing, (by, way) = self._closing, passed
        if closing.crossing:
            lead = all(k <= closing.first or k >= closing.last for k in (index, by))
        else:
            lead = not closing.closed and behind and index in (0, len(self._moves) - 1)
        corner_before = by == index > 0  # the corner in front of a move belongs to both
        return _Hit(self._moves[index - 1].line if corner_before else way.line, lead, by == RAMP)

    def _seen_from(self, place: ContourPlace, passed: tuple) -> str:
        """Return how a pass cuts a place, as the names above tell; NOT where it does not."""
        (x, c), by, way = place.place, *passed
        px, pc = nearest_place(way, place.place)
        if hypot(px - x, pc - c) >= self._radius - self._tolerance:
            return NOT
        if by == RAMP:
            return FACING
        tx, tc = direction_at(way, (px, pc))
        touch_x, touch_c = px + self._offset * tc, pc - self._offset * tx
        height = (touch_x - x) * place.normal[0] + (touch_c - c) * place.normal[1]
        if height >= -self._tolerance:
            return FACING
        same_way = tx * place.way[0] + tc * place.way[1] > SAME_WAY
        return PASSED if same_way else BEHIND

    # Where the contour crosses itself.

    def _cross(self, index: int, move: Line | Arc, by: int) -> bool:
        """Return whether the contour crosses itself at two of its moves."""
        if apart(self._boxes[index], self._boxes[by], 0.0):
            return False
        other = self._part(by)
        if other is None:
            return False
        return any(self._goes_through(index, place, by) for place in common_places(move, other))

    def _goes_through(self, index: int, place: Point, by: int) -> bool:
        """Return whether the contour goes from one side of itself to the other, at a place."""
        here, there = (self._ends[k] + along_start(self._moves[k], place) for k in (index, by))
        deep = max(MEETING * self._tolerance, CROSSED * self._radius)
        for share in BESIDE_CROSSING:
            away = share * self._radius
            about = self._about(here, 2.0 * away)
            before, after = (
                self._side_of(about, self._point(there + step)) for step in (-away, away)
            )
            if min(before, after) < -deep and max(before, after) > deep:
                return True
        return False

    def _point(self, at: float) -> Point:
        """Return the place at a length along the contour, from its start to its end."""
        closing = self._closing
        first = self._ends[closing.first] + closing.start
        last = self._ends[closing.last] + closing.end
        at = min(max(at, first), last)
        index = min(max(bisect_right(self._ends, at) - 1, 0), len(self._moves) - 1)
        part = (at - self._ends[index]) / path_length(self._moves[index])
        return place_at(self._moves[index], min(part, 1.0))

    def _side_of(self, indices: Iterable[int], point: Point) -> float:
        """Return how far to the left of some moves of the contour a point is."""
        nearest, side = inf, 0.0
        for k in indices:
            move = self._moves[k]
            x, c = nearest_place(move, point)
            away = hypot(point[0] - x, point[1] - c)
            tx, tc = direction_at(move, (x, c))
            across = tx * (point[1] - c) - tc * (point[0] - x)
            if away < nearest - SAME_PLACE or (away <= nearest and abs(across) > abs(side)):
                nearest, side = away, across
        return side

    def _about(self, middle: float, reach: float) -> range:
        """Return the indices of the moves within a length of a place along the contour."""
        first = bisect_right(self._ends, middle - reach) - 1
        last = bisect_right(self._ends, middle + reach)
        return range(max(first, 0), min(last, len(self._moves)))


def _worse(one: _Hit | None, other: _Hit | None) -> _Hit | None:
    """Return which of two hits is refused rather than told, and rather not a ramp's."""
    hits = [hit for hit in (one, other) if hit]
    return min(hits, key=lambda hit: (hit.lead, hit.ramp), default=None)


def place_count(move: Line | Arc, tolerance: float) -> int:
    """Return how many places `places_along` yields."""
    return ceil(path_length(move) / sqrt(2.0 * abs(move.offset) * tolerance)) + 1


def places_along(move: Line | Arc, tolerance: float) -> Iterator[ContourPlace]:
    """Yield places along a move, so close that no cut falls between two of them."""
    last = place_count(move, tolerance) - 1
    inset = min(0.25, tolerance / path_length(move))
    side = copysign(1.0, move.offset)
    for k in range(last + 1):
        place = place_at(move, inset + (1.0 - 2.0 * inset) * k / last)
        tx, tc = direction_at(move, place)
        yield ContourPlace(place, (tx, tc), (-side * tc, side * tx))


def without_repeats(passes: Iterable[tuple]) -> list[tuple]:
    """Return passes without those that repeat another at the same depth or higher."""
    kept: dict[tuple, tuple] = {}
    for index, way in passes:
        place = in_plane(way)
        if place not in kept or min(way.z0, way.z1) < min(kept[place][1].z0, kept[place][1].z1):
            kept[place] = (kept[place][0] if place in kept else index), way
    return list(kept.values())


def greatest_heights(moves: Sequence[Line | Arc]) -> dict[int, float]:
    """Return the greatest Z of each move, by its index; of repeated ones only the first's index.

    Moves in the air, between a plunge up and a plunge down, are not there.
    """
    heights: dict[int, float] = {}
    first: dict[tuple, int] = {}
    for index in _in_material(moves):
        move = moves[index]
        place = first.setdefault(in_plane(move), index)
        heights[place] = max(heights.get(place, -inf), move.z0, move.z1)
    return heights


def _in_material(moves: Sequence[Line | Arc]) -> Iterator[int]:
    """Yield the indices of the moves that are not made in the air."""
    levels: list[list[int]] = [[0]]
    for index in range(1, len(moves)):
        if abs(moves[index].z0 - moves[index - 1].z1) > SAME_PLACE:
            levels.append([])
        levels[-1].append(index)
    for k, level in enumerate(levels):
        lifted = k > 0 and moves[level[0]].z0 > moves[level[0] - 1].z1
        lowered = k + 1 < len(levels) and moves[level[-1]].z1 > moves[level[-1] + 1].z0
        if not (lifted and lowered):
            yield from level


def in_plane(move: Line | Arc) -> tuple:
    """Return what tells one move in the plane from another, rounding aside."""
    places = (move.x0, move.c0, move.x1, move.c1, *move[9:])
    return tuple(round(place / SAME_PLACE) for place in places)
