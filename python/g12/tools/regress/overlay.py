# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a program's differences: the recorded path, the present one, their gap.

Lengths are millimetres until they are drawn; those of the layout are inches on the page.
"""

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from g12.tools.path.farthest_apart import Gap, gap_between
from g12.tools.path.part import Part, paths
from g12.tools.plot import style
from g12.tools.preview.moves import Move
from g12.tools.regress.differences import Difference
from g12.tools.regress.recording_text import Recording
from g12.tools.units import UNITS, Unit

Paths = list[list[np.ndarray]]  # (n, 3) on the part: unchanged, only recorded, only now

DRAWN_CHORD_ERROR = 0.005
LEFT, RIGHT, TOP, BETWEEN, BOTTOM = style.MARGIN, 0.3, 1.0, 0.65, 0.55
LARGEST_PLAN = np.array([7.0, 5.6])  # of the larger view, across and up
LEAST_PLAN = np.array([3.0, 1.4])
SIDE = 1.5  # height of the side view
LEGEND, ROWS = 2.9, 1.6
GAP_VIEW_SIZE = 2.0  # sides of the detail view of the largest gap
REACH, LEAST_REACH = 4.0, 1e-3  # half the view's side: in gaps, in mm
VISIBLE = 0.08  # of the picture's size: a larger gap needs no detail view
MARGIN_SHARE = 0.05
LEAST_EXTENT = 1e-6  # an axis with less motion is not shown
LONGEST_SUBTITLE = 130
FINEST_CHORD_ERROR = 1e-6
DASHES = {"linestyle": (0, (4, 3)), "capstyle": "butt"}
STYLES = (  # colour, width, order: same, was, now
    (style.RAPID, 0.8, 2.5),
    (style.PATH, 3.0, 3.0),
    (style.REAL, 1.2, 3.5),
)


class DrawnPaths(NamedTuple):
    """The paths of two recordings: moves at feed, rapids, the largest gap.

    ``around`` are the moves near that gap again, with a finer chord error.
    """

    feeds: Paths
    rapids: Paths
    gap: Gap | None
    around: Paths


class View:
    def __init__(self, points: np.ndarray, unit: Unit, turning: bool) -> None:
        self.unit = unit
        low, high = points.min(axis=0), points.max(axis=0)
        spread = high - low
        self.letters = ("towards C0", "towards C90", "Z") if turning else "XYZ"
        profile = spread[1] < LEAST_EXTENT < spread[2]
        self.pairs = [[2, 0]] if profile else [[0, 1]] + [[0, 2]] * bool(spread[2] > LEAST_EXTENT)
        self.size = max(*spread, LEAST_EXTENT)
        margin, plan = MARGIN_SHARE * self.size, self.pairs[0]
        self.low, self.high = low - margin, high + margin
        extent = (self.high - self.low)[plan]
        scale = (LARGEST_PLAN / extent).min()
        more = np.maximum(0.0, LEAST_PLAN / scale - extent) / 2
        self.low[plan], self.high[plan] = self.low[plan] - more, self.high[plan] + more
        self.plan = tuple((self.high - self.low)[plan] * scale)
        views = self.plan[1] + (BETWEEN + SIDE) * (len(self.pairs) > 1)
        self.height = max(TOP + views + BOTTOM, TOP + ROWS + GAP_VIEW_SIZE + BOTTOM)
        self.width = LEFT + self.plan[0] + LEGEND + RIGHT

    def panels(self, figure: Figure) -> Iterator[tuple[Axes, list[int]]]:
        """Yield the axes of each view with the part's two axes it shows."""
        bottom = self.height - TOP - self.plan[1]
        for pair, height in zip(self.pairs, (self.plan[1], SIDE)):
            axes = style.add_axes(figure, LEFT, bottom, self.plan[0], height)
            names = [self.letters[axis] for axis in pair]
            style.frame(axes, self.low[pair], self.high[pair], self.unit, names)
            style.caption(axes, "The part" if pair == self.pairs[0] else "Side, not to scale")
            yield axes, pair
            bottom -= BETWEEN + SIDE


def draw_overlay(was: Recording, now: Recording, found: Sequence[Difference], part: Part) -> Figure:
    drawn = drawn_of(was, now, found, part)
    lines = [line for some in (*drawn.feeds, *drawn.rapids) for line in some]
    points = np.concatenate(lines or [np.zeros((1, 3))])
    view = View(points, UNITS[now.facts["units"]], part.turning)
    name = now.facts["program"].rpartition(" ")[0]
    figure = style.new_figure(view.width, view.height, name, subtitle(found))
    for axes, pair in view.panels(figure):
        _draw_styled(axes, drawn.feeds, pair, view.unit.mm)
        _draw_styled(axes, drawn.rapids, pair, view.unit.mm, 0.6, **DASHES)
        if drawn.gap:
            at = drawn.gap.point[pair] / view.unit.mm
            axes.plot(*at, "o", color=style.WORST, markersize=9, fillstyle="none", zorder=6)
    left, top = LEFT + view.plan[0] + 0.35, view.height - TOP + 0.08
    style.draw_legend(figure, legend(drawn, view.unit), left, top, borderaxespad=0.0)
    if drawn.gap and drawn.gap.size < VISIBLE * view.size:
        axes = style.add_axes(
            figure, left, top - ROWS - GAP_VIEW_SIZE, GAP_VIEW_SIZE, GAP_VIEW_SIZE
        )
        draw_change(axes, drawn, view)
    return figure


