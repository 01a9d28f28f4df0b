# SPDX-License-Identifier: GPL-2.0-or-later
"""How large a section's contour comes out: how far it reaches, and its widths across flats.

Points are complex, lengths mm. The wall is where the cutter's edge goes, a tool radius beside its
centre; leads that stick out of a closed contour are no part of it.
"""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Point

from g12.geometry.curve import Curve, Line
from g12.tools.verify.expected.contour import Element
from g12.tools.verify.expected.toolpath import NO_LENGTH
from g12.tools.verify.sections.outline import MEETS, outlines_of
from g12.tools.verify.sections.view import SectionView

PARALLEL = 1e-4  # radians between parallel sides


class SectionSize(NamedTuple):
    """The least and the greatest of a contour, as programmed and reached, and its widths."""

    programmed: tuple[float, float]
    reached: tuple[float, float]
    flats: list[tuple[float, float]]


class CutWall(NamedTuple):
    """A wall along an element: where its points are by the words, and as reached."""

    element: Element
    programmed: np.ndarray
    reached: np.ndarray


def contour_size(view: SectionView) -> SectionSize:
    """Return the size of what is compensated of a contour, of all of it if nothing is."""
    sides = {each.side for each in view.section.elements if not each.ramp} - {0} or {0}
    leads = [lead for outline in outlines_of(view.section) for lead in outline.leads]
    walls = [on_shape(wall, leads) for wall in walls_along(view) if wall.element.side in sides]
    sizes = view.plane.sizes
    programmed = span([sizes(wall.programmed) for wall in walls])
    reached = span([sizes(wall.reached) for wall in walls])
    flats = across_flats([wall for wall in walls if wall.element.side])
    return SectionSize(programmed, reached, sorted(flats, reverse=True))


def on_shape(wall: CutWall, leads: Sequence[LineString]) -> CutWall:
    """Return what of a wall is no lead."""
    if not leads:
        return wall
    places = [Point(place.real, place.imag) for place in wall.programmed]
    on = [all(lead.distance(place) > MEETS for lead in leads) for place in places]
    return CutWall(wall.element, wall.programmed[on], wall.reached[on])


def walls_along(view: SectionView) -> Iterator[CutWall]:
    segments: dict[int, list[np.ndarray]] = {}
    laid, across = view.found.run or view.found.emitted, set(view.across)
    for index, made in laid.spans.items():
        whole = made.index == made.last or made.share > 1.0 - NO_LENGTH
        if whole and view.expected[made.last].name == "contour" and index in across:
            before = segments.setdefault(made.last, [])
            before.append(view.plane.points(view.motion(index))[1 if before else 0 :])
    for at, centres in segments.items():
        element, centre = view.steps[at].element, np.concatenate(centres)
        nearest, normal = beside(view.expected[at].curve, centre)
        aside = element.side * view.tool * normal
        yield CutWall(element, nearest - aside, centre - aside)


def beside(curve: Curve, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest points of a curve's line or circle, and its left normals there."""
    if isinstance(curve, Line):
        along = curve.direction()
        return curve.start + ((points - curve.start) / along).real * along, 1j * along
    outward = (points - curve.centre) / np.maximum(np.abs(points - curve.centre), NO_LENGTH)
    return curve.centre + curve.radius * outward, -np.sign(curve.sweep) * outward


def across_flats(walls: Sequence[CutWall]) -> Iterator[tuple[float, float]]:
    """Yield the width, programmed and reached, between the outermost sides of each direction."""
    flat = [each for each in walls if isinstance(each.element.curve, Line) and len(each.reached)]
    for parallel in groups_by_direction(flat):
        outward = 1j * parallel[0].element.curve.direction()
        order = sorted(parallel, key=lambda wall: along(outward, wall.element.start))
        first, last = order[0].element, order[-1].element
        if (first.curve.direction() / last.curve.direction()).real < 0.0:
            low, high = (np.mean(along(outward, wall.reached)) for wall in (order[0], order[-1]))
            yield float(along(outward, last.start - first.start)), float(high - low)


def groups_by_direction(walls: Sequence[CutWall]) -> list[list[CutWall]]:
    """Return straight walls, those that are parallel together."""
    if not walls:
        return []
    angles = np.array([np.angle(wall.element.curve.direction() ** 2) / 2 for wall in walls])
    order = np.argsort(angles)
    gaps = np.diff(angles[order], append=angles.min() + math.pi) > PARALLEL
    order = np.roll(order, -1 - int(gaps.argmax()))  # a gap is where the last one ends
    gaps = np.roll(gaps, -1 - int(gaps.argmax()))
    groups = np.split(order, 1 + np.flatnonzero(gaps[:-1]))
    return [[walls[index] for index in group] for group in groups]


def along(direction: complex, points: np.ndarray | complex) -> np.ndarray | float:
    """Return how far points lie in a direction of length 1."""
    return (np.conj(direction) * points).real


def span(distances: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the least and the greatest of distances."""
    every = np.concatenate([np.zeros(0), *distances])
    return (float(every.min()), float(every.max())) if len(every) else (0.0, 0.0)
