# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves on the face, drawn and at random, and their places."""

from math import cos, pi, radians, sin

import numpy as np
from hypothesis import strategies as st

from g12.compensation.contour import Arc, Line
from g12.polar.follow import FaceLimits

LIMITS = FaceLimits(1000.0, 707.0, 1000.0, radians(3600.0), radians(360.0), 1.0, 0.0)


def line(*ends, feed=1000.0, z=(0.0, 0.0)):
    (x0, c0), (x1, c1) = ends
    return Line(1, feed, 0.0, x0, c0, z[0], x1, c1, z[1])


def arc(centre, radius, start, sweep, feed=1000.0):
    (x0, c0), (x1, c1) = (
        (centre[0] + radius * cos(angle), centre[1] + radius * sin(angle))
        for angle in (start, start + sweep)
    )
    return Arc(1, feed, 0.0, x0, c0, 0.0, x1, c1, 0.0, *centre, sweep)


coordinates = st.floats(-60, 60)
places = st.tuples(coordinates, coordinates)
lines = st.builds(
    lambda a, b, feed: line(a, b, feed=feed), places, places, st.floats(100, 9000)
).filter(lambda move: abs(complex(move.x1 - move.x0, move.c1 - move.c0)) > 0.1)
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
    parts, speed = np.linspace(0.0, 1.0, 2000), move.feed / 60.0
    start, end = complex(move.x0, move.c0), complex(move.x1, move.c1)
    if isinstance(move, Line):
        return start + parts * (end - start), speed
    centre = complex(move.cx, move.cc)
    speed = min(speed, (limits.round_acceleration * abs(start - centre)) ** 0.5)
    return centre + (start - centre) * np.exp(1j * parts * move.sweep), speed
