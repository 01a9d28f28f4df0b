# SPDX-License-Identifier: GPL-2.0-or-later
"""Hostile files of all kinds: every command answers each with a sentence, never a fault."""

import random

import pytest

from soak import LANES, SEED, tries
from support.hostile_files import Shop, check_answer, kinds

KINDS = kinds()


@pytest.mark.parametrize("lane", LANES)
def test_soak_hostile(lane, tmp_path, capfd, request):
    chance, shop = random.Random(f"{SEED} {lane}"), Shop(tmp_path)
    for number in tries(request, "hostile files given to commands"):
        kind = chance.choice(KINDS)
        check_answer(capfd, f"{number} of {SEED} {lane}", *shop.attack(kind, chance))
