# SPDX-License-Identifier: GPL-2.0-or-later
"""Where on the path segments end, measured by small steps."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from g12.polar.segments import Law, split_move
from support.axes_of_places import along, axes_of, bend, places_of, rates
from support.contour_geometry import Round, Straight

INF = math.inf
coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)
sweep = st.floats(0.3, 2 * math.pi).flatmap(lambda turn: st.sampled_from((turn, -turn)))
lines = st.builds(Straight, point, point).filter(lambda line: line.length > 0.5)
arcs = st.builds(Round, point, point, sweep).filter(lambda arc: arc.radius > 0.5)
shapes = lines | arcs
laws = st.builds(
    Law,
    st.sampled_from([1e-5, 0.005, 0.05]),
    st.sampled_from([1e9, 0.01, 0.001]),
    st.sampled_from([INF, 3.0, 0.5]),
    st.sampled_from([INF, 0.3, 0.05]),
)
offsets = st.sampled_from([-8.0, -0.3, 2.0, 9.0])


def clear_of(shape, beside=0.0):
    """Return whether the slide's travel along a shape is a tenth of what it reaches or more."""
    away = abs(along(shape)(np.linspace(-0.1, 1.1, 300) * shape.length))
    return away.min() > abs(beside) * 1.02 + 0.3


def turning_points(shape):
    """Return the lengths at which a shape is nearest to the pole or farthest from it."""
    every = np.linspace(0.0, shape.length, 1001)
    square = abs(along(shape)(every)) ** 2
    left, middle, right = square[:-2], square[1:-1], square[2:]
    bent = left - 2.0 * middle + right
    (at,) = np.nonzero(((left - middle) * (right - middle) >= 0.0) & (abs(bent) > 1e-7))
    return every[at + 1] + 0.5 * every[1] * (left - right)[at] / bent[at]


@settings(max_examples=150)
@given(shapes, laws, st.just(0.0) | offsets)
@example(Straight(0.6 + 5j, -4 + 5j), Law(1e-5, 0.01, 3.0, 3.0), 2.0)
@example(Straight(4 + 5j, -0.6 + 5j), Law(1e-5, 0.01, 3.0, 3.0), 2.0)
def test_ends_of_segments_are_beside_the_path_where_their_lengths_tell(shape, law, beside):
    """Inner ends are off to the side that segments do not bulge to, the ends of the path are on it.

    The angles go on from one to the next as they do along the path. Where X turns round a segment
    ends, unless that is next to an end of the path.
    """
    assume(clear_of(shape, beside))
    law = law._replace(ripple=0.01, x_hold=3.0, c_hold=3.0)
    path = along(shape)
    split = split_move(shape, law, beside)
    slides, angles, lengths = map(np.array, split)
    assert (lengths[0], lengths[-1]) == pytest.approx((0.0, shape.length))
    assert (np.diff(lengths) > 0).all()
    on_path = path(lengths)
    heading = path(lengths + 1e-3) - path(lengths - 1e-3)
    off = (places_of(slides, angles, beside) - on_path) * np.conj(heading / abs(heading))
    assert off[[0, -1]] == pytest.approx(0.0, abs=1e-9)
    assert off.real == pytest.approx(0.0, abs=1e-9)
    shares, side = off.imag[1:-1] / law.deviation, np.sign(bend(path, lengths, beside))
    assert (abs(shares) <= 1.001).all()
    turns = (side[1:-1] != side[:-2]) | (side[1:-1] != side[2:])
    assert (turns | (shares * side[1:-1] > -1e-6)).all()
    every = np.linspace(0.0, shape.length, 500)
    turned = np.interp(lengths, every, axes_of(path(every), beside)[1])
    assert np.diff(angles) == pytest.approx(np.diff(turned), abs=0.5)
    for at in turning_points(shape):
        k = np.searchsorted(lengths, at)
        near = lengths[max(k - 1, 0) : k + 1]
        ends = at / lengths[1], (shape.length - at) / (shape.length - lengths[-2])
        assert abs(near - at).min() < 1e-3 or len(near) < 2 or min(ends) < 2.5  # segments


@settings(max_examples=150)
@given(shapes, laws, st.just(0.0) | offsets)
@example(Straight(24 - 46.4j, 41 - 46.4j), Law(0.005, 1e9, INF, INF), 50.0)
def test_motion_between_the_ends_is_on_the_path_but_for_the_deviation(shape, law, beside):
    """Slide and C move evenly between two ends; the tool is compared with a drawing of the path."""
    assume(clear_of(shape, beside))
    path, split = along(shape), split_move(shape, law, beside)
    slides, angles, lengths = map(np.array, split)
    assume(len(lengths) < 3000)
    share = np.linspace(0.0, 1.0, 15)[:, None]
    made = places_of(
        slides[:-1] + share * np.diff(slides), angles[:-1] + share * np.diff(angles), beside
    )
    at = lengths[:-1] + share * np.diff(lengths)
    for _ in range(3):  # the length at which the path passes each place
        heading = path(at + 1e-3) - path(at - 1e-3)
        at = at + ((made - path(at)) * np.conj(heading / abs(heading))).real
    assert abs(made - path(at)).max() <= 1.05 * law.deviation + 1e-9


def is_whole(line, law):
    """Return whether one segment would do, with both its ends exactly on the path.

    As if the line were all the way as it is where it is nearest to the pole.
    """
    path, every = along(line), np.linspace(0.0, line.length, 401)
    at = every[abs(path(every)).argmin()]
    slide, _, turning = rates(path, at)
    first, last = abs(line.start), abs(line.end)
    growth = abs(last - first) / (first + last)
    off = abs(bend(path, at)) * line.length**2 / 8.0
    return off <= 0.75 * law.deviation and (turning * slide) ** 2 * growth <= law.ripple


@pytest.mark.parametrize("law", [Law(0.005, 1e9, INF, INF), Law(1e9, 0.01, INF, INF)])
@pytest.mark.parametrize("first", [-1.0, -0.04, 0.0, 0.98, 2.5])
@pytest.mark.parametrize("foot", [2.0, -30.0])
def test_a_short_line_is_one_segment_while_that_keeps_the_limits(law, first, foot):
    """It begins as far after the foot of the pole's perpendicular, and back again.

    Short is a tenth of the distance from the pole.
    """
    start = complex(foot, first * abs(foot))
    low, high = 1e-3, 50.0
    while high - low > 1e-4 * low:
        middle = 0.5 * (low + high)
        whole = is_whole(Straight(start, start + 1j * middle), law)
        low, high = (middle, high) if whole else (low, middle)
    for length, whole in ((min(0.97 * low, 0.09 * abs(start)), True), (1.2 * low, False)):
        ends = (start, start + 1j * length)
        for line in (Straight(*ends), Straight(*ends[::-1])):
            assert (len(split_move(line, law).lengths) == 2) is whole


@pytest.mark.parametrize(("away", "whole"), [(0.0024, True), (0.0026, False)])
def test_an_arc_is_one_segment_if_its_radii_differ_by_less_than_the_deviation(away, whole):
    circle = Round(complex(10 + away), complex(away), 2 * math.pi)
    split = split_move(circle, Law(0.005, 1e9, INF, INF))
    assert (len(split.lengths) == 2) is whole
