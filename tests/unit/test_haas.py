# SPDX-License-Identifier: GPL-2.0-or-later
"""The Haas planner by itself: rules, counts and messages, without LinuxCNC."""

import math

import pytest

from g12.cycles.entry import PocketEntry
from g12.cycles.haas import plan_pocket
from g12.errors import Refusal
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import INCH

TABLE = {1: Tool(1, 0.125), 2: Tool(2, 0.25), 3: Tool(3, -0.125), 4: Tool(4, 0.0)}
FOUND = INCH._replace(z=0.1, spindle_tool=TABLE[1], tool_in_table=TABLE.get)


def plan(clearing="rings", found=FOUND, **values):
    return plan_pocket(Words("G12", values), found, clearing)


def ring_radii(pocket):
    """Walk the links as the NGC body does."""
    radii, grow = [pocket.first_radius], pocket.first_grow
    for left in range(pocket.links, 0, -1):
        radii.append(radii[-1] + grow)
        if left == 2:
            grow *= 1 - pocket.shrink
    return radii


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (dict(I=0.75, Z=-1.2, D=1), [0.625]),
        (dict(I=0.3, K=1.5, Q=1.0, Z=-1.2, D=1), [0.175, 1.175, 1.375]),
        (dict(I=0.3, K=1.5, Q=0.3, Z=-1.2, D=1), [0.175, 0.475, 0.775, 1.075, 1.375]),
        (dict(I=0.4, K=2.0, Q=0.4, Z=-0.5, D=2), [0.15, 0.55, 0.95, 1.35, 1.75]),
        (dict(I=0.3, K=1.5, Q=0.3, Z=-1.2, D=0), [0.3, 0.6, 0.9, 1.2, 1.5]),
        (dict(I=0.3, K=1.0, Q=0.4, Z=-1.2, D=1), [0.175, 0.575, 0.875]),
        (dict(I=0.1, K=0.7, Q=0.1, Z=-1.2, D=0), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]),
        (dict(I=0.3, K=0.35, Q=0.3, Z=-1.2, D=1), [0.175, 0.225]),
    ],
)
def test_rings_end_at_the_finished_radius(words, expected):
    assert ring_radii(plan(**words)) == pytest.approx(expected, abs=1e-12)


def test_spiral_grows_by_half_the_increment_each_half_turn():
    pocket = plan("spiral", I=0.3, K=0.7, Q=0.2, Z=-1.0, D=1)
    assert ring_radii(pocket) == pytest.approx([0.175, 0.275, 0.375, 0.475, 0.575])
    clamped = plan("spiral", I=0.3, K=0.65, Q=0.2, Z=-1.0, D=1)
    assert ring_radii(clamped) == pytest.approx([0.175, 0.275, 0.375, 0.475, 0.525])


def test_rounding_of_the_increment_makes_no_sliver():
    third = plan(I=1 / 3, K=1.0, Q=1 / 3, Z=-1.0, D=1)
    assert third.links == 2
    millimetres = FOUND._replace(inch=False, spindle_tool=None, last_radius=0.0)
    assert plan(found=millimetres, I=2.54, K=17.78, Q=2.54, Z=-1.0).links == 6


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            dict(R=0.5, Z=-1.0, D=1),
            "G12: R0.5 is not a word of this cycle, which knows X Y Z I K Q L D F",
        ),
        (dict(Z=-1.0, D=1), "G12: I is missing: the radius of the first circle"),
        (dict(I=0.125, Z=-1.0, D=1), "G12: I0.125 must be greater than the tool radius 0.125 (D1)"),
        (dict(I=0.0, Z=-1.0, D=0), "G12: I0 must be greater than 0"),
        (dict(I=-0.5, Z=-1.0, D=0), "G12: I-0.5 must be greater than 0"),
        (
            dict(I=0.12505, Z=-1.0, D=1),
            "G12: I0.12505 must exceed the tool radius 0.125 (D1) by at least 0.0002",
        ),
        (dict(I=0.5, K=1.0, Z=-1.0, D=1), "G12: K1 needs Q as well"),
        (dict(I=0.5, Q=0.2, Z=-1.0, D=1), "G12: Q0.2 needs K as well"),
        (dict(I=0.5, K=1.0, Q=0.0, Z=-1.0, D=1), "G12: Q0 must be greater than 0"),
        (dict(I=0.5, K=1.0, Q=-0.1, Z=-1.0, D=1), "G12: Q-0.1 must be greater than 0"),
        (dict(I=0.5, K=0.5, Q=0.1, Z=-1.0, D=1), "G12: I0.5 must be less than K0.5"),
        (dict(I=0.5, K=0.4, Q=0.1, Z=-1.0, D=1), "G12: I0.5 must be less than K0.4"),
        (dict(I=0.5, Z=-1.0, L=0, D=1), "G12: L0 must be at least 1"),
        (dict(I=0.5, Z=-1.0, D=-1), "G12: D-1 must be at least 0"),
        (dict(I=0.5, Z=-1.0, D=1.5), "G12: D1.5 must be a whole number"),
        (dict(I=0.5, Z=-1.0, D=77), "G12: D77 is not in the tool table"),
        (
            dict(I=0.5, Z=-1.0, D=3),
            "G12: D3 has the negative diameter -0.25 in the tool table",
        ),
        (
            dict(I=0.5, Z=-1.0, D=1, R=0.1),
            "G12: R0.1 is not a word of this cycle, which knows X Y Z I K Q L D F",
        ),
        (
            dict(I=0.3, K=10.0, Q=0.00001, Z=-1.0, D=1),
            "G12: Q0.00001 makes 970001 circles, the most is 100000",
        ),
    ],
)
def test_a_bad_block_is_refused_by_name(words, message):
    with pytest.raises(Refusal) as refused:
        plan(**words)
    assert refused.value.message == message


