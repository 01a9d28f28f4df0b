# SPDX-License-Identifier: GPL-2.0-or-later
"""The locals of the circle mill event without LinuxCNC: depths, radii, directions, feeds.

What is refused is in test_cycles.py; random events are cut in test_valid_programs.py.
"""

import itertools

import pytest

from g12.cycles.circle_mill import EVENT_ENTRIES, entries_by_letter, plan_call, plan_code
from g12.cycles.plan import EventPlanes
from g12.request import CLOCKWISE, COUNTERCLOCKWISE, LEFT_OUT, Words
from g12.state import Tool
from support.planner_context import INCH, MM, reported, words_of

CODE = "X1 Y2 Z-.5 R1.5 I.1 H2"
CALL = "X1 Y2 Z-.5 R1.5 W.1 C2"
NONE = EventPlanes()
FEEDS = ("plunge_feed", "feed", "finish_feed")


def event(words="", found=INCH, pocket=True, planes=NONE):
    code = "G13.2" if pocket else "G12.2"
    return plan_code(Words(code, words_of(CODE, words), found), planes, pocket)


def code(*arguments, **options):
    return event(*arguments, **options).locals


def call(words="", found=INCH):
    return plan_call(Words("circle_mill", words_of(CALL, words), found), NONE).locals


def taken(numbers, *names):
    return tuple(numbers[name] for name in names)


def ring_radii(numbers):
    return [(ring + 1) * numbers["roughing_width"] for ring in range(numbers["rings"])]


def level_depths(numbers):
    """Walk the levels as the NGC body does."""
    z, pecks, found = numbers["z"], numbers["pecks"], []
    for _ in range(numbers["levels"]):
        found.append(z)
        if pecks > 1:
            z -= numbers["peck"]
        else:
            z = numbers["rough_z" if pecks == 1 else "final_z"]
        pecks -= 1
    return found


def test_pocket_in_millimetres():
    metric = MM._replace(spindle_tool=Tool(5, 6.0))
    numbers = code("X0 Y0 Z-5 R40 I2 Q.3", metric)
    assert ring_radii(numbers) == pytest.approx([11.233333, 22.466667, 33.7], abs=1e-6)
    assert taken(numbers, "finish_radius", "retract") == (34.0, 2.54)
    # sizes as small as a refusal says that they may be
    assert code("R.00508 H0", metric, pocket=False)["rough_radius"] == 0.00508
    assert code("R40 Q.00508", metric)["side_finish"]
    assert code("R6.1 J.00508", metric)["roughing_width"] <= 0.00508


@pytest.mark.parametrize(
    ("words", "depths"),
    [
        ("K.3 Q.02", [-0.2, -0.5, -0.8, -0.98, -1.0]),
        ("K.3 Q.02 L0", [-0.2, -0.5, -0.8, -1.0]),
        ("K.55", [-0.45, -1.0]),
        ("K2 Q.02", [-0.98, -1.0]),
    ],
)
def test_depths_from_w_down(words, depths):
    assert level_depths(code(f"Z-1 {words}")) == pytest.approx(depths, abs=1e-12)


CW, CCW = CLOCKWISE, COUNTERCLOCKWISE
ROUGH = {0: CW, 1: CCW, 2: CW, 3: CCW}
FINISH = {0: CW, 1: CCW, 2: CCW, 3: CW}
INSIDE_PAIRS = {(0, 2), (2, 2), (1, 1), (3, 1)}
OUTSIDE_PAIRS = {(0, 1), (2, 1), (1, 2), (3, 2)}


@pytest.mark.parametrize(("d", "h"), itertools.product(range(4), range(3)))
def test_a_pair_is_a_perimeter_and_one_that_puts_the_tool_inside_a_pocket(d, h):
    inside, outside = (d, h) in INSIDE_PAIRS, (d, h) in OUTSIDE_PAIRS
    finish = " Q.02" if h else ""
    numbers = code(f"D{d} H{h}{finish}", pocket=False)
    assert numbers["rough_radius"] == pytest.approx(1.5 + (outside - inside) * 0.27)
    assert numbers["rough_arc"] == ROUGH[d]
    if finish:
        # outside, the entry arc turns against the cut, or it would not touch the wall
        against = {CW: CCW, CCW: CW}[FINISH[d]]
        entry = FINISH[d] if inside else against
        assert taken(numbers, "finish_arc", "entry_arc") == (FINISH[d], entry)
    if inside:
        arcs = taken(code(f"D{d} H{h} Q.02"), "rough_arc", "finish_arc", "entry_arc")
        assert arcs == (ROUGH[d], FINISH[d], FINISH[d])
        return
    assert reported(code, f"D{d} H{h}") == (
        f"G13.2: D{d} with H{h} does not put the tool inside the pocket:"
        " D0 and D2 need H2, D1 and D3 need H1"
    )
    assert reported(call, f"G7 D{d} C{h}").startswith(f"circle_mill: D{d} with C{h} does not")


