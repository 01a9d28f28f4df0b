# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page: from a key to the drawing, and the memory of many edits."""

import os
import resource
import tempfile
import threading
import time

from bench import Figure
from g12.tools.cycles_page.page import Page
from support.sim_machines import SIM

MACHINES = "mill_mm", "mill_yasnac_mm", "mill_mitsubishi_mm", "lathe_mm"
KEYS, EDITS, WARM = 15, 10_000, 500


def figures():
    """Yield the page's rows."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["XDG_STATE_HOME"] = folder
        times = {}
        for machine in MACHINES:
            page, drawn = opened(machine)
            times |= {form.name: middle(page, drawn, form) for form in page.forms}
            page.close()
        slowest = max(times, key=times.get)
        how = f"middle of {KEYS} edits of its depth, the slowest cycle: {slowest}"
        yield Figure("Cycles page: from a key to the drawing", times[slowest], 50, how, " ms")
        yield memory()


def opened(machine):
    drawn = threading.Event()
    return Page(SIM / f"{machine}_headless.ini", drawn.set), drawn


def middle(page, drawn, form):
    """Return the middle time in ms from a key to the sketch."""
    page.select(form)
    name = "depth" if "depth" in page.texts else "z"
    text, times = page.texts[name], []
    for key in range(KEYS):
        begun = time.perf_counter()
        typed(page, drawn, name, f"{text}{key % 10}" if "." in text else f"{text}.{key % 10}")
        times.append(time.perf_counter() - begun)
    return 1000 * sorted(times)[KEYS // 2]


def typed(page, drawn, name, text):
    drawn.clear()
    page.type(name, text)
    drawn.wait(10)


def memory():
    """Measure how memory grows over many edits."""
    page, drawn = opened("mill_mm")
    for edit in range(EDITS):
        typed(page, drawn, "i", str(7 + edit % 5))
        if edit == WARM:
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    page.close()
    what = f"Cycles page: memory that {EDITS:,} edits of a form add"
    return Figure(what, grown / 1024, 2, f"peak of the screen's process after {WARM} edits", " MB")
