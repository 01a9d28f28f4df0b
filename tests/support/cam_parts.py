# SPDX-License-Identifier: GPL-2.0-or-later
"""Parts as a CAM system sees them: where the tool's centre goes over the face of a bar of 40.

X, Y and Z in mm, X as a radius, the face at Z0. A path is a list of moves: ``("rapid", x, y, z)``,
``("line", x, y, z)`` and ``("arc", x, y, z, i, j, turns)`` with the centre from the arc's start and
``turns`` 1 counter-clockwise, -1 clockwise. Of a part with ``side`` (41, 42) the path from its
``lead``-th move to its last but one is the contour, which the control compensates.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.geometry.curve import sweep_between


class CamPart(NamedTuple):
    """A part: its tool, the feed in mm/min, the moves, and the side of compensation."""

    tool: int
    feed: float
    path: tuple
    side: int = 40
    lead: int = 0


def at(radius, angle):
    """Return a point of the face, as a CAM system rounds it."""
    return round(radius * math.cos(angle), 4), round(radius * math.sin(angle), 4)


def polygon(sides, corner, first=0.0):
    """Return the corners of a polygon, clockwise, and the first again."""
    return [at(corner, first - math.tau * k / sides) for k in range(sides + 1)]


def lines(points, z):
    """Return lines through points at a level."""
    return [("line", x, y, z) for x, y in points]


def ring(radius, z, turns=-1):
    """Return a circle about the axis in four arcs, from X radius Y0."""
    ends = [(0, radius), (-radius, 0), (0, -radius), (radius, 0)]
    if turns < 0:
        ends = [(x, -y) for x, y in ends]
    starts = [(radius, 0), *ends]
    return [("arc", x, y, z, -a, -b, turns) for (a, b), (x, y) in zip(starts, ends)]


def helix(radius, top, bottom, parts):
    """Return a helix of thirds of a turn about the axis."""
    points = [at(radius, k * math.tau / 3) for k in range(parts + 1)]
    return [
        ("arc", x, y, round(top + (bottom - top) * (k + 1) / parts, 4), -a, -b, 1)
        for k, ((a, b), (x, y)) in enumerate(zip(points, points[1:]))
    ]


HEX = polygon(6, 16.5, math.radians(30))
PARTS = {
    "hexagon": CamPart(1, 400, (
        ("rapid", 34, 0, 5), ("rapid", 34, 0, 2), ("line", 34, 0, -3),
        *lines([(14.2894, 14), *HEX[1:], (19.4856, 5.25)], -3), ("line", 34, 5.25, -3),
        ("rapid", 34, 5.25, 5),
    ), 41, 3),
    "pocket": CamPart(3, 250, (
        ("rapid", 4, 0, 5), ("rapid", 4, 0, 1), ("line", 4, 0, 0), *helix(4, 0, -3, 6),
        *ring(4, -3, 1), ("line", 7, 0, -3), *ring(7, -3, 1), ("line", 6, 0, -2.5),
        ("rapid", 6, 0, 5),
    )),
    "slot": CamPart(3, 200, (
        ("rapid", 11, 6, 5), ("rapid", 11, 6, 1), ("line", 11, 6, 0), ("line", 11, -6, -1),
        ("line", 11, 6, -2), ("line", 11, -6, -2), ("rapid", 11, -6, 5),
    )),
    "strokes": CamPart(3, 300, (
        ("rapid", 5, 3, 4), ("line", 5, 3, -0.4), *lines([(12, 3), (12, 8)], -0.4),
        ("rapid", 12, 8, 4), ("rapid", -6, 9, 4), ("line", -6, 9, -0.4),
        *lines([(-12, 4), (-6, -2)], -0.4), ("rapid", -6, -2, 4), ("rapid", -3, -12, 4),
        ("line", -3, -12, -0.4), ("line", 8, -10, -0.4), ("rapid", 8, -10, 4),
    )),
    "levels": CamPart(2, 400, (
        ("rapid", 25, 0, 5), ("line", 25, 0, -1), ("line", 15, 0, -1), *ring(15, -1),
        ("line", 15, 0, -2.5), *ring(15, -2.5), ("line", 25, 0, -2.5), ("rapid", 25, 0, 5),
    )),
    "ramp": CamPart(3, 250, (
        ("rapid", 14, -8, 3), ("line", 14, -8, 0), ("line", 14, 8, -1.5), ("line", 6, 10, -3),
        ("arc", 6, -10, -3, 0, -10, 1), ("line", 14, -8, -1.5), ("rapid", 14, -8, 6),
    )),
    "inside": CamPart(3, 200, (
        ("rapid", 4, 2, 5), ("rapid", 4, 2, 1), ("line", 4, 2, -2), ("line", 11, 0, -2),
        ("line", 11, 6, -2), ("arc", 6, 11, -2, -5, 0, 1), ("line", -6, 11, -2),
        ("arc", -11, 6, -2, 0, -5, 1), ("line", -11, -6, -2), ("arc", -6, -11, -2, 5, 0, 1),
        ("line", 6, -11, -2), ("arc", 11, -6, -2, 0, 5, 1), ("line", 11, 0.5, -2),
        ("line", 4, -1, -2), ("rapid", 4, -1, 5),
    ), 41, 3),
}  # fmt: skip


def points_of(part, step=0.2):
    """Return points along a part's path, at most ``step`` apart."""
    found, here = [], np.array(part.path[0][1:4], float)
    for kind, *to in part.path[1:]:
        end = np.array(to[:3], float)
        if kind == "arc":
            leg = along_arc(here, end, *to[3:], step=step)
        else:
            count = max(2, math.ceil(math.dist(here, end) / step) + 1)
            leg = here + (end - here) * np.linspace(0, 1, count)[:, None]
        found.append(leg)
        here = end
    return np.concatenate(found)


def along_arc(start, end, i, j, turns, step):
    """Return points of an arc or a helix."""
    here, there = complex(*start[:2]), complex(*end[:2])
    centre = here + complex(i, j)
    sweep = sweep_between(here, there, centre, turns)
    share = np.linspace(0, 1, max(3, math.ceil(abs(sweep * (here - centre)) / step) + 1))
    plane = centre + (here - centre) * np.exp(1j * sweep * share)
    return np.column_stack([plane.real, plane.imag, start[2] + (end[2] - start[2]) * share])


def mill_program(part):
    """Return a part as a mill's program, as a post for LinuxCNC writes it."""
    rows, modal = [], {}

    def word(letter, value):
        text = f"{letter}{value:.4f}"
        changed = modal.get(letter) != text
        modal[letter] = text
        return text if changed else ""

    for at, (kind, *to) in enumerate(part.path):
        codes = {"rapid": "G0", "line": "G1", "arc": "G3" if to[-1] == 1 else "G2"}
        side = {part.lead: f"G{part.side} D{part.tool}", len(part.path) - 2: "G40"}
        comp = side.get(at, "") if part.side != 40 else ""
        words = [word(letter, value) for letter, value in zip("XYZ", to)]
        words += [f"I{to[3]:.4f} J{to[4]:.4f}"] if kind == "arc" else []
        words += [word("F", part.feed)] if kind != "rapid" else []
        rows.append(" ".join(filter(None, [codes[kind], comp, *words])))
    head = ["G17 G54 G40 G49 G80 G90", "G21", f"T{part.tool} M6", f"G43 H{part.tool}", "S900 M3"]
    return "\n".join([*head, *rows, "M5", "M2", ""])
