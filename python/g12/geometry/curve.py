# SPDX-License-Identifier: GPL-2.0-or-later
"""Lines and arcs of a plane, directed from start to end; which of many is near to a point.

A share of a curve is a fraction of its length: 0 at the start, 1 at the end.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Iterator, Sequence
from math import inf, sqrt
from typing import NamedTuple

DEGENERATE = 1e-12  # a shorter line is a point: it has a length of 0 and no direction
FULL_TURN = 2 * math.pi
LEAST_MARGIN = 0.5  # radians beyond an end that still count as the end of a nearly full circle

Box = tuple[float, float, float, float]  # least x and y, greatest x and y


class Line(NamedTuple):
    start: complex
    end: complex

    @property
    def length(self) -> float:
        return abs(self.end - self.start)

    @property
    def curvature(self) -> float:
        return 0.0

    def point(self, share: float) -> complex:
        return self.start + share * (self.end - self.start)

    def direction(self, share: float = 0.0) -> complex:
        """Return the unit vector of the motion, 0 of a point."""
        length = self.length
        return (self.end - self.start) / length if length > DEGENERATE else 0j

    def portion(self, first: float, last: float) -> Line:
        return Line(self.point(first), self.point(last))

    def offset(self, distance: float) -> Line:
        """Return the parallel line, ``distance`` to the left of the motion."""
        shift = 1j * distance * self.direction()
        return Line(self.start + shift, self.end + shift)

    def share_of(self, point: complex) -> float:
        """Return the share of the line's point nearest to a point."""
        along = self.end - self.start
        square = (along * along.conjugate()).real
        if square <= DEGENERATE * DEGENERATE:
            return 0.0
        return min(1.0, max(0.0, ((point - self.start) * along.conjugate()).real / square))

    def distance(self, point: complex) -> float:
        return abs(point - self.point(self.share_of(point)))

    def length_to(self, point: complex, late: bool = False) -> float:
        """Return the length to a point's foot: below 0 before the start, more beyond the end."""
        return ((point - self.start) * self.direction().conjugate()).real

    @property
    def box(self) -> Box:
        (x0, y0), (x1, y1) = _pair(self.start), _pair(self.end)
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)


class Arc(NamedTuple):
    """A circular curve about ``centre`` by the signed angle ``sweep``; a full circle has 2 pi."""

    start: complex
    centre: complex
    sweep: float

    @property
    def end(self) -> complex:
        return self.point(1.0)

    @property
    def radius(self) -> float:
        return abs(self.start - self.centre)

    @property
    def length(self) -> float:
        return self.radius * abs(self.sweep)

    @property
    def curvature(self) -> float:
        """The turn to the left in radians per unit of length."""
        return math.copysign(1.0 / self.radius, self.sweep)

    def point(self, share: float) -> complex:
        return self.centre + (self.start - self.centre) * cmath.rect(1.0, share * self.sweep)

    def direction(self, share: float = 0.0) -> complex:
        """Return the unit vector of the motion at a share of the arc."""
        outward = self.point(share) - self.centre
        return math.copysign(1.0, self.sweep) * 1j * outward / (abs(outward) or 1.0)

    def portion(self, first: float, last: float) -> Arc:
        return Arc(self.point(first), self.centre, (last - first) * self.sweep)

    def offset(self, distance: float) -> Arc:
        """Return the parallel arc, ``distance`` to the left of the motion.

        An arc that is offset beyond its own centre has the start on the other side of it.
        """
        outward = (self.start - self.centre) / (self.radius or 1.0)
        return self._replace(start=self.start - math.copysign(1.0, self.sweep) * distance * outward)

    def share_of(self, point: complex) -> float:
        angle, sweep = self._angle_to(point), abs(self.sweep)
        if angle <= sweep:
            return angle / (sweep or 1.0)
        return 0.0 if abs(point - self.start) <= abs(point - self.end) else 1.0

    def share_towards(self, point: complex) -> float:
        """Return the share at which the arc is in the direction of a point from its centre.

        Above 1 where that is beyond its end, and 1 of a full circle for its start.
        """
        turn = 1 if self.sweep > 0.0 else -1
        return sweep_between(self.start, point, self.centre, turn) / self.sweep

    def distance(self, point: complex) -> float:
        if self._angle_to(point) <= abs(self.sweep):
            return abs(abs(point - self.centre) - self.radius)
        return min(abs(point - self.start), abs(point - self.end))

    def length_to(self, point: complex, late: bool = False) -> float:
        """Return the length to a point's foot: below 0 before the start, more beyond the end.

        A foot in an arc's gap counts as before the start in the nearer half of the gap. The gap of
        a nearly full circle is narrow or none: half a radian counts as before the start, with
        ``late`` as beyond the end.
        """
        sweep = abs(self.sweep)
        margin = max(math.pi - sweep / 2, LEAST_MARGIN)
        highest = sweep + margin if late else FULL_TURN - margin
        return self.radius * (highest - (highest - self._angle_to(point)) % FULL_TURN)

    def _angle_to(self, point: complex) -> float:
        """Return the angle from the start to the direction of a point, below a full turn."""
        start, there = self.start - self.centre, point - self.centre
        if abs(there) <= DEGENERATE or abs(start) <= DEGENERATE:
            return 0.0
        return angle_of(there * start.conjugate()) * math.copysign(1.0, self.sweep) % FULL_TURN

    @property
    def box(self) -> Box:
        """A box around the arc, not always the smallest."""
        (x0, y0), (x1, y1) = _pair(self.start), _pair(self.end)
        if abs(self.sweep) > math.pi:
            (x, y), radius = _pair(self.centre), self.radius
            return x - radius, y - radius, x + radius, y + radius
        rise = self.radius * (1.0 - math.cos(self.sweep / 2))
        return min(x0, x1) - rise, min(y0, y1) - rise, max(x0, x1) + rise, max(y0, y1) + rise


