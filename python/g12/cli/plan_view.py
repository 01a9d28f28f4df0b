# SPDX-License-Identifier: GPL-2.0-or-later
"""The view along the tool's axis, of a mill's part or of a lathe's face: swept floors and paths.

Lengths are millimetres until they are drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from shapely.affinity import scale as scaled
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.cli import pictures
from g12.cli.motion import Worst, worst_of
from g12.cli.part import Part, is_sideways, paths, swept
from g12.cli.pictures import Shade
from g12.cli.scene import Scene
from g12.cli.trace import Move
from g12.cli.units import plain

PICTURE_CHORD = 0.01
SAME_DEPTH = 1e-3
MOST_LEVELS = 10  # with more, depths and feeds are shown in bands
BANDS = 24
MOST_ARROWS = 80
MANY = 20_000  # moves
LONG = 0.12  # of the view's smaller side: shorter moves get no arrow
MARGIN = 0.05  # of the view's greater side
PLUNGE, CUTTER = 3.5, 8.0  # points


class Level(NamedTuple):
    """What is milled at one depth: colours, paths (n, 3) and the area swept."""

    z: float
    shade: Shade
    lines: list[np.ndarray]
    area: BaseGeometry


def levels_of(scene: Scene) -> list[Level]:
    """Return the depths milled or drilled, from the top down; with many, in bands."""
    cutting = [move for move in scene.moves if move.kind != "rapid" and removes(move)]
    if not cutting:
        return []
    depth = np.array([min(move.start[2], move.end[2]) for move in cutting])
    found = sorted(set(np.round(depth / SAME_DEPTH) * SAME_DEPTH), reverse=True)
    if len(found) > MOST_LEVELS:
        found = list(np.linspace(depth.max(), depth.min(), BANDS))
    nearest = np.abs(np.subtract.outer(depth, found)).argmin(axis=1)
    groups = [[cutting[i] for i in np.flatnonzero(nearest == level)] for level in range(len(found))]
    part = scene.path.part
    return [
        Level(z, shade, milled(part, group), swept_by(part, group, scene.diameters))
        for z, shade, group in zip(found, pictures.shades(len(found)), groups)
        if group
    ]


def removes(move: Move) -> bool:
    """Tell whether a move at feed goes sideways or down."""
    return is_sideways(move) or move.end[2] < move.start[2]


def milled(part: Part, moves: Sequence[Move]) -> list[np.ndarray]:
    """Return the paths of the moves that go sideways."""
    return paths(part, [move for move in moves if is_sideways(move)], PICTURE_CHORD)


def swept_by(part: Part, moves: Sequence[Move], diameters: dict[int, float]) -> BaseGeometry:
    """Return the area that the cutters of moves sweep."""
    areas = []
    for tool in {move.tool for move in moves}:
        lines = paths(part, [move for move in moves if move.tool == tool], PICTURE_CHORD)
        areas.append(swept(lines, max(diameters.get(tool, 0.0) / 2, PICTURE_CHORD)))
    return unary_union(areas)


def bounds_of(scene: Scene, levels: Sequence[Level]) -> tuple[np.ndarray, np.ndarray]:
    """Return least and greatest X, Y and Z of what is cut, with a margin; rapids don't count."""
    cutting = [move for move in scene.moves if move.kind != "rapid"] or scene.moves
    ends = np.array([point for move in cutting for point in (move.start, move.end)])
    points = scene.path.part.points(ends)
    low, high = points.min(axis=0), points.max(axis=0)
    for level in levels:
        bounds = level.area.bounds
        low[:2], high[:2] = np.minimum(low[:2], bounds[:2]), np.maximum(high[:2], bounds[2:])
    high[2] = max(high[2], top_of(scene))
    size = high - low
    margin = np.clip(MARGIN * max(size[:2]), PICTURE_CHORD, np.maximum(0.15 * size, PICTURE_CHORD))
    margin[2] = max(0.12 * size[2], 0.2 * min(margin[:2]))
    return low - margin, high + margin


