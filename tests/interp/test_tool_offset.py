# SPDX-License-Identifier: GPL-2.0-or-later
"""[G12] POLAR_TOOL_OFFSET on the stock interpreter, and what the tools know of it."""

import math

import numpy as np
import pytest

from g12.tools.machine.ini import Ini, read_ini
from g12.tools.plot.history import history_of
from g12.tools.plot.scene import scene_of_judgement
from support.judged_programs import prove
from support.polar_programs import lines, section, tracer
from support.sim_machines import PROGRAMS, SIM

HEXAGON = PROGRAMS / "polar" / "hexagon.ngc"
WAYS = ["lathe_mm", "lathe_mm_kinematics"]


def ini_of(name, offset=8.0):
    return read_ini(SIM / f"{name}.ini").replaced({"G12": {"POLAR_TOOL_OFFSET": offset}})


def test_verify_finds_a_tool_that_is_elsewhere(monkeypatch):
    monkeypatch.setattr(Ini, "tool_beside", 7.9)
    assert prove(HEXAGON, ini_of("lathe_mm")).findings


@pytest.mark.parametrize("name", WAYS)
def test_a_picture_shows_where_slide_and_c_are(name):
    history = history_of(scene_of_judgement(prove(HEXAGON, ini_of(name)).judgement))
    assert history.x[0] == pytest.approx(30)
    assert history.x.max() == pytest.approx(math.sqrt(30**2 + 18**2 - 8**2), abs=0.01)
    end = math.sqrt(30**2 + 7.7942**2 - 8**2)
    assert history.x[-1] == pytest.approx(end, abs=0.01)
    turned = math.degrees(math.atan2(7.7942, 30) - math.atan2(8, end)) - 360
    assert history.c[-1] == pytest.approx(turned, abs=0.01)
    assert np.abs(np.diff(history.c)).max() < 30


def test_words_are_those_of_the_part():
    body = ("G1 X15 C0", "G91 C-5", "(DEBUG, #<_x> #5424)", "G90 X-10 C-8")
    with tracer(POLAR_TOOL_OFFSET=2) as lathe:
        traced = lathe.trace_text(section(*body))
    assert traced.error is None
    assert lines(traced) == [6, 7, 9]
    end = traced.moves[-1].end
    slide = math.sqrt(164 - 4)
    assert (end[0], end[1]) == pytest.approx((slide, 2))
    assert end[5] == pytest.approx(math.degrees(math.atan2(-8, -10) - math.atan2(2, slide)))


@pytest.mark.parametrize(
    ("body", "line", "says"),
    [
        (("G3 X-20 C0 R20",), 6, "needs a G1 with X or C before it: the tool is 2 beside"),
        (("G1 X15 C0", "X-15"), 7, "come to 0 from the spindle's centre: it is 2 beside X's"),
        (("G1 X15 C0", "X1 C1", "X15"), 7, "(POLAR_TOOL_OFFSET) and comes no nearer than 2.005"),
    ],
)
def test_refused(body, line, says):
    with tracer(POLAR_TOOL_OFFSET=-2) as lathe:
        traced = lathe.trace_text(section(*body))
    assert traced.error.text.startswith(f"G12.1 line {line}: ")
    assert says in traced.error.text
    assert not [move for move in traced.moves if move.kind != "rapid"]
