# SPDX-License-Identifier: GPL-2.0-or-later
"""The planner of holes by itself: where they are, how C turns, what is refused."""

from math import sqrt

import pytest

from g12.errors import Refusal
from g12.request.common import LEFT_OUT
from g12.request.context import Tool
from g12.shapes import holes
from g12.shapes.entries import ShapeEntries
from g12.shapes.holes import HoleMachine
from support.planner_context import MM

STANDING = MM._replace(spindle_tool=Tool(1, 3.0), x=30.0, z=10.0, speed=500.0)
MACHINE = HoleMachine(c=0.0, spindle=0, spindle_code=3, speed=500.0, beside=0.0, diameters=True)
HOLE = {"depth": 8.0, "retract": 2.0, "feed": 120.0}
PLANS = {
    "face_holes": (holes.FACE_HOLES, holes.plan_face_holes),
    "side_holes": (holes.SIDE_HOLES, holes.plan_side_holes),
    "face_hole_at": (holes.FACE_HOLE_AT, holes.plan_face_hole_at),
}
NEEDED = {
    "face_holes": {"count": 6.0, "circle_diameter": 30.0},
    "side_holes": {"count": 4.0, "z": -10.0, "surface_diameter": 40.0},
    "face_hole_at": {"x": 20.0, "c": 5.0},
}


def plan(name, found=STANDING, machine=MACHINE, **values):
    names, planner = PLANS[name]
    given = {**dict.fromkeys(names, LEFT_OUT), **NEEDED[name], **HOLE, **values}
    return planner(ShapeEntries(name, names, given), found, machine)


@pytest.mark.parametrize(
    ("c", "first", "step", "first_turn", "turn"),
    [
        (0, LEFT_OUT, LEFT_OUT, 0, 60),
        (350, 20, 60, 30, 60),
        (-720, 90, 270, 90, -90),
        (100, -100, -20, 160, -20),
        (0, 180, 180, 180, 180),
        (0, -180, -180, -180, -180),
    ],
)
def test_first_and_further_turns(c, first, step, first_turn, turn):
    found = plan("face_holes", machine=MACHINE._replace(c=c), first_angle=first, step_angle=step)
    assert (found.first_turn, found.turn) == pytest.approx((first_turn, turn))
    assert found.holes == 6 and found.position.x == 15


def test_a_hole_by_x_and_c():
    found = plan("face_hole_at")
    assert found.position.x == pytest.approx(sqrt(125))
    assert found.first_turn == pytest.approx(26.565051)
    assert plan("face_hole_at", x=LEFT_OUT, c=LEFT_OUT).position.x == 0
    radii = MACHINE._replace(diameters=False)
    assert plan("face_hole_at", machine=radii, c=0.0).position.x == 20


def test_a_tool_beside_the_x_line_stands_nearer():
    found = plan("face_holes", machine=MACHINE._replace(beside=9.0))
    assert found.position.x == pytest.approx(12)
    assert found.first_turn == pytest.approx(-36.869898)


@pytest.mark.parametrize(
    ("peck", "pecks", "step", "full", "clear"),
    [
        (LEFT_OUT, 1, 8, 0, 0),
        (3, 3, 3, 1, 0.254),
        (-3, 3, 3, 0, 0.254),
        (8, 1, 8, 1, 0.254),
        (4, 2, 4, 1, 0.254),
        (0.2, 40, 0.2, 1, 0.1),
    ],
)
def test_pecks(peck, pecks, step, full, clear):
    hole = plan("face_holes", peck=peck).hole
    assert (hole.pecks, hole.step, hole.full, hole.clear) == pytest.approx(
        (pecks, step, full, clear)
    )


def test_how_far_the_axes_go():
    face = plan("face_holes", first_angle=30).extent()
    assert face == ((15, 15), (-8, 10), (0, 330))
    side = plan("side_holes", found=STANDING._replace(x=21.0), step_angle=-20)
    assert side.travel == 2
    assert side.extent() == ((12, 22), (-10, -10), (-60, 0))


TOOLLESS = {"found": STANDING._replace(spindle_tool=None)}
REFUSED = [
    ("face_holes", TOOLLESS, "no tool is loaded"),
    ("face_holes", {"count": LEFT_OUT}, "count is missing: how many holes"),
    ("face_holes", {"count": 361}, "count 361 must be at most 360"),
    ("face_holes", {"count": 2.5}, "count 2.5 must be a whole number"),
    ("face_holes", {"circle_diameter": -1}, "circle_diameter -1 must be greater than 0"),
    ("face_holes", {"step_angle": 361}, "step_angle 361 must lie between -360 and 360"),
    ("face_holes", {"found": STANDING._replace(z=0.0)}, "Z0: the tool must be above the face"),
    ("face_holes", {"retract": LEFT_OUT}, "retract is missing: the height at which"),
    ("face_holes", {"kind": -1}, "kind -1 must be at least 0"),
    ("face_holes", {"kind": 4}, "kind 4 must be at most 3"),
    ("face_holes", {"kind": 1, "feed": LEFT_OUT}, "feed is missing: a tap's pitch"),
    ("face_holes", {"kind": 1, "peck": -1}, "peck -1 is for drilling (kind 0), not for kind 1"),
    ("face_holes", {"kind": 3, "peck": 1}, "peck 1 is for drilling (kind 0), not for kind 3"),
    ("face_holes", {"kind": 2}, "kind 2 taps a left-hand thread: the tool's spindle must turn"),
    ("face_holes", {"kind": 1, "machine": MACHINE._replace(speed=0.0)}, "kind 1 taps a right-hand"),
    ("face_holes", {"peck": 1e-4}, "count and peck make 1440018 moves, the most is 100000"),
    ("face_holes", {"feed": LEFT_OUT, "found": STANDING._replace(feed=0.0)}, "feed is missing"),
    ("face_holes", {"found": STANDING._replace(per_revolution=True, speed=0.0)}, "feed per rev"),
    ("face_holes", {"dwell": -1}, "dwell -1 must not be below 0"),
    ("face_hole_at", {"machine": MACHINE._replace(beside=-12.0)}, "the hole is 11.18034 from"),
    ("side_holes", {"z": LEFT_OUT}, "z is missing: where the holes are along the part"),
    ("side_holes", {"surface_diameter": 60}, "X30 (radius): the tool must be outside"),
    ("side_holes", {"machine": MACHINE._replace(beside=1.0)}, "needs a tool on the X line"),
]


@pytest.mark.parametrize(("name", "wrong", "rule"), REFUSED)
def test_what_is_refused(name, wrong, rule):
    plan(name)
    with pytest.raises(Refusal) as refused:
        plan(name, **wrong)
    assert str(refused.value).startswith(f"{name}: {rule}")
