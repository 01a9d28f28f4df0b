# SPDX-License-Identifier: GPL-2.0-or-later
"""A tool beside the X line: what cannot be reached, and how many segments it needs."""

import math

import pytest

from g12.compensation.contour import Contour
from g12.errors import Refusal
from g12.polar.plan import PolarSettings, plan
from support.contour_geometry import Round, Straight
from support.planned_cuts import add, programmed

LATHE = PolarSettings(0.005, 1e-9, 1000.0, 3600.0, 21600.0)


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
