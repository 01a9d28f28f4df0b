# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill planner by itself: depths, radii, directions and messages, without LinuxCNC."""

import itertools
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from g12.cycles.circle_mill import (
    CLOCKWISE,
    COUNTERCLOCKWISE,
    ENTRIES,
    LEFT_OUT,
    entries_by_letter,
    plan_call,
    plan_code,
)
from g12.errors import Refusal
from g12.request.context import Tool
from g12.request.words import Words
from support.planner_context import BAD_MODES, INCH, MM

PLACE = dict(X=1.0, Y=2.0)
NEEDED = dict(**PLACE, Z=-0.5, R=1.5, I=0.1)
METRIC = MM._replace(spindle_tool=Tool(5, 6.0))


def code(found=INCH, plane=None, pocket=True, **values):
    name = "G13.2" if pocket else "G12.2"
    return plan_code(Words(name, values), found, plane, pocket)


def call(found=INCH, plane=None, **values):
    return plan_call(Words("circle_mill", values), found, plane)


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


def test_pocket_with_the_default_roughing_width():
    event = code(**NEEDED, H=2)
    assert ring_radii(event) == pytest.approx([0.416667, 0.833333, 1.25], abs=1e-6)
    assert not event.side_finish.side_finish


def test_pocket_with_finish_and_roughing_width():
    event = code(**NEEDED, H=2, J=0.3, Q=0.02)
    assert ring_radii(event) == pytest.approx([0.246, 0.492, 0.738, 0.984, 1.23])
    assert event.side_finish == (True, 1.25, CLOCKWISE, CLOCKWISE)


def test_pocket_in_millimetres():
    event = code(found=METRIC, X=0.0, Y=0.0, Z=-5.0, R=40.0, I=2.0, H=2, Q=0.3)
    assert ring_radii(event) == pytest.approx([11.233333, 22.466667, 33.7], abs=1e-6)
    assert event.side_finish.finish_radius == 34.0
    assert event.depths.retract == 2.54


@pytest.mark.parametrize(
    ("words", "depths"),
    [
        (dict(K=0.3, Q=0.02), [-0.2, -0.5, -0.8, -0.98, -1.0]),
        (dict(K=0.3, Q=0.02, L=1), [-0.2, -0.5, -0.8, -0.98, -1.0]),
        (dict(K=0.3, Q=0.02, L=0), [-0.2, -0.5, -0.8, -1.0]),
        (dict(K=0.3), [-0.2, -0.5, -0.8, -1.0]),
        (dict(Q=0.02), [-0.98, -1.0]),
        (dict(Q=0.02, L=0), [-1.0]),
        ({}, [-1.0]),
        (dict(K=1.1), [-1.0]),
        (dict(K=5.0), [-1.0]),
        (dict(K=0.55), [-0.45, -1.0]),
        (dict(K=0.1), [-0.1 * index for index in range(11)]),
    ],
)
def test_depths_from_w_down(words, depths):
    event = code(**PLACE, R=1.5, H=2, Z=-1.0, I=0.1, **words)
    assert level_depths(event) == pytest.approx(depths, abs=1e-12)


@pytest.mark.parametrize(
    ("words", "rough", "finish"),
    [
        (dict(H=2), 0.75, None),
        (dict(H=1), 1.25, None),
        (dict(H=0), 1.0, None),
        (dict(H=2, Q=0.02), 0.73, 0.75),
        (dict(H=1, Q=0.02), 1.27, 1.25),
    ],
)
def test_perimeter_radii(words, rough, finish):
    event = code(pocket=False, **PLACE, Z=-0.5, I=0.1, R=1.0, **words)
    roughing, side = event.roughing, event.side_finish
    assert (roughing.rings, roughing.rough_radius) == (1, pytest.approx(rough))
    assert roughing.plunge_radius == pytest.approx(rough)
    assert side.side_finish is (finish is not None)
    if finish:
        assert side.finish_radius == pytest.approx(finish)


# ---------------------------------------------------------------- directions and sides

CW, CCW = CLOCKWISE, COUNTERCLOCKWISE
ROUGH = {0: CW, 1: CCW, 2: CW, 3: CCW}
FINISH = {0: CW, 1: CCW, 2: CCW, 3: CW}
INSIDE_PAIRS = {(0, 2), (2, 2), (1, 1), (3, 1)}
OUTSIDE_PAIRS = {(0, 1), (2, 1), (1, 2), (3, 2)}


