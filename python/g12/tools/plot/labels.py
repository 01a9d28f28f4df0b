# SPDX-License-Identifier: GPL-2.0-or-later
"""Labels side by side without overlap."""

from collections.abc import Sequence

import numpy as np


def spread_out(positions: Sequence[float], apart: float) -> list[float]:
    """Return ascending positions, moved as little as possible to be ``apart`` from each other.

    That is an isotonic regression: positions less their index times ``apart`` must not descend,
    and neighbours that do are replaced by their mean.
    """
    groups: list[list[float]] = []
    for index, position in enumerate(positions):
        groups.append([position - index * apart])
        while len(groups) > 1 and np.mean(groups[-2]) > np.mean(groups[-1]):
            groups[-2:] = [groups[-2] + groups[-1]]
    flat = [np.mean(group) for group in groups for _ in group]
    return [float(position + index * apart) for index, position in enumerate(flat)]
