# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a bar's face and round a part, of lathe and mill, cuts what it does flat."""

import numpy as np
import pytest

from g12.tools.machine.ini import read_ini
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
from support.valid_programs import WITH_B

SETTINGS = {"POLAR_Z": "allow", "CYLINDER_X": "allow", "LIVE_SPINDLE": "0"}
DIAMETER = 50.0
ROUND = ("--diameter", "50")


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


def legs_of(moves, axes):
    """Return positions of some axes along moves, densely."""
    legs = [np.linspace(*([at[i] for i in axes] for at in (m.start, m.end)), 200) for m in moves]
    return np.concatenate(legs).T


def round_the_part(moves):
    """Return points of the tool's way over the unrolled surface, as the mill has them."""
    x, z, c = legs_of(moves, (0, 2, 5))
    return np.column_stack([z, -np.radians(c) * DIAMETER / 2, x - DIAMETER / 2])


def round_a(moves):
    """Return the same of a mill with A, which stays above the axis of rotation."""
    x, y, z, a = legs_of(moves, (0, 1, 2, 3))
    assert not y.any()
    return np.column_stack([x, -np.radians(a) * DIAMETER / 2, z - DIAMETER / 2])


def round_b(moves):
    """Return the same of a mill with B."""
    x, y, z, b = legs_of(moves, (0, 1, 2, 4))
    assert not x.any()
    return np.column_stack([np.radians(b) * DIAMETER / 2, y, z - DIAMETER / 2])


def round_a_reversed(moves):
    return round_a(moves) * (1, -1, 1)


MILLS = {
    round_a: {},
    round_b: WITH_B,
    round_a_reversed: {"G12": {"CYLINDER_X": "allow", "ROTARY_SENSE": "reversed"}},
}


@pytest.fixture(scope="module", params=MILLS, ids=lambda made: made.__name__)
def mill(request, tmp_path_factory):
    """Return a function: the points of a flat program's way round a part, and its moves."""
    folder = tmp_path_factory.mktemp("round")
    machine = {"overrides": MILLS[request.param], "tools": {1: 12.0, 2: 10.0, 3: 6.0}}
    with Tracer(SIM / "mill_a_mm.ini", **machine) as tracer:
        ini = folder / "machine.ini"
        own = read_ini(SIM / "mill_a_mm.ini").replaced(MILLS[request.param])
        ini.write_text("\n".join(own.lines))

        def cut(text, *options):
            program = folder / "part.nc"
            program.write_text(text)
            translated = translation(
                program, "mill-round-part", *ROUND, *options, "--ini", str(ini)
            )
            traced = tracer.trace_text(translated, setup=["G21 G90", "G0 Z80"], alone=True)
            assert traced.error is None, (traced.error, translated)
            return request.param(traced.moves), traced.moves

        yield cut


ROUND_MILL = [
    *((round_a, part) for part in PARTS),
    (round_b, "strokes"),
    (round_a_reversed, "inside"),
]


@pytest.mark.parametrize(("mill", "part"), ROUND_MILL, indirect=["mill"])
def test_round_the_part_on_a_mill(mill, part):
    made, moves = mill(mill_program(PARTS[part]), "--safe", "1")
    assert_cut(made, PARTS[part])
    assert all(m.end[2] > DIAMETER / 2 for m in moves if m.kind == "rapid")


@pytest.mark.parametrize("part", PARTS)
def test_on_the_face(lathe, part):
    moves = lathe(mill_program(PARTS[part]), "mill-on-face", "--safe", "1")
    assert_cut(on_the_part(moves), PARTS[part])
    assert rapids_turn_above_the_part(moves)


@pytest.mark.parametrize("part", PARTS)
def test_round_the_part(lathe, part):
    moves = lathe(mill_program(PARTS[part]), "mill-round-part", "--safe", "1", *ROUND)
    assert_cut(round_the_part(moves), PARTS[part])
    assert all(m.start[0] > DIAMETER / 2 < m.end[0] for m in moves if m.kind == "rapid")


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


@pytest.mark.parametrize(
    ("control", "options", "made_by"),
    [("mill-on-face", (), on_the_part), ("mill-round-part", ROUND, round_the_part)],
)
def test_holes_are_where_the_mill_has_them(lathe, control, options, made_by):
    moves = lathe(HOLES, control, *options)
    first = max(n for n, m in enumerate(moves) if m.kind == "feed" and m.start[5] != m.end[5])
    downs = made_by(moves[first + 2 :])
    assert_drilled(downs[downs[:, 2] < 0])


def assert_drilled(deep):
    """Assert that points in the part are those of the holes, down to their ends."""
    away = np.array([np.hypot(deep[:, 0] - x, deep[:, 1] - y) for x, y, _ in WANTED])
    assert (away.min(axis=0) < 1e-3).all()
    ends = [deep[beside < 1e-3, 2].min() for beside in away]
    assert ends == pytest.approx([depth for *_, depth in WANTED])


def test_holes_round_a_part_of_a_mill(mill):
    made, moves = mill(HOLES)
    assert_drilled(made[made[:, 2] < -1.001])
    assert moves[-1].end[2] == 5 + DIAMETER / 2


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
