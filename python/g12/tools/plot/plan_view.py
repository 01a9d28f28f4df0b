# SPDX-License-Identifier: GPL-2.0-or-later
"""The view along the tool's axis, of a mill's part or of a lathe's: swept floors and paths.

Lengths are millimetres until they are drawn.
"""

from collections.abc import Iterable, Sequence
from itertools import groupby, takewhile
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle
from shapely.affinity import scale as scaled
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.material.material import NOTHING, Material, Removed
from g12.tools.path.part import paths
from g12.tools.plot import style
from g12.tools.plot.scene import Scene
from g12.tools.plot.style import Shade
from g12.tools.verify.model.solid import pieces

PICTURE_CHORD = 0.01
SAME_DEPTH, ONE_DEPTH = 1e-3, 0.35  # mm; the shade of a single one
THIN = 0.02  # mm: a narrower strip of a floor is not shown
MOST_SHOWN_LEVELS = 10  # in a legend
MANY_LEVELS, BANDS = 100, 24
MOST_ARROWS = 80
NEAR_RAPIDS = 0.5  # of the view: rapids that end within this distance are shown whole
MANY = 20_000  # moves
STROKE = 1000  # points that matplotlib draws at once: its memory grows with them
LONG = 0.12  # of the view's smaller side: shorter moves get no arrow
VIEW_MARGIN = 0.05  # of the view's greater side
PLUNGE, CUTTER = 3.5, 8.0  # points


class Floor(NamedTuple):
    """A floor of the material that is left: its level, its area, its colours."""

    z: float
    area: BaseGeometry
    shade: Shade

    @property
    def edge(self) -> tuple:
        return style.tint(self.shade.line, 0.35)


class SceneView(NamedTuple):
    """Axes that show a scene in two axes of its part, by their indices ``pair``."""

    axes: Axes
    scene: Scene
    pair: Sequence[int] = (0, 1)

    def shown(self, points: Sequence[float] | np.ndarray) -> np.ndarray:
        """Return points (…, 3) as points (…, 2) of the view, in the unit shown."""
        return np.asarray(points)[..., list(self.pair)] / self.scene.unit.mm

    def lines(self, lines: Iterable[np.ndarray]) -> list[np.ndarray]:
        return [self.shown(line) for line in lines]

    def area(self, area: BaseGeometry) -> BaseGeometry:
        """Return an area of the view in the unit shown."""
        return scaled(area, 1 / self.scene.unit.mm, 1 / self.scene.unit.mm, origin=(0, 0))


# ------------------------------------------------------------ what is cut


def floors_of(scene: Scene) -> list[Floor]:
    """Return the floors that are milled or drilled, from the top down; none of a turned part."""
    if scene.is_turned:
        return []
    return [Floor(z, area, shade_at(scene, z)) for z, area in floors_left(swept_by(scene))]


def shade_at(scene: Scene, z: float) -> Shade:
    """Return the colours of a depth, darker than those above."""
    low, high = scene.depths
    share = (high - z) / (high - low) if high - low > SAME_DEPTH else ONE_DEPTH
    return style.shade(round(share, 2))


def swept_by(scene: Scene) -> list[Removed]:
    """Return what the cutters sweep, wherever material is."""
    material = Material(NOTHING, scene.depths[1] + SAME_DEPTH)
    for tool, own in groupby(scene.cutting, lambda index: scene.moves[index].tool):
        radius = max(diameter_of(scene, tool) / 2, PICTURE_CHORD)
        moves = [scene.moves[index] for index in own]
        for line in paths(scene.path.part, moves, PICTURE_CHORD):
            for piece in pieces(line):
                material.cut(0, piece, radius)
    return material.sweeps_of(range(1))


