# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a bar's face cuts what it cuts on a mill."""

import numpy as np
import pytest

from g12.tools.preview.tracer import Tracer
from interp.test_translate_cam import (
    DEEPEST_RAPID,
    HOME,
    SOME,
    TOLERANCE,
    TOP,
    on_the_part,
    rapids_turn_above_the_part,
    wanted_path,
)
from support.cam_parts import PARTS, mill_program
from support.contour_geometry import FROM_COLUMNS, distances
from support.foreign_programs import FOREIGN, translation
from support.shape_geometry import polygon
from support.sim_machines import SIM

SETTINGS = {"POLAR_Z": "allow", "LIVE_SPINDLE": "0"}


@pytest.fixture(scope="module")
def lathe(tmp_path_factory):
    """Return a function: the trace of a mill's program, as a lathe cuts it."""
    folder = tmp_path_factory.mktemp("mill")
    with Tracer(SIM / "lathe_mm.ini", overrides={"G12": SETTINGS}) as tracer:

        def cut(text, control, *options):
            program = folder / "part.nc"
            program.write_text(text)
            translated = translation(program, control, *options)
            traced = tracer.trace_text(translated.replace(" $1", ""), setup=HOME["mm"], alone=True)
            assert traced.error is None, (traced.error, translated)
            return traced.moves

        yield cut


@pytest.mark.parametrize("part", PARTS)
def test_on_the_face(lathe, part):
    moves = lathe(mill_program(PARTS[part]), "mill-on-face", "--safe", "1")
    assert_cut(on_the_part(moves), PARTS[part])
    assert rapids_turn_above_the_part(moves)


def assert_cut(made, part):
    expected = wanted_path(part)
    assert distances(made[made[:, 2] < DEEPEST_RAPID][::SOME], expected).max() < TOLERANCE
    low = made[made[:, 2] < TOP]
    assert distances(expected[expected[:, 2] < DEEPEST_RAPID][::SOME], low).max() < TOLERANCE


HOLES = """G21 G90 G54
T3 M6
G43 H3
G0 X8 Y-3 S900 M3
Z5
G1 Z-1 F100
G1 X6 Y-2 F200
G0 Z5
G81 X5 Y5 Z-6 R2 F80
X-5
G83 X0 Y-7 Z-4 Q1.5
G80
G0 Z5
M2
"""
WANTED = [(5, 5, -6), (-5, 5, -6), (0, -7, -4)]


def test_holes_are_where_the_mill_has_them(lathe):
    moves = lathe(HOLES, "mill-on-face")
    first = max(n for n, m in enumerate(moves) if m.kind == "feed" and m.start[5] != m.end[5])
    downs = on_the_part(moves[first + 2 :])
    for x, y, depth in WANTED:
        near = downs[np.hypot(downs[:, 0] - x, downs[:, 1] - y) < 1e-3]
        assert near[:, 2].min() == pytest.approx(depth)
    deep = downs[downs[:, 2] < 0]
    assert all(min(np.hypot(p[0] - x, p[1] - y) for x, y, _ in WANTED) < 1e-3 for p in deep)


CUTTER, CLOSE = 2.5, 0.01  # mm: the radius; POLAR_TOLERANCE, and arcs with three decimals
DRILLED = [11, -5.5 + 9.526j, -5.5 - 9.526j]


def test_a_job_of_freecads_is_cut_on_the_face(lathe):
    """A hexagon, a pocket and three holes: where the tool's centre may be, and has been."""
    made = on_the_part(lathe((FOREIGN / "freecad" / "bar.nc").read_text(), "mill-on-face"))
    points, z, plane = made[:, :2], made[:, 2], made[:, :2] @ FROM_COLUMNS
    hole = np.min([abs(plane - place) for place in DRILLED], axis=0) < CLOSE
    pocket = abs(plane) < 6 - CUTTER + CLOSE
    profile = np.array(polygon(6, 28, angle=30).buffer(CUTTER, 200).exterior.coords)
    outside = distances(points, profile) < CLOSE
    assert (hole | pocket | outside)[z < 0].all()
    assert [round(z[where].min(), 2) for where in (hole, pocket, outside)] == [-6, -3, -4]
    assert all(z[abs(plane - place) < CLOSE].min() < -5.99 for place in DRILLED)
    assert distances(profile, points[outside & (z < -3.99)]).max() < 2 * CLOSE
    assert abs(plane)[pocket & (z < -2.99)].max() > 6 - CUTTER - CLOSE
