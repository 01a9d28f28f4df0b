# SPDX-License-Identifier: GPL-2.0-or-later
"""The pictures beside the forms: what each entry measures, from above and from the side.

    python3 .ci/form_pictures.py

draws them anew. ngcgui shows a picture of the form's name and halves one of 320 x 240 dots or
more. Lengths here are shares of the plan view's half width, angles degrees.
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
INK, FAINT, STOCK, CUT = "#1f2933", "#8d99a6", "#e9dcc3", "#ffffff"
TOOL, PATH, WORD = "#c9d6df", "#1971c2", "#a61e4d"
WORDS = {"fontsize": 6.4, "color": WORD, "ha": "center", "va": "center"}
NOTE = {"fontsize": 5.8, "color": INK, "ha": "center"}
PLATE = {"boxstyle": "square,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}
ARROW = {"arrowstyle": "<->", "lw": 0.6, "color": WORD, "shrinkA": 0, "shrinkB": 0,
         "mutation_scale": 5}  # fmt: skip
Point = tuple[float, float]


def at(radius: float, angle: float) -> Point:
    """Return a point by its distance from the centre and its direction in degrees."""
    return radius * cos(radians(angle)), radius * sin(radians(angle))


def views() -> tuple[Figure, Axes, Axes]:
    """Return an empty picture with the view from above and the one from the side."""
    figure = Figure(figsize=tuple(dots / DOTS_PER_INCH for dots in DOTS), dpi=DOTS_PER_INCH)
    plan, side = figure.add_axes((0, 0, 0.63, 1)), figure.add_axes((0.63, 0, 0.37, 1))
    for axes, left, right in ((plan, -1.15, 1.15), (side, -0.66, 0.9)):
        axes.set(xlim=(left, right), ylim=(-1.3, 1.3), aspect="equal")
        axes.axis("off")
    return figure, plan, side


def measure(axes: Axes, start: Point, end: Point, words: str, where: float = 0.5) -> None:
    """Draw a line with arrows and what it measures, at a share of its length."""
    axes.annotate("", start, end, arrowprops=ARROW, zorder=4)
    place = [a + where * (b - a) for a, b in zip(start, end)]
    axes.text(*place, words, bbox=PLATE, zorder=5, **WORDS)


def circle(axes: Axes, radius: float, *, centre: Point = (0, 0), fill: str = "none",
           line: str = INK, dashed: bool = False, width: float = 0.8) -> None:  # fmt: skip
    style = {"ls": (0, (4, 3)) if dashed else "-", "lw": width}
    axes.add_patch(Circle(centre, radius, facecolor=fill, edgecolor=line, **style))


def tool(axes: Axes, radius: float, centre: Point) -> None:
    circle(axes, radius, centre=centre, fill=TOOL)
    axes.text(*centre, "T", **WORDS)


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


def pocket(plan: Axes, rings: tuple[float, ...] = (), boss: float = 0) -> None:
    """Draw a pocket of radius 1 with rings of the tool's centre, the tool and its turn."""
    circle(plan, 1.0, fill=CUT, width=1.2)
    for radius in rings:
        circle(plan, radius, dashed=True, line=FAINT)
    circle(plan, boss, fill=STOCK, width=0.6, line=FAINT)
    tool(plan, 0.26, at(0.74, 0))
    turn(plan, 0.74, 22, 75)
    plan.text(0, 1.12, "G  12 clockwise, 13 counterclockwise", **NOTE)


def haas(plan: Axes, side: Axes) -> None:
    pocket(plan, (0.4, 0.7))
    measure(plan, (0, 0), at(0.4, 140), "I", 0.55)
    measure(plan, (0, 0), at(1.0, 205), "K", 0.62)
    measure(plan, at(0.4, 290), at(0.7, 290), "Q")
    cross(plan, "X Y")
    section(side, {"retract": 0.85, "Z top": 0.3, "Z depth": -0.5}, (0.033, -0.233))
    side.text(-0.54, -0.1, "L", **WORDS)


def yasnac(plan: Axes, side: Axes) -> None:
    pocket(plan, (0.62,))
    plan.plot((0, 0.36), (0, 0), color=PATH, lw=1.1, ls=(0, (3, 2)))
    measure(plan, (0, 0), at(0.62, 105), "R", 0.62)
    measure(plan, (0, 0), at(1.0, 205), "I", 0.62)
    measure(plan, (0, 0), at(0.5, 300), "K", 0.6)
    measure(plan, at(0.5, 300), at(0.8, 300), "Q")
    cross(plan, "X Y", (-0.05, -0.14))
    plan.text(0, -1.2, "I below 0: begun on the −X side", **NOTE)
    section(side, {"retract": 0.85, "rapid to": 0.42, "Z depth": -0.5})


def mitsubishi(plan: Axes, side: Axes) -> None:
    pocket(plan, boss=0.48)
    plan.add_patch(Arc((0.37, 0), 0.74, 0.74, theta1=180, theta2=360, color=PATH, lw=1.1))
    measure(plan, (0, 0), at(1.0, 205), "I", 0.62)
    cross(plan, "X Y", (-0.02, 0.14))
    section(side, {"retract": 0.85, "rapid to": 0.42, "Z depth": -0.5})


def circle_mill(plan: Axes, side: Axes) -> None:
    circle(plan, 0.92, fill=CUT, width=1.2)
    circle(plan, 0.8, dashed=True, line=FAINT)
    for radius in (0.28, 0.56):
        circle(plan, radius, line=PATH, width=0.6)
    tool(plan, 0.24, at(0.56, -90))
    measure(plan, (0, 0), at(0.88, 205), "R", 0.6)
    measure(plan, at(0.28, 60), at(0.56, 60), "J")
    plan.annotate("L", at(0.8, 20), at(1.06, 20), arrowprops={**ARROW, "arrowstyle": "->"}, **WORDS)
    cross(plan, "X Y", (0.0, 0.12))
    plan.text(0, 1.12, "C  0 on, 1 left, 2 right of the circle", **NOTE)
    plan.text(0, -1.2, "D  0 CW, 1 CCW, 2 CW/CCW, 3 CCW/CW", **NOTE)
    section(side, {"O": 0.85, "W": 0.42, "Z": -0.5}, (0.1, -0.2, -0.44))
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


ON_A_MILL = (haas, yasnac, mitsubishi, circle_mill)
ON_A_BAR = (polygon, slot, face_pocket, face_holes, side_holes)


def draw_all() -> None:
    """Write every picture, for each unit's form the same."""
    for draw in (*ON_A_MILL, *ON_A_BAR):
        figure, plan, side = views()
        if draw in ON_A_MILL:
            plan.add_patch(Rectangle((-1.1, -1.06), 2.2, 2.12, facecolor=STOCK, edgecolor="none"))
        else:
            bar_end(plan)
        draw(plan, side)
        for unit in UNITS:
            figure.savefig(NGC / f"form_{draw.__name__}_{unit}.png", dpi=DOTS_PER_INCH,
                           facecolor="white", metadata={"Software": None})  # fmt: skip


if __name__ == "__main__":
    draw_all()
