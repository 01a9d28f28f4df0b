# SPDX-License-Identifier: GPL-2.0-or-later
"""The pictures of configs/spindle_c.md: the signals, and two changes of a real run.

    PYTHONPATH=python:tests python3 -m support.spindle_c_pictures

draws them anew.
"""

from __future__ import annotations

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from support.sim_machines import ROOT
from support.spindle_lathe import UNLOCKED, SpindleLathe

PICTURES = ROOT / "ngc" / "pictures"
DOTS_PER_INCH = 100
INK, FAINT, BOX, OURS, HOT, PATH = (
    "#1f2933", "#8d99a6", "#eef2f5", "#fdf3dc", "#a61e4d", "#1971c2",
)  # fmt: skip
BOXES = {  # left, bottom, width, height, colour, text
    "spindle": (0.0, 4.4, 2.3, 1.1, BOX, "spindle.0\nM3 M4 M5 S G96"),
    "code": (0.0, 2.5, 2.3, 1.1, BOX, "M254: M64 P2, M19\nM255: M65 P2"),
    "joint": (0.0, 0.6, 2.3, 1.1, BOX, "joint C\nG0 C, G12.1, G07.1"),
    "gate": (4.1, 4.4, 2.9, 1.1, OURS, "gate: shut from M254\nuntil M5 after M255"),
    "state": (4.1, 2.5, 2.9, 1.1, OURS, "index seen? stands?\nat C's angle for 0.1 s? C!"),
    "shift": (4.1, 0.6, 2.9, 1.1, OURS, "ramp to C's angle, then C;\nturns between kept"),
    "drive": (9.0, 2.5, 1.9, 3.0, BOX, "drive and\nmotor"),
    "encoder": (9.0, 0.6, 1.9, 1.1, BOX, "encoder\nwith index"),
}
ARROWS = (  # from, to, text, and where the text stands
    ((2.3, 5.2), (4.1, 5.2), "speed-out-rps", (3.2, 5.32)),
    ((2.3, 3.3), (4.1, 3.3), "request, orient", (3.2, 3.42)),
    ((4.1, 2.8), (2.3, 2.8), "spindle-c-on", (3.2, 2.55)),
    ((2.3, 1.4), (4.1, 1.4), "pos-cmd", (3.2, 1.52)),
    ((4.1, 0.9), (2.3, 0.9), "feedback", (3.2, 0.65)),
    ((7.0, 5.2), (9.0, 5.2), "spindle-c-velocity", (8.0, 5.32)),
    ((7.0, 3.3), (9.0, 3.3), "spindle-c-holds", (8.0, 3.42)),
    ((7.0, 1.4), (9.0, 2.7), "spindle-c-position", (7.55, 2.12)),
    ((9.0, 0.9), (7.0, 0.9), "TURNS, RPS", (8.0, 0.65)),
    ((9.95, 2.5), (9.95, 1.7), "", (0, 0)),
    ((5.55, 3.6), (5.55, 4.4), "", (0, 0)),
    ((5.55, 2.5), (5.55, 1.7), "", (0, 0)),
)
PROGRAM = [
    "G21 G18 G8 G40 G61 G90 G94", "G0 X40 Z5", "S600 M3", "G4 P1.2", "M254", "G0 C150", "G0 C60",
    "M255", "S400 M4", "G4 P1", "M254", "G0 C0", "M255", "M2",
]  # fmt: skip


def signals() -> Figure:
    """Return the drawing of the signals."""
    figure = Figure(figsize=(9.6, 5.2), dpi=DOTS_PER_INCH)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(-0.3, 11.3), ylim=(-0.55, 6.2))
    axes.axis("off")
    for left, bottom, width, height, colour, text in BOXES.values():
        look = {"boxstyle": "round,pad=0,rounding_size=0.1", "edgecolor": INK, "lw": 1}
        axes.add_patch(FancyBboxPatch((left, bottom), width, height, facecolor=colour, **look))
        middle = left + width / 2, bottom + height / 2
        axes.text(*middle, text, ha="center", va="center", fontsize=8.5, color=INK)
    for start, end, text, place in ARROWS:
        axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": PATH, "lw": 1.2})
        axes.text(*place, text, ha="center", fontsize=7.5, color=HOT)
    index_and_notes(axes)
    return figure


def index_and_notes(axes: Axes) -> None:
    """Draw the way of the index, which joint C has no part in, and the columns' names."""
    axes.plot((9.95, 9.95, -0.15, -0.15, 0.0), (0.6, 0.05, 0.05, 4.95, 4.95), color=FAINT, lw=1.2)
    note = "INDEX: of spindle.0 alone, never of joint C (G33 and G76 need it)"
    axes.text(4.9, -0.2, note, ha="center", fontsize=7.5, color=INK)
    for x, name in ((1.15, "LinuxCNC"), (5.55, "spindle_c.hal"), (9.95, "machine")):
        axes.text(x, 5.75, name, ha="center", fontsize=10, color=INK, weight="bold")


def over_time() -> Figure:
    """Return C, speed and mode of a run over time."""
    with SpindleLathe() as machine:
        samples = machine.run_text(PROGRAM).samples
    figure = Figure(figsize=(9.6, 5.6), dpi=DOTS_PER_INCH)
    angle, speed, error = figure.subplots(3, 1, sharex=True, height_ratios=(2, 2, 1))
    turns, is_c = samples.axes["T"], samples.axes["L"] < UNLOCKED
    steps = np.diff(turns, prepend=turns[0])
    rpm = np.where(np.abs(steps) > 0.3, np.nan, steps * 60e3)  # where the index reset it
    shaft = {"ms": 1.5, "color": FAINT, "label": "shaft, from its index"}
    angle.plot(samples.time, turns * 360 % 360, ".", **shaft)
    angle.plot(samples.time, samples.axes["C"], color=PATH, label="C commanded")
    angle.plot(samples.time, samples.axes["F"], color=HOT, ls="--", label="joint C feedback")
    speed.plot(samples.time, rpm, color=INK)
    error.plot(samples.time, samples.axes["E"], color=HOT)
    names = ("degrees", "spindle, rpm", "C's error,\ndegrees")
    for axes, name in zip((angle, speed, error), names):
        axes.set_ylabel(name)
        axes.grid(color="#e3e8ec")
        low, high = axes.get_ylim()
        axes.fill_between(samples.time, low, high, where=is_c, color=OURS, zorder=0)
        axes.set_ylim(low, high)
    angle.legend(loc="upper right", fontsize=8)
    angle.set_title("the spindle is C where the ground is yellow", fontsize=10)
    error.set_xlabel("s")
    figure.tight_layout()
    return figure


def draw_all() -> None:
    """Write both pictures."""
    for name, picture in (("spindle_c_signals", signals), ("spindle_c_time", over_time)):
        file = PICTURES / f"{name}.png"
        picture().savefig(file, dpi=DOTS_PER_INCH, facecolor="white", metadata={"Software": None})


if __name__ == "__main__":
    draw_all()
