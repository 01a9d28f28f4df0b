# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Haas dialect on the stock interpreter: D, codes in the block, helix and plunge.

Modes, units and refusals are in test_cycles.py, the geometry in test_valid_cuts.py.
"""

import pytest

from g12.tools.preview.tracer import Tracer
from support import cut_geometry
from support.sim_machines import SIM, kept_tracer

INCH = 25.4
FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F10"


inch = kept_tracer("mill_inch", tools={1: 0.25, 2: 0.5, 3: -0.25, 4: 0.0})


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


# ---------------------------------------------------------------- codes in the block


@pytest.mark.parametrize("codes", ["M8 M3 S100 M48 T2", "M9 S200"])
def test_spindle_coolant_and_tool_preparation_may_stand_in_the_block(inch, codes):
    traced = cut(inch, "G0 Z.1", f"G12 I.5 Z-.1 D1 {codes}")
    assert [r / INCH for r in cut_geometry.radii(traced.moves)] == pytest.approx([0.375])


def test_right_after_g40_the_plunge_does_not_slant(inch):
    traced = cut(inch, "T2 M6", "G41", "G1 X1", "Y1", "G40", "G12 X1 Y1 I.26 Z-1")
    falling = [move for move in cut_geometry.cutting(traced.moves) if move.end[2] < move.start[2]]
    assert [move.start[:2] for move in falling] == [move.end[:2] for move in falling] != []


# ---------------------------------------------------------------- the D last commanded


@pytest.mark.parametrize(
    ("blocks", "radius"),
    [
        (["T1 M6", "G12 I.6 Z-.1", "T2 M6"], 0.25),
        (["G12 I.6 Z-.1 D1", "T2 M6", "G12 I.6 Z-.1"], 0.125),
        (["T2 M6", "G12 I.6 Z-.1 D0"], 0.0),
        (["T2 M6", "G41 D1", "G40"], 0.125),
        (["T2 M6", "G41", "G40"], 0.25),
        (["T2 M6", "G12 I.6 Z-.1 D1", "G41 D4", "G40"], 0.0),
        (["G42 D1", "G40", "G12 I.6 Z-.1 D2"], 0.25),
        (["G12 I.6 Z-.1 D0", "G42 D1", "G40"], 0.125),
        (["G42 D1", "G40", "G12 I.6 Z-.1 D0"], 0.0),
    ],
)
def test_without_d_the_last_commanded_one_counts(inch, blocks, radius):
    traced = cut(inch, *blocks, "G0 X0 Y0", "G13 I.75 Z-.1")
    assert cut_geometry.radii(traced.moves)[-1] / INCH == pytest.approx(0.75 - radius)


def test_without_d_the_last_one_follows_the_units(inch):
    traced = cut(inch, "G12 I.6 Z-.1 D1", "G21", "G12 I20 Z-2 F200")
    assert cut_geometry.radii(traced.moves)[-1] == pytest.approx(20 - 0.125 * INCH)


def test_neither_a_refused_block_nor_one_without_d_stores_one(inch):
    traced = inch.trace_text([FIRST, "G12 I.6 Z-.1 D1", "G12 I.6 Z-.1 K.3 Q.1 D2"])
    assert traced.error
    assert traced.state["cutter_comp_radius"] == pytest.approx(0.125)
    traced = inch.trace_text([FIRST, "T1 M6", "G12 I.6 Z-.1", "T0 M6", "G12 I.6 Z-.1"])
    assert traced.error.text.startswith("G12 line 5: D is missing")


BEFORE = "the D of what ran before"
NONE_ABOVE = "G13: no D above this block in the program: "
LOADED = f"{NONE_ABOVE}the loaded tool T2 counts, diameter 0.5, or {BEFORE}. Give D"


@pytest.mark.parametrize(
    ("blocks", "told"),
    [
        (["T2 M6"], [LOADED]),
        (["T2 M6", "G13 I.6 Z-.1"], [LOADED]),
        (["T2 M6", "(G41)", "; G42"], [LOADED]),
        (["T2 M6", "G13 I.6 Z-.1", "G13 I.6 Z-.1 D2"], [LOADED]),
        (["T2 M6", "G13 I.6 Z-.1 D2"], []),
        (["T2 M6", "N5 (on) g 42.1 D.5", "G40"], []),
        (["T2 M6", "o1 repeat [2]", "G13 I.6 Z-.1 D2", "o1 endrepeat"], []),
        (["T2 M6", "o<s> sub", "G13 I.6 Z-.1 D2", "o<s> endsub", "o<s> call"], []),
    ],
)
def test_a_cutter_that_depends_on_what_ran_before_is_reported_once(inch, blocks, told):
    traced = cut(inch, *blocks, "G0 X0 Y0", "G13 I.75 Z-.1", "G13 I.75 Z-.1")
    assert [message.text.strip() for message in traced.messages] == told


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ("G10 L1 P2 R.24",
         ["G13: D2 has the diameter 0.48 in the tool table now, but counts as it was commanded, "
          "with 0.5. Give D2 again"]),
        ("G10 L1 P2 R.25", []),
        ("G10 L1 P1 R.2", []),
    ],
)  # fmt: skip
def test_a_line_of_the_table_that_has_changed_since_d_is_reported_once(inch, change, told):
    traced = cut(inch, "T2 M6", "G13 I.6 Z-.1 D2", change, *["G13 I.75 Z-.1"] * 2)
    assert [message.text.strip() for message in traced.messages] == told
    assert cut_geometry.radii(traced.moves)[-1] / INCH == pytest.approx(0.5)
    again = cut(inch, "T2 M6", "G13 I.6 Z-.1 D2", change, "G13 I.75 Z-.1 D2")
    assert again.messages == []


# ---------------------------------------------------------------- plunge


def test_half_of_the_least_feed_down_and_all_of_it_elsewhere():
    """LinuxCNC's EQ takes numbers 0.0001 apart for equal."""
    overrides = {"G12": {"PLUNGE_FEED": 50}}
    with Tracer(SIM / "mill_inch.ini", tools={1: 0.5}, overrides=overrides) as machine:
        traced = cut(machine, "G95 S1000 F0.00015", "G0 X1 Y2 Z0.1", "G13 I.4 Z-.3 D1")
    down, *plane = [move.feed / INCH for move in traced.moves if move.kind != "rapid"]
    assert [down, *plane] == pytest.approx([0.000075, *[0.00015] * len(plane)])
