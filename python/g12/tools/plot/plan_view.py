# SPDX-License-Identifier: GPL-2.0-or-later
"""The view along the tool's axis, of a mill's part or of a lathe's: swept floors and paths.

Lengths are millimetres until they are drawn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby, takewhile
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from shapely.affinity import scale as scaled
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.path.follow import Worst, worst_of
from g12.tools.path.part import FLAT, C, Part, is_sideways, paths, swept
from g12.tools.plot import style
from g12.tools.plot.scene import Scene
from g12.tools.plot.style import Shade
from g12.tools.preview.moves import Move
from g12.tools.units import plain

PICTURE_CHORD = 0.01
SAME_DEPTH = 1e-3
LEAST_LEVELS = 2  # entries in a short legend
MOST_SHOWN_LEVELS = 10  # more depths or feeds than this are shown in bands
BANDS = 24
MOST_ARROWS = 80
ARC_POINTS = 181  # points of an arc whose level changes
NEAR_RAPIDS = 0.5  # of the view: rapids that end within this distance are shown whole
MANY = 20_000  # moves
LONG = 0.12  # of the view's smaller side: shorter moves get no arrow
VIEW_MARGIN = 0.05  # of the view's greater side
PLUNGE, CUTTER = 3.5, 8.0  # points


class Level(NamedTuple):
    """The milling at one depth: colours, paths (n, 3), swept area, largest cutter's radius."""

    z: float
    shade: Shade
    lines: list[np.ndarray]
    area: BaseGeometry
    radius: float = 0.0


def milled_levels(scene: Scene) -> list[Level]:
    """Return the depths milled or drilled, from the top down; with many, in bands."""
    cutting = [move for move in scene.sweeping if removes(move)]
    if not cutting:
        return []
    depth = floors(cutting)
    found = sorted(set(np.round(depth / SAME_DEPTH) * SAME_DEPTH), reverse=True)
    if len(found) > MOST_SHOWN_LEVELS:
        found = list(np.linspace(depth.max(), depth.min(), BANDS))
    nearest = np.abs(np.subtract.outer(depth, found)).argmin(axis=1)
    groups = [[cutting[i] for i in np.flatnonzero(nearest == level)] for level in range(len(found))]
    part = scene.path.part
    return [
        Level(z, shade, milled(part, group), *swept_by(part, group, scene.subject.trace.diameters))
        for z, shade, group in zip(found, style.shades(len(found)), groups)
        if group
    ]


def floors(moves: Sequence[Move]) -> np.ndarray:
    """Return the depth of each move; turns of a helix count for the floor below them."""
    found: list[float] = []
    for move in reversed(moves):
        own = lowest(move)
        leads_to = found[-1] if found and is_helical(move) else own
        found.append(min(own, leads_to))
    return np.array(found[::-1])


def is_helical(move: Move) -> bool:
    """Return whether a move is helical about the tool's axis, or about the spindle's on a face."""
    revolves = (move.kind == "arc" and move.plane == FLAT) or move.end[C] != move.start[C]
    return revolves and move.end[2] < move.start[2] - SAME_DEPTH


def lowest(move: Move) -> float:
    """Return the lowest level of a move; an arc may go below its ends."""
    bulge = move.kind == "arc" and move.plane != FLAT
    shares = np.linspace(0, 1, ARC_POINTS) if bulge else (0.0, 1.0)
    return min(move.point(share)[2] for share in shares)


def removes(move: Move) -> bool:
    return is_sideways(move) or move.end[2] < move.start[2]


def milled(part: Part, moves: Sequence[Move]) -> list[np.ndarray]:
    return paths(part, [move for move in moves if is_sideways(move)], PICTURE_CHORD)


