# SPDX-License-Identifier: GPL-2.0-or-later
"""What was cut, derived from emitted moves alone; lengths are mm, as in a trace."""

import math
from typing import NamedTuple

import numpy as np

from g12.tools.path.part import arc_points

SAME_POINT = 1e-6  # mm
NEAR = 1e-6  # of a move: the points whose difference is its direction


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


def points_at(move, fractions):
    """Return points (n, 3) after fractions of a move."""
    fractions = np.asarray(fractions)
    if move.kind == "arc":
        return arc_points(move, fractions)[:, :3]
    return np.outer(1.0 - fractions, move.start[:3]) + np.outer(fractions, move.end[:3])


def tangent(move, fraction):
    """Return the unit direction in X, Y, Z after a fraction of a move; zeros without motion."""
    before, after = points_at(move, [fraction - NEAR, fraction + NEAR])
    return (after - before) / (math.dist(before, after) or 1.0)


def in_plane(moves):
    """Return the moves that go sideways (not the plunge)."""
    return [move for move in moves if math.hypot(*tangent(move, 0.5)[:2]) > 0.5]
