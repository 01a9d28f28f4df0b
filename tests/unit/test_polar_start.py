# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section goes by: from what it finds, the settings and the machine's axes."""

from math import radians, sqrt

import pytest

from g12.errors import Refusal
from g12.machine_ini import Axis, FaceAxes
from g12.moves.steps import BlockMoves
from g12.polar.follow import FaceLimits
from g12.polar.start import check_section_start, polar_setup
from g12.settings import Settings
from support.section_starts import START

INCH = 25.4
SHIFTED = (
    "X0 must be the spindle's axis: G52 or G92 shifts X by {};"
    " cancel it with G92.1 (an X offset of G54 may stay)"
)
AXES = {letter: Axis(-100.0, 100.0, 50.0, 1000.0) for letter in "XZC"}


def setup_of(settings=Settings(), **found):  # noqa: B008 - it is frozen
    return polar_setup(START._replace(**found), settings, AXES, None)


@pytest.mark.parametrize(
    ("found", "rule"),
    [
        ({"alone": False}, "must be alone in its block"),
        ({"compensated": True}, "needs G40: compensation is switched on inside"),
        ({"inverse_time": True}, "needs G94 or G95, not G93"),
        ({"yz_plane": True}, "needs G18 or G17, not G19"),
        ({"surface_speed": True}, "needs G97: with G96 the speed would change with X"),
        (
            {"offset_pending": True},
            "needs a move after G40: the tool is still beside the programmed point",
        ),
        ({"rotated": True}, "needs an unrotated work offset (G10 L2 R0)"),
        ({"missing_code": "M133"}, "needs the spindle as C: M133 first"),
        ({"x_shift": -2.5}, SHIFTED.format(-2.5)),
        ({"x_shift": -2.5, "diameter": True}, SHIFTED.format(-5)),
        ({"x": 0.0}, "needs the tool at X above zero, not at 0 (radius)"),
    ],
)
def test_where_no_section_begins(found, rule):
    check_section_start(START, "XZC")
    with pytest.raises(Refusal) as refused:
        check_section_start(START._replace(**found), "XZC")
    assert str(refused.value) == f"G12.1 line 7: {rule}"


def test_a_section_may_begin_near_the_centre_on_a_machine_with_x_and_c():
    check_section_start(START._replace(x=1e-3), "XC")
    for axes in ("XYZ", "ZC"):
        with pytest.raises(Refusal) as refused:
            check_section_start(START, axes)
        assert refused.value.message == "G12.1 line 7: needs a machine with an X and a C axis"


@pytest.mark.parametrize(
    ("machine_unit", "millimetre", "tolerance"),
    [
        (1.0, 1.0, 0.005),  # mm machine in G21
        (1.0, 1 / INCH, 0.0002),  # inch machine in G20
        (1 / 0.0393700787, 1.0, 0.0002 / 0.0393700787),  # LINEAR_UNITS = 0.0393700787
    ],
)
def test_lengths_are_in_program_units(machine_unit, millimetre, tolerance):
    made = setup_of(machine_unit=machine_unit, millimetre=millimetre)
    assert made.words.radius_tolerance == pytest.approx(0.0005 * INCH * millimetre)
    assert made.tolerance == made.plan.tolerance == pytest.approx(tolerance)
    assert made.plan.least_x == pytest.approx(0.001 * millimetre)
    assert made.plan.x_acceleration == pytest.approx(1000.0 * machine_unit)
    assert (made.plan.c_acceleration, made.plan.c_speed) == (1000.0, 3000.0)


@pytest.mark.parametrize(
    ("settings", "found", "words"),
    [
        ({}, {"diameter": True}, {"diameter": True, "x_scale": 1.0}),
        ({}, {"diameter": False}, {"diameter": False, "x_scale": 1.0}),
        ({"polar_x": "diameter"}, {"diameter": False}, {"diameter": True, "x_scale": 0.5}),
        ({"polar_x": "radius"}, {"diameter": True}, {"diameter": False, "x_scale": 2.0}),
        ({}, {}, {"third_with_others": False, "c_scale": 1.0, "rapid_feed": None}),
        ({"polar_z": "allow"}, {}, {"third_with_others": True}),
        (
            {"polar_g0": "feed", "polar_g0_feed": 500.0},
            {"machine_unit": INCH},
            {"rapid_feed": pytest.approx(12700.0)},
        ),
    ],
)
def test_what_settings_make_of_words(settings, found, words):
    made = setup_of(Settings(**settings), **found).words
    assert {name: getattr(made, name) for name in words} == words


def test_kinematics_are_refused_on_a_machine_without_them():
    with pytest.raises(Refusal, match=r"needs \[KINS\] KINEMATICS = polar_xzc"):
        setup_of(Settings(polar_kinematics="1"))


@pytest.mark.parametrize(("override", "kept"), [(1.5, 1.5), (0.5, 1.0)])
def test_what_the_axes_of_the_face_allow(override, kept):
    x, y, slide = (Axis(-1.0, 1.0, 9.0, acceleration) for acceleration in (30.0, 40.0, 20.0))
    axes = {**AXES, "C": Axis(-9.0, 9.0, 50.0, 700.0)}
    start = START._replace(machine_unit=INCH)
    kinematics = Settings(polar_kinematics="1")
    made = polar_setup(start, kinematics, axes, FaceAxes(x, y, slide, override))
    nearest = 20.0 * INCH / radians(700.0)
    chord = sqrt(8.0 * made.tolerance * nearest)
    assert made.plan.face == FaceLimits(
        acceleration=pytest.approx(50.0 * INCH),
        round_acceleration=pytest.approx(30.0 * INCH),
        slide_acceleration=pytest.approx(20.0 * INCH),
        c_acceleration=radians(700.0),
        c_speed=radians(50.0),
        override=kept,
        segments_speed=pytest.approx(0.7 * sqrt(20.0 * INCH * chord)),
    )
    assert polar_setup(start, Settings(), axes, FaceAxes(x, y, slide, 1.0)).plan.face is None


def test_a_tool_beside_x_s_line_is_so_everywhere_and_the_slide_has_its_own_speed():
    slide = Axis(-1.0, 1.0, 9.0, 20.0)
    beside = Settings(polar_kinematics="1", polar_tool_offset=-2.0)
    found = START._replace(machine_unit=INCH)
    made = polar_setup(found, beside, AXES, FaceAxes(slide, slide, slide, 1.0))
    assert made.words.beside == made.plan.beside == made.plan.face.beside == -2.0 * INCH
    assert made.plan.face.slide_speed == pytest.approx(9.0 * INCH)
    assert setup_of().words.beside == setup_of().plan.beside == 0.0
    assert setup_of(Settings(polar_pole="refuse")).plan.pole_refused
    assert not setup_of().plan.pole_refused


@pytest.mark.parametrize(
    ("machine_unit", "millimetre", "unit"),
    [(1.0, 1.0, "mm"), (INCH, 1.0, "in"), (1.0, 1 / INCH, "in"), (1 / INCH, 1 / INCH, "mm")],
)
def test_the_travel_is_told_in_the_machines_unit(machine_unit, millimetre, unit):
    limits = setup_of(machine_unit=machine_unit, millimetre=millimetre).limits
    far, off = 200.0 * machine_unit, START.offsets
    for axis, place in (("X", (far, 0.0, 0.0)), ("Z", (0.0, 0.0, far))):
        beyond = limits.beyond([BlockMoves(3, "XCZ", [(*place, 1.0)], False)])
        assert (beyond.axis, beyond.unit) == (axis, unit)
        assert beyond.position == pytest.approx(200.0 + off[axis] / machine_unit)
