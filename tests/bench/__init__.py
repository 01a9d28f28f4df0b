# SPDX-License-Identifier: GPL-2.0-or-later
"""The figures the project promises, each measured against its peer in the same run.

A module of this package yields `Figure`s from its ``figures()``; ``make bench`` prints them.
"""

from typing import NamedTuple


class Figure(NamedTuple):
    """One promised figure: what was measured, the number, its limit, and how it came about."""

    what: str
    value: float
    limit: float
    unit: str
    how: str
