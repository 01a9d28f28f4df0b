# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Yasnac dialect on the stock interpreter: fast moves, modes, refusals."""

import pytest
from hypothesis import given, settings

from support import mode_matrix
from support.sim_machines import ROOT, kept_tracer

TOOLS = {1: 6.0, 3: -4.0, 10: 20.0}
FIRST = "G21 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F300"
REMAPS = {"RS274NGC": {"REMAP": mode_matrix.remaps(ROOT / "configs/include/g12_yasnac.inc")}}


IN_INCHES = {tool: diameter / mode_matrix.INCH for tool, diameter in TOOLS.items()}
metric = kept_tracer("mill_yasnac_mm", tools=TOOLS)
inch = kept_tracer("mill_inch", tools=IN_INCHES, overrides=REMAPS)
traversing = kept_tracer(
    "mill_yasnac_mm", tools=TOOLS, overrides={"G12": {"YASNAC_TRAVERSE": 1500}}
)


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


# ---------------------------------------------------------------- any valid block


def test_an_approach_however_short_is_made_and_taken_back(inch):
    approach = 0.00006  # inches: LinuxCNC's NE takes it for 0
    offset = 0.5 * TOOLS[10] / mode_matrix.INCH
    traced = cut(inch, "G20 F10", "G0 X1 Y2 Z-.1", f"G12 I1.5 R{offset + approach:.9f} D10")
    *_, last = traced.moves
    assert last.start[0] - last.end[0] == pytest.approx(approach * mode_matrix.INCH, rel=1e-3)
    assert last.end[:2] == pytest.approx((1 * mode_matrix.INCH, 2 * mode_matrix.INCH), abs=1e-9)


# ---------------------------------------------------------------- fast moves


@pytest.mark.parametrize("mode", ["G94 F300", "G95 F0.2"])
def test_fast_moves_at_the_traverse_feed(traversing, mode):
    before = [FIRST, "S1000 M3", mode]
    traced = traversing.trace_text([*before, "G12 I50 R40 D10"])
    kinds = [(move.kind, round(move.feed, 9), move.feed_mode) for move in traced.moves]
    cutting = ("arc", 300, "G94") if "G94" in mode else ("arc", 0.2, "G95")
    assert kinds == [("feed", 1500, "G94"), *[cutting] * 3, ("feed", 1500, "G94")]
    mode_matrix.check_modes(traversing.trace_text(before), traced)


def test_the_traverse_feed_is_in_machine_units(traversing):
    traced = traversing.trace_text([FIRST, "G20", "F10", "G12 I2 R1 D1"])
    assert [round(move.feed, 6) for move in traced.moves] == [1500, 254, 254, 254, 1500]
    assert traced.modes.feed == 10


# ---------------------------------------------------------------- modes, units, work offsets


def spiral_block(scale, incremental):
    lengths = mode_matrix.words(scale, I=1.9, R=0.7, K=1.1, Q=0.3, F=12.0)
    return f"G13 {lengths} D10 L2"


@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates):
    mode_matrix.check_same_path(
        inch, metric, coordinates, mode_matrix.Case(spiral_block, feed=12.0)
    )


def test_the_last_d_commanded_is_left_alone(metric):
    before = [FIRST, "G41 D1", "G40"]
    found = metric.trace_text(before)
    after = metric.trace_text([*before, "G12 I50 D10"])
    assert after.state == found.state


# ---------------------------------------------------------------- refusals on the interpreter

REFUSED = [  # the sentences are those of unit/test_yasnac.py
    ("G12 R40 D10", "G12: I is missing: the radius of the finished circle"),
    ("G12 I50 D77", "G12: D77 is not in the tool table"),
    ("G13 I50 D10 X1", "G13: X1 is not a word of this cycle, which knows I R (or J) K Q L D F"),
]


@pytest.mark.parametrize(("block", "message"), REFUSED)
def test_a_bad_block_moves_nothing_and_changes_nothing(metric, block, message):
    mode_matrix.check_refused(metric, [FIRST, "G91 G0 X3 Z5"], block, message)


def test_right_after_g40_nothing_moves(metric):
    message = "G12: the tool is still offset: after G40 move in X or Y first"
    before = [FIRST, "T1 M6", "G41", "G1 X30", "Y30", "G40"]
    mode_matrix.check_refused(metric, before, "G12 I30 R20 D10", message)


@settings(max_examples=40, deadline=None)
@given(block=mode_matrix.blocks("G13", "IRJKQLDX"))
def test_any_block_cuts_or_is_refused_in_words(metric, block):
    mode_matrix.check_cut_or_refused(metric, [FIRST, "G91 G0 X3"], block, "G13")