def top_of(scene: Scene) -> float:
    """Return the top of the part: Z0 if the tool goes down through it, else where it feeds from."""
    cutting = [move for move in scene.moves if move.kind != "rapid"] or scene.moves
    lowest = min(min(move.start[2], move.end[2]) for move in cutting)
    highest = max(max(move.start[2], move.end[2]) for move in scene.moves)
    if lowest < 0 < highest:
        return 0.0
    return max(max(move.start[2], move.end[2]) for move in cutting)


def draw_plan(axes: Axes, scene: Scene, levels: Sequence[Level]) -> None:
    """Draw the view along the tool's axis."""
    unit = scene.unit.mm
    for order, level in enumerate(levels):
        area = scaled(level.area, 1 / unit, 1 / unit, origin=(0, 0))
        pictures.fill(axes, area, *floor(scene, level), 1 + order / 100)
    draw_paths(axes, scene, levels, [0, 1])
    draw_plunges(axes, scene)
    draw_arrows(axes, scene)


def floor(scene: Scene, level: Level) -> tuple:
    """Return the fill and the outline of a level's area; grey where colours tell feeds."""
    if scene.feed_colours:
        return pictures.grey(level.shade.floor), pictures.RAPID
    return level.shade.floor, pictures.tint(level.shade.line, 0.35)


def draw_paths(axes: Axes, scene: Scene, levels: Sequence[Level], pair: list[int]) -> None:
    """Draw rapids, programmed path and real motion in two of the part's axes."""
    unit = scene.unit.mm
    rapids = [move for move in scene.moves if move.kind == "rapid"]
    lines = paths(scene.path.part, rapids, PICTURE_CHORD)
    pictures.draw_rapids(axes, [line[:, pair] / unit for line in lines])
    wide = scene.real is not None
    for lines, colour in coloured_paths(scene, levels):
        lines = [line[:, pair] / unit for line in lines]
        shade = pictures.tint(colour, 0.4) if wide else colour
        pictures.draw(axes, lines, shade, 2.6 if wide else width_for(scene))
    if scene.real is not None:
        pictures.draw(axes, [scene.real.points[:, pair] / unit], pictures.REAL, 0.7, 3.5)


def width_for(scene: Scene) -> float:
    """Return the width of paths in points: finer where there are very many."""
    return 1.1 if len(scene.moves) < MANY else 0.5


def coloured_paths(scene: Scene, levels: Sequence[Level]) -> list:
    """Return the moves at feed as polylines with their colour: by depth, or by feed."""
    part = scene.path.part
    if scene.feed_colours:
        bands = feed_bands(scene)
        return [(paths(part, moves, PICTURE_CHORD), colour) for _, colour, moves in bands]
    plunging = [m for m in scene.moves if m.kind != "rapid" and not is_sideways(m)]
    below = [(paths(part, plunging), pictures.MUTED)]
    return below + [(level.lines, level.shade.line) for level in levels]


def feed_bands(scene: Scene) -> list[tuple[float, tuple, list[Move]]]:
    """Return feeds along the part (mm/min), each with its colour and moves; many in bands."""
    feeds = {index: scene.path.part_feed(index) for index in at_feed(scene)}
    found = sorted({float(f"{feed:.3g}") for feed in feeds.values()})
    if len(found) > MOST_LEVELS:
        found = list(np.linspace(found[0], found[-1], MOST_LEVELS))
    groups: list[list[Move]] = [[] for _ in found]
    for index, feed in feeds.items():
        groups[int(np.argmin(np.abs(np.subtract(found, feed))))].append(scene.moves[index])
    return list(zip(found, pictures.feed_colours(len(found)), groups))


def at_feed(scene: Scene) -> list[int]:
    """Return the indices of the moves at feed."""
    return [index for index, move in enumerate(scene.moves) if move.kind != "rapid"]


def plunges_of(scene: Scene) -> list[tuple[tuple[float, float], int]]:
    """Return the points where a tool feeds straight down, each with the tool's number."""
    down = [m for m in scene.moves if m.kind != "rapid" and not is_sideways(m)]
    down = [move for move in down if move.end[2] < move.start[2]]
    points = scene.path.part.points(np.array([m.end for m in down]).reshape(-1, 9))
    return sorted({(tuple(np.round(p[:2], 6)), m.tool) for p, m in zip(points, down)})


