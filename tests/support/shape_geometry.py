# SPDX-License-Identifier: GPL-2.0-or-later
"""Drawings of the shapes on a lathe's face, and what a tool's path leaves of a bar.

Nothing here knows the planners: a polygon is what half planes leave, corners are rounded by moving
it in and out. Lengths are millimetres, angles degrees, areas are shapely's.
"""

from shapely.affinity import rotate
from shapely.geometry import LineString, Point, box

FAR = 500.0
SEGMENTS = 180  # of a quarter circle of a drawing
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


def area_off(area, expected, tolerance):
    """Return how much of an area lies beyond a drawing, or is missing of it, by more than that."""
    beyond = area.difference(expected.buffer(tolerance)).area
    return beyond + expected.buffer(-tolerance).difference(area).area
