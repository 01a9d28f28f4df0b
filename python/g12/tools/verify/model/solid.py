# SPDX-License-Identifier: GPL-2.0-or-later
"""The one material of a program: the stock, given or assumed, less what its feed moves remove.

Assumed is solid material below the program's Z0: on a mill everywhere, on a lathe a bar as thick
as what is programmed on it. A lathe's cylinders are materials of their own: the face does not know
of them.
"""

import math
from collections.abc import Iterable
from functools import cached_property
from itertools import groupby

import numpy as np
from shapely.geometry import box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.cut_report import PolygonCut
from g12.tools.material.material import Material, Ring
from g12.tools.material.stock import Stock
from g12.tools.path.part import FLAT, Z, disc, swept
from g12.tools.preview.moves import Move
from g12.tools.verify.model.cut import NOTHING, Cut
from g12.tools.verify.model.program import TracedProgram

MARGIN = 50.0  # mm around everything that moves
FACE = 0.0
JUST_ABOVE = 0.02  # of a floor: where material is looked for
NEAR = 0.5  # mm around a tool's tip
ALONG = 1.0  # mm beside what is cut on a cylinder
LONG = 2000.0  # mm: a bar
FULL_TURN = 2 * math.pi - 1e-6


class Solids:
    """The materials of a program by the side that a tool works on.

    ``given_bar`` is the radius of the bar that is given, 0 without one; ``face`` is the level of
    the top.
    """

    def __init__(self, program: TracedProgram, stock: Stock | None) -> None:
        self.program, self.stock, self.z0 = program, stock, program.z0
        self.given_bar = stock.diameter / 2 if stock else 0.0
        self.face = self.z0 + (stock.top if stock else 0.0)
        self.bottom = self.face - stock.size[2] if stock and stock.size else -math.inf
        self._materials: dict[float, Material] = {}
        for side in {FACE, *(cut.surface for cut in program.cuts)}:
            shape = self._stock(side, stock)
            self._materials[side] = Material(shape, self.top(side), period=2 * math.pi * side)
        self._cut_all()

    # ------------------------------------------------------------ the stock

    def top(self, side: float) -> float:
        return (self.given_bar or side) if side else self.face

    @cached_property
    def bar(self) -> float:
        """The radius of the bar: the given one, else the smallest that holds what is programmed."""
        needed = (needed_bar(cut) for cut in self.program.cuts if cut.at < cut.end)
        return self.given_bar or max(needed, default=0.0)

    def _stock(self, side: float, stock: Stock | None) -> BaseGeometry:
        program = self.program
        if side:
            above = program.is_round or (not stock and self._above_face(side))
            return box(0.0, -LONG, 2 * math.pi * side, LONG if above else self.z0)
        if program.is_round and all(cut.surface for cut in program.cuts):
            return NOTHING
        if program.turning:
            return disc((0.0, 0.0), self.bar) if self.bar else NOTHING
        pockets = [(c.centre, c.wall) for c in program.cuts if c.is_circle and not c.upright]
        if stock and stock.is_whole:
            turned = program.cuts[0].frame.rotation if program.cuts else 0.0
            return stock.shape(np.array(program.zero), turned, pockets)
        ends = np.array([move.end[:2] for move in program.moves] or [(0.0, 0.0)])
        wide = MARGIN + max((wall for _, wall in pockets), default=0.0)
        bores = [disc(centre, stock.bore / 2) for centre, _ in pockets] if stock else []
        whole = box(*(ends.min(axis=0) - wide), *(ends.max(axis=0) + wide))
        return whole.difference(unary_union([NOTHING, *bores]))

    def _above_face(self, side: float) -> bool:
        """Return whether all that is cut on a cylinder is above Z0: that is not the part's face."""
        cuts = [cut for cut in self.program.cuts if cut.surface == side]
        low = (self.program.tip(i, side)[:, 1].min() + cut.radius for cut in cuts for i in cut.fed)
        return bool(min(low, default=math.inf) + ALONG >= self.z0)

    def of(self, side: float) -> Material:
        return self._materials[side]

    # ------------------------------------------------------------ what is made

    def _cut_all(self) -> None:
        """Remove what each stretch at feed sweeps, full circles one by one."""
        program = self.program
        for run, rapid, _, sides, radius, _ in program.stretches:
            if rapid or not sides or radius <= 0:
                continue
            side = max(sides)
            material = self._materials[side]
            circles = groupby(run, lambda index: is_circle(program.moves[index]) and index)
            for circle, own in circles:
                ring = circle and self._ring(circle, radius, run[-1])
                if ring:
                    material.cut_ring(ring)
                    continue
                for piece in pieces(program.tips(list(own), side)):
                    material.cut(run[-1], piece, radius)

    def _ring(self, index: int, radius: float, last: int) -> Ring | None:
        """Return a full circle at one level, as it is commanded on a mill."""
        program, move = self.program, self.program.moves[index]
        if program.turning or program.real or move.start[Z] != move.end[Z]:
            return None
        level = move.start[Z] - program.tip_beyond(index)[Z]
        return Ring(move.centre[:2], move.radius, radius, level, last)

    def standing(
        self, region: BaseGeometry, level: float, side: float, before: float = math.inf
    ) -> BaseGeometry:
        """Return what stands in a region just above a level."""
        return self._materials[side].standing(region, level + JUST_ABOVE, before)

    def is_met(self, cut: Cut) -> bool:
        """Return whether a cut is over the stock or in it."""
        material, program = self._materials[cut.surface], self.program
        lines = (program.tip(i, cut.surface)[:, :2] for i in cut.fed)
        return any(material.is_under(line, cut.radius) for line in lines)

    def surrounds(self, tip: np.ndarray, radius: float, side: float) -> bool:
        """Return whether a tool's tip is below the top, inside of what the stock was."""
        around = disc(tip[:2], radius + NEAR)
        return self._materials[side].surrounds(around, float(tip[2]))

    def swept_in(
        self, region: BaseGeometry, moves: Iterable[int], side: float
    ) -> tuple[BaseGeometry, int | None]:
        """Return what of a region moves at feed sweep below the top, and the first one's index."""
        first, areas = None, []
        for index in moves if not region.is_empty else ():
            stretch = self.program.stretch_at(index)
            if stretch.is_rapid or stretch.sides != {side}:
                continue
            points, radius = self.program.tip(index, side), stretch.radius
            low = np.minimum(points[1:, 2], points[:-1, 2]) < self.top(side) - JUST_ABOVE
            for at in np.flatnonzero(low) if radius > 0 else ():
                area = swept([points[at : at + 2]], radius).intersection(region)
                if not area.is_empty:
                    areas.append(area)
                    first = index if first is None else first
        return unary_union([NOTHING, *areas]), first


