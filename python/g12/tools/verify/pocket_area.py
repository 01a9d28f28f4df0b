# SPDX-License-Identifier: GPL-2.0-or-later
"""What of a pocket's material remains uncut at its deepest level. Lengths mm, areas mm²."""

from __future__ import annotations

from collections.abc import Iterator

from shapely.affinity import translate
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from g12.geometry.curve import Arc
from g12.tools.material.material import Material
from g12.tools.path.part import Z, disc
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.reading.circles import Cutter, Target
from g12.tools.verify.result.tolerances import WEAR

FINE = 1e-5  # chord error of the circles about a pocket's centre
LEAST_CORE = 0.01  # a smaller circle about the centre is none
NOTHING = Polygon()


def is_wrong_tool(cutter: Cutter) -> bool:
    """Tell whether D names another cutter than the loaded one, by more than wear."""
    known = cutter.named is not None and cutter.loaded > 0.0
    return known and abs(cutter.radius - cutter.loaded) > WEAR * cutter.loaded


def cutting_radius(cutter: Cutter) -> float:
    """Return the radius of the cutter that cuts: the loaded one, if it is surely not that of D."""
    return cutter.loaded if is_wrong_tool(cutter) else cutter.radius


def uncut(
    block: Block, target: Target, material: Material, tolerance: float, as_emitted: bool
) -> BaseGeometry:
    """Return what remains of a pocket after its block, in machine coordinates of the plane XY.

    ``as_emitted``: its circles are those of its moves, not what a run made of them.
    """
    wall = target.wall
    if wall.plane != Z or not target.cutter.radius or (as_emitted and clears(target, tolerance)):
        return NOTHING
    wanted = translate(region(target, tolerance), *wall.origin[:2])
    return material.standing(wanted, wall.height(target.deepest), block.end)


def region(target: Target, tolerance: float) -> BaseGeometry:
    """Return the area about the centre in which nothing may remain."""
    inner, outer = reach(target, tolerance)
    area = disc((0, 0), outer, FINE)
    return area.difference(disc((0, 0), inner, FINE)) if inner > LEAST_CORE else area


def reach(target: Target, tolerance: float) -> tuple[float, float]:
    """Return between which distances from the centre nothing may remain.

    D may be larger than the cutter by an allowance for wear.
    """
    wall, cutter = target.wall, target.cutter
    if not wall.inside:
        return wall.radius + tolerance, wall.radius + 2 * cutter.radius - tolerance
    worn = 0.0 if is_wrong_tool(cutter) else max(0.0, cutter.radius - cutter.loaded)
    return wall.cleared + tolerance, wall.radius - tolerance - worn * bool(cutter.loaded)


def clears(target: Target, tolerance: float) -> bool:
    """Tell whether the circles of the deepest level surely leave nothing, by distances alone."""
    at, end = reach(target, tolerance)
    for first, last in sorted(_cleared(target)):
        at = max(at, last) if first <= at else at
    return at >= end


def _cleared(target: Target) -> Iterator[tuple[float, float]]:
    """Yield between which distances from the centre everything is cut at the deepest level."""
    cutter = cutting_radius(target.cutter)
    flat = [move for move in target.path if move.start_level == move.end_level]
    floor = [move for move in flat if not move.rapid and move.end_level == target.deepest]
    if any(abs(move.curve.start) < FINE for move in floor):
        yield 0.0, cutter
    for move in target.circles:
        if move.end_level == target.deepest and isinstance(move.curve, Arc):
            radius = move.curve.radius
            yield (radius - cutter if radius > cutter else 0.0), radius + cutter
