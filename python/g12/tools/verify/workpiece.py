# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program is cut from: a stock that is given, or what its pockets and sections assume.

Each view of the part has a material of its own: the plane XY of a mill or the face of a lathe, and
every cylinder whose unrolled surface is cut. Lengths are mm in machine coordinates.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import groupby
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, box
from shapely.geometry.base import BaseGeometry

from g12.tools.material.material import SAME_LEVEL, Material, Opening, Solid
from g12.tools.material.stock import Stock, StockText, read_stock
from g12.tools.path.part import FLAT, Part, Z, disc, is_sideways, part_of
from g12.tools.path.surface import Surface
from g12.tools.preview.moves import Move
from g12.tools.units import plain, unit_of
from g12.tools.verify.compare.plane import plane_of
from g12.tools.verify.subject import Subject
from g12.tools.verify.walls import (
    FAR,
    AssumedHole,
    SurfaceKey,
    approached,
    assume_holes,
    flat_circles,
    solids_of_circles,
    solids_of_holes,
    solids_of_sections,
)

CHUNK = 32  # moves of a lathe whose area is worked out at once
SAMPLED = 1e-4  # how far a run's motion may be off, drawn with fewer points


class PartView(NamedTuple):
    """The part as tools see it that point at its plane or surface, and its material there."""

    part: Part
    material: Material

    @property
    def surface(self) -> float:
        """The radius of a cylinder, 0 of a plane."""
        return self.part.radius if isinstance(self.part, Surface) else 0.0

    def meets(self, subject: Subject, index: int) -> bool:
        """Tell whether the tool of a move points at it."""
        return subject.sideways[index] == {self.surface > 0.0}

    def words(
        self, subject: Subject, index: int, point: Sequence[float]
    ) -> tuple[tuple[str, float | str], ...]:
        """Return a point of a move as words: X Y Z of a mill, X C Z of a lathe.

        In a section on the face they are the section's own.
        """
        if not self.part.turning:
            return tuple(zip("XYZ", point))
        for section in subject.commanded.on_face:
            if section.at <= index < section.end:
                plane = plane_of(section, subject.moves[section.at])
                at = complex(plane.points(np.array([point]))[0])
                return plane.words((at, point[2] - plane.base), section.diameters)
        if self.surface:
            around, along, level = point
            x, c, z = level - self.part.centre, math.degrees(around / self.surface), along
        else:
            x, z, c = math.hypot(*point[:2]), point[2], math.degrees(math.atan2(point[1], point[0]))
        factor = 2 if subject.commanded.in_diameters(index) else 1
        return ("X", factor * x), ("C", plain(c, 3)), ("Z", z)


@dataclass(frozen=True)
class Workpiece:
    """The material that a program cuts, and the holes that were assumed in it.

    ``shape`` and ``top`` are those of the given ``stock``.
    """

    subject: Subject
    views: Sequence[PartView]
    holes: Sequence[AssumedHole] = ()
    stock: Stock | None = None
    shape: BaseGeometry | None = None
    top: float = 0.0

    @property
    def material(self) -> Material:
        return self.views[0].material

    def top_in(self, view: PartView) -> float:
        """Return the level below which material may be, beside that of a view, too."""
        return max(view.material.top, -math.inf if view.surface else self._z0)

    @cached_property
    def _z0(self) -> float:
        """The highest Z0 of the circles."""
        walls = [target.wall for _, target in flat_circles(self.subject)]
        return max((wall.face for wall in walls), default=-math.inf)

    @property
    def bottom(self) -> float | None:
        """The level of a block's bottom, None if it is not known."""
        return self.top - self.stock.size[Z] if self.stock and self.stock.size else None


def workpiece_of(subject: Subject, text: StockText | None) -> Workpiece:
    """Return what a program is cut from, assumed where no stock is given.

    Raises UsageError for a text that is no stock of the machine's.
    """
    if text is None:
        return assumed_workpiece(subject)
    unit = unit_of(subject.trace.modes.gcodes, text.units)
    return _given_workpiece(subject, read_stock(text.text, part_of(subject.ini).turning, unit))


def assumed_workpiece(subject: Subject) -> Workpiece:
    """Return what a program's words assume that it is cut from."""
    face, cylinders = solids_of_sections(subject)
    face += [*solids_of_circles(approached(subject)), *solids_of_holes(subject)]
    view = _view(subject, subject.part, face)
    holes = assume_holes(subject, view.material)
    return Workpiece(subject, [view, *_cylinder_views(subject, cylinders)], holes)