def test_g91_counts_xy_from_the_tool_and_z_from_w():
    numbers = code("Z-.6 E.5", INCH._replace(incremental=True, x=5.0, y=-1.0, z=0.7))
    assert taken(numbers, "x", "y", "first_plane", "second_plane") == (6.0, 1.0, 0.1, 0.5)
    assert numbers["final_z"] == pytest.approx(-0.5)


@pytest.mark.parametrize(
    ("words", "earlier", "planes", "commanded"),
    [
        ("", NONE, (0.1, 0.1), (0.1, None)),
        ("E.5", NONE, (0.1, 0.5), (0.1, 0.5)),
        ("", EventPlanes(0.3, 0.7), (0.1, 0.7), (0.1, None)),
        ("I.4", EventPlanes(0.3, None), (0.4, 0.4), (0.4, None)),
        ("E.6", EventPlanes(0.3, 0.7), (0.1, 0.6), (0.1, 0.6)),
    ],
)
def test_both_planes_are_modal_and_o_is_w_only_where_none_was_given(
    words, earlier, planes, commanded
):
    plan = event(words, planes=earlier)
    assert taken(plan.locals, "first_plane", "second_plane") == planes
    assert plan.commanded_planes == commanded


def test_an_earlier_o_below_w_is_refused_as_such():
    assert reported(event, "I.8", planes=EventPlanes(0.3, 0.7)) == (
        "G13.2: E0.7 must not be below the first reference plane I0.8:"
        " it is that of an earlier event, give a new E"
    )


def test_feeds():
    assert taken(code("P3"), *FEEDS) == (3.0, 10.0, 10.0)
    assert taken(call(), *FEEDS) == (10.0, 10.0, 10.0)
    assert taken(call("F20", INCH._replace(feed=0.0)), *FEEDS) == (20.0, 20.0, 20.0)
    assert taken(call("F20 P5 V15"), *FEEDS) == (5.0, 20.0, 15.0)


def test_the_finish_of_a_call_is_below_zero_of_the_side_only():
    both, side, none = call("G7 L.02"), call("G7 L-.02"), call("G7")
    assert [level_depths(numbers) for numbers in (both, side, none)] == [
        pytest.approx([-0.48, -0.5]), [-0.5], [-0.5],
    ]  # fmt: skip
    for numbers in (both, side):
        found = taken(numbers, "side_finish", "finish_radius", "finish_arc", "entry_arc")
        assert found == (True, 1.25, CW, CW)
    assert not none["side_finish"] and max(ring_radii(none)) == 1.25


def test_entries_of_a_call():
    values = [LEFT_OUT] * len(EVENT_ENTRIES)
    values[1], values[14] = 0.0, 15.0
    assert entries_by_letter(values) == {"X": 0.0, "V": 15.0}
    assert list(entries_by_letter(range(15))) == list("GXYZWORDCKJLPFV")
    assert [call(cycle)["pocket"] for cycle in ("", "G0", "G7")] == [False, False, True]


def test_the_tool_below_w_is_raised_first():
    assert [code(found=INCH._replace(z=z))["below"] for z in (0.05, 0.1)] == [True, False]


def test_a_roughing_width_above_the_tool_diameter_is_a_message():
    assert ring_radii(code("J.7")) == pytest.approx([0.625, 1.25])
    assert ring_radii(code("R.3")) == pytest.approx([0.05])
    assert event("J.7").message == (
        "G13.2: the roughing width 0.625 is greater than the tool diameter 0.5:"
        " material is left between the rings"
    )
    assert event("J.5").message is None
