# SPDX-License-Identifier: GPL-2.0-or-later
"""A contour from its G41 or G42 to its G40: where it closes, its walls, the tool's passes along it.

A contour closes where one of its first moves meets one of its last: the one ends on the other, or
both are long enough to cross, as leads do that overrun a corner. Its moves beyond that point are
lead-in and lead-out.

A wall is the finished surface of a move, on the side away from the tool. Leads have no wall, nor
have moves in the air between two plunges. Program units.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property
from itertools import accumulate, groupby, product
from math import ceil, copysign, inf, sqrt
from typing import NamedTuple

from g12.compensation.contour import SAME_POINT, Contour, PathElement, PlaneMove
from g12.errors import number
from g12.geometry.curve import Arc, Box, BoxTree, Curve, common_points

LEADS = 3  # moves at either end of a contour that are searched for the point where it closes
CROSSING = 2  # moves at either end that may cross each other
LEAST_LEAD_SHARE = 0.5  # of a lead's length: a contour is at least this long, or
LEAST_RADII = 4.0  # tool radii
LEAST_SINE = 0.05  # of the angle between moves: below this they touch, they do not cross
LEAST_CONTOUR = 5  # least moves of a contour in which a crossing lead may have more than one move


class Closing(NamedTuple):
    """The contour from a length along its move ``first`` to one along its move ``last``.

    ``closed`` is False for an open contour, which has no leads. ``crossing``: the leads cross, and
    end on both sides of the contour.
    """

    first: int
    start: float
    last: int
    end: float
    closed: bool
    crossing: bool

    def shares(self, index: int, curve: Curve) -> tuple[float, float]:
        """Return the shares of a move between which it belongs to the contour; else (0, 0)."""
        if not self.first <= index <= self.last:
            return 0.0, 0.0
        length = curve.length
        start = self.start if index == self.first else 0.0
        end = self.end if index == self.last else length
        return (start / length, end / length) if end - start > SAME_POINT else (0.0, 0.0)


def closing_of(curves: Sequence[Curve], radius: float, near: float) -> Closing:
    """Return where a contour closes; points up to ``near`` apart meet.

    A loop much shorter than the leads and the tool is a spur of an open contour.
    """
    count, ends = len(curves), [0.0, *accumulate(curve.length for curve in curves)]
    for i, j in product(range(min(count, LEADS)), range(count - 1, count - 1 - LEADS, -1)):
        found = [each for each in _meetings(curves, i, j, near) if each.allowed] if j > i else []
        if found:
            start, end, crossing, _ = max(found, key=lambda each: each.start - each.end)
            lead = max(ends[i] + start, ends[-1] - ends[j] - end)
            least = min(LEAST_LEAD_SHARE * lead, LEAST_RADII * radius)
            if ends[j] + end - ends[i] - start >= least:
                return Closing(i, start, j, end, True, crossing)
    is_round = abs(curves[0].start - curves[-1].end) <= near
    return Closing(0, 0.0, count - 1, curves[-1].length, is_round, False)


class _Meeting(NamedTuple):
    start: float
    end: float
    crossing: bool
    allowed: bool


def _meetings(curves: Sequence[Curve], i: int, j: int, near: float) -> Iterator[_Meeting]:
    """Yield the meetings of moves ``i`` and ``j``; of neighbours in the later half of ``j``."""
    one, other, count = curves[i], curves[j], len(curves)
    skipped = 0.5 if j == i + 1 else 0.0
    if skipped:
        other = other.portion(skipped, 1.0)
    length, rest = one.length, other.length
    outer = (i, j) == (0, count - 1)
    leads = count >= LEAST_CONTOUR and i < CROSSING and j >= count - CROSSING
    for a, b in _points(one, other, near):
        start = min(max(one.length_to(a), 0.0), length)
        end = min(max(other.length_to(b, late=True), 0.0), rest)
        inside = near < start < length - near, near < end < rest - near
        joints = _joined_directions(curves, i, start), _joined_directions(curves, j, end)
        crossing = all(inside) or any(
            within and joint and _goes_through(joint, curve, point)
            for within, joint, curve, point in zip(inside[::-1], joints, (other, one), (b, a))
        )
        passed = skipped * curves[j].length
        yield _Meeting(start, passed + end, crossing, outer or leads or not crossing)


def _joined_directions(curves: Sequence[Curve], k: int, along: float) -> tuple[complex, ...]:
    """Return the directions on both sides of the nearer end of a move, if others join it."""
    at_end = along > 0.5 * curves[k].length
    first = k if at_end else k - 1
    if not 0 <= first < len(curves) - 1:
        return ()
    return curves[first].direction(1.0), curves[first + 1].direction(0.0)


def _goes_through(joint: tuple[complex, ...], curve: Curve, point: complex) -> bool:
    """Return whether two moves joined at a point of a third lie on both sides of it."""
    along = curve.direction(curve.share_of(point)).conjugate()
    sines = [(along * direction).imag for direction in joint]
    return min(sines) > LEAST_SINE or max(sines) < -LEAST_SINE


def _points(one: Curve, other: Curve, near: float) -> Iterator[tuple[complex, complex]]:
    """Yield points on two moves that are at most ``near`` apart."""
    for point in common_points(one, other):
        yield point, point
    pairs = [(end, other.point(other.share_of(end))) for end in (one.start, one.end)]
    pairs += [(one.point(one.share_of(end)), end) for end in (other.start, other.end)]
    yield from ((a, b) for a, b in pairs if abs(a - b) <= near)


MEETING = 4.0  # tolerances: ends within this distance close a contour
RAMP = -1  # the move index of a ramp's passes


class PathOfMove(NamedTuple):
    """A move of the contour and the tool centre's ``path`` for it.

    ``compensated``: compensation is on at both its ends, so it is no ramp.
    """

    move: PlaneMove
    path: tuple[PathElement, ...]
    compensated: bool


class Pass(NamedTuple):
    """A move of the tool's centre along move ``move_index`` of a contour, with all its levels."""

    contour: CompensatedContour
    move_index: int
    move: PlaneMove
    levels: frozenset[int]

    def contact(self, share: float) -> complex:
        """Return the contact point of tool and contour at a share of the pass."""
        curve = self.move.curve
        return curve.point(share) - 1j * self.contour.offset * curve.direction(share)

    def is_low(self, level: float) -> bool:
        """Return whether the pass is at or below a Z level somewhere."""
        return self.move.lowest <= level + SAME_POINT

    def cuts(self, point: WallPoint, distance: float) -> bool:
        """Return whether the pass, at the wall's Z or below, comes nearer than ``distance``."""
        return self.is_low(point.level) and self.move.curve.distance(point.point) < distance