@pytest.mark.parametrize(("d", "h"), sorted(INSIDE_PAIRS))
def test_every_pair_that_puts_the_tool_inside_is_a_pocket(d, h):
    event = code(**NEEDED, D=d, H=h, Q=0.02)
    assert event.roughing.rough_arc == ROUGH[d]
    assert event.side_finish.finish_arc == FINISH[d]
    assert event.side_finish.entry_arc == FINISH[d]


@pytest.mark.parametrize(
    ("d", "h"), sorted(set(itertools.product(range(4), range(3))) - INSIDE_PAIRS)
)
def test_every_other_pair_is_no_pocket(d, h):
    with pytest.raises(Refusal) as refused:
        code(**NEEDED, D=d, H=h)
    assert refused.value.message == (
        f"G13.2: D{d} with H{h} does not put the tool inside the pocket:"
        " D0 and D2 need H2, D1 and D3 need H1"
    )
    values = {key: value for key, value in NEEDED.items() if key != "I"}
    with pytest.raises(Refusal, match=rf"^circle_mill: D{d} with C{h} does not"):
        call(**values, W=0.1, G=7, D=d, C=h)


@pytest.mark.parametrize(("d", "h"), itertools.product(range(4), range(3)))
def test_every_pair_is_a_perimeter(d, h):
    finish = {} if h == 0 else {"Q": 0.02}
    event = code(pocket=False, **NEEDED, D=d, H=h, **finish)
    inside, outside = (d, h) in INSIDE_PAIRS, (d, h) in OUTSIDE_PAIRS
    sign = outside - inside
    assert event.roughing.rough_radius == pytest.approx(1.5 + sign * 0.27)
    assert event.roughing.rough_arc == ROUGH[d]
    if finish:
        # outside, the entry arc turns against the cut, or it would not touch the wall
        assert event.side_finish.finish_arc == FINISH[d]
        against = {CLOCKWISE: COUNTERCLOCKWISE, COUNTERCLOCKWISE: CLOCKWISE}[FINISH[d]]
        assert event.side_finish.entry_arc == (FINISH[d] if inside else against)


# ---------------------------------------------------------------- entries


def test_g91_counts_xy_from_the_tool_and_z_from_w():
    found = INCH._replace(incremental=True, x=5.0, y=-1.0, z=0.7)
    event = code(found=found, X=1.0, Y=2.0, Z=-0.6, R=1.5, I=0.1, E=0.5, H=2)
    place = event.place
    assert (place.x, place.y) == (6.0, 1.0)
    assert (place.first_plane, place.second_plane) == (0.1, 0.5)
    assert event.depths.final_z == pytest.approx(-0.5)


def test_w_is_modal_and_o_is_w_unless_given():
    values = {key: value for key, value in NEEDED.items() if key != "I"}
    event = code(plane=0.2, **values, H=2)
    assert (event.place.first_plane, event.place.second_plane) == (0.2, 0.2)
    event = code(plane=0.2, **NEEDED, E=0.4, H=2)
    assert (event.place.first_plane, event.place.second_plane) == (0.1, 0.4)


def test_feeds_of_the_code_form():
    assert code(**NEEDED, H=2).feeds == (10.0, 10.0, 10.0)
    assert code(**NEEDED, H=2, P=3.0).feeds == (3.0, 10.0, 10.0)


def test_feeds_of_the_call():
    values = {key: value for key, value in NEEDED.items() if key != "I"} | {"W": 0.1, "C": 2}
    assert call(**values).feeds == (10.0, 10.0, 10.0)
    assert call(**values, F=20.0).feeds == (20.0, 20.0, 20.0)
    assert call(**values, F=20.0, P=5.0, V=15.0).feeds == (5.0, 20.0, 15.0)
    assert call(found=INCH._replace(feed=0.0), **values, F=20.0).feeds.feed == 20.0


def test_the_call_s_l_below_zero_is_the_side_only():
    values = {key: value for key, value in NEEDED.items() if key != "I"} | {"W": 0.1, "C": 2}
    both = call(**values, G=7, L=0.02)
    assert level_depths(both) == pytest.approx([-0.48, -0.5])
    side = call(**values, G=7, L=-0.02)
    assert level_depths(side) == [-0.5]
    assert both.side_finish == side.side_finish == (True, 1.25, CW, CW)


def test_both_front_ends_plan_the_same_event():
    values = {key: value for key, value in NEEDED.items() if key != "I"}
    shared = dict(values, D=2, K=0.2, J=0.3, P=5.0)
    assert code(**shared, I=0.1, E=0.5, H=2, Q=0.02) == call(
        **shared, G=7, W=0.1, O=0.5, C=2, L=0.02
    )