def draw_plunges(axes: Axes, scene: Scene) -> None:
    """Mark where the tool plunges, with the cutter drawn to scale about each point."""
    for (x, y), tool in plunges_of(scene):
        at = (x / scene.unit.mm, y / scene.unit.mm)
        radius = scene.diameters.get(tool, 0.0) / 2 / scene.unit.mm
        axes.plot(*at, "o", color=pictures.INK, markersize=PLUNGE, zorder=5)
        circle = Circle(at, radius, fill=False, edgecolor=pictures.INK, linewidth=0.8, zorder=4.5)
        axes.add_patch(circle)


def draw_arrows(axes: Axes, scene: Scene, pair: Sequence[int] = (0, 1)) -> None:
    """Show the direction of the longer moves, once where levels repeat them."""
    least = LONG * min(np.diff(axes.get_xlim())[0], np.diff(axes.get_ylim())[0]) * scene.unit.mm
    lines = [line[:, list(pair)] for line in elements(scene)]
    long = [line for line in lines if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() > least]
    places = {tuple(np.round(line[len(line) // 2], 2)): line for line in long}
    if len(places) <= MOST_ARROWS:
        for line in places.values():
            pictures.draw_arrow(axes, line / scene.unit.mm, pictures.INK)


def elements(scene: Scene) -> list[np.ndarray]:
    """Return the path of each cutting block (n, 3); pieces of one line of the program are one."""
    part, blocks = scene.path.part, []
    cutting = (scene.moves[index] for index in at_feed(scene))
    whole = (lambda move: (move.block, move.line)) if part.turning else id
    for _, moves in groupby(cutting, whole):
        blocks += paths(part, moves, PICTURE_CHORD)
    return blocks


def entries(scene: Scene, levels: Sequence[Level]) -> list:
    """Return the legend."""
    listed = feed_entries(scene) if scene.feed_colours else []
    listed += level_entries(scene, levels)
    for tool in sorted({scene.moves[index].tool for index in at_feed(scene)}):
        size = scene.unit.text(scene.diameters.get(tool, 0.0))
        name = f"cutter T{tool}" if tool > 0 else "no tool"
        text = f"{name}, ⌀ {size} {scene.unit.name}"
        listed.append(pictures.marker(pictures.INK, text, CUTTER, hollow=True))
    if plunges_of(scene):
        listed.append(pictures.marker(pictures.INK, "plunge"))
    return listed + motion_entries(scene)


def motion_entries(scene: Scene) -> list:
    """Return the legend's entries of rapids and of the real motion."""
    listed = []
    if any(move.kind == "rapid" for move in scene.moves):
        listed.append(pictures.stroke(pictures.RAPID, "rapid", 0.9, dashed=True))
    if scene.real is not None:
        listed.append(pictures.stroke(pictures.REAL, "real motion", 0.9))
        listed.append(pictures.marker(pictures.WORST, "largest deviation", 7, hollow=True))
    return listed


def level_entries(scene: Scene, levels: Sequence[Level]) -> list:
    """Return the legend's entries of the depths."""
    return [
        pictures.swatch(*floor(scene, level), f"swept at Z{scene.unit.text(level.z)}")
        for level in few(levels)
    ]


def feed_entries(scene: Scene) -> list:
    """Return the legend's entries of the feeds."""
    unit = scene.unit
    return [
        pictures.stroke(colour, f"{plain(feed / unit.mm, 1)} {unit.name}/min")
        for feed, colour, _ in feed_bands(scene)
    ]


def few(items: Sequence) -> list:
    """Return at most MOST_LEVELS of the items, the first and the last among them."""
    if len(items) <= MOST_LEVELS:
        return list(items)
    return [items[i] for i in np.linspace(0, len(items) - 1, MOST_LEVELS).round().astype(int)]


def mark_worst(axes: Axes, scene: Scene, pair: list[int]) -> Worst | None:
    """Circle the largest deviation of the run in a view of two of the part's axes."""
    worst = worst_of(scene.real, scene.moves)
    if worst is not None:
        at = worst.point[pair] / scene.unit.mm
        axes.plot(*at, "o", color=pictures.WORST, markersize=8, fillstyle="none", zorder=6)
    return worst
