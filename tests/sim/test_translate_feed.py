# SPDX-License-Identifier: GPL-2.0-or-later
"""C beside a slide at a feed, on a running lathe: the time of the real motion is the control's."""

import numpy as np
import pytest

from g12.tools.translate.blocks.control import read_control
from g12.tools.translate.program import translate_program
from support.operated_machine import kept_machine

HEAD = "G21 G98 G54\nG0 X50. Z5. C0\nG1 Z4. F4000.\n"
LAST_OF_HEAD = 4  # the line, with that of what holds at the start
FEED = 3600  # mm and degrees a minute
TURNS = [  # the blocks, and the path in mm and degrees
    ("X40. C360. F3600.", np.hypot(5, 360)),
    # as CAM writes it: X within a thousandth or two, which LinuxCNC alone ran three times too fast
    ("F3600.\n" + "".join(f"X{50 + 0.001 * (n % 3):.3f} C{30 * n}.\n" for n in range(1, 13)), 360),
]


machine = kept_machine("lathe_mm")


@pytest.mark.parametrize(("blocks", "path"), TURNS, ids=("one", "twelve"))
def test_a_turn_takes_the_time_that_the_control_takes(machine, blocks, path):
    translated = translate_program(f"{HEAD}{blocks}\nM30\n", read_control("fanuc-lathe"))
    assert translated.refused == []
    run = machine.run_text(translated.text)
    assert run.error is None
    angles, seconds = run.samples.axes["C"], run.samples.time
    turning = seconds[(angles > 0.01) & (angles < 359.99) & (run.samples.line > LAST_OF_HEAD)]
    ideal = path / FEED * 60
    assert 0.98 * ideal < turning[-1] - turning[0] < 1.02 * ideal