def test_entries_of_a_call():
    values = [LEFT_OUT] * len(ENTRIES)
    assert entries_by_letter(values) == {}
    values[1], values[14] = 0.0, 15.0
    assert entries_by_letter(values) == {"X": 0.0, "V": 15.0}
    assert list(entries_by_letter(range(15))) == list("GXYZWORDCKJLPFV")


def test_a_call_without_l_has_no_finish():
    values = {key: value for key, value in NEEDED.items() if key != "I"} | {"W": 0.1, "C": 2}
    event = call(**values, G=7)
    assert not event.side_finish.side_finish
    assert level_depths(event) == [-0.5]
    assert max(ring_radii(event)) == 1.25


def test_a_perimeter_is_the_default_of_the_call():
    values = {key: value for key, value in NEEDED.items() if key != "I"} | {"W": 0.1, "C": 2}
    assert not call(**values).roughing.pocket
    assert not call(**values, G=0).roughing.pocket
    assert call(**values, G=7).roughing.pocket


def test_the_tool_below_w_is_raised_first():
    assert code(found=INCH._replace(z=0.05), **NEEDED, H=2).place.below
    assert not code(found=INCH._replace(z=0.1), **NEEDED, H=2).place.below


def test_a_roughing_width_above_the_tool_diameter_is_a_message():
    event = code(**NEEDED, H=2, J=0.7)
    assert ring_radii(event) == pytest.approx([0.625, 1.25])
    assert event.message == (
        "G13.2: the roughing width 0.625 is greater than the tool diameter 0.5:"
        " material is left between the rings"
    )
    assert code(**NEEDED, H=2, J=0.5).message is None


# ---------------------------------------------------------------- refusals


def without(*letters):
    return {key: value for key, value in NEEDED.items() if key not in letters}


KNOWN = "X Y Z I E R D H K J Q L P F"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        (dict(without("X"), H=2), "X is missing: the circle's centre"),
        (dict(without("Y"), H=2), "Y is missing: the circle's centre"),
        (dict(without("Z"), H=2), "Z is missing: the final depth"),
        (dict(without("R"), H=2), "R is missing: the circle's radius"),
        (
            dict(without("I"), H=2),
            "I is missing: the first reference plane, which no earlier event has commanded",
        ),
        (NEEDED, "H is missing: 0 tool centre on the circle, 1 left, 2 right of it"),
        (dict(NEEDED, H=3), "H3 must be at most 2"),
        (dict(NEEDED, H=-1), "H-1 must be at least 0"),
        (
            dict(NEEDED, H=2, D=4),
            "D4 must be at most 3: D is the direction of the cut,"
            " the cutter is the tool in the spindle",
        ),
        (dict(NEEDED, H=2, D=-1), "D-1 must be at least 0"),
        (dict(NEEDED, H=2, D=0.5), "D0.5 must be a whole number"),
        (dict(NEEDED, H=2, R=-1.5), "R-1.5 must be greater than 0"),
        (dict(NEEDED, H=2, R=0.0), "R0 must be greater than 0"),
        (dict(NEEDED, H=2, K=0.0), "K0 must be greater than 0"),
        (dict(NEEDED, H=2, K=-0.1), "K-0.1 must be greater than 0"),
        (dict(NEEDED, H=2, J=0.0), "J0 must be greater than 0"),
        (dict(NEEDED, H=2, J=0.00005), "J0.00005 must be at least 0.0002"),
        (dict(NEEDED, H=2, P=0.0), "P0 must be greater than 0"),
        (dict(NEEDED, H=2, Q=-0.02), "Q-0.02 must be greater than 0"),
        (dict(NEEDED, H=2, Q=0.0), "Q0 must be greater than 0"),
        (dict(NEEDED, H=2, Q=0.00005), "Q0.00005 must be at least 0.0002"),
        (dict(NEEDED, H=2, L=1), "L needs Q as well: the finish dimension"),
        (dict(NEEDED, H=2, Q=0.02, L=2), "L2 must be at most 1"),
        (
            dict(NEEDED, H=2, E=0.05),
            "E0.05 must not be below the first reference plane I0.1",
        ),
        (
            dict(NEEDED, H=2, Z=0.1),
            "Z0.1 must be below the first reference plane I0.1",
        ),
        (
            dict(NEEDED, H=2, Z=0.09, Q=0.02),
            "Z0.09 must be below the first reference plane I0.1 by more than Q0.02",
        ),
        (
            dict(NEEDED, H=2, R=0.25),
            "R0.25 must be greater than the tool radius 0.25 (T1)",
        ),
        (
            dict(NEEDED, H=2, R=0.27, Q=0.02),
            "R0.27 must be greater than the tool radius 0.25 (T1) + Q0.02",
        ),
        (dict(NEEDED, H=2, B=1.0), f"B1 is not a word of this cycle, which knows {KNOWN}"),
        (dict(NEEDED, H=2, W=1.0), f"W1 is not a word of this cycle, which knows {KNOWN}"),
        (
            dict(NEEDED, H=2, J=0.001, K=0.0001),
            "J and K make 7500000 circles, the most is 100000",
        ),
    ],
)
def test_a_bad_pocket_is_refused_by_name(words, rule):
    with pytest.raises(Refusal) as refused:
        code(**words)
    assert refused.value.message == f"G13.2: {rule}"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        (dict(NEEDED, H=1, J=0.3), "J0.3 is the roughing width of a pocket"),
        (
            dict(NEEDED, H=0, Q=0.02),
            "Q0.02: there is no finish pass with the tool centre on the circle (H0)",
        ),
        (dict(NEEDED, H=2, R=0.2), "R0.2 must be greater than the tool radius 0.25 (T1)"),
        (dict(NEEDED, H=0, R=0.00005), "R0.00005 must be at least 0.0002"),
    ],
)
def test_a_bad_perimeter_is_refused_by_name(words, rule):
    with pytest.raises(Refusal) as refused:
        code(pocket=False, **words)
    assert refused.value.message == f"G12.2: {rule}"


