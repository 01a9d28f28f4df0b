# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs in the X-C plane, and how near to them points lie.

A point is a complex number x + jc. Samples of a motion are an array (n, 2) of x and c. A shape is
the package's curve, to draw with; its points and its distance, which judge, are its own.
"""

import cmath
import math

import numpy as np

from g12.geometry.curve import Arc, Line

FROM_COLUMNS = np.array([1, 1j])


class Straight(Line):
    """A line of the drawing."""

    def points(self, count):
        return self.start + (self.end - self.start) * np.linspace(0.0, 1.0, count)

    def turned(self, by):
        return Straight(self.start * by, self.end * by)

    def moved(self, by):
        return Straight(self.start + by, self.end + by)

    def distance(self, points):
        along = self.end - self.start
        part = np.clip(((points - self.start) * np.conj(along)).real / abs(along) ** 2, 0.0, 1.0)
        return abs(points - self.start - part * along)


class Round(Arc):
    """An arc of the drawing; ``sweep`` in radians, counterclockwise above zero."""

    def points(self, count):
        angles = self.sweep * np.linspace(0.0, 1.0, count)
        return self.centre + (self.start - self.centre) * np.exp(1j * angles)

    def turned(self, by):
        return Round(self.start * by, self.centre * by, self.sweep)

    def moved(self, by):
        return Round(self.start + by, self.centre + by, self.sweep)

    def distance(self, points):
        arm = (points - self.centre) / (self.start - self.centre)
        angle = np.angle(arm) * math.copysign(1.0, self.sweep) % (2 * math.pi)
        to_ends = np.minimum(abs(points - self.start), abs(points - self.points(2)[-1]))
        to_circle = abs(abs(points - self.centre) - self.radius)
        return np.where(angle <= abs(self.sweep) + 1e-9, to_circle, to_ends)


def shape_of(curve):
    """Return a curve of the package as a shape."""
    return (Straight if isinstance(curve, Line) else Round)(*curve)


def lines(*points):
    """Return the lines from point to point, each complex or x and c."""
    ends = [point if isinstance(point, complex) else complex(*point) for point in points]
    return [Straight(*pair) for pair in zip(ends, ends[1:])]


def arc(centre, radius, start, sweep):
    """Return an arc by its centre (x, c), its radius, and its start and sweep in degrees."""
    middle = complex(*centre)
    return Round(middle + cmath.rect(radius, math.radians(start)), middle, math.radians(sweep))


def distance(points, shapes):
    """Return the distance of points from the nearest of the shapes."""
    return np.min([shape.distance(points) for shape in shapes], axis=0)


def distances(points, path):
    """Return how far points lie from the polyline through those of a path: rows of coordinates."""
    start, along = path[:-1], np.diff(path, axis=0)
    there = np.linalg.norm(along, axis=1) > 1e-12
    start, along = start[there], along[there]
    found = []
    for some in np.array_split(points, max(1, len(points) // 200)):
        arms = some[:, None] - start
        share = np.clip((arms * along).sum(2) / (along**2).sum(1), 0.0, 1.0)
        found.append(np.linalg.norm(arms - share[..., None] * along, axis=2).min(1))
    return np.concatenate(found)


def distance_from_path(points, path):
    """Return the distance of points from the polyline through the points of a path."""
    return distances(*(np.column_stack([each.real, each.imag]) for each in (points, path)))


def apart(one, other, step=20):
    """Return how far two sampled paths leave each other; their points are rows of coordinates."""
    return max(distances(one[::step], other).max(), distances(other[::step], one).max())
