# SPDX-License-Identifier: GPL-2.0-or-later
"""Files with random damage, a few of each kind: `make soak` gives the commands two thousand."""

import random

import pytest

from support.hostile_files import Shop, check_answer, kinds


@pytest.fixture(scope="module")
def shop(tmp_path_factory):
    return Shop(tmp_path_factory.mktemp("shop"))


@pytest.mark.parametrize("kind", [kind for kind in kinds() if kind != "run"])
def test_a_damaged_file_is_answered_with_a_sentence(kind, shop, capfd):
    chance = random.Random(kind)
    for number in range(4):
        check_answer(capfd, number, *shop.attack(kind, chance))
