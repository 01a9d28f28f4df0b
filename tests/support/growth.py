# SPDX-License-Identifier: GPL-2.0-or-later
"""How the time of a task grows with its size, which a slow or busy machine does not change."""

import time


def growth(task, size, factor=4):
    """Return how often the CPU time of ``task(size)`` a task ``factor`` times as large takes.

    ``task(n)`` makes what is to be measured and returns a function that runs it.  The square of
    ``factor`` is what a comparison of each with each costs.
    """
    return seconds(task(size * factor)) / seconds(task(size))


def seconds(run):
    """Return the least CPU time of three runs."""
    times = []
    for _ in range(3):
        start = time.process_time()
        run()
        times.append(time.process_time() - start)
    return min(times)
