# SPDX-License-Identifier: GPL-2.0-or-later
"""The common style of all pictures: colours, lines, axes, legends, files; for a light page.

Lengths given to the drawing functions are in the units shown; sizes of figures in inches.
"""

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")

import numpy as np
from matplotlib import colors
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path as Outline
from shapely.geometry.base import BaseGeometry
from shapely.geometry.polygon import orient

from g12.tools.errors import UsageError
from g12.tools.machine.files import utf8_text
from g12.tools.units import Unit

FORMATS = ("png", "svg", "pdf")
INK, MUTED, FAINT = "#1f2933", "#64707d", "#e4e8ec"
PATH = "#5fa8d3"
RAPID = "#8d99a6"
REAL = "#e8590c"
WORST = "#c2255c"
LIMIT = "#c2255c"
CRASH = "#e03131"
STOCK, STOCK_EDGE = "#f4eee3", "#b39a6b"
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "text.color": INK,
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.6,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "svg.hashsalt": "g12",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}
matplotlib.rcParams.update(STYLE)
DEPTHS = colors.LinearSegmentedColormap.from_list(
    "depth", ["#58b4d1", "#2f86bd", "#1f5c9e", "#173f83", "#1b1f5e"]
)
FLOORS = colors.LinearSegmentedColormap.from_list(
    "floor", ["#e4f4f7", "#c3e1ef", "#a3cbe8", "#86aedd", "#93a9da"]
)
SIGN = {"marker": "^", "color": CRASH}
HIT = {"marker": "X", "color": CRASH, "markeredgecolor": "white"}
DPI = 150
TITLE, SUBTITLE = 0.89, 0.61  # inches above the views
SUBTITLE_WIDTH = 140  # characters
MARGIN = 0.2  # inches around the picture
WIDE, HIGH, LEAST = 7.0, 5.6, 1.2  # inches: a view to scale
CENTRE_LINE = {"color": MUTED, "linewidth": 0.5, "dashes": (12, 3, 2, 3), "zorder": 1.9}
SAVE = {"png": {"Software": None}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def check_format(path: Path) -> None:
    """Refuse a file whose suffix is no picture format, before any work is done."""
    if path.suffix.lower().lstrip(".") not in FORMATS:
        known = ", ".join(f".{name}" for name in FORMATS)
        raise UsageError(f"{path}: the suffix must be one of {known}")
    if not path.parent.is_dir():
        raise UsageError(f"{path.parent}: no such directory")


def new_page(title: str, subtitle: str) -> Figure:
    """Return a page with its title above the views.

    Its coordinates are inches to the right and upwards from the upper left corner of the views. It
    has no size: the saved picture holds whatever is drawn.
    """
    figure = Figure(figsize=(1, 1), facecolor="white")
    figure.text(0, TITLE, utf8_text(title), size=13, weight="bold", va="top")
    lines = "\n".join(textwrap.wrap(utf8_text(subtitle), SUBTITLE_WIDTH))
    figure.text(0, SUBTITLE, lines, size=8.5, color=MUTED, va="top")
    return figure


def add_axes(page: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Return axes whose upper left corner is so many inches to the right and down."""
    axes = page.add_axes([left, -top - height, width, height])
    axes.spines["top"].set_visible(False)
    axes.spines["right"].set_visible(False)
    return axes


def add_view(
    page: Figure,
    low: np.ndarray,
    high: np.ndarray,
    unit: Unit,
    names: Sequence[str],
    top: float = 0.0,
) -> Axes:
    """Return axes that show a portion of the part (mm) to scale, as large as fits."""
    size = high - low
    across, up = np.maximum(size * (np.array([WIDE, HIGH]) / size).min(), LEAST)
    axes = add_axes(page, 0, top, across, up)
    frame(axes, low, high, unit, names)
    axes.set_aspect("equal", adjustable="datalim")
    return axes


def caption(axes: Axes, text: str) -> None:
    axes.set_title(text, loc="left", size=9, color=INK, pad=5)


def frame(axes: Axes, low: np.ndarray, high: np.ndarray, unit: Unit, names: Sequence[str]) -> None:
    """Set limits (mm) and labels of a view of two axes."""
    (left, bottom), (right, top) = low / unit.mm, high / unit.mm
    across, up = (f"{name}, {unit.name}" for name in names)
    axes.set(xlim=(left, right), ylim=(bottom, top), xlabel=across, ylabel=up)


def frame_detail(axes: Axes, centre: Sequence[float], half: float, title: str, text: str) -> None:
    """Frame axes as the detail view of a deviation, ``half`` to each side, with a text below."""
    x, y = centre
    axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set(visible=True, color=WORST, linewidth=0.9)
    caption(axes, title)
    axes.set_xlabel(text, size=8, color=WORST, loc="left")


def draw_legend(page: Figure, entries: Sequence, left: float, top: float, columns: int = 1) -> None:
    """Draw the legend with its upper left corner so many inches to the right and down."""
    at = {"loc": "upper left", "bbox_to_anchor": (left, -top), "borderaxespad": 0.0}
    page.legend(handles=entries, ncol=columns, columnspacing=1.6, **at)


def fill(axes: Axes, area: BaseGeometry, face, edge=None, order: float = 1.0, **style) -> None:
    """Draw an area of shapely's as a filled shape, holes included."""
    outline = outline_of(area)
    if outline is not None:
        line = {"edgecolor": edge, "linewidth": 0.7} if edge is not None else {"linewidth": 0}
        axes.add_patch(PathPatch(outline, facecolor=face, zorder=order, **line, **style))


def outline_of(area: BaseGeometry) -> Outline | None:
    """Return the outline of an area, holes included; None if it is empty."""
    polygons = [part for part in getattr(area, "geoms", [area]) if part.geom_type == "Polygon"]
    rings = [
        np.asarray(ring.coords)
        for polygon in map(orient, (part for part in polygons if not part.is_empty))
        for ring in (polygon.exterior, *polygon.interiors)
    ]
    closed = (Outline(ring[:, :2], closed=True) for ring in rings)
    return Outline.make_compound_path(*closed) if rings else None


def draw(axes: Axes, lines: Sequence[np.ndarray], colour, width=1.1, order=3.0, **style) -> None:
    style = {"capstyle": "round", "joinstyle": "round", **style}
    axes.add_collection(
        LineCollection(lines, colors=colour, linewidths=width, zorder=order, **style),
        autolim=False,
    )


def draw_rapids(axes: Axes, lines: Sequence[np.ndarray], colour=RAPID, order: float = 2.5) -> None:
    draw(axes, lines, colour, 0.8, order, linestyle=(0, (4, 3)), capstyle="butt")


def draw_arrow(axes: Axes, line: np.ndarray, colour, order: float = 4.0) -> None:
    """Draw an arrowhead at the middle of a polyline (n, 2), pointing along it."""
    along = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1)))
    half = along[-1] / 2
    end = np.array([np.interp(half, along, axis) for axis in line.T])
    index = min(int(np.searchsorted(along, half, side="right")), len(line) - 1)
    tail = end - (line[index] - line[index - 1]) * 1e-3
    head = {"arrowstyle": "-|>,head_width=0.2,head_length=0.45", "mutation_scale": 13}
    axes.annotate("", end, tail, arrowprops={**head, "color": colour, "lw": 0}, zorder=order)


