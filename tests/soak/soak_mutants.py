# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners' tests notice their mutants: see `mutation`."""

import json
import os
import subprocess

from g12.tools.system import PYTHON
from soak import often
from soak.mutation import cases, equivalent
from support.sim_machines import ROOT

SCORE = 0.98


def test_more_than_98_of_100_mutants_are_noticed():
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tests")}
    command = [PYTHON, "-m", "soak.mutation", "--count", str(often(200))]
    run = subprocess.run(command, env=environment, stdout=subprocess.PIPE, check=True)
    found = json.loads(run.stdout)
    noticed = found["unit"] + found["interp"]
    assert noticed > SCORE * (noticed + len(found["survived"])), found


def test_every_mutant_that_is_called_equivalent_is_one_of_today():
    assert set(equivalent()) <= {case.name for case in cases()}
