# SPDX-License-Identifier: GPL-2.0-or-later
"""Run the tests of the soak again and again, each time with other seeds, until the time is over.

These are `soak_*.py`, and the properties among the normal tests. Each run is a process of its own,
which is killed when the time is over.
"""

import itertools
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from soak import SEED
from support.sim_machines import ROOT

ENDING = 5.0  # s, to kill what runs and to report
END = time.monotonic() + 60 * float(os.environ["SOAK_MINUTES"]) - ENDING
WORKERS = 3 * os.cpu_count()  # many wait for real motion
PYTEST = [sys.executable, "-m", "pytest"]
FILES = (
    "soak/soak_*.py", "interp/test_cycles.py", "interp/test_bore_thread_frame.py",
    "unit/test_cylinder.py", "unit/test_polar_plan.py", "unit/test_compensation_offset.py",
    "unit/test_compensation_simplify.py",
)  # fmt: skip
PROPERTIES = "any or keeps or soak_ or short_moves"


def main():
    """Return 1 if a test has failed."""
    names, numbers = collected(), itertools.count()
    random.Random(SEED).shuffle(names)
    failed = []

    def work(_):
        while time.monotonic() < END:
            number = next(numbers)
            said = run(names[number % len(names)], SEED + number // len(names), folder, len(names))
            if said:
                failed.append(said)
                print(said, flush=True)

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        with ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(work, range(WORKERS)))
        tried = Path(folder, "tried")
        held = Counter(tried.read_text(encoding="utf-8").splitlines() if tried.exists() else ())
    for what, number in sorted(held.items()):
        print(f"{number:8,} {what}")
    print(f"soak: {len(failed)} failed")
    return bool(failed)


def collected():
    """Return the tests to run."""
    files = [str(file) for pattern in FILES for file in sorted((ROOT / "tests").glob(pattern))]
    words = [*PYTEST, "--collect-only", "-k", PROPERTIES, *files]
    listed = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [line for line in listed.splitlines() if "::" in line]


def run(name, seed, folder, count):
    """Run a test until its share of the time, or the time, is over; return what fails in it."""
    left = END - time.monotonic()
    share = {"SOAK_SEED": str(seed), "SOAK_SECONDS": str(left * WORKERS / count / 2)}
    base = tempfile.mkdtemp(dir=folder)
    words = [*PYTEST, name, f"--hypothesis-seed={seed}", f"--basetemp={base}/tests"]
    environment = {**os.environ, **share, "SOAK_TRIED": f"{folder}/tried", "TMPDIR": base}
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    process = subprocess.Popen(words, cwd=ROOT, env=environment, start_new_session=True, **options)
    try:
        said, _ = process.communicate(timeout=max(left, 0))
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()  # not for its output: a machine of its own session may still hold the pipe
        return ""
    if "soak_" not in name and not process.returncode:
        with open(f"{folder}/tried", "a", encoding="utf-8") as file:
            file.write(f"runs of {name.rpartition('::')[2]}\n")
    again = f"repeat it: SOAK_SEED={seed} {' '.join(words[2:5])}"
    return f"{said}\n{again}" if process.returncode else ""


if __name__ == "__main__":
    sys.exit(main())
