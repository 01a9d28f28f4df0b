# SPDX-License-Identifier: GPL-2.0-or-later
"""How large a section's contour comes out: how far it reaches, and its widths across flats.

Points are complex, lengths mm. The wall is where the cutter's edge goes, a tool radius beside its
centre; leads that stick out of a closed contour are no part of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np

from g12.geometry.curve import Curve, Line
from g12.tools.verify.compare.section import SectionPath
from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.sections.closed_contour import MEETS, trimmed
from g12.tools.verify.sections.contour_width import across_flats

LENGTHLESS = 1e-6


class SectionSize(NamedTuple):
    """The least and the greatest of a contour, as programmed and reached, and its widths."""

    wanted: tuple[float, float]
    reached: tuple[float, float]
    flats: tuple[tuple[float, float], ...]


class Walls(NamedTuple):
    """Points of the wall along an element: of the contour, and as reached."""

    wanted: np.ndarray
    reached: np.ndarray


def contour_size(
    section: SectionContour,
    found: SectionPath,
    points: Mapping[int, np.ndarray],
    radius: float,
    sizes: Callable[[np.ndarray], np.ndarray],
) -> SectionSize:
    """Return the size of what is compensated of a contour, of all of it if nothing is.

    ``points`` are those of the tool's centre in the plane by move, ``sizes`` what counts of them.
    """
    sides = {each.side for each in section.elements if not each.ramp} - {0} or {0}
    leads = [lead for stretch in stretches_of(section) for lead in leads_of(stretch)]
    cut = [
        (element, on_shape(walls, leads))
        for element, walls in walls_along(found, points, radius)
        if element.side in sides
    ]
    wanted = [sizes(walls.wanted) for _, walls in cut]
    reached = [sizes(walls.reached) for _, walls in cut]
    flats = across_flats([(each, walls.reached) for each, walls in cut if each.side])
    return SectionSize(span(wanted), span(reached), tuple(flats))


def stretches_of(section: SectionContour) -> list[list[Element]]:
    """Return the stretches of contour with the tool on one side, ramps aside."""
    longer = (element for element in section.elements if element.length > LENGTHLESS)
    groups = groupby(longer, key=lambda element: (element.side, element.ramp))
    return [list(stretch) for (_, ramp), stretch in groups if not ramp]


def leads_of(stretch: Sequence[Element]) -> list[Curve]:
    """Return what sticks out of a closed contour where its end meets its beginning."""
    if not stretch[0].side:
        return []
    pairs = zip(stretch, trimmed(stretch))
    cut = [(whole.curve, kept) for whole, kept in pairs if kept.length < whole.length - LENGTHLESS]
    ends = [(each, each.share_of(kept.start), each.share_of(kept.end)) for each, kept in cut]
    parts = [
        part
        for curve, first, last in ends
        for part in (curve.portion(0.0, first), curve.portion(last, 1.0))
    ]
    return [part for part in parts if part.length > LENGTHLESS]


def on_shape(walls: Walls, leads: Sequence[Curve]) -> Walls:
    """Return the walls that are no lead."""
    on = [all(lead.distance(place) > MEETS for lead in leads) for place in walls.wanted]
    return Walls(walls.wanted[on], walls.reached[on])


def walls_along(
    found: SectionPath, points: Mapping[int, np.ndarray], radius: float
) -> Iterator[tuple[Element, Walls]]:
    """Yield the walls of each element that is cut."""
    pieces: dict[int, list[np.ndarray]] = {}
    for index, made in (found.run or found.emitted).spans.items():
        whole = made.index == made.last or made.share > 1.0 - LENGTHLESS
        if whole and found.expected[made.last].name == "contour" and index in points:
            before = pieces.setdefault(made.last, [])
            before.append(points[index][1 if before else 0 :])
    for at, centres in pieces.items():
        element = found.elements[at]
        offset = element.side * radius
        yield element, wall_of(found.expected[at], np.concatenate(centres), offset)


def wall_of(move: Expected, centre: np.ndarray, offset: float) -> Walls:
    """Return the wall beside a toolpath, on its right if ``offset`` is above 0, and as reached."""
    curve = move.curve
    if isinstance(curve, Line):
        normal = 1j * curve.direction()
        along = ((centre - curve.start) / curve.direction()).real
        nearest = curve.start + along * curve.direction()
    else:
        outward = (centre - curve.centre) / np.maximum(np.abs(centre - curve.centre), LENGTHLESS)
        normal = -np.sign(curve.sweep) * outward
        nearest = curve.centre + curve.radius * outward
    return Walls(nearest - offset * normal, centre - offset * normal)


def span(distances: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the least and the greatest of distances."""
    every = np.concatenate([np.zeros(0), *distances])
    return (float(every.min()), float(every.max())) if len(every) else (0.0, 0.0)
