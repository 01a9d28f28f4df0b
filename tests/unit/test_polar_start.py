# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section goes by: from what it finds, the settings and the machine's axes."""

from math import radians, sqrt

import pytest

from g12.errors import Refusal
from g12.machine_ini import Axis, FaceAxes
from g12.moves.setup import SectionMachine
from g12.polar.face import FaceLimits
from g12.polar.polar_section import Polar
from g12.settings import Settings
from support.section_starts import START, with_found

INCH = 25.4
SHIFTED = (
    "X0 must be the spindle's axis: G52 or G92 shifts X by {};"
    " cancel it with G92.1 (an X offset of G54 may stay)"
)
AXES = {letter: Axis(-100.0, 100.0, 50.0, 1000.0) for letter in "XZC"}


def section(settings=Settings(), letters="XZC", axes=AXES, face=None, **found):  # noqa: B008
    """Return a section that begins with what is found."""
    return Polar(with_found(START, **found), SectionMachine(letters, settings, axes, face))


@pytest.mark.parametrize(
    ("found", "rule"),
    [
        ({"alone": False}, "must be alone in its block"),
        ({"compensated": True}, "needs G40: compensation is switched on inside"),
        ({"inverse_time": True}, "needs G94 or G95, not G93"),
        ({"plane": "G19"}, "needs G18 or G17, not G19"),
        ({"surface_speed": True}, "needs G97: with G96 the speed would change with X"),
        (
            {"offset_pending": True},
            "needs a move after G40: the tool is still beside the programmed point",
        ),
        ({"rotation": 1.0}, "needs an unrotated work offset (G10 L2 R0)"),
        ({"missing_code": "M133"}, "needs the spindle as C: M133 first"),
        ({"shifts": {"X": -2.5}}, SHIFTED.format(-2.5)),
        ({"shifts": {"X": -2.5}, "diameter": True}, SHIFTED.format(-5)),
        ({"x": 0.0}, "needs the tool at X above zero, not at 0 (radius)"),
    ],
)
def test_where_no_section_begins(found, rule):
    with pytest.raises(Refusal) as refused:
        section(**found)
    assert str(refused.value) == f"G12.1 line 7: {rule}"


@pytest.mark.parametrize(
    ("machine_mm", "inch", "tolerance"),
    [
        (1.0, False, 0.005),
        (INCH, True, 0.0002),
        (1 / 0.0393700787, False, 0.0002 / 0.0393700787),  # LINEAR_UNITS = 0.0393700787
    ],
)
def test_lengths_are_in_program_units(machine_mm, inch, tolerance):
    made = section(machine_mm=machine_mm, inch=inch)
    millimetre = 1 / INCH if inch else 1.0
    machine_unit = machine_mm * millimetre
    assert made.rules.radius_tolerance == pytest.approx(0.0005 * INCH * millimetre)
    assert made.tolerance == pytest.approx(tolerance)
    assert made.least == pytest.approx(0.001 * millimetre)
    assert made.in_program(AXES["X"]) == pytest.approx(1000.0 * machine_unit)


@pytest.mark.parametrize(
    ("settings", "found", "words"),
    [
        ({}, {"diameter": True}, {"diameter": True, "x_scale": 1.0}),
        ({}, {"diameter": False}, {"diameter": False, "x_scale": 1.0}),
        ({"polar_x": "diameter"}, {"diameter": False}, {"diameter": True, "x_scale": 0.5}),
        ({"polar_x": "radius"}, {"diameter": True}, {"diameter": False, "x_scale": 2.0}),
        ({}, {}, {"height_with_others": False, "turn_scale": 1.0, "rapid_feed": None}),
        ({"polar_z": "allow"}, {}, {"height_with_others": True}),
        (
            {"polar_g0": "feed", "polar_g0_feed": 500.0},
            {"machine_mm": INCH},
            {"rapid_feed": pytest.approx(12700.0)},
        ),
    ],
)
def test_what_settings_make_of_words(settings, found, words):
    made = section(Settings(**settings), **found).rules
    assert {name: getattr(made, name) for name in words} == words


def test_kinematics_are_refused_on_a_machine_without_them():
    with pytest.raises(Refusal, match=r"needs \[KINS\] KINEMATICS = polar_xzc"):
        section(Settings(polar_kinematics=True))


@pytest.mark.parametrize(("override", "kept"), [(1.5, 1.5), (0.5, 1.0)])
def test_what_the_axes_of_the_face_allow(override, kept):
    x, y, slide = (Axis(-1.0, 1.0, 9.0, acceleration) for acceleration in (30.0, 40.0, 20.0))
    axes = {**AXES, "C": Axis(-9.0, 9.0, 50.0, 700.0)}
    kinematics = Settings(polar_kinematics=True)
    face = FaceAxes(x, y, slide, override)
    made = section(kinematics, axes=axes, face=face, machine_mm=INCH)
    nearest = 20.0 * INCH / radians(700.0)
    chord = sqrt(8.0 * made.tolerance * nearest)
    assert made.face == FaceLimits(
        acceleration=pytest.approx(50.0 * INCH),
        round_acceleration=pytest.approx(30.0 * INCH),
        slide_acceleration=pytest.approx(20.0 * INCH),
        c_acceleration=radians(700.0),
        c_speed=radians(50.0),
        override=kept,
        segments_speed=pytest.approx(0.7 * sqrt(20.0 * INCH * chord)),
    )
    assert section(face=face).face is None


def test_a_tool_beside_x_s_line_is_so_everywhere_and_the_slide_has_its_own_speed():
    slide = Axis(-1.0, 1.0, 9.0, 20.0)
    beside = Settings(polar_kinematics=True, polar_tool_offset=-2.0)
    face = FaceAxes(slide, slide, slide, 1.0)
    made = section(beside, face=face, machine_mm=INCH)
    assert made.rules.beside == made.face.beside == -2.0 * INCH
    assert made.face.slide_speed == pytest.approx(9.0 * INCH)
    assert section().rules.beside == 0.0
    assert section(Settings(polar_pole="refuse")).pole_refused
    assert not section().pole_refused
