# SPDX-License-Identifier: GPL-2.0-or-later
"""Random valid programs of every cycle, shape and section: verify has no finding in them.

What verify detects is proved by test_verify_codes.py; here it is the judge of the motion that
LinuxCNC makes of the words. `make soak` tries the same kinds with other seeds.
"""

import random

import pytest

from support.judged_programs import prove
from support.valid_programs import MACHINES, machine_of, valid_program

POCKETS, SECTIONS, SHAPES = 24, 6, 4  # in a program; a shape takes verify a second


def count_of(kind):
    """Return how many pockets, sections or shapes a program of a kind gets."""
    if kind.startswith("shapes"):
        return SHAPES
    return SECTIONS if kind.startswith(("polar", "cylinder")) else POCKETS


def check_as_its_words_ask(program, kind, seed, count):
    """Write a random program of so many pockets, sections or shapes, and let verify judge it."""
    program.write_text(valid_program(kind, random.Random(seed), count))
    proof = prove(program, machine_of(kind))
    assert len(proof.program.cuts) >= count, seed
    assert [each.text() for each in proof.judgement.found if each.severity == "finding"] == [], seed


@pytest.mark.parametrize("kind", MACHINES)
def test_a_valid_program_is_cut_as_its_words_ask(kind, tmp_path):
    check_as_its_words_ask(tmp_path / "valid.ngc", kind, kind, count_of(kind))
