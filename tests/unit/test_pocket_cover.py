# SPDX-License-Identifier: GPL-2.0-or-later
"""What distances alone tell of a pocket is what areas tell."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.path.part import disc, swept
from g12.tools.verify.pocket_cover import clears

CUTTER = 3.0


def around(first, last, turns=1.0, beside=0.0):
    """Return a circle, or a spiral, about a centre that lies beside the pocket's."""
    angles = np.linspace(0.0, 2 * math.pi * turns, int(3000 * turns) + 1)
    radius = np.linspace(first, last, len(angles))
    points = [radius * np.cos(angles) + beside, radius * np.sin(angles), 0 * angles]
    return np.stack(points, axis=1)


def left_between(lines, inner, outer):
    wanted = disc((0, 0), outer, 1e-5).difference(disc((0, 0), inner, 1e-5))
    return wanted.difference(swept(lines, CUTTER)).area


RADII = st.floats(0.5, 30.0)


@settings(max_examples=25, deadline=None)
@given(
    circles=st.lists(st.tuples(RADII, st.just(0.0) | st.floats(-3.0, 3.0)), min_size=1, max_size=6),
    spiral=st.none() | st.tuples(RADII, RADII, st.sampled_from([0.5, 1.0, 2.5, 4.0])),
    wanted=st.tuples(st.just(0.0) | RADII, st.floats(0.1, 25.0)),
)
def test_what_is_surely_cleared_leaves_nothing(circles, spiral, wanted):
    lines = [around(radius, radius, beside=beside) for radius, beside in circles]
    lines += [around(*spiral)] if spiral else []
    inner, outer = wanted[0], wanted[0] + wanted[1]
    if clears(lines, CUTTER, (inner, outer)):
        assert left_between(lines, inner, outer) < 0.01


@pytest.mark.parametrize(
    ("lines", "wanted", "surely"),
    [
        ([around(2, 2), around(7, 7), around(12, 12)], (0, 14.99), True),
        ([around(2, 2), around(8.5, 8.5), around(12, 12)], (0, 14.99), False),
        ([around(2, 2), around(2, 17, 3), around(17, 17)], (0, 19.99), True),
        ([around(2, 2), around(2, 23, 3), around(23, 23)], (0, 25.99), False),
        ([around(2, 2), around(2, 17, 3)], (0, 19.99), False),
        ([around(2, 18, 2.5), around(18, 18)], (5, 20.99), False),
        ([around(17, 17)], (14.01, 19.99), True),
        ([around(17, 17, 0.99)], (14.01, 19.99), False),
        ([around(17, 17, beside=0.1)], (14.01, 19.99), False),
        ([], (1, 2), False),
    ],
)
def test_it_is_sure_of_rings_and_spirals(lines, wanted, surely):
    assert clears(lines, CUTTER, wanted) is surely
