# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs in the X-C plane, and how near to them points lie: nothing here knows the package.

A point is a complex number x + jc. Samples of a motion are an array (n, 2) of x and c.
"""

import cmath
import math
from typing import NamedTuple

import numpy as np

SAME_HEADING = math.radians(0.01)
FROM_COLUMNS = np.array([1, 1j])


def phase(vector):
    """Return the direction of a vector; `cmath.phase` fails where it underflows (Python 3.13)."""
    return math.atan2(vector.imag, vector.real)


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

    def moved(self, by):
        return Straight(self.start + by, self.end + by)

    def headings(self):
        """Return the direction at both ends, radians."""
        angle = phase(self.end - self.start)
        return angle, angle

    def aside(self, by):
        """Return the parallel line on the left."""
        normal = by * 1j * (self.end - self.start) / self.length
        return Straight(self.start + normal, self.end + normal)

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

    def moved(self, by):
        return Round(self.start + by, self.centre + by, self.sweep)

    def headings(self):
        """Return the direction at both ends, radians."""
        first = phase(self.start - self.centre) + math.copysign(math.pi / 2, self.sweep)
        return first, first + self.sweep

    def aside(self, by):
        """Return the concentric arc on the left."""
        arm = self.start - self.centre
        to = self.radius - math.copysign(by, self.sweep)
        return Round(self.centre + arm * to / self.radius, self.centre, self.sweep)

    def between(self, first, last):
        start = self.centre + (self.start - self.centre) * np.exp(1j * self.sweep * first)
        return Round(start, self.centre, self.sweep * (last - first))

    def distance(self, points):
        arm = (points - self.centre) / (self.start - self.centre)
        angle = np.angle(arm) * math.copysign(1.0, self.sweep) % (2 * math.pi)
        to_ends = np.minimum(abs(points - self.start), abs(points - self.end))
        to_circle = abs(abs(points - self.centre) - self.radius)
        return np.where(angle <= abs(self.sweep) + 1e-9, to_circle, to_ends)


def lines(*points):
    """Return the lines from point to point, each x and c."""
    return [Straight(complex(*start), complex(*end)) for start, end in zip(points, points[1:])]


def arc(centre, radius, start, sweep):
    """Return an arc by its centre (x, c), its radius, and its start and sweep in degrees."""
    middle = complex(*centre)
    return Round(middle + cmath.rect(radius, math.radians(start)), middle, math.radians(sweep))


def spaced(shape, step):
    """Return points of a shape, at most ``step`` apart."""
    return shape.points(max(2, math.ceil(shape.length / step)))


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


def apart(one, other, step=20):
    """Return how far two sampled paths leave each other; their points are rows of coordinates."""
    return max(_farthest_off(one[::step], other), _farthest_off(other[::step], one))


def _farthest_off(points, path):
    start, along = path[:-1], np.diff(path, axis=0)
    squared = np.maximum((along**2).sum(axis=1), 1e-18)
    found = 0.0
    for point in points:
        share = np.clip(((point - start) * along).sum(axis=1) / squared, 0.0, 1.0)
        off = point - start - share[:, None] * along
        found = max(found, np.linalg.norm(off, axis=1).min())
    return found


def outward(shapes, by):
    """Return each shape set ``by`` to the left, with the arc about the corner after it."""
    moved = [[shape.aside(by)] for shape in shapes]
    for group, shape, following in zip(moved, shapes, shapes[1:]):
        before, after = shape.headings()[1], following.headings()[0]
        turn = (after - before + math.pi) % (2 * math.pi) - math.pi
        if abs(turn) > SAME_HEADING and by:
            group.append(Round(shape.end + by * 1j * cmath.rect(1, before), shape.end, turn))
    return moved
