# SPDX-License-Identifier: GPL-2.0-or-later
"""What a shape's call asks for, by its entries, and the forms of the shapes."""

import cmath
import math
from types import SimpleNamespace

import numpy as np
import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.preview.executed_blocks import STATE, Block, read_line
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.shapes.shape_cut import area_swept
from g12.tools.verify.shapes.shape_form import Shift, polygon_form, round_form, slot_form
from g12.tools.verify.shapes.shape_way import ShapeWay
from g12.tools.verify.shapes.wanted_shape import ShapeReading, shapes_asked
from support.sim_machines import SIM

LATHE, MILL = (read_ini(SIM / f"{name}_mm_headless.ini") for name in ("lathe", "mill"))
READING = ShapeReading("inherit", 0.5, 3.0)
FOUND = {"_x": 40.0, "_z": 5.0, "_c": 0.0, "_metric": 1.0, "_feed": 150.0, "_rpm": 1000.0}
CUTTER = {3: 6.0}


def asked(shape, *entries, start=(40.0, 0.0, 5.0, 0.0, 0.0, 0.0), **state):
    """Return what a call asks for; the tool stands at X40 Z5, in mm, G8, G94 and F150."""
    found = {**dict.fromkeys(STATE, 0.0), **FOUND, **state}
    text = read_line(7, f"o<{shape}> call")
    block = Block(text, {}, (), (), entries, found, 0, 1)
    place = (*start, 0.0, 0.0, 0.0)
    move = Move("rapid", 7, 7, place, place, 0.0, "G94", 18, 3, (0.0,) * 9)
    ((_, wanted),) = shapes_asked([block], Codes(LATHE), [move], CUTTER, READING)
    return wanted


def hexagon(**state):
    return asked("polar_polygon", 6, 20, 3, 30, 2, 1, 0.3, 600, -9999, 10, **state)


def test_entries_are_read_by_their_names():
    wanted = hexagon()
    assert wanted.levels == (-1.0, -2.0, -3.0) and wanted.allowance == 0.3
    assert (wanted.feed, wanted.plunge_feed, wanted.cutter) == (600, 300, 3.0)
    assert (wanted.start, wanted.near, wanted.line) == (5.0, 1.0, 7)


def test_what_is_left_out_has_its_default():
    wanted = asked("polar_slot", 8, 30, 4, -9999, -9999, -9999, -9999, -9999)
    assert (wanted.levels, wanted.allowance, wanted.feed) == ((-4.0,), 0.0, 150)
    assert asked("polar_slot", 8, 30, 4, 2.5).levels == (-2.0, -4.0)


def test_a_feed_per_revolution_and_one_that_is_forgotten():
    assert hexagon(_units_per_rev=1.0).feed == 600 * 1000
    wanted = asked("polar_slot", 8, 30, 4, 4, 0, -9999, -9999, 0, _feed=1.0)
    assert (wanted.feed, wanted.plunge_feed) == (None, None) and "_feed" not in wanted.leaves


def test_inches_and_the_program_s_zero():
    state = {"_metric": 0.0, "_x": 1.5, "_z": 1.0, "_c": 10.0}
    wanted = asked("polar_pocket", 1, 0.5, 0.4, 0.1, 1, start=(50.8, 0, 25.4, 0, 0, 40), **state)
    assert wanted.zero == pytest.approx((12.7, 0.0, 30.0))
    assert wanted.form.centre == pytest.approx(25.4 * (1 + 0.5j) * cmath.rect(1, math.pi / 6))
    assert wanted.levels == pytest.approx((-2.54,))


def test_x_of_a_pocket_is_read_as_x_words_are():
    assert asked("polar_pocket", 8, 0, 9, 1, 1, _lathe_diameter_mode=1.0).form.centre == 4
    assert asked("polar_pocket", 8, 0, 9, 1, 1).form.centre == 8


def test_a_sub_of_that_name_without_its_code_is_another_s():
    call = read_line(1, "o<polar_slot> call [8] [30] [4]")
    assert (Codes(LATHE).shape_of(call), Codes(MILL).shape_of(call)) == ("polar_slot", "")


def test_forms_have_the_areas_of_the_formulas():
    hexagon = polygon_form(6, 20, 0, 15, 10)
    assert hexagon.area.area == pytest.approx(6 * 100 * math.tan(math.pi / 6), rel=1e-9)
    rounded = polygon_form(4, 20, 3, 60, 0)
    assert rounded.area.area == pytest.approx(400 - 9 * (4 - math.pi), abs=0.01)
    half = math.acos(10 / 15)
    flats = polygon_form(2, 20, 0, 15, -40)
    assert flats.area.area == pytest.approx(
        225 * (math.pi - 2 * half + math.sin(2 * half)), abs=0.1
    )
    assert slot_form(8, 30, 20).area.area == pytest.approx(8 * 22 + 16 * math.pi, abs=0.01)
    assert round_form(5 + 1j, 9, 0).area.area == pytest.approx(81 * math.pi / 4, abs=0.01)


@pytest.mark.parametrize(
    "form",
    [
        polygon_form(6, 20, 2, 30, 10),
        polygon_form(5, 20, 0, 40, -3),
        polygon_form(2, 20, 0, 30, 77),
        slot_form(8, 30, 20),
        round_form(5 + 1j, 9, 11),
    ],
)
def test_a_form_stands_where_its_own_extremes_are(form):
    x, y = form.area.exterior.coords.xy
    corners = [complex(*place) for place in zip(x, y)]
    assert form.stands(np.array(corners)) == pytest.approx([0.0] * len(form.extremes), abs=1e-3)
    shift = Shift(7.0, 0j) if form.fold else Shift(0.0, 1 - 2j)
    x, y = form.placed(shift).area.exterior.coords.xy
    moved = [complex(*place) for place in zip(x, y)]
    assert form.placed(shift).stands(np.array(moved)) == pytest.approx(
        form.stands(np.array(corners)), abs=1e-3
    )
    assert max(map(abs, form.stands(np.array(moved)))) > 0.05


def test_a_move_too_short_for_a_sample_of_a_run_is_as_emitted():
    emitted = SimpleNamespace(points=np.array([[1.0, 2.0, 0.0]]), vertices=lambda _: slice(0, 1))
    run = SimpleNamespace(points=np.array([[3.0, 4.0, 0.0]]), during=lambda index: slice(0, index))
    way = ShapeWay(hexagon(), [], emitted, run)
    assert (way.points(0), way.points(1)) == (1 + 2j, 3 + 4j)


def test_corners_that_the_bar_cuts_off_are_none():
    names = [{each.name for each in polygon_form(4, 20, 0, bar, 0).extremes} for bar in (14, 15)]
    assert names == [{"flats"}, {"flats", "corners"}]


@pytest.mark.parametrize("radius", [0.85, 0.69, 1.1, 2.0, 5.9])
def test_a_ring_smaller_than_its_cutter_clears_the_middle(radius):
    ring = 4j + radius * np.exp(2j * np.pi * np.arange(50) / 50)
    area = area_swept([np.append(ring, ring[0])], 6.0).area
    assert area == pytest.approx(np.pi * (6.0 + radius) ** 2, rel=0.01)
