# SPDX-License-Identifier: GPL-2.0-or-later
"""install, an update and uninstall, killed at system calls; `make soak` tries more of them."""

import random
import shutil

import pytest

from support.killed_installs import KilledInstalls
from support.kinematics import needs_kinematics

CASES = [
    ("haas", "update", []),
    ("polar-kinematics", "install", [needs_kinematics]),
    ("spindle-c", "uninstall", []),
]


@pytest.mark.skipif(not shutil.which("strace"), reason="strace is not installed")
@pytest.mark.parametrize(
    ("feature", "command"),
    [
        pytest.param(*case, marks=[*marks, pytest.mark.xdist_group(f"kills of {case}")])
        for *case, marks in CASES
    ],
)
def test_the_config_loads_and_a_second_run_completes_it(tmp_path, feature, command):
    killed = KilledInstalls(tmp_path, feature, command)
    for point in killed.sample(random.Random(command), 7):
        killed.kill(point)
