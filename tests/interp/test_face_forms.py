# SPDX-License-Identifier: GPL-2.0-or-later
"""The forms of a lathe's face: what ngcgui makes of them comes out as filled in."""

import pytest

from g12.tools.preview.tracer import Tracer
from support.ngcgui import filled_in
from support.shape_geometry import area_off, disc, path_of, polygon, slot
from support.sim_machines import SIM

INCH = 25.4
TOLERANCE = 0.006  # mm: POLAR_TOLERANCE, and the polygons of the drawing
NOTHING = 0.002  # mm² of what rounding leaves of areas
CUTTER = 6.0
UNITS = {"mm": 1.0, "inch": INCH}
BOTH = pytest.mark.parametrize("unit", UNITS)
ONE = pytest.mark.parametrize("unit", ["inch"])  # the forms of both units are one text
COUNTS = ("tool", "speed", "sides", "angle", "on", "off", "count", "first_angle", "step")


@pytest.fixture(scope="module")
def lathe():
    with Tracer(SIM / "lathe_mm.ini", tools={1: CUTTER}) as opened:
        yield opened


@pytest.fixture
def cut(lathe, tmp_path):
    """Return what a form filled in cuts; lengths are given in mm and entered in its unit."""

    def traced(form, unit, before=("G21 G8 G0 X60 Z20",), **values):
        entered = {
            name: value if name in COUNTS else value / UNITS[unit] for name, value in values.items()
        }
        program = filled_in(f"form_{form}_{unit}", tmp_path / "auto.ngc", tool=1, **entered)
        return lathe.trace_text([*before, *program.read_text().splitlines()])

    return traced


def path(found):
    assert found.error is None, found.error
    assert {"M5", "M9"} <= set(found.modes.mcodes)
    return path_of(found.moves)


@ONE
def test_a_hexagon_comes_out_as_filled_in(cut, unit):
    found = cut("polygon", unit, retract=4, sides=6, across_flats=27, depth=5, stock_diameter=32,
                corner_radius=2, per_pass=3, allowance=0.3, feed=500, angle=10)  # fmt: skip
    way, bar = path(found), disc(0, 0, 32)
    standing = bar.difference(way.area(-5, CUTTER / 2))
    assert area_off(standing, polygon(6, 27, 2, 10).intersection(bar), TOLERANCE) < NOTHING
    assert way.z.min() == pytest.approx(-5, abs=1e-9)
    assert found.moves[-1].end[2] == pytest.approx(4)


@ONE
def test_a_slot_comes_out_as_filled_in(cut, unit):
    way = path(cut("slot", unit, width=9, length=28, depth=3, per_pass=2, angle=-20))
    assert area_off(way.area(-3, CUTTER / 2), slot(9, 28, -20), TOLERANCE) < NOTHING
    assert way.z.min() == pytest.approx(-3, abs=1e-9)


@ONE
def test_a_pocket_comes_out_as_filled_in(cut, unit):
    way = path(cut("face_pocket", unit, x=12, c=4, diameter=15, depth=3))
    assert area_off(way.area(-3, CUTTER / 2), disc(6, 4, 15), TOLERANCE) < NOTHING
    assert way.z.min() == pytest.approx(-3, abs=1e-9)


@ONE
def test_holes_come_out_as_filled_in(cut, unit):
    face = cut("face_holes", unit, circle_diameter=30, first_angle=20, depth=8, height=2, count=3)
    side = cut("side_holes", unit, z=-10, first_angle=30, surface_diameter=40, depth=8, height=2,
               count=2, step=90, clear=60)  # fmt: skip
    assert face.error is None and side.error is None, (face.error, side.error)
    for found, bottom in ((face, (15, -8)), (side, (12, -10))):
        drilled = [move.end for move in found.moves if move.kind == "feed"]
        assert [(end[0], end[2]) for end in drilled] == [pytest.approx(bottom)] * len(drilled)
    assert [move.end[5] for move in side.moves if move.kind == "feed"] == pytest.approx([30, 120])


@BOTH
@pytest.mark.parametrize("active", ["G20 G7", "G20 G8", "G21 G7", "G21 G8"])
def test_the_modes_of_lengths_are_put_back(cut, unit, active):
    found = cut("slot", unit, [active], width=9, length=28, depth=3)
    assert found.error is None, found.error
    assert set(active.split()) <= set(found.modes.gcodes)


REFUSED = [
    ("polygon", {"tool": 0}, "form: the tool number must be 1 or more, not 0"),
    ("polygon", {"speed": 0}, "form: the tool's speed must be above zero, not 0"),
    ("polygon", {"coolant": 1}, "form: coolant must be 7, 8 or 9, not 1"),
    ("polygon", {"retract": 0}, "form: the retract height 0.000000 must be above the face at Z0"),
    ("polygon", {"on": 34}, "Unknown m code used: M34"),
    ("polygon", {"sides": 1}, "form_polygon_mm.ngc: sides 1 must be at least 2"),
    ("polygon", {"across_flats": 60}, "stock_diameter 40 must be greater than across_flats 60"),
    ("slot", {"width": 5}, "form_slot_mm.ngc: width 5 must not be less than the cutter's 6"),
    ("slot", {"length": 4}, "form_slot_mm.ngc: length 4 must be greater than width 8"),
    ("face_pocket", {"diameter": 0}, "form_face_pocket_mm.ngc: diameter 0 must be greater than 0"),
    ("face_pocket", {"depth": -1}, "form_face_pocket_mm.ngc: depth -1 must be greater than 0"),
]


@pytest.mark.parametrize(("form", "wrong", "message"), REFUSED)
def test_a_wrong_entry_is_refused_and_nothing_is_cut(lathe, tmp_path, form, wrong, message):
    program = filled_in(f"form_{form}_mm", tmp_path / "auto.ngc", **{"tool": 1, **wrong})
    found = lathe.trace_text(program.read_text().splitlines())
    assert found.error is not None
    assert message in found.error.text
    assert all(move.kind == "rapid" for move in found.moves)


@ONE
def test_the_live_tool_beside_a_main_spindle_that_is_c(tmp_path, unit):
    """A tap is refused unless spindle 1 turns; the main spindle never does."""
    tap = dict(kind=1, feed=1.5 / UNITS[unit], on=3, off=5)
    with Tracer(SIM / f"lathe_spindle_c_{unit}.ini", tools={1: CUTTER}) as spindle_lathe:
        for spindle in (0, 1):
            path = tmp_path / f"{spindle}.ngc"
            form = f"form_face_holes_{unit}"
            program = filled_in(form, path, tool=1, spindle=spindle, **tap).read_text()
            found = spindle_lathe.trace_text(["G0 X60 Z20", *program.splitlines()])
            assert (found.error is None) == (spindle == 1)
            assert ("M3" in [event.text for event in found.events]) == (spindle == 0)
