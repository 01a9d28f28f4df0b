# SPDX-License-Identifier: GPL-2.0-or-later
"""The view along Y of a mill's part: the material removed at each Z level, projected."""

from collections.abc import Sequence

from shapely.geometry import LineString, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.plot import style
from g12.tools.plot.plan_view import Floor, SceneView, draw_paths, draw_stock, top_of
from g12.tools.plot.scene import Scene
from g12.tools.verify.model.finding import Finding


def draw_side(view: SceneView, floors: Sequence[Floor]) -> None:
    scene, top = view.scene, top_of(view.scene)
    draw_stock(view, block_from_the_side(scene))
    for order, floor in enumerate(reversed(floors)):
        removed = view.area(removed_to(floor, max(top, floor.z)))
        style.fill(view.axes, removed, floor.shade.floor, floor.edge, 1 + order / 100)
    for each in scene.uncut:
        style.hatch(view.axes, view.area(cut_through(each, top)))
    draw_paths(view)


def cut_through(uncut: Finding, top: float) -> BaseGeometry:
    """Return the uncut material in a pocket, in a section along X through its middle."""
    spans = spans_at(uncut.values["shape"], uncut.place[1])
    return unary_union([box(low, uncut.values["floor"], high, top) for low, high in spans])


def block_from_the_side(scene: Scene) -> BaseGeometry | None:
    """Return a block as seen along Y, if its depth is known."""
    stock = scene.stock
    if stock is None or stock.bottom is None:
        return None
    return box(stock.shape.bounds[0], stock.bottom, stock.shape.bounds[2], stock.top)


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
