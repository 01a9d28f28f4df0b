# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`."""

import os

MINUTES = float(os.environ.get("SOAK_MINUTES", "10"))
SEED = int(os.environ.get("SOAK_SEED", "0"))


def often(each_ten_minutes):
    """Return how often something is done, at least once."""
    return max(1, round(each_ten_minutes * MINUTES / 10))
