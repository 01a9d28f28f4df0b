# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves found by their boxes: which of many are near to a box, which is nearest to a point."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import inf, sqrt

from g12.geometry.curve import Box, Curve

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
