# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a lathe program with C: the part's face, and the axes over time.

The face is shown as one looks at it. Lengths are millimetres until they are drawn; those of the
layout are inches on the page.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.part import C, Y, slide_positions, spindle_angles
from g12.tools.path.track import limits_of
from g12.tools.plot import style
from g12.tools.plot.deviation import DETAIL_SIZE
from g12.tools.plot.plan_view import (
    SceneView,
    bounds_of,
    draw_plan,
    finish,
    first_shown,
    floors_of,
    legend_entries,
)
from g12.tools.plot.scene import Scene
from g12.tools.units import plain

FACE_SIZE = 5.0  # side of the face's view
BELOW = 0.55  # the distance of legend and detail view from it
PANELS_LEFT, PANELS_WIDTH = 6.0, 4.55
ROWS, PANEL, GAP = 5, 1.0, 0.3  # panels: number, height, gap
TIME_IN_RAPIDS = style.swatch(style.FAINT, None, "time spent in rapids")


class History(NamedTuple):
    """The axes over time, arrays of one value per moment: X (radius), Z, C, speeds, whether rapid.

    Seconds, mm, degrees, degrees/s, mm/min along the part.
    """

    time: np.ndarray
    x: np.ndarray
    z: np.ndarray
    c: np.ndarray
    c_speed: np.ndarray
    feed: np.ndarray
    rapid: np.ndarray


def draw_face(scene: Scene) -> Figure:
    floors = floors_of(scene)
    page = style.new_page(scene.title, scene.subtitle)
    view = SceneView(style.add_axes(page, 0, 0, FACE_SIZE, FACE_SIZE), scene)
    frame_face(view.axes, scene, floors)
    draw_plan(view, floors)
    draw_history(panels_of(page, PANELS_LEFT, 0, PANELS_WIDTH, ROWS), scene, "part")
    entries = [*legend_entries(scene, floors), TIME_IN_RAPIDS]
    below = FACE_SIZE + BELOW
    legend = (0, below, 2 if scene.real is None else 1)
    return finish(page, [view], entries, legend, (FACE_SIZE - DETAIL_SIZE, below + GAP))


def panels_of(page: Figure, left: float, top: float, width: float, rows: int) -> list[Axes]:
    """Return panels one below the other, the first one's upper left corner there."""
    tops = (top + row * (PANEL + GAP) for row in range(rows))
    return [style.add_axes(page, left, each, width, PANEL) for each in tops]


def frame_face(axes: Axes, scene: Scene, floors: list) -> None:
    low, high = bounds_of(scene, floors)
    low, high = np.minimum(low[:2], 0), np.maximum(high[:2], 0)
    middle, half = (low + high) / 2, max(high - low) / 2
    style.frame(axes, middle - half, middle + half, scene.unit, ("towards C0", "towards C90"))
    axes.set_aspect("equal")
    axes.axhline(0, **style.CENTRE_LINE)
    axes.axvline(0, **style.CENTRE_LINE)
    style.caption(axes, "; ".join(filter(None, ["The part's face", scene.x0_text])))


def draw_history(panels: Sequence[Axes], scene: Scene, along: str) -> None:
    """Draw the axes over time, and the feed ``along`` the part or its surface."""
    history = history_of(scene)
    x, z, c, c_speed, feed = panels
    colour = style.REAL if scene.real is not None else style.DEPTHS(0.5)
    drawn = {"color": colour, "linewidth": 1.0, "zorder": 3}
    name = scene.unit.name
    x.plot(history.time, history.x / scene.unit.mm, **drawn)
    turn, along_axis, height = (AXIS_LETTERS[axis] for axis in scene.path.part.roles[:3])
    style.caption(x, f"{height} (radius), {name}")
    z.plot(history.time, history.z / scene.unit.mm, **drawn)
    style.caption(z, f"{along_axis}, {name}")
    c.plot(history.time, history.c, **drawn)
    style.caption(c, f"{turn}, degrees")
    c_speed.plot(history.time, history.c_speed, drawstyle="steps-pre", **drawn)
    limit = limits_of(scene.program.ini).axes[scene.path.part.roles.turn]
    draw_limit(c_speed, limit)
    style.caption(c_speed, f"Speed of {turn}, degrees/s")
    draw_feed(feed, history, scene, drawn)
    style.caption(feed, f"Feed along the {along}, {name}/min")
    for axes in panels:
        shade_rapids(axes, history)
        axes.set_xlim(0, history.time[-1])
        axes.tick_params(labelbottom=axes is feed)
    feed.set_xlabel("time, s" if scene.real is not None else "time, s, at the programmed feeds")


def history_of(scene: Scene) -> History:
    """Return the axes over time: in a run, or with every move at its feed, if the axes can."""
    path, part = scene.real or scene.path, scene.path.part
    turn, along, height, _ = part.roles
    first = 0 if scene.real else scene.path.vertices(first_shown(scene)).start
    positions, time = path.positions[first:], path.time[first:] - path.time[first]
    beside = positions[:, Y] * (turn == C)  # on a lathe Y is the face's
    on_face = positions[:, height] + 1j * beside
    c = spindle_angles(on_face, positions[:, turn], part.beside)
    slide = slide_positions(on_face, part.beside)
    x = np.where(slide.imag, np.abs(slide), slide.real)
    steps = np.linalg.norm(np.diff(path.points[first:], axis=0), axis=1)
    seconds = np.maximum(np.diff(time), 1e-12)
    speeds = np.abs(np.diff(c)) / seconds, steps / seconds * 60
    c_speed, feed = (np.insert(values, 0, values[:1]) for values in speeds)
    fast = np.array([move.kind == "rapid" for move in scene.moves])
    return History(time, x, positions[:, along], c, c_speed, feed, fast[path.move[first:]])


def draw_feed(axes: Axes, history: History, scene: Scene, drawn: dict) -> None:
    """Draw the feed along the part, of moves at feed only."""
    feeds = [(history.feed, drawn)]
    if scene.real is not None:
        of_moves = np.array([scene.path.part_feed(index) for index in range(len(scene.moves))])
        programmed = of_moves[scene.real.move] * scene.override / 100.0
        feeds.insert(0, (programmed, {"color": style.PATH, "linewidth": 2.2}))
    for feed, line in feeds:
        shown = np.where(history.rapid, np.nan, feed) / scene.unit.mm
        axes.plot(history.time, shown, drawstyle="steps-pre", **line)
    axes.set_ylim(0, 1.15 * axes.get_ylim()[1])


def draw_limit(axes: Axes, limit: float) -> None:
    if np.isfinite(limit):
        axes.axhline(limit, color=style.LIMIT, linewidth=0.9, linestyle=(0, (4, 2)))
        anchor = {"xy": (1, limit), "xycoords": ("axes fraction", "data"), "ha": "right"}
        offset = {"xytext": (0, 2), "textcoords": "offset points", "va": "bottom"}
        axes.annotate(f"limit {plain(limit, 1)}", color=style.LIMIT, size=7.5, **anchor, **offset)
        axes.set_ylim(0, 1.25 * limit)


def shade_rapids(axes: Axes, history: History) -> None:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], history.rapid.astype(int), [0]])))
    last = len(history.time) - 1
    for first, end in zip(edges[::2], edges[1::2]):
        span = history.time[max(0, first - 1)], history.time[min(end - 1, last)]
        axes.axvspan(*span, color=style.FAINT, linewidth=0, zorder=0.5)
