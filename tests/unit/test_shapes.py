# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of shapes and holes without LinuxCNC: a call is planned or refused by name."""

import math
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.errors import Refusal, number
from g12.request import LEFT_OUT
from g12.shapes import holes, pockets, polygon
from g12.shapes.entries import ShapeEntries, ShapeMachine
from g12.shapes.holes import HoleMachine
from g12.state import Tool
from support.planner_context import MM, reported

FOUND = MM._replace(x=30.0, z=5.0, speed=500.0, spindle_tool=Tool(3, 3.0))
LATHE = ShapeMachine(False, 3.0, 1.0, 0.0025, False)
LIVE = HoleMachine(c=0.0, spindle=0, spindle_code=3, speed=500.0, beside=0.0, diameters=True)
PLANS = {
    "polar_polygon": (polygon.POLYGON_ENTRIES, polygon.plan_polygon),
    "polar_slot": (pockets.SLOT_ENTRIES, pockets.plan_slot),
    "polar_pocket": (pockets.ROUND_POCKET_ENTRIES, pockets.plan_round_pocket),
    "face_holes": (holes.FACE_HOLES, holes.plan_face_holes),
    "side_holes": (holes.SIDE_HOLES, holes.plan_side_holes),
    "face_hole_at": (holes.FACE_HOLE_AT, holes.plan_face_hole_at),
}
HOLE = dict(depth=8, retract=2, feed=120)
EXAMPLES = {
    "polar_polygon": dict(sides=6, across_flats=27, depth=5, stock_diameter=40, feed=400),
    "polar_slot": dict(width=20, length=45, depth=4, feed=400),
    "polar_pocket": dict(x=10, c=3, diameter=16, depth=4, feed=400),
    "face_holes": dict(count=6, circle_diameter=30, **HOLE),
    "side_holes": dict(count=4, z=-10, surface_diameter=40, **HOLE),
    "face_hole_at": dict(x=20, c=5, **HOLE),
}
SHAPES = list(EXAMPLES)[:3]


def planned(name, machine=None, found=FOUND, **entries):
    """Return the plan of a call; entries that are not named are those of the example."""
    names, planner = PLANS[name]
    values = {**dict.fromkeys(names, LEFT_OUT), **EXAMPLES[name], **entries}
    assert tuple(values) == names
    machine = machine or (LATHE if name in SHAPES else LIVE)
    return planner(ShapeEntries(name, names, values, found), machine)


def numbers_of(*arguments, **entries):
    return planned(*arguments, **entries).locals


refusal = partial(reported, planned)


def taken(numbers, *names):
    return tuple(numbers[name] for name in names)


ANY = st.sampled_from([LEFT_OUT, 0.0, -1.0, 1e-9, 2.0, 1e9]) | st.floats(-5, 60)


@pytest.mark.parametrize("name", PLANS)
@given(changed=st.dictionaries(st.integers(0, 10), ANY))
def test_any_entries_are_planned_or_refused_by_name(name, changed):
    """Those of the example, but for some of them or all."""
    names, _ = PLANS[name]
    entries = {names[index]: value for index, value in changed.items() if index < len(names)}
    try:
        made = planned(name, **entries)
    except Refusal as refusal:
        assert refusal.message.startswith(f"{name}: ") and len(refusal.message) <= 255
    else:
        assert all(math.isfinite(value) for value in made.locals.values())
        low, high = zip(*made.extent)
        assert all(least <= most for least, most in zip(low, high))
        assert low[0] >= 0 or name == "side_holes"  # a cross hole leads beyond the axis


# ---------------------------------------------------------------- refusals

