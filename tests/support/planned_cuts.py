# SPDX-License-Identifier: GPL-2.0-or-later
"""What a polar plan cuts: its segments turned back into the plane by r exp(j angle).

Nothing here knows how the planner works.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.compensation.contour import Contour
from g12.geometry.curve import Line
from g12.moves.steps import Segments

SAGITTA = 2e-4  # of the chords that stand for a segment


def programmed(shapes, *, feed=250.0, by_radius=False):
    """Return the contour of a program that cuts the shapes, which begin where the tool stands.

    That is on the positive X axis, or beside it.
    """
    start = shapes[0].start
    contour = Contour(start.real, 0.0, 0.0, beside=start.imag)
    for line, shape in enumerate(shapes, 1):
        add(contour, shape, line=line, feed=feed, by_radius=by_radius)
    return contour


def add(contour, shape, *, line, feed, by_radius=False):
    """Add a shape that begins where the contour stands."""
    end = shape.end
    if isinstance(shape, Line):
        contour.straight(end.real, end.imag, at=line, feed=feed)
        return
    arm = shape.centre - shape.start
    words = dict(i=arm.real, j=arm.imag)
    if by_radius:
        words = dict(radius=math.copysign(shape.radius, math.pi - abs(shape.sweep)))
    turn = 1 if shape.sweep > 0.0 else -1
    contour.arc(turn, end.real, end.imag, at=line, feed=feed, **words)


class Cut(NamedTuple):
    """One segment as the machine makes it: radius, angle in radians and Z at its ends, seconds.

    ``run`` counts the runs of the plan. The radius is the slide's position, with the tool
    ``beside`` it.
    """

    run: int
    line: int
    radius: tuple
    angle: tuple
    z: tuple
    seconds: float
    beside: float

    @property
    def points(self):
        """The tool's path in the plane, an odd number of points."""
        turn = abs(self.angle[1] - self.angle[0])
        count = 8 + math.ceil(turn * math.sqrt(max(self.radius) / SAGITTA / 32))
        part = np.linspace(0.0, 1.0, 2 * count + 1)
        radius = self.radius[0] + (self.radius[1] - self.radius[0]) * part
        angle = self.angle[0] + (self.angle[1] - self.angle[0]) * part
        return (radius + 1j * self.beside) * np.exp(1j * angle)

    @property
    def length(self):
        """The length of the tool's path in space."""
        return math.hypot(math.fsum(abs(np.diff(self.points))), self.z[1] - self.z[0])

    @property
    def speeds(self):
        """The speed along the part at the segment's ends, per minute."""
        x = (self.radius[1] - self.radius[0]) / self.seconds
        z = (self.z[1] - self.z[0]) / self.seconds
        turn = (self.angle[1] - self.angle[0]) / self.seconds
        return [60.0 * math.hypot(x, radius * turn, z) for radius in self.radius]


def seconds(dx, dz, degrees, feed):
    """Return how long LinuxCNC takes in G94: F is for X and Z, or for C where neither moves."""
    return 60.0 * (math.hypot(dx, dz) or abs(degrees)) / feed


def cuts(contour, plan, c=0.0, beside=0.0):
    """Return the segments of a plan whose plane has its zero angle at ``c`` degrees."""
    x, angle, z = contour.start
    degrees, made = c + math.degrees(angle), []
    for count, run in enumerate(step for step in plan.steps if isinstance(step, Segments)):
        for to_x, to_c, to_z, feed in run.segments:
            assert "X" in run.axes or (to_x == x and to_c == degrees)
            assert "Z" in run.axes or to_z == z
            ends = (math.radians(degrees - c), math.radians(to_c - c))
            time = seconds(to_x - x, to_z - z, to_c - degrees, feed)
            made.append(Cut(count, run.line, (x, to_x), ends, (z, to_z), time, beside))
            x, degrees, z = to_x, to_c, to_z
    return made


def path(made):
    """Return the path in the plane of all segments."""
    return np.concatenate([cut.points for cut in made])
