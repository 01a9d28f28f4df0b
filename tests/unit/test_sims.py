# SPDX-License-Identifier: GPL-2.0-or-later
"""The simulated machines of configs/sim are those of the table in .ci/sims.py."""

import runpy

from support.sim_machines import ROOT

SIM = ROOT / "configs" / "sim"
TABLE = runpy.run_path(str(ROOT / ".ci" / "sims.py"))


def test_the_inis_are_up_to_date():
    written = {path.name: path.read_text(encoding="utf-8") for path in SIM.glob("*.ini")}
    assert written == dict(TABLE["texts"]())
