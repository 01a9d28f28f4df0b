# SPDX-License-Identifier: GPL-2.0-or-later
"""Counts of rings, levels and spiral turns: decided here once, never rounded again in NGC.

All lengths of one call are in one unit.
"""

from __future__ import annotations

import math

COUNTLESS = 1e9  # steps; a quotient beyond it could not even be rounded


def steps_between(first: float, last: float, step: float, tolerance: float) -> int:
    """Return how many steps, none longer than ``step``, lead from ``first`` to ``last``.

    A rest shorter than ``tolerance`` is rounding, not a step of its own.
    """
    return max(0, math.ceil(min((last - first - tolerance) / step, COUNTLESS)))