STILL = FOUND._replace(feed=0.0)
TURNING = FOUND._replace(per_revolution=True, speed=0.0)
IN_MM = dict(found=FOUND._replace(machine_mm=25.4))  # G21 on a machine in inches
ABOVE = "a shape begins at the tool's position, which must be above the face at Z0"
HELIX = "must leave the cutter room for a helix: at least 6.01016 and twice the allowance"
CALL = "(a call has {} entries, -9999 leaves one out)"
REFUSED = [
    *((shape, entries, rule) for shape in SHAPES for entries, rule in (
        (dict(depth=1.0001, depth_per_pass=1e-4),
         "depth_per_pass 0.0001 makes 10001 passes of depth 1.0001, the most is 10000"),
        (dict(found=FOUND._replace(z=0.0)), f"Z0: {ABOVE}"),
        (dict(found=FOUND._replace(z=-1.0)), f"Z-1: {ABOVE}"),
        (dict(found=TURNING), "feed per revolution (G95) needs the spindle speed S"),
        (dict(found=STILL, feed=LEFT_OUT), "feed is missing, and no F is active"),
        (dict(depth=LEFT_OUT), "depth is missing: how deep, from the face at Z0"),
    )),
    ("polar_slot", dict(angle=361), "angle 361 must lie between -360 and 360"),
    ("polar_slot", dict(width=0), f"width 0 must be greater than 0 {CALL.format(8)}"),
    ("polar_slot", dict(length=20),
     "length 20 must be greater than width 20 (polar_pocket makes a round one)"),
    ("polar_slot", dict(width=5.9999), "width 5.9999 must not be less than the cutter's 6"),
    ("polar_slot", dict(width=8, allowance=1.001, **IN_MM),
     "allowance 1.001: the cutter of 6 mm does not fit between the walls that it leaves"),
    ("polar_slot", dict(allowance=0.00507), "allowance 0.00507 must be at least 0.00508"),
    ("polar_slot", dict(allowance=-0.1), "allowance -0.1 must not be below 0"),
    ("polar_slot", dict(allowance=4.6, **IN_MM),
     "allowance 4.6 must be at most 4.5, what one round of the cutter of 6 mm takes"),
    ("polar_pocket", dict(diameter=5.9), "diameter 5.9 must not be less than the cutter's 6"),
    ("polar_pocket", dict(diameter=6.0101), f"diameter 6.0101 {HELIX}"),
    ("polar_pocket", dict(diameter=7, allowance=0.5), f"diameter 7 {HELIX}"),
    ("polar_polygon", dict(depth=0), f"depth 0 must be greater than 0 {CALL.format(10)}"),
    ("polar_polygon", dict(stock_diameter=27),
     "stock_diameter 27 must be greater than across_flats 27"),
    ("polar_polygon", dict(corner_radius=13.5),
     "corner_radius 13.5 must be less than half of across_flats 27"),
    ("polar_polygon", dict(sides=2, corner_radius=1), "corner_radius 1: two flats have no corners"),
    ("polar_polygon", dict(sides=101), "sides 101 must be at most 100"),
    ("polar_polygon", dict(stock_diameter=30, allowance=1.5),
     "allowance 1.5 must be less than the 1.5 from the stock to the flats"),
    ("polar_polygon", dict(allowance=4.6, stock_diameter=40),
     "allowance 4.6 must be at most 4.5, what one round of the cutter of 6 takes"),
    ("face_holes", dict(found=FOUND._replace(spindle_tool=None)), "no tool is loaded"),
    ("face_holes", dict(count=361), "count 361 must be at most 360"),
    ("face_holes", dict(found=FOUND._replace(z=0.0)),
     "Z0: the tool must be above the face at Z0"),
    ("face_holes", dict(kind=4), "kind 4 must be at most 3"),
    ("face_holes", dict(kind=1, peck=-1), "peck -1 is for drilling (kind 0), not for kind 1"),
    ("face_holes", dict(kind=2),
     "kind 2 taps a left-hand thread: the tool's spindle must turn, by M4 and S"),
    ("face_holes", dict(kind=1, machine=LIVE._replace(speed=0.0)),
     "kind 1 taps a right-hand thread: the tool's spindle must turn, by M3 and S"),
    ("face_holes", dict(peck=1e-4), "count and peck make 1440018 moves, the most is 100000"),
    ("face_hole_at", dict(machine=LIVE._replace(beside=-12.0)),
     "the hole is 11.18034 from the spindle's axis, where [G12] POLAR_TOOL_OFFSET"
     " lets the tool no nearer than 12"),
    ("side_holes", dict(first_angle=-361), "first_angle -361 must lie between -360 and 360"),
    ("side_holes", dict(surface_diameter=60),
     "X30 (radius): the tool must be outside the surface, beyond 30"),
    ("side_holes", dict(machine=LIVE._replace(beside=1.0)),
     "needs a tool on the X line, not [G12] POLAR_TOOL_OFFSET beside it"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "wrong", "rule"), REFUSED)
def test_a_bad_call_is_refused_by_name(name, wrong, rule):
    planned(name)
    assert refusal(name, **wrong) == f"{name}: {rule}"


# ---------------------------------------------------------------- slots and pockets


def rough_radii(numbers):
    first, step = numbers["first_ring"], numbers["ring_step"]
    return [first + index * step for index in range(numbers["further"] + 1)]


def test_a_cutter_as_wide_as_the_slot_goes_along_its_line():
    """Nothing but rounding, or less than a ring that LinuxCNC can cut, is left beside it."""
    rings = ("first_ring", "ring_step", "further")
    for width in (6.0, 6.0 - 1e-6, 6.0101):
        numbers = numbers_of("polar_slot", width=width, length=30)
        assert taken(numbers, *rings) == (0.0, 0.0, 0)
    assert numbers_of("polar_slot", width=6.0103, length=30)["first_ring"] > 0.005
    narrow = numbers_of("polar_slot", width=6.4, length=30, allowance=0.2)
    assert taken(narrow, *rings) == (0.0, 0.0, 0)


