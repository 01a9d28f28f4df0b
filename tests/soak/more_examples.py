# SPDX-License-Identifier: GPL-2.0-or-later
"""A plugin of pytest: the properties of the normal tests are tried with far more examples.

Other ones each time; a failure is reduced by hypothesis and printed with what repeats it.  What was
tried is counted, and said at the end.
"""

import signal
import time
from collections import Counter
from functools import wraps
from itertools import chain

import pytest
from hypothesis import HealthCheck, settings

from soak import END, Share

EXAMPLES = 1_000_000  # its share of the time ends a test
TIME_IS_UP = "its share of the time is used up"
TRIED = {  # by file
    "test_cycles": "blocks of the cycles",
    "test_polar_plan": "polar contours",
    "test_compensation_offset": "polar contours with compensation",
    "test_compensation_simplify": "contours with short moves",
    "soak_text": "hostile files",
}
# tests that wait for real motion while the cores are free, those with the longest runs first
WAITING = ("test_programs_as_they_run", "soak_kinematics", "soak_interruptions", "soak_spindle_c")
COUNTED = "soak: "  # begins the name of a report's property


@pytest.hookimpl(trylast=True)  # after the choice of -k
def pytest_collection_modifyitems(items):
    Share.tests = len(items)
    for item in (item for item in items if hasattr(item.obj, "hypothesis")):
        item.obj._hypothesis_internal_use_settings = settings(
            max_examples=EXAMPLES,
            deadline=None,
            derandomize=False,
            database=None,
            print_blob=True,
            suppress_health_check=list(HealthCheck),
        )
        item.obj.hypothesis.inner_test = counted(item)
    items[:] = alternated(items)


def pytest_runtest_setup(item):
    if time.time() > END:
        pytest.skip(TIME_IS_UP)
    Share.begin()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call():
    """End a test whose last try would go on when the time is over."""
    signal.signal(signal.SIGALRM, lambda *_: pytest.skip(TIME_IS_UP))
    signal.setitimer(signal.ITIMER_REAL, max(0.1, END - time.time()))
    yield
    signal.setitimer(signal.ITIMER_REAL, 0)


def alternated(items):
    """Return tests that wait and tests that compute by turns: each worker begins with both."""
    waiting = [item for name in WAITING for item in items if name in item.nodeid]
    computing = [item for item in items if item not in waiting]
    both = min(len(waiting), len(computing))
    by_turns = chain.from_iterable(zip(waiting, computing))
    return [*by_turns, *waiting[both:], *computing[both:]]


def counted(item):
    """Return a property's test that counts the examples it holds for."""
    test, held = item.obj.hypothesis.inner_test, []
    item.user_properties.append((COUNTED + TRIED.get(item.path.stem, item.path.stem), held))

    @wraps(test)
    def counting(*arguments, **words):
        if held and Share.is_used():
            pytest.skip(TIME_IS_UP)  # which ends a property
        test(*arguments, **words)
        held[:] = [sum(held) + 1]

    return counting


def tried_in(reports):
    """Return how often each thing was tried."""
    found = Counter()
    for name, number in (each for report in reports for each in report.user_properties):
        if name.startswith(COUNTED):
            found[name.removeprefix(COUNTED)] += sum(number)
    return found


def pytest_terminal_summary(terminalreporter):
    tried = Counter()
    for outcome in ("passed", "failed", "skipped"):
        tried.update(tried_in(terminalreporter.getreports(outcome)))
    terminalreporter.section("tried")
    for name, number in sorted(tried.items()):
        terminalreporter.write_line(f"{number:8,} {name}")
