# SPDX-License-Identifier: GPL-2.0-or-later
"""Proof at scale, outside the normal tests: `make soak MINUTES=N`; see `__main__`."""

import os
import time

SEED = int(os.environ.get("SOAK_SEED", "0"))
END = time.time() + float(os.environ.get("SOAK_SECONDS", "30"))  # of this process's tries
TRIED = os.environ.get("SOAK_TRIED", os.devnull)  # a file with a line for each try that held


def tries(what):
    """Yield a number for each try; that one more held is noted when the next one is asked for."""
    number = 0
    while not number or time.time() < END:
        yield number
        with open(TRIED, "a", encoding="utf-8") as file:
            file.write(f"{what}\n")
        number += 1
