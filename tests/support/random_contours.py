# SPDX-License-Identifier: GPL-2.0-or-later
"""Contours made at random for one tool, and how deep it cuts into them, as shapely measures it."""

import cmath
import math
from typing import NamedTuple

import numpy as np
from shapely.geometry import LineString, Polygon

from g12.compensation import centre_path
from g12.compensation.contour import Contour, PlaneMove
from g12.errors import LONGEST_MESSAGE, Refusal
from g12.geometry.curve import angle_of
from support.contour_geometry import Round, Straight, lines, shape_of
from support.planned_cuts import add

TOLERANCE = 0.005
FINE = 0.002  # of chords that stand for arcs


class Drawn(NamedTuple):
    """Shapes to cut with a tool, first a lead-in and last a lead-out, if any, and the part's."""

    shapes: list
    side: int
    radius: float
    body: list


def away(drawn):
    """Return the vector from the contour to the tool's side, long enough for a ramp."""
    return (1.3 * abs(drawn.radius) + 0.2) * (1j if drawn.side == 41 else -1j)


def contour_of(drawn, depth=-1.0):
    """Return the contour with ramps square to its ends; it begins at no special place."""
    first, last = drawn.shapes[0], drawn.shapes[-1]
    start = first.start + away(drawn) * first.direction(0.0)
    end = last.end + away(drawn) * last.direction(1.0)
    contour = Contour(abs(start), 0.0, depth)
    contour.straight(start.real, start.imag, at=1, feed=300.0)
    contour.compensate(drawn.side, drawn.radius, at=2)
    contour.straight(first.start.real, first.start.imag, at=2, feed=300.0)
    for line, shape in enumerate(drawn.shapes, 3):
        add(contour, shape, line=line, feed=300.0)
    contour.compensate(40, 0.0, at=9000)
    contour.straight(end.real, end.imag, at=9000, feed=300.0)
    return contour


def points_of(shape):
    """Return points of a shape, or of a move of the tool's path."""
    shape = getattr(shape, "curve", shape)
    bend, radius = getattr(shape, "sweep", 0.0), getattr(shape, "radius", 1.0)
    count = 2 + math.ceil(abs(bend) * math.sqrt(radius / FINE))
    return shape_of(shape).points(count)


def as_shapely(shapes):
    points = np.concatenate([points_of(shape) for shape in shapes])
    return LineString(np.column_stack([points.real, points.imag]))


def outline(part):
    """Return the outline of a closed part, each corner once: twice, rounding makes it a loop."""
    points = np.concatenate([points_of(shape)[:-1] for shape in part.body])
    return Polygon(np.column_stack([points.real, points.imag]))


def stands(part):
    """Return whether the material is inside of a closed part, by the tool's side."""
    return outline(part).exterior.is_ccw == (part.side == 42)


def refusal(contour):
    """Return the message with which a contour is refused, or an empty text."""
    try:
        centre_path.tool_path(contour, contour.elements, TOLERANCE)
    except Refusal as refused:
        assert len(refused.message) < LONGEST_MESSAGE
        return refused.message
    return ""


def blind_path(monkeypatch, contour):
    """Return the tool's path, compensated and its ramps, that nobody has looked at for gouges."""
    with monkeypatch.context() as patch:
        patch.setattr(centre_path, "check_gouges", lambda *_: None)
        path = centre_path.tool_path(contour, contour.elements, TOLERANCE)
    return [element for element in path if isinstance(element, PlaneMove) and element.line > 1]


def depth(path, drawn):
    """Return how deep the tool cuts into the part."""
    return drawn.radius - as_shapely(path).distance(as_shapely(drawn.body))


def closed(corners):
    """Return a closed polygon that begins in its first corner."""
    return lines(*corners, corners[0])


def polygon(corners):
    """Return a closed polygon that begins in the middle of its first side."""
    middle = 0.5 * (corners[0] + corners[1])
    return lines(middle, *corners[1:], corners[0], middle)


def star(draw, count, reach):
    """Return corners about a centre at random distances, counterclockwise."""
    radii = [draw.uniform(4.0, reach) for _ in range(count)]
    angles = sorted(draw.uniform(0.0, 2 * math.pi) for _ in range(count))
    centre = complex(draw.uniform(-20, 20), draw.uniform(-20, 20))
    return [centre + cmath.rect(r, a) for r, a in zip(radii, angles)]


def rounded(draw, shapes):
    """Return a polygon with some of its corners rounded off."""
    made, ahead = [], shapes[0]
    for following in shapes[1:]:
        shape, ahead = ahead, following
        before = shape.direction(1.0)
        turn = angle_of(following.direction(0.0) / before)
        if draw.random() < 0.5 or abs(turn) < 0.05 or abs(turn) > 2.8:
            made.append(shape)
            continue
        cut = draw.uniform(0.1, 0.45) * min(shape.length, following.length)
        radius = math.copysign(cut / math.tan(abs(turn) / 2), turn)
        start = shape.end - cut * before
        corner = Round(start, start + 1j * radius * before, turn)
        made += [Straight(shape.start, start), corner]
        ahead = Straight(corner.end, following.end)
    return [*made, ahead]


def drawn(draw, crossing=False, reach=25.0):
    """Return a closed contour and its tool, or None; ``crossing``: it mostly crosses itself."""
    corners = star(draw, draw.randint(3, 9), reach)
    if crossing:
        draw.shuffle(corners)
    shapes = polygon(corners)
    if min(shape.length for shape in shapes) < 0.3:
        return None
    if draw.random() < 0.6:
        shapes = rounded(draw, shapes)
    return Drawn(shapes, draw.choice([41, 42]), draw.choice([0.3, 1.0, 3.0, 6.0]), shapes)


def open_path(draw):
    """Return lines and arcs one after the other and their tool, or None for too few of them."""
    at, shapes = complex(draw.uniform(-20, 20), draw.uniform(-20, 20)), []
    for _ in range(draw.randint(2, 5)):
        to = complex(draw.uniform(-20, 20), draw.uniform(-20, 20))
        sweep = draw.choice([1, -1, 0]) * draw.uniform(0.1, 5.0)
        shape = Round(at, to, sweep) if sweep else Straight(at, to)
        if shape.length > 0.5 and abs(shape.start - shape.end) > 0.1:
            shapes.append(shape)
            at = complex(shape.end)
    sides, radii = [41, 42], [0.5, 1.0, 4.0]
    return Drawn(shapes, draw.choice(sides), draw.choice(radii), shapes) if shapes[1:] else None
