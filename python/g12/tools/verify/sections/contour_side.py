# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether compensation has the tool on the side of a contour that it comes from.

A tool that comes from outside of a closed contour is meant to stay outside of it; one that comes
to an open contour is meant to stay on the side from which it comes, unless it goes over the part to
the side away from the spindle's centre. Points are complex, in mm.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from shapely.geometry import LineString

from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.outline import Outline, stretches_of, vectors

NEAR = 1e-2  # mm: a contour's end is met, not passed
SIDES = {1: ("G41", "G42"), -1: ("G42", "G41")}  # the code in force, and the other one


def judge_side(section: SectionContour, tool: float) -> Iterator[Finding]:
    """Yield each compensation that takes the tool (a radius) to the side it does not come from."""
    stretches = stretches_of(section) if tool else []
    for before, stretch in zip(stretches, stretches[1:]):
        if before[-1].ramp and before[-1].side and not stretch[0].ramp:
            outline = Outline(stretch)
            if np.abs(outline.points - before[-1].start).min() > NEAR:
                judge = closed_side if outline.is_closed else open_side
                yield from judge(section.line, before[-1], outline, tool)


def closed_side(line: int, ramp: Element, outline: Outline, tool: float) -> Iterator[Finding]:
    """Yield that the tool comes from the other side of a closed contour."""
    away = outline.points - ramp.start
    turns = np.angle(np.roll(away, -1) / away).sum() / (2 * np.pi)
    if outline.tool_is_inside != (abs(turns) > 0.5):
        code, instead = SIDES[ramp.side]
        here, there = ("inside", "outside")[:: 1 if outline.tool_is_inside else -1]
        values = {"here": here, "there": there, "code": code, "instead": instead}
        yield Finding("side-other", line, values)


def open_side(line: int, ramp: Element, outline: Outline, tool: float) -> Iterator[Finding]:
    """Yield that the tool crosses an open contour, and does not go over the part."""
    beside = outline.curves[0].start + 1j * outline.curves[0].direction() * ramp.side * tool
    above = ramp.depth > outline.depth + NEAR and crosses(0j, beside, outline.points)
    if crosses(ramp.start, beside, outline.points) and not above:
        yield Finding("side-crossed", line, {"instead": SIDES[ramp.side][1]})


def crosses(start: complex, end: complex, points: np.ndarray) -> bool:
    """Tell whether a line ends on the other side of a polyline than it starts."""
    along = points[[1, -1]] - points[[0, -2]]
    ends = points[[0, -1]] + along / np.abs(along) * (-NEAR, NEAR)
    contour = LineString(vectors([ends[0], *points, ends[1]]))
    met = contour.intersection(LineString(vectors([start, end])))
    return len(getattr(met, "geoms", [met] * (not met.is_empty))) % 2 == 1
