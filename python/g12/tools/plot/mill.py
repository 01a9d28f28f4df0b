# SPDX-License-Identifier: GPL-2.0-or-later
"""The pictures of a mill's part, from above and from the side, and of a turned one.

Lengths are millimetres until they are drawn; those of the layout are inches on the page.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from shapely.geometry import LineString, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE
from g12.tools.plot.plan_view import (
    ONE_DEPTH,
    Floor,
    SceneView,
    bounds_of,
    draw_arrows,
    draw_paths,
    draw_plan,
    draw_signs,
    draw_stock,
    finish,
    floors_of,
    legend_entries,
    motion_entries,
    top_of,
)
from g12.tools.plot.scene import Scene
from g12.tools.units import plain
from g12.tools.verify.model.finding import Finding

PAGE = 9.75  # wide
WIDE = 2.0  # a plan wider than this times its height has the legend below
LEGEND, BESIDE = 2.75, 0.2  # the width of one beside the views, and its distance from them
BELOW = 0.6  # the distance of one below them
MOST_PLAN, LEAST_PLAN = 5.6, 1.2  # high
BETWEEN = 0.5  # the views
MOST_SIDE, LEAST_SIDE = 3.2, 0.8
MOST_PROFILE, LEAST_PROFILE = 6.5, 2.0
ROW = 0.22  # a line of the legend
COLUMNS = 4
XZ = [0, 2]  # the axes of the side view
PROFILE = [2, 0]  # of a turned part: Z to the right, X up


def draw_mill(scene: Scene) -> Figure:
    floors = floors_of(scene)
    low, high = bounds_of(scene, floors)
    width, height, depth = high - low
    is_wide = width > WIDE * height
    scale = min((PAGE if is_wide else PAGE - LEGEND) / width, MOST_PLAN / height)
    across, up = width * scale, max(LEAST_PLAN, height * scale)
    deep = float(np.clip(depth * scale, LEAST_SIDE, MOST_SIDE))
    page = style.new_page(scene.title, scene.subtitle)
    plan = style.add_axes(page, 0, 0, across, up)
    side = style.add_axes(page, 0, up + BETWEEN, across, deep)
    style.frame(plan, low[:2], high[:2], scene.unit, "XY")
    plan.set_aspect("equal", adjustable="datalim")
    plan.set_xlabel("")
    style.caption(plan, "Plan")
    views = SceneView(plan, scene), SceneView(side, scene, XZ)
    draw_plan(views[0], floors)
    style.frame(side, low[XZ], high[XZ], scene.unit, "XZ")
    draw_side(views[1], floors, deep / (depth * scale))
    entries = legend_entries(scene, floors)
    bottom = up + BETWEEN + deep
    if is_wide:
        corner = (across - DETAIL_SIZE, bottom + BELOW)
        return finish(page, views, entries, (0, bottom + BELOW, COLUMNS), corner)
    return finish(page, views, entries, (across + BESIDE, 0, 1), beside(across, bottom, entries))


def beside(across: float, bottom: float, entries: Sequence) -> tuple[float, float]:
    """Return the corner of the detail view beside the views: below the legend, or at the bottom."""
    return across + 2 * BESIDE, max(bottom - DETAIL_SIZE, ROW * len(entries) + BETWEEN)


def draw_turn(scene: Scene) -> Figure:
    """Draw the toolpath in Z and X, as seen from the front of the lathe."""
    low, high = (corner[PROFILE] for corner in bounds_of(scene, []))
    low[1] = min(low[1], 0.0)
    width, (across, up) = PAGE - LEGEND, high - low
    height = float(np.clip(width * up / across, LEAST_PROFILE, MOST_PROFILE))
    page = style.new_page(scene.title, scene.subtitle)
    view = SceneView(style.add_axes(page, 0, 0, width, height), scene, PROFILE)
    style.frame(view.axes, low, high, scene.unit, ("Z", "X (radius)"))
    view.axes.set_aspect("equal", adjustable="datalim")
    view.axes.axhline(0, **style.CENTRE_LINE)
    draw_paths(view)
    draw_arrows(view)
    draw_signs(view)
    entries = [style.stroke(style.shade(ONE_DEPTH).line, "cut"), *motion_entries(scene)]
    return finish(page, [view], entries, (width + BESIDE, 0, 1), beside(width, height, entries))


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
