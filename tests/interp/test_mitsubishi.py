# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Mitsubishi dialect on the stock interpreter: three planes, modes, refusals."""

import pytest
from hypothesis import given, settings

from support import mode_matrix
from support.sim_machines import ROOT, kept_tracer

TOOLS = {1: 6.0, 3: -4.0, 10: 20.0}
FIRST = "G21 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F300"
REMAPS = {"RS274NGC": {"REMAP": mode_matrix.remaps(ROOT / "configs/include/g12_mitsubishi.inc")}}
AXES = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}  # first and second axis of the plane


IN_INCHES = {tool: diameter / mode_matrix.INCH for tool, diameter in TOOLS.items()}
metric = kept_tracer("mill_mitsubishi_mm", tools=TOOLS)
inch = kept_tracer("mill_inch", tools=IN_INCHES, overrides=REMAPS)


# ---------------------------------------------------------------- modes, units, work offsets


@pytest.mark.parametrize("plane", AXES)
@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates, plane):
    def block(scale, incremental):
        return f"{plane}\nG13 {mode_matrix.words(scale, I=1.9, F=12.0)} D10\nG17"

    case = mode_matrix.Case(block, feed=12.0)
    mode_matrix.check_same_path(inch, metric, coordinates, case)


# ---------------------------------------------------------------- refusals on the interpreter

REFUSED = [  # the sentences are those of unit/test_mitsubishi.py
    ("G12 I50", "G12: D is missing: the tool whose radius reduces the circle, D0 for none"),
    ("G13 I10 D10", "G13: I10 must be greater than the tool radius 10 (D10) by at least 0.00508"),
    ("G12 I50 D77", "G12: D77 is not in the tool table"),
    ("G12 I50 D10 X1", "G12: X1 is not a word of this cycle, which knows I D F"),
]


@pytest.mark.parametrize(("block", "message"), REFUSED)
def test_a_bad_block_moves_nothing_and_changes_nothing(metric, block, message):
    mode_matrix.check_refused(metric, [FIRST, "G91 G0 X3 Z5 G18"], block, message)


@settings(max_examples=60, deadline=None)
@given(block=mode_matrix.blocks("G13", "IDQ"))
def test_any_block_cuts_or_is_refused_in_words(metric, block):
    mode_matrix.check_cut_or_refused(metric, [FIRST, "G91 G0 X3 G19"], block, "G13")