CALLED = dict(PLACE, Z=-0.5, W=0.1, R=1.5, C=2)
CALL_KNOWN = "G X Y Z W O R D C K J L P F V"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        (
            {key: value for key, value in CALLED.items() if key != "W"},
            "W is missing: the first reference plane, which no earlier event has commanded",
        ),
        (
            {key: value for key, value in CALLED.items() if key != "C"},
            "C is missing: 0 tool centre on the circle, 1 left, 2 right of it",
        ),
        (dict(CALLED, G=1), "G1 must be 0 (perimeter) or 7 (pocket)"),
        (dict(CALLED, O=0.0), "O0 must not be below the first reference plane W0.1"),
        (dict(CALLED, L=0.0), "L0 must not be 0; -9999 leaves it out"),
        (dict(CALLED, F=0.0), "F0 must be greater than 0"),
        (
            dict(CALLED, V=-1.0),
            "V-1 must be greater than 0 (a call has 15 entries, -9999 leaves one out)",
        ),
        (dict(CALLED, P=0.0), "P0 must be greater than 0"),
        (dict(CALLED, K=0.0), "K0 must be greater than 0"),
        (dict(CALLED, C=0.5), "C0.5 must be a whole number"),
        (
            dict(CALLED, C=0, L=-0.02),
            "L0.02: there is no finish pass with the tool centre on the circle (C0)",
        ),
        (dict(CALLED, J=0.3), "J0.3 is the roughing width of a pocket"),
    ],
)
def test_a_bad_call_is_refused_by_name(words, rule):
    with pytest.raises(Refusal) as refused:
        call(**words)
    assert refused.value.message == f"circle_mill: {rule}"


@pytest.mark.parametrize(
    ("found", "rule"),
    [
        *BAD_MODES,
        (dict(plane="G19"), "needs the XY plane G17, but G19 is active"),
        (dict(spindle_tool=None), "no tool is loaded: its diameter sets the path"),
        (
            dict(spindle_tool=Tool(8, 0.0)),
            "T8 in the spindle needs a diameter above 0 in the tool table, not 0",
        ),
        (
            dict(spindle_tool=Tool(8, -0.25)),
            "T8 in the spindle needs a diameter above 0 in the tool table, not -0.5",
        ),
        (
            dict(spindle_tool=Tool(8, 0.005)),
            "J is missing: its default, the tool diameter 0.01 less 0.01, is too small",
        ),
    ],
)
def test_what_the_block_finds_must_be_fit(found, rule):
    with pytest.raises(Refusal) as refused:
        code(found=INCH._replace(**found), **NEEDED, H=2)
    assert refused.value.message == f"G13.2: {rule}"


def test_sizes_as_small_as_a_refusal_says_that_they_may_be():
    metric = dict(X=0.0, Y=0.0, Z=-5.0, I=2.0)
    perimeter = code(found=METRIC, pocket=False, **metric, R=0.00508, H=0)
    assert perimeter.roughing.rough_radius == 0.00508
    finished = code(found=METRIC, **metric, R=40.0, H=2, Q=0.00508)
    assert finished.side_finish.side_finish
    narrow = code(found=METRIC, **metric, R=6.1, H=2, J=0.00508)
    assert narrow.roughing.roughing_width <= 0.00508


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
    event = code(**words)
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