def floors_left(sweeps: Sequence[Removed]) -> list[tuple[float, BaseGeometry]]:
    """Return the levels that are left of what is swept, from the top down, each with its area.

    Very many are in bands.
    """
    depth = np.round([sweep.level for sweep in sweeps], 3)
    levels = np.unique(depth)
    if len(levels) > MANY_LEVELS:
        levels = np.linspace(levels[0], levels[-1], BANDS)
    nearest = [np.abs(levels - each).argmin() for each in depth]
    found, deeper = [], NOTHING
    for at, level in enumerate(levels):
        area = unary_union([sweeps[index].shape for index in np.flatnonzero(np.equal(nearest, at))])
        left = area.difference(deeper).buffer(-THIN).buffer(THIN)
        if not left.is_empty:
            found.append((float(level), left))
        deeper = unary_union([deeper, area])
    return found[::-1]


def diameter_of(scene: Scene, tool: int) -> float:
    return scene.program.trace.diameters.get(tool, 0.0)


def plunges_of(scene: Scene) -> list[tuple[tuple[float, float], int]]:
    """Return the points of plunges straight down at feed, each with the tool's number."""
    found = set()
    for index in scene.sweeping:
        start, end = scene.ends[index]
        if end[2] < start[2] and not scene.across[index]:
            found.add((tuple(np.round(end[:2], 6).tolist()), scene.moves[index].tool))
    return sorted(found)


# ------------------------------------------------------------ the size of the view


def bounds_of(scene: Scene, floors: Sequence[Floor]) -> tuple[np.ndarray, np.ndarray]:
    """Return least and greatest X, Y, Z of the cut, with a margin; far rapids do not count."""
    shown = scene.fed or range(len(scene.moves))
    points = np.concatenate([scene.path.points[scene.path.vertices(index)] for index in shown])
    low, high = points.min(axis=0), points.max(axis=0)
    uncut = (each.values["shape"] for each in scene.uncut)
    for shape in (*(floor.area for floor in floors), *uncut):
        bounds = shape.bounds
        low[:2], high[:2] = np.minimum(low[:2], bounds[:2]), np.maximum(high[:2], bounds[2:])
    high[2] = max(high[2], top_of(scene))
    stock = scene.stock
    if stock and not scene.program.surface:
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
    points = scene.ends[first_shown(scene) :, :, :2].reshape(-1, 2)
    away = NEAR_RAPIDS * max(high - low)
    near = points[np.all((points > low - away) & (points < high + away), axis=1)]
    return np.vstack([near, low]).min(axis=0), np.vstack([near, high]).max(axis=0)


def top_of(scene: Scene) -> float:
    """Return the top of the part: Z0 if the tool passes it downward, else where the feed begins."""
    z0, levels = scene.program.z0, scene.ends[:, :, 2]
    cutting = levels[scene.fed] if scene.fed else levels
    return z0 if cutting.min() < z0 < levels.max() else float(cutting.max())


def first_shown(scene: Scene) -> int:
    """Return the number of the first rapids, whose start no trace knows.

    These are the first one, and those up to the first command of Z.
    """
    rapids = len(list(takewhile(lambda move: move.kind == "rapid", scene.moves)))
    if scene.real is not None or rapids in (0, len(scene.moves)):
        return 0
    levels = scene.ends[:rapids, :, 2]
    return int(np.argmax(levels[:, 0] != levels[:, 1])) + 1


# ------------------------------------------------------------ drawing


def draw_plan(view: SceneView, floors: Sequence[Floor]) -> None:
    scene = view.scene
    draw_stock(view, scene.stock and scene.stock.shape)
    for order, floor in enumerate(floors):
        area = view.area(floor.area)
        style.fill(view.axes, area, floor.shade.floor, floor.edge, 1 + order / 100)
    draw_paths(view)
    draw_plunges(view)
    draw_arrows(view)
    for each in scene.uncut:
        style.hatch(view.axes, view.area(each.values["shape"]))
    draw_signs(view)


def draw_signs(view: SceneView) -> None:
    """Draw signs at the findings that are neither a rapid nor uncut material."""
    for finding in view.scene.signs:
        style.draw_sign(view.axes, view.shown(finding.place))


def draw_stock(view: SceneView, shape: BaseGeometry | None) -> None:
    if shape is not None:
        style.fill(view.axes, view.area(shape), style.STOCK, order=0.7)
        style.fill(view.axes, view.area(shape), "none", style.STOCK_EDGE, 2.2)


