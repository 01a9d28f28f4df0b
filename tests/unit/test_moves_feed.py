# SPDX-License-Identifier: GPL-2.0-or-later
"""F words: a segment lasts as long as its path at the feed, and X moves enough or not at all."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.moves.steps import Split, segments_with_feed
from support import planned_moves

LEAST = 0.001


def move(h1=0.0):
    """Return a move at F120; its split is what counts."""
    return planned_moves.line(10.0, 0.0, 0.0, 0.0, h1=h1, feed=120.0)


step = st.sampled_from([0.0, 0.0004, -0.0007, 0.0015, -0.3, 2.0])
turn = st.sampled_from([0.0, 1e-12, 0.01, -3.0, 40.0])
ends = st.lists(st.tuples(step, turn, st.floats(0.01, 5.0)), min_size=1, max_size=8)


@settings(max_examples=150)
@given(ends, st.sampled_from([0.0, -0.002, -4.0]), st.sampled_from([0.0, 90.0]))
def test_all_segments_together_last_as_long_as_the_path(steps, rise, entry):
    """None turns C and moves the slides by less than the least step, and none does nothing."""
    slides, turns, lengths = ([first] for first in (10.0, 0.0, 0.0))
    for by, turned, long in steps:
        slides.append(slides[-1] + by)
        turns.append(turns[-1] + turned)
        lengths.append(lengths[-1] + long)
    split = Split(slides, [math.radians(angle) for angle in turns], lengths)
    start, along = (10.0, entry, -5.0), move(-5.0 + rise)._replace(h0=-5.0)
    made, at = segments_with_feed(split, start, along, entry, LEAST), start
    space, minutes = math.hypot(1.0, rise / lengths[-1]) / 120.0, 0.0
    for segment in made:
        slid, turned = math.hypot(segment[0] - at[0], segment[2] - at[2]), abs(segment[1] - at[1])
        assert slid or turned
        assert not turned or not slid or slid > 0.999 * LEAST
        minutes += (slid or turned) / segment[3]
        assert min(abs(minutes - length * space) for length in lengths) < 1e-9
        done = lengths[min(range(len(lengths)), key=lambda k: abs(minutes - lengths[k] * space))]
        assert abs(segment[2] - (-5.0 + rise * done / lengths[-1])) <= LEAST + 1e-9
        at = segment
    if made:
        assert at[0] == pytest.approx(slides[-1], abs=LEAST)
        assert at[1] == pytest.approx(entry + turns[-1], abs=1e-9)
