# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves on the face, drawn and at random, and their places."""

import cmath
from math import pi, radians

from hypothesis import strategies as st

from g12.geometry.curve import Arc
from g12.polar.face import FaceLimits
from support import planned_moves
from support.contour_geometry import shape_of

LIMITS = FaceLimits(1000.0, 707.0, 1000.0, radians(3600.0), radians(360.0), 1.0, 0.0)


def line(*ends, feed=1000.0, z=(0.0, 0.0)):
    (x0, c0), (x1, c1) = ends
    return planned_moves.line(x0, c0, x1, c1, *z, feed=feed)


def arc(centre, radius, start, sweep, feed=1000.0):
    middle = complex(*centre)
    return planned_moves.arc(middle, middle + cmath.rect(radius, start), sweep, feed=feed)


coordinates = st.floats(-60, 60)
places = st.tuples(coordinates, coordinates)
lines = st.builds(
    lambda a, b, feed: line(a, b, feed=feed), places, places, st.floats(100, 9000)
).filter(lambda move: move.length > 0.1)
arcs = st.builds(
    arc,
    places,
    st.floats(1, 60),
    st.floats(-pi, pi),
    st.floats(0.1, 2 * pi).flatmap(lambda turn: st.sampled_from((turn, -turn))),
    st.floats(100, 9000),
)


def motion(move, limits=LIMITS):
    """Return 2,000 places of a move, as complex numbers, and its speed per second."""
    speed = move.feed / 60.0
    if isinstance(move.curve, Arc):
        speed = min(speed, (limits.round_acceleration * move.curve.radius) ** 0.5)
    return shape_of(move.curve).points(2000), speed