def swept_by(
    part: Part, moves: Sequence[Move], diameters: Mapping[int, float]
) -> tuple[BaseGeometry, float]:
    areas, radii = [], []
    for tool in {move.tool for move in moves}:
        lines = paths(part, [move for move in moves if move.tool == tool], PICTURE_CHORD)
        radii.append(max(diameters.get(tool, 0.0) / 2, PICTURE_CHORD))
        areas.append(swept(lines, radii[-1]))
    return unary_union(areas), max(radii)


def bounds_of(scene: Scene, levels: Sequence[Level]) -> tuple[np.ndarray, np.ndarray]:
    """Return least and greatest X, Y, Z of the cut, with a margin; far rapids do not count."""
    shown = at_feed(scene) or range(len(scene.moves))
    points = np.concatenate([scene.path.points[scene.path.vertices(index)] for index in shown])
    low, high = points.min(axis=0), points.max(axis=0)
    for shape in (
        *(level.area for level in levels),
        *(each.values["shape"] for each in scene.seen.uncut),
    ):
        bounds = shape.bounds
        low[:2], high[:2] = np.minimum(low[:2], bounds[:2]), np.maximum(high[:2], bounds[2:])
    high[2] = max(high[2], top_of(scene))
    stock = scene.seen.stock
    if stock:
        bounds, deep = stock.shape.bounds, stock.bottom
        low = np.minimum(low, (*bounds[:2], low[2] if deep is None else deep))
        high = np.maximum(high, (*bounds[2:], stock.top))
    low[:2], high[:2] = with_near_rapids(scene, low[:2], high[:2])
    size = high - low
    margin = np.clip(
        VIEW_MARGIN * max(size[:2]), PICTURE_CHORD, np.maximum(0.15 * size, PICTURE_CHORD)
    )
    margin[2] = max(0.12 * size[2], 0.2 * min(margin[:2]))
    return low - margin, high + margin


