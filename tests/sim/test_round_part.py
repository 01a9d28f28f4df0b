# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A in a headless LinuxCNC: real motion against the flat program's path, and a part."""

import random
import re

import numpy as np
import pytest
from shapely.geometry import LineString, Point, box

from support.flat_contours import FlatContour, flat_path, flat_program, wrapped_program
from support.foreign_programs import FOREIGN, translation
from support.operated_machine import kept_machine
from support.polar_programs import FEED, ROUND
from support.sim_machines import SIM, trace_text

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add
RADIUS, PROGRAMMED = 25.0, 800.0  # mm, mm/min

mill = kept_machine("mill_a_mm", tools={1: 5.0, 2: 3.0, 3: 6.0})


def on_surface(samples, depth=1.0, radius=RADIUS):
    """Return where the tool was at feed at a depth: X, and upwards -A as a length."""
    axes = samples.axes
    deep = np.isin(samples.kind, (FEED, ROUND)) & (abs(axes["Z"] - (radius - depth)) < 1e-4)
    upwards = -np.radians(axes["A"]) * radius
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


PLATE = box(-37, -22, 37, 22).buffer(8, 256)  # of the job: 90 by 60, its corners round
SLOT = LineString([(-15, 0), (15, 0)]).buffer(8, 256)  # 3 deep
HOLES = [(-33, -19), (-33, 19), (33, -19), (33, 19)]
CUTTER, OWN_ERROR = (
    2.5,
    0.022,
)  # mm, the radius; FreeCAD's own arcs leave the slot's wall by so much


def test_a_job_of_freecads_is_cut_round_the_part(mill):
    """Posted by its own post for LinuxCNC; eight times its feeds, for the test's time."""
    job = FOREIGN / "freecad" / "plate.nc"
    text = translation(job, "mill-round-part", "--diameter", "100", "--ini", str(mill.ini.path))
    faster = re.sub(r"F([\d.]+)", lambda feed: f"F{8 * float(feed[1]):g}", text)
    samples = mill.motion_of(["G21 G90 G0 Z80", *faster.splitlines()])
    outline, slot, drilled = (on_surface(samples, depth, 50)[0] for depth in (6, 3, 6.5))
    outside = [at for at in map(Point, outline[::5]) if not PLATE.contains(at)]
    from_edge = [PLATE.exterior.distance(at) for at in outside]
    assert (min(from_edge), max(from_edge)) == pytest.approx((CUTTER, CUTTER), abs=LIMIT)
    wanted, made = PLATE.buffer(CUTTER, 256).exterior, LineString(outline)
    assert max(made.distance(wanted.interpolate(at)) for at in range(int(wanted.length))) < LIMIT
    inside = [at for at in map(Point, slot[::5]) if SLOT.contains(at)]
    wall = min(map(SLOT.exterior.distance, inside))
    assert CUTTER - OWN_ERROR - LIMIT < wall < CUTTER + LIMIT
    assert sorted({tuple(at) for at in drilled.round(3)}) == HOLES
