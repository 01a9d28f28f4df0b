# SPDX-License-Identifier: GPL-2.0-or-later
"""Curves found by their boxes, against a look at each of them."""

import math

import numpy as np
import pytest

from g12.geometry.curve import Arc, BoxTree, Line, apart


def some(count):
    """Return lines and arcs anywhere, and what draws more."""
    rng = np.random.default_rng(count)
    curves = []
    for k in range(count):
        start, to = (complex(*rng.uniform(-20, 20, 2)) for _ in range(2))
        curves.append(Arc(start, start + 0.2 * to, 2.0) if k % 3 else Line(start, to))
    return curves, rng


@pytest.mark.parametrize("count", [1, 4, 5, 60])
@pytest.mark.parametrize("reach", [math.inf, 12.0])
def test_the_nearest_curve_that_counts_is_found_among_many(count, reach):
    curves, rng = some(count)
    tree, found = BoxTree(curves), 0
    for point in (complex(*xy) for xy in rng.uniform(-40, 40, (100, 2))):
        away = [curve.distance(point) for curve in curves[::2]]
        nearest = min(*away, reach)
        far, index = tree.nearest(point, reach, lambda k: k % 2 == 0)
        assert far == pytest.approx(nearest)
        assert index == (2 * away.index(nearest) if nearest < reach else None)
        found += index is not None
    assert found > 10


@pytest.mark.parametrize("count", [1, 60])
def test_the_curves_near_to_a_box_are_found(count):
    curves, rng = some(count)
    tree = BoxTree(curves)
    assert all(apart(curve.box, tree.box, -1e-9) is False for curve in curves)
    for x, y in rng.uniform(-30, 30, (50, 2)):
        box = (x, y, x + 3, y + 1)
        expected = [k for k, curve in enumerate(curves) if not apart(curve.box, box, 2.0)]
        assert sorted(tree.near(box, 2.0)) == expected
