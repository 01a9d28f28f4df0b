# SPDX-License-Identifier: GPL-2.0-or-later
"""The least time of a path against motions whose least time is known."""

import math

import numpy as np
import pytest

from g12.tools.path.least_time import least_seconds

FREE = (1e9, 1e9)


def test_along_a_radius_the_slide_speeds_up_and_brakes():
    points = np.linspace(10.0, 50.0, 2001) + 0j
    assert least_seconds(points, 1e4, (1e9, 1000.0), FREE) == pytest.approx(0.4, rel=0.01)
    assert least_seconds(points, 50.0, (1e9, 1000.0), FREE) == pytest.approx(0.85, rel=0.01)
    assert least_seconds(points, 1e4, (50.0, 1e9), FREE) == pytest.approx(0.8, rel=0.01)


def test_about_the_axis_c_does():
    points = 20.0 * np.exp(1j * np.linspace(0.0, math.pi, 2001))
    least = least_seconds(points, 1e4, FREE, (1e9, 10.0))
    assert least == pytest.approx(2.0 * math.sqrt(math.pi / 10.0), rel=0.01)
