# SPDX-License-Identifier: GPL-2.0-or-later
"""How far the cycles go on the machine, and what is refused for it, without LinuxCNC."""

import math

import pytest

from g12.cycles import circle_mill, haas, mitsubishi, yasnac
from g12.errors import Refusal
from g12.lengths import MM_PER_INCH
from g12.request.travel import CycleExtent, MachineFrame, check_travel
from g12.request.words import Words
from support.planner_context import MM

AXES = {
    "X": (-100.0, 300.0),
    "Y": (-200.0, 200.0),
    "Z": (-50.0, 60.0),
}
PLAIN = MachineFrame((0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), 1.0, 1.0)


def refusal(extent, frame=PLAIN, axes=AXES):
    """Return why a cycle is refused, None if it stays within the limits."""
    try:
        check_travel(Words("G12", {}), extent, frame, axes)
    except Refusal as refused:
        return refused.message
    return None


@pytest.mark.parametrize(
    ("x", "y", "radius", "rule"),
    [
        (200, 0, 100 + 1e-9, None),
        (200, 0, 100.01, "the X axis would go to 300.01 mm, beyond its limit 300 mm"),
        (100, 150, 51, "the Y axis would go to 201 mm, beyond its limit 200 mm"),
        (100, -150, 51, "the Y axis would go to -201 mm, beyond its limit -200 mm"),
    ],
)
def test_a_circle_that_leaves_the_limits_is_refused(x, y, radius, rule):
    said = refusal(CycleExtent("G17", (x, y, 0.0), radius))
    assert said == (rule and f"G12: {rule}")


@pytest.mark.parametrize(("height", "limit"), [(-51, -50), (61, 60)])
def test_every_height_is_looked_at(height, limit):
    assert refusal(CycleExtent("G17", (0, 0, 0), 5, (-50.0, 60.0))) is None
    said = refusal(CycleExtent("G17", (0, 0, 0), 5, (2.0, height, -3.0)))
    assert said == f"G12: the Z axis would go to {height} mm, beyond its limit {limit} mm"


def test_offsets_rotation_and_tool_are_those_of_the_machine():
    frame = MachineFrame((10.0, 0.0, -1.0), 90.0, (100.0, 50.0, 20.0), 1.0, 1.0)
    assert frame.position((30.0, 7.0, 2.0)) == pytest.approx((100 - 7, 50 + 40, 21))
    said = refusal(CycleExtent("G17", (30.0, 7.0, 2.0), 111.0), frame)
    assert said == "G12: the Y axis would go to 201 mm, beyond its limit 200 mm"


@pytest.mark.parametrize("plane", ["G17", "G18", "G19"])
@pytest.mark.parametrize("rotation", [0, 30, -75, 200])
def test_the_widths_are_those_of_every_point_of_the_circle(plane, rotation):
    frame = MachineFrame((1.0, 2.0, 3.0), rotation, (4.0, 5.0, 6.0), 1 / MM_PER_INCH, MM_PER_INCH)
    extent = CycleExtent(plane, (7.0, 8.0, 9.0), 25.0)
    turns = [math.radians(degrees / 10) for degrees in range(3600)]
    along = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}[plane]
    points = []
    for turn in turns:
        point = list(extent.centre)
        point[along[0]] += 25.0 * math.cos(turn)
        point[along[1]] += 25.0 * math.sin(turn)
        points.append(frame.position(point))
    centre = frame.position(extent.centre)
    for axis, width in enumerate(frame.half_widths(extent)):
        reached = max(abs(point[axis] - centre[axis]) for point in points)
        assert reached == pytest.approx(width, abs=1e-5)


@pytest.mark.parametrize(
    ("unit", "millimetres", "reported"),
    [
        (MM_PER_INCH, 1.0, "381 mm, beyond its limit 300 mm (G20 is active)"),
        (1 / MM_PER_INCH, MM_PER_INCH, "15 in, beyond its limit 11 in (G21 is active)"),
    ],
)
def test_the_machines_unit_is_told(unit, millimetres, reported):
    frame = PLAIN._replace(unit=unit, millimetres=millimetres)
    high = 300.0 if millimetres == 1.0 else 11.0
    axes = dict.fromkeys("XYZ", (-1000.0, high))
    size = 15.0 if unit != 1 / MM_PER_INCH else 15.0 * MM_PER_INCH
    said = refusal(CycleExtent("G17", (size - 1.0, 0.0, 0.0), 1.0), frame, axes)
    assert said == f"G12: the X axis would go to {reported}"


def test_the_extent_of_every_dialect():
    deep = MM._replace(incremental=True)
    pocket = haas.plan_pocket(Words("G12", dict(I=20, K=50, Q=5, Z=-4, L=3, D=2)), deep)
    assert pocket.extent() == CycleExtent("G17", (0, 0, 6), 40, (6, -2))
    circle = yasnac.plan_circle(Words("G12", dict(I=-50, R=-40, D=2)), MM)
    assert circle.extent(MM.z) == CycleExtent("G17", (0, 0, 10), 40)
    upright = MM._replace(plane="G18")
    circle = mitsubishi.plan_circle(Words("G12", dict(I=-50, D=2)), upright)
    assert circle.extent(upright) == CycleExtent("G18", (0, 0, 10), 40)


@pytest.mark.parametrize(
    ("words", "pocket", "radius"),
    [
        (dict(H=2, Q=0.5), True, 38.0),
        (dict(H=1, Q=0.5), False, 50.5 + 12 - 0.5),
    ],
)
def test_the_extent_of_the_event(words, pocket, radius):
    found = MM._replace(spindle_tool=MM.tool_in_table(1)._replace(radius=12.0))
    values = Words("G12.2", dict(X=3, Y=4, Z=-9, I=2, E=5, R=50, **words))
    event = circle_mill.plan_code(values, found, None, pocket)
    expected = radius + (0.5 if not pocket and "Q" in words else 0.0)
    assert event.extent() == CycleExtent("G17", (3, 4, -9), expected, (2, 5, -9))
