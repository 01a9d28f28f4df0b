# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of cuts on a cylinder: its unrolled surface, and the axes over time.

The surface is seen from outside, its axis upwards: C is to the right, Z upwards, X towards the
viewer, or round a mill's part A, X and Z. Lengths are millimetres until they are drawn; those of
the layout are inches.
"""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from shapely.geometry import box

from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE
from g12.tools.plot.face import GAP, PANEL, TIME_IN_RAPIDS, draw_history, panels_of
from g12.tools.plot.marks import DrawnStock
from g12.tools.plot.plan_view import (
    SceneView,
    bounds_of,
    draw_plan,
    finish,
    floors_of,
    legend_entries,
)
from g12.tools.plot.scene import Scene
from g12.tools.verify.model.finding import Finding

WIDTH, MOST, LEAST = 10.8, 4.6, 0.9  # of the surface; its greatest and least height
ABOVE, UNDER = 0.25, 0.95  # for its angles; between its labels and the panels' captions
BETWEEN = 0.75  # the two columns of panels
COLUMN = (WIDTH - BETWEEN) / 2  # its width
NICE_ANGLES = (1, 1.5, 1.8, 3, 3.6, 4.5, 9, 10)


def draw_unrolled(scene: Scene) -> Figure:
    flat = unrolled(scene)
    floors = floors_of(flat)
    low, high = (corner[:2] for corner in bounds_of(flat, floors))
    size = high - low
    scale = min(WIDTH / size[0], MOST / size[1])
    across, up = size[0] * scale, max(LEAST, size[1] * scale)
    page = style.new_page(flat.title, flat.subtitle)
    flat = with_bar(flat, scene.marks.stock, low, high)
    view = SceneView(style.add_axes(page, 0, ABOVE, across, up), flat)
    frame_surface(view.axes, flat, low, high, scene.x0_text)
    draw_plan(view, floors)
    below, right = ABOVE + up + UNDER, WIDTH - COLUMN
    columns = panels_of(page, 0, below, COLUMN, 3), panels_of(page, right, below, COLUMN, 2)
    draw_history([*columns[0], *columns[1]], flat, "surface")
    for column in columns:
        column[-1].tick_params(labelbottom=True)
        column[-1].set_xlabel(columns[1][-1].get_xlabel())
    entries = [*legend_entries(flat, floors), TIME_IN_RAPIDS]
    top = below + 2 * (PANEL + GAP) + GAP
    legend = (right, top, 2 if scene.real is None else 1)
    return finish(page, [view], entries, legend, (WIDTH - DETAIL_SIZE, top + GAP))


def frame_surface(axes: Axes, scene: Scene, low: np.ndarray, high: np.ndarray, x0: str) -> None:
    """Frame a portion of the surface, with C's angles and ``x0``, the position of X0, above it."""
    radius = scene.marks.surface / scene.unit.mm
    turn, along, _ = tuple(scene.path.part.letters)
    style.frame(axes, low, high, scene.unit, (f"along {turn}", along))
    axes.set_aspect("equal", adjustable="datalim")
    around = radius * getattr(scene.path.part, "sense", 1.0)
    to_degrees = (lambda length: np.degrees(length / around)), (lambda c: np.radians(c) * around)
    above = axes.secondary_xaxis("top", functions=to_degrees)
    above.xaxis.set_major_locator(MaxNLocator(8, steps=NICE_ANGLES))
    label = f"{turn}, degrees, on the radius {scene.unit.text(scene.marks.surface)}"
    above.set_xlabel("; ".join(filter(None, [label, x0])))


def unrolled(scene: Scene) -> Scene:
    """Return a scene on the surface of its cylinder, without the bar."""
    radius = scene.marks.surface
    findings = tuple(on_radius(each, radius) for each in scene.marks.findings)
    marks = scene.marks._replace(findings=findings, stock=None)
    return replace(scene, program=scene.program.on_surface(radius), marks=marks)


def with_bar(flat: Scene, bar: DrawnStock | None, low: np.ndarray, high: np.ndarray) -> Scene:
    """Return an unrolled scene with the bar, if any: all around, up to Z0, beyond the view."""
    if bar is None:
        return flat
    (left, below), (right, _) = low - (high - low), high + (high - low)
    shape = box(left, below, right, flat.program.z0)
    return replace(flat, marks=flat.marks._replace(stock=bar._replace(shape=shape)))


def on_radius(finding: Finding, radius: float) -> Finding:
    """Return a finding with its path, if any, unrolled on another radius."""
    surface = finding.values.get("surface", radius)
    if surface == radius:
        return finding
    path = finding.values["path"] * (radius / surface, 1.0, 1.0)
    return replace(finding, values={**finding.values, "path": path})
