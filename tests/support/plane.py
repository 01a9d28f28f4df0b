# SPDX-License-Identifier: GPL-2.0-or-later
"""Independent geometry of polar interpolation: what a plan cuts, and what it should have cut.

Nothing here knows how the planner works. A path in the X-C plane is a list of complex numbers
x + jc, or of shapes with a distance; pieces of a plan are turned back into it by r exp(j angle).
"""

import math
from typing import NamedTuple

import numpy as np

from g12.flat.contour import Contour
from g12.polar.plan import Run

SAGITTA = 2e-4  # of the chords that stand for a piece


class Straight(NamedTuple):
    """A line of the drawing."""

    start: complex
    end: complex

    @property
    def length(self):
        return abs(self.end - self.start)

    def points(self, count):
        return self.start + (self.end - self.start) * np.linspace(0.0, 1.0, count)

    def turned(self, by):
        return Straight(self.start * by, self.end * by)

    def between(self, first, last):
        return Straight(*(self.start + (self.end - self.start) * part for part in (first, last)))

    def distance(self, points):
        along = self.end - self.start
        part = np.clip(((points - self.start) * np.conj(along)).real / abs(along) ** 2, 0.0, 1.0)
        return abs(points - self.start - part * along)


class Round(NamedTuple):
    """An arc of the drawing; ``sweep`` in radians, counterclockwise above zero."""

    start: complex
    centre: complex
    sweep: float

    @property
    def radius(self):
        return abs(self.start - self.centre)

    @property
    def length(self):
        return self.radius * abs(self.sweep)

    @property
    def end(self):
        return self.points(2)[-1]

    def points(self, count):
        angles = self.sweep * np.linspace(0.0, 1.0, count)
        return self.centre + (self.start - self.centre) * np.exp(1j * angles)

    def turned(self, by):
        return Round(self.start * by, self.centre * by, self.sweep)

    def between(self, first, last):
        start = self.centre + (self.start - self.centre) * np.exp(1j * self.sweep * first)
        return Round(start, self.centre, self.sweep * (last - first))

    def distance(self, points):
        arm = (points - self.centre) / (self.start - self.centre)
        angle = np.angle(arm) * math.copysign(1.0, self.sweep) % (2 * math.pi)
        to_ends = np.minimum(abs(points - self.start), abs(points - self.end))
        to_circle = abs(abs(points - self.centre) - self.radius)
        return np.where(angle <= abs(self.sweep) + 1e-9, to_circle, to_ends)


def distance(points, shapes):
    """Return the distance of points from the nearest of the shapes."""
    return np.min([shape.distance(points) for shape in shapes], axis=0)


def distance_from_path(points, path):
    """Return the distance of points from the polyline through the points of a path."""
    start, along = path[:-1], np.diff(path)
    there = abs(along) > 1e-12
    start, along = start[there], along[there]
    arms = points[:, None] - start
    part = np.clip((arms * np.conj(along)).real / abs(along) ** 2, 0.0, 1.0)
    return abs(arms - part * along).min(axis=1)


def programmed(shapes, *, feed=250.0, by_radius=False):
    """Return the contour of a program that cuts the shapes, which begin on the positive X axis."""
    contour = Contour(shapes[0].start.real, 0.0)
    for line, shape in enumerate(shapes, 1):
        add(contour, shape, line=line, feed=feed, by_radius=by_radius)
    return contour


def add(contour, shape, *, line, feed, by_radius=False):
    """Add a shape that begins where the contour stands."""
    end = shape.end
    if isinstance(shape, Straight):
        contour.line(end.real, end.imag, line=line, feed=feed)
        return
    arm = shape.centre - shape.start
    words = dict(i=arm.real, j=arm.imag)
    if by_radius:
        words = dict(radius=math.copysign(shape.radius, math.pi - abs(shape.sweep)))
    turn = 1 if shape.sweep > 0.0 else -1
    contour.arc(turn, end.real, end.imag, line=line, feed=feed, **words)


class Cut(NamedTuple):
    """One piece as the machine makes it: radius, angle in radians and Z at its ends, seconds.

    ``run`` counts the runs of the plan.
    """

    run: int
    line: int
    radius: tuple
    angle: tuple
    z: tuple
    seconds: float

    @property
    def points(self):
        """The tool's path in the plane, an odd number of points."""
        turn = abs(self.angle[1] - self.angle[0])
        count = 8 + math.ceil(turn * math.sqrt(max(self.radius) / SAGITTA / 32))
        part = np.linspace(0.0, 1.0, 2 * count + 1)
        radius = self.radius[0] + (self.radius[1] - self.radius[0]) * part
        angle = self.angle[0] + (self.angle[1] - self.angle[0]) * part
        return radius * np.exp(1j * angle)

    @property
    def length(self):
        """The length of the tool's path in space."""
        return math.hypot(math.fsum(abs(np.diff(self.points))), self.z[1] - self.z[0])

    @property
    def speeds(self):
        """The speed along the part at the piece's ends, per minute."""
        x = (self.radius[1] - self.radius[0]) / self.seconds
        z = (self.z[1] - self.z[0]) / self.seconds
        turn = (self.angle[1] - self.angle[0]) / self.seconds
        return [60.0 * math.hypot(x, radius * turn, z) for radius in self.radius]


def seconds(dx, dz, degrees, feed):
    """Return how long LinuxCNC takes in G94: F is for X and Z, or for C where neither moves."""
    return 60.0 * (math.hypot(dx, dz) or abs(degrees)) / feed


def cuts(contour, plan, c=0.0):
    """Return the pieces of a plan whose plane has its zero angle at ``c`` degrees."""
    x, angle, z = contour.start
    degrees, made = c + math.degrees(angle), []
    for count, run in enumerate(step for step in plan.steps if isinstance(step, Run)):
        for to_x, to_c, to_z, feed in run.pieces:
            assert "X" in run.axes or (to_x == x and to_c == degrees)
            assert "Z" in run.axes or to_z == z
            ends = (math.radians(degrees - c), math.radians(to_c - c))
            time = seconds(to_x - x, to_z - z, to_c - degrees, feed)
            made.append(Cut(count, run.line, (x, to_x), ends, (z, to_z), time))
            x, degrees, z = to_x, to_c, to_z
    return made


def path(made):
    """Return the path in the plane of all pieces."""
    return np.concatenate([cut.points for cut in made])
