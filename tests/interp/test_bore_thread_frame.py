# SPDX-License-Identifier: GPL-2.0-or-later
"""Bore, thread and frame on the stock interpreter: geometry, refusals, modes, the page's tables.

What a block must cut is computed from its words in support/hole_blocks.py.
"""

import random
import re
from fractions import Fraction
from math import sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support import hole_blocks, mode_matrix
from support.sim_machines import ROOT, SIM, kept_tracer, trace_text

KINDS = pytest.mark.parametrize("kind", hole_blocks.MAKERS)
SEEDS = st.integers(0, 10**9)

metric = kept_tracer("mill_mm", tools={**hole_blocks.TOOLS, 5: 0.0})
helical = kept_tracer("mill_mm", tools=hole_blocks.TOOLS, overrides={"G12": {"ENTRY": "helix"}})
inch = kept_tracer("mill_inch", tools={n: d / 25.4 for n, d in hole_blocks.TOOLS.items()})


@KINDS
@settings(max_examples=20, deadline=None)
@given(seed=SEEDS)
def test_any_valid_block_cuts_what_its_words_say(metric, helical, kind, seed):
    block = hole_blocks.MAKERS[kind](random.Random(seed))
    traced = (metric, helical)[seed % 2].trace_text([*block.before, block.text, "M2"])
    assert traced.error is None, traced.error
    hole_blocks.CHECKS[kind](block, traced.moves[1:])


WRONG = {  # words that replace those of a good block, and a word of the rule
    "G13.5 Z-5 R0 I4 P.2 D1": {
        "I0": "greater", "I-4": "greater", "I2.9": "greater", "P0": "greater", "P-1": "greater",
        "P": "missing", "P3": "ENTRY_ANGLE", "P5.1": "longer", "Z": "missing", "Z0": "below",
        "Z4": "below", "R6": "retract", "K-1": "least", "K4": "less", "K9": "less", "Q0": "greater",
        "Q-1": "greater", "D99": "table", "E1": "not a word", "H1": "not a word",
        "J1": "not a word", "I9": "cross a core", "Q7": "tool diameter", "D0": "no diameter",
        "L99990": "P, Q and L make",
    },
    "G13.5 Z-5 R0 I4.1 K4 P3 D1": {"K1": "ENTRY_ANGLE", "K": "ENTRY_ANGLE"},
    "G13.5 Z-5 R0 I20 K7 P1 D1": {"K6": "cross", "K7.9": "cross", "Q.00001": "P, Q and L make"},
    "G12.6 Z-9 R0 I6 K2 P1 H1 D3": {"K.05": "too thin", "E.45": "no diameter", "E.434": "too thin"},
    "G12.6 Z-9 R0 I6 P1 D1": {
        "I0": "greater", "I": "missing", "P": "missing", "P0": "left-hand", "P12": "too large",
        "P.006": "in size", "L99999": "P, Q and L make",
        "Z": "missing", "Z1": "below", "Z-.5": "longer", "R6": "retract", "K0": "greater",
        "K6": "less", "K2.9": "tool diameter", "K3.002": "tool diameter",
        "H2": "most", "H-1": "least", "J0": "least",
        "J1.5": "whole", "Q0": "greater", "Q-1": "greater", "D99": "table", "I3.2": "tool diameter",
        "E3": "more than the length", "E-2": "more than the length", "D5": "no diameter",
    },
    "G12.6 Z-9 R0 I3.5 P1 E-.1 D1": {"H0": "tool diameter"},
    "G13.7 Z-4 I40 J30 R3 E.2 D1": {"J6.3": "2 x E0.2"},
    "G13.7 Z-4 I40 J30 R5 D1": {
        "I0": "greater", "I-4": "greater", "I6": "half", "I": "missing", "J": "missing",
        "R": "missing", "R-1": "least", "R2": "tool radius", "R16": "half", "Z": "missing",
        "Z5": "below", "K0": "greater", "Q0": "greater", "Q-1": "greater", "P0": "greater",
        "Q.001": "least", "H3": "most", "E-1": "least", "E13": "tool radius", "E3.1": "tool radius",
        "L1": "not a word", "D99": "table", "Q4.21": "0.7", "D0": "no diameter",
    },
}  # fmt: skip
CASES = [(good, wrong, rule) for good, rows in WRONG.items() for wrong, rule in rows.items()]
BEFORE = "G21 G17 G40 G49 G54 G64 P.01 G80 G90 G91.1 G94 F300\nT1 M6\nG0 X1 Y2 Z5"


@pytest.mark.parametrize(("good", "wrong", "rule"), CASES)
def test_a_wrong_word_is_refused_and_nothing_moves(metric, good, wrong, rule):
    words = [word for word in good.split() if word[0] != wrong[0]]
    block = " ".join([*words, wrong if len(wrong) > 1 else ""])
    code = words[0]
    traced = metric.trace_text([*BEFORE.splitlines(), block, "M2"])
    assert traced.error is not None and len(traced.moves) == 1
    assert rule in traced.error.text
    assert traced.error.text.startswith(f"{code} line 4: ")


