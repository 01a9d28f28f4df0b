# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms of the shapes on a lathe's face, drawn from their dimensions, and their sizes.

Points of the part's plane are complex, lengths mm; angles are degrees, counterclockwise, as the
part is seen from its face, and 0 where the X line is with C at 0.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from shapely.affinity import rotate, translate
from shapely.geometry import LineString, box
from shapely.geometry.base import BaseGeometry

from g12.tools.path.part import CHORD_ERROR, arc_pieces, disc

FAR = 10.0  # bars: how far a half plane reaches
MITRE = 2  # shapely's name of corners that stay sharp
FLATS, CORNERS, WIDTH, LENGTH, DIAMETER = "flats", "corners", "width", "length", "diameter"


class Extreme(NamedTuple):
    """How far a form reaches from its centre in a ``direction`` (of length 1), and its name."""

    name: str
    direction: complex
    reach: float


class Shift(NamedTuple):
    """How a form lies on the part: ``turned`` by degrees, its centre ``away``."""

    turned: float
    away: complex


@dataclass(frozen=True)
class ShapeForm:
    """What a shape should be: the ``area`` that stands, or of an ``inside`` one is cut away.

    ``stock`` is the radius of the bar round a standing one. One of its flats faces the ``angle``;
    in a whole turn it looks ``fold`` times the same, 0 if it is round. There the angle is square
    to the line to its centre.
    """

    area: BaseGeometry
    centre: complex
    angle: float
    fold: int
    extremes: tuple[Extreme, ...]
    inside: bool = True
    stock: float = 0.0

    @property
    def outward(self) -> int:
        """Return 1 where material stands within the wall, -1 where it stands round it."""
        return -1 if self.inside else 1

    @property
    def rays(self) -> tuple[complex, complex]:
        """Return two directions from the centre in which each round is met once."""
        first = cmath.rect(1.0, math.radians(self.angle))
        return first, -first if self.inside else first * cmath.rect(1.0, 2 * math.pi / self.fold)

    def placed(self, shift: Shift) -> ShapeForm:
        """Return the form as it is where a shift has taken it."""
        turned, away = shift
        turn = cmath.rect(1.0, math.radians(turned))
        area = translate(rotate(self.area, turned, origin=(0, 0)), away.real, away.imag)
        extremes = (e._replace(direction=e.direction * turn) for e in self.extremes)
        centre, angle = self.centre + away, self.angle + turned
        if away:
            angle = math.degrees(cmath.phase(centre)) + 90.0
        told = {"area": area, "centre": centre, "angle": angle, "extremes": tuple(extremes)}
        return replace(self, **told)

    def stands(self, corners: np.ndarray) -> tuple[float, ...]:
        """Return by how much corners (complex) reach farther than the extremes."""
        reach = ((corners - self.centre) * e.direction.conjugate() for e in self.extremes)
        return tuple(float(far.real.max()) - e.reach for far, e in zip(reach, self.extremes))

    def moved(self, distance: float) -> BaseGeometry:
        """Return the area with its wall moved into the air, into the material below 0."""
        return self.area.buffer(distance * self.outward, pieces_of(self.area))


def pieces_of(area: BaseGeometry) -> int:
    """Return into how many chords a quarter of the largest circle about an area is cut."""
    size = float(np.ptp(np.array(area.bounds).reshape(2, 2), axis=0).max())
    return arc_pieces(size, math.pi / 2, CHORD_ERROR)


def polygon_form(
    sides: int, across: float, rounding: float, stock: float, angle: float
) -> ShapeForm:
    """Return a polygon, or two flats, on a bar; ``across`` is twice its flats' distance."""
    half_turn, apothem = math.pi / sides, across / 2
    far = FAR * stock
    whole = box(-far, -far, far, far)
    half = box(-far, -far, apothem, far)
    for index in range(sides):
        whole = whole.intersection(rotate(half, angle + 360.0 * index / sides, origin=(0, 0)))
    if rounding:
        pieces = arc_pieces(rounding, math.pi / 2, CHORD_ERROR)
        whole = whole.buffer(-rounding, join_style=MITRE).buffer(rounding, pieces)
    corner = math.inf if sides == 2 else (apothem - rounding) / math.cos(half_turn) + rounding
    area = whole.intersection(disc((0.0, 0.0), stock))
    extremes = polygon_extremes(sides, apothem, corner if corner < stock else 0.0, angle)
    return ShapeForm(area, 0j, angle, sides, tuple(extremes), inside=False, stock=stock)


def polygon_extremes(sides: int, apothem: float, corner: float, angle: float) -> Iterator[Extreme]:
    """Yield the flats and the corners of a polygon; ``corner`` is 0 if the bar cuts them off."""
    for index in range(sides):
        flat = math.radians(angle + 360.0 * index / sides)
        yield Extreme(FLATS, cmath.rect(1.0, flat), apothem)
        if corner:
            yield Extreme(CORNERS, cmath.rect(1.0, flat + math.pi / sides), corner)


def slot_form(width: float, length: float, angle: float) -> ShapeForm:
    """Return a slot with round ends about the spindle's centre."""
    along = cmath.rect(1.0, math.radians(angle))
    reach = along * (length - width) / 2
    line = LineString([(reach.real, reach.imag), (-reach.real, -reach.imag)])
    area = line.buffer(width / 2, arc_pieces(width / 2, math.pi / 2, CHORD_ERROR))
    sizes = ((LENGTH, along, length), (WIDTH, 1j * along, width))
    extremes = [
        Extreme(name, side * direction, size / 2)
        for name, direction, size in sizes
        for side in (1, -1)
    ]
    return ShapeForm(area, 0j, angle + 90.0, 2, tuple(extremes))


def round_form(centre: complex, diameter: float, angle: float) -> ShapeForm:
    """Return a round pocket; ``angle`` is that of the line to its centre."""
    area = translate(disc((0.0, 0.0), diameter / 2), centre.real, centre.imag)
    first = cmath.rect(1.0, math.radians(angle))
    extremes = [Extreme(DIAMETER, first * 1j**quarter, diameter / 2) for quarter in range(4)]
    return ShapeForm(area, centre, angle + 90.0, 0, tuple(extremes))
