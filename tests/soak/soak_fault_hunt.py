# SPDX-License-Identifier: GPL-2.0-or-later
"""verify finds faults that nobody chose, of those that change the motion: see `fault_hunt`."""

import json
import os
import subprocess

from g12.tools.system import PYTHON
from soak import SEED, often
from soak.fault_hunt import CRASHED, FOUND, MISSED, faults, right
from support.sim_machines import ROOT, with_package

FAULTS = 80  # in ten minutes
SHARE = 0.9  # some of the others move as rightly as before, and nobody has read them yet


def test_more_than_90_of_100_faults_that_change_the_motion_are_found():
    paths = (str(ROOT / "tests"), os.environ.get("PYTHONPATH"))
    environment = with_package({**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))})
    count = ("--count", str(often(FAULTS)), "--seed", str(SEED))
    command = [PYTHON, "-m", "soak.fault_hunt", *count]
    run = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True)
    rooms = json.loads(run.stdout).values()
    found, missed, crashed = (
        sum(room.get(verdict, 0) for room in rooms) for verdict in (FOUND, MISSED, CRASHED)
    )
    assert not crashed
    assert found > SHARE * (found + missed), rooms


def test_every_fault_whose_motion_is_called_right_is_one_of_today():
    assert set(right()) <= {fault.name for fault in faults()}