class WallPoint(NamedTuple):
    """A point of a wall, its length ``along`` the contour, and the contour's direction there.

    ``level`` is the wall's Z.
    """

    move_index: int
    along: float
    point: complex
    direction: complex
    level: float


class Sweep:
    """The tool swept along passes: which of them cut a point of a wall."""

    def __init__(self, passes: Iterable[Pass]) -> None:
        self.passes = list(passes)
        self._tree = BoxTree([each.move.curve for each in self.passes])

    @property
    def box(self) -> Box:
        return self._tree.box

    def deepest(
        self, point: WallPoint, distance: float, counts: Callable[[Pass], bool] = lambda _: True
    ) -> tuple[float, Pass | None]:
        """Return the distance from a point to the nearest pass that counts, and that pass.

        Only passes nearer than ``distance``, at the wall's Z or below, are searched: that and None
        where there is none.
        """
        passes, level = self.passes, point.level
        away, k = self._tree.nearest(
            point.point, distance, lambda k: passes[k].is_low(level) and counts(passes[k])
        )
        return away, None if k is None else passes[k]

    def cuts(self, point: WallPoint, distance: float) -> bool:
        return self.deepest(point, distance)[1] is not None

    def cutting(self, point: WallPoint, distance: float) -> Iterator[Pass]:
        for k in self._tree.near((point.point.real, point.point.imag) * 2, distance):
            if self.passes[k].cuts(point, distance):
                yield self.passes[k]


