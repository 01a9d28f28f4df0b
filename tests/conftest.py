# SPDX-License-Identifier: GPL-2.0-or-later
"""What holds for all tests: which this system can run, a scratch home, no process left."""

from __future__ import annotations

import compileall
import os
import shutil
from itertools import chain

import pytest
from hypothesis import settings

from g12.tools import progress
from g12.tools.headless.namespaces import OneAtATime
from support.processes import kill_session, start_in_terminal
from support.sim_machines import ROOT

NEED_LINUXCNC = ("interp", "sim")

SOAKED = "SOAK_SEED" in os.environ  # other examples each time
settings.register_profile("g12", deadline=None, derandomize=not SOAKED, database=None)
settings.load_profile("g12")


def pytest_configure(config):
    """Compile the package once: the many interpreters that tests start write no bytecode."""
    if not hasattr(config, "workerinput"):  # which are xdist's
        compileall.compile_dir(ROOT / "python" / "g12", quiet=2)


def missing(folder):
    """Return what this system lacks for the tests of a folder, None if nothing."""
    needed = folder in NEED_LINUXCNC and not shutil.which("linuxcnc")
    return "LinuxCNC is not installed" if needed else None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Skip what cannot run here; a file's tests stay on one core unless they say otherwise."""
    groups = {}
    for item in items:
        if not item.get_closest_marker("xdist_group"):
            item.add_marker(pytest.mark.xdist_group(f"{item.path.parent.name}/{item.path.stem}"))
        why = missing(item.path.parent.name)
        if why:
            item.add_marker(pytest.mark.skip(reason=why))
        groups.setdefault(item.get_closest_marker("xdist_group").args, []).append(item)
    items[:] = chain.from_iterable(mixed(list(groups.values())))


def mixed(groups):
    """Return groups of tests with those of `sim` spread among the others, the largest first.

    They wait for real motion; meanwhile the cores are free for tests that compute.
    """
    waiting = sorted((group for group in groups if is_of_sim(group)), key=len, reverse=True)
    computing = [group for group in groups if not is_of_sim(group)]
    shares = [
        (number / len(kind), group) for kind in (waiting, computing)
        for number, group in enumerate(kind)
    ]  # fmt: skip
    return [group for _, group in sorted(shares, key=lambda share: share[0])]


def is_of_sim(group):
    """Tell whether a group of tests runs LinuxCNC's motion."""
    return group[0].path.parent.name == "sim"


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    """Skip a test that needs two LinuxCNCs side by side where there are no namespaces."""
    report = (yield).get_result()
    if call.excinfo and call.excinfo.errisinstance(OneAtATime):
        report.outcome = "skipped"
        report.longrepr = (str(item.path), item.location[1], str(call.excinfo.value))


@pytest.fixture(autouse=True, scope="session")
def scratch_home(tmp_path_factory):
    """Nothing that a test starts finds or leaves anything in the user's home."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HOME", str(tmp_path_factory.mktemp("home")))
        yield


@pytest.fixture(autouse=True, scope="session")
def unhurried():
    """Keep commands that a test calls from telling of their progress, on slow systems too."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(progress, "LINE_TICK", 3600.0)
        yield


@pytest.fixture(autouse=True, scope="session")
def unsynced():
    """Write nothing through to the disk: it would be whatever else the system has written."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        patch.setattr(os, "sync", lambda: None)
        yield


@pytest.fixture
def start():
    """Start commands as a terminal does; they and what they started end with the test."""
    started = []

    def started_here(*command, **options):
        started.append(start_in_terminal(*command, **options))
        return started[-1]

    yield started_here
    for process in started:
        kill_session(process)
