# SPDX-License-Identifier: GPL-2.0-or-later
"""`regress` is killed; a second run completes what it began."""

import random
import shutil
import subprocess
import time

from g12.tools.regress.recording_text import read_recording
from g12.tools.system import PYTHON
from soak import SEED, tries
from support.sim_machines import PROGRAMS, ROOT, SIM

COMMAND = [PYTHON, ROOT / "python" / "g12"]


def g12(*words, **options):
    return subprocess.run([*COMMAND, *words], capture_output=True, text=True, **options)


def killed(after, *words, **options):
    """Start a command and kill it so many seconds later."""
    process = subprocess.Popen([*COMMAND, *words], stdout=-3, stderr=-3, **options)
    time.sleep(after)
    process.kill()
    process.wait()


def seconds_of(*words, **options):
    """Return how long a command takes that goes well."""
    started = time.monotonic()
    assert g12(*words, **options).returncode == 0
    return time.monotonic() - started


def test_recordings(tmp_path):
    chance = random.Random(SEED)
    shutil.copytree(PROGRAMS / "haas", tmp_path / "nc", ignore=shutil.ignore_patterns("regress"))
    words = ("regress", "record", "nc", "--ini", SIM / "mill_inch.ini", "-d", "kept")
    lasts = seconds_of(*words, cwd=tmp_path)
    for number in tries("kill -9 of regress record, mended by it"):
        seed = f"kill {number} of seed {SEED}"
        if number % 2:
            shutil.rmtree(tmp_path / "kept", ignore_errors=True)
        killed(chance.uniform(0, lasts), *words, cwd=tmp_path)
        for recording in (tmp_path / "kept").glob("*.trace"):
            read_recording(recording.read_text(encoding="utf-8"))
        mended = g12(*words, cwd=tmp_path)
        assert mended.returncode == 0, f"{seed}: {mended.stderr}"
        assert g12("regress", "check", "-d", "kept", cwd=tmp_path).returncode == 0, seed
