# SPDX-License-Identifier: GPL-2.0-or-later
"""Hostile files of all kinds: every command answers each with a sentence, never a fault."""

import random

from soak import SEED, tries
from support.hostile_files import Shop, check_answer, kinds

KINDS = kinds()


def test_soak_hostile(tmp_path, capfd):
    chance, shop = random.Random(SEED), Shop(tmp_path)
    for number in tries("hostile files given to commands"):
        kind = chance.choice(KINDS)
        check_answer(capfd, f"{number} of {SEED}", *shop.attack(kind, chance))
