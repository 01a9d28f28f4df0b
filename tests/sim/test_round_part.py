# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 with A in a headless LinuxCNC: real motion of random contours, and of a part."""

import random
import re

import numpy as np
import pytest
from shapely.geometry import LineString, Point, box

from support.foreign_programs import FOREIGN, translation
from support.operated_machine import kept_machine
from support.polar_programs import FEED, ROUND
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
    mill.reset()
    samples = mill.motion_of(["G21 G90 G0 Z80", *faster.splitlines()])
    outline, slot, drilled = (on_surface(samples, depth, 50) for depth in (6, 3, 6.5))
    outside = [at for at in map(Point, outline[::5]) if not PLATE.contains(at)]
    from_edge = [PLATE.exterior.distance(at) for at in outside]
    assert (min(from_edge), max(from_edge)) == pytest.approx((CUTTER, CUTTER), abs=LIMIT)
    wanted, made = PLATE.buffer(CUTTER, 256).exterior, LineString(outline)
    assert max(made.distance(wanted.interpolate(at)) for at in range(int(wanted.length))) < LIMIT
    inside = [at for at in map(Point, slot[::5]) if SLOT.contains(at)]
    wall = min(map(SLOT.exterior.distance, inside))
    assert CUTTER - OWN_ERROR - LIMIT < wall < CUTTER + LIMIT
    assert sorted({tuple(at) for at in drilled.round(3)}) == HOLES
