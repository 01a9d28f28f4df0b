# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath that a section's contour asks for: with G41 and G42 the parallel contour.

By polar.md and cylinder.md:

1. Without compensation the tool's centre follows the contour.
2. An element under compensation is followed on its parallel, a tool radius away.
3. At an outside corner an arc about it joins two parallels, part of the element that follows; at an
   inside corner each ends where they cross.
4. The line that switches compensation on ends square to the start of the next element, a tool
   radius away from it; the one that switches it off begins square to the end of the last one.
5. A move at right angles to the plane is made where the tool's centre is.

The words are taken for what they are: whether the tool gouges on this path is another question.
"""

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from g12.cut_report import CutReport, SectionCut
from g12.geometry.curve import FULL_TURN, Arc, Curve, Line, crossings
from support.contour_geometry import shape_of, spaced

NO_LENGTH = 1e-6  # mm
SPACING = 0.05  # mm of points
BACK = math.pi - 1e-6  # radians: the contour goes back on itself
COINCIDENT = 0.005  # mm: ends of parallels so near to each other meet in the middle
ON_CURVE = 1e-5  # mm, of a crossing


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


class Corner(NamedTuple):
    """Where one curve of the tool's centre ends and the next begins, about which corner."""

    leave: complex
    meet: complex
    corner: complex | None = None


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
    is_compensated = radius and any(each.side for each in elements)
    path = parallel_path(elements, height, radius) if is_compensated else None
    if path is None:
        levels = [height, *(each.depth for each in elements)]
        path = [step_of(each, each.curve, *ends) for each, ends in zip(elements, pairwise(levels))]
    return [step for step in path if step.length > NO_LENGTH]


def step_of(element: Element, curve: Curve, start: float, end: float) -> Step:
    return Step(curve, start, end, element.line, element.feed)


def is_cut(element: Element) -> bool:
    """Tell whether an element is followed on its parallel."""
    return bool(element.side) and not element.ramp


def parallel_path(elements: Sequence[Element], height: float, radius: float) -> list[Step] | None:
    """Return the path of the tool's centre; None if a line is too short for its inside corners."""
    moves = [each for each in elements if each.length > NO_LENGTH]
    curves = [
        each.curve.offset(each.side * radius) if is_cut(each) else each.curve for each in moves
    ]
    joints = [None, *map(joint_of, zip(moves, moves[1:]), zip(curves, curves[1:])), None]
    if any(joint is TIGHT for joint in joints):
        return None
    path: list[Step] = []
    at, index = elements[0].start, 0
    for element in elements:
        if element.length > NO_LENGTH:
            found = followed_part(curves[index], joints[index], joints[index + 1], element)
            if found is None:
                return None
            path += placed(element, found, height)
            at, index = found[-1].end, index + 1
        else:
            path.append(step_of(element, Line(at, at), height, element.depth))
        height = element.depth
    return path


TIGHT = Corner(0j, 0j)


def joint_of(moves: tuple[Element, Element], curves: tuple[Curve, Curve]) -> Corner:
    """Return where the tool's centre goes from one element to the next, TIGHT if nowhere."""
    (one, other), (before, after) = moves, curves
    if not is_cut(one):
        return Corner(after.start, after.start)
    if not is_cut(other):
        return Corner(before.end, before.end)
    turned = cmath.phase(other.curve.direction(0.0) / one.curve.direction(1.0))
    gap = abs(after.start - before.end)
    outside = turned * one.side < 0.0 or abs(turned) > BACK
    if outside and gap > NO_LENGTH:
        return Corner(before.end, after.start, other.start)
    if outside or (gap < COINCIDENT and abs(turned) < math.pi / 2):
        middle = (before.end + after.start) / 2
        return Corner(middle, middle)
    shared = [
        place
        for place in crossings(before, after)
        if max(before.distance(place), after.distance(place)) < ON_CURVE
    ]
    nearest = min(shared, key=lambda place: trimmed_by(before, after, place), default=None)
    return TIGHT if nearest is None else Corner(nearest, nearest)


def trimmed_by(before: Curve, after: Curve, place: complex) -> float:
    """Return the length of two curves that is not followed if they are joined at a place."""
    last, first = last_share(before, place), first_share(after, place)
    return (1.0 - last) * before.length + first * after.length


def first_share(curve: Curve, place: complex) -> float:
    """Return the share of a curve at which it begins, near its start; of a circle both are."""
    share = curve.share_of(place)
    return share if share < 0.5 or not _is_full_circle(curve) else 0.0


def last_share(curve: Curve, place: complex) -> float:
    """Return the share of a curve at which it ends, near its end."""
    share = curve.share_of(place)
    return share if share > 0.5 or not _is_full_circle(curve) else 1.0


def _is_full_circle(curve: Curve) -> bool:
    """Tell whether a curve is a full circle, but for rounding."""
    return isinstance(curve, Arc) and abs(curve.sweep) > FULL_TURN - 1e-6


def followed_part(
    curve: Curve, before: Corner | None, after: Corner | None, element: Element
) -> list[Curve] | None:
    """Return what is followed of a curve between two joints, with the arc of the first one.

    None if nothing is: the second joint comes before the first.
    """
    start, end = before.meet if before else curve.start, after.leave if after else curve.end
    if not is_cut(element):
        return [Line(start, end)] if element.centre is None else [curve]
    first, last = first_share(curve, start), last_share(curve, end)
    if (last - first) * curve.length < -NO_LENGTH:
        return None
    followed = [curve.portion(first, max(first, last))]
    if before and before.corner is not None:
        turn = cmath.phase((before.meet - before.corner) / (before.leave - before.corner))
        followed.insert(0, Arc(before.leave, before.corner, -element.side * abs(turn)))
    return followed


def placed(element: Element, curves: Sequence[Curve], height: float) -> Iterator[Step]:
    """Yield the moves along an element: an arc about its corner is level."""
    for curve in curves[:-1]:
        yield step_of(element, curve, height, height)
    yield step_of(element, curves[-1], height, element.depth)
