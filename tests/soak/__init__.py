# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`.

Every test has the same share of the time; it begins no other try when that is used up.
"""

import os
import time

MINUTES = float(os.environ.get("SOAK_MINUTES", "10"))
SEED = int(os.environ.get("SOAK_SEED", "0"))
END = float(os.environ.setdefault("SOAK_END", str(time.time() + 60 * MINUTES)))  # workers inherit
WORKERS = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))


class Share:
    """What a test has of the time, from its start on."""

    seconds = 0.0  # `more_examples` knows it when the tests are collected
    end = END

    @classmethod
    def of(cls, tests):
        cls.seconds = 60 * MINUTES * WORKERS / tests

    @classmethod
    def begin(cls):
        cls.end = min(END, time.time() + cls.seconds)

    @classmethod
    def is_used(cls):
        return time.time() > cls.end


def tries(request, what):
    """Yield a number for each try; `more_examples` reports at the end how many held."""
    held = [0]
    request.node.user_properties.append((f"soak: {what}", held))
    while not held[0] or not Share.is_used():
        yield held[0]
        held[0] += 1
