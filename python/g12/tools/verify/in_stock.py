# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program does to its stock: rapids and plunges into it, and what it leaves standing.

Lengths are millimetres, areas square millimetres, in machine coordinates; on a lathe those of the
part's face. Only cutters with a diameter count, on a lathe those that cut polar sections; sections
on a cylinder are not compared with the stock.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry
from shapely.ops import split, unary_union

from g12.tools.path.part import Z, is_sideways
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.closed_contour import as_points, is_closed, trimmed
from g12.tools.verify.contour_distance import SAME
from g12.tools.verify.contour_side import area_within
from g12.tools.verify.rapids import LEAST_AREA, SAME_HEIGHT, Circles, Cleared, Collision, dense
from g12.tools.verify.reading.block_words import BlockInMm
from g12.tools.verify.section import stretches_of
from g12.tools.verify.section_paths import Plane
from g12.tools.verify.stock import Stock
from g12.tools.verify.wanted_contour import Element, SectionContour

LEAST_SHARE = 0.01  # of a cutter that plunges into the stock
MOST_POINTS = 60  # of a rapid that are looked at
BEYOND = 10.0  # bars: how far an open contour's ends are drawn on
PROBE = 1e-3  # mm beside a contour


class PlungeIntoStock(NamedTuple):
    """A cutter that goes straight down into the stock: its line, place, and share in it."""

    line: int
    place: tuple[float, float, float]
    share: float


class Standing(NamedTuple):
    """What of a bar stands beyond a section's contour: its first line, the area, the height."""

    line: int
    area: float
    height: float


@dataclass(frozen=True)
class StockFacts:
    """What a program does to its stock, whose top is at ``top``; ``shape`` is seen along Z.

    ``below`` is how far the lowest cut goes below a block, 0 if it does not.
    ``missed`` are the lines of cycles and sections that meet nothing of it, ``aside`` those of
    sections on a cylinder.
    """

    stock: Stock
    shape: BaseGeometry
    top: float
    rapids: tuple[Collision, ...]
    plunges: tuple[PlungeIntoStock, ...]
    standing: tuple[Standing, ...]
    below: float
    missed: tuple[int, ...] = ()
    aside: tuple[int, ...] = ()

    @property
    def bottom(self) -> float | None:
        """Return the height of a block's bottom, None if it is not known."""
        return self.top - self.stock.size[2] if self.stock.size else None


