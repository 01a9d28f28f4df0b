# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`."""

import os

MINUTES = float(os.environ.get("SOAK_MINUTES", "10"))
SEED = int(os.environ.get("SOAK_SEED", "0"))


def often(each_ten_minutes):
    """Return how often something is done, at least once."""
    return max(1, round(each_ten_minutes * MINUTES / 10))


def tries(request, what, each_ten_minutes):
    """Yield a number for each try; `more_examples` reports at the end how many held."""
    held = [0]
    request.node.user_properties.append((f"soak: {what}", held))
    for number in range(often(each_ten_minutes)):
        yield number
        held[0] += 1
