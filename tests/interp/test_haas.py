# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Haas dialect on the stock interpreter: D, codes in the block, helix and plunge.

Modes, units and refusals are in test_cycles.py, the geometry in test_valid_programs.py.
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


@pytest.mark.parametrize("motion", ["G0 X0", "G1 X0", "G2 I.1", "G3 I.1", "G80"])
def test_the_motion_mode_is_what_it_was(inch, motion):
    assert motion.split()[0] in cut(inch, motion, "G12 I.3 Z-.1 D1").modes.gcodes


def test_a_g91_in_the_block_stays(inch):
    assert "G91" in cut(inch, "G12 G91 I.3 Z-.1 D1").modes.gcodes


def test_g7_in_the_block_reads_x_as_a_diameter_and_nothing_else(inch):
    plain = cut(inch, "G12 X1 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    traced = cut(inch, "G7 G12 X2 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    assert [move.end for move in plain.moves] == [move.end for move in traced.moves]
    assert "G7" in traced.modes.gcodes


@pytest.mark.parametrize("code", ["M8", "M3 S100", "M9", "M48", "S200", "T2"])
def test_spindle_coolant_and_tool_preparation_may_stand_in_the_block(inch, code):
    traced = cut(inch, "G0 Z.1", f"G12 I.5 Z-.1 D1 {code}")
    assert [r / INCH for r in cut_geometry.radii(traced.moves)] == pytest.approx([0.375])


def test_right_after_g40_the_plunge_must_not_slant(inch):
    offset = [FIRST, "T2 M6", "G41", "G1 X1", "Y1", "G40"]
    refused = inch.trace_text([*offset, "G12 I.26 Z-1"]).error
    assert refused.text.endswith("the tool is still offset: after G40 move in X or Y first")
    moved = inch.trace_text([*offset, "G12 X1 Y1 I.26 Z-1"])
    (plunge,) = [
        move
        for move in cut_geometry.cutting(moved.moves)
        if abs(cut_geometry.tangent(move, 0.5)[2]) > 0.1
    ]
    assert plunge.start[:2] == pytest.approx(plunge.end[:2])


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
        (["G12 I.6 Z-.1 D1", "G21", "G20"], 0.125),
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
        (["T2 M6", "G13 I.6 Z-.1 D0"], []),
        (["T2 M6", "G41", "G40"], []),
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


# ---------------------------------------------------------------- helix and plunge


helical = kept_tracer("mill_inch", tools={1: 0.5}, overrides={"G12": {"ENTRY": "helix"}})


def program(block, first=FIRST):
    """Return a program that cuts a pocket about X1 Y2 from Z.1."""
    return [first, "G0 X1 Y2 Z0.1", block, "M2"]


def pocket(machine, *arguments):
    """Return the moves at a feed of a pocket, those of them that fall, and the trace."""
    found = machine.trace_text(program(*arguments))
    assert found.error is None, found.error
    moves = [move for move in found.moves if move.kind != "rapid"]
    return moves, [move for move in moves if move.start[2] - move.end[2] > 1e-9], found


def test_a_pocket_that_needs_no_way_down_has_no_helix(helical):
    for depth, message in (("", ""), ("Z.5", "lost its minus sign")):
        _, falling, found = pocket(helical, f"G12 I.75 {depth} D1")
        assert not falling
        assert message in "".join(each.text for each in found.messages)


@pytest.mark.parametrize(
    ("entry", "block", "first", "feed"),
    [
        ("helix", "G13 I.4 K.8 Q.2 Z-.3 D1", FIRST, 10),
        # LinuxCNC's EQ takes numbers 0.0001 apart for equal
        ("plunge", "G13 I.4 Z-.3 D1", f"{FIRST}\nG95 S1000 F0.00015", 0.00015),
    ],
)
def test_half_of_the_feed_down_and_all_of_it_elsewhere(entry, block, first, feed):
    overrides = {"G12": {"ENTRY": entry, "PLUNGE_FEED": 50}}
    with Tracer(SIM / "mill_inch.ini", tools={1: 0.5}, overrides=overrides) as machine:
        moves, falling, found = pocket(machine, block, first)
    (down,), (plane,) = {move.feed for move in falling}, {
        move.feed for move in moves if move not in falling
    }  # fmt: skip
    assert (down, plane) == pytest.approx((feed / 2 * INCH, feed * INCH))
    assert found.modes.feed == pytest.approx(feed)
