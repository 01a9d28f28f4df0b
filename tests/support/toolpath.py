# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that a section's contour asks for: with G41 and G42 the parallel contour.

By polar.md and cylinder.md:

1. Without compensation the tool's centre follows the contour.
2. An element under compensation is followed on its parallel, a tool radius away.
3. At an outside corner an arc about it joins two parallels, part of the element that follows. The
   random valid programs have no inside corner under compensation.
4. The line that switches compensation on ends square to the start of the next element, a tool
   radius away from it; the one that switches it off begins square to the end of the last one.
5. A move at right angles to the plane is made where the tool's centre is.

The words are taken for what they are: whether the tool gouges on this path is another question.
"""

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from g12.cut_report import CutReport, SectionCut
from g12.geometry.curve import Arc, Curve, Line
from support.contour_geometry import shape_of, spaced

NO_LENGTH = 1e-6  # mm
SPACING = 0.05  # mm of points
ROUNDED = 0.005  # mm: ends of parallels so near to each other meet


@dataclass(frozen=True)
class Element:
    """A line or an arc of a contour, mm; ``ramp``: compensation is switched on or off along it.

    ``depth`` is the level at its end. A move square to the plane has no length.
    """

    line: int
    start: complex
    end: complex
    side: int
    ramp: bool
    depth: float
    centre: complex | None = None
    sweep: float = 0.0
    feed: float | None = None

    @property
    def curve(self) -> Curve:
        if self.centre is None:
            return Line(self.start, self.end)
        return Arc(self.start, self.centre, self.sweep)

    @property
    def length(self) -> float:
        return self.curve.length


def elements_of(report: CutReport, cut: SectionCut) -> Iterator[Element]:
    """Yield the elements of a reported section; a plunge is where the one before it ends."""
    unit, at, side = report.frame.mm, start_of(report, cut), 0
    for each in cut.elements:
        is_plunge = each.start is None
        start, end = (at, at) if is_plunge else (each.start, each.end)
        centre = None if each.centre is None else each.centre * unit
        ramp = not is_plunge and each.side != side
        yield Element(
            each.line, start * unit, end * unit, each.side, ramp, each.z1 * unit,
            centre, each.sweep, each.feed * unit,
        )  # fmt: skip
        at, side = end, side if is_plunge else each.side


def start_of(report: CutReport, cut: SectionCut) -> complex:
    """Return where the first line or arc of a section begins; without one where the tool is."""
    x, _, z, c = report.at
    here = complex(math.radians(c) * cut.surface, z) if cut.surface else complex(x)
    return next((each.start for each in cut.elements if each.start is not None), here)


class Step(NamedTuple):
    """A move of the tool's centre: its curve, its levels, and its element's line and feed."""

    curve: Curve
    start_level: float
    end_level: float
    line: int
    feed: float | None

    @property
    def length(self) -> float:
        return abs(complex(self.curve.length, self.end_level - self.start_level))

    def points(self) -> np.ndarray:
        """Return points with their levels, rows of three."""
        has_length = self.curve.length > NO_LENGTH
        flat = spaced(shape_of(self.curve), SPACING) if has_length else np.full(2, self.curve.end)
        levels = np.linspace(self.start_level, self.end_level, len(flat))
        return np.column_stack([flat.real, flat.imag, levels])


def contour_path(elements: Iterable[Element], height: float, radius: float) -> list[Step]:
    """Return the path of the tool's centre along elements; it begins at a height.

    ``radius`` is the tool's.
    """
    elements = list(elements)
    at, path = elements[0].start, []
    moves = [each for each in elements if each.length > NO_LENGTH]
    every = followed_curves(moves, radius)
    for element in elements:
        curves = next(every) if element.length > NO_LENGTH else [Line(at, at)]
        for curve in curves:
            level = element.depth if curve is curves[-1] else height  # a corner's arc is level
            path.append(Step(curve, height, level, element.line, element.feed))
            at, height = curve.end, level
    return [step for step in path if step.length > NO_LENGTH]


def is_cut(element: Element | None) -> bool:
    """Tell whether an element is followed on its parallel."""
    return element is not None and bool(element.side) and not element.ramp


def followed_curves(moves: Sequence[Element], radius: float) -> Iterator[list[Curve]]:
    """Yield the curves of the tool's centre for each move: a corner's arc and the parallel."""
    parallels = [
        each.curve.offset(each.side * radius) if radius and is_cut(each) else each.curve
        for each in moves
    ]
    nothing = (None, None)
    pairs = [nothing, *zip(moves, parallels), nothing]
    for (before, last), (move, own), (after, following) in zip(pairs, pairs[1:], pairs[2:]):
        if is_cut(move):
            yield [*corner(before, move, last, own, radius), own]
        elif move.centre is None:
            start = last.end if is_cut(before) else move.start
            yield [Line(start, following.start if is_cut(after) else move.end)]
        else:
            yield [own]


def corner(before, move, last, own, radius) -> list[Curve]:
    """Return the arc about a corner of two parallels, none where they meet."""
    if not radius or not is_cut(before) or abs(own.start - last.end) < ROUNDED:
        return []
    turn = cmath.phase((own.start - move.start) / (last.end - move.start))
    assert turn * move.side < 0 or abs(turn) > math.pi - NO_LENGTH, f"inside corner: {move.line}"
    return [Arc(last.end, move.start, -move.side * abs(turn))]
