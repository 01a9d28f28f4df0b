# SPDX-License-Identifier: GPL-2.0-or-later
"""The detail view of a run's largest deviation: programmed path, actual motion, the gap."""

from collections.abc import Iterator

import numpy as np
from matplotlib.figure import Figure

from g12.tools.path.follow import Worst
from g12.tools.path.part import paths
from g12.tools.plot import style
from g12.tools.plot.scene import Scene
from g12.tools.units import Unit

DETAIL_SIZE = 1.9  # inches: the detail view's sides
NEIGHBOURS = 3  # number of moves drawn before and after
SAMPLES = 500  # of the motion drawn before and after
HALF_VIEW = 6.0  # half the view's side, in deviations
LEAST_WINDOW = 1e-4  # mm


def size_of(worst: Worst, unit: Unit) -> str:
    least = "below " if worst.deviation < LEAST_WINDOW else ""
    return f"{least}{unit.fine(max(worst.deviation, LEAST_WINDOW))} {unit.name}"


def draw_window(page: Figure, left: float, top: float, scene: Scene, worst: Worst) -> None:
    """Draw the detail view with its upper left corner so many inches to the right and down."""
    axes, real = style.add_axes(page, left, top, DETAIL_SIZE, DETAIL_SIZE), scene.real
    half = max(HALF_VIEW * worst.deviation, LEAST_WINDOW)
    before, after = real.points[max(0, worst.sample - 1) : worst.sample + 2][[0, -1]]
    pair = clearest_axes(worst.point - worst.nearest, after - before)
    origin = worst.nearest[pair]
    around = scene.moves[max(0, real.move[worst.sample] - NEIGHBOURS) :][: 2 * NEIGHBOURS + 1]
    programmed = [line[:, pair] - origin for line in paths(scene.path.part, around, half / 500)]
    near = real.points[max(0, worst.sample - SAMPLES) : worst.sample + SAMPLES]
    sampled = near[:, pair] - origin
    style.draw(axes, programmed, style.PATH, 2.6)
    style.draw(axes, [sampled], style.REAL, 1.0, 3.5)
    axes.plot(*sampled.T, ".", color=style.REAL, markersize=3, zorder=3.5)
    gap = np.array([[0.0, 0.0], worst.point[pair] - origin])
    style.draw(axes, [gap], style.WORST, 1.8, 4.0)
    in_segments = "C" in scene.path.part.letters
    title = "Deviation from segments" if in_segments else "Largest deviation"
    style.frame_detail(axes, (0, 0), half, title, "\n".join(window_lines(worst, scene, pair, half)))


def window_lines(worst: Worst, scene: Scene, pair: list[int], half: float) -> Iterator[str]:
    """Yield the lines below the view: size, position, feed, deviation from the contour, scale."""
    fast = f" at {scene.override:g} % feed" if scene.override != 100.0 else ""
    letters = " and ".join(scene.path.part.letters[axis] for axis in pair)
    yield f"{size_of(worst, scene.unit)}{fast},"
    yield f"line {scene.user_line(worst.move.block, '')}, in {letters}"
    if scene.contour is not None:
        yield f"off the contour: {scene.unit.fine(scene.contour)} {scene.unit.name}"
    yield f"the window is {scene.unit.fine(2 * half)} {scene.unit.name} wide"


def clearest_axes(deviation: np.ndarray, direction: np.ndarray) -> list[int]:
    """Return the two axes of the part, in order, that show a deviation and its path best."""
    score = sum(vector**2 / max(vector @ vector, 1e-30) for vector in (deviation, direction))
    return sorted(np.argsort(-score, kind="stable")[:2].tolist())