def with_near_rapids(
    scene: Scene, low: np.ndarray, high: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return a view's corners, extended to the ends of near rapids."""
    ends = np.array([point for move in shown_moves(scene) for point in (move.start, move.end)])
    points = scene.path.part.points(ends)[:, :2]
    away = NEAR_RAPIDS * max(high - low)
    near = points[np.all((points > low - away) & (points < high + away), axis=1)]
    return np.vstack([near, low]).min(axis=0), np.vstack([near, high]).max(axis=0)


def top_of(scene: Scene) -> float:
    """Return the top of the part: Z0 if the tool passes it downward, else where the feed begins."""
    z0 = scene.seen.z0
    cutting = [move for move in scene.moves if move.kind != "rapid"] or scene.moves
    lowest = min(min(move.start[2], move.end[2]) for move in cutting)
    highest = max(max(move.start[2], move.end[2]) for move in scene.moves)
    if lowest < z0 < highest:
        return z0
    return max(max(move.start[2], move.end[2]) for move in cutting)


def draw_plan(axes: Axes, scene: Scene, levels: Sequence[Level]) -> None:
    unit = scene.unit.mm
    draw_stock(axes, scene, scene.seen.stock.shape if scene.seen.stock else None)
    for order, level in enumerate(levels):
        area = scaled(level.area, 1 / unit, 1 / unit, origin=(0, 0))
        style.fill(axes, area, *floor(scene, level), 1 + order / 100)
    draw_paths(axes, scene, levels, [0, 1])
    draw_plunges(axes, scene)
    draw_arrows(axes, scene)
    draw_warnings(axes, scene)


def draw_warnings(axes: Axes, scene: Scene) -> None:
    unit = scene.unit.mm
    for each in scene.seen.uncut:
        style.hatch(axes, scaled(each.values["shape"], 1 / unit, 1 / unit, origin=(0, 0)))
    draw_signs(axes, scene, [0, 1])


def draw_signs(axes: Axes, scene: Scene, pair: list[int]) -> None:
    """Draw signs at the findings that are neither a rapid nor uncut material."""
    for finding in scene.seen.signs:
        style.draw_sign(axes, np.array(finding.place)[pair] / scene.unit.mm)


def draw_stock(axes: Axes, scene: Scene, shape: BaseGeometry | None) -> None:
    if shape is not None:
        area = scaled(shape, 1 / scene.unit.mm, 1 / scene.unit.mm, origin=(0, 0))
        style.fill(axes, area, style.STOCK, order=0.7)
        style.fill(axes, area, "none", style.STOCK_EDGE, 2.2)


def floor(scene: Scene, level: Level) -> tuple[object, object]:
    """Return the fill and the outline of a level's area; grey where colours show feeds."""
    if scene.feed_colours:
        return style.grey(level.shade.floor), style.RAPID
    return level.shade.floor, style.tint(level.shade.line, 0.35)


def shown_moves(scene: Scene) -> Sequence[Move]:
    """Return the moves without the first rapids, whose start no trace knows.

    These are the first one, and those up to the first command of Z.
    """
    moves = scene.moves
    rapids = list(takewhile(lambda move: move.kind == "rapid", moves))
    if scene.real is not None or not rapids or len(rapids) == len(moves):
        return moves
    down = (index for index, move in enumerate(rapids) if move.start[2] != move.end[2])
    return moves[next(down, 0) + 1 :]


def draw_paths(axes: Axes, scene: Scene, levels: Sequence[Level], pair: list[int]) -> None:
    """Draw rapids, programmed path and actual motion in two of the part's axes."""
    unit = scene.unit.mm
    rapids = (move for move in shown_moves(scene) if move.kind == "rapid")
    lines = (scene.path.part.polyline(move, PICTURE_CHORD) for move in rapids)
    style.draw_rapids(axes, once([line[:, pair] / unit for line in lines]))
    wide = scene.real is not None
    for path, colour in coloured_paths(scene, levels):
        shade = style.tint(colour, 0.4) if wide else colour
        width = 2.6 if wide else width_for(scene)
        style.draw(axes, [line[:, pair] / unit for line in path], shade, width)
    if scene.real is not None:
        draw_real(axes, scene, pair)
    hit = [found.values["path"][:, pair] for found in scene.seen.rapids]
    style.draw(axes, [line / unit for line in hit], style.CRASH, 3.0, 3.8)
    for line in hit:
        if is_point(line):
            style.draw_hit(axes, line[0] / unit)


def is_point(line: np.ndarray) -> bool:
    return bool(np.ptp(line, axis=0).max() < PICTURE_CHORD)


def draw_real(axes: Axes, scene: Scene, pair: list[int]) -> None:
    """Draw the actual motion in two of the part's axes, rapids dashed."""
    real = scene.real
    cuts: list[np.ndarray] = []
    rapids: list[np.ndarray] = []
    edges = np.flatnonzero(np.diff(real.move)) + 1
    for stretch in np.split(np.arange(len(real.move)), edges):
        shown = real.points[max(0, stretch[0] - 1) : stretch[-1] + 1, pair] / scene.unit.mm
        is_rapid = scene.moves[real.move[stretch[0]]].kind == "rapid"
        (rapids if is_rapid else cuts).append(shown)
    style.draw(axes, cuts, style.REAL, 0.7, 3.5)
    style.draw_rapids(axes, once(rapids), style.REAL, 3.4)


def once(lines: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return polylines without repeated and reversed ones: two dashed lines look solid."""
    found: dict[frozenset[tuple[float, ...]], np.ndarray] = {}
    for line in lines:
        ends = np.round(line[[0, len(line) // 2, -1]] / max(np.ptp(line, axis=0).max(), 1e-6), 2)
        found.setdefault(frozenset(map(tuple, ends + 0.0)), line)
    return list(found.values())


def width_for(scene: Scene) -> float:
    """Return the width of paths in points: finer where there are very many."""
    return 1.1 if len(scene.moves) < MANY else 0.5


def coloured_paths(scene: Scene, levels: Sequence[Level]) -> list:
    """Return the moves at feed as polylines with their colour: by depth, or by feed."""
    part = scene.path.part
    if scene.feed_colours:
        bands = feed_bands(scene)
        return [(paths(part, moves, PICTURE_CHORD), colour) for _, colour, moves in bands]
    others = [move for move in scene.sweeping if not is_sideways(move)]
    others += [scene.moves[index] for index in scene.radial]
    below = [(paths(part, others, PICTURE_CHORD), style.MUTED)]
    return below + [(level.lines, level.shade.line) for level in levels]


def feed_bands(scene: Scene) -> list[tuple[float, tuple, list[Move]]]:
    """Return feeds along the part (mm/min), each with its colour and moves; many in bands."""
    feeds = {index: scene.path.part_feed(index) for index in at_feed(scene)}
    found = sorted({float(f"{feed:.3g}") for feed in feeds.values()})
    if len(found) > MOST_SHOWN_LEVELS:
        found = list(np.linspace(found[0], found[-1], MOST_SHOWN_LEVELS))
    groups: list[list[Move]] = [[] for _ in found]
    for index, feed in feeds.items():
        groups[int(np.argmin(np.abs(np.subtract(found, feed))))].append(scene.moves[index])
    return list(zip(found, style.feed_colours(len(found)), groups))


def at_feed(scene: Scene) -> list[int]:
    return [index for index, move in enumerate(scene.moves) if move.kind != "rapid"]


def plunges_of(scene: Scene) -> list[tuple[tuple[float, float], int]]:
    """Return the points of plunges straight down at feed, each with the tool's number."""
    down = [m for m in scene.sweeping if not is_sideways(m) and m.end[2] < m.start[2]]
    points = scene.path.part.points(np.array([m.end for m in down]).reshape(-1, 9))
    return sorted({(tuple(np.round(p[:2], 6)), m.tool) for p, m in zip(points, down)})


def draw_plunges(axes: Axes, scene: Scene) -> None:
    """Mark where the tool plunges, with the cutter drawn to scale about each point."""
    for (x, y), tool in plunges_of(scene):
        at = (x / scene.unit.mm, y / scene.unit.mm)
        radius = scene.subject.trace.diameters.get(tool, 0.0) / 2 / scene.unit.mm
        axes.plot(*at, "o", color=style.INK, markersize=PLUNGE, zorder=5)
        circle = Circle(at, radius, fill=False, edgecolor=style.INK, linewidth=0.8, zorder=4.5)
        axes.add_patch(circle)


def draw_arrows(axes: Axes, scene: Scene, pair: Sequence[int] = (0, 1)) -> None:
    """Show the direction of the longer moves, once where levels repeat them."""
    least = LONG * min(np.diff(axes.get_xlim())[0], np.diff(axes.get_ylim())[0]) * scene.unit.mm
    lines = [line[:, list(pair)] for line in elements(scene)]
    long = [line for line in lines if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() > least]
    by_middle = {tuple(np.round(line[len(line) // 2], 2)): line for line in long}
    if len(by_middle) <= MOST_ARROWS:
        for line in by_middle.values():
            style.draw_arrow(axes, line / scene.unit.mm, style.INK)


def elements(scene: Scene) -> list[np.ndarray]:
    """Return the path of each cutting block (n, 3); segments of one line of the program are one."""
    part, blocks = scene.path.part, []
    cutting = (scene.moves[index] for index in at_feed(scene))
    whole = (lambda move: (move.block, move.line)) if part.turning else id
    for _, moves in groupby(cutting, whole):
        blocks += paths(part, moves, PICTURE_CHORD)
    return blocks


def legend_entries(scene: Scene, levels: Sequence[Level], room: int | None = None) -> list:
    """Return the legend, with fewer depths where ``room`` limits its entries."""
    feeds = feed_entries(scene) if scene.feed_colours else []
    listed = []
    for tool in sorted({scene.moves[index].tool for index in at_feed(scene)}):
        listed.append(style.marker(style.INK, cutter_text(scene, tool), CUTTER, hollow=True))
    if plunges_of(scene):
        listed.append(style.marker(style.INK, "plunge"))
    listed += motion_entries(scene)
    room = MOST_SHOWN_LEVELS if room is None else max(room - len(feeds) - len(listed), LEAST_LEVELS)
    return [*feeds, *level_entries(scene, levels, min(room, MOST_SHOWN_LEVELS)), *listed]


def cutter_text(scene: Scene, tool: int) -> str:
    diameter = scene.subject.trace.diameters.get(tool, 0.0)
    if tool <= 0 or not diameter:
        return f"{f'T{tool} has no diameter' if tool > 0 else 'no tool'}: tool centre only"
    return f"cutter T{tool}, ⌀ {scene.unit.text(diameter)} {scene.unit.name}"


def motion_entries(scene: Scene) -> list:
    """Return the legend's entries of the stock, of rapids and of the actual motion."""
    listed = []
    if scene.seen.stock:
        stock = scene.seen.stock.stock
        text = f"{'bar' if stock.diameter else 'stock'} {stock.text}"
        listed.append(style.swatch(style.STOCK, style.STOCK_EDGE, text))
    if scene.radial:
        listed.append(style.stroke(style.MUTED, "toolpath in the side"))
    if any(move.kind == "rapid" for move in scene.moves):
        listed.append(style.stroke(style.RAPID, "rapid", 0.9, dashed=True))
    if scene.real is not None:
        listed.append(style.stroke(style.PATH, "programmed path", 2.6))
        listed.append(style.stroke(style.REAL, "real motion", 0.9))
        listed.append(style.marker(style.WORST, "largest deviation", 7, hollow=True))
    return listed + warning_entries(scene)


def has_side_view(scene: Scene) -> bool:
    part = scene.path.part
    return not part.turning and part.letters[2] == "Z"


def warning_entries(scene: Scene) -> list:
    listed = []
    end_on = [is_point(found.values["path"][:, :2]) for found in scene.seen.rapids]
    if any(end_on):
        listed.append(style.hit("rapid straight down into material"))
    if scene.seen.rapids and (has_side_view(scene) or not all(end_on)):
        listed.append(style.stroke(style.CRASH, "rapid through material", 3.0))
    if scene.seen.uncut:
        listed.append(style.uncut_entry("uncut material"))
    lines = dict.fromkeys(finding.line for finding in scene.seen.signs)
    if lines:
        listed.append(style.sign(f"finding in line {', '.join(map(str, lines))}"))
    return listed


def level_entries(scene: Scene, levels: Sequence[Level], most: int) -> list:
    letter = scene.path.part.letters[2]
    return [
        style.swatch(*floor(scene, level), f"swept at {letter}{scene.unit.text(level.z)}")
        for level in few(levels, most)
    ]


def feed_entries(scene: Scene) -> list:
    unit = scene.unit
    return [
        style.stroke(colour, f"{plain(feed / unit.mm, 1)} {unit.name}/min")
        for feed, colour, _ in feed_bands(scene)
    ]


def few(items: Sequence, most: int = MOST_SHOWN_LEVELS) -> list:
    """Return at most so many of the items, the first and the last among them."""
    if len(items) <= most:
        return list(items)
    return [items[i] for i in np.linspace(0, len(items) - 1, most).round().astype(int)]


def mark_worst(axes: Axes, scene: Scene, pair: list[int]) -> Worst | None:
    """Circle the largest deviation of the run in a view of two of the part's axes."""
    worst = worst_of(scene.real, scene.moves)
    if worst is not None:
        at = worst.point[pair] / scene.unit.mm
        axes.plot(*at, "o", color=style.WORST, markersize=8, fillstyle="none", zorder=6)
    return worst