def test_feed_per_revolution_of_a_spindle_that_turns():
    assert plan(found=FOUND._replace(per_revolution=True, speed=100.0), I=0.75, Z=-1.0, D=1)
    assert plan(found=FOUND._replace(per_revolution=False, speed=0.0), I=0.75, Z=-1.0, D=1)


@pytest.mark.parametrize(
    ("modes", "message"),
    [
        (dict(plane="G18"), "G12: needs the XY plane G17, but G18 is active"),
        (
            dict(inverse_time=True),
            "G12: needs feed per minute or revolution (G94, G95), but G93 is active",
        ),
        (
            dict(compensated=True),
            "G12: brings its own cutter compensation: program G40 first",
        ),
        (dict(feed=0.0), "G12: F0 must be greater than 0 (no feed commanded?)"),
        (
            dict(per_revolution=True),
            "G12: needs a spindle speed for feed per revolution (G95), but S is 0",
        ),
        (
            dict(offset_pending=True),
            "G12: the tool still stands offset: after G40 move in X or Y first",
        ),
        (
            dict(spindle_tool=TABLE[3]),
            "G12: T3 in the spindle has the negative diameter -0.25 in the tool table",
        ),
        (
            dict(spindle_tool=None),
            "G12: D is missing, none was commanded before and no tool is loaded",
        ),
    ],
)
def test_a_mode_that_cannot_work_is_refused(modes, message):
    with pytest.raises(Refusal) as refused:
        plan(found=FOUND._replace(**modes), I=0.75, Z=-1.0)
    assert refused.value.message == message


def test_x_or_y_in_the_block_ends_a_pending_offset():
    assert plan(found=FOUND._replace(offset_pending=True), X=1.0, I=0.75, Z=-1.0, D=1)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (dict(I=1e7, Z=-1.0, D=1), "G12: I10000000 is beyond 1000000"),
        (dict(I=1e300, Z=-1.0, D=1), "G12: I1e+300 is beyond 1000000"),
        (dict(I=0.5, Z=-math.inf, D=1), "G12: Z-inf is beyond 1000000"),
        (dict(I=0.5, Z=math.nan, D=1), "G12: Znan is beyond 1000000"),
        (
            dict(I=0.5, K=1.0, Q=1e-7, Z=-1.0, D=1),
            "G12: Q1e-07 makes 5000001 circles, the most is 100000",
        ),
        (
            dict(I=0.5, K=1.0, Q=1e-320, Z=-1.0, D=1),
            "G12: Q9.99989e-321 makes 1000000001 circles, the most is 100000",
        ),
        (
            dict(I=0.5, L=200000, Z=-1.0, D=1),
            "G12: L makes 200000 circles, the most is 100000",
        ),
    ],
)
def test_absurd_numbers_are_refused_in_words(words, message):
    with pytest.raises(Refusal) as refused:
        plan(**words)
    assert refused.value.message == message


def test_the_smallest_ring_is_accepted_in_both_units():
    assert plan(I=0.1252, Z=-1.0, D=1).first_radius == pytest.approx(0.0002)
    millimetres = FOUND._replace(inch=False)
    assert plan(found=millimetres, I=0.00508, Z=-1.0, D=0).first_radius == 0.00508


def test_the_cutter_is_the_block_s_then_the_last_commanded_then_the_loaded_one():
    last = FOUND._replace(last_radius=0.2)
    assert plan(I=0.75, Z=-1.0, D=2).first_radius == 0.5
    assert plan(found=last, I=0.75, Z=-1.0).first_radius == pytest.approx(0.55)
    assert plan(found=FOUND._replace(last_radius=0.0), I=0.75, Z=-1.0).first_radius == 0.75
    assert plan(I=0.75, Z=-1.0).first_radius == 0.625
    assert plan(I=0.75, Z=-1.0, D=0).first_radius == 0.75


def test_a_refusal_tells_where_the_radius_comes_from():
    last = FOUND._replace(last_radius=0.2)
    for found, words, source in (
        (FOUND, dict(D=2), "0.25 (D2)"),
        (last, {}, "0.2 (the D last commanded)"),
        (FOUND, {}, "0.125 (T1 in the spindle)"),
    ):
        with pytest.raises(Refusal) as refused:
            plan(found=found, I=0.1, Z=-1.0, **words)
        assert refused.value.message == f"G12: I0.1 must be greater than the tool radius {source}"


