# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`."""

import os

MINUTES = float(os.environ.get("SOAK_MINUTES", "10"))
SEED = int(os.environ.get("SOAK_SEED", "0"))


def often(each_ten_minutes):
    """Return how often something is done, at least once."""
    return max(1, round(each_ten_minutes * MINUTES / 10))


class Tried:
    """Counts what a test tries, for what `more_examples` says at the end."""

    def __init__(self, request, what):
        self._number = [0]
        request.node.user_properties.append((f"soak: {what}", self._number))

    def one(self):
        """Count one more."""
        self._number[0] += 1