def test_a_way_down_that_never_ends_is_refused():
    """0.01 round about the centre at 3 degrees falls by 0.0016 each half turn."""
    fall = math.pi * 0.01 * math.tan(math.radians(3))
    fits, too_deep = (turns * fall - 1.0 for turns in (19_999.5, 20_000.5))
    assert numbers_of("polar_pocket", diameter=6.02, depth=fits)["first_turns"] == 20_000
    rule = "a ramp of 3 degrees needs more than 20000 half turns of 0.031416 for a pass"
    assert refusal("polar_pocket", diameter=6.02, depth=too_deep) == f"polar_pocket: {rule}"


THIN = FOUND._replace(spindle_tool=Tool(3, 0.03))


REFUSING = LATHE._replace(pole_refused=True)


@pytest.mark.parametrize("allowance", [LEFT_OUT, 0.3])
def test_no_ring_of_a_pocket_passes_through_the_centre_where_that_is_refused(allowance):
    entries = dict(c=LEFT_OUT, diameter=30, allowance=allowance)
    radii = rough_radii(numbers_of("polar_pocket", **entries))
    assert len(radii) >= 3
    for radius in (*radii, 12.0):
        for x in (radius - 0.002, radius + 0.002):
            planned("polar_pocket", x=x, **entries)
            assert refusal("polar_pocket", REFUSING, x=x, **entries) == (
                "polar_pocket: a ring of the tool's centre would pass through the spindle's"
                f" centre, {number(x)} away, which [G12] POLAR_POLE = refuse forbids:"
                " change the diameter or the cutter"
            )
        for x in (radius - 0.003, radius + 0.003):
            planned("polar_pocket", REFUSING, x=x, **entries)


@pytest.mark.parametrize(
    ("width", "length", "through"),
    [(6, 30, True), (6.02, 30, False), (20, 20.004, True), (20, 20.006, False)],
)
def test_no_slot_leads_through_the_centre_where_that_is_refused(width, length, through):
    if not through:
        planned("polar_slot", REFUSING, width=width, length=length)
        return
    assert refusal("polar_slot", REFUSING, width=width, length=length) == (
        f"polar_slot: width {width}: the cutter of 6 would pass"
        " through the spindle's centre, which [G12] POLAR_POLE = refuse forbids"
    )


# ---------------------------------------------------------------- polygons


@pytest.mark.parametrize("sides", [2, 100])
def test_rounds_without_number_are_refused(sides):
    """Each has a line and an arc for every side, and six moves in and out."""
    entries = dict(sides=sides, depth=8)
    moves = numbers_of("polar_polygon", LATHE, THIN, **entries)["rounds"] * (2 * sides + 6)
    most = 100_000 // moves
    assert planned("polar_polygon", LATHE, THIN, depth_per_pass=8 / most, **entries)
    assert refusal("polar_polygon", LATHE, THIN, depth_per_pass=8 / (most + 1), **entries) == (
        f"polar_polygon: stock_diameter and depth_per_pass make {(most + 1) * moves} moves,"
        " the most is 100000"
    )


# ---------------------------------------------------------------- holes


def test_how_far_the_axes_go_to_holes():
    assert planned("face_holes", first_angle=30).extent == ((15, 15), (-8, 5), (0, 330))
    side = planned("side_holes", found=FOUND._replace(x=21.0), step_angle=-20)
    assert side.locals["travel"] == 2
    assert side.extent == ((12, 22), (-10, -10), (-60, 0))


@pytest.mark.parametrize(
    ("peck", "expected"),
    [
        (LEFT_OUT, (1, 8, 0, 0)),
        (3, (3, 3, 1, 0.254)),
        (-3, (3, 3, 0, 0.254)),
        (8, (1, 8, 1, 0.254)),
        (4, (2, 4, 1, 0.254)),
        (0.2, (40, 0.2, 1, 0.1)),
    ],
)
def test_pecks(peck, expected):
    numbers = numbers_of("face_holes", peck=peck)
    assert taken(numbers, "pecks", "step", "full", "clear") == pytest.approx(expected)


@pytest.mark.parametrize(
    ("entries", "outside"),
    [
        (dict(sides=3, across_flats=30, stock_diameter=44), 22 + 3 + 1),
        (dict(sides=2, across_flats=20, stock_diameter=30), 15 + 3 + 1),
        (dict(corner_radius=2), 20 + 3 + 1),
        # the first round of a small triangle in a large bar is 4.25 less deep than the stock
        (dict(sides=3, across_flats=16, stock_diameter=50), 16 + (25 + 3 - 4.25) - 8),
    ],
)
def test_rounds_begin_clear_of_the_stock_and_of_every_corner(entries, outside):
    """Corners that would lie beyond the stock are not there."""
    made = planned("polar_polygon", **entries)
    assert made.locals["outside"] == made.extent.x[1] == pytest.approx(outside)