class InStock:
    """A program in its stock, by its pockets, its sections, its moves and their tools."""

    def __init__(
        self,
        stock: Stock,
        circles: Circles,
        sections: Sequence[SectionContour],
        moves: Sequence[Move],
        path: Track,
        diameters: dict[int, float],
    ) -> None:
        self._aside = tuple(each.line for each in sections if each.surface)
        sections = [each for each in sections if not each.surface]
        zero = zero_of(circles, sections, moves)
        self.cleared = Cleared(circles, moves, path, diameters)
        self.shape = stock.shape(zero, [target.wall for _, target in circles])
        self.top = float(zero[2])
        self._stock, self._moves, self._path = stock, moves, path
        tools = {moves[each.at].tool for each in sections}
        self._own = [
            index
            for index in range(1 + first_down(moves), len(moves))
            if self.cleared.radius(index) and (not stock.diameter or moves[index].tool in tools)
        ]
        self._sections = sections
        self._cuts = [(each.line, each) for each in sections]
        self._cuts += [(target.source.line, block) for block, target in circles]

    def facts(self, known: Sequence[Collision]) -> StockFacts:
        """Return what happens to the stock but for the rapids that are known."""
        told = {hit.move for hit in known}
        rapids = (self._hit(index) for index in self._own if index not in told)
        plunges: dict[int, PlungeIntoStock] = {}
        for plunge in filter(None, map(self._plunge, self._own)):
            plunges.setdefault(plunge.line, plunge)
        standing = tuple(self._standing()) if self._stock.diameter else ()
        lowest = min((self._moves[index].end[Z] for index in self._own), default=self.top)
        found = tuple(filter(None, rapids)), tuple(plunges.values()), standing
        facts = StockFacts(self._stock, self.shape, self.top, *found, 0.0)
        below = 0.0 if facts.bottom is None else max(0.0, facts.bottom - lowest)
        return replace(facts, below=below, missed=tuple(self._missed()), aside=self._aside)

    def _bite(self, index: int, point: np.ndarray) -> BaseGeometry:
        """Return what of the stock is under a move's cutter there, not cleared before."""
        cutter = Point(point[:2]).buffer(self.cleared.radius(index)).intersection(self.shape)
        if point[2] > self.top - SAME_HEIGHT or cutter.area < LEAST_AREA:
            return Polygon()
        return cutter.difference(self.cleared.before(index, point[2]))

    def _hit(self, index: int) -> Collision | None:
        move = self._moves[index]
        if move.kind != "rapid" or (not is_sideways(move) and move.end[Z] > move.start[Z]):
            return None
        points = dense(self._path, move)
        points = points[:: len(points) // MOST_POINTS + 1]
        bites = [(point, self._bite(index, point)) for point in [*points, points[-1]]]
        bites = [(point, bite) for point, bite in bites if bite.area > LEAST_AREA]
        area = unary_union([bite for _, bite in bites]).area if bites else 0.0
        places = np.array([point for point, _ in bites])
        return Collision(index, self._line(move), area, places) if bites else None

    def _plunge(self, index: int) -> PlungeIntoStock | None:
        move = self._moves[index]
        if move.kind == "rapid" or is_sideways(move) or move.end[Z] >= move.start[Z]:
            return None
        place = self._path.part.points(np.array(move.end))[0]
        share = self._bite(index, place).area / Point(0, 0).buffer(self.cleared.radius(index)).area
        found = PlungeIntoStock(self._line(move), tuple(map(float, place)), share)
        return found if share > LEAST_SHARE else None

    def _line(self, move: Move) -> int:
        """Return the program's line of a move; a cycle's own lines are in its subroutine."""
        in_cycle = move.remap and all(move.remap != each.code for each in self._sections)
        return move.block if in_cycle else move.line

    def _missed(self) -> Iterator[int]:
        """Yield the lines of cycles and sections that meet nothing of the stock."""
        for line, each in self._cuts:
            own = [
                index
                for index in range(each.at, each.end)
                if self.cleared.radius(index) and self._moves[index].end[Z] < self.top
            ]
            if self.cleared.of(own).intersection(self.shape).area < LEAST_AREA:
                yield line

    def _standing(self) -> Iterator[Standing]:
        for section in self._sections:
            own = range(section.at, section.end)
            height = min(self._moves[index].end[Z] for index in own)
            plane = Plane(section, self._moves[section.at])
            asked = (beyond(stretch, plane, self.shape) for stretch in stretches_of(section))
            in_air = height > self.top - SAME_HEIGHT
            cleared = Polygon() if in_air else self.cleared.before(len(self._moves), height)
            left = unary_union([area for area in asked if area]).difference(cleared)
            if left.area > LEAST_AREA:
                yield Standing(section.line, left.area, height)


def zero_of(
    circles: Circles, sections: Sequence[SectionContour], moves: Sequence[Move]
) -> np.ndarray:
    """Return the program's zero where it first cuts; on a lathe X is that of the spindle.

    A section on a cylinder tells nothing of it.
    """
    for section in (each for each in sections if not each.surface):
        return np.array([0.0, 0.0, moves[section.at].start[Z] - section.height])
    for block, _ in circles:
        return BlockInMm(block, moves[block.at]).zero()
    return np.zeros(3)


def first_down(moves: Sequence[Move]) -> int:
    """Return the first move that changes Z: before it the tool is wherever a trace begins."""
    return next((i for i, move in enumerate(moves) if move.start[Z] != move.end[Z]), 0)


def beyond(stretch: Sequence[Element], plane: Plane, bar: BaseGeometry) -> BaseGeometry | None:
    """Return what of a bar lies on the tool's side of a contour that it is to be cut away to.

    None where the tool works inside of a closed contour, or without compensation.
    """
    contour = [element for element in trimmed(stretch) if element.length > SAME]
    side = stretch[0].side
    if not side or not contour:
        return None
    points = plane.on_part(np.concatenate([as_points(element) for element in contour]))
    if is_closed(contour):
        inside = (area_within(points) > 0.0) == (side > 0)
        return None if inside else bar.difference(Polygon(vectors(points)).buffer(0))
    points = points[np.append(True, np.abs(np.diff(points)) > SAME)]
    along = np.diff(points) / np.abs(np.diff(points))
    middles = (points[:-1] + points[1:]) / 2 + 1j * side * along * PROBE
    probe = middles[np.abs(middles).argmin()]
    reach = BEYOND * float(np.abs(np.array(bar.bounds)).max())
    ends = points[0] - along[0] * reach, points[-1] + along[-1] * reach
    edge = vectors(np.array([ends[0], *points, ends[1]]))
    pieces = split(bar, LineString(edge)).geoms
    near = [piece for piece in pieces if piece.contains(Point(probe.real, probe.imag))]
    return unary_union(near) if len(pieces) > 1 else None


def vectors(points: np.ndarray) -> list[tuple[float, float]]:
    """Return complex points as pairs."""
    return [(point.real, point.imag) for point in points]
