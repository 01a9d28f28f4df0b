# SPDX-License-Identifier: GPL-2.0-or-later
"""Units of length and angle, the largest length, the rounding of a length."""

from __future__ import annotations

MM_PER_INCH = 25.4
INCH_SLACK = 1e-3  # units per mm that LinuxCNC takes for an inch machine
DEGREES_PER_TURN = 360.0
ROUNDING_MM = 1e-6  # lengths closer than this are equal: a unit's conversion rounds
LARGEST = 1e6  # inches or mm: beyond any machine; sums and squares stay exact enough


def converts(factor: float) -> bool:
    """Return whether a factor converts to another unit; an INI's inch may be rounded."""
    return abs(factor - 1.0) > INCH_SLACK


def is_inch(millimetres: float) -> bool:
    """Return whether LinuxCNC takes a machine for an inch machine, by its unit's length in mm."""
    return abs(1 / millimetres - 1 / MM_PER_INCH) < INCH_SLACK
