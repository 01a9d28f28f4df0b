# SPDX-License-Identifier: GPL-2.0-or-later
"""Independent geometry: what was cut, derived from emitted moves alone.

Nothing here knows the planners; areas are those of the tools. Lengths are mm, as in a trace.
"""

import math
from typing import NamedTuple

import numpy as np
from shapely.geometry import Point

from g12.tools.path import part

SAME_POINT = 1e-6  # mm
NEAR = 1e-6  # of a move: the points whose difference is its direction
CHORD_ERROR = 1e-4  # mm, of the polylines that stand for arcs
MILL = part.Part(turning=False)


class Circle(NamedTuple):
    """A full circle that was cut; ``turns`` counts positive counterclockwise."""

    x: float
    y: float
    z: float
    radius: float
    turns: int


def moving(moves):
    """Return the moves that go anywhere at all."""
    return [move for move in moves if move.length > SAME_POINT]


def cutting(moves):
    """Return the moves at feed that go anywhere."""
    return [move for move in moving(moves) if move.kind != "rapid"]


def full_circles(moves):
    """Return the full circles in the order they were cut."""
    return [
        Circle(move.centre[0], move.centre[1], move.end[2], move.radius, move.turns)
        for move in moves
        if move.kind == "arc" and math.dist(move.start[:3], move.end[:3]) < SAME_POINT
    ]


def radii(moves):
    """Return the radii of the full circles in the order they were cut."""
    return [circle.radius for circle in full_circles(moves)]


def tangent(move, fraction):
    """Return the unit direction in X, Y, Z after a fraction of a move; zeros without motion."""
    before, after = (np.array(move.point(fraction + step)[:3]) for step in (-NEAR, NEAR))
    return (after - before) / (math.dist(before, after) or 1.0)


def in_plane(moves):
    """Return the moves that go sideways (not the plunge)."""
    return [move for move in moves if math.hypot(*tangent(move, 0.5)[:2]) > 0.5]


def largest_jump(moves):
    """Return the largest change of direction between consecutive moves, in degrees."""
    jumps = [
        math.degrees(math.acos(np.clip(np.dot(tangent(before, 1.0), tangent(after, 0.0)), -1, 1)))
        for before, after in zip(moves, moves[1:])
    ]
    return max(jumps, default=0.0)


def path_length(moves):
    """Return the length of the path."""
    return sum(move.length for move in moves)


def polyline(move):
    """Return points along a move, close enough for `CHORD_ERROR`."""
    return MILL.polyline(move, CHORD_ERROR)[:, :2]


def swept(moves, cutter_radius):
    """Return the area in XY that a cutter of that radius sweeps (shapely)."""
    return part.swept(map(polyline, moves), cutter_radius)


def disc(x, y, radius):
    """Return the full disc (shapely)."""
    return Point(x, y).buffer(radius, 512)


def levels(moves):
    """Return the distinct Z of sideways motion, from the top down."""
    depths = {round(move.end[2], 6) + 0.0 for move in in_plane(cutting(moves))}
    return sorted(depths, reverse=True)


def dense_points(moves, step=0.2):
    """Return points (n, 3) along the moves, at most ``step`` apart, ends included."""
    points = []
    for move in moves:
        count = max(2, math.ceil(move.length / step) + 1)
        points += [move.point(fraction)[:3] for fraction in np.linspace(0, 1, count)]
    return np.array(points)


def farthest_off(points, path):
    """Return the largest distance of points (n, 3) from a polyline (m, 3)."""
    start, along = path[:-1], np.diff(path, axis=0)
    length = np.maximum((along**2).sum(axis=1), 1e-30)
    found = 0.0
    for point in points:
        share = np.clip(((point - start) * along).sum(axis=1) / length, 0, 1)
        off = point - start - share[:, None] * along
        found = max(found, float((off**2).sum(axis=1).min()))
    return math.sqrt(found)