def drawn_of(was: Recording, now: Recording, found: Sequence[Difference], part: Part) -> DrawnPaths:
    old = {index for difference in found for index in difference.was}
    new = {index for difference in found for index in difference.now}
    moves = (_moves(now, new, False), _moves(was, old, True), _moves(now, new, True))
    feeds, rapids = (
        [paths(part, _rapid(some, fast), DRAWN_CHORD_ERROR) for some in moves]
        for fast in (False, True)
    )
    gap = gap_of(was, now, found, part)
    near = [_near(part, some, gap) if gap else [] for some in moves]
    return DrawnPaths(feeds, rapids, gap, near)


def _reach(gap: Gap) -> float:
    return max(REACH * gap.size, LEAST_REACH)


def _near(part: Part, moves: Sequence[Move], gap: Gap) -> list[np.ndarray]:
    """Return moves near a gap as polylines, fine enough for its size."""
    margin = 2 * _reach(gap) + DRAWN_CHORD_ERROR
    lines = (part.polyline(move, DRAWN_CHORD_ERROR) for move in moves)
    near = [move for move, line in zip(moves, lines) if _is_near(line, gap.point, margin)]
    return paths(part, near, max(_reach(gap) / 500, FINEST_CHORD_ERROR))


def _is_near(line: np.ndarray, point: np.ndarray, margin: float) -> bool:
    low, high = line.min(axis=0) - margin, line.max(axis=0) + margin
    return bool(np.all((low <= point) & (point <= high)))


def _moves(recording: Recording, changed: set[int], among: bool) -> list[Move]:
    steps = enumerate(recording.steps)
    return [step for i, step in steps if (i in changed) is among and isinstance(step, Move)]


def _rapid(moves: Iterable[Move], fast: bool) -> list[Move]:
    return [move for move in moves if (move.kind == "rapid") is fast]


def gap_of(was: Recording, now: Recording, found: Sequence[Difference], part: Part) -> Gap | None:
    """Return the largest gap between moved or replaced moves and the recorded ones."""
    gaps = []
    for difference in found:
        if difference.kind in ("moved", "replaced"):
            before = _moves(was, set(difference.was), True)
            after = _moves(now, set(difference.now), True)
            gaps.append(gap_between(part, before, after) if before and after else None)
    return max(filter(None, gaps), key=lambda gap: gap.size, default=None)


def subtitle(found: Sequence[Difference]) -> str:
    """Return a text for the first difference of the path, and their number."""
    first = next((one for one in found if one.moves), found[0]).text
    text = first if len(found) == 1 else f"{len(found)} differences, such as {first}"
    return text if len(text) <= LONGEST_SUBTITLE else f"{text[:LONGEST_SUBTITLE]}…"


def _draw_styled(axes, drawn: Paths, pair: list[int], unit: float, share=1.0, **line) -> None:
    """Draw paths in two of the part's axes; ``unit`` is the unit shown in mm."""
    for lines, (colour, width, order) in zip(drawn, STYLES):
        shown = [line[:, pair] / unit for line in lines]
        style.draw(axes, shown, colour, share * width, order, **line)


def draw_change(axes: Axes, drawn: DrawnPaths, view: View) -> None:
    """Draw the detail view of the largest gap, in the axes that show most of it."""
    gap, unit = drawn.gap, view.unit
    half = _reach(gap)
    pair = max(view.pairs, key=lambda pair: round(math.dist(gap.point[pair], gap.nearest[pair]), 9))
    _draw_styled(axes, drawn.around, pair, unit.mm)
    ends = np.array([gap.nearest[pair], gap.point[pair]]) / unit.mm
    style.draw(axes, [ends], style.WORST, 1.8, 4.0)
    title = f"Largest gap{', from the side' if pair != view.pairs[0] else ''}"
    text = f"{unit.fine(gap.size)} {unit.name}; the window is {unit.fine(2 * half)} wide"
    style.frame_detail(axes, ends.mean(axis=0), half / unit.mm, title, text)


def legend(drawn: DrawnPaths, unit: Unit) -> list:
    listed = [
        style.stroke(style.RAPID, "as recorded", 0.8),
        style.stroke(style.PATH, "recorded, not so any more", 3.0),
        style.stroke(style.REAL, "now", 1.2),
    ]
    if any(drawn.rapids):
        listed.append(style.stroke(style.INK, "dashed: rapid", 0.6, dashed=True))
    if drawn.gap:
        text = f"farthest apart, {unit.fine(drawn.gap.size)} {unit.name}"
        listed.append(style.marker(style.WORST, text, 7, hollow=True))
    return listed
