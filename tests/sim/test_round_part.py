# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A in a headless LinuxCNC: real motion of random contours, and of a part."""

import random
import re

import numpy as np
import pytest
from shapely.geometry import LineString, Point

from support.foreign_programs import FOREIGN, translation
from support.operated_machine import kept_machine
from support.polar_programs import FEED, ROUND
from support.shape_geometry import polygon
from support.valid_programs import valid_program

LIMIT = 0.005 + 0.001  # POLAR_TOLERANCE, and what sampling may add

mill = kept_machine("mill_a_mm", tools={1: 5.0, 2: 3.0, 3: 6.0, 4: 10.0, 5: 12.0, 10: 20.0})


def on_surface(samples, depth, radius):
    """Return where the tool was at feed at a depth: X, and upwards -A as a length."""
    axes = samples.axes
    deep = np.isin(samples.kind, (FEED, ROUND)) & (abs(axes["Z"] - (radius - depth)) < 1e-4)
    upwards = -np.radians(axes["A"]) * radius
    return np.column_stack([axes["X"], upwards])[deep]


def test_random_contours_are_cut_at_the_programmed_feed(mill):
    mill.reset()
    proof = mill.proof_of_run(valid_program("cylinder a", random.Random(4), 2))
    assert proof.findings == [] and len(proof.sections) == 2
    for section in proof.sections:
        assert section.deviation <= LIMIT
        assert section.values["seconds"] == pytest.approx(
            section.values["seconds_programmed"], rel=0.1
        )
    assert abs(proof.program.samples.axes["Y"]).max() == 0.0


HEXAGON = polygon(6, 28, angle=30)  # of the job: 4 deep, with a pocket of radius 6, 3 deep
HOLES = [(-5.5, -9.526), (-5.5, 9.526), (11, 0)]
CUTTER, OWN_ERROR = 2.5, 0.01  # mm, the radius; FreeCAD's arcs have three decimals


def test_a_job_of_freecads_is_cut_round_the_part(mill):
    """Posted by its own post for LinuxCNC; eight times its feeds, for the test's time."""
    job = FOREIGN / "freecad" / "bar.nc"
    text = translation(job, "mill-round-part", "--diameter", "100", "--ini", str(mill.ini.path))
    faster = re.sub(r"F([\d.]+)", lambda feed: f"F{8 * float(feed[1]):g}", text)
    mill.reset()
    samples = mill.motion_of(["G21 G90 G0 Z80", *faster.splitlines()])
    outline, pocket, drilled = (on_surface(samples, depth, 50) for depth in (4, 3, 6))
    outside = [at for at in map(Point, outline[::5]) if not HEXAGON.contains(at)]
    from_edge = [HEXAGON.exterior.distance(at) for at in outside]
    assert (min(from_edge), max(from_edge)) == pytest.approx((CUTTER, CUTTER), abs=LIMIT)
    wanted, made = HEXAGON.buffer(CUTTER, 256).exterior, LineString(outline)
    assert max(made.distance(wanted.interpolate(at)) for at in range(int(wanted.length))) < LIMIT
    assert np.hypot(*pocket.T).max() == pytest.approx(6 - CUTTER, abs=OWN_ERROR + LIMIT)
    assert sorted({tuple(at) for at in drilled.round(3)}) == HOLES
