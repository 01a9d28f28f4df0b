# SPDX-License-Identifier: GPL-2.0-or-later
"""Where the tool stops: at the pole, at the end, and where blending would round a corner too much.

Two moves at right angles, each with the acceleration a, are blended at the speed v in 2 v / a; the
tool passes the corner at sqrt(2) v t / 8.
"""

import math

import pytest

from g12.compensation.contour import Contour, Plunge
from g12.geometry.curve import Line
from g12.moves import exact_stops
from g12.polar.polar_section import PolarSteps
from support import planned_moves
from support.section_starts import AXES, polar

FEED = 600.0  # 10 per second
C = 1000.0 / 30.0  # as quick as X at the corners, which are at radius 30
ROUNDING = math.sqrt(2) * 10.0 * (2 * 10.0 / 1000.0) / 8


def stops(path, rounding, x, c):
    """Return where the tool stops on a face; accelerations per second squared, of C in radians."""
    quick = {"X": x, "C": math.degrees(c)}
    axes = {name: AXES[name]._replace(acceleration=most) for name, most in quick.items()}
    steps = PolarSteps(Contour(30.0, 0.0, 0.0), polar(axes=axes))
    return exact_stops.stops(path, rounding, steps.acceleration)


def line(x0, c0, x1, c1, h0=0.0, h1=0.0, feed=FEED):
    return planned_moves.line(x0, c0, x1, c1, h0, h1, feed=feed)


def first_stops(path, rounding, x=1000.0, c=C):
    """Say whether the tool stops at the end of the first move; the last one is not the end."""
    away = path[-1]
    after = away._replace(curve=Line(away.end, 2 * away.end - away.start))
    return stops([*path, after], rounding, x, c)[0]


RIGHT_ANGLE = [line(20, 0, 30, 0), line(30, 0, 30, 10)]


def test_the_slower_axis_counts_where_it_brakes():
    """C at radius 10 has a fifth of the acceleration, X is 2.2 times as quick and more."""
    braking = [line(10, -5, 10, 0), line(10, 0, 20, 0)]
    slow, quick = 5 * ROUNDING * 2.2, dict(c=20.0)
    assert first_stops(braking, 0.99 * slow, **quick)
    assert not first_stops(braking, 1.01 * slow, **quick)


def test_a_move_that_stops_gathers_speed_twice_as_quickly():
    assert stops(RIGHT_ANGLE, 1.99 * ROUNDING, 1000.0, C) == [True, True]
    assert stops(RIGHT_ANGLE, 2.01 * ROUNDING, 1000.0, C) == [False, True]


@pytest.mark.parametrize("depth", [-5.0, 5.0])
@pytest.mark.parametrize(("share", "stop"), [(0.99, True), (1.01, False)])
def test_a_plunge_is_a_right_angle_up_and_down(depth, share, stop):
    down = [line(20, 0, 30, 0), Plunge(2, FEED, 0.0, depth), line(30, 0, 30, 5)]
    assert stops([*down, line(30, 5, 30, 5.1)], share * ROUNDING, 1000.0, C)[:2] == [stop, stop]


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
    assert stops(up, rounding / steep, 1000.0, C)[0] is stop
    on = level.start
    beyond = line(on.real, on.imag, 2 * on.real - 30, 2 * on.imag, 2.0, 2.0)
    assert stops([*map(turned_back, up[::-1]), beyond], rounding * steep, 1000.0, C)[1] is stop


def turned_back(move):
    return move.reversed()


def test_at_the_pole_the_tool_always_stops():
    assert stops([line(5, 0, 0, 0, feed=1.0), line(0, 0, -5, 0, feed=1.0)], 1.0, 1e3, 1e2)[0]


def test_down_and_up_again_is_a_turn_back():
    pecks = [Plunge(1, FEED, 0.0, -5.0), Plunge(2, FEED, -5.0, -1.0), Plunge(3, FEED, -1.0, 0.0)]
    assert stops(pecks, ROUNDING, 1000.0, C) == [True, False, True]
