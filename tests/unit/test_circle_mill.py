# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill planner by itself: depths, radii, directions and messages, without LinuxCNC."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.circle_mill import EVENT_ENTRIES, entries_by_letter, plan_call, plan_code
from g12.request.common import CLOCKWISE, COUNTERCLOCKWISE, LEFT_OUT
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import BAD_MODES, INCH, MM, reported, words_of

NEEDED = words_of("X1 Y2 Z-.5 R1.5 I.1 H2")
CALLED = words_of("X1 Y2 Z-.5 R1.5 W.1 C2")


def values_of(needed, words, without):
    return {k: v for k, v in {**needed, **words_of(words)}.items() if k not in without}


def code(words="", found=INCH, plane=None, pocket=True, without=""):
    values = values_of(NEEDED, words, without)
    return plan_code(Words("G13.2" if pocket else "G12.2", values), found, plane, pocket)


def call(words="", found=INCH, plane=None, without=""):
    return plan_call(Words("circle_mill", values_of(CALLED, words, without)), found, plane)


def ring_radii(event):
    roughing = event.roughing
    if not roughing.pocket:
        return [roughing.rough_radius]
    return [(ring + 1) * roughing.roughing_width for ring in range(roughing.rings)]


def level_depths(event):
    """Walk the levels as the NGC body does."""
    depths, found = event.depths, []
    z, pecks = depths.z, depths.pecks
    for _ in range(depths.levels):
        found.append(z)
        if pecks > 1:
            z -= depths.peck
        else:
            z = depths.rough_z if pecks == 1 else depths.final_z
        pecks -= 1
    return found


# ---------------------------------------------------------------- golden cases


def test_pocket_in_millimetres():
    metric = MM._replace(spindle_tool=Tool(5, 6.0))
    event = code("X0 Y0 Z-5 R40 I2 Q.3", metric)
    assert ring_radii(event) == pytest.approx([11.233333, 22.466667, 33.7], abs=1e-6)
    assert (event.side_finish.finish_radius, event.depths.retract) == (34.0, 2.54)
    # sizes as small as a refusal says that they may be
    assert code("R.00508 H0", metric, pocket=False).roughing.rough_radius == 0.00508
    assert code("R40 Q.00508", metric).side_finish.side_finish
    assert code("R6.1 J.00508", metric).roughing.roughing_width <= 0.00508


@pytest.mark.parametrize(
    ("words", "depths"),
    [
        ("K.3 Q.02", [-0.2, -0.5, -0.8, -0.98, -1.0]),
        ("K.3 Q.02 L0", [-0.2, -0.5, -0.8, -1.0]),
        ("Q.02 L0", [-1.0]),
        ("K.55", [-0.45, -1.0]),
    ],
)
def test_depths_from_w_down(words, depths):
    assert level_depths(code(f"Z-1 {words}")) == pytest.approx(depths, abs=1e-12)


# ---------------------------------------------------------------- directions and sides

CW, CCW = CLOCKWISE, COUNTERCLOCKWISE
ROUGH = {0: CW, 1: CCW, 2: CW, 3: CCW}
FINISH = {0: CW, 1: CCW, 2: CCW, 3: CW}
INSIDE_PAIRS = {(0, 2), (2, 2), (1, 1), (3, 1)}
OUTSIDE_PAIRS = {(0, 1), (2, 1), (1, 2), (3, 2)}


@pytest.mark.parametrize(("d", "h"), itertools.product(range(4), range(3)))
def test_a_pair_is_a_perimeter_and_one_that_puts_the_tool_inside_a_pocket(d, h):
    inside, outside = (d, h) in INSIDE_PAIRS, (d, h) in OUTSIDE_PAIRS
    finish = " Q.02" if h else ""
    event = code(f"D{d} H{h}{finish}", pocket=False)
    assert event.roughing.rough_radius == pytest.approx(1.5 + (outside - inside) * 0.27)
    assert event.roughing.rough_arc == ROUGH[d]
    if finish:
        # outside, the entry arc turns against the cut, or it would not touch the wall
        assert event.side_finish.finish_arc == FINISH[d]
        against = {CW: CCW, CCW: CW}[FINISH[d]]
        assert event.side_finish.entry_arc == (FINISH[d] if inside else against)
    if inside:
        pocket = code(f"D{d} H{h} Q.02")
        assert (pocket.roughing.rough_arc, pocket.side_finish[2:]) == (ROUGH[d], (FINISH[d],) * 2)
        return
    assert reported(code, f"D{d} H{h}") == (
        f"G13.2: D{d} with H{h} does not put the tool inside the pocket:"
        " D0 and D2 need H2, D1 and D3 need H1"
    )
    assert reported(call, f"G7 D{d} C{h}").startswith(f"circle_mill: D{d} with C{h} does not")


