# SPDX-License-Identifier: GPL-2.0-or-later
"""Which moves of a section go out as X and Y of the face, and how."""

from math import atan2, degrees, hypot, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour, Plunge
from g12.machine_ini import FaceAxes
from g12.moves.steps import FaceSwitch, Segments
from g12.polar.face import blending_halves, in_face
from support import planned_moves
from support.face_moves import arc, arcs, line, lines, motion
from support.section_starts import AXES, polar

X = AXES["X"]
FACE = FaceAxes(X, X, X, 1.0)


@pytest.mark.parametrize(
    ("following", "halved"),
    [
        (line((20, 10), (0, 10)), True),
        (line((20, 10), (0, 10.1)), False),
        (line((20, 10), (0, 10 + 20 * 0.9e-6)), True),
        (line((20, 10), (0, 10 - 20 * 1.1e-6)), False),
        (line((20, 10), (40, 10)), False),
        (arc((20, 0), 10, pi / 2, 1), True),
        (arc((20, 20), 10, -pi / 2, -1), True),
        (arc((20, 20), 10, -pi / 2, 1), False),
        (Plunge(1, 100.0, 0.0, -1.0), True),
    ],
)
def test_an_arc_whose_acceleration_blending_would_halve(following, halved):
    assert blending_halves(arc((20, 0), 10, 0, pi / 2), following) is halved


@settings(max_examples=200)
@given(st.one_of(lines, arcs), st.floats(-20, 20))
def test_the_face_is_the_plane_turned(move, angle):
    turned = in_face(move, angle)
    before, after = motion(move)[0], motion(turned)[0]
    assert after * np.exp(1j * angle) == pytest.approx(before, abs=1e-9)


def contour(*points, feed=2000.0):
    """Return a contour of lines from X30 on."""
    drawn = Contour(30.0, 0.0, 0.0, code="G12.1", radius_tolerance=0.0127)
    x, c = 30.0, 0.0
    for number, (to_x, to_c) in enumerate(points, 7):
        drawn.elements.append(planned_moves.line(x, c, to_x, to_c, number=number, feed=feed))
        x, c = to_x, to_c
    return drawn


def test_arcs_on_the_face_leave_the_machine_at_their_end():
    """Clockwise over three quarters of a circle, C goes from 0 to 90 about a centre far out."""
    drawn = Contour(60.0, 0.0, 0.0)
    drawn.arc(-1, 40.0, 20.0, i=-20.0, at=7, feed=1000.0)
    drawn.straight(40.0, 30.0, -1.0, at=8, feed=1000.0)
    made = polar(10.0, face=FACE).plan(drawn)
    there, arc_on, line_on, back = made.steps
    for step, (x, c), z in ((arc_on, (40, 20), 0.0), (line_on, (40, 30), -1.0)):
        assert step.segments[-1] == pytest.approx((hypot(x, c), 10 + degrees(atan2(c, x)), z))
    assert len(arc_on.segments) > 40
    assert (made.end.slide, made.end.height) == pytest.approx(line_on.segments[-1][::2])
    assert (there.position, back.position) == ((60.0, 10.0, 0.0), line_on.segments[-1])
    assert abs(line_on.move.start) == pytest.approx(hypot(40, 20))


def test_the_part_beside_the_pole_is_made_of_segments_and_the_face_begins_anew():
    made = polar(face=FACE).plan(contour((30, 20), (0.2, 20), (0.2, -30), (30, -30), (30, 0)))
    assert [step.on for step in made.steps if isinstance(step, FaceSwitch)] == [True, False] * 2
    assert {step.line for step in made.steps if isinstance(step, Segments)} == {9}
    *_, at = (k for k, step in enumerate(made.steps) if isinstance(step, FaceSwitch) and step.on)
    switch, again = made.steps[at : at + 2]
    assert (again.line, again.move.start.imag) == (9, pytest.approx(0.0, abs=0.002))
    assert again.move.start.real == pytest.approx(switch.position[0])
    assert 0.2 < again.move.start.real < hypot(3, 30)
