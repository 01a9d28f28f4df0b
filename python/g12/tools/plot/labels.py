# SPDX-License-Identifier: GPL-2.0-or-later
"""Texts beside each other that must not cover each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def spread_out(places: Sequence[float], apart: float) -> list[float]:
    """Return ascending places moved as little as it takes to be so far apart.

    Less as many steps as come before them they must not fall: neighbours that do share their mean.
    """
    groups: list[list[float]] = []
    for index, place in enumerate(places):
        groups.append([place - index * apart])
        while len(groups) > 1 and np.mean(groups[-2]) > np.mean(groups[-1]):
            groups[-2:] = [groups[-2] + groups[-1]]
    flat = [np.mean(group) for group in groups for _ in group]
    return [float(place + index * apart) for index, place in enumerate(flat)]
