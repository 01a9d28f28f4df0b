# SPDX-License-Identifier: GPL-2.0-or-later
"""The shapes on a lathe's face: the travel that is checked, modes, refusals.

Their geometry is proved in test_valid_cuts.py.
"""

import itertools
import math

import numpy as np
import pytest

from g12.shapes import pockets, polygon
from g12.shapes.entries import ShapeEntries, ShapeMachine
from g12.state import Tool
from support.planner_context import MM
from support.polar_programs import FIRST, feed_moves, in_plane, tracer
from support.sim_machines import kept_tracer

LEFT = -9999
CUTTER = {1: 6.0, 2: 5.0, 3: 3.0}
PLANNERS = {
    "polar_polygon": (polygon.POLYGON_ENTRIES, polygon.plan_polygon),
    "polar_slot": (pockets.SLOT_ENTRIES, pockets.plan_slot),
    "polar_pocket": (pockets.ROUND_POCKET_ENTRIES, pockets.plan_round_pocket),
}
MACHINE = ShapeMachine(False, 3.0, 1.0, 0.0025, False)
EXAMPLES = {
    "polar_polygon": dict(sides=6, across_flats=27, depth=5, stock_diameter=40, feed=400),
    "polar_slot": dict(width=8, length=30, depth=4, feed=400),
    "polar_pocket": dict(diameter=20, depth=4, feed=400),
}
SHAPES = {name: dict.fromkeys(PLANNERS[name][0], LEFT) | EXAMPLES[name] for name in PLANNERS}


lathe = kept_tracer("lathe_mm")


def call(shape, **entries):
    """Return a call of a shape; entries that are not named are those of the example."""
    assert entries.keys() <= SHAPES[shape].keys()
    values = {**SHAPES[shape], **entries}.values()
    return f"o<{shape}> call {' '.join(f'[{value}]' for value in values)}"


def program(*calls, tool=3, first=FIRST, start="G0 X40 Z5 C0", feed="F100", after=()):
    """Return a program of calls, the first of them in line 5."""
    return [first, f"T{tool} M6", start, feed, *calls, *after, "M2"]


def trace(lathe, shape, tool=3, **entries):
    traced = lathe.trace_text(program(call(shape, **entries), tool=tool))
    assert traced.error is None, traced.error
    return traced


def last_ends(traced):
    """Return where the last moves end in the part's plane."""
    assert traced.error is None, traced.error
    return np.array([in_plane(move.end) for move in feed_moves(traced)[-40:]])


# ---------------------------------------------------------------- travel

TO_AND_FRO = (dict(width=6), dict(x=4.5, c=0, diameter=28), dict(x=0, c=2.7, diameter=30))
TRAVELS = [
    ("polar_polygon", 1, dict(allowance=0.5)),
    ("polar_polygon", 3, dict(sides=2, across_flats=20, stock_diameter=30, angle=30)),
    ("polar_polygon", 3, dict(sides=2, across_flats=3, stock_diameter=28)),
    ("polar_polygon", 1, dict(sides=3, across_flats=16, stock_diameter=50, corner_radius=2)),
    ("polar_polygon", 2, dict(sides=5, across_flats=25, stock_diameter=36, angle=10)),
    ("polar_slot", 3, dict(width=6)),
    ("polar_slot", 3, dict(width=20, length=45, angle=75, allowance=0.5)),
    ("polar_slot", 2, dict(width=10.03, length=30)),
    ("polar_pocket", 3, dict(diameter=6.5)),
    ("polar_pocket", 3, dict(x=10, c=-4, diameter=16)),
    ("polar_pocket", 3, dict(x=1, c=1, diameter=25, allowance=0.5)),
    ("polar_pocket", 2, dict(x=4.5, c=0, diameter=28)),
    ("polar_pocket", 3, dict(x=0, c=2.7, diameter=30)),
]


@pytest.mark.parametrize(("shape", "tool", "entries"), TRAVELS)
def test_the_travel_that_is_checked_is_that_of_the_tool(lathe, shape, tool, entries):
    """Less would let it run into a limit amid the cut, more would refuse what fits.

    What goes to and fro through the centre, or begins beside it, might turn on and on.
    """
    every = dict(entries, depth_per_pass=2)
    moves = trace(lathe, shape, tool, **every).moves
    moves = moves[next(k for k, move in enumerate(moves) if move.end[2] < 5) :]
    ends = np.array([end for move in moves for end in (move.start, move.end)])
    found = MM._replace(z=5.0, spindle_tool=Tool(tool, CUTTER[tool]))
    names, planner = PLANNERS[shape]
    call_ = ShapeEntries(shape, names, {**SHAPES[shape], **every}, found)
    extent = planner(call_, MACHINE).extent
    onward = {"polar_polygon": 0.01}.get(shape, math.inf if entries in TO_AND_FRO else 180)
    for within, places, off, spare in zip(
        extent, ends.T[[0, 2, 5]], (0.005, 1e-9, 1e-6), (0.005, 1e-9, onward)
    ):
        assert within[0] - off <= places.min() <= within[0] + spare
        assert within[1] - spare <= places.max() <= within[1] + off


