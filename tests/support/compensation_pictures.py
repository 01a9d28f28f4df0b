# SPDX-License-Identifier: GPL-2.0-or-later
"""The picture of the three examples of compensation in `ngc/polar.md`, from their own programs.

    PYTHONPATH=python:tests /usr/bin/python3 -m support.compensation_pictures

draws it anew. The tool's centre is where LinuxCNC's preview of a program has it.
"""

from __future__ import annotations

import re

import matplotlib

matplotlib.use("Agg")
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Polygon

from g12.tools.preview.tracer import Tracer
from support.polar_programs import in_plane
from support.sim_machines import ROOT, SIM

PAGE, PICTURE = ROOT / "ngc" / "polar.md", ROOT / "ngc" / "pictures" / "compensation.png"
HEADING = "## Compensation in three examples"
PART, INK, PATH, WRONG, TOOL = "#e9dcc3", "#1f2933", "#1971c2", "#c92a2a", "#c9d6df"
PARTS = (  # corners of what stays, or of what is cut out
    [(14, -10), (-14, -10), (-14, 10), (4, 10), (4, 2), (14, 2)],
    [(10, -2.5), (10, 2.5), (-10, 2.5), (-10, -2.5)],
    [(10, -10), (10, 10), (-10, 10), (-10, -10)],
)
RADIUS = 3.0


def examples() -> list[str]:
    """Return the programs of the section, in their order."""
    text = PAGE.read_text(encoding="utf-8").split(HEADING)[1].split("\n## ")[0]
    blocks = re.findall(r"(?:^ {4}.*\n)+", text, re.MULTILINE)
    return [
        re.sub("^ {4}", "", block, flags=re.MULTILINE) for block in blocks if "G12.1\n" in block
    ]


def draw(axes: Axes, example: int, points: list, title: str, *, hole: bool) -> None:
    """Draw one example: the part, and the toolpath if there is one."""
    axes.set(xlim=(-19, 24), ylim=(-19, 19), aspect="equal")
    axes.axis("off")
    axes.set_title(title, size=8.5, color=INK, loc="left")
    if hole:
        axes.add_patch(Circle((0, 0), 17.5, facecolor=PART, edgecolor="none"))
    face = "white" if hole else PART
    axes.add_patch(Polygon(PARTS[example], facecolor=face, edgecolor=INK, lw=1.2))
    if points:
        axes.plot(*zip(*points), color=PATH, lw=1.2)
        axes.annotate("", points[len(points) // 2 + 1], points[len(points) // 2],
                      arrowprops={"arrowstyle": "-|>", "color": PATH})  # fmt: skip


def tool_at(axes: Axes, x: float, c: float, colour: str) -> None:
    """Draw the cutter with its centre at a point."""
    axes.add_patch(Circle((x, c), RADIUS, facecolor=TOOL, edgecolor=colour, lw=1.0, alpha=0.75))


def toolpaths() -> list[list[tuple[float, float]]]:
    """Return the path of the tool's centre of each example, none where it is refused."""
    with Tracer(SIM / "lathe_mm.ini") as tracer:
        traces = [tracer.trace_text(text) for text in examples()]
    return [
        [in_plane(move.end)[:2] for move in trace.moves if move.remap and move.end[2] < 0]
        for trace in traces
    ]


def main() -> None:
    """Draw the picture."""
    figure = Figure(figsize=(10.5, 3.4), dpi=110)
    corners, slot, pocket = toolpaths()
    axes = [figure.add_axes((0.005 + k / 3, 0.0, 0.325, 0.92)) for k in range(3)]
    draw(axes[0], 0, corners, "1  outside: arc; inside: intersection", hole=False)
    tool_at(axes[0], 7, 5, PATH)
    draw(axes[1], 1, slot, "2  5 wide, cutter 6: refused", hole=True)
    tool_at(axes[1], -2, 0, WRONG)
    draw(axes[2], 2, pocket, "3  begin on a side, never in a corner", hole=True)
    tool_at(axes[2], 7, 0, PATH)
    tool_at(axes[2], 7, -10, WRONG)
    axes[2].text(10.8, -14.5, "refused", size=7, color=WRONG)
    figure.savefig(PICTURE)


if __name__ == "__main__":
    main()
