# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a turning program: the toolpath in Z and X, as seen from the front of the lathe.

Lengths are millimetres until they are drawn; those of the layout are inches on the page.
"""

import numpy as np
from matplotlib.figure import Figure

from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE, draw_window
from g12.tools.plot.plan_view import (
    ONE_DEPTH,
    SceneView,
    bounds_of,
    draw_arrows,
    draw_paths,
    draw_signs,
    mark_worst,
    motion_entries,
)
from g12.tools.plot.scene import Scene

WIDTH, MOST, LEAST = 11.0, 6.5, 2.0
LEFT, RIGHT, TOP, BOTTOM = style.MARGIN, 0.3, 1.05, 0.55
LEGEND, ROWS = 2.35, 2.2  # the legend's width and height
PROFILE = [2, 0]  # Z to the right, X up


def draw_turn(scene: Scene) -> Figure:
    low, high = (corner[PROFILE] for corner in bounds_of(scene, []))
    low[1] = min(low[1], 0.0)
    width = WIDTH - LEFT - RIGHT - LEGEND
    across, up = high - low
    height = float(np.clip(width * up / across, LEAST, MOST))
    beside = ROWS + DETAIL_SIZE if scene.real is not None else 0.0
    page = TOP + max(height, beside) + BOTTOM
    figure = style.new_figure(WIDTH, page, scene.title, scene.subtitle)
    axes = style.add_axes(figure, LEFT, page - TOP - height, width, height)
    view = SceneView(axes, scene, PROFILE)
    draw_profile(view, low, high)
    style.draw_legend(figure, turn_entries(scene), LEFT + width + 0.2, page - TOP + 0.08)
    if scene.real is not None:
        mark_worst(view)
        draw_window(figure, (LEFT + width + 0.35, BOTTOM), scene)
    return figure


def draw_profile(view: SceneView, low: np.ndarray, high: np.ndarray) -> None:
    """Draw the path between two corners of the view, and the spindle's centre line."""
    style.frame(view.axes, low, high, view.scene.unit, ("Z", "X (radius)"))
    view.axes.set_aspect("equal", adjustable="datalim")
    view.axes.axhline(0, **style.CENTRE_LINE)
    draw_paths(view)
    draw_arrows(view)
    draw_signs(view)


def turn_entries(scene: Scene) -> list:
    return [style.stroke(style.shade(ONE_DEPTH).line, "cut"), *motion_entries(scene)]
