# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a mill program: plan view over side view, with the cutter's swept area.

Lengths are millimetres until they are drawn; those of the layout are inches on the page.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from shapely.geometry import LineString, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE, draw_window
from g12.tools.plot.plan_view import (
    Floor,
    SceneView,
    bounds_of,
    draw_paths,
    draw_plan,
    draw_stock,
    floors_of,
    legend_entries,
    mark_worst,
    top_of,
)
from g12.tools.plot.scene import Scene
from g12.tools.units import plain
from g12.tools.verify.model.finding import Finding

PAGE_WIDTH = 11.0  # wide
WIDE = 2.0  # a plan wider than this times its height has the legend below
LEFT, RIGHT, TOP, BETWEEN, BOTTOM = style.MARGIN, 0.5, 1.05, 0.5, 0.55
LEGEND = 2.75  # width
MOST_PLAN, LEAST_PLAN = 5.6, 1.2  # high
MOST_SIDE, LEAST_SIDE = 3.2, 0.8
ROW = 0.22  # a line of the legend
COLUMNS = 4
XZ = [0, 2]  # the axes of the side view
DETAIL_ROOM = DETAIL_SIZE + 0.75  # the detail view of the largest deviation, with its texts


class Layout:
    """The layout of the page; ``size`` is width, height and depth of the view."""

    def __init__(self, size: np.ndarray, rows: int, with_window: bool) -> None:
        width, height, depth = size
        self.below = width > WIDE * height
        beside = RIGHT if self.below else LEGEND + RIGHT
        room = PAGE_WIDTH - LEFT - beside
        scale = min(room / width, MOST_PLAN / height)
        self.plan = (width * scale, max(LEAST_PLAN, height * scale))
        self.side = min(MOST_SIDE, max(LEAST_SIDE, depth * scale))
        self.stretch = self.side / (depth * scale)
        legend = ROW * (-(-rows // COLUMNS) if self.below else rows) + 0.2
        window = DETAIL_ROOM if with_window else 0.0
        foot = max(legend, window) if self.below else 0.0
        views = self.plan[1] + BETWEEN + self.side + BOTTOM
        self.height = TOP + max(views + foot, 0.0 if self.below else legend + window)
        self.width = PAGE_WIDTH if self.below else LEFT + self.plan[0] + beside
        self.under = self.height - TOP - views

    def axes(self, figure: Figure) -> tuple[Axes, Axes]:
        low = self.height - TOP - self.plan[1]
        plan = style.add_axes(figure, LEFT, low, *self.plan)
        side = style.add_axes(figure, LEFT, low - BETWEEN - self.side, self.plan[0], self.side)
        return plan, side

    def draw_legend(self, figure: Figure, shown: Sequence) -> None:
        beside = (LEFT + self.plan[0] + 0.2, self.height - TOP + 0.08, 1)
        at = (LEFT - 0.1, self.under, COLUMNS) if self.below else beside
        style.draw_legend(figure, shown, *at)

    def window_corner(self) -> tuple[float, float]:
        """Return the lower left corner of the detail view of the largest deviation."""
        beside = (LEFT + self.plan[0] + RIGHT, BOTTOM)
        return (self.width - RIGHT - DETAIL_SIZE, 0.4) if self.below else beside


def draw_mill(scene: Scene) -> Figure:
    floors = floors_of(scene)
    low, high = bounds_of(scene, floors)
    shown = legend_entries(scene, floors)
    layout = Layout(high - low, len(shown), scene.real is not None)
    figure = style.new_figure(layout.width, layout.height, scene.title, scene.subtitle)
    plan, side = layout.axes(figure)
    style.frame(plan, low[:2], high[:2], scene.unit, "XY")
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_xlabel("")
    style.caption(plan, "Plan")
    views = SceneView(plan, scene), SceneView(side, scene, XZ)
    draw_plan(views[0], floors)
    style.frame(side, low[XZ], high[XZ], scene.unit, "XZ")
    draw_side(views[1], floors, layout.stretch)
    layout.draw_legend(figure, shown)
    if scene.real is not None:
        for view in views:
            mark_worst(view)
        draw_window(figure, layout.window_corner(), scene)
    return figure


def draw_side(view: SceneView, floors: Sequence[Floor], stretch: float) -> None:
    """Draw the view along Y: the material removed at each Z level, projected."""
    axes, scene, _ = view
    top = top_of(scene)
    draw_stock(view, block_from_the_side(scene))
    for order, floor in enumerate(reversed(floors)):
        removed = view.area(removed_to(floor, max(top, floor.z)))
        style.fill(axes, removed, floor.shade.floor, floor.edge, 1 + order / 100)
    for each in scene.marks.uncut:
        style.hatch(axes, view.area(cut_through(each, top)))
    draw_paths(view)
    true = abs(stretch - 1) < 0.02
    style.caption(axes, "Side" if true else f"Side, heights drawn {plain(stretch, 2)} : 1")


def cut_through(uncut: Finding, top: float) -> BaseGeometry:
    """Return the uncut material in a pocket, in a section along X through its middle."""
    spans = spans_at(uncut.values["shape"], uncut.place[1])
    return unary_union([box(low, uncut.values["floor"], high, top) for low, high in spans])


def block_from_the_side(scene: Scene) -> BaseGeometry | None:
    """Return a block as seen along Y, if its depth is known."""
    facts = scene.marks.stock
    if facts is None or facts.bottom is None:
        return None
    return box(facts.shape.bounds[0], facts.bottom, facts.shape.bounds[2], facts.top)


def removed_to(floor: Floor, top: float) -> BaseGeometry:
    """Return the material removed above a floor as seen along Y: X and Z, up to the top."""
    areas = getattr(floor.area, "geoms", [floor.area])
    spans = (span for area in areas for span in spans_of(area))
    return unary_union([box(low, floor.z, high, top) for low, high in spans])


def spans_of(area: Polygon) -> list[tuple[float, float]]:
    """Return the spans of an area along X; of one around a boss, those through its middle."""
    low, bottom, high, up = area.bounds
    if not area.interiors:
        return [(low, high)]
    return spans_at(area, (bottom + up) / 2)


def spans_at(area: BaseGeometry, y: float) -> list[tuple[float, float]]:
    """Return the spans of an area along a line parallel to X."""
    low, high = area.bounds[::2]
    across = area.intersection(LineString([(low, y), (high, y)]))
    lines = [line.bounds for line in getattr(across, "geoms", [across]) if line.length]
    return [(line[0], line[2]) for line in lines]