def draw_paths(view: SceneView) -> None:
    """Draw rapids, programmed path and actual motion."""
    scene, is_run = view.scene, view.scene.real is not None
    rapids = (move for move in scene.moves[first_shown(scene) :] if move.kind == "rapid")
    lines = (scene.path.part.polyline(move, PICTURE_CHORD) for move in rapids)
    style.draw_rapids(view.axes, once(view.lines(lines)))
    width = 1.1 if len(scene.moves) < MANY else 0.5
    fed, colours = fed_paths(scene)
    shades = [style.tint(colour, 0.4) for colour in colours] if is_run else colours
    style.draw(view.axes, view.lines(fed), shades, 2.6 if is_run else width)
    if is_run:
        draw_real(view)
    style.draw(view.axes, view.lines(scene.hits), style.CRASH, 3.0, 3.8)
    for hit in scene.hits:
        if is_point(hit[:, view.pair]):
            style.draw_hit(view.axes, view.shown(hit[0]))


def is_point(line: np.ndarray) -> bool:
    """Return whether a polyline (mm) is seen end on."""
    return bool(np.ptp(line, axis=0).max() < PICTURE_CHORD)


def draw_real(view: SceneView) -> None:
    """Draw the actual motion, rapids dashed."""
    real = view.scene.real
    lines: dict[bool, list[np.ndarray]] = {True: [], False: []}
    for stretch in np.split(np.arange(len(real.move)), np.flatnonzero(np.diff(real.move)) + 1):
        points = real.points[max(0, stretch[0] - 1) : stretch[-1] + 1]
        is_rapid = view.scene.moves[real.move[stretch[0]]].kind == "rapid"
        lines[is_rapid].append(view.shown(points))
    style.draw(view.axes, lines[False], style.REAL, 0.7, 3.5)
    style.draw_rapids(view.axes, once(lines[True]), style.REAL, 3.4)


