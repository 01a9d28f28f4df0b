# SPDX-License-Identifier: GPL-2.0-or-later
"""What a pocket's toolpath leaves uncut at its deepest level. Lengths mm, areas mm²."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from shapely.geometry.base import BaseGeometry

from g12.geometry.curve import Line
from g12.tools.path.part import disc, swept
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.pocket_cover import FINE, SECTORS, Span, clears
from g12.tools.verify.reading.circles import Cutter, Target, Wall
from g12.tools.verify.result.tolerances import LEVEL, WEAR

ROUND = 4e-6  # chord error of an arc with radius 1, so that every sector gets a point
DECIMALS = 6

Known = dict[tuple, float]


def cutting_radius(cutter: Cutter) -> float:
    """Return the radius of the cutter that cuts: the loaded one, if it is surely not that of D."""
    return cutter.loaded if is_wrong_tool(cutter) else cutter.radius


def is_wrong_tool(cutter: Cutter) -> bool:
    """Tell whether D names another cutter than the loaded one, by more than wear."""
    known = cutter.named is not None and cutter.loaded > 0.0
    return known and abs(cutter.radius - cutter.loaded) > WEAR * cutter.loaded


def _moves_on_floor(path: Sequence[Expected]) -> list[Expected]:
    """Return the moves at feed at the deepest level."""
    deepest = min(move.end_level for move in path)
    flat = (move for move in path if move.start_level == move.end_level and not move.rapid)
    return [move for move in flat if move.end_level - deepest < FINE]


def uncut_area(target: Target, tolerance: float, known: Known) -> float:
    """Return what the expected toolpath leaves; ``known`` are pockets like it, by their paths."""
    floor, cutter = _moves_on_floor(target.path), cutting_radius(target.cutter)
    wall = target.wall
    key = (wall.radius, wall.cleared, cutter, *map(_key, floor))
    if key not in known:
        known[key] = area_left(wall, cutter, [polyline(move) for move in floor], tolerance)
    return known[key]


def _key(move: Expected) -> tuple:
    curve = move.curve
    points = [curve.start, *((curve.end,) if isinstance(curve, Line) else (curve.centre,))]
    sizes = [getattr(curve, "sweep", 0.0), *(part for p in points for part in (p.real, p.imag))]
    return tuple(round(size, DECIMALS) + 0.0 for size in sizes)


def polyline(move: Expected) -> np.ndarray:
    """Return points (n, 2) along an expected move."""
    curve = move.curve
    if isinstance(curve, Line):
        return np.array([[p.real, p.imag] for p in (curve.start, curve.end)])
    error = min(FINE, ROUND * curve.radius) / curve.radius
    count = int(np.ceil(abs(curve.sweep) / np.sqrt(8 * error))) + 1
    turned = np.exp(1j * np.linspace(0.0, curve.sweep, count + 1))
    points = curve.centre + (curve.start - curve.centre) * turned
    return np.stack([points.real, points.imag], axis=1)


def area_left(wall: Wall, cutter: float, lines: Sequence[np.ndarray], tolerance: float) -> float:
    """Return the area of what paths leave standing; see ``left_of``."""
    if not cutter or clears(lines, cutter, wanted_of(wall, cutter, tolerance)):
        return 0.0
    return left_of(wall, cutter, swept(lines, cutter), tolerance).area


def wanted_of(wall: Wall, cutter: float, tolerance: float) -> Span:
    """Return between which distances from the centre nothing may be left."""
    if wall.inside:
        return wall.cleared + tolerance, wall.radius - tolerance
    return wall.radius + tolerance, wall.radius + 2 * cutter - tolerance


def left_of(wall: Wall, cutter: float, floor: BaseGeometry, tolerance: float) -> BaseGeometry:
    """Return what is left standing at the deepest level, beyond the tolerance."""
    return ring(*wanted_of(wall, cutter, tolerance)).difference(floor)


def ring(inner: float, outer: float) -> BaseGeometry:
    """Return the area between two circles about the centre."""
    area = disc((0, 0), outer, FINE)
    return area.difference(disc((0, 0), inner, FINE)) if inner > 0.01 else area


def uncut_in_run(target: Target, lines: Sequence[np.ndarray], tolerance: float) -> float:
    """Return what a run leaves; ``lines`` (n, 3) are its motion at the deepest level."""
    lines = [densified(line) for line in lines if len(line)]
    return area_left(target.wall, cutting_radius(target.cutter), lines, tolerance)


def densified(line: np.ndarray) -> np.ndarray:
    """Return a polyline with points so close together that every sector gets one."""
    most = np.pi / SECTORS * max(np.hypot(*line[:, :2].T).max(), LEVEL)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    places = np.union1d(along, np.linspace(0.0, along[-1], int(along[-1] / most) + 2))
    return np.stack([np.interp(places, along, axis) for axis in line.T], axis=1)
