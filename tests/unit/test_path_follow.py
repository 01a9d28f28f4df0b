# SPDX-License-Identifier: GPL-2.0-or-later
"""Paths in time, and real motion laid on them: made-up samples with known faults."""

import math

import numpy as np
import pytest

from g12.tools.path.follow import follow, windows_of, worst_of
from g12.tools.path.part import Part
from g12.tools.path.track import Track, duration
from support.made_moves import HOME, LIMITS, Hand, samples_of

MILL, FACE = Part(turning=False), Part(turning=True)


@pytest.mark.parametrize(
    ("hand", "seconds"),
    [
        (Hand(feed=600).line(x=100), 10.0),
        (Hand(feed=60000).line(x=120), 1.2),  # X allows 100 mm/s
        (Hand().rapid(x=100, y=100), math.sqrt(2) * 100 / 120),  # the path 120 mm/s
        (Hand().rapid(z=-100), 2.0),
        (Hand(feed=3600).line(c=90), 1.5),  # degrees per minute
        (Hand(feed=36000).line(c=720), 2.0),
        (Hand(feed=600).rapid(x=10).arc(1, 0, 0), 2 * math.pi),
    ],
)
def test_a_move_takes_as_long_as_feed_and_axes_ask(hand, seconds):
    assert duration(hand.moves[-1], LIMITS) == pytest.approx(seconds)
    per_turn = hand.moves[-1]._replace(feed=hand.moves[-1].feed / 600, feed_mode="G95")
    assert duration(per_turn, LIMITS, spindle_speed=600) == pytest.approx(seconds)


def test_a_track_tells_length_time_and_feed_of_each_move():
    path = Track(MILL, Hand(feed=600).rapid(x=10).arc(1, 0, 0).moves, LIMITS)
    assert path.part_length(1) == pytest.approx(20 * math.pi, rel=1e-4)
    assert (path.seconds(1), path.part_feed(1)) == pytest.approx((2 * math.pi, 600), rel=1e-4)
    on_face = Track(FACE, Hand(feed=3600).rapid(x=10).line(c=90).moves, LIMITS)
    assert on_face.part_feed(1) == pytest.approx(math.radians(60) * 10 * 60, rel=1e-3)


def run_of(hand, unit=1.0, change=lambda samples: None, **options):
    """Return a run along a hand's path, its samples changed."""
    path = Track(MILL, hand.moves, LIMITS)
    samples = samples_of(path, **options)
    change(samples)
    return follow(path, samples, unit)


def test_an_arc_is_followed_exactly_not_by_its_chords():
    path = Track(MILL, Hand().rapid(x=50).arc(-1, 0, 0).moves, LIMITS)
    samples = samples_of(path, 3000)
    angle = -np.linspace(0, 2 * math.pi, 3000)
    samples.axes.update(X=50.003 * np.cos(angle), Y=50.003 * np.sin(angle))
    inner = follow(path, samples, 1.0).deviation[50:-50]
    assert np.allclose(inner, 0.003, atol=1e-9)


def test_a_sharp_corner_that_is_cut_short_is_followed_by_the_lines():
    hand = Hand().line(x=40).next_block().line(x=0, y=4)
    places = np.linspace(0, 3, 3001)
    lines = np.where(places < 1.5, 1, 2)

    def without_the_last_10_mm(samples):
        samples.axes["X"] = np.interp(places, range(4), [0, 30, 30, 0])
        samples.axes["Y"] = np.interp(places, range(4), [0, 0, 1, 4])
        samples.line[:] = lines

    real = run_of(hand, change=without_the_last_10_mm, count=3001)
    assert real.deviation.max() == pytest.approx(0.5, abs=0.01)  # between the legs
    assert (real.move == lines - 1).all()
    assert real.deviation[places > 2].max() < 1e-6


def test_a_line_that_linuxcnc_names_late_or_early_has_its_neighbours_path():
    """Blended: the tool is 2 mm beyond the move of the line."""
    hand = Hand().line(x=40).next_block().arc(1, 40, 10, x=50, y=10).next_block().line(y=50)
    along = np.linspace(0, 40 + 5 * math.pi + 40, 2000)
    for shift in (2.0, -2.0):
        ends = [40 + shift, 40 + 5 * math.pi + shift]

        def named(samples, ends=ends):
            samples.line[:] = 1 + np.searchsorted(ends, along)

        assert run_of(hand, change=named).deviation.max() < 1e-3


def test_the_tool_length_offset_is_taken_off():
    hand = Hand().line(x=20)
    hand.offset = (0, 0, 30.0, *HOME[3:])
    real = run_of(hand.line(z=5).line(x=40), count=4000)
    assert real.points[:, 2].max() == pytest.approx(5)
    assert real.deviation.max() < 1e-6


def test_samples_are_converted_to_mm_and_standstill_is_left_out():
    def in_inches_and_waiting(samples):
        samples.axes.update({letter: values / 25.4 for letter, values in samples.axes.items()})
        samples.kind[:500] = 0

    real = run_of(Hand().line(x=25.4), 25.4, in_inches_and_waiting)
    assert real.points[-1][0] == pytest.approx(25.4) and len(real.time) == 1500


def test_the_largest_deviation_is_looked_for_in_cuts_only():
    def aside(samples):
        samples.axes["Y"][samples.axes["X"] < 50] += 3.0
        samples.axes["Y"][samples.axes["X"] > 150] += 0.01

    hand = Hand().rapid(x=100).line(x=200)
    worst = worst_of(run_of(hand, change=aside, count=4000), hand.moves)
    assert worst.deviation == pytest.approx(0.01)
    assert worst.move is hand.moves[1]
    assert worst.point[0] > 150


def test_a_sample_may_be_on_its_lines_moves_or_in_a_corner_with_the_neighbours():
    hand = Hand().line(x=10).next_block().line(x=10, y=10).next_block().line(x=0, y=10)
    path, lines = Track(MILL, hand.moves, LIMITS), np.array([1, 1, 2, 3])
    on_its_line, with_neighbours = windows_of(path, lines)
    assert on_its_line.tolist() == [[0, 0], [0, 0], [1, 1], [2, 2]]
    assert with_neighbours.tolist() == [[0, 1], [0, 1], [0, 2], [1, 2]]
    anywhere = [window.tolist() for window in windows_of(path, lines[::-1])]
    assert anywhere == [[[0, 2]] * 4] * 2