def once(lines: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Return polylines without repeated and reversed ones: two dashed lines look solid."""
    found: dict[frozenset[tuple[float, ...]], np.ndarray] = {}
    for line in lines:
        ends = np.round(line[[0, len(line) // 2, -1]] / max(np.ptp(line, axis=0).max(), 1e-6), 2)
        found.setdefault(frozenset(map(tuple, ends + 0.0)), line)
    return list(found.values())


def fed_paths(scene: Scene) -> tuple[list[np.ndarray], list]:
    """Return the moves at feed as polylines, and their colours: those across by their depth."""
    part, sweeping = scene.path.part, {*scene.sweeping}

    def colour(index: int) -> object:
        lowest = scene.path.points[scene.path.vertices(index), 2].min()
        across = index in sweeping and scene.across[index]
        return shade_at(scene, lowest).line if across else style.MUTED

    lines: list[np.ndarray] = []
    colours: list[object] = []
    for shade, own in groupby(scene.fed, colour):
        for line in paths(part, [scene.moves[index] for index in own], PICTURE_CHORD):
            lines += (line[at : at + STROKE + 1] for at in range(0, len(line) - 1, STROKE))
        colours += [shade] * (len(lines) - len(colours))
    return lines, colours


def draw_plunges(view: SceneView) -> None:
    """Mark where the tool plunges, with the cutter drawn to scale about each point."""
    unit = view.scene.unit.mm
    for (x, y), tool in plunges_of(view.scene):
        at, radius = (x / unit, y / unit), diameter_of(view.scene, tool) / 2 / unit
        view.axes.plot(*at, "o", color=style.INK, markersize=PLUNGE, zorder=5)
        circle = Circle(at, radius, fill=False, edgecolor=style.INK, linewidth=0.8, zorder=4.5)
        view.axes.add_patch(circle)


def draw_arrows(view: SceneView) -> None:
    """Show the direction of the longer moves, once where levels repeat them."""
    axes = view.axes
    least = LONG * min(np.diff(axes.get_xlim())[0], np.diff(axes.get_ylim())[0])
    lines = view.lines(elements(view.scene))
    long = [line for line in lines if np.linalg.norm(np.diff(line, axis=0), axis=1).sum() > least]
    middle = (line[len(line) // 2] * view.scene.unit.mm for line in long)
    by_middle = {tuple(np.round(at, 2)): line for at, line in zip(middle, long)}
    if len(by_middle) <= MOST_ARROWS:
        for line in by_middle.values():
            style.draw_arrow(axes, line, style.INK)


def elements(scene: Scene) -> list[np.ndarray]:
    """Return the path of each cutting block (n, 3); segments of one line of the program are one."""
    part, blocks = scene.path.part, []
    whole = (lambda move: (move.block, move.line)) if part.turning else id
    for _, moves in groupby((scene.moves[index] for index in scene.fed), whole):
        blocks += paths(part, moves, PICTURE_CHORD)
    return blocks


# ------------------------------------------------------------ the legend


def legend_entries(scene: Scene, floors: Sequence[Floor]) -> list:
    if scene.is_turned:
        return [style.stroke(shade_at(scene, 0.0).line, "cut"), *motion_entries(scene)]
    letter = scene.path.part.letters[2]
    listed = [
        style.swatch(floor.shade.floor, floor.edge, f"swept at {letter}{scene.unit.text(floor.z)}")
        for floor in few(floors)
    ]
    for tool in sorted({scene.moves[index].tool for index in {*scene.fed} - {*scene.turned}}):
        listed.append(style.marker(style.INK, cutter_text(scene, tool), CUTTER, hollow=True))
    if plunges_of(scene):
        listed.append(style.marker(style.INK, "plunge"))
    return listed + motion_entries(scene)


def cutter_text(scene: Scene, tool: int) -> str:
    diameter = diameter_of(scene, tool)
    if tool <= 0 or not diameter:
        return f"{f'T{tool} has no diameter' if tool > 0 else 'no tool'}: tool centre only"
    return f"cutter T{tool}, ⌀ {scene.unit.text(diameter)} {scene.unit.name}"


def motion_entries(scene: Scene) -> list:
    """Return the legend's entries of the stock, of rapids and of the actual motion."""
    listed = []
    if scene.stock and not scene.is_turned:
        listed.append(style.swatch(style.STOCK, style.STOCK_EDGE, scene.stock.name))
    if scene.radial:
        listed.append(style.stroke(style.MUTED, "toolpath in the side"))
    if scene.turned:
        listed.append(style.stroke(style.MUTED, "toolpath of turning"))
    if len(scene.fed) < len(scene.moves):
        listed.append(style.stroke(style.RAPID, "rapid", 0.9, dashed=True))
    if scene.real is not None:
        listed.append(style.stroke(style.PATH, "programmed path", 2.6))
        listed.append(style.stroke(style.REAL, "real motion", 0.9))
        listed.append(style.marker(style.WORST, "largest deviation", 7, hollow=True))
    return listed + warning_entries(scene)


def warning_entries(scene: Scene) -> list:
    listed, part = [], scene.path.part
    end_on = [is_point(hit[:, :2]) for hit in scene.hits]
    has_side_view = not part.turning and part.letters[2] == "Z"
    if any(end_on):
        listed.append(style.hit("rapid straight down into material"))
    if scene.hits and (has_side_view or not all(end_on)):
        listed.append(style.stroke(style.CRASH, "rapid through material", 3.0))
    if scene.uncut:
        listed.append(style.uncut_entry("uncut material"))
    lines = dict.fromkeys(scene.user_line(each.line, each.file) for each in scene.signs)
    if lines:
        listed.append(style.sign(f"finding in line {', '.join(map(str, lines))}"))
    return listed


def few(items: Sequence) -> list:
    """Return at most MOST_SHOWN_LEVELS of the items, the first and the last among them."""
    shown = np.linspace(0, len(items) - 1, min(len(items), MOST_SHOWN_LEVELS))
    return [items[index] for index in shown.round().astype(int)]
