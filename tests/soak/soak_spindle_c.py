# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle that becomes C is interrupted at random moments; the next program runs."""

import random

from soak import SEED, tries
from support.spindle_lathe import INTERRUPTS, SPINDLE_LATHE, SpindleLathe, interrupted


def test_interrupts():
    chance = random.Random(SEED)
    with SpindleLathe(SPINDLE_LATHE) as lathe:
        for _ in tries("spindle and C, interrupted, and the next program"):
            interrupted(lathe, chance.choice(INTERRUPTS), chance)
