# SPDX-License-Identifier: GPL-2.0-or-later
"""What a step would do: a sentence, and lines to draw. Lengths are mm."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

READY, MESSAGE, REFUSED = "ready", "message", "refused"
MARGIN = 0.92  # share of a drawing's place


class Sketch(NamedTuple):
    """What a step would do."""

    state: str  # READY, MESSAGE or REFUSED
    text: str  # for the operator
    cut: Sequence[np.ndarray] = ()  # lines, a row for each point
    rapid: Sequence[np.ndarray] = ()
    radius: float = 0.0  # of the cutter

    def strokes(self, width: int, height: int) -> Iterator[tuple[str, float, list[np.ndarray]]]:
        """Yield a colour's name, a pen's width and its lines, all in pixels, in drawing order.

        What is cut fills the place, with y downwards.
        """
        points = np.concatenate(self.cut or [np.zeros((1, 2))])
        low, high = points.min(axis=0) - self.radius, points.max(axis=0) + self.radius
        place, middle = np.array([width, height]), (low + high) / 2
        scale = MARGIN * (place / np.maximum(high - low, 1e-3)).min()
        for name, pen in ("swept", 2 * self.radius * scale), ("rapid", 1), ("path", 1.3):
            lines = self.rapid if name == "rapid" else self.cut
            pixels = [place / 2 + (line - middle) * scale * (1, -1) for line in lines]
            yield name, max(pen, 0.1), pixels
