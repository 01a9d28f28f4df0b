# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step would do: a sentence, and lines to draw. Lengths are mm."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

READY, MESSAGE, REFUSED = "ready", "message", "refused"
MARGIN = 0.92  # share of a drawing's place


class Line(NamedTuple):
    """A move as drawn."""

    is_rapid: bool
    points: np.ndarray  # one row each


class Sketch(NamedTuple):
    """What a step would do."""

    state: str  # READY, MESSAGE or REFUSED
    text: str  # for the operator
    lines: Sequence[Line] = ()
    radius: float = 0.0  # of the cutter

    def strokes(self, width: int, height: int) -> Iterator[tuple[str, float, list[np.ndarray]]]:
        """Yield a colour's name, a pen's width and its lines, all in pixels, in drawing order.

        What is cut fills the place, with y downwards.
        """
        cut = [line.points for line in self.lines if not line.is_rapid] or [np.zeros((1, 2))]
        points = np.concatenate(cut)
        low, high = points.min(axis=0) - self.radius, points.max(axis=0) + self.radius
        size = np.maximum(high - low, 1e-3)
        scale = MARGIN * min(width / size[0], height / size[1])
        middle = np.array([width / 2, height / 2])
        pens = ("swept", 2 * self.radius * scale, False), ("rapid", 1, True), ("path", 1.3, False)
        for name, pen, is_rapid in pens:
            shown = (line.points for line in self.lines if line.is_rapid == is_rapid)
            pixels = [middle + (each - (low + high) / 2) * scale * (1, -1) for each in shown]
            yield name, max(pen, 0.1), pixels
