# SPDX-License-Identifier: GPL-2.0-or-later
"""Polar planning, whole sections: the contour is cut, at its feed, in as few segments as can be."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour
from g12.errors import Refusal
from g12.machine_ini import Axis
from g12.moves.setup import SectionMachine
from g12.moves.steps import Segments
from g12.polar.polar_section import Polar
from g12.settings import Settings
from support.contour_geometry import Round, Straight, distance, distance_from_path
from support.planned_cuts import SAGITTA, cuts, path, programmed
from support.section_starts import START, polar, with_found

TOLERANCE = 0.005
LEAST = 1e-9  # of the slide: nothing is handed on, so that all of the deviation is seen

coordinate = st.floats(-30.0, 30.0) | st.sampled_from([0.0, 1e-9, 0.001, -0.004, 0.02, 1.0, -7.0])
point = st.builds(complex, coordinate, coordinate)
sweep = st.floats(0.05, 6.28) | st.sampled_from([math.pi, 2 * math.pi])
arc = st.tuples(point, st.builds(math.copysign, sweep, st.sampled_from([1, -1])))
ON_LINE = st.just(0.0)
offsets = ON_LINE | st.sampled_from([0.02, -0.5, 3.0, -10.0]) | st.floats(-15.0, 15.0)


@st.composite
def drawings(draw, most=5, beside=ON_LINE):
    """Shapes one after the other from where the tool stands: lines to points, arcs about centres.

    A line leads to them from a tool that is beside the X axis.
    """
    at = complex(draw(st.floats(0.1, 30.0)), draw(beside))
    elements, shapes = draw(st.lists(point | arc, min_size=1, max_size=most)), []
    for element in [draw(point), *elements] if at.imag else elements:
        straight = isinstance(element, complex)
        shape = Straight(at, element) if straight else Round(at, *element)
        assume(shape.length > 0.01 and (straight or shape.radius > 0.02))
        shapes.append(shape)
        at = shape.end
    return shapes


def runs(planned):
    return [step for step in planned.steps if isinstance(step, Segments)]


# What is cut is the contour.


@settings(max_examples=250)
@given(
    drawings(beside=offsets),
    st.floats(-400.0, 400.0),
    st.sampled_from([0.0005, 0.002, TOLERANCE, 0.02]),
)
@example([Straight(10 + 0j, -10 + 0j)], 0.0, TOLERANCE)
@example([Straight(10 + 0j, -10 + 0.004j)], 30.0, TOLERANCE)
@example([Round(10 + 0j, 5 + 0j, 2 * math.pi)], 0.0, TOLERANCE)
@example([Round(10 + 0j, 5.0008 + 0j, -2 * math.pi)], 0.0, TOLERANCE)
@example([Straight(5 + 0j, 0j), Straight(0j, 3j), Round(3j, 1.5j, math.pi)], 0.0, TOLERANCE)
@example([Straight(5 + 10j, 5 + 10.006j)], 0.0, TOLERANCE)
@example([Straight(20 + 3j, 3.006j), Straight(3.006j, -20 + 3.006j)], 0.0, TOLERANCE)  # the slide
@example([Straight(20 + 3j, 3.0050001j)], 0.0, TOLERANCE)  # hardly reached
@example([Straight(20 + 3j, 3.0049999j)], 0.0, TOLERANCE)
@example([Straight(20 + 3j, 9 + 0j), Round(9 + 0j, 0j, 2 * math.pi)], 0.0, TOLERANCE)
@example([Straight(20 + 3j, 8 + 0j), Round(8 + 0j, 2.4 + 0j, -2 * math.pi)], 0.0, TOLERANCE)
@example([Straight(1 + 5e-324j, -2j), Straight(-2j, 9j)], 0.0, 0.0005)
def test_stays_within_any_tolerance_of_the_contour_both_ways_and_keeps_x(shapes, c, tolerance):
    """Only what a tool beside the X axis cannot reach is refused."""
    contour, beside = programmed(shapes), shapes[0].start.imag
    nearest = distance(np.array([0j]), shapes)[0]
    try:
        planned = polar(c, tolerance, LEAST, polar_tool_offset=beside).plan(contour)
    except Refusal as refusal:
        assert "POLAR_TOOL_OFFSET" in refusal.message
        assert beside and nearest < abs(beside) + tolerance + 1e-9
        return
    assert not beside or nearest > abs(beside) + tolerance - 1e-9
    made = cuts(contour, planned, c, beside)
    assert distance(path(made), shapes).max() <= tolerance + 1e-9
    drawn = np.concatenate([shape.points(40) for shape in shapes])
    assert distance_from_path(drawn, path(made)).max() <= tolerance + 1.5 * SAGITTA
    assert all(min(cut.radius) >= 0.0 for cut in made)
    length, expected = (sum(each.length for each in every) for every in (made, shapes))
    assert length == pytest.approx(expected, rel=5e-3, abs=0.05)  # no turn too many


# At its feed.


def is_small(shape):
    """Say whether the tolerance alone makes more than half a percent of an arc."""
    return isinstance(shape, Round) and shape.radius < 200 * TOLERANCE


@settings(max_examples=100)
@given(drawings())
def test_the_feed_is_even_inside_a_segment_where_the_machine_can_hold_it(shapes):
    contour = programmed(shapes, feed=100.0)
    for cut in cuts(contour, polar(least=LEAST).plan(contour)):
        if min(cut.radius) > 2.0 and not is_small(shapes[cut.line - 1]):
            assert all(speed == pytest.approx(100.0, rel=0.02) for speed in cut.speeds)


# The pole.


def test_through_the_pole_c_turns_in_place_as_fast_as_it_may():
    contour = programmed([Straight(10 + 0j, -8 + 0j)], feed=300.0)
    assert runs(polar().plan(contour)) == [
        Segments(1, "XC", [(0.0, 0.0, 0.0, 300.0)], True),
        Segments(1, "XC", [(0.0, -180.0, 0.0, 21600.0)], True),
        Segments(1, "XC", [(8.0, -180.0, 0.0, 300.0)], True),
    ]


@pytest.mark.parametrize("shape", [Straight(9 + 0j, -9 + 0.003j), Round(9 + 0j, 4.501 + 0j, 5.0)])
def test_a_path_through_the_pole_is_refused_on_demand(shape):
    careful = polar(polar_pole="refuse")
    with pytest.raises(
        Refusal, match=r"^G12\.1 line 1: .*spindle's centre \(POLAR_POLE = refuse\)$"
    ):
        careful.plan(programmed([shape]))
    assert careful.plan(programmed([Straight(9 + 0j, -9 + 0.2j)])).steps


# Where it begins, from the settings and the machine's axes.

LIMITS = {letter: Axis(-100.0, 100.0, 50.0, 1000.0) for letter in "XZC"}


def section(settings=Settings(), letters="XZC", axes=LIMITS, face=None, **found):  # noqa: B008
    """Return a section that begins with what is found."""
    machine = SectionMachine(frozenset(letters), settings, axes, face)
    return Polar(with_found(START, **found), machine)


@pytest.mark.parametrize(
    ("found", "rule"),
    [
        ({"alone": False}, "must be alone in its block"),
        ({"compensated": True}, "needs G40: compensation is switched on inside"),
        ({"inverse_time": True}, "needs G94 or G95, not G93"),
        (
            {"offset_pending": True},
            "needs a move after G40: the tool is still beside the programmed point",
        ),
        ({"plane": "G19"}, "needs G18 or G17, not G19"),
        ({"surface_speed": True}, "needs G97: with G96 the speed would change with X"),
        ({"rotation": 1.0}, "needs an unrotated work offset (G10 L2 R0)"),
        ({"missing_code": "M133"}, "needs the spindle as C: M133 first"),
        (
            {"shifts": {"X": -2.5}, "diameter": True},
            "X0 must be the spindle's axis: G52 or G92 shifts X by -5;"
            " cancel it with G92.1 (an X offset of G54 may stay)",
        ),
        ({"x": 0.0}, "needs the tool at X above zero, not at 0 (radius)"),
        (
            {"letters": "XYZC", "y": 10.0},
            "needs Y0: the tool must stand on the spindle's axis, not at Y10",
        ),
    ],
)
def test_where_no_section_begins(found, rule):
    with pytest.raises(Refusal) as refused:
        section(**found)
    assert str(refused.value) == f"G12.1 line 7: {rule}"


def test_kinematics_are_refused_on_a_machine_without_them():
    with pytest.raises(Refusal, match=r"needs \[KINS\] KINEMATICS = polar_xzc"):
        section(Settings(polar_kinematics=True))


def test_segments_that_keep_x_stay_within_the_tolerance():
    """Two circles, one after the other: without a stop segments are as far off as they may be."""
    centre, size = 30.8521 - 0.1765j, abs(5.3802 - 0.1765j)
    contour = Contour(25.4718, 0.0, 0.0)
    for line in (1, 2):
        contour.arc(1, 25.4718, 0.0, i=5.3802, j=-0.1765, at=line, feed=300.0)
    made = cuts(contour, polar().plan(contour))
    assert any(cut.radius[0] == cut.radius[1] for cut in made)
    assert abs(abs(path(made) - centre) - size).max() < TOLERANCE