class CompensatedContour:
    """A contour from one ramp to the next.

    ``walls`` are the portions of its moves that are walls, by their indices, each with the
    greatest Z of all moves that repeat it.
    """

    def __init__(
        self,
        contour: Contour,
        cuts: Sequence[PathOfMove],
        ramps: Sequence[PathOfMove],
        tolerance: float,
    ) -> None:
        self.code, self.tolerance = contour.code, tolerance
        self.moves = [cut.move for cut in cuts]
        self.offset = self.moves[0].offset
        self.radius, self.side = abs(self.offset), copysign(1.0, self.offset)
        curves = [move.curve for move in self.moves]
        near = max(MEETING * tolerance, 2 * contour.radius_tolerance)
        self.closing = closing_of(curves, self.radius, near)
        self.ends = [0.0, *accumulate(curve.length for curve in curves)]
        self.walls: dict[int, PlaneMove] = {}
        for index, level in sorted(greatest_levels(self.moves).items()):
            first, last = self.closing.shares(index, curves[index])
            if first < last:
                wall = self.moves[index].portion(first, last)
                self.walls[index] = wall._replace(h0=level, h1=level)
        self.levels = frozenset(_level_key(self.moves[index].h1) for index in self.walls)
        passes = [(index, move) for index, cut in enumerate(cuts) for move in cut.path]
        self.passes = self._passes_of(passes)
        self.ramps = self._passes_of((RAMP, move) for ramp in ramps for move in ramp.path)

    @property
    def gouge_distance(self) -> float:
        """Distance from a wall below which the tool's centre gouges it."""
        return self.radius - self.tolerance

    @property
    def spacing(self) -> float:
        """The length between two points of a wall: half the chord at a depth of the tolerance.

        A chord of height h in a circle of radius r is nearly 2 sqrt(2 r h) long.
        """
        return sqrt(2.0 * self.radius * self.tolerance)

    @cached_property
    def sweep(self) -> Sweep:
        return Sweep(self.passes)

    @cached_property
    def wall_tree(self) -> BoxTree:
        """The walls, in their order."""
        return BoxTree([wall.curve for wall in self.walls.values()])

    @cached_property
    def _contour_tree(self) -> BoxTree:
        return BoxTree([move.curve for move in self.moves])

    def _passes_of(self, path: Iterable[tuple[int, object]]) -> list[Pass]:
        """Return the passes of moves with their indices; repeated ones once, with all Z levels."""
        kept: dict[tuple[int, ...], Pass] = {}
        for index, move in path:
            if not isinstance(move, PlaneMove):
                continue
            key, levels = in_plane(move), frozenset([_level_key(move.h1)])
            before = kept.get(key)
            if before:
                index, levels = before.move_index, levels | before.levels
                move = min(before.move, move, key=lambda each: each.lowest)
            kept[key] = Pass(self, index, move, levels)
        return list(kept.values())

    def points(self) -> Iterator[WallPoint]:
        """Yield points of the walls, so close that no gouge falls between two of them.

        A tool that is one tolerance deep in a wall cuts a chord of its radius there. Short
        collinear moves share their points.
        """
        spacing = self.spacing
        straight, last = 4.0 * self.tolerance / spacing, None
        for index, wall in self.walls.items():
            curve, length = wall.curve, wall.length
            begin = self.ends[index] + self.closing.start * (index == self.closing.first)
            if last and begin + length - last.along < spacing:
                turned = last.direction.conjugate() * curve.direction(1.0)
                if turned.real > 0.0 and abs(turned.imag) < straight:
                    continue
            step = spacing
            if isinstance(curve, Arc):
                step = min(step, 2.0 * sqrt(curve.radius * self.tolerance))
            count, inset = ceil(length / step), min(0.25, self.tolerance / length)
            for k in range(count + 1):
                share = inset + (1.0 - 2.0 * inset) * k / count
                along, direction = begin + share * length, curve.direction(share)
                last = WallPoint(index, along, curve.point(share), direction, wall.h0)
                yield last

    def gouge(self, one: int, other: int) -> tuple[str, str, int]:
        """Return the rule, the code and the line of a refusal."""
        one, other = sorted((one, other))
        rule = (
            f"the tool of radius {number(self.radius)} cannot follow both"
            f" lines {one} and {other}: beside one of them it cuts into the other"
        )
        return rule, self.code, other

    def length_to(self, index: int, point: complex) -> float:
        """Return the length along the contour to a point on one of its moves."""
        return self.ends[index] + self.moves[index].curve.length_to(point)

    def point_at(self, along: float) -> complex:
        """Return the point at a length along the contour, no farther than where it closes."""
        closing = self.closing
        first = self.ends[closing.first] + closing.start
        last = self.ends[closing.last] + closing.end
        along = min(max(along, first), last)
        index = min(bisect_right(self.ends, along), len(self.moves)) - 1
        move = self.moves[index]
        return move.curve.point(min((along - self.ends[index]) / move.length, 1.0))

    def clearance(self, point: complex) -> tuple[float, bool]:
        """Return a point's distance from the walls, below zero in the material, and ``at_end``.

        ``at_end``: the point is beyond an end of an open contour, where the material is not known.
        """
        near, across, foot = _nearest(self.wall_tree, point)
        ends = () if self.closing.closed else (self.moves[0].start, self.moves[-1].end)
        at_end = any(abs(foot - end) <= SAME_POINT for end in ends)
        return copysign(near, across * self.offset), at_end

    def across(self, point: complex, along: float, span: float) -> float:
        """Return a point's distance to the left of the contour, near a length along it.

        Only the contour within ``span`` of that length is searched.
        """
        first = bisect_right(self.ends, along - span) - 1
        last = bisect_right(self.ends, along + span)
        return _nearest(self._contour_tree, point, lambda k: first <= k < last)[1]

    def is_lead(self, index: int, centre: complex) -> bool:
        """Return whether a move is lead-in or lead-out at a position of the tool's centre."""
        closing, curve = self.closing, self.moves[index].curve
        if not closing.closed or closing.crossing:
            return not closing.first < index < closing.last
        first, last = closing.shares(index, curve)
        share = curve.share_of(centre)
        return first >= last or (first > 0.0 and share <= first) or (last < 1.0 and share >= last)


