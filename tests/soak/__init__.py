# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`.

Every test has a share of the time that is left: what tests before it have used beyond theirs, as on
a busy computer, is shared by those after it. It begins no other try when its share is used up.
"""

import os
import tempfile
import time

MINUTES = float(os.environ.get("SOAK_MINUTES", "10"))
SEED = int(os.environ.get("SOAK_SEED", "0"))
END = float(os.environ.setdefault("SOAK_END", str(time.time() + 60 * MINUTES)))  # workers inherit
WORKERS = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
if "SOAK_STARTED" not in os.environ:  # a file with a byte for each test that has started
    os.environ["SOAK_STARTED"] = tempfile.mkstemp(prefix="soak-")[1]


class Share:
    """What a test has of the time, from its start on."""

    tests = 1  # `more_examples` knows it when the tests are collected
    end = END

    @classmethod
    def begin(cls):
        with open(os.environ["SOAK_STARTED"], "ab") as started:
            started.write(b".")
            started.flush()
            left = cls.tests - started.tell() + 1
        now = time.time()
        cls.end = now + (END - now) * min(1.0, WORKERS / max(left, 1))

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
