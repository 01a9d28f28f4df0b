# SPDX-License-Identifier: GPL-2.0-or-later
"""The count of steps by itself: enough of them, none too long, no sliver."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.common import COUNTLESS, steps_between

TOLERANCE = 1e-6


@pytest.mark.parametrize(
    ("first", "last", "step", "count"),
    [
        (0.0, 1.0, 0.25, 4),
        (0.0, 1.0, 0.3, 4),
        (0.0, 1.0, 2.0, 1),
        (0.1, 0.7, 0.1, 6),
        (1 / 3, 1.0, 1 / 3, 2),
        (1.0, 1.0, 0.5, 0),
        (2.0, 1.0, 0.5, 0),
        (0.0, 1.0 + 0.9e-6, 0.25, 4),
        (0.0, 1.0 + 1.1e-6, 0.25, 5),
        (0.0, 0.9e-6, 0.25, 0),
    ],
)
def test_the_count_of_steps(first, last, step, count):
    assert steps_between(first, last, step, TOLERANCE) == count


def test_a_quotient_beyond_all_counting_is_still_a_count():
    assert steps_between(0.0, 1e6, 1e-300, TOLERANCE) == COUNTLESS
    assert steps_between(0.0, 1e6, 1e-310, TOLERANCE) == COUNTLESS


@given(first=st.floats(0, 50), way=st.floats(0.01, 50), step=st.floats(0.001, 50))
def test_the_steps_are_enough_and_one_less_would_not_be(first, way, step):
    count = steps_between(first, first + way, step, TOLERANCE)
    assert count * step >= way - 2 * TOLERANCE
    assert (count - 1) * step < way
