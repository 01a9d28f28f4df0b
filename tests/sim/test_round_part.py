# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A in a headless LinuxCNC: real motion of random contours."""

import random

import pytest

from support.operated_machine import kept_machine
from support.valid_programs import valid_program

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add

mill = kept_machine("mill_a_mm", tools={1: 5.0, 2: 3.0, 3: 6.0, 4: 10.0, 5: 12.0, 10: 20.0})


def test_random_contours_are_cut_at_the_programmed_feed(mill):
    mill.reset()
    proof = mill.proof_of_run(valid_program("cylinder a", random.Random(4), 2))
    assert proof.findings == [] and len(proof.sections) == 2
    for section in proof.sections:
        assert section.deviation <= LIMIT
        assert section.values["seconds"] == pytest.approx(
            section.values["seconds_programmed"], rel=0.1
        )
    assert abs(proof.program.samples.axes["Y"]).max() == 0.0
