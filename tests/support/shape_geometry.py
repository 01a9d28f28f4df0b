# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawings of the shapes on a lathe's face, and what a tool's path leaves of a bar.

Nothing here knows the planners: a polygon is what half planes leave, corners are rounded by moving
it in and out. Lengths are millimetres, angles degrees, areas are shapely's.
"""

import math
from typing import NamedTuple

import numpy as np
from shapely.affinity import rotate
from shapely.geometry import LineString, Point, box
from shapely.ops import unary_union

FAR = 500.0
SEGMENTS = 180  # of a quarter circle of a drawing
CUTTER_SEGMENTS = 48
STEP = 0.05  # between points of a path
CHORD_ERROR = 5e-4
PART = 8  # lines of a path whose area is worked out at once


def polygon(sides, across, radius=0.0, angle=0.0):
    """Return a polygon whose flats are half of ``across`` away; the first faces ``angle``."""
    half = box(-FAR, -FAR, across / 2, FAR)
    drawn = box(-FAR, -FAR, FAR, FAR)
    for index in range(sides):
        drawn = drawn.intersection(rotate(half, angle + index * 360 / sides, origin=(0, 0)))
    if radius:
        drawn = drawn.buffer(-radius, join_style=2).buffer(radius, SEGMENTS)
    return drawn


def slot(width, length, angle=0.0):
    """Return a slot with round ends about the centre."""
    reach = (length - width) / 2
    line = LineString([(-reach, 0), (reach, 0)]).buffer(width / 2, SEGMENTS)
    return rotate(line, angle, origin=(0, 0))


def disc(x, c, diameter):
    """Return a round pocket, or a bar."""
    return Point(x, c).buffer(diameter / 2, SEGMENTS)


class FacePath(NamedTuple):
    """A tool's path in the part's plane: complex points, Z."""

    points: np.ndarray
    z: np.ndarray

    def area(self, depth, radius):
        """Return the area that a cutter sweeps at a depth or below it."""
        deep = self.z <= depth + 1e-6
        ends = np.flatnonzero(np.diff(deep.astype(int))) + 1
        runs = zip(np.split(self.points, ends), np.split(deep, ends))
        kept = [points for points, low in runs if low[0] and len(points) > 1]
        return unary_union([part for run in kept for part in swept_by(run, radius)])


def swept_by(points, radius):
    """Yield the areas that a cutter sweeps along parts of a path; a whole one takes long."""
    line = LineString(np.column_stack([points.real, points.imag])).simplify(CHORD_ERROR)
    corners = line.coords
    for first in range(0, len(corners) - 1, PART):
        yield LineString(corners[first : first + PART + 1]).buffer(radius, CUTTER_SEGMENTS)


def path_of(moves, scale=1.0):
    """Return the path of traced moves in X, Z and C; ``scale`` is 1 mm in their unit."""
    columns = [], []
    for move in moves:
        (x0, z0, c0), (x1, z1, c1) = ([end[i] for i in (0, 2, 5)] for end in (move.start, move.end))
        reach = max(x0, x1) * abs(math.radians(c1 - c0)) + abs(x1 - x0)
        share = np.linspace(0, 1, max(2, math.ceil(reach / STEP)))
        x, angle = x0 + (x1 - x0) * share, np.radians(c0 + (c1 - c0) * share)
        columns[0].append(x * np.exp(1j * angle) * scale)
        columns[1].append((z0 + (z1 - z0) * share) * scale)
    return FacePath(*map(np.concatenate, columns))


def area_off(area, wanted, tolerance):
    """Return how much of an area lies beyond a drawing, or is missing of it, by more than that."""
    beyond = area.difference(wanted.buffer(tolerance)).area
    return beyond + wanted.buffer(-tolerance).difference(area).area
