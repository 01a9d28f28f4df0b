# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of a block by themselves: whole numbers, pairs, limits, what is left over."""

import pytest

from g12.errors import Refusal
from g12.lengths import LARGEST
from g12.request.words import Words


def words(**values):
    return Words("G12", values)


def refusal(function, *arguments, **options):
    """Return the message of a refused call."""
    with pytest.raises(Refusal) as refused:
        function(*arguments, **options)
    return refused.value.message


@pytest.mark.parametrize("value", [1.00009, 0.99991])
def test_what_linuxcnc_takes_for_a_whole_number_is_one(value):
    assert words(L=value).take_whole("L", least=1) == 1


@pytest.mark.parametrize(("letter", "value"), [("L", 1.001), ("D", 0.9989)])
def test_what_is_not_whole_is_refused(letter, value):
    message = f"G12: {letter}{value} must be a whole number"
    assert refusal(words(**{letter: value}).take_whole, letter, least=0) == message


def test_a_whole_number_keeps_its_limits():
    assert refusal(words(D=-1.0).take_whole, "D", least=0) == "G12: D-1 must be at least 0"
    assert refusal(words(D=4.0).take_whole, "D", least=0, most=3) == "G12: D4 must be at most 3"
    assert words(D=3.0).take_whole("D", least=3, most=3) == 3
    assert words().take_whole("D", least=1, default=7) == 7


@pytest.mark.parametrize("value", [1.001e6, float("nan")])
def test_a_number_beyond_any_machine_is_refused_at_once(value):
    assert refusal(words, X=value).endswith("is beyond 1000000")
    assert words(X=LARGEST, Y=-LARGEST).take("Y") == -LARGEST
