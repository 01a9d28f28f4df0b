# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A in a headless LinuxCNC: real motion against the flat program's path."""

import random

import numpy as np
import pytest
from shapely.geometry import LineString, Point

from support.flat_contours import FlatContour, flat_path, flat_program, wrapped_program
from support.operated_machine import kept_machine
from support.polar_programs import FEED, ROUND
from support.sim_machines import SIM, trace_text

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add
RADIUS, PROGRAMMED = 25.0, 800.0  # mm, mm/min

mill = kept_machine("mill_a_mm")


def on_surface(samples):
    """Return where the tool was at feed on the surface: X, and upwards -A as a length."""
    axes = samples.axes
    deep = np.isin(samples.kind, (FEED, ROUND)) & (abs(axes["Z"] - (RADIUS - 1)) < 1e-4)
    upwards = -np.radians(axes["A"]) * RADIUS
    return np.column_stack([axes["X"], upwards])[deep], samples.line[deep]


def speeds(places, lines):
    """Return the median speed along the surface of the middle of each long block, mm/min."""
    for line in np.unique(lines):
        own = places[lines == line]
        middle = own[len(own) // 3 : len(own) - len(own) // 3]
        if len(middle) > 100:
            yield np.median(np.hypot(*np.diff(middle, axis=0).T)) * 1000 * 60


@pytest.mark.parametrize("number", [2, 18, 23])  # of G40, G42 and G41
def test_the_tool_follows_the_flat_contour_at_the_programmed_feed(mill, number):
    contour = FlatContour(random.Random(f"A {number}"))
    flat = trace_text(flat_program(contour), SIM / "mill_mm.ini")
    drawn = LineString([(at.real, at.imag) for at in flat_path(flat)])
    run = mill.run_text(wrapped_program(contour, "A", RADIUS, feed=PROGRAMMED))
    assert run.error is None, run.error
    places, lines = on_surface(run.samples)
    assert max(drawn.distance(Point(place)) for place in places[::3]) <= LIMIT
    measured = list(speeds(places, lines))
    assert measured == pytest.approx([PROGRAMMED] * len(measured), rel=0.02)
    assert abs(run.samples.axes["Y"]).max() == 0.0
