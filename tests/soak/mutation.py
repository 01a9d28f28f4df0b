# SPDX-License-Identifier: GPL-2.0-or-later
"""Mutants of the planners against their tests: which ones nobody notices.

    PYTHONPATH=tests python3 -m soak.mutation --count 200 [--rooms flat polar] [--jobs 2]

Each mutant is put alone into a copy of the package. The tests of its module run first, then, if it
has survived, programs on the interpreter. Running for ever or taking too much memory counts as
noticed: the test did not pass. The sample is shuffled once: a longer run tries the same and more.
"""

import argparse
import json
import multiprocessing
import os
import random
import resource
import shutil
import signal
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import tomllib

from soak.mutants import Mutant, mutants_of, mutated

ROOT = Path(__file__).resolve().parents[2]
SEED = 12
ROOMS = ("cycles", "section", "flat", "polar")
PARTS = ("python", "tests", "ngc", "configs", "pyproject.toml")
CYCLES = ("words", "cycles_common", "cycles_travel", "haas", "yasnac", "mitsubishi", "circle_mill")
SECTION = ("section_block_rules", "section_codes", "section_line", "section_output", "polar_start")
FLAT = ("flat_contour", "flat_intersect", "flat_gouge", "flat_simplify", "flat_offset")
POLAR = (
    *("polar_exact_stops", "polar_feed", "polar_soft_limits", "polar_start", "polar_spacing"),
    "polar_pole",
    *("polar_face", "polar_plan"),
)
UNIT = {"cycles": CYCLES, "section": SECTION, "flat": (*FLAT, "polar_plan"), "polar": POLAR}
SECTIONS = ("polar_words", "polar_refusals", "polar_reading")
INTERP = {
    "cycles": ("haas", "yasnac", "mitsubishi", "circle_mill"),
    "section": SECTIONS,
    "flat": (*SECTIONS, "verify_programs"),
    "polar": (*SECTIONS, "verify_programs"),
}
CPU_SECONDS = 60  # of one process; the tests of a room take less than half of it
SECONDS = 900
MEMORY = 4 << 30


class Case(NamedTuple):
    """A mutant of a module, which is ``room/name.py``."""

    module: str
    mutant: Mutant

    @property
    def name(self):
        """What a list calls it."""
        return f"{self.module} {self.mutant.name}"


def cases(rooms=ROOMS):
    """Return all mutants of the rooms in the order in which they are tried."""
    found = [
        Case(f"{room}/{path.name}", mutant)
        for room in rooms
        for path in sorted((ROOT / "python" / "g12" / room).glob("*.py"))
        for mutant in mutants_of(path.read_text())
    ]
    random.Random(SEED).shuffle(found)
    return found


def equivalent():
    """Return the mutants that a reader found to behave the same, each with the reason."""
    table = tomllib.loads(Path(__file__).with_name("equivalent_mutants.toml").read_text())
    return {f"{module} {name}": reason for module in table for name, reason in table[module].items()}


def tests_of(module):
    """Return the test files of a module, those without LinuxCNC and the others."""
    room, name = module.removesuffix(".py").split("/")
    unit, interp = UNIT[room], INTERP[room]
    first = [test for test in unit if test.endswith(name)]
    own = [test for test in interp if test == name] or interp
    return (
        [f"tests/unit/test_{test}.py" for test in (*first, *(t for t in unit if t not in first))],
        [f"tests/interp/test_{test}.py" for test in own],
    )


class Bench:
    """A copy of the package in which one mutant after the other is tried."""

    def __init__(self, folder):
        self.folder = Path(tempfile.mkdtemp(dir=folder))
        for part in PARTS:
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
            copy(ROOT / part, self.folder / part)

    def noticed(self, case, *, interp):
        """Return in which tests a mutant is noticed: "unit", "interp", "" if nowhere."""
        path = self.folder / "python" / "g12" / case.module
        source = (ROOT / "python" / "g12" / case.module).read_text()
        path.write_text(mutated(source, case.mutant))
        try:
            for kind, tests in zip(("unit", "interp"), tests_of(case.module)):
                tests = [test for test in tests if (self.folder / test).exists()]
                if (kind == "unit" or interp) and not _pass(self.folder, tests):
                    return kind
            return ""
        finally:
            path.write_text(source)


def _pass(folder, tests):
    """Return whether tests pass in a copy, in a process of their own."""
    child = os.fork()
    if child == 0:
        _run(folder, tests)
    deadline = time.monotonic() + SECONDS
    while time.monotonic() < deadline:
        if os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            break
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    return os.waitpid(child, 0)[1] == 0


def _run(folder, tests):
    import pytest

    os.setsid()
    os.chdir(folder)
    os.environ["PYTHONPATH"] = os.pathsep.join(
        filter(None, (str(folder / "python"), os.environ.get("PYTHONPATH")))
    )
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    code = 1
    try:
        code = pytest.main(["-x", "-q", "--rootdir", str(folder), *tests])
    finally:
        os._exit(code)


def _begin(folder):
    global _bench
    _bench = Bench(folder)


def _judge(job):
    case, interp = job
    return case, _bench.noticed(case, interp=interp)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--skip", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rooms", nargs="+", default=ROOMS, choices=ROOMS)
    parser.add_argument("--module")
    parser.add_argument("--unit-only", action="store_true")
    options = parser.parse_args()
    import hypothesis  # noqa: F401  loaded once, for all mutants
    import numpy  # noqa: F401
    import pytest  # noqa: F401
    import shapely  # noqa: F401

    known = equivalent()
    chosen = [c for c in cases(options.rooms) if options.module in (None, c.module)]
    chosen = chosen[options.skip : options.skip + options.count]
    tried = [case for case in chosen if case.name not in known]
    found = {"unit": 0, "interp": 0, "": 0}
    fork = multiprocessing.get_context("fork")
    with (
        tempfile.TemporaryDirectory(prefix="g12-mutants-") as folder,
        fork.Pool(options.jobs, _begin, (folder,)) as pool,
    ):
        jobs = [(case, not options.unit_only) for case in tried]
        for case, where in pool.imap_unordered(_judge, jobs):
            found[where] += 1
            if not where:
                print(f"survived: {case.mutant.line}: {case.name}", flush=True)
    print(json.dumps({**found, "equivalent": len(chosen) - len(tried)}))


if __name__ == "__main__":
    main()
