# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section gains from kinematics, against times that were measured in runs."""

import cmath
import math

import numpy as np
import pytest

from g12.geometry.curve import Arc, Line
from g12.tools.machine.ini import read_machine_ini
from g12.tools.path.section_times import (
    Leg,
    lathe_axes,
    least_seconds,
    section_times,
)
from support.sim_machines import SIM

FLAT, CUTTER = 13.5, 6.0  # mm, radii
CIRCLE = [Arc(30 + 0j, 20 + 0j, math.tau)]
FREE = (1e9, 1e9)  # speed and acceleration
LATHE, INCH = "lathe_mm", "lathe_inch"
SLOW = "lathe_slow_c_mm_kinematics"


def hexagon():
    """Return the path of the cutter around a hexagon."""
    path = []
    for side in range(6):
        turn = cmath.rect(1, -side * math.pi / 3)
        corner = FLAT * complex(1, -1 / math.sqrt(3))
        first, last = corner.conjugate() + CUTTER, corner + CUTTER
        path += [Line(first * turn, last * turn), Arc(last * turn, corner * turn, -math.pi / 3)]
    return path


def times_of(path, feed, lathe=LATHE):
    """Return the times of a path at a feed in mm/min."""
    axes = lathe_axes(read_machine_ini(SIM / f"{lathe}.ini"))
    return section_times([Leg(curve, feed / 60) for curve in path], axes)


@pytest.mark.parametrize(
    ("feed", "segments", "kinematics"),  # against length / F, by the bench on 2.9.0~pre1
    [(1000, 0.995, 1.001), (2000, 1.449, 1.007), (3000, 2.173, 1.018)],
)
@pytest.mark.parametrize("lathe", [LATHE, "lathe_mm_kinematics", INCH])
def test_the_hexagon_as_in_runs(feed, segments, kinematics, lathe):
    ideal = 60 * sum(curve.length for curve in hexagon()) / feed
    found = times_of(hexagon(), feed, lathe)
    assert found.segments / ideal == pytest.approx(segments, rel=0.05)
    assert found.kinematics / ideal == pytest.approx(kinematics, rel=0.04)


def test_the_circle_as_in_runs():
    assert times_of(CIRCLE, 2000).segments == pytest.approx(3.21, rel=0.03)
    for lathe, feed, measured in (
        (LATHE, 1000, 1.01), (LATHE, 2000, 1.05), (LATHE, 3000, 1.15), (SLOW, 500, 1.01),
        (SLOW, 1000, 1.05),
    ):  # fmt: skip
        found = times_of(CIRCLE, feed, lathe)
        assert found.kinematics / found.least == pytest.approx(measured, rel=0.05)


def test_at_the_pole_c_turns_in_place():
    feed, turned = 300, 0.5 + 0.1  # seconds: 180 degrees at 360 degrees/s, 3600 degrees/s²
    way = [Line(-20 + 0j, 0j), Line(0j, 20 + 0j)]
    found = times_of(way, feed)
    halves = [times_of([half], feed).least for half in way]
    assert found.least - sum(halves) == pytest.approx(turned, abs=0.03)  # a step is 0.02 s
    assert sum(halves) == pytest.approx(40 / 5, rel=0.01)
    assert found.least <= found.kinematics <= found.segments <= 1.02 * found.least
    assert times_of([Line(-20 + 0j, 20 + 0j)], feed) == pytest.approx(found, rel=0.01)
    assert times_of([Line(0.18 + 0j, -20 + 0j)], feed).segments < 5  # begins at the pole, nearly


@pytest.mark.parametrize("away", [0.01, 0.5, 3.0, 30.0])
@pytest.mark.parametrize("lathe", [LATHE, SLOW])
def test_no_way_is_quicker_than_the_limits(away, lathe):
    for path in ([Line(away - 20j, away + 20j)], [Arc(away + 8 + 0j, away + 0j, -5.0)]):
        for feed in (200, 1000, 5000):
            segments, face, least = times_of(path, feed, lathe)
            assert 0 < least <= 1.01 * face and face <= segments


ALONG_A_RADIUS = np.linspace(10.0, 50.0, 2001) + 0j
ABOUT_THE_AXIS = 20.0 * np.exp(1j * np.linspace(0.0, math.pi, 2001))


@pytest.mark.parametrize(
    ("points", "speed", "slide", "spindle", "seconds"),
    [
        (ALONG_A_RADIUS, 1e4, (1e9, 1000.0), FREE, 0.4),
        (ALONG_A_RADIUS, 50.0, (1e9, 1000.0), FREE, 0.85),
        (ALONG_A_RADIUS, 1e4, (50.0, 1e9), FREE, 0.8),
        (ABOUT_THE_AXIS, 1e4, FREE, (1e9, 10.0), 2.0 * math.sqrt(math.pi / 10.0)),
    ],
)
def test_along_a_radius_the_slide_speeds_up_and_brakes_and_c_about_the_axis(
    points, speed, slide, spindle, seconds
):
    assert least_seconds(points, speed, slide, spindle) == pytest.approx(seconds, rel=0.01)
