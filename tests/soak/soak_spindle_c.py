# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle that becomes C is interrupted at random moments; the next program runs."""

import random

import pytest

from soak import SEED, tries
from support.spindle_lathe import INTERRUPTS, SPINDLE_LATHE, SpindleLathe, interrupted


@pytest.mark.parametrize("interrupt", INTERRUPTS)
def test_interrupts(interrupt, request):
    chance = random.Random(f"{interrupt} {SEED}")
    with SpindleLathe(SPINDLE_LATHE) as lathe:
        for _ in tries(request, f"spindle and C, {interrupt}, and the next program"):
            interrupted(lathe, interrupt, chance)