def _given_workpiece(subject: Subject, stock: Stock) -> Workpiece:
    """Return the stock; of a bore alone the pockets are known to be in something."""
    zero, walls = subject.zero, [target.wall for _, target in flat_circles(subject)]
    top = float(zero[Z])
    pockets = [(wall.origin, wall.radius) for wall in walls if wall.inside]
    shape = stock.shape(zero, subject.rotation, pockets)
    assumed = list(solids_of_circles(approached(subject)))
    apart = [each for each in assumed if each.shape.disjoint(shape)]  # in another part
    solids, bores = [Solid(shape, top), *apart], []
    if not stock.is_whole:
        solids = assumed
        bores = [Opening(disc(wall.origin, stock.bore / 2)) for wall in walls]
    views = [_view(subject, subject.part, solids, bores)]
    views += _cylinder_views(subject, solids_of_sections(subject)[1])
    if stock.diameter:
        views.append(_bar_from_side(subject, stock.diameter / 2))
    return Workpiece(subject, views, (), stock, shape, top)


def _cylinder_views(
    subject: Subject, cylinders: Mapping[SurfaceKey, Iterable[Solid]]
) -> Iterator[PartView]:
    for key, solids in cylinders.items():
        part = Surface(turning=True, centre=key.face - key.radius, radius=key.radius)
        yield _view(subject, part, solids)


def _bar_from_side(subject: Subject, radius: float) -> PartView:
    """Return a bar as the tools see it that point at its axis."""
    part = Surface(turning=True, centre=subject.part.centre, radius=radius)
    whole = Solid(box(-FAR, -FAR, FAR, subject.z0), part.centre + radius)
    return _view(subject, part, [whole], _cut_from_face(subject, radius))


def _cut_from_face(subject: Subject, radius: float) -> Iterator[Opening]:
    """Yield what tools along Z may cut of a bar: all of it down to there.

    All of it where the cutter is not known.
    """
    lowest = subject.z0
    for index, move in enumerate(subject.moves):
        cutter, level = subject.cutter(index), min(move.start[Z], move.end[Z])
        reached = math.hypot(*subject.ends[index, :2]) - cutter < radius - SAME_LEVEL
        cuts = move.kind != "rapid" and subject.sideways[index] != {True} and reached
        if cuts and move.end[Z] < subject.z0 - SAME_LEVEL and level < lowest - SAME_LEVEL:
            lowest = level if cutter else -FAR
            yield Opening(box(-FAR, lowest, FAR, FAR), since=index, perhaps=True)


def _view(
    subject: Subject, part: Part, solids: Iterable[Solid], openings: Iterable[Opening] = ()
) -> PartView:
    """Return a view of the part with what the program cuts of it.

    A cutter that is not known counts as the widest.
    """
    moves, period = subject.moves, 2 * math.pi * getattr(part, "radius", 0.0)
    view = PartView(part, Material(solids, openings, period))
    kind = partial(_kind_of_cut, part, moves, [block.at for block, _ in subject.commanded.circles])
    for (rapid, level, *_), group in groupby(range(len(moves)), kind):
        own = list(group)
        if rapid or (view.surface and not view.meets(subject, own[0])):
            continue
        cutter = subject.cutter(own[0]) or subject.widest_cutter
        points = partial(_points_along, subject, part, own)
        if level is None:
            view.material.cut(own[-1], points(), cutter)
        else:
            bounds = _bounds_of_level([moves[index] for index in own])
            draw = partial(_across, points, subject.real is not None)
            view.material.cut_level(own[-1], bounds, level, draw, cutter)
    return view


def _kind_of_cut(part: Part, moves: Sequence[Move], circles: Sequence[int], index: int) -> tuple:
    """Return what the moves of one cut have in common: rapid or not, their level, and more.

    The level is None where it may change. ``circles`` are the first moves of the cycles, of which
    one sub may have several.
    """
    move = moves[index]
    rapid = move.kind == "rapid"
    if part.turning:
        return rapid, None, move.tool, is_sideways(move), index // CHUNK, move.block
    if move.start[Z] != move.end[Z] or move.plane != FLAT:
        return rapid, None, index
    return rapid, move.end[Z], move.tool, move.block, bisect_right(circles, index)


def _points_along(subject: Subject, part: Part, own: Sequence[int]) -> np.ndarray:
    return np.concatenate([subject.points(index, part) for index in own])


def _across(points: Callable[[], np.ndarray], sampled: bool) -> np.ndarray:
    """Return points without their level, of a run no more than are needed."""
    drawn = points()[:, :2]
    many = sampled and len(drawn) > 2
    return np.array(LineString(drawn).simplify(SAMPLED).coords) if many else drawn


def _bounds_of_level(moves: Sequence[Move]) -> tuple[float, ...]:
    """Return the bounds of moves in the plane XY; an arc counts as its circle."""
    ends = [place[:2] for move in moves for place in (move.start, move.end)]
    for move in moves:
        if move.kind == "arc":
            x, y, _ = move.centre
            reach = max(move.radius, math.dist(move.end[:2], (x, y)))
            ends += [(x - reach, y - reach), (x + reach, y + reach)]
    low, high = np.min(ends, axis=0), np.max(ends, axis=0)
    return (*map(float, low), *map(float, high))