def is_circle(move: Move) -> bool:
    return move.kind == "arc" and move.plane == FLAT and abs(move.sweep) > FULL_TURN


def pieces(points: np.ndarray) -> list[np.ndarray]:
    """Return a path (n, 3) without its vertical portions, of which the lower ends count."""
    upright = np.abs(np.diff(points[:, :2], axis=0)).max(axis=1, initial=0.0) < 1e-6
    found = np.split(points, 1 + np.flatnonzero(upright))
    return [piece for piece in found if len(piece) > 1 or len(found) > 1 or len(points) == 1]


def needed_bar(cut: Cut) -> float:
    """Return the radius of the smallest bar that can hold a cut on a face."""
    if cut.surface:
        return 0.0
    if isinstance(cut.plan, PolygonCut):
        return cut.plan.stock_diameter * cut.mm / 2
    if cut.is_shape:
        return max(map(abs, cut.goes.bounds))
    if cut.places:
        return max(map(abs, cut.places)) + cut.radius + 1.0
    ends = [np.abs(outline.points) for outline in cut.outlines]
    reach = (at.max() if o.is_closed else min(at[0], at[-1]) for o, at in zip(cut.outlines, ends))
    return float(max(reach, default=cut.deep_reach))


def reachable(region: BaseGeometry, radius: float) -> BaseGeometry:
    """Return what a round cutter can remove of a region without leaving it."""
    return region.buffer(-radius, 32).buffer(radius, 32)