def test_a_helix_may_be_steep_where_its_centre_runs_over_an_open_hole(metric):
    steep = "G13.5 Z-5 R0 I4.1 K4 P3 D1"
    traced = metric.trace_text([*BEFORE.splitlines(), steep, "M2"])
    assert traced.error is None and min(move.end[2] for move in traced.moves) == -5


def written(code, scale, incremental, numbers="", **values):
    if incremental:
        values |= {"X": values["X"] - 0.5, "Y": values["Y"] - 0.25, "Z": values["Z"] - 0.1}
    return f"{code} {mode_matrix.words(scale, **values)} {numbers}"


def bore_block(scale, incremental):
    return written("G13.5", scale, incremental, "D1 L1", X=1, Y=2, Z=-0.5, I=0.4, P=0.01, Q=0.1)


def thread_block(scale, incremental):
    return written("G12.6", scale, incremental, "D1 J2 E0.05", X=1, Y=2, Z=-0.5, I=0.4, P=0.05)


def frame_block(scale, incremental):
    return written("G13.7", scale, incremental, "D1 H0", X=1, Y=2, Z=-0.5, I=2, J=3, R=0.3, K=0.2,
                   E=0.01, P=9)  # fmt: skip


@pytest.mark.parametrize("block", [bore_block, thread_block, frame_block])
def test_all_modes_make_the_same_machine_path(inch, metric, block):
    mode_matrix.check_same_path(inch, metric, mode_matrix.Case(block, feed=12.0))


def test_a_frame_along_the_limits_of_a_turned_system_fits():
    """Its corners are not those of the circle round it: 900 of 1,000 mm are in the travel."""
    before = "G21 G17 G40 G54 G64 P.01 G90 G94 F300\nT1 M6"
    good = "G13.7 Z-1 I900 J60 R5 H1 D1"
    fits = trace_text([before, good, "M2"], SIM / "mill_mm.ini", tools={1: 6.0})
    assert fits.error is None and max(move.end[0] for move in fits.moves) == pytest.approx(447)


def test_a_frame_hardly_wider_than_its_first_ring_has_one(metric):
    traced = metric.trace_text([*BEFORE.splitlines(), "G13.7 Z-4 I40 J11.402 R5 D1", "M2"])
    assert traced.error is None


# ---------------------------------------------------------------- the page's tables

ROW = re.compile(r"^\| (\S+?)(?: (UNC|UNF|NPT))? \| ([\d. |]+) \|$", re.MULTILINE)
HEIGHT = sqrt(3) / 2
PIPE = {  # ANSI B1.20.1: outside diameter, threads per inch, hand-tight length
    "1/8": (0.405, 27, 0.1615), "1/4": (0.540, 18, 0.2278), "3/8": (0.675, 18, 0.240),
    "1/2": (0.840, 14, 0.320), "3/4": (1.050, 14, 0.339), "1": (1.315, 11.5, 0.400),
}  # fmt: skip
COARSE = {3: 0.5, 4: 0.7, 5: 0.8, 6: 1, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2, 16: 2, 18: 2.5, 20: 2.5,
          22: 2.5, 24: 3, 27: 3, 30: 3.5}  # fmt: skip


def test_the_threads_of_the_page_are_computed():
    found = ROW.findall((ROOT / "ngc" / "thread.md").read_text(encoding="utf-8"))
    kinds = [kind for _, kind, _ in found]
    assert [kinds.count(kind) for kind in ("", "UNC", "UNF", "NPT")] == [15, 10, 10, 6]
    for name, kind, cells in found:
        shown = [float(cell) for cell in cells.split(" | ")]
        if kind == "NPT":
            size, per_inch = name.rsplit("-", 1)
            outside, threads, hand_tight = PIPE[size]
            assert float(per_inch) == threads
            small = outside - (0.05 * outside + 1.1) / threads  # pitch diameter at the pipe's end
            at_face, height = small + hand_tight / 16, 0.8 / threads
            depths = [shown.pop(3), shown.pop()]  # with the wrench's turns; the effective thread
            effective = (0.8 * outside + 6.8) / threads
            assert depths == pytest.approx([hand_tight + 3 / threads, effective], abs=6e-4)
            due = [1 / threads, (at_face + height) / 2, (at_face - height) / 2,
                   (small + height) / 2, (small - height) / 2]  # fmt: skip
        else:
            size, _, per_inch = name.removeprefix("M").partition("-")
            pitch = 1 / float(per_inch) if kind else COARSE[int(size)]
            large = float(Fraction(size)) / 2
            due = [large, pitch, large - 5 / 8 * HEIGHT * pitch, large - 17 / 24 * HEIGHT * pitch]
        assert shown == pytest.approx(due, abs=6e-4 if not kind else 6e-5), name
