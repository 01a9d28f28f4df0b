# SPDX-License-Identifier: GPL-2.0-or-later
"""A contour with the tool's passes along it, to be compared with others. Program units."""

from __future__ import annotations

from functools import cached_property
from math import copysign, hypot, inf

from g12.compensation.closing import closing_of
from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Contour,
    Line,
    Point,
    direction_at,
    is_move,
    path_length,
)
from g12.compensation.gouge import (
    MEETING,
    RAMP,
    Cut,
    greatest_heights,
    in_plane,
    place_count,
    without_repeats,
)
from g12.compensation.intersect import along_start, nearest_place, part_of_move, place_at
from g12.compensation.nearby import Boxes


class ComparedContour:
    """A contour with the tool's passes along it.

    ``parts``: what of its moves may be cut, by their index; ``heights``: the greatest Z of each.
    ``levels``: the heights at which the contour is cut. ``ways``: the passes, with the index of
    the move that each is for.
    """

    def __init__(
        self, contour: Contour, cuts: list[Cut], ramps: list[Cut], tolerance: float
    ) -> None:
        self.moves = [cut.move for cut in cuts]
        self.tolerance, self.offset = tolerance, self.moves[0].offset
        self.radius = abs(self.offset)
        self.closing = closing_of(self.moves, max(MEETING * tolerance, 2 * contour.closing))
        self.parts, self.heights = {}, {}
        for index, height in sorted(greatest_heights(self.moves).items()):
            first, last = self.closing.part(index, self.moves[index])
            if first < last:
                self.parts[index] = part_of_move(self.moves[index], first, last)
                self.heights[index] = height
        self.levels = {_level(self.moves[index].z1) for index in self.parts}
        ways = [(k, way) for k, cut in enumerate(cuts) for way in cut.path if is_move(way)]
        ways += [(RAMP, way) for ramp in ramps for way in ramp.path if is_move(way)]
        self._all_ways = ways
        self.ways = without_repeats(ways)
        self.signature = self.offset, tuple(dict.fromkeys(map(in_plane, self.moves)))

    def add_level(self, other: ComparedContour) -> None:
        """Take over the heights of a contour that is the same in the plane."""
        for index, height in other.heights.items():
            self.heights[index] = max(height, self.heights.get(index, height))
        self.levels |= other.levels
        self._all_ways += other._all_ways
        self.ways = without_repeats([*self.ways, *other.ways])

    @cached_property
    def first_places(self) -> dict[int, int]:
        """The number of each part's first place; a number is left out where parts do not join."""
        first, following = {}, 0
        for index, part in self.parts.items():
            first[index] = following
            following += place_count(part, self.tolerance) + (index + 1 not in self.parts)
        return first

    @property
    def count(self) -> int:
        """How many places there are."""
        return sum(place_count(part, self.tolerance) for part in self.parts.values())

    @property
    def last_place(self) -> int:
        """The number of the last place."""
        index = max(self.parts)
        return self.first_places[index] + place_count(self.parts[index], self.tolerance) - 1

    @cached_property
    def walls(self) -> Boxes:
        """What may be cut, by its index."""
        return Boxes(list(self.parts.items()))

    @cached_property
    def passes(self) -> Boxes:
        """The passes, by minus their number from 1, which `near_passes` takes for no move's."""
        return Boxes([(-1 - number, way) for number, (_, way) in enumerate(self.ways)])

    @cached_property
    def balls(self) -> list[tuple[Point, float]]:
        """A circle round each pass: centre and radius."""
        return [ball_round(way) for _, way in self.ways]

    @cached_property
    def levels_of(self) -> dict[tuple, set[int]]:
        """The heights of each pass, by its place in the plane."""
        levels: dict[tuple, set[int]] = {}
        for _, way in self._all_ways:
            levels.setdefault(in_plane(way), set()).add(_level(way.z1))
        return levels

    @cached_property
    def whole(self) -> bool:
        """Whether what may be cut goes all round: between air and material it lies everywhere."""
        return self.closing.closed and len(self.parts) == 1 + max(self.parts) - min(self.parts)

    def height_of(self, point: Point) -> tuple[float, bool]:
        """Return how far a point is from the contour, below zero in its material.

        And whether it is beyond an end of an open contour: nobody knows what is there.
        """
        nearest, _ = self.walls.nearest(point, inf, lambda *_: True)
        reach = nearest + SAME_PLACE
        sides = [self._side(move, point) for _, move in self.walls.near((*point, *point), reach)]
        _, across, place = max(
            (side for side in sides if side[0] <= reach), key=lambda side: abs(side[1])
        )
        return copysign(nearest, across), self._is_end(*place)

    def _side(self, move: Line | Arc, point: Point) -> tuple[float, float, Point]:
        """Return how far a point is from a move and to the tool's side of it, and where there."""
        (x, c), (px, pc) = point, nearest_place(move, point)
        tx, tc = direction_at(move, (px, pc))
        across = copysign(1.0, self.offset) * (tx * (c - pc) - tc * (x - px))
        return hypot(x - px, c - pc), across, (px, pc)

    def _is_end(self, x: float, c: float) -> bool:
        """Return whether a place is an end of an open contour."""
        if self.closing.closed:
            return False
        first, last = self.moves[0], self.moves[-1]
        ends = (first.x0, first.c0), (last.x1, last.c1)
        return any(hypot(x - ex, c - ec) <= SAME_PLACE for ex, ec in ends)

    def leads(self, index: int, centre: Point) -> bool:
        """Return whether a pass for a move may be one to lead in or out, at a place of the tool."""
        closing = self.closing
        if not closing.closed or closing.crossing:
            return not closing.first < index < closing.last
        first, last = closing.part(index, self.moves[index])
        at = self._share(index, centre)
        return first >= last or (first > 0.0 and at <= first) or (last < 1.0 and at >= last)

    def _share(self, index: int, centre: Point) -> float:
        """Return at which part of a move the tool is, 0 to 1."""
        move = self.moves[index]
        return along_start(move, nearest_place(move, centre)) / path_length(move)


def ball_round(move: Line | Arc) -> tuple[Point, float]:
    """Return a circle round a move: centre and radius."""
    return place_at(move, 0.5), 0.5 * path_length(move)


def _level(z: float) -> int:
    """Return a height that is the same but for rounding."""
    return round(z / SAME_PLACE)