def test_g91_counts_xy_from_the_tool_and_z_from_w():
    event = code("Z-.6 E.5", INCH._replace(incremental=True, x=5.0, y=-1.0, z=0.7))
    assert (event.position.x, event.position.y) == (6.0, 1.0)
    assert (event.position.first_plane, event.position.second_plane) == (0.1, 0.5)
    assert event.depths.final_z == pytest.approx(-0.5)


# ---------------------------------------------------------------- entries


def test_feeds():
    assert code().feeds == (10.0, 10.0, 10.0)
    assert code("P3").feeds == (3.0, 10.0, 10.0)
    assert call().feeds == (10.0, 10.0, 10.0)
    assert call("F20", INCH._replace(feed=0.0)).feeds == (20.0, 20.0, 20.0)
    assert call("F20 P5 V15").feeds == (5.0, 20.0, 15.0)


def test_the_finish_of_a_call_is_below_zero_of_the_side_only():
    both, side, none = call("G7 L.02"), call("G7 L-.02"), call("G7")
    assert [level_depths(event) for event in (both, side, none)] == [
        pytest.approx([-0.48, -0.5]), [-0.5], [-0.5],
    ]  # fmt: skip
    assert both.side_finish == side.side_finish == (True, 1.25, CW, CW)
    assert not none.side_finish.side_finish and max(ring_radii(none)) == 1.25


def test_entries_of_a_call():
    values = [LEFT_OUT] * len(EVENT_ENTRIES)
    assert entries_by_letter(values) == {}
    values[1], values[14] = 0.0, 15.0
    assert entries_by_letter(values) == {"X": 0.0, "V": 15.0}
    assert list(entries_by_letter(range(15))) == list("GXYZWORDCKJLPFV")


def test_a_perimeter_is_the_default_of_the_call():
    assert [call(g).roughing.pocket for g in ("", "G0", "G7")] == [False, False, True]


def test_the_tool_below_w_is_raised_first():
    assert [code(found=INCH._replace(z=z)).position.below for z in (0.05, 0.1)] == [True, False]


def test_a_roughing_width_above_the_tool_diameter_is_a_message():
    event = code("J.7")
    assert ring_radii(event) == pytest.approx([0.625, 1.25])
    assert event.message == (
        "G13.2: the roughing width 0.625 is greater than the tool diameter 0.5:"
        " material is left between the rings"
    )
    assert code("J.5").message is None


# ---------------------------------------------------------------- refusals

NO_PLANE = "is missing: the first reference plane, which no earlier event has commanded"
NO_FINISH = "there is no finish pass with the tool centre on the circle"


@pytest.mark.parametrize(
    ("without", "rule"),
    [
        ("X", "X is missing: the circle's centre"),
        ("Y", "Y is missing: the circle's centre"),
        ("Z", "Z is missing: the final depth"),
        ("R", "R is missing: the circle's radius"),
        ("I", f"I {NO_PLANE}"),
        ("H", "H is missing: 0 tool centre on the circle, 1 left, 2 right of it"),
    ],
)
def test_a_missing_word_is_named(without, rule):
    assert reported(code, without=without) == f"G13.2: {rule}"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("H3", "H3 must be at most 2"),
        (
            "D4",
            "D4 must be at most 3: D is the direction of the cut,"
            " the cutter is the tool in the spindle",
        ),
        ("D.5", "D0.5 must be a whole number"),
        ("J.00005", "J0.00005 must be at least 0.0002"),
        ("Q.00005", "Q0.00005 must be at least 0.0002"),
        ("L1", "L needs Q as well: the finish dimension"),
        ("Q.02 L2", "L2 must be at most 1"),
        ("E.05", "E0.05 must not be below the first reference plane I0.1"),
        ("Z.1", "Z0.1 must be below the first reference plane I0.1"),
        ("Z.09 Q.02", "Z0.09 must be below the first reference plane I0.1 by more than Q0.02"),
        ("R.25", "R0.25 must be greater than the tool radius 0.25 (T1)"),
        ("R.27 Q.02", "R0.27 must be greater than the tool radius 0.25 (T1) + Q0.02"),
        ("W1", "W1 is not a word of this cycle, which knows X Y Z I E R D H K J Q L P F"),
        ("J.001 K.0001", "J and K make 7500000 circles, the most is 100000"),
    ],
)
def test_a_bad_pocket_is_refused_by_name(words, rule):
    assert reported(code, words) == f"G13.2: {rule}"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        ("H1 J.3", "J0.3 is the roughing width of a pocket"),
        ("H0 Q.02", f"Q0.02: {NO_FINISH} (H0)"),
        ("R.2", "R0.2 must be greater than the tool radius 0.25 (T1)"),
        ("H0 R.00005", "R0.00005 must be at least 0.0002"),
    ],
)
def test_a_bad_perimeter_is_refused_by_name(words, rule):
    assert reported(code, words, pocket=False) == f"G12.2: {rule}"


