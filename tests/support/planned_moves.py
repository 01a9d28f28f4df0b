# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves of a contour, from the coordinates of their ends."""

from g12.compensation.contour import PlaneMove
from g12.geometry.curve import Arc, Line


def line(x0, c0, x1, c1, h0=0.0, h1=0.0, *, number=1, feed=100.0, offset=0.0):
    return PlaneMove(number, feed, offset, Line(complex(x0, c0), complex(x1, c1)), h0, h1)


def arc(centre, start, sweep, h0=0.0, h1=0.0, *, number=1, feed=100.0, offset=0.0):
    return PlaneMove(number, feed, offset, Arc(start, centre, sweep), h0, h1)
