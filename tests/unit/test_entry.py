# SPDX-License-Identifier: GPL-2.0-or-later
"""The helix of a plunge of too many turns, and what its refusal advises."""

import math
import re

import pytest

from g12.cycles.plan import PocketEntry, pocket_descent
from g12.errors import Refusal
from g12.request import Words
from support.planner_context import MM

HELIX = PocketEntry(helix=True, angle=3.0)


def down(first, *heights, cutter=5.0):
    pocket_descent(Words("G13", {}, MM), HELIX, first, cutter, heights)


def test_a_helix_of_a_thousand_turns_is_refused_by_the_first_level_alone():
    each = math.pi * 0.01 * math.tan(math.radians(3.0))
    down(0.01, 1990 * each, 9999 * each)
    with pytest.raises(Refusal, match=r"0\.01 needs 1004 turns for .*, the most is 1000: "):
        down(0.01, 2010 * each, each)


@pytest.mark.parametrize(
    ("cutter", "height", "advice"),
    [
        (5.0, 100.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (0.0, 100.0, r"I from ([\d.]+) fits, or \[G12\] ENTRY = plunge"),
        (5.0, 2000.0, r"([\d.]+) down fits at most, or \[G12\] ENTRY = plunge"),
    ],
)
def test_the_advice_of_a_refused_helix_holds(cutter, height, advice):
    """With D0 no size of the cutter limits the helix."""
    with pytest.raises(Refusal) as refused:
        down(0.01, height, 1.0, cutter=cutter)
    advised = float(re.search(f"{advice}$", refused.value.message)[1])
    wide = advice.startswith("I")
    fits = (advised - cutter + 1e-4, height) if wide else (100.0, advised - 1e-2)
    fails = (advised - cutter - 0.005, height) if wide else (100.0, advised * 1.005)
    down(*fits, 1.0, cutter=cutter)
    with pytest.raises(Refusal):
        down(*fails, 1.0, cutter=cutter)