@pytest.mark.parametrize(
    ("words", "without", "rule"),
    [
        ("", "W", f"W {NO_PLANE}"),
        ("", "C", "C is missing: 0 tool centre on the circle, 1 left, 2 right of it"),
        ("G1", "", "G1 must be 0 (perimeter) or 7 (pocket)"),
        ("O0", "", "O0 must not be below the first reference plane W0.1"),
        ("L0", "", "L0 must not be 0; -9999 leaves it out"),
        ("F0", "", "F0 must be greater than 0"),
        ("V-1", "", "V-1 must be greater than 0 (a call has 15 entries, -9999 leaves one out)"),
        ("C.5", "", "C0.5 must be a whole number"),
        ("C0 L-.02", "", f"L0.02: {NO_FINISH} (C0)"),
        ("J.3", "", "J0.3 is the roughing width of a pocket"),
    ],
)
def test_a_bad_call_is_refused_by_name(words, without, rule):
    assert reported(call, words, without=without) == f"circle_mill: {rule}"


DIAMETER = "T8 in the spindle needs a diameter above 0 in the tool table, not"


@pytest.mark.parametrize(
    ("found", "rule"),
    [
        *BAD_MODES,
        (dict(plane="G19"), "needs the XY plane G17, but G19 is active"),
        (dict(spindle_tool=None), "no tool is loaded: its diameter sets the path"),
        (dict(spindle_tool=Tool(8, 0.0)), f"{DIAMETER} 0"),
        (dict(spindle_tool=Tool(8, -0.25)), f"{DIAMETER} -0.5"),
        (
            dict(spindle_tool=Tool(8, 0.005)),
            "J is missing: its default, the tool diameter 0.01 less 0.01, is too small",
        ),
    ],
)
def test_what_the_block_finds_must_be_fit(found, rule):
    assert reported(code, found=INCH._replace(**found)) == f"G13.2: {rule}"


# ---------------------------------------------------------------- any valid event


@st.composite
def events(draw):
    radius = draw(st.floats(0.3, 5.0))
    words = dict(X=0.0, Y=0.0, R=radius, I=0.1, Z=-draw(st.floats(0.05, 2.0)), H=2)
    words |= draw(st.fixed_dictionaries({}, optional={"K": st.floats(0.02, 3.0)}))
    words |= draw(st.fixed_dictionaries({}, optional={"J": st.floats(0.01, 0.5)}))
    finish = draw(st.none() | st.floats(0.001, 0.04))
    if finish:
        words |= {"Q": finish, "L": draw(st.integers(0, 1))}
    return words


@given(words=events())
def test_any_pocket_steps_evenly_within_j_and_k_and_ends_exactly(words):
    event = plan_code(Words("G13.2", dict(words)), INCH, None, True)
    finish = words.get("Q", 0.0)
    rings = [0.0, *ring_radii(event)]
    widths = [b - a for a, b in zip(rings, rings[1:])]
    assert max(widths) <= words.get("J", 0.49) + 1e-6
    assert max(widths) == pytest.approx(min(widths))
    assert rings[-1] == pytest.approx(words["R"] - 0.25 - finish)
    assert len(widths) == max(1, math.ceil(rings[-1] / words.get("J", 0.49) - 1e-6))
    levels = level_depths(event)
    drops = [a - b for a, b in zip([0.1, *levels], levels)]
    bottom = bool(finish) and words["L"] == 1
    assert levels[-1] == words["Z"]
    assert max(drops[: len(drops) - bottom]) <= words.get("K", 9.0) + 1e-6
    assert min(drops) > 0
    if bottom:
        assert drops[-1] == pytest.approx(finish)
