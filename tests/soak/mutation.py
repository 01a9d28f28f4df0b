# SPDX-License-Identifier: GPL-2.0-or-later
"""Mutants of the planners against their tests: which ones nobody notices.

    PYTHONPATH=tests /usr/bin/python3 -m soak.mutation --count 200 --jobs 2 2>survivors
    PYTHONPATH=tests /usr/bin/python3 -m soak.mutation --again survivors

Each mutant is put alone into a copy of the package. The tests of its module run first, then, if it
has survived, programs on the interpreter. Running for ever or taking too much memory counts as
noticed: the test did not pass. The sample is shuffled once: a longer run tries the same and more.
"""

import argparse
import contextlib
import functools
import json
import multiprocessing
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import tomllib
from pathlib import Path
from typing import NamedTuple

from soak.mutants import Mutant, mutants_of, mutated

ROOT = Path(__file__).resolve().parents[2]
SEED = 12
ROOMS = ("request", "cycles", "shapes", "section", "compensation", "moves")
ROOMS += ("polar", "cylinder")
PARTS = ("python", "tests", "ngc", "configs", "pyproject.toml")
CYCLES = (
    *("words", "cycles_common", "cycles_travel", "entry"),
    *("haas", "yasnac", "mitsubishi", "circle_mill"),
)
SECTION = (
    *("section_block_rules", "section_codes", "section_line", "section_output"),
    *("polar_start", "cylinder"),
)
COMPENSATION = (
    *(
        "compensation_contour",
        "compensation_intersect",
        "compensation_nearby",
        "compensation_gouge",
        "compensation_between",
        "compensation_simplify",
    ),
    "compensation_offset",
)
MOVES = ("moves_exact_stops", "moves_feed", "moves_soft_limits", "moves_spacing")
POLAR = (
    *("polar_start", "polar_pole", "polar_pieces", "polar_beside", "polar_face", "polar_follow"),
    *("polar_quickest", "polar_plan"),
)
UNIT = {
    "request": CYCLES,
    "cycles": CYCLES,
    "shapes": ("shapes",),
    "section": SECTION,
    "compensation": (*COMPENSATION, "polar_plan"),
    "moves": (*MOVES, *POLAR, "cylinder"),
    "polar": (*MOVES, *POLAR, "section_line", "section_block_rules"),
    "cylinder": ("cylinder", *MOVES),
}
SECTIONS = ("polar_words", "polar_refusals", "polar_reading")
INTERP = {
    "request": ("haas", "yasnac", "mitsubishi", "circle_mill"),
    "cycles": ("haas", "haas_entry", "yasnac", "mitsubishi", "circle_mill"),
    "shapes": ("shapes",),
    "section": SECTIONS,
    "compensation": (*SECTIONS, "verify_programs"),
    "moves": (*SECTIONS, "cylinder"),
    "polar": (*SECTIONS, "tool_offset", "verify_programs"),
    "cylinder": ("cylinder",),
}
CPU_SECONDS = 180  # of one process; the tests of a room take less than half of it
SECONDS = 1800
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
    return {
        f"{module} {name}": reason
        for module, names in table.items()
        for name, reason in names.items()
    }


def tests_of(module):
    """Return the test files of a module, those without LinuxCNC and the others."""
    room, name = module.removesuffix(".py").split("/")
    unit, interp = UNIT[room], INTERP[room]
    first = [test for test in unit if test.endswith(name)]
    own = [test for test in interp if name in test] or interp
    return (
        [f"tests/unit/test_{test}.py" for test in (*first, *(t for t in unit if t not in first))],
        [f"tests/interp/test_{test}.py" for test in own],
    )


class Bench:
    """A copy of the package in which one mutant after the other is tried."""

    def __init__(self, folder):
        self.folder = Path(tempfile.mkdtemp(dir=folder))
        self._sound = set()
        for part in PARTS:
            copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy2
            copy(ROOT / part, self.folder / part)

    def noticed(self, case, *, interp):
        """Return in which tests a mutant is noticed: "unit", "interp", "" if nowhere."""
        path = self.folder / "python" / "g12" / case.module
        source = path.read_text()
        for kind, tests in zip(("unit", "interp"), tests_of(case.module)):
            if kind == "interp" and not interp:
                return ""
            self._check(tests)
            path.write_text(mutated(source, case.mutant))
            try:
                if not self._pass(tests):
                    return kind
            finally:
                path.write_text(source)
        return ""

    def _check(self, tests):
        """Raise if tests do not pass without a mutant, once for each list of them."""
        if tuple(tests) not in self._sound and not self._pass(tests):
            raise RuntimeError(f"fail without any mutant: {' '.join(tests)}")
        self._sound.add(tuple(tests))

    def _pass(self, tests):
        """Return whether tests pass in the copy, in a process of their own."""
        child = os.fork()
        if child == 0:
            _run(self.folder, tests)
        end = time.monotonic() + SECONDS
        while not os.waitid(os.P_PID, child, os.WEXITED | os.WNOHANG | os.WNOWAIT):
            if time.monotonic() > end:
                break
            time.sleep(0.02)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)
        return os.waitpid(child, 0)[1] == 0


class Unreduced:
    """A plugin of pytest: a failure is enough, hypothesis looks for no smaller one."""

    def pytest_configure(self):
        from hypothesis import Phase, settings

        phases = [Phase.explicit, Phase.generate]
        settings.register_profile("unreduced", settings.get_profile("g12"), phases=phases)
        settings.load_profile("unreduced")


def _run(folder, tests):
    """Run tests in this process, quietly and within bounds, and end it."""
    import pytest

    code = 1
    try:
        os.setsid()
        os.chdir(folder)
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
        resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        code = pytest.main(["-x", "--rootdir", str(folder), *tests], plugins=[Unreduced()])
    finally:
        os._exit(code)


def _begin(folder):
    global _bench
    _bench = Bench(folder)


def _judge(job):
    case, interp = job
    return case, _bench.noticed(case, interp=interp)


def run(chosen, *, jobs=1, interp=True, tell=print):
    """Try mutants; return how many are noticed in which tests, and the names of the others."""
    import hypothesis  # noqa: F401  loaded once, for all mutants
    import numpy  # noqa: F401
    import pytest  # noqa: F401
    import shapely  # noqa: F401

    known = equivalent()
    tried = [case for case in chosen if case.name not in known]
    found = {"equivalent": len(chosen) - len(tried), "unit": 0, "interp": 0, "survived": []}
    fork = multiprocessing.get_context("fork")
    with (
        tempfile.TemporaryDirectory(prefix="g12-mutants-") as folder,
        fork.Pool(jobs, _begin, (folder,)) as pool,
    ):
        for case, where in pool.imap_unordered(_judge, [(case, interp) for case in tried]):
            if where:
                found[where] += 1
            else:
                found["survived"].append(case.name)
                tell(f"line {case.mutant.line}: {case.name}")
    return found


def main():
    """Print the mutants that survive, and how many there were."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--count", type=int, help="so many of the sample, from its start")
    parser.add_argument("--rooms", nargs="+", default=ROOMS, choices=ROOMS)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--unit", action="store_true", help="without LinuxCNC")
    parser.add_argument("--again", type=Path, help="those alone that this file names")
    options = parser.parse_args()
    chosen = cases(options.rooms)
    if options.again:
        text = options.again.read_text()
        chosen = [case for case in chosen if f": {case.name}\n" in text]
    tell = functools.partial(print, file=sys.stderr, flush=True)
    found = run(chosen[: options.count], jobs=options.jobs, interp=not options.unit, tell=tell)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
