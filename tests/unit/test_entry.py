# SPDX-License-Identifier: GPL-2.0-or-later
"""The helix of a plunge of too many turns, and what its refusal advises."""

import re

import pytest

from g12.cycles.plan import pocket_descent
from g12.errors import Refusal
from g12.request import Words
from g12.settings import Settings
from support.planner_context import MM

HELIX = Settings(entry="helix", entry_angle=3.0)


def down(first, *heights, cutter=5.0):
    pocket_descent(Words("G13", {}, MM), HELIX, first, cutter, heights)


@pytest.mark.parametrize(
    ("cutter", "height", "further", "advice"),
    [
        (5.0, 100.0, 1.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (0.0, 100.0, 1.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),  # D0 has no size
        (5.0, 2000.0, 1e9, r"([\d.]+) down fits at most, or \[G12\] ENTRY = plunge"),
    ],
)
def test_the_advice_of_a_refused_helix_holds(cutter, height, further, advice):
    """Of a thousand turns, to the first level alone."""
    with pytest.raises(Refusal) as refused:
        down(0.01, height, further, cutter=cutter)
    advised = float(re.search(f"the most is 1000: {advice}$", refused.value.message)[1])
    wide = advice.startswith("I")
    fits = (advised - cutter + 1e-4, height) if wide else (100.0, advised - 1e-2)
    fails = (advised - cutter - 0.005, height) if wide else (100.0, advised * 1.005)
    down(*fits, further, cutter=cutter)
    with pytest.raises(Refusal):
        down(*fails, further, cutter=cutter)