# ---------------------------------------------------------------- modes and units


@pytest.mark.parametrize("shape", SHAPES)
def test_every_mode_is_what_it_was(lathe, shape):
    modes = dict(
        first=FIRST.replace("G8 ", "G7 ").replace("G91.1", "G90.1"),
        start="G0 X80 Z5 C0",
        feed="G91 F100",
    )
    traced = lathe.trace_text(program(call(shape), after=("X2", "G1 X2"), **modes))
    assert traced.error is None, traced.error
    plain = lathe.trace_text(program(**modes))
    *_, rapid, fed = traced.moves
    assert rapid.kind == "rapid" and rapid.end[0] - rapid.start[0] == pytest.approx(1)
    assert fed.feed == 100
    assert sorted(traced.modes.gcodes) == sorted([*plain.modes.gcodes[1:], "G1"])


@pytest.mark.parametrize(
    ("shape", "mode", "setting"),
    [
        ("polar_polygon", "G7", "inherit"),
        *itertools.product(["polar_pocket"], ["G7", "G8"], ["inherit", "diameter", "radius"]),
    ],
)
def test_lengths_are_the_same_in_g7_and_g8_but_for_x(lathe, shape, mode, setting):
    diameters = setting == "diameter" or (setting, mode) == ("inherit", "G7")
    entries = dict(x=20 if diameters else 10, c=3) if shape == "polar_pocket" else {}
    first = FIRST.replace("G8 ", f"{mode} ")
    with tracer(POLAR_X=setting) as own:
        traced = own.trace_text(program(call(shape, **entries), first=first))
    assert traced.error is None, traced.error
    expected = trace(lathe, shape, **{**entries, "x": 10} if entries else {})
    assert np.abs(last_ends(traced) - last_ends(expected)).max() < 1e-6


# ---------------------------------------------------------------- refusals


def refused(lathe, text):
    """Return the message of a program that is refused before anything of the call moves."""
    traced = lathe.trace_text(text)
    assert traced.error is not None
    assert all(move.line < 5 for move in traced.moves)
    assert len(traced.error.text) <= 255
    return traced.error.text


@pytest.mark.parametrize(
    ("shape", "entries", "changed", "rule"),
    [  # those of one planner are in unit/test_shapes.py
        ("polar_polygon", dict(depth=501), {},
         "the Z axis would go to -501 mm, beyond its limit -500 mm"),
        ("polar_slot", dict(depth=LEFT), {}, "depth is missing: how deep, from the face at Z0"),
        ("polar_slot", {}, dict(feed="G93"), "needs G94 or G95, not G93"),
    ],
)  # fmt: skip
def test_a_call_is_refused_by_name_where_it_cannot_be_cut(lathe, shape, entries, changed, rule):
    text = program(call(shape, **entries), **changed)
    assert refused(lathe, text) == f"{shape} line 5: {rule}"


@pytest.mark.parametrize("code", ["G12.4", "G13.4"])
def test_the_codes_stand_in_the_subs_and_in_blocks_of_their_own(lathe, code):
    assert refused(lathe, program(code)) == (
        f"{code} line 5: belongs in the subs polar_polygon, polar_slot, polar_pocket,"
        " face_holes, side_holes and face_hole_at: call one of them"
    )
    edited = ["o<polar_slot> sub", f"{code} X5", "o<polar_slot> endsub", "o<polar_slot> call"]
    assert refused(lathe, program(*edited)) == f"{code} line 6: must be alone in its block"


def test_a_shape_nearer_to_the_centre_than_a_tool_beside_x_can_come_is_refused():
    with tracer(POLAR_TOOL_OFFSET="-5") as lathe:
        assert refused(lathe, program(call("polar_slot", width=24, length=25))) == (
            "polar_slot line 5: the tool's centre would come to 0.5 from the spindle's centre,"
            " where [G12] POLAR_TOOL_OFFSET lets it no nearer than 5.005"
        )


wrapped = kept_tracer("lathe_mm", overrides={"AXIS_C": {"WRAPPED_ROTARY": "1"}})


@pytest.mark.parametrize(
    ("shape", "entries", "stands"),
    [
        ("polar_polygon", dict(sides=2, angle=-110), 0),
        ("polar_slot", dict(angle=-30), 200),
        ("polar_slot", dict(angle=360), 0),
        ("polar_pocket", dict(x=15, c=-6, diameter=12), 200),
    ],
)
def test_a_wrapped_c_axis_reads_no_sign_of_the_angle(lathe, wrapped, shape, entries, stands):
    """LinuxCNC turns a wrapped axis to C30 with C-30, in the other sense, and refuses C360."""
    text = program(call(shape, **entries), start=f"G0 X40 Z5 C{stands}")
    ours = wrapped.trace_text(text)
    assert ours.error is None, ours.error
    theirs = lathe.trace_text(program(call(shape, **entries)))
    assert np.abs(last_ends(ours) - last_ends(theirs)).max() < 1e-6
