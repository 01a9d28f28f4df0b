# SPDX-License-Identifier: GPL-2.0-or-later
"""A tool beside the X line: what X and C make of it on the part, and what cannot be reached."""

import math

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from g12.compensation.contour import Contour
from g12.errors import Refusal
from g12.polar.plan import PolarSettings, plan
from support.contour_geometry import Round, Straight, distance, distance_from_path
from support.planned_cuts import add, programmed

TOLERANCE = 0.005
LATHE = PolarSettings(TOLERANCE, 1e-9, 1000.0, 3600.0, 21600.0)

offsets = st.sampled_from([0.02, -0.5, 3.0, -10.0]) | st.floats(-15.0, 15.0).filter(bool)
coordinate = st.floats(-30.0, 30.0)
point = st.builds(complex, coordinate, coordinate)
sweep = st.floats(0.05, 6.28) | st.sampled_from([math.pi, 2 * math.pi])
arc = st.tuples(point, st.builds(math.copysign, sweep, st.sampled_from([1, -1])))


@st.composite
def drawings(draw):
    """Draw a tool's offset, and shapes that a line leads to from where it stands."""
    beside = draw(offsets)
    at = complex(draw(st.floats(0.1, 30.0)), beside)
    shapes = [Straight(at, draw(point))]
    for element in draw(st.lists(point | arc, max_size=4)):
        at = shapes[-1].end
        straight = isinstance(element, complex)
        shapes.append(Straight(at, element) if straight else Round(at, *element))
        assume(straight or shapes[-1].radius > 0.02)
    assume(min(shape.length for shape in shapes) > 0.01)
    return beside, shapes


def contour_of(beside, shapes):
    contour = Contour(shapes[0].start.real, 0.0, beside=beside)
    for line, shape in enumerate(shapes, 1):
        add(contour, shape, line=line, feed=250.0)
    return contour


def on_the_part(contour, beside, planned):
    """Return the tool's path that X and C make, complex."""
    x, c = contour.start.x, 0.0
    parts, points = np.linspace(0.0, 1.0, 60), []
    for run in planned.steps:
        for to_x, to_c, _, _ in run.segments:
            slide, turn = x + (to_x - x) * parts, np.radians(c + (to_c - c) * parts)
            assert slide.min() >= 0.0
            points.append((slide + 1j * beside) * np.exp(1j * turn))
            x, c = to_x, to_c
    return np.concatenate(points)


@settings(max_examples=100, deadline=None)
@given(drawings())
@example((10.0, [Straight(5 + 10j, 5 + 10.006j)]))
@example((3.0, [Straight(20 + 3j, 3.006j), Straight(3.006j, -20 + 3.006j)]))  # along the slide
@example((-3.0, [Straight(20 - 3j, 3.006j), Straight(3.006j, -20 + 3.006j)]))
@example((3.0, [Straight(20 + 3j, 9 + 0j), Round(9 + 0j, 0j, 2 * math.pi)]))
@example((3.0, [Straight(20 + 3j, 8 + 0j), Round(8 + 0j, 2.4 + 0j, -2 * math.pi)]))
def test_the_tool_is_on_the_contour_or_it_is_refused(drawn):
    beside, shapes = drawn
    nearest = min(abs(shape.points(2000)).min() for shape in shapes)
    contour = contour_of(beside, shapes)
    try:
        planned = plan(contour, LATHE._replace(beside=beside), c=0.0)
    except Refusal as refusal:
        assert "POLAR_TOOL_OFFSET" in refusal.message
        assert nearest < abs(beside) + TOLERANCE + 1e-3
        return
    assert nearest >= abs(beside)
    made = on_the_part(contour, beside, planned)
    assert distance(made, shapes).max() <= TOLERANCE
    assert distance_from_path(np.concatenate([s.points(40) for s in shapes]), made).max() <= 0.0053


def test_every_segment_lasts_as_long_as_its_path_at_the_feed():
    shapes = [Straight(40 + 8j, 15 + 0j), Straight(15 + 0j, 15 - 20j), Straight(15 - 20j, -9 - 20j)]
    contour = contour_of(8.0, shapes)
    planned = plan(contour, LATHE._replace(beside=8.0), c=0.0)
    x, c, seconds = 40.0, 0.0, 0.0
    for to_x, to_c, _, feed in (segment for run in planned.steps for segment in run.segments):
        seconds += (abs(to_x - x) or abs(to_c - c)) / feed * 60
        x, c = to_x, to_c
    assert seconds == pytest.approx(sum(shape.length for shape in shapes) / 250 * 60, rel=1e-3)
    assert max(len(run.segments) for run in planned.steps) < 40


def test_what_is_nearer_to_the_centre_is_refused_with_its_line():
    contour = Contour(20.0, 0.0, beside=-3.0)
    contour.line(10.0, 0.0, line=7, feed=100.0)
    contour.line(2.9, 0.0, line=8, feed=100.0)
    with pytest.raises(Refusal) as refused:
        plan(contour, LATHE._replace(beside=-3.0), c=0.0)
    assert refused.value.message == (
        "G12.1 line 8: the tool's centre would come to 2.9 from the spindle's centre: it is 3 "
        "beside X's line (POLAR_TOOL_OFFSET) and comes no nearer than 3.005"
    )


@pytest.mark.parametrize(("feed", "quick"), [(60.0, 1.0), (250.0, 1e-6)])
@pytest.mark.parametrize(
    "shape",
    [
        Straight(30 + 0j, -20 + 15j),
        Straight(20 + 0j, 20 - 40j),
        Round(30 + 0j, 18 + 0j, -4.0),
        Round(30 + 0j, 12 + 0j, 2 * math.pi),
        Round(30 + 0j, 0j, -2 * math.pi),
    ],
)
def test_a_tool_hardly_beside_its_line_needs_the_same_segments_as_one_on_it(shape, feed, quick):
    """For an even feed at F60, or, if the axes are too slow for that, for the tolerance alone."""
    machine = LATHE._replace(x_acceleration=1000.0 * quick, c_acceleration=3600.0 * quick)
    on_line = plan(programmed([shape], feed=feed), machine, c=0.0).steps[0].segments
    contour = Contour(shape.start.real, 0.0, beside=1e-4)
    contour.line(c=0.0, line=1, feed=feed)
    add(contour, shape, line=2, feed=feed)
    beside = plan(contour, machine._replace(beside=1e-4), c=0.0).steps[-1].segments
    assert len(beside) == len(on_line)
    for one, other in zip(on_line, beside):
        assert other[:2] == pytest.approx(one[:2], rel=0.01, abs=0.05)