Curve = Line | Arc


def angle_of(vector: complex) -> float:
    """Return the angle of a vector; `cmath.phase` fails where one of its parts underflows."""
    return math.atan2(vector.imag, vector.real)


def _pair(point: complex) -> tuple[float, float]:
    return point.real, point.imag


def recentred(start: complex, end: complex, centre: complex) -> complex:
    """Return the point nearest to ``centre`` that is equally far from ``start`` and ``end``."""
    chord, middle = end - start, (start + end) / 2
    along = ((centre - middle) * chord.conjugate()).real / abs(chord) ** 2
    return centre - along * chord


def sweep_between(start: complex, end: complex, centre: complex, turn: int) -> float:
    """Return the signed angle from one point to another about a centre.

    ``turn``: +1 counterclockwise, -1 clockwise. A full turn where the angle is none.
    """
    angle = (turn * angle_of((end - centre) * (start - centre).conjugate())) % FULL_TURN
    return turn * (angle or FULL_TURN)


# Crossings. A circle that misses another curve by less than TOUCHES counts as tangent.

PARALLEL_SINE = 1e-9  # sine of the angle between lines that are parallel
TOUCHES = 1e-6  # as SAME_POINT of a contour


def crossings(one: Curve, other: Curve) -> list[complex]:
    """Return the points common to the lines or circles on which two curves lie, at most two."""
    if isinstance(one, Line):
        return _line_line(one, other) if isinstance(other, Line) else _line_circle(one, other)
    return _line_circle(other, one) if isinstance(other, Line) else _circle_circle(one, other)


def common_points(one: Curve, other: Curve) -> list[complex]:
    """Return the points at which two curves cross or touch; none along a common portion."""
    return [
        point
        for point in crossings(one, other)
        if one.distance(point) <= TOUCHES and other.distance(point) <= TOUCHES
    ]


def _line_line(one: Line, other: Line) -> list[complex]:
    along, across = one.direction(), other.direction()
    sine = (along.conjugate() * across).imag
    if abs(sine) <= PARALLEL_SINE:
        return []
    return [one.start + ((other.start - one.start).conjugate() * across).imag / sine * along]


def _line_circle(line: Line, circle: Arc) -> list[complex]:
    along = line.direction()
    foot = line.start + ((circle.centre - line.start) * along.conjugate()).real * along
    return [foot + half * along for half in _halves(abs(circle.centre - foot), circle.radius)]