def compensated_contours(
    contour: Contour, cuts: Sequence[PathOfMove], tolerance: float
) -> Iterator[CompensatedContour]:
    at = 0
    for compensated, group in groupby(cuts, key=lambda cut: cut.compensated):
        own = list(group)
        if compensated:
            ramps = [*cuts[max(at - 1, 0) : at], *cuts[at + len(own) :][:1]]
            yield CompensatedContour(contour, own, ramps, tolerance)
        at += len(own)


def greatest_levels(moves: Sequence[PlaneMove]) -> dict[int, float]:
    """Return the greatest Z of each move, by its index; of repeated ones only the first's index.

    Moves in the air, between a plunge up and a plunge down, are omitted.
    """
    levels: dict[int, float] = {}
    first: dict[tuple[int, ...], int] = {}
    for index in _in_material(moves):
        move = moves[index]
        kept = first.setdefault(in_plane(move), index)
        levels[kept] = max(levels.get(kept, -inf), move.h0, move.h1)
    return levels


def _in_material(moves: Sequence[PlaneMove]) -> Iterator[int]:
    """Yield the indices of the moves that are not in the air."""
    runs: list[list[int]] = [[0]]
    for index in range(1, len(moves)):
        if abs(moves[index].h0 - moves[index - 1].h1) > SAME_POINT:
            runs.append([])
        runs[-1].append(index)
    for k, run in enumerate(runs):
        lifted = k > 0 and moves[run[0]].h0 > moves[run[0] - 1].h1
        lowered = k + 1 < len(runs) and moves[run[-1]].h1 > moves[run[-1] + 1].h0
        if not (lifted and lowered):
            yield from run


def in_plane(move: PlaneMove) -> tuple[int, ...]:
    """Return a key that is equal for moves that are equal in the plane within ``SAME_POINT``."""
    curve = move.curve
    points, sweep = [curve.start, curve.end], 0.0
    if isinstance(curve, Arc):
        points, sweep = [*points, curve.centre], curve.sweep
    values = [axis for point in points for axis in (point.real, point.imag)]
    return tuple(round(value / SAME_POINT) for value in (*values, sweep))


def _nearest(
    tree: BoxTree, point: complex, counts: Callable[[int], bool] = lambda _: True
) -> tuple[float, float, complex]:
    """Return the distance to the nearest curve that counts, the distance to its left, and the foot.

    Of curves that are equally near, the one is chosen from which the point lies farthest to a side.
    """
    near, _ = tree.nearest(point, inf, counts)
    within = near + SAME_POINT
    found = []
    for index in filter(counts, tree.near((point.real, point.imag) * 2, within)):
        curve = tree.curves[index]
        share = curve.share_of(point)
        foot = curve.point(share)
        if abs(point - foot) <= within:
            across = (curve.direction(share).conjugate() * (point - foot)).imag
            found.append((near, across, foot))
    return max(found, key=lambda each: abs(each[1]))


def _level_key(z: float) -> int:
    """Return a Z level in whole steps of ``SAME_POINT``, so that rounding makes no difference."""
    return round(z / SAME_POINT)
