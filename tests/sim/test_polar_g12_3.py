# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.3 and G13.3, the pair for a LinuxCNC that has a G12.1 of its own, in real motion."""

import pytest

from g12.tools.install.config.features import INCLUDES
from support.contour_geometry import deviation
from support.kinematics import marked
from support.operated_machine import Machine
from support.polar_drawings import MILLIMETRES
from support.polar_programs import Cut
from support.sim_machines import PROGRAMS, SIM

LATHES = [SIM / f"{name}.ini" for name in ("lathe_mm", "lathe_mm_kinematics")]
HEXAGON = "hexagon"


def other_pair():
    """Return the REMAP lines that `polar_g12_3.inc` brings."""
    lines = (INCLUDES / "polar_g12_3.inc").read_text().splitlines()
    return [line.partition("=")[2].strip() for line in lines if line.startswith("REMAP")]


@pytest.mark.parametrize("ini", marked(LATHES))
def test_the_other_pair_cuts_the_same(ini):
    text = (PROGRAMS / "polar" / f"{HEXAGON}.ngc").read_text()
    text = text.replace("G12.1", "G12.3").replace("G13.1", "G13.3")
    with Machine(ini, overrides={"RS274NGC": {"REMAP": other_pair()}}) as machine:
        run = machine.run_text(text.splitlines())
    assert run.error is None
    assert max(deviation(MILLIMETRES[HEXAGON].segments, Cut(run).points, step=0.1)) <= 0.006
