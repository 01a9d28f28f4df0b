# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Haas dialect on the stock interpreter: depth, D, modes, refusals.

Their geometry is proved in test_valid_programs.py.
"""

import pytest
from hypothesis import given, settings

from support import cut_geometry, mode_matrix
from support.sim_machines import kept_tracer

INCH = 25.4
TOOLS = {1: 0.25, 2: 0.5, 3: -0.25, 4: 0.0}
FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F10"


inch = kept_tracer("mill_inch", tools=TOOLS)
metric = kept_tracer("mill_mm", tools={tool: d * INCH for tool, d in TOOLS.items()})


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


def test_a_tool_of_the_table_has_its_unit_where_the_programs_is_another(inch, metric):
    for tracer, unit, radius in ((inch, "G21", "3.175 mm"), (metric, "G20", "0.125 in")):
        traced = tracer.trace_text([FIRST.replace("G20", unit), "G13 I.05 Z-1 D1"])
        reported = f"G13 line 2: I0.05 must be greater than the tool radius {radius} (D1)"
        assert traced.error.text == reported


# ---------------------------------------------------------------- modes, units, work offsets


def pocket_block(scale, incremental):
    x, y, z = (1.0, -1.0, -0.4) if incremental else (1.5, -0.75, -0.3)
    words = mode_matrix.words(scale, X=x, Y=y, I=0.2, K=0.9, Q=0.22, Z=z, F=12.0)
    return f"G13 {words} D1"


POCKET = mode_matrix.Case(pocket_block, feed=12.0)


@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates):
    mode_matrix.check_same_path(inch, metric, coordinates, POCKET)


@pytest.mark.parametrize("motion", ["G0", "G1", "G2", "G3", "G80"])
def test_the_motion_mode_is_what_it_was(inch, motion):
    first = {"G2": "G2 I.1", "G3": "G3 I.1", "G80": "G80"}.get(motion, f"{motion} X0")
    traced = cut(inch, first, "G12 I.3 Z-.1 D1")
    assert motion in traced.modes.gcodes


def test_a_g91_in_the_block_stays(inch):
    assert "G91" in cut(inch, "G12 G91 I.3 Z-.1 D1").modes.gcodes


def test_g7_in_the_block_reads_x_as_a_diameter_and_nothing_else(inch):
    plain = cut(inch, "G12 X1 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    traced = cut(inch, "G7 G12 X2 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    ends = [[move.end for move in found.moves] for found in (plain, traced)]
    assert ends[0] == ends[1]
    assert "G7" in traced.modes.gcodes


# ---------------------------------------------------------------- the D last commanded


@pytest.mark.parametrize(
    ("blocks", "radius"),
    [
        (["T2 M6"], 0.25),
        (["T1 M6", "G12 I.6 Z-.1", "T2 M6"], 0.25),
        (["G12 I.6 Z-.1 D1", "T2 M6", "G12 I.6 Z-.1"], 0.125),
        (["T2 M6", "G12 I.6 Z-.1 D1"], 0.125),
        (["T2 M6", "G12 I.6 Z-.1 D0"], 0.0),
        (["T2 M6", "G41 D1", "G40"], 0.125),
        (["T2 M6", "G41", "G40"], 0.25),
        (["G12 I.6 Z-.1 D2", "G42 D1", "G40"], 0.125),
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


def test_a_refused_block_stores_no_d(inch):
    traced = inch.trace_text([FIRST, "G12 I.6 Z-.1 D1", "G12 I.6 Z-.1 K.3 Q.1 D2"])
    assert traced.error
    assert traced.state["cutter_comp_radius"] == pytest.approx(0.125)


# ---------------------------------------------------------------- refusals


REFUSED = [  # what a block says by itself is in unit/test_haas.py
    ("G12 I.5 Z-1 D9", "G12: D9 is not in the tool table"),
    ("G12 I.5 Z-1 D3", "G12: D3 has the negative diameter -0.25 in the tool table"),
    ("G12 I.5 Z-1", "G12: D is missing, none was commanded before and no tool"),
    ("G93 G12 I.5 Z-1 D1 F1", "G12: needs feed per minute or revolution (G94, G95), but G93"),
    ("G18 G12 I.5 Z-1 D1", "G12: needs the XY plane G17, but G18 is active"),
    ("G95 S0 F.1 G12 I.5 Z-1 D1", "G12: needs a spindle speed for feed per revolution (G95)"),
    ("G43.1 Z1 G12 I.5 D1", "G12: G43.1 cannot be in the same block"),
    ("G64 P.1 G12 I.5 Z-1 D1", "G12: G64 cannot be in the same block"),
    ("G43 G12 I.5 Z-1 D1 H2", "G12: G43 cannot be in the same block"),
    ("G12 I.5 Z-1 T2 M6", "G12: M6 cannot be in the same block"),
    ("M61 Q2 G12 I.5 K1 Z-1 D1", "G12: M61 cannot be in the same block"),
    ("M68 E1 Q.1 G12 I.5 K1 Z-1 D1", "G12: M68 cannot be in the same block"),
    ("M19 R1 G12 I.5 Z-1 D1", "G12: M19 cannot be in the same block"),
    ("M62 P5 G12 I.5 Z-1 D1", "G12: M62 cannot be in the same block"),
    ("G96 S100 G12 I.5 Z-1 D1", "G12: G96 cannot be in the same block"),
    ("G41 D1 G12 I.5 Z-1", "G12: brings its own cutter compensation: program G40 first"),
    *(
        (f"G12 I.5 Z-1 D1 {word}", f"G12: {word} is not a word of this cycle, which knows X Y Z")
        for word in ("E1", "H1", "@1", "^1")
    ),
]


@pytest.mark.parametrize(("block", "message"), REFUSED)
def test_a_refused_block_names_word_rule_and_value(inch, block, message):
    before = [FIRST, "G1 X1 Y1 Z.1"]
    mode_matrix.check_refused(inch, before, block, message, keeps=["motion_mode"])


def test_without_a_tool_a_cycle_before_does_not_count_as_a_d(inch):
    traced = inch.trace_text([FIRST, "T1 M6", "G12 I.6 Z-.1", "T0 M6", "G12 I.6 Z-.1"])
    assert traced.error.text.startswith("G12 line 5: D is missing")


def test_a_negative_diameter_in_the_spindle_is_refused(inch):
    message = "G12: T3 in the spindle has the negative diameter -0.25 in the tool table"
    mode_matrix.check_refused(inch, [FIRST, "T3 M6"], "G12 I.75 Z-.1", message)


def test_right_after_g40_the_plunge_must_not_slant(inch):
    offset = [FIRST, "T2 M6", "G41", "G1 X1", "Y1"]
    message = "G12: the tool is still offset: after G40 move in X or Y first"
    mode_matrix.check_refused(inch, [*offset, "G40"], "G12 I.26 Z-1", message)
    moved = inch.trace_text([*offset, "G40", "G12 X1 Y1 I.26 Z-1"])
    (plunge,) = [
        move
        for move in cut_geometry.cutting(moved.moves)
        if abs(cut_geometry.tangent(move, 0.5)[2]) > 0.1
    ]
    assert plunge.start[:2] == pytest.approx(plunge.end[:2])


@pytest.mark.parametrize("code", ["M8", "M3 S100", "M9", "M48", "S200", "T2"])
def test_spindle_coolant_and_tool_preparation_may_stand_in_the_block(inch, code):
    traced = cut(inch, "G0 Z.1", f"G12 I.5 Z-.1 D1 {code}")
    assert [r / INCH for r in cut_geometry.radii(traced.moves)] == pytest.approx([0.375])


@settings(max_examples=60)
@given(block=mode_matrix.blocks("G13", "XYIKQLDZRJ"))
def test_any_block_cuts_or_is_refused_in_words(inch, block):
    mode_matrix.check_cut_or_refused(inch, [FIRST, "G0 Z.1"], block, "G13")