def tint(colour, share: float = 0.72) -> tuple[float, float, float]:
    return tuple(1 - (1 - value) * (1 - share) for value in colors.to_rgb(colour))


class Shade(NamedTuple):
    """The colours of one depth: of its paths, and of the floor that the cutter leaves."""

    line: tuple
    floor: tuple


def shade(share: float) -> Shade:
    """Return the colours of a depth, from 0 the shallowest to 1 the deepest."""
    return Shade(DEPTHS(share), FLOORS(share))


def hatch(axes: Axes, area: BaseGeometry) -> None:
    fill(axes, area, "none", CRASH, 2.4, hatch="////")


def draw_sign(axes: Axes, at: Sequence[float]) -> None:
    axes.plot(*at, **SIGN, markersize=15, zorder=6)
    axes.plot(*at, marker="$!$", color="white", markersize=6.5, zorder=6.1)


def draw_hit(axes: Axes, at: Sequence[float]) -> None:
    """Mark a rapid through material that is seen end on."""
    axes.plot(*at, **HIT, markersize=11, zorder=5.5)


def hit(text: str) -> Line2D:
    return Line2D([], [], ls="", **HIT, ms=8, label=text)


def uncut_entry(text: str) -> Patch:
    return Patch(facecolor="none", edgecolor=CRASH, linewidth=0.7, hatch="////", label=text)


def sign(text: str) -> Line2D:
    return Line2D([], [], ls="", **SIGN, ms=9, label=text)


def swatch(face, edge, text: str) -> Patch:
    return Patch(facecolor=face, edgecolor=edge, linewidth=1.1, label=text)


def stroke(colour, text: str, width: float = 1.3, dashed: bool = False) -> Line2D:
    style = (0, (4, 3)) if dashed else "-"
    return Line2D([], [], color=colour, linewidth=width, linestyle=style, label=text)


def marker(colour, text: str, size: float = 4.0, hollow: bool = False) -> Line2D:
    style = "none" if hollow else "full"
    return Line2D([], [], ls="", marker="o", color=colour, ms=size, fillstyle=style, label=text)


def save(figure: Figure, path: Path) -> None:
    kind = path.suffix.lower().lstrip(".")
    fit = {"bbox_inches": "tight", "pad_inches": MARGIN}
    figure.savefig(path, format=kind, dpi=DPI, metadata=SAVE[kind], **fit)
