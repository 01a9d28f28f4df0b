# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether compensation has the tool on the side of a contour that it comes from.

A tool that comes from outside of a closed contour is meant to stay outside of it; one that comes
to an open contour is meant to stay on the side from which it comes, unless it goes over the part to
the side away from the spindle's centre. Points are complex, in mm.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString

from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.sections.closed_contour import as_points, is_closed, trimmed

SAME = 1e-7  # mm
NEAR = 1e-2  # mm: a contour's end is met, not passed


class OtherSide(NamedTuple):
    """Compensation that takes the tool to the other side than it comes from.

    ``side`` is that of G41 (+1) or G42 (-1) in force; ``inside`` says on which side of a closed
    contour it is, None for an open one.
    """

    side: int
    inside: bool | None


def other_side(section: SectionContour, tool: float) -> OtherSide | None:
    """Return the first compensation of a section that is on the other side; ``tool`` a radius."""
    for ramp, stretch in leads_in(section) if tool else ():
        found = side_taken(ramp, trimmed(stretch), tool)
        if found:
            return found
    return None


def leads_in(section: SectionContour) -> Iterator[tuple[Element, list[Element]]]:
    """Yield each line on which compensation is switched on, and the contour behind it."""
    longer = [element for element in section.elements if element.length > SAME]
    for at, ramp in enumerate(longer):
        if ramp.ramp and ramp.side:
            stretch = list(takewhile(lambda each: not each.ramp, longer[at + 1 :]))
            if stretch:
                yield ramp, stretch


def side_taken(ramp: Element, contour: Sequence[Element], tool: float) -> OtherSide | None:
    """Return what is wrong with the side that a tool takes of a contour, if anything is."""
    contour = [element for element in contour if element.length > SAME]
    points = np.concatenate([as_points(element) for element in contour])
    if np.abs(points - ramp.start).min() < NEAR:
        return None
    if is_closed(contour):
        inside = (area_within(points) > 0.0) == (ramp.side > 0)
        return OtherSide(ramp.side, inside) if inside != goes_round(points, ramp.start) else None
    beside = contour[0].start + contour[0].normal(0.0) * ramp.side * tool
    wrong = crosses(ramp.start, beside, points) and not goes_over(ramp, contour, beside, points)
    return OtherSide(ramp.side, None) if wrong else None


def goes_over(
    ramp: Element, contour: Sequence[Element], beside: complex, points: np.ndarray
) -> bool:
    """Tell whether a tool goes above an open contour to the side away from the centre."""
    above = ramp.depth > min(element.depth for element in contour) + NEAR
    return above and crosses(0j, beside, points)


def area_within(points: np.ndarray) -> float:
    """Return the area within a closed polyline, above 0 if it goes round counterclockwise."""
    return float((points.conj() * np.roll(points, -1)).imag.sum() / 2)


def goes_round(points: np.ndarray, point: complex) -> bool:
    """Tell whether a closed polyline goes round a point."""
    away = points - point
    turns = np.angle(np.roll(away, -1) / away).sum() / (2 * np.pi)
    return bool(abs(turns) > 0.5)


def crosses(start: complex, end: complex, points: np.ndarray) -> bool:
    """Tell whether a line ends on the other side of a polyline than it starts."""
    along = points[[1, -1]] - points[[0, -2]]
    ends = points[[0, -1]] + along / np.abs(along) * (-NEAR, NEAR)
    contour = LineString([(p.real, p.imag) for p in (ends[0], *points, ends[1])])
    met = contour.intersection(LineString([(start.real, start.imag), (end.real, end.imag)]))
    return len(getattr(met, "geoms", [met] * (not met.is_empty))) % 2 == 1
