# SPDX-License-Identifier: GPL-2.0-or-later
"""The Haas planner by itself: rules, counts and messages, without LinuxCNC."""

import pytest

from g12.cycles.entry import STRAIGHT_DOWN, PocketEntry
from g12.cycles.haas import plan_pocket
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import BAD_MODES, INCH, reported, words_of

TABLE = {1: Tool(1, 0.125), 2: Tool(2, 0.25), 3: Tool(3, -0.125), 4: Tool(4, 0.0)}
FOUND = INCH._replace(z=0.1, spindle_tool=TABLE[1], tool_in_table=TABLE.get)


def plan(words, clearing="rings", entry=STRAIGHT_DOWN, **found):
    return plan_pocket(Words("G12", words_of(words)), FOUND._replace(**found), clearing, entry)


def ring_radii(pocket):
    """Walk the links as the NGC body does."""
    radii, grow = [pocket.first_radius], pocket.first_grow
    for left in range(pocket.links, 0, -1):
        radii.append(radii[-1] + grow)
        if left == 2:
            grow *= 1 - pocket.shrink
    return radii


def test_a_spiral_ends_at_the_finished_radius():
    found = ring_radii(plan("I.3 K.7 Q.2 D1 Z-1", "spiral"))
    assert found == pytest.approx([0.175, 0.275, 0.375, 0.475, 0.575], abs=1e-12)


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("R.5 I1", "R0.5 is not a word of this cycle, which knows X Y Z I K Q L D F"),
        ("D1", "I is missing: the radius of the first circle"),
        ("I.12505 D1", "I0.12505 must exceed the tool radius 0.125 (D1) by at least 0.0002"),
        ("I0 D0", "I0 must be greater than 0"),
        ("I.5 K.5 Q.1", "I0.5 must be less than K0.5"),
        ("I.5 L0", "L0 must be at least 1"),
        ("I.5 L200000", "L makes 200000 circles, the most is 100000"),
        ("I.5 D77", "D77 is not in the tool table"),
        ("I.5 K1 Q1e-320", "Q9.99989e-321 makes 1000000001 circles, the most is 100000"),
    ],
)
def test_a_bad_block_is_refused_by_name(words, rule):
    assert reported(plan, f"{words} Z-1") == f"G12: {rule}"


LAST = dict(last_radius=0.2)


@pytest.mark.parametrize(
    ("modes", "rule"),
    [
        *BAD_MODES,
        (dict(plane="G18"), "needs the XY plane G17, but G18 is active"),
        (
            dict(per_revolution=True),
            "needs a spindle speed for feed per revolution (G95), but S is 0",
        ),
        (dict(offset_pending=True), "the tool is still offset: after G40 move in X or Y first"),
        (
            dict(spindle_tool=TABLE[3]),
            "T3 in the spindle has the negative diameter -0.25 in the tool table",
        ),
        (dict(spindle_tool=None), "D is missing, none was commanded before and no tool is loaded"),
        (
            dict(last_radius=0.8),
            "I0.75 must be greater than the tool radius 0.8 (the D last commanded)",
        ),
    ],
)
def test_a_mode_that_cannot_work_is_refused(modes, rule):
    assert reported(plan, "I.75 Z-1", **modes) == f"G12: {rule}"


def test_modes_that_can():
    assert plan("I.75 Z-1 D1", per_revolution=True, speed=100.0)
    assert plan("X1 I.75 Z-1 D1", offset_pending=True)  # X ends the offset


@pytest.mark.parametrize(
    ("words", "found", "radius"),
    [
        ("I.75", LAST, 0.55),
        ("I.1252 D1", {}, 0.0002),  # the smallest ring
    ],
)
def test_the_cutter_is_the_block_s_then_the_last_commanded_then_the_loaded_one(
    words, found, radius
):
    pocket = plan(f"{words} Z-1", **found)
    assert pocket.first_radius == pytest.approx(radius)
    commanded = {"D2": 0.25, "D0": 0.0, "D1": 0.125}
    assert pocket.commanded_radius == commanded.get(words[-2:])


@pytest.mark.parametrize(
    ("words", "clearing", "entry", "message"),
    [
        (
            "I.3 K1.5 Q.3 Z-1",
            "rings",
            {},
            "Q0.3 is greater than the tool diameter 0.25: material is left between the rings",
        ),
        (
            "I.4 K1.5 Q.25 Z-1",
            "rings",
            {},
            "I0.4 is greater than 1.5 x the tool diameter 0.25: a core is left in the centre",
        ),
        # a helix clears its own radius, 0.9 of the cutter's, more than a straight way down
        ("I.4875 K1.5 Q.25 Z-1", "rings", dict(helix=True), None),
        (
            "I.4876 K1.5 Q.25 Z-1",
            "rings",
            dict(helix=True),
            "I0.4876 is greater than 1.95 x the tool diameter 0.25: a ring is left about the"
            " centre",
        ),
    ],
)
def test_material_left_and_a_lost_sign_are_messages(words, clearing, entry, message):
    made = plan(f"{words} D1", clearing, PocketEntry(**entry))
    assert made.message == (message and f"G12: {message}")


def test_without_a_cutter_nothing_is_left_and_a_depth_above_is_up_in_g91_too():
    assert plan("I.3 K1.5 Q.3 Z-1 D0").message is None
    assert "is up from the tool" in plan("I.3 Z.5 D1", incremental=True).message


LOCALS = ["x", "y", "move_to_centre", "z", "z_step", "levels", "first_radius", "links", "step",
          "shorter", "restart", "rings"]  # fmt: skip


@pytest.mark.parametrize(
    ("words", "incremental", "expected"),
    [
        ("X1 Y2 K1.5 Q.5 Z-.5", False, [1, 2, True, -0.5, 0, 1, 0.625, 2, 0.5, 0.25, False, True]),
        ("Y5 Z-.5", True, [3, 9, True, -0.4, -0.5, 1, 0.625, 0, 0, 0, True, True]),
    ],
)
def test_the_locals_of_the_subroutine(words, incremental, expected):
    found = plan(f"I.75 D1 {words}", x=3.0, y=4.0, incremental=incremental).locals()
    assert [found[name] for name in LOCALS] == pytest.approx(expected)