def test_only_a_d_in_the_block_is_a_d_commanded():
    assert plan(I=0.75, Z=-1.0, D=2).commanded_radius == 0.25
    assert plan(I=0.75, Z=-1.0, D=0).commanded_radius == 0.0
    assert plan(I=0.75, Z=-1.0).commanded_radius is None


def test_levels_repeat_in_g90_and_go_deeper_in_g91():
    absolute = plan(I=0.75, Z=-1.0, L=3, D=1)
    assert (absolute.z, absolute.z_step, absolute.levels) == (-1.0, 0.0, 3)
    incremental = plan(found=FOUND._replace(incremental=True), I=0.75, Z=-0.5, L=4, D=1)
    assert incremental.z == pytest.approx(-0.4)
    assert (incremental.z_step, incremental.levels) == (-0.5, 4)


def test_x_and_y_name_the_centre():
    found = FOUND._replace(x=1.0, y=2.0)
    here = plan(found=found, I=0.75, Z=-1.0)
    assert (here.x, here.y, here.move_to_centre) == (1.0, 2.0, False)
    absolute = plan(found=found, X=5.0, I=0.75, Z=-1.0)
    assert (absolute.x, absolute.y, absolute.move_to_centre) == (5.0, 2.0, True)
    incremental = plan(found=found._replace(incremental=True), Y=5.0, I=0.75, Z=-1.0)
    assert (incremental.x, incremental.y) == (1.0, 7.0)


def test_a_depth_above_the_tool_is_a_message():
    lost = plan(I=0.3, Z=0.5, D=1).message
    assert lost == "G12: Z0.5 is up from the tool at Z0.1: has it lost its minus sign?"
    incremental = FOUND._replace(incremental=True)
    assert plan(found=incremental, I=0.3, Z=0.5, D=1).message.startswith("G12: Z0.5 is up")
    assert plan(I=0.3, Z=0.1, D=1).message is None


def test_material_left_is_a_message_not_an_error():
    between = plan(I=0.3, K=1.5, Q=0.3, Z=-1.0, D=1).message
    assert between == (
        "G12: Q0.3 is greater than the tool diameter 0.25: material is left between the rings"
    )
    core = plan(I=0.4, K=1.5, Q=0.25, Z=-1.0, D=1).message
    assert core == (
        "G12: I0.4 is greater than 1.5 x the tool diameter 0.25: a core is left in the centre"
    )
    assert plan(I=0.3, K=1.5, Q=0.25, Z=-1.0, D=1).message is None
    assert plan(I=0.3, K=0.4, Q=0.5, Z=-1.0, D=1).message is None
    assert plan(I=0.75, Z=-1.0, D=1).message is None
    assert plan(I=0.3, K=1.5, Q=0.3, Z=-1.0, D=0).message is None


def test_a_ring_is_left_about_the_centre_where_a_helix_does_not_reach():
    """It clears its own radius, 0.9 of the cutter's, more than a straight way down."""

    def message(first):
        words = Words("G12", dict(I=first, K=1.5, Q=0.25, Z=-1.0, D=1))
        return plan_pocket(words, FOUND, entry=PocketEntry(helix=True)).message

    assert message(3.9 * 0.125) is None
    assert message(3.9 * 0.125 + 1e-4) == (
        "G12: I0.4876 is greater than 1.95 x the tool diameter 0.25:"
        " a ring is left about the centre"
    )


def test_a_table_diameter_with_conversion_noise_changes_nothing():
    noisy = FOUND._replace(tool_in_table=lambda number: Tool(number, 0.125 + 1e-11))
    assert plan(found=noisy, I=0.375, K=1.5, Q=0.25, Z=-1.0, D=1).message is None
    with pytest.raises(Refusal, match="greater than the tool radius"):
        plan(found=noisy, I=0.125, Z=-1.0, D=1)
    assert math.isclose(plan(found=noisy, I=0.3, K=1.0, Q=0.4, Z=-1.0, D=1).links, 2)


def test_the_locals_of_the_subroutine():
    rings = plan(X=1.0, Y=2.0, I=0.75, K=1.5, Q=0.5, Z=-0.5, D=1, found=FOUND).locals()
    wanted = {
        "x": 1.0,
        "y": 2.0,
        "move_to_centre": True,
        "z": -0.5,
        "z_step": 0.0,
        "levels": 1,
        "first_radius": 0.625,
        "links": 2,
        "step": 0.5,
        "shorter": 0.25,
        "restart": False,
        "rings": True,
    }
    assert {name: rings[name] for name in wanted} == wanted
    deeper = plan(I=0.75, K=1.5, Q=0.5, Z=-0.5, L=2, D=1, found=FOUND._replace(incremental=True))
    found = deeper.locals()
    assert [found[name] for name in ("z_step", "restart")] == [-0.5, True]
