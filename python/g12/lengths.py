# SPDX-License-Identifier: GPL-2.0-or-later
"""Units of length, and what is no length any more."""

from __future__ import annotations

MM_PER_INCH = 25.4
LARGEST = 1e6  # inches or mm: more than any machine has; sums and squares stay exact enough
