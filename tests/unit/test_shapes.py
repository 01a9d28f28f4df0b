# SPDX-License-Identifier: GPL-2.0-or-later
"""The planners of the shapes by themselves: whatever a call says is planned or refused by name."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.errors import Refusal, number
from g12.request.common import LEFT_OUT
from g12.request.context import Tool
from g12.shapes import polygon, round_pocket, slot
from g12.shapes.entries import ShapeEntries, ShapeMachine, check_nearest
from g12.shapes.rings import half_turns_in_all
from support.planner_context import MM

FOUND = MM._replace(z=5.0, spindle_tool=Tool(3, 3.0))
LATHE = ShapeMachine(False, 3.0, 1.0, 0.0025, False)
PLANS = {
    "polar_polygon": (polygon.POLYGON_ENTRIES, polygon.plan_polygon),
    "polar_slot": (slot.SLOT_ENTRIES, slot.plan_slot),
    "polar_pocket": (round_pocket.ROUND_POCKET_ENTRIES, round_pocket.plan_round_pocket),
}
ANY = st.sampled_from([LEFT_OUT, 0.0, -1.0, 1e-9, 2.0, 1e9]) | st.floats(-5, 60)


HEXAGON = dict(
    sides=6, across_flats=27, depth=5, stock_diameter=40, corner_radius=LEFT_OUT,
    depth_per_pass=LEFT_OUT, allowance=LEFT_OUT, feed=400, plunge_feed=LEFT_OUT, angle=LEFT_OUT,
)  # fmt: skip
SLOT = dict(
    width=20, length=45, depth=4, depth_per_pass=LEFT_OUT, allowance=LEFT_OUT, feed=400,
    plunge_feed=LEFT_OUT, angle=LEFT_OUT,
)  # fmt: skip
POCKET = dict(
    x=10, c=3, diameter=16, depth=4, depth_per_pass=LEFT_OUT, allowance=LEFT_OUT, feed=400,
    plunge_feed=LEFT_OUT,
)  # fmt: skip
EXAMPLES = {"polar_polygon": HEXAGON, "polar_slot": SLOT, "polar_pocket": POCKET}


def planned(shape, machine=LATHE, found=FOUND, **entries):
    """Return the plan of a shape; entries that are not named are those of the example."""
    names, planner = PLANS[shape]
    values = {**EXAMPLES[shape], **entries}
    assert tuple(values) == names
    return planner(ShapeEntries(shape, names, values), found, machine)


def refusal(*arguments, **entries):
    with pytest.raises(Refusal) as refused:
        planned(*arguments, **entries)
    return refused.value.message


@pytest.mark.parametrize("shape", PLANS)
@given(changed=st.dictionaries(st.integers(0, 9), ANY))
def test_any_entries_are_planned_or_refused_by_name(shape, changed):
    """Those of the example, but for some of them or all."""
    entries = {
        name: changed.get(k, value) for k, (name, value) in enumerate(EXAMPLES[shape].items())
    }
    try:
        made = planned(shape, **entries)
    except Refusal as refusal:
        assert refusal.message.startswith(f"{shape}: ") and len(refusal.message) <= 255
    else:
        assert all(math.isfinite(value) for value in made.locals().values())
        low, high = zip(*made.extent())
        assert all(least <= most for least, most in zip(low, high)) and low[0] >= 0


def test_a_polygon_turns_c_once_with_every_round():
    made = planned("polar_polygon", depth_per_pass=2, allowance=0.5, angle=0)
    turns = made.levels.levels * made.rounds.rounds + 1
    low, high = made.extent().c
    assert turns == 3 * 2 + 1
    assert 30 <= high < 90 and -360 * turns - 60 < low <= 30 - 360 * turns


def test_x_of_a_pocket_is_a_diameter_where_x_words_are():
    made = planned("polar_pocket", LATHE._replace(diameters=True), x=20)
    assert made.away == math.hypot(10, 3)
    assert planned("polar_pocket", x=20).away == math.hypot(20, 3)


def test_a_polygon_keeps_its_allowance_for_one_more_round():
    for allowance, finish in ((LEFT_OUT, 0), (0.0, 0), (0.5, 1)):
        rounds = planned("polar_polygon", allowance=allowance).rounds
        rough = rounds.apothem - (rounds.rounds - 1) * rounds.step
        assert rough == pytest.approx(13.5 + 3 + max(allowance, 0))
        assert (rounds.finish, rounds.finish_apothem) == (finish, 13.5 + 3)


# ---------------------------------------------------------------- what every shape has


@pytest.mark.parametrize("shape", EXAMPLES)
class TestEveryShape:
    def test_passes_that_never_end_are_refused(self, shape):
        assert refusal(shape, depth=1.0001, depth_per_pass=1e-4) == (
            f"{shape}: depth_per_pass 0.0001 makes 10001 passes of depth 1.0001, the most is 10000"
        )

    def test_a_feed_is_that_of_the_call_or_the_active_one(self, shape):
        assert planned(shape).feeds == (400, 400)
        assert planned(shape, feed=LEFT_OUT).feeds == (300, 300)
        slower = LATHE._replace(plunge_share=0.25)
        assert planned(shape, slower).feeds == (400, 100)
        assert planned(shape, slower, plunge_feed=90).feeds == (400, 90)

    def test_it_goes_on_at_a_feed_from_a_millimetre_above_the_face(self, shape):
        assert planned(shape).heights == (5.0, 1.0)
        assert planned(shape, found=FOUND._replace(z=0.3)).heights == (0.3, 0.3)
        inches = FOUND._replace(inch=True, spindle_tool=Tool(3, 3.0))
        assert planned(shape, found=inches).heights == (5.0, pytest.approx(1 / 25.4))

    def test_it_never_begins_at_the_face_or_below(self, shape):
        rule = "a shape begins at the tool's position, which must be above the face at Z0"
        for z in (0.0, -1.0):
            assert refusal(shape, LATHE, FOUND._replace(z=z)) == f"{shape}: Z{z:g}: {rule}"
        assert planned(shape, found=FOUND._replace(z=1e-3)).heights.near_z == 1e-3

    def test_feed_per_revolution_needs_a_speed(self, shape):
        turning = FOUND._replace(per_revolution=True)
        rule = "feed per revolution (G95) needs the spindle speed S"
        assert refusal(shape, LATHE, turning) == f"{shape}: {rule}"
        assert planned(shape, found=turning._replace(speed=1e-3)).feeds.feed == 400

    def test_without_any_feed(self, shape):
        still = FOUND._replace(feed=0.0)
        rule = "feed is missing, and no F is active"
        assert refusal(shape, LATHE, still, feed=LEFT_OUT) == f"{shape}: {rule}"
        assert planned(shape, found=still, feed=0.5).feeds.feed == 0.5

    def test_an_allowance_that_one_round_does_not_take_would_stand(self, shape):
        size = dict(polar_polygon="stock_diameter", polar_slot="width", polar_pocket="diameter")
        wide = {size[shape]: 40.0}
        assert planned(shape, allowance=4.5, **wide)
        assert refusal(shape, allowance=4.6, **wide) == (
            f"{shape}: allowance 4.6 must be at most 4.5, what one round of the cutter of 6 takes"
        )

    def test_it_comes_no_nearer_to_the_centre_than_a_tool_beside_x_can(self, shape):
        names, _ = PLANS[shape]
        entries = ShapeEntries(shape, names, EXAMPLES[shape])
        extent = planned(shape).extent()
        check_nearest(entries, extent, LATHE._replace(nearest=extent.x[0]))
        with pytest.raises(Refusal, match="POLAR_TOOL_OFFSET lets it no nearer than"):
            check_nearest(entries, extent, LATHE._replace(nearest=extent.x[0] + 1e-6))


def test_an_angle_is_at_most_a_whole_turn():
    for angle in (360, -360):
        assert planned("polar_slot", angle=angle).start_angle == angle
    rule = "must lie between -360 and 360"
    assert refusal("polar_slot", angle=361) == f"polar_slot: angle 361 {rule}"
    assert refusal("polar_slot", angle=-360.5) == f"polar_slot: angle -360.5 {rule}"


# ---------------------------------------------------------------- slots and pockets

HOLES = [
    (shape, tool, {name: size}, allowance)
    for shape, name in (("polar_slot", "width"), ("polar_pocket", "diameter"))
    for tool in (2.0, 6.0)
    for size in (tool + 0.5, 8.0, 11.3, 30.0)
    for allowance in (LEFT_OUT, 0.2)
]


def hole(shape, tool, size, allowance, **found):
    found = FOUND._replace(spindle_tool=Tool(3, tool / 2), **found)
    return planned(shape, LATHE, found, allowance=allowance, depth_per_pass=1.5, **size)


@pytest.mark.parametrize(("shape", "tool", "size", "allowance"), HOLES)
def test_rings_lead_outward_to_the_wall_and_leave_no_core(shape, tool, size, allowance):
    rings = hole(shape, tool, size, allowance).rings
    (expected,), left = size.values(), max(allowance, 0)
    rough = [rings.first_ring + index * rings.ring_step for index in range(rings.further + 1)]
    assert rough[-1] == pytest.approx((expected - tool) / 2 - left)
    assert 0 < rough[0] <= 0.9 * tool / 2
    assert np.all(np.diff(rough) > 0) and np.all(np.diff(rough) <= 0.75 * tool)
    assert rings.further < 1 + (rough[-1] - rough[0]) / (0.75 * tool)  # no more than needed
    assert rings.finish == (left > 0)
    assert rings.largest == pytest.approx((expected - tool) / 2)


@pytest.mark.parametrize(("shape", "tool", "size", "allowance"), HOLES)
def test_the_ramp_comes_down_in_as_few_half_turns_as_its_slope_lets(shape, tool, size, allowance):
    made = hole(shape, tool, size, allowance)
    ramp, levels = made.ramp, made.levels
    line = 45 - size["width"] if shape == "polar_slot" else 0.0
    half_turn = line + math.pi * made.rings.first_ring
    steepest = half_turn * math.tan(math.radians(LATHE.entry_angle))
    heights = (made.heights.near_z + levels.step_down, levels.step_down)
    ways = ((ramp.first_turns, ramp.first_fall), (ramp.next_turns, ramp.next_fall))
    for height, (turns, fall) in zip(heights, ways):
        assert turns * fall == pytest.approx(height)
        assert fall <= steepest * (1 + 1e-9)
        assert (turns - 1) * steepest < height
    assert ramp.line_share == pytest.approx(line / half_turn)


def test_a_cutter_as_wide_as_the_slot_goes_along_its_line():
    """Nothing but rounding, or less than a ring that LinuxCNC can cut, is left beside it."""
    for width in (6.0, 6.0 - 1e-6, 6.0101):
        rings = planned("polar_slot", width=width, length=30).rings
        assert (rings.first_ring, rings.further) == (0.0, 0)
        assert rings.largest == 0.0
    assert planned("polar_slot", width=6.0103, length=30).rings.first_ring > 0.005
    assert planned("polar_slot", width=6.4, length=30, allowance=0.2).rings[:3] == (0.0, 0.0, 0)
    rule = "width 5.9999 must not be less than the cutter's 6"
    assert refusal("polar_slot", width=5.9999, length=30) == f"polar_slot: {rule}"


def test_a_cutter_fits_between_the_walls_that_an_allowance_leaves():
    assert planned("polar_slot", width=8, length=30, allowance=1)
    rule = "allowance 1.001: the cutter of 6 does not fit between the walls that it leaves"
    assert refusal("polar_slot", width=8, length=30, allowance=1.001) == f"polar_slot: {rule}"


def test_a_pocket_is_no_smaller_than_the_cutter():
    rule = "diameter 5.9 must not be less than the cutter's 6"
    assert refusal("polar_pocket", diameter=5.9) == f"polar_pocket: {rule}"


def test_an_allowance_is_none_or_one_that_linuxcnc_can_cut():
    assert planned("polar_slot", allowance=0).rings.finish == 0
    assert planned("polar_slot", allowance=0.00508).rings.finish == 1
    rule = "allowance 0.00507 must be at least 0.00508"
    assert refusal("polar_slot", allowance=0.00507) == f"polar_slot: {rule}"
    assert refusal("polar_slot", allowance=-0.1) == "polar_slot: allowance -0.1 must not be below 0"


def test_a_pocket_has_room_for_a_helix():
    assert planned("polar_pocket", diameter=6.01016).rings.first_ring == pytest.approx(0.00508)
    rule = "must leave the cutter room for a helix: at least 6.01016 and twice the allowance"
    assert refusal("polar_pocket", diameter=6.0101) == f"polar_pocket: diameter 6.0101 {rule}"
    message = f"polar_pocket: diameter 7 {rule}"
    assert refusal("polar_pocket", diameter=7, allowance=0.5) == message


def test_a_way_down_that_never_ends_is_refused():
    """0.01 round about the centre at 3 degrees falls by 0.0016 each half turn."""
    fall = math.pi * 0.01 * math.tan(math.radians(3))
    fits, too_deep = (turns * fall - 1.0 for turns in (19_999.5, 20_000.5))
    assert planned("polar_pocket", diameter=6.02, depth=fits).ramp.first_turns == 20_000
    rule = "a ramp of 3 degrees needs more than 20000 half turns of 0.031416 for a pass"
    assert refusal("polar_pocket", diameter=6.02, depth=too_deep) == f"polar_pocket: {rule}"


THIN = FOUND._replace(spindle_tool=Tool(3, 0.03))


@pytest.mark.parametrize(("shape", "per_half_turn"), [("polar_pocket", 1), ("polar_slot", 2)])
def test_half_turns_without_number_are_refused(shape, per_half_turn):
    """A tool typed a thousand times too small must not hang the preview."""

    def moves(levels):
        made = planned(shape, LATHE, THIN, depth=0.5 * levels, depth_per_pass=0.5)
        return per_half_turn * half_turns_in_all(made.rings, made.levels, made.ramp)

    per_level = moves(3) - moves(2)
    most = 2 + (100_000 - moves(2)) // per_level
    assert moves(most) <= 100_000
    count = moves(most) + per_level
    deeper = dict(depth=0.5 * (most + 1), depth_per_pass=0.5)
    assert refusal(shape, LATHE, THIN, **deeper) == (
        f"{shape}: depth_per_pass makes {count} moves, the most is 100000"
    )


@pytest.mark.parametrize("sides", [2, 6, 100])
def test_rounds_without_number_are_refused(sides):
    """Each has a line and an arc for every side, and six moves in and out."""
    entries = dict(sides=sides, depth=8)
    rounds = planned("polar_polygon", LATHE, THIN, **entries).rounds.rounds
    moves = rounds * (2 * sides + 6)
    most = 100_000 // moves
    assert planned("polar_polygon", LATHE, THIN, depth_per_pass=8 / most, **entries)
    assert refusal("polar_polygon", LATHE, THIN, depth_per_pass=8 / (most + 1), **entries) == (
        f"polar_polygon: stock_diameter and depth_per_pass make {(most + 1) * moves} moves,"
        " the most is 100000"
    )


def test_passes_of_a_polygon_may_be_ten_thousand():
    flats = dict(sides=2, across_flats=36, depth=1, depth_per_pass=1e-4)
    assert planned("polar_polygon", **flats).levels.levels == 10_000


@pytest.mark.parametrize(
    ("shape", "entries", "x", "back", "on"),
    [
        ("polar_slot", dict(angle=30, depth_per_pass=2), (2.7, 12.5 + 7), 0, None),
        ("polar_slot", dict(angle=0, width=6, length=30), (0, 12), 180, None),  # to and fro
        ("polar_slot", dict(angle=0, width=20, length=21), (0.5, 7.5), 0, None),
        ("polar_pocket", dict(x=10, c=0), (5, 15), 90, 90),  # C swings
        ("polar_pocket", dict(x=0, c=20), (15, 25), 90, 90),
        ("polar_pocket", dict(x=5, c=0), (0, 10), 180, None),  # round the centre
    ],
)
def test_how_far_the_axes_go(shape, entries, x, back, on):
    """From where a shape begins C goes back and on; with each half turn on by half a turn."""
    made = planned(shape, **entries)
    turned = 180 * (half_turns_in_all(made.rings, made.levels, made.ramp) + 1)
    extent = made.extent()
    assert (extent.x, extent.z) == (pytest.approx(x), (-4.0, 5.0))
    start = made.start_angle
    assert extent.c == pytest.approx((start - back, start + (turned if on is None else on)))


def test_a_slot_is_longer_than_wide():
    rule = "length 20 must be greater than width 20 (polar_pocket makes a round one)"
    assert refusal("polar_slot", width=20, length=20) == f"polar_slot: {rule}"
    assert planned("polar_slot", width=20, length=20.01).end_distance == pytest.approx(0.005)


REFUSING = LATHE._replace(pole_refused=True)


@pytest.mark.parametrize("allowance", [LEFT_OUT, 0.3])
def test_no_ring_of_a_pocket_passes_through_the_centre_where_that_is_refused(allowance):
    entries = dict(c=LEFT_OUT, diameter=30, allowance=allowance)
    rings = planned("polar_pocket", **entries).rings
    radii = [rings.first_ring + index * rings.ring_step for index in range(rings.further + 1)]
    assert len(radii) >= 3
    for radius in (*radii, 12.0):
        for x in (radius - 0.002, radius, radius + 0.002):
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


@pytest.mark.parametrize(
    ("entries", "outside"),
    [
        (dict(sides=3, across_flats=30, stock_diameter=44), 22 + 3 + 1),
        (dict(sides=2, across_flats=20, stock_diameter=30), 15 + 3 + 1),
        (dict(sides=4, across_flats=20, stock_diameter=20.1), 10.05 + 3 + 1),
        (dict(corner_radius=2), 20 + 3 + 1),
        # the first round of a small triangle in a large bar is 4.25 less deep than the stock
        (dict(sides=3, across_flats=16, stock_diameter=50), 16 + (25 + 3 - 4.25) - 8),
    ],
)
def test_rounds_begin_clear_of_the_stock_and_of_every_corner(entries, outside):
    """Corners that would lie beyond the stock are not there."""
    made = planned("polar_polygon", **entries)
    assert made.rounds.outside == pytest.approx(outside)
    assert made.extent().x[1] == made.rounds.outside


def test_where_a_polygon_cannot_be():
    for entries, rule in (
        (dict(stock_diameter=27), "stock_diameter 27 must be greater than across_flats 27"),
        (dict(corner_radius=13.5), "corner_radius 13.5 must be less than half of across_flats 27"),
        (dict(sides=2, corner_radius=1), "corner_radius 1: two flats have no corners"),
        (dict(sides=1), "sides 1 must be at least 2"),
        (dict(sides=101), "sides 101 must be at most 100"),
        (
            dict(stock_diameter=30, allowance=1.5),
            "allowance 1.5 must be less than the 1.5 from the stock to the flats",
        ),
    ):
        assert refusal("polar_polygon", **entries) == f"polar_polygon: {rule}"
    assert planned("polar_polygon", stock_diameter=30, allowance=1.499).rounds.rounds == 1
    assert planned("polar_polygon", corner_radius=13.499)
    assert planned("polar_polygon", sides=100) and planned("polar_polygon", sides=2)


@pytest.mark.parametrize(
    ("shape", "name", "meaning"),
    [
        ("polar_polygon", "sides", "how many, 2 for two flats"),
        ("polar_polygon", "across_flats", "the distance between two flats"),
        ("polar_polygon", "stock_diameter", "the bar's"),
        ("polar_slot", "width", "from wall to wall"),
        ("polar_slot", "length", "over all"),
        ("polar_pocket", "diameter", "the pocket's"),
        *((shape, "depth", "how deep, from the face at Z0") for shape in EXAMPLES),
    ],
)
def test_an_entry_without_a_default_is_missed_by_its_meaning(shape, name, meaning):
    assert refusal(shape, **{name: LEFT_OUT}) == f"{shape}: {name} is missing: {meaning}"
    count = len(PLANS[shape][0])
    if name != "sides":
        assert refusal(shape, **{name: 0}) == (
            f"{shape}: {name} 0 must be greater than 0"
            f" (a call has {count} entries, -9999 leaves one out)"
        )
