# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves of slides and a rotary axis: where they stop, how long segments are, how fast.

Two moves at right angles, each with the acceleration a, are blended at the speed v in 2 v / a; the
tool passes the corner at sqrt(2) v t / 8.
"""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Plunge
from g12.errors import Refusal
from g12.moves import exact_stops
from g12.moves.steps import Split, segments_with_feed
from g12.polar.polar_section import PolarSteps
from support import planned_moves
from support.contour_geometry import Round
from support.planned_cuts import programmed
from support.section_starts import AXES, polar

FEED = 600.0  # 10 per second
C = 1000.0 / 30.0  # as quick as X at the corners, which are at radius 30
ROUNDING = math.sqrt(2) * 10.0 * (2 * 10.0 / 1000.0) / 8


def stops(path, rounding):
    """Return where the tool stops on a face; accelerations per second squared."""
    quick = {"X": 1000.0, "C": math.degrees(C)}
    axes = {name: AXES[name]._replace(acceleration=most) for name, most in quick.items()}
    steps = PolarSteps(Contour(30.0, 0.0, 0.0), polar(axes=axes))
    return exact_stops.stops(path, rounding, steps.acceleration)


def line(x0, c0, x1, c1, h0=0.0, h1=0.0, feed=FEED):
    return planned_moves.line(x0, c0, x1, c1, h0, h1, feed=feed)


RIGHT_ANGLE = [line(20, 0, 30, 0), line(30, 0, 30, 10)]


def test_a_move_that_stops_gathers_speed_twice_as_quickly():
    assert stops(RIGHT_ANGLE, 1.99 * ROUNDING) == [True, True]
    assert stops(RIGHT_ANGLE, 2.01 * ROUNDING) == [False, True]


@pytest.mark.parametrize("depth", [-5.0, 5.0])
@pytest.mark.parametrize(("share", "stop"), [(0.99, True), (1.01, False)])
def test_a_plunge_is_a_right_angle_up_and_down(depth, share, stop):
    down = [line(20, 0, 30, 0), Plunge(2, FEED, 0.0, depth), line(30, 0, 30, 5)]
    assert stops([*down, line(30, 5, 30, 5.1)], share * ROUNDING)[:2] == [stop, stop]


ALONG_X, ALONG_C = [line(20, 0, 30, 0), (40, 0)], [line(30, -5, 30, 0), (30, 10)]


@pytest.mark.parametrize(("level", "on"), [ALONG_X, ALONG_C])
@pytest.mark.parametrize("rise", [0.5, -1.0, 3.0])
@pytest.mark.parametrize(("share", "stop"), [(0.99, True), (1.01, False)])
def test_a_slope_has_its_angle_and_its_axes_in_space(level, on, rise, share, stop):
    """X, Z and C are as quick as each other here: the steeper of both parts takes all of it."""
    slope = line(30, 0, *on, h0=2.0, h1=2.0 + 10.0 * rise)
    bend, steep = math.atan(rise), max(1.0, abs(rise)) / math.hypot(1.0, rise)
    rounding = share * abs(math.sin(bend / 2)) * 10.0**2 / 2000.0
    far_x, far_c = 2 * on[0] - 30, 2 * on[1]
    onwards = line(on[0], on[1], far_x, far_c, h0=slope.h1, h1=slope.h1 + 10.0 * rise)
    up = [level._replace(h0=2.0, h1=2.0), slope, onwards]
    assert stops(up, rounding / steep)[0] is stop
    on = level.start
    beyond = line(on.real, on.imag, 2 * on.real - 30, 2 * on.imag, 2.0, 2.0)
    down = [*(move.portion(1.0, 0.0) for move in up[::-1]), beyond]
    assert stops(down, rounding * steep)[1] is stop


# F words.

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


# Spacing.


def test_an_arc_of_too_many_segments_is_refused_with_its_line():
    far = Round(1e6 + 0j, 1e5 + 0j, 2 * math.pi)
    with pytest.raises(Refusal) as refused:
        polar(tolerance=1e-5).plan(programmed([far]))
    assert refused.value.message == (
        "G12.1 line 1: more than 100000 moves would be needed to stay within POLAR_TOLERANCE"
    )