def _circle_circle(one: Arc, other: Arc) -> list[complex]:
    apart = abs(other.centre - one.centre)
    if apart <= TOUCHES:
        return []
    along = (other.centre - one.centre) / apart
    foot = (apart + (one.radius - other.radius) * (one.radius + other.radius) / apart) / 2
    return [one.centre + (foot + 1j * half) * along for half in _halves(abs(foot), one.radius)]


def _halves(distance: float, radius: float) -> tuple[float, ...]:
    """Return half the chord at a distance from a circle's centre, with both signs."""
    if distance > radius + TOUCHES:
        return ()
    half = math.sqrt(max(0.0, (radius - distance) * (radius + distance)))
    return (half, -half)


LEAF = 4  # most curves in a box that is not divided
NOWHERE = (inf, inf, -inf, -inf)  # the box around no curves


class BoxTree:
    """A tree of boxes around curves, which are known by their indices in a sequence."""

    def __init__(self, curves: Sequence[Curve]) -> None:
        self.curves = curves
        self._root = _Node([(index, curve.box) for index, curve in enumerate(curves)])

    @property
    def box(self) -> Box:
        return self._root.box

    def near(self, box: Box, distance: float) -> Iterator[int]:
        """Yield the indices of the curves whose boxes are within a distance of a box."""
        waiting = [self._root]
        while waiting:
            node = waiting.pop()
            if not apart(node.box, box, distance):
                waiting.extend(node.halves)
                yield from (
                    index for index, around in node.items if not apart(around, box, distance)
                )

    def nearest(
        self, point: complex, distance: float, counts: Callable[[int], bool] = lambda _: True
    ) -> tuple[float, int | None]:
        """Return the distance from a point to the nearest curve that counts, and the curve's index.

        Only curves nearer than ``distance`` are searched: that and None where there is none.
        """
        found, x, y = None, point.real, point.imag
        waiting = [(0.0, self._root)]
        while waiting:
            away, node = waiting.pop()
            if away >= distance:
                continue
            if node.halves:
                one, other = node.halves
                to_one, to_other = _away(x, y, one.box), _away(x, y, other.box)
                pairs = (to_other, other), (to_one, one)
                waiting.extend(pairs if to_one < to_other else pairs[::-1])
            for index, around in node.items:
                if _away(x, y, around) < distance:
                    away = self.curves[index].distance(point)
                    if away < distance and counts(index):
                        distance, found = away, index
        return distance, found


class _Node:
    """A box around some curves: two halves, or a few curves with their own boxes."""

    __slots__ = ("box", "halves", "items")

    def __init__(self, items: list[tuple[int, Box]]) -> None:
        self.items, self.halves = items, list[_Node]()
        low_x, low_y, high_x, high_y = zip(*[box for _, box in items] or [NOWHERE])
        self.box: Box = (min(low_x), min(low_y), max(high_x), max(high_y))
        if len(items) > LEAF:
            # Divided across the longer side: the boxes of concentric rings contain each other.
            low = 0 if self.box[2] - self.box[0] > self.box[3] - self.box[1] else 1
            items.sort(key=lambda item: item[1][low] + item[1][low + 2])
            middle = len(items) // 2
            self.items, self.halves = [], [_Node(items[:middle]), _Node(items[middle:])]


def apart(one: Box, other: Box, distance: float) -> bool:
    """Tell whether two boxes are farther than ``distance`` from each other."""
    return (
        one[0] - other[2] > distance
        or other[0] - one[2] > distance
        or one[1] - other[3] > distance
        or other[1] - one[3] > distance
    )


def _away(x: float, y: float, box: Box) -> float:
    """Return the distance of a point from a box, 0 inside it."""
    low_x, low_y, high_x, high_y = box
    dx = low_x - x if x < low_x else x - high_x if x > high_x else 0.0
    dy = low_y - y if y < low_y else y - high_y if y > high_y else 0.0
    return sqrt(dx * dx + dy * dy) if dx and dy else dx + dy
