# SPDX-License-Identifier: GPL-2.0-or-later
"""The drawings of the forms and of the codes' pages: what each entry or word measures.

    python3 .ci/form_pictures.py

draws them anew. ngcgui shows a picture of the form's name and halves one of 320 x 240 dots or
more. Lengths here are shares of the plan view's half width, angles degrees. A drawing of a code's
page has the words of the block in place of the form's entries.
"""

from math import cos, radians, sin
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

NGC = Path(__file__).resolve().parents[1] / "ngc"
UNITS = ("mm", "inch")
DOTS, DOTS_PER_INCH = (319, 239), 100
PAGE_DOTS_PER_INCH = 240
INK, FAINT, STOCK, CUT = "#1f2933", "#8d99a6", "#e9dcc3", "#ffffff"
TOOL, PATH, WORD = "#c9d6df", "#1971c2", "#a61e4d"
WORDS = {"fontsize": 6.4, "color": WORD, "ha": "center", "va": "center"}
NOTE = {"fontsize": 5.8, "color": INK, "ha": "center"}
PLATE = {"boxstyle": "square,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
ARROW = {"arrowstyle": "<->", "lw": 0.6, "color": WORD, "shrinkA": 0, "shrinkB": 0,
         "mutation_scale": 5}  # fmt: skip
AT_DEPTH = {"tool’s Z": -0.5}
EVENT_WORDS = {letter: letter for letter in "LCOW"}
CODE_WORDS = {"L": "Q", "C": "H", "O": "E", "W": "I"}  # of G12.2 and G13.2
Point = tuple[float, float]


def at(radius: float, angle: float) -> Point:
    """Return a point by its distance from the centre and its direction in degrees."""
    return radius * cos(radians(angle)), radius * sin(radians(angle))


def at_from(centre: Point, radius: float, angle: float) -> Point:
    """Return a point by its distance and direction from another."""
    x, y = at(radius, angle)
    return centre[0] + x, centre[1] + y


def views() -> tuple[Figure, Axes, Axes]:
    """Return an empty picture with the view from above and the one from the side."""
    figure = Figure(figsize=tuple(dots / DOTS_PER_INCH for dots in DOTS), dpi=DOTS_PER_INCH)
    return figure, *two_views(figure)


def two_views(figure: Figure, bottom: float = 0, height: float = 1) -> tuple[Axes, Axes]:
    """Add the two views to a share of a picture's height."""
    plan = figure.add_axes((0, bottom, 0.63, height))
    side = figure.add_axes((0.63, bottom, 0.37, height))
    for axes, left, right in ((plan, -1.15, 1.15), (side, -0.66, 0.9)):
        axes.set(xlim=(left, right), ylim=(-1.3, 1.3), aspect="equal")
        axes.axis("off")
    return plan, side


def save(figure: Figure, path: Path, dots_per_inch: int = DOTS_PER_INCH) -> None:
    figure.savefig(path, dpi=dots_per_inch, facecolor="white", metadata={"Software": None})


def measure(axes: Axes, start: Point, end: Point, words: str, where: float = 0.5) -> None:
    """Draw a line with arrows and what it measures, at a share of its length."""
    axes.annotate("", start, end, arrowprops=ARROW, zorder=4)
    place = [a + where * (b - a) for a, b in zip(start, end)]
    axes.text(*place, words, bbox=PLATE, zorder=5, **WORDS)


def circle(axes: Axes, radius: float, *, centre: Point = (0, 0), fill: str = "none",
           line: str = INK, dashed: bool = False, width: float = 0.8) -> None:  # fmt: skip
    style = {"ls": (0, (4, 3)) if dashed else "-", "lw": width}
    axes.add_patch(Circle(centre, radius, facecolor=fill, edgecolor=line, **style))


def tool(axes: Axes, radius: float, centre: Point, word: str = "T") -> None:
    circle(axes, radius, centre=centre, fill=TOOL)
    axes.text(*centre, word, **WORDS)


def turn(axes: Axes, radius: float, start: float, end: float) -> None:
    """Draw an arc with an arrow at its end, the way the tool goes."""
    axes.add_patch(Arc((0, 0), 2 * radius, 2 * radius, theta1=min(start, end),
                       theta2=max(start, end), color=PATH, lw=1.1))  # fmt: skip
    back = end - (6 if end > start else -6)
    axes.annotate("", at(radius, end), at(radius, back),
                  arrowprops={**ARROW, "arrowstyle": "-|>", "color": PATH})  # fmt: skip


def cross(axes: Axes, words: str, place: Point = (0, -0.13)) -> None:
    """Draw the centre and name it."""
    axes.plot((-0.07, 0.07), (0, 0), color=INK, lw=0.6, zorder=6)
    axes.plot((0, 0), (-0.07, 0.07), color=INK, lw=0.6, zorder=6)
    axes.text(*place, words, bbox=PLATE, zorder=6, **WORDS)


def section(side: Axes, heights: dict[str, float], levels: tuple[float, ...] = ()) -> None:
    """Draw the workpiece in section: its top at 0.3, the pocket's floor at -0.5.

    ``heights`` are the words at each height on the right.
    """
    side.add_patch(Rectangle((-0.66, -0.85), 1.02, 1.15, facecolor=STOCK, edgecolor=INK, lw=0.7))
    side.add_patch(Rectangle((-0.46, -0.5), 0.62, 0.81, facecolor=CUT, edgecolor="none"))
    side.plot((-0.46, -0.46, 0.16, 0.16), (0.3, -0.5, -0.5, 0.3), color=INK, lw=0.8)
    box(side, -0.27, -0.5, 0.24, 1.2, TOOL)
    for level in levels:
        side.plot((-0.46, 0.16), (level, level), color=FAINT, lw=0.6, ls=(0, (4, 3)))
    for words, height in heights.items():
        side.plot((-0.6, 0.42), (height, height), color=WORD, lw=0.5, ls=(0, (2, 2)))
        side.text(0.45, height, words, **{**WORDS, "ha": "left"})


def pocket(plan: Axes, rings: tuple[float, ...] = (), boss: float = 0, word: str = "T") -> None:
    """Draw a pocket of radius 1 with rings of the tool's centre, the tool and its turn.

    ``word`` names the tool.
    """
    circle(plan, 1.0, fill=CUT, width=1.2)
    for radius in rings:
        circle(plan, radius, dashed=True, line=FAINT)
    circle(plan, boss, fill=STOCK, width=0.6, line=FAINT)
    tool(plan, 0.26, at(0.74, 0), word)
    turn(plan, 0.74, 22, 75)
    plan.text(0, 1.12, "G  12 clockwise, 13 counterclockwise", **NOTE)


def haas(plan: Axes, side: Axes, *, page: bool = False) -> None:
    pocket(plan, (0.4, 0.7), word="D" if page else "T")
    measure(plan, (0, 0), at(0.4, 140), "I", 0.55)
    measure(plan, (0, 0), at(1.0, 205), "K", 0.62)
    measure(plan, at(0.4, 290), at(0.7, 290), "Q")
    cross(plan, "X Y")
    heights = (
        {"tool’s Z": 0.85, "Z": -0.5} if page else {"retract": 0.85, "Z top": 0.3, "Z depth": -0.5}
    )
    section(side, heights, (0.033, -0.233))
    side.text(-0.54, -0.1, "L", **WORDS)


def yasnac(plan: Axes, side: Axes, *, page: bool = False) -> None:
    pocket(plan, (0.62,), word="D" if page else "T")
    plan.plot((0, 0.36), (0, 0), color=PATH, lw=1.1, ls=(0, (3, 2)))
    measure(plan, (0, 0), at(0.62, 105), "R", 0.62)
    measure(plan, (0, 0), at(1.0, 205), "I", 0.62)
    measure(plan, (0, 0), at(0.5, 300), "K", 0.6)
    measure(plan, at(0.5, 300), at(0.8, 300), "Q")
    cross(plan, "X Y", (-0.05, -0.14))
    plan.text(0, -1.2, "I below 0: begun on the −X side", **NOTE)
    section(side, AT_DEPTH if page else {"retract": 0.85, "rapid to": 0.42, "Z depth": -0.5})


def mitsubishi(plan: Axes, side: Axes, *, page: bool = False) -> None:
    pocket(plan, boss=0.48, word="D" if page else "T")
    plan.add_patch(Arc((0.37, 0), 0.74, 0.74, theta1=180, theta2=360, color=PATH, lw=1.1))
    measure(plan, (0, 0), at(1.0, 205), "I", 0.62)
    cross(plan, "X Y", (-0.02, 0.14))
    section(side, AT_DEPTH if page else {"retract": 0.85, "rapid to": 0.42, "Z depth": -0.5})


def circle_mill(plan: Axes, side: Axes, *, page: bool = False) -> None:
    words = CODE_WORDS if page else EVENT_WORDS
    circle(plan, 0.92, fill=CUT, width=1.2)
    circle(plan, 0.8, dashed=True, line=FAINT)
    for radius in (0.28, 0.56):
        circle(plan, radius, line=PATH, width=0.6)
    tool(plan, 0.24, at(0.56, -90))
    measure(plan, (0, 0), at(0.88, 205), "R", 0.6)
    measure(plan, at(0.28, 60), at(0.56, 60), "J")
    plan.annotate(
        words["L"], at(0.8, 20), at(1.06, 20), arrowprops={**ARROW, "arrowstyle": "->"}, **WORDS
    )
    cross(plan, "X Y", (0.0, 0.12))
    plan.text(0, 1.12, f"{words['C']}  0 on, 1 left, 2 right of the circle", **NOTE)
    plan.text(0, -1.2, "D  0 CW, 1 CCW, 2 CW/CCW, 3 CCW/CW", **NOTE)
    section(side, {words["O"]: 0.85, words["W"]: 0.42, "Z": -0.5}, (0.1, -0.2, -0.44))
    measure(side, (-0.38, 0.42), (-0.38, 0.1), "K")


def bar_end(plan: Axes) -> None:
    """Draw the zero line of a bar's end, which is seen from the front."""
    plan.annotate("", (1.12, 0), (0.98, 0), arrowprops={**ARROW, "arrowstyle": "-|>", "color": INK})
    plan.text(1.04, -0.12, "C0", **NOTE)


def box(axes: Axes, x: float, y: float, width: float, height: float, fill: str = CUT) -> None:
    """Draw a rectangle from its lower left corner."""
    edge = 0.8 if fill == STOCK else 0.7
    axes.add_patch(Rectangle((x, y), width, height, facecolor=fill, edgecolor=INK, lw=edge))


def bar(side: Axes, tip: float, middle: float, word: str, where: float) -> None:
    """Draw a bar that sticks out of a spindle, Z0 at its end, and a depth cut into it.

    ``word``, at ``where``, names the distance to the tool's ``tip``.
    """
    box(side, -0.6, -0.45, 0.65, 0.9, STOCK)
    measure(side, (-0.25, -0.62), (0.05, -0.62), "")
    side.text(-0.1, -0.78, "depth", bbox=PLATE, **WORDS)
    measure(side, (0.05, 0.62), (tip, 0.62), "")
    side.text(where, 0.78, word, bbox=PLATE, **WORDS)
    side.plot((0.05, 0.05), (-0.95, 1.0), color=WORD, lw=0.5, ls=(0, (2, 2)))
    side.text(0.05, -1.08, "Z0", **WORDS)
    side.text(0.57, middle, "T", **WORDS)


def milled_bar(side: Axes, *cuts: tuple[float, float]) -> None:
    """Draw a bar with cuts, each by its lower side and its height."""
    bar(side, 0.32, 0.13, "retract", 0.2)
    box(side, 0.32, 0.02, 0.5, 0.22, TOOL)
    for low, height in cuts:
        box(side, -0.25, low, 0.3, height)


def bore(plan: Axes, side: Axes, *, page: bool = False) -> None:
    circle(plan, 0.95, fill=CUT, width=1.2)
    circle(plan, 0.45, line=FAINT, dashed=True)
    circle(plan, 0.63, line=PATH, width=0.6)
    tool(plan, 0.32, at(0.63, 0), "D" if page else "T")
    turn(plan, 0.63, 32, 80)
    measure(plan, (0, 0), at(0.95, 205), "I", 0.7)
    measure(plan, (0, 0), at(0.45, 120), "K", 0.65)
    cross(plan, "X Y")
    plan.text(0, 1.12, "G  12.5 clockwise, 13.5 counterclockwise", **NOTE)
    stock_and_hole(side, 0.31)
    helix(side, 0.14, 0.3, -0.5, 6)
    box(side, -0.15, 0.5, 0.3, 0.5, TOOL)
    measure(side, (-0.46, 0.03), (-0.46, -0.1), "")
    side.text(-0.53, -0.03, "P", **WORDS)
    at_heights(side, {"start": 0.9, "R": 0.3, "Z": -0.5})


def thread(plan: Axes, side: Axes, *, page: bool = False) -> None:
    circle(plan, 0.95, fill=CUT, width=1.2)
    circle(plan, 0.75, line=INK, width=0.6)
    circle(plan, 0.6, line=PATH, width=0.6)
    tool(plan, 0.35, at(0.6, 0), "D" if page else "T")
    turn(plan, 0.6, 38, 80)
    measure(plan, (0, 0), at(0.95, 205), "I", 0.7)
    measure(plan, (0, 0), at(0.75, 130), "K", 0.6)
    cross(plan, "X Y")
    plan.text(0, 1.12, "right-hand, inside: G13.6 goes up, G12.6 down", **NOTE)
    plan.text(0, -1.2, "left-hand (P below 0): the other way", **NOTE)
    stock_and_hole(side, 0.33)
    helix(side, 0.33, -0.5, 0.3, 4)
    measure(side, (-0.46, 0.0), (-0.46, 0.2), "")
    side.text(-0.54, 0.1, "P", **WORDS)
    for place, ends, code in ((-0.17, (-0.32, 0.15), "13.6"), (0.17, (0.15, -0.32), "12.6")):
        side.annotate("", (place, ends[1]), (place, ends[0]),
                      arrowprops={**ARROW, "arrowstyle": "-|>", "color": PATH})  # fmt: skip
        side.text(place, -0.64, code, **WORDS)
    at_heights(side, {"start": 0.9, "R": 0.3, "Z": -0.5})


def frame(plan: Axes, side: Axes, *, page: bool = False) -> None:
    for half, line in ((0, INK), (0.3, PATH), (0.5, FAINT)):
        corner = max(0.0, 0.3 - half)
        across, along = 0.98 - half - corner, 0.75 - half - corner
        ends = [at_from((a * across, b * along), corner, first + angle)
                for a, b, first in ((1, 1, 0), (-1, 1, 90), (-1, -1, 180), (1, -1, 270))
                for angle in range(0, 91, 15)]  # fmt: skip
        fill = CUT if not half else "none"
        plan.add_patch(Polygon(ends, closed=True, facecolor=fill, edgecolor=line, lw=0.9))
    tool(plan, 0.29, (0.68, 0.2), "D" if page else "T")
    measure(plan, (-0.98, -0.88), (0.98, -0.88), "I")
    measure(plan, (-0.85, -0.75), (-0.85, 0.75), "J", 0.62)
    measure(plan, (0.68, -0.45), at_from((0.68, -0.45), 0.3, 315), "R", 0.4)
    measure(plan, (-0.3, -0.45), (-0.3, -0.25), "")
    plan.text(-0.2, -0.35, "Q", **WORDS)
    cross(plan, "X Y", (0.0, -0.13))
    plan.text(0, 1.12, "H  0 pocket, 1 inside, 2 outside", **NOTE)
    plan.text(0, -1.2, "G  12.7 clockwise, 13.7 counterclockwise", **NOTE)
    section(side, {"start": 0.3, "Z": -0.5}, (-0.1,))
    side.text(-0.54, 0.1, "K", **WORDS)


def stock_and_hole(side: Axes, radius: float) -> None:
    """Draw the workpiece with a hole in section, and the hole's middle line."""
    side.add_patch(Rectangle((-0.66, -0.85), 1.02, 1.15, facecolor=STOCK, edgecolor=INK, lw=0.7))
    box(side, -radius, -0.5, 2 * radius, 0.81, CUT)
    side.plot((0, 0), (-0.6, 0.45), color=FAINT, lw=0.5, ls=(0, (6, 2, 1, 2)))


def helix(side: Axes, radius: float, first: float, last: float, turns: int) -> None:
    """Draw a helix from the side, its half at the back dashed."""
    for half in range(2 * turns):
        low, high = (first + (last - first) * (half + end) / 2 / turns for end in (0, 1))
        ends = (radius, -radius) if half % 2 == 0 else (-radius, radius)
        style = {"ls": (0, (2, 2))} if half % 2 == 0 else {}
        side.plot(ends, (low, high), color=PATH, lw=0.9, **style)


def at_heights(side: Axes, heights: dict[str, float]) -> None:
    for words, height in heights.items():
        side.plot((-0.6, 0.42), (height, height), color=WORD, lw=0.5, ls=(0, (2, 2)))
        side.text(0.45, height, words, **{**WORDS, "ha": "left"})


def polygon(plan: Axes, side: Axes) -> None:
    circle(plan, 0.95, fill=CUT, line=FAINT, dashed=True)
    corners = [at(0.56 / cos(radians(30)), angle) for angle in range(30, 390, 60)]
    plan.add_patch(Polygon(corners, closed=True, facecolor=STOCK, edgecolor=INK, lw=1.2))
    tool(plan, 0.2, at(0.76, 0))
    measure(plan, at(0.56, 120), at(0.56, 300), "across flats", 0.5)
    measure(plan, (-0.95, -1.08), (0.95, -1.08), "stock diameter")
    for x in (-0.95, 0.95):
        plan.plot((x, x), (-1.12, 0), color=WORD, lw=0.4)
    plan.annotate("corner", at(0.63, 150), (-0.8, 0.85), arrowprops={**ARROW, "arrowstyle": "->"},
                  **WORDS)  # fmt: skip
    plan.text(0.05, 1.1, "angle: C of the middle of a flat", **NOTE)
    milled_bar(side, (0.24, 0.21), (-0.45, 0.21))


def slot(plan: Axes, side: Axes) -> None:
    circle(plan, 0.95, fill=STOCK)
    for end in (-0.5, 0.5):
        circle(plan, 0.24, centre=(end, 0), fill=CUT, width=1.2)
    plan.add_patch(Rectangle((-0.5, -0.24), 1.0, 0.48, facecolor=CUT, edgecolor="none"))
    for y in (-0.24, 0.24):
        plan.plot((-0.5, 0.5), (y, y), color=INK, lw=1.2)
    tool(plan, 0.17, (0.5, 0))
    measure(plan, (-0.74, -0.5), (0.74, -0.5), "length")
    for x in (-0.74, 0.74):
        plan.plot((x, x), (-0.55, 0), color=WORD, lw=0.4)
    measure(plan, (-0.2, -0.24), (-0.2, 0.24), "width")
    plan.text(0.05, 1.1, "angle: C of the slot's middle line", **NOTE)
    milled_bar(side, (-0.11, 0.22))


def face_pocket(plan: Axes, side: Axes) -> None:
    centre = (0.36, 0.3)
    circle(plan, 0.95, fill=STOCK)
    circle(plan, 0.34, centre=centre, fill=CUT, width=1.2)
    tool(plan, 0.15, (0.55, 0.3))
    for x, y in ((0, 0), centre):
        plan.plot((x - 0.07, x + 0.07), (y, y), color=INK, lw=0.6)
        plan.plot((x, x), (y - 0.07, y + 0.07), color=INK, lw=0.6)
    measure(plan, (0, -0.3), (0.36, -0.3), "")
    plan.text(0.18, -0.45, "X / 2", **WORDS)
    plan.plot((0, 0, 0.36, 0.36), (0, -0.35, -0.35, 0.3), color=WORD, lw=0.4, ls=(0, (2, 2)))
    measure(plan, (-0.3, 0), (-0.3, 0.3), "C")
    plan.plot((-0.35, 0.36), (0.3, 0.3), color=WORD, lw=0.4, ls=(0, (2, 2)))
    plan.plot((-0.35, 0), (0, 0), color=WORD, lw=0.4, ls=(0, (2, 2)))
    measure(plan, (0.02, 0.78), (0.7, 0.78), "diameter")
    plan.text(0.05, 1.1, "X is a diameter, C a length", **NOTE)
    milled_bar(side, (-0.05, 0.36))


def face_holes(plan: Axes, side: Axes) -> None:
    circle(plan, 0.95, fill=STOCK)
    circle(plan, 0.62, line=FAINT, dashed=True)
    for angle in range(20, 380, 60):
        circle(plan, 0.13, centre=at(0.62, angle), fill=CUT, width=1.2)
    plan.plot((0, 0.8), (0, 0), color=WORD, lw=0.5)
    plan.plot(*zip((0, 0), at(0.8, 20)), color=WORD, lw=0.5)
    plan.plot(*zip((0, 0), at(0.8, 80)), color=WORD, lw=0.5)
    turn(plan, 0.36, 20, 80)
    plan.text(*at(0.36, 50), "step", bbox=PLATE, zorder=5, **WORDS)
    plan.text(0.72, 0.1, "first", bbox=PLATE, **WORDS)
    measure(plan, at(0.62, 140), at(0.62, 320), "circle diameter", 0.5)
    plan.text(0.05, 1.1, "first: C of the first hole", **NOTE)
    bar(side, 0.3, 0.14, "height", 0.25)
    box(side, -0.25, 0.06, 0.3, 0.16)
    box(side, 0.3, 0.06, 0.5, 0.16, TOOL)


def side_holes(plan: Axes, side: Axes) -> None:
    circle(plan, 0.7, fill=STOCK, width=1.2)
    for angle in (30, 120, 210, 300):
        for across in (-0.1, 0.1):
            cosine, sine = at(1.0, angle)
            ends = [(r * cosine - across * sine, r * sine + across * cosine) for r in (0.35, 0.69)]
            plan.plot(*zip(*ends), color=INK, lw=0.9)
    plan.plot((0, 0.9), (0, 0), color=WORD, lw=0.5)
    plan.plot(*zip((0, 0), at(0.95, 30)), color=WORD, lw=0.5)
    plan.plot(*zip((0, 0), at(0.95, 120)), color=WORD, lw=0.5)
    turn(plan, 0.9, 30, 120)
    plan.text(*at(0.9, 75), "step", bbox=PLATE, zorder=5, **WORDS)
    plan.text(*at(0.84, 14), "first", bbox=PLATE, **WORDS)
    measure(plan, (-0.7, -0.95), (0.7, -0.95), "surface diameter")
    plan.text(0.05, 1.1, "first: C of the first hole", **NOTE)
    box(side, -0.6, -0.6, 1.1, 0.9, STOCK)
    box(side, -0.13, 0.0, 0.16, 0.3, CUT)
    box(side, -0.13, 0.5, 0.16, 0.45, TOOL)
    side.text(-0.05, 0.75, "T", **WORDS)
    measure(side, (-0.3, 0.0), (-0.3, 0.3), "depth")
    measure(side, (0.2, 0.3), (0.2, 0.5), "height")
    measure(side, (-0.05, -0.8), (0.5, -0.8), "z")
    side.plot((0.5, 0.5), (-0.95, 0.3), color=WORD, lw=0.5, ls=(0, (2, 2)))
    side.text(0.5, -1.08, "Z0", **WORDS)


def axes_of(plan: Axes, right: str, up: str) -> None:
    """Draw the two directions of a flat drawing from its zero."""
    for end, word, place in (((1.1, 0), right, (1.06, -0.13)), ((0, 1.1), up, (-0.06, 1.06))):
        plan.annotate("", end, (0, 0), arrowprops={**ARROW, "arrowstyle": "-|>", "color": INK})
        plan.text(*place, word, **{**WORDS, "ha": "right"})


def polar(plan: Axes, side: Axes) -> None:
    """Draw the words of a section on the face of a bar, seen from the tool."""
    circle(plan, 0.95, line=FAINT, dashed=True)
    straight = [(0.25, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5), (0.5, 0.25)]
    rounded = [at_from((0.25, 0.25), 0.25, angle) for angle in range(0, 91, 10)]
    outline = [*straight, *rounded]
    plan.add_patch(Polygon(outline, closed=True, facecolor=STOCK, edgecolor=INK, lw=1.2))
    axes_of(plan, "X", "C or Y")
    tool(plan, 0.17, (0.67, -0.15))
    along = {**ARROW, "arrowstyle": "-|>", "color": PATH}
    plan.annotate("", (0.67, 0.24), (0.67, 0.03), arrowprops=along)
    plan.text(0.76, 0.12, "F", **WORDS)
    measure(plan, (0.5, 0.25), (0.25, 0.25), "I")
    measure(plan, (0.25, 0.25), at_from((0.25, 0.25), 0.25, 60), "R", 0.9)
    measure(plan, (0, -0.68), (0.5, -0.68), "")
    plan.text(0.25, -0.8, "X, in G7 twice this", **WORDS)
    measure(plan, (-0.66, 0), (-0.66, 0.5), "C")
    plan.text(0, 1.2, "the face, seen from the tool", **NOTE)
    box(side, -0.6, -0.45, 0.65, 0.9, STOCK)
    box(side, 0.1, -0.1, 0.7, 0.2, TOOL)
    side.plot((0.05, 0.05), (-0.95, 0.9), color=WORD, lw=0.5, ls=(0, (2, 2)))
    side.text(0.05, -1.08, "Z0", **WORDS)
    side.text(-0.28, 0.62, "turns as C", **WORDS)


def unrolled(plan: Axes, side: Axes, letters: str, centre: str) -> None:
    """Draw a section on a turned surface; ``letters`` are right, upwards, across."""
    right, up, height = letters.split()
    box(plan, -0.9, -0.8, 1.9, 1.75, STOCK)
    axes_of(plan, right, up)
    tool(plan, 0.16, (0.6, 0.55))
    middle, radius = (-0.6, -0.1), 0.5
    arc = [at_from(middle, radius, angle) for angle in range(0, 61, 10)]
    start = arc[-1]
    plan.plot(*zip((arc[0][0], -0.6), *arc, (-0.85, start[1])), color=INK, lw=1.2)
    circle(plan, 0.03, centre=start, fill=INK)
    measure(plan, start, (start[0], middle[1]), centre[1], 0.45)
    measure(plan, (start[0], middle[1]), middle, centre[0])
    measure(plan, middle, at_from(middle, radius, 20), "R", 0.8)
    circle(side, 0.5, centre=(0.1, -0.2), fill=STOCK)
    box(side, 0.02, 0.15, 0.16, 0.9, TOOL)
    measure(side, (0.1, -0.2), at_from((0.1, -0.2), 0.5, 240), "")
    measure(side, (-0.3, -0.2), (-0.3, 0.15), "")
    side.plot((-0.42, 0.1), (0.15, 0.15), color=WORD, lw=0.5, ls=(0, (2, 2)))
    side.text(-0.5, 0.25, height, **WORDS)


def cylinder(plan: Axes, side: Axes) -> None:
    """Draw the words of a section on a turned surface, unrolled and seen from outside."""
    unrolled(plan, side, "C Z X", "JK")
    measure(plan, (-0.9, -0.95), (1.0, -0.95), "")
    plan.text(0.05, -1.14, "360° of C: π · diameter long", **NOTE)
    plan.text(0, 1.15, "the surface unrolled, seen from outside", **NOTE)
    side.text(0.14, -0.85, "C of G7.1: radius", **WORDS)


def round_part(plan: Axes, side: Axes) -> None:
    """Draw the words of a section round a mill's part, unrolled and seen from the tool."""
    unrolled(plan, side, "X A− Z", "IJ")
    measure(plan, (-1.03, -0.8), (-1.03, 0.95), "")
    plan.text(0.05, -1.0, "360° of A: π · diameter long", **NOTE)
    plan.text(0, 1.15, "the surface unrolled, seen from the tool", **NOTE)
    side.text(0.14, -0.85, "A of G7.1: radius", **WORDS)
    side.text(0.14, -1.1, "seen from X+, Y to the right", **NOTE)
    turns = [at_from((0.1, -0.2), 0.6, angle) for angle in range(65, 14, -5)]
    side.plot(*zip(*turns), color=WORD, lw=0.8)
    side.annotate("", turns[-1], turns[-2], arrowprops={**ARROW, "arrowstyle": "-|>"})
    side.text(0.68, 0.32, "A+", **WORDS)


ON_A_MILL = (haas, yasnac, mitsubishi, circle_mill, bore, thread, frame)
ON_A_BAR = (polygon, slot, face_pocket, face_holes, side_holes)


ON_PAGES = ON_A_MILL
IN_SECTIONS = (polar, cylinder, round_part)


def plate(plan: Axes) -> None:
    """Draw the plate that a mill's cycle cuts."""
    plan.add_patch(Rectangle((-1.1, -1.06), 2.2, 2.12, facecolor=STOCK, edgecolor="none"))


def draw_pages() -> None:
    """Write the drawings of the codes' pages."""
    for draw in (*ON_PAGES, *IN_SECTIONS):
        figure, plan, side = views()
        if draw in ON_PAGES:
            plate(plan)
        draw(plan, side, **({"page": True} if draw in ON_PAGES else {}))
        save(figure, NGC / "pictures" / f"{draw.__name__}_words.png", PAGE_DOTS_PER_INCH)


def draw_holes() -> None:
    """Write the drawing of the holes' page: on the face, and on the side beneath it."""
    width, height = (dots / DOTS_PER_INCH for dots in DOTS)
    figure = Figure(figsize=(width, 2 * height), dpi=DOTS_PER_INCH)
    for draw, bottom in ((face_holes, 0.5), (side_holes, 0)):
        plan, side = two_views(figure, bottom, 0.5)
        bar_end(plan)
        draw(plan, side)
    save(figure, NGC / "pictures" / "holes_words.png", PAGE_DOTS_PER_INCH)


def draw_forms() -> None:
    """Write the picture of every form, for each unit's the same."""
    for draw in (*ON_A_MILL, *ON_A_BAR):
        figure, plan, side = views()
        if draw in ON_A_MILL:
            plate(plan)
        else:
            bar_end(plan)
        draw(plan, side)
        for unit in UNITS:
            save(figure, NGC / f"form_{draw.__name__}_{unit}.png")


if __name__ == "__main__":
    draw_forms()
    draw_pages()
    draw_holes()
