# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a section on a cylinder: moves of Z and C, with their feeds.

On a surface of radius r an angle of C is r times the angle in radians long. Z and that length are
proportional to the axes' positions: a line is exactly one segment. The segments of an arc bulge
equally everywhere; spacing shares the deviation between them.
"""

import cmath
from collections.abc import Sequence
from functools import partial
from math import copysign, degrees, radians, sqrt
from typing import NamedTuple

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import Contour, Mark, PathElement, PlaneMove, Plunge
from g12.geometry.curve import Arc
from g12.moves.exact_stops import Direction, stops
from g12.moves.feed import Split, segments_with_feed
from g12.moves.spacing import BULGE, Stretch, spaced
from g12.moves.steps import ROUNDING_SHARE, MachinePosition, SectionPlan, StepMaker

LEAST_DENSITY = 2.0  # segments per radian of an arc: fewer do not resemble it


class CylinderSettings(NamedTuple):
    """The machine's limits and the owner's settings for a section; lengths in program units."""

    radius: float  # of the surface
    tolerance: float
    least_z: float  # 0.001 mm: a segment that turns C changes Z by this at least, or not at all
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
    return SectionPlan(machine.steps, machine.position, radians(machine.position.c), contour.notes)


def _acceleration(direction: Direction, _point: complex, *, settings: CylinderSettings) -> float:
    """Return the acceleration along a direction that no axis exceeds; it is the same everywhere."""
    around, along, deep = map(abs, direction)
    surface = settings.radius * radians(settings.c_acceleration)
    return 1.0 / max(
        around / surface, along / settings.z_acceleration, deep / settings.x_acceleration
    )


class _Surface(StepMaker):
    def __init__(self, contour: Contour, settings: CylinderSettings) -> None:
        x, angle, z = contour.start
        super().__init__(contour, MachinePosition(x, degrees(angle), z))
        self._settings = settings

    def cut(self, move: PlaneMove, stop: bool) -> None:
        settings, (x, c, z) = self._settings, self.position
        split_by = partial(split_on_cylinder, move, settings.radius)
        split = self._split(move, split_by, settings.tolerance, stop, settings.least_z)
        segments = segments_with_feed(split, (z, c, x), move, 0.0, settings.least_z)
        axes = "ZC" if move.z0 == move.z1 else "XZC"
        self._run(move.line, axes, [(x, c, z, feed) for z, c, x, feed in segments], stop)

    def plunge(self, move: Plunge, stop: bool) -> None:
        self._run(move.line, "X", [(move.z1, *self.position[1:], move.feed)], stop)

    def finish(self, path: Sequence[PathElement]) -> None:
        x, z = self.position.x, self.position.z
        for element in path:
            x = x if isinstance(element, Mark) else element.z1
            z = element.end.imag if isinstance(element, PlaneMove) else z
        self._add_remainder(path, x, z, self._settings.least_z)


def split_on_cylinder(move: PlaneMove, radius: float, deviation: float) -> Split:
    """Return where the segments of a move on the cylinder end: Z, the angle of C, the length."""
    if isinstance(move.curve, Arc):
        points, lengths = _along_arc(move.curve, deviation)
    else:
        points, lengths = [move.start, move.end], [0.0, move.length]
    return Split([at.imag for at in points], [at.real / radius for at in points], lengths)


def _along_arc(arc: Arc, deviation: float) -> tuple[list[complex], list[float]]:
    """Return the ends of an arc's segments, and the length of the arc up to them."""
    radius, turn = arc.radius, copysign(1.0, arc.sweep)
    bulging = sqrt(radius / (8.0 * BULGE * deviation))
    segments = max(bulging, LEAST_DENSITY)
    density = (segments, (bulging / segments) ** 2)
    stretch = Stretch(0.0, abs(arc.sweep), [], lambda _: 0.0)
    angles, shares = spaced(stretch, lambda _: density)
    outward = (arc.start - arc.centre) / radius
    points = [
        arc.centre + (radius + deviation * share) * outward * cmath.rect(1.0, turn * angle)
        for angle, share in zip(angles, shares)
    ]
    points[0], points[-1] = arc.start, arc.end
    return points, [radius * angle for angle in angles]
