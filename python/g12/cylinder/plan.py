# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a section on a cylinder: moves of Z and C, with their feeds.

With the radius r of the surface an angle of C is as long as r times the angle in radians. Z and
that length are proportional to what the axes do: a line is one piece, exactly. The pieces of an arc
bulge alike everywhere; spacing shares the deviation between them.
"""

from collections.abc import Sequence
from functools import partial
from math import copysign, cos, degrees, hypot, radians, sin, sqrt
from typing import NamedTuple

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import (
    Arc,
    Contour,
    Element,
    Line,
    Mark,
    Plunge,
    Point,
    arc_radius,
    is_move,
)
from g12.moves.exact_stops import Direction, stops
from g12.moves.feed import Split, pieces_with_feed
from g12.moves.spacing import BULGE, Stretch, spaced
from g12.moves.steps import (
    ROUNDING_SHARE,
    Position,
    SectionPlan,
    StepMaker,
)

FEWEST = 2.0  # pieces per radian of an arc: fewer would not be like it any more


class CylinderSettings(NamedTuple):
    """What the machine and its owner want of a section; lengths in program units."""

    radius: float  # of the surface
    tolerance: float
    least_z: float  # 0.001 mm: no piece with a turn of C changes Z by less, other than not at all
    x_acceleration: float  # per second squared
    z_acceleration: float
    c_acceleration: float  # degrees per second squared


def plan(contour: Contour, settings: CylinderSettings) -> SectionPlan:
    """Return the moves of a whole section.

    Raises Refusal, naming the blocks by their lines, when the contour cannot be cut as programmed.
    """
    path, moved = centre_path(contour, settings.tolerance)
    settings = settings._replace(tolerance=settings.tolerance - moved)
    acceleration = partial(_acceleration, settings=settings)
    stopping = stops(path, ROUNDING_SHARE * settings.tolerance, acceleration)
    machine = _Surface(contour, settings)
    for element, stop in zip(path, stopping):
        if isinstance(element, Mark):
            machine.steps.append(element.action)
        elif isinstance(element, Plunge):
            machine.plunge(element, stop)
        else:
            machine.cut(element, stop)
    machine.finish(path)
    return SectionPlan(machine.steps, machine.place, radians(machine.place.c), contour.notes)


def _acceleration(direction: Direction, _place: Point, *, settings: CylinderSettings) -> float:
    """Return the acceleration along a direction that no axis exceeds; it is the same everywhere."""
    around, along, deep = map(abs, direction)
    surface = settings.radius * radians(settings.c_acceleration)
    return 1.0 / max(
        around / surface, along / settings.z_acceleration, deep / settings.x_acceleration
    )


class _Surface(StepMaker):
    """Z and the C axis, making one element after the other."""

    def __init__(self, contour: Contour, settings: CylinderSettings) -> None:
        x, angle, z = contour.start
        super().__init__(contour, Position(x, degrees(angle), z))
        self._settings = settings

    def cut(self, move: Line | Arc, stop: bool) -> None:
        """Add the pieces of a move on the surface."""
        settings, (x, c, z) = self._settings, self.place
        split_by = partial(split_on_cylinder, move, settings.radius)
        split = self._split(move, split_by, settings.tolerance, stop, settings.least_z)
        made = pieces_with_feed(split, (z, c, x), move, 0.0, settings.least_z)
        axes = "ZC" if move.z0 == move.z1 else "XZC"
        self._run(move.line, axes, [(x, c, z, feed) for z, c, x, feed in made], stop)

    def plunge(self, move: Plunge, stop: bool) -> None:
        """Add a move of X alone."""
        self._run(move.line, "X", [(move.z1, *self.place[1:], move.feed)], stop)

    def finish(self, path: Sequence[Element]) -> None:
        """Add what the last pieces left over of Z and X."""
        x, z = self.place.x, self.place.z
        for element in path:
            x = x if isinstance(element, Mark) else element.z1
            z = element.c1 if is_move(element) else z
        self._make_up(path, x, z, self._settings.least_z)


def split_on_cylinder(move: Line | Arc, radius: float, deviation: float) -> Split:
    """Return the ends of the pieces of a move on the surface: Z, the angle of C, and the length."""
    if isinstance(move, Line):
        length = hypot(move.x1 - move.x0, move.c1 - move.c0)
        places = [(move.x0, move.c0), (move.x1, move.c1)]
        lengths = [0.0, length]
    else:
        places, lengths = _along_arc(move, deviation)
    return Split([z for _, z in places], [s / radius for s, _ in places], lengths)


def _along_arc(move: Arc, deviation: float) -> tuple[list[Point], list[float]]:
    """Return the ends of an arc's pieces, and the length of the arc up to them."""
    radius, turn = arc_radius(move), copysign(1.0, move.sweep)
    bulging = sqrt(radius / (8.0 * BULGE * deviation))
    pieces = max(bulging, FEWEST)
    density = (pieces, (bulging / pieces) ** 2)
    stretch = Stretch(0.0, abs(move.sweep), [], lambda _: 0.0)
    angles, shares = spaced(stretch, lambda _: density)
    x, z = (move.x0 - move.cx) / radius, (move.c0 - move.cc) / radius
    places = [
        _turned((x, z), (move.cx, move.cc), turn * angle, radius + deviation * share)
        for angle, share in zip(angles, shares)
    ]
    places[0], places[-1] = (move.x0, move.c0), (move.x1, move.c1)
    return places, [radius * angle for angle in angles]


def _turned(direction: Point, centre: Point, angle: float, radius: float) -> Point:
    """Return the place at a radius about a centre, an angle on from a direction."""
    (x, z), sine, cosine = direction, sin(angle), cos(angle)
    return centre[0] + radius * (x * cosine - z * sine), centre[1] + radius * (
        x * sine + z * cosine
    )
