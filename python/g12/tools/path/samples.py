# SPDX-License-Identifier: GPL-2.0-or-later
"""The actual motion of a machine, recorded at the servo rate."""

from dataclasses import dataclass
from typing import Self

import numpy as np


@dataclass(frozen=True)
class Samples:
    """The motion recorded at the servo rate, numpy arrays of equal length.

    ``time`` in seconds from the first sample; ``axes`` maps ``"X"`` … to commanded positions;
    ``velocity`` is the speed along the path, machine units per second; ``line`` the program line in
    motion; ``kind`` 0 for standstill, 1 rapid, 2 feed, 3 arc, 4 tool change, 5 probe, 6 rotary
    unlock.
    """

    time: np.ndarray
    axes: dict[str, np.ndarray]
    velocity: np.ndarray
    line: np.ndarray
    kind: np.ndarray

    def moving(self) -> np.ndarray:
        return self.kind != 0

    def only(self, chosen: np.ndarray) -> Self:
        """Return the samples of a mask."""
        axes = {letter: values[chosen] for letter, values in self.axes.items()}
        velocity, line, kind = (each[chosen] for each in (self.velocity, self.line, self.kind))
        return type(self)(self.time[chosen], axes, velocity, line, kind)
