# SPDX-License-Identifier: GPL-2.0-or-later
"""The axes of a part that turns over time, in panels one below the other."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.part import C, Y, slide_positions, spindle_angles
from g12.tools.plot import style
from g12.tools.plot.plan_view import first_shown
from g12.tools.plot.scene import Scene
from g12.tools.units import plain

STEPS = "steps-pre"  # speeds: each holds from the moment before


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


def draw_history(panels: Sequence[Axes], scene: Scene) -> None:
    """Draw the axes over time, and the feed along the part, or its surface, of moves at feed."""
    found, mm, name = history_of(scene), scene.unit.mm, scene.unit.name
    turn, along, height = (AXIS_LETTERS[axis] for axis in scene.path.part.roles[:3])
    where = "surface" if scene.program.surface else "part"
    colour = style.REAL if scene.real is not None else style.DEPTHS(0.5)
    if scene.real is not None:
        feeds = np.array([scene.path.part_feed(index) for index in range(len(scene.moves))])
        programmed = feeds[scene.real.move] * scene.override / 100.0
        shown = np.where(found.rapid, np.nan, programmed) / mm
        panels[-1].plot(found.time, shown, color=style.PATH, linewidth=2.2, drawstyle=STEPS)
    for axes, text, values, drawstyle in zip(
        panels,
        (
            f"{height} (radius), {name}",
            f"{along}, {name}",
            f"{turn}, degrees",
            f"Speed of {turn}, degrees/s",
            f"Feed along the {where}, {name}/min",
        ),
        (
            found.x / mm,
            found.z / mm,
            found.c,
            found.c_speed,
            np.where(found.rapid, np.nan, found.feed) / mm,
        ),
        ("default", "default", "default", STEPS, STEPS),
    ):
        axes.plot(found.time, values, color=colour, linewidth=1.0, zorder=3, drawstyle=drawstyle)
        style.caption(axes, text)
        _shade_rapids(axes, found)
        axes.set_xlim(0, found.time[-1])
        axes.tick_params(labelbottom=axes is panels[-1])
    _draw_limit(panels[-2], scene.path.limits.axes[scene.path.part.roles.turn])
    panels[-1].set_ylim(0, 1.15 * panels[-1].get_ylim()[1])
    feeds_text = "" if scene.real is not None else ", at the programmed feeds"
    panels[-1].set_xlabel(f"time, s{feeds_text}")


def _draw_limit(axes: Axes, limit: float) -> None:
    if np.isfinite(limit):
        axes.axhline(limit, color=style.LIMIT, linewidth=0.9, linestyle=(0, (4, 2)))
        anchor = {"xy": (1, limit), "xycoords": ("axes fraction", "data"), "ha": "right"}
        offset = {"xytext": (0, 2), "textcoords": "offset points", "va": "bottom"}
        axes.annotate(f"limit {plain(limit, 1)}", color=style.LIMIT, size=7.5, **anchor, **offset)
        axes.set_ylim(0, 1.25 * limit)


def _shade_rapids(axes: Axes, found: History) -> None:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], found.rapid.astype(int), [0]])))
    last = len(found.time) - 1
    for first, end in zip(edges[::2], edges[1::2]):
        span = found.time[max(0, first - 1)], found.time[min(end - 1, last)]
        axes.axvspan(*span, color=style.FAINT, linewidth=0, zorder=0.5)
