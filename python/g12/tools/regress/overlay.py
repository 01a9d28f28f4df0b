# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of a program's differences: the recorded path, the present one, their gap.

The part is seen from above, or from the side if that shows more of the gap. Lengths are millimetres
until they are drawn; those of the layout are inches on the page.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from g12.tools.path.farthest_apart import Gap, gap_between
from g12.tools.path.part import Part, paths
from g12.tools.plot import style
from g12.tools.preview.moves import Move
from g12.tools.regress.differences import Difference
from g12.tools.regress.recording_text import Recording
from g12.tools.units import Unit, counted_as

CHORD_ERROR, FINEST_CHORD_ERROR = 0.005, 2e-5
BESIDE, ROWS = 0.35, 1.6  # the legend's distance from the view, its height
GAP_VIEW_SIZE = 2.0  # sides of the detail view of the largest gap
REACH, LEAST_REACH = 4.0, 1e-3  # half the view's side: in gaps, in mm
VISIBLE = 0.08  # of the picture's size: a larger gap needs no detail view
MARGIN_SHARE = 0.05
LEAST_EXTENT = 1e-6  # an axis with less motion is not shown
PLAN, SIDE, PROFILE = [0, 1], [0, 2], [2, 0]  # the part's axes of a view, across and up
DASHES = {"linestyle": (0, (4, 3)), "capstyle": "butt"}
STYLES = (  # text, colour, width, order
    ("as recorded", style.RAPID, 0.8, 2.5),
    ("recorded, not so any more", style.PATH, 3.0, 3.0),
    ("now", style.REAL, 1.2, 3.5),
)

Paths = list[tuple[list[np.ndarray], list[np.ndarray]]]  # for each of STYLES: at feed, rapids


def draw_overlay(was: Recording, now: Recording, found: Sequence[Difference], part: Part) -> Figure:
    unit, gap = now.unit, largest_gap(was, now, found, part)
    drawn = list(drawn_paths(was, now, found, part, gap))
    low, high = bounds_of(drawn)
    pair = view_of(gap, found, high - low)
    margin = MARGIN_SHARE * max(*(high - low), LEAST_EXTENT)
    low, high = low[pair] - margin, high[pair] + margin
    title = now.facts["program"].rpartition(" ")[0]
    text = f"{counted_as(len(found), 'difference')}: {found[0].text}"
    page = style.new_page(title, text)
    letters = ("towards C0", "towards C90", "Z") if part.turning else "XYZ"
    axes = style.add_view(page, low, high, unit, [letters[axis] for axis in pair])
    draw_paths(axes, drawn, pair, unit)
    left = axes.get_position().x1 + BESIDE
    style.draw_legend(page, legend(drawn, gap, unit), left, 0)
    if gap:
        ring = {"color": style.WORST, "markersize": 9, "fillstyle": "none"}
        axes.plot(*gap.point[pair] / unit.mm, "o", **ring)
    if gap and gap.size < VISIBLE * max(high - low):
        view = style.add_axes(page, left, ROWS, GAP_VIEW_SIZE, GAP_VIEW_SIZE)
        draw_gap(view, drawn, pair, gap, unit)
    return page


def bounds_of(drawn: Paths) -> tuple[np.ndarray, np.ndarray]:
    lines = [line for kinds in drawn for lines in kinds for line in lines]
    points = np.concatenate(lines or [np.zeros((1, 3))])
    return points.min(axis=0), points.max(axis=0)


def view_of(gap: Gap | None, found: Sequence[Difference], spread: np.ndarray) -> list[int]:
    """Return the part's axes to show: those of the motion, in which it differs most."""
    if spread[1] < LEAST_EXTENT < spread[2]:
        return PROFILE
    apart = gap.point - gap.nearest if gap else np.zeros(3)
    in_z = max(found, key=lambda one: abs(one.by)).axis == "Z"
    return SIDE if in_z or abs(apart[2]) > math.hypot(*apart[:2]) else PLAN


def largest_gap(
    was: Recording, now: Recording, found: Sequence[Difference], part: Part
) -> Gap | None:
    """Return the largest gap between moved or replaced moves and the recorded ones."""
    moved = [one for one in found if one.kind in ("moved", "replaced")]
    pairs = ((_moves(was, set(one.was)), _moves(now, set(one.now))) for one in moved)
    gaps = [gap_between(part, *pair) for pair in pairs if all(pair)]
    return max(filter(None, gaps), key=lambda gap: gap.size, default=None)


def _moves(recording: Recording, among: set[int]) -> list[Move]:
    return [move for i, move in enumerate(recording.steps) if i in among and isinstance(move, Move)]


def drawn_paths(
    was: Recording, now: Recording, found: Sequence[Difference], part: Part, gap: Gap | None
) -> Iterator[tuple[list[np.ndarray], list[np.ndarray]]]:
    """Yield the paths for each of STYLES, fine enough for the gap to be seen."""
    old = {index for one in found for index in one.was}
    new = {index for one in found for index in one.now}
    chord_error = max(min(CHORD_ERROR, gap.size / 100), FINEST_CHORD_ERROR) if gap else CHORD_ERROR
    same = {*range(len(now.steps))} - new
    for moves in (_moves(now, same), _moves(was, old), _moves(now, new)):
        fed = [move for move in moves if move.kind != "rapid"]
        fast = [move for move in moves if move.kind == "rapid"]
        yield paths(part, fed, chord_error), paths(part, fast, chord_error)


def draw_paths(axes: Axes, drawn: Paths, pair: list[int], unit: Unit) -> None:
    for (fed, fast), (_, colour, width, order) in zip(drawn, STYLES):
        for lines, share, dashes in ((fed, 1.0, {}), (fast, 0.6, DASHES)):
            shown = [line[:, pair] / unit.mm for line in lines]
            style.draw(axes, shown, colour, share * width, order, **dashes)


def draw_gap(axes: Axes, drawn: Paths, pair: list[int], gap: Gap, unit: Unit) -> None:
    """Draw the detail view of the largest gap."""
    half = max(REACH * gap.size, LEAST_REACH)
    draw_paths(axes, drawn, pair, unit)
    ends = np.array([gap.nearest[pair], gap.point[pair]]) / unit.mm
    style.draw(axes, [ends], style.WORST, 1.8, 4.0)
    text = f"{unit.fine(gap.size)} {unit.name}; the window is {unit.fine(2 * half)} wide"
    style.frame_detail(axes, ends.mean(axis=0), half / unit.mm, "Largest gap", text)


def legend(drawn: Paths, gap: Gap | None, unit: Unit) -> list:
    listed = [style.stroke(colour, text, width) for text, colour, width, _ in STYLES]
    if any(fast for _, fast in drawn):
        listed.append(style.stroke(style.INK, "dashed: rapid", 0.6, dashed=True))
    if gap:
        text = f"farthest apart, {unit.fine(gap.size)} {unit.name}"
        listed.append(style.marker(style.WORST, text, 7, hollow=True))
    return listed
