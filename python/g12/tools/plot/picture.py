# SPDX-License-Identifier: GPL-2.0-or-later
"""The page of a program: its views, beside them the axes over time, or the legend.

A mill's part is shown from above and from the side, a turned one in Z and X. Of a part that C turns
it is the face as one looks at it, or the unrolled surface of a cylinder, seen from outside, its
axis upwards: C is to the right, Z upwards, X towards the viewer, or round a mill's part A, X and Z.

Lengths of the part are millimetres until they are drawn, those of the page are inches.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from g12.tools.path.follow import worst_of
from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE, draw_window
from g12.tools.plot.history import draw_history
from g12.tools.plot.plan_view import (
    Floor,
    SceneView,
    bounds_of,
    draw_arrows,
    draw_paths,
    draw_plan,
    draw_signs,
    floors_of,
    legend_entries,
)
from g12.tools.plot.scene import Scene
from g12.tools.plot.side_view import draw_side
from g12.tools.units import plain

MOST_SIDE, LEAST_SIDE = 3.2, 0.8  # the height of the side view
BETWEEN, BESIDE, BELOW = 0.5, 0.25, 0.6  # views, and what is beside and below them
PANELS, PANEL, PANEL_GAP = 5, (4.55, 1.0), 0.3
PANELS_BESIDE = 0.7
LEGEND, ROW = 2.75, 0.22  # its width, the height of a line
ANGLES = 0.25  # the height of those above a surface
PLAN, SIDE, PROFILE = [0, 1], [0, 2], [2, 0]  # the part's axes of a view, across and up
NICE_ANGLES = (1, 1.5, 1.8, 3, 3.6, 4.5, 9, 10)
TIME_IN_RAPIDS = style.swatch(style.FAINT, None, "time spent in rapids")


def picture_of(scene: Scene) -> Figure:
    page = style.new_page(scene.title, scene.subtitle)
    floors = floors_of(scene)
    low, high = bounds_of(scene, floors)
    views, entries = draw_views(page, scene, floors, low, high), legend_entries(scene, floors)
    place = views[-1].axes.get_position()
    left, top, columns = place.x1 + BESIDE, 0.0, 1
    detail = left, ROW * len(entries) + BETWEEN
    if scene.path.part.turning:
        draw_history(panels_of(page, place.x1 + PANELS_BESIDE), scene)
        entries.append(TIME_IN_RAPIDS)
        left, top, columns = 0.0, BELOW - place.y0, 1 if scene.real else 2
        detail = max(place.x1 - DETAIL_SIZE, LEGEND), top + PANEL_GAP
    style.draw_legend(page, entries, left, top, columns)
    worst = worst_of(scene.real, scene.moves) if scene.real else None
    if worst is not None:
        ring = {"color": style.WORST, "markersize": 8, "fillstyle": "none", "zorder": 6}
        for view in views:
            view.axes.plot(*view.shown(worst.point), "o", **ring)
        draw_window(page, *detail, scene, worst)
    return page


def panels_of(page: Figure, left: float) -> list:
    """Return panels one below the other."""
    width, height = PANEL
    tops = (row * (height + PANEL_GAP) for row in range(PANELS))
    return [style.add_axes(page, left, top, width, height) for top in tops]


def draw_views(
    page: Figure, scene: Scene, floors: Sequence[Floor], low: np.ndarray, high: np.ndarray
) -> list[SceneView]:
    if scene.program.surface:
        return [surface_view(page, scene, floors, low, high)]
    if scene.path.part.turning:
        return [face_view(page, scene, floors, low, high)]
    if scene.is_turned:
        return [profile_view(page, scene, low, high)]
    return mill_views(page, scene, floors, low, high)


def mill_views(
    page: Figure, scene: Scene, floors: Sequence[Floor], low: np.ndarray, high: np.ndarray
) -> list[SceneView]:
    plan = SceneView(style.add_view(page, low[PLAN], high[PLAN], scene.unit, "XY"), scene, PLAN)
    plan.axes.set_xlabel("")
    style.caption(plan.axes, "Plan")
    draw_plan(plan, floors)
    place = plan.axes.get_position()
    wide, deep = (high - low)[SIDE]
    true = deep * place.width / wide
    height = float(np.clip(true, LEAST_SIDE, MOST_SIDE))
    axes = style.add_axes(page, 0, BETWEEN - place.y0, place.width, height)
    style.frame(axes, low[SIDE], high[SIDE], scene.unit, "XZ")
    to_scale = abs(height / true - 1) < 0.02
    scale = "" if to_scale else f", heights drawn {plain(height / true, 2)} : 1"
    style.caption(axes, f"Side{scale}")
    side = SceneView(axes, scene, SIDE)
    draw_side(side, floors)
    return [plan, side]


def profile_view(page: Figure, scene: Scene, low: np.ndarray, high: np.ndarray) -> SceneView:
    """Draw the toolpath in Z and X, as seen from the front of the lathe."""
    low = np.minimum(low, (0.0, np.inf, np.inf))
    names = "Z", "X (radius)"
    axes = style.add_view(page, low[PROFILE], high[PROFILE], scene.unit, names)
    view = SceneView(axes, scene, PROFILE)
    view.axes.axhline(0, **style.CENTRE_LINE)
    draw_paths(view)
    draw_arrows(view)
    draw_signs(view)
    return view


def face_view(
    page: Figure, scene: Scene, floors: Sequence[Floor], low: np.ndarray, high: np.ndarray
) -> SceneView:
    low, high = np.minimum(low[PLAN], 0), np.maximum(high[PLAN], 0)
    middle, half = (low + high) / 2, max(high - low) / 2
    names = "towards C0", "towards C90"
    axes = style.add_view(page, middle - half, middle + half, scene.unit, names)
    view = SceneView(axes, scene)
    view.axes.axhline(0, **style.CENTRE_LINE)
    view.axes.axvline(0, **style.CENTRE_LINE)
    style.caption(view.axes, "; ".join(filter(None, ["The part's face", scene.x0_text])))
    draw_plan(view, floors)
    return view


def surface_view(
    page: Figure, scene: Scene, floors: Sequence[Floor], low: np.ndarray, high: np.ndarray
) -> SceneView:
    """Draw a portion of the surface, with C's angles and the position of X0 above it."""
    radius, part = scene.program.surface, scene.path.part
    turn, along, _ = tuple(part.letters)
    names = f"along {turn}", along
    view = SceneView(style.add_view(page, low[PLAN], high[PLAN], scene.unit, names, ANGLES), scene)
    around = radius / scene.unit.mm * getattr(part, "sense", 1.0)
    to_degrees = (lambda length: np.degrees(length / around)), (lambda c: np.radians(c) * around)
    above = view.axes.secondary_xaxis("top", functions=to_degrees)
    above.xaxis.set_major_locator(MaxNLocator(8, steps=NICE_ANGLES))
    label = f"{turn}, degrees, on the radius {scene.unit.text(radius)}"
    above.set_xlabel("; ".join(filter(None, [label, scene.x0_text])))
    draw_plan(view, floors)
    return view
