# SPDX-License-Identifier: GPL-2.0-or-later
"""The cycles of all dialects on the stock interpreter: modes, units, refusals, messages.

Their geometry is proved in test_valid_cuts.py.
"""

import functools
from contextlib import ExitStack

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.preview.tracer import Tracer
from support import mode_matrix
from support.mode_matrix import event_call as call
from support.sim_machines import ROOT, SIM

INCH = mode_matrix.INCH
FIRST = "G21 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F300"
IN_INCHES = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F10"
EVENT_FIRST = [IN_INCHES, "F20", "T1 M6", "G0 X-1 Y-1 Z1"]

HAAS_TOOLS = {1: 0.25, 2: 0.5, 3: -0.25, 4: 0.0}
EVENT_TOOLS = {1: 0.5, 2: 0.0, 3: 12.0 / INCH}
METRIC_TOOLS = {1: 6.0, 3: -4.0, 10: 20.0}


def scaled(tools, factor):
    return {tool: diameter * factor for tool, diameter in tools.items()}


def remapped(include):
    lines = mode_matrix.remaps(ROOT / "configs" / "include" / f"g12_{include}.inc")
    return {"RS274NGC": {"REMAP": lines}}


MACHINES = {  # each dialect on a machine in inches and one in mm
    "haas inch": ("mill_inch", HAAS_TOOLS, None),
    "haas helix": ("mill_inch", HAAS_TOOLS, {"G12": {"ENTRY": "helix"}}),
    "haas mm": ("mill_mm", scaled(HAAS_TOOLS, INCH), None),
    "yasnac inch": ("mill_inch", scaled(METRIC_TOOLS, 1 / INCH), remapped("yasnac")),
    "yasnac mm": ("mill_yasnac_mm", METRIC_TOOLS, None),
    "mitsubishi inch": ("mill_inch", scaled(METRIC_TOOLS, 1 / INCH), remapped("mitsubishi")),
    "mitsubishi mm": ("mill_mitsubishi_mm", METRIC_TOOLS, None),
    "event inch": ("mill_inch", EVENT_TOOLS, None),
    "event mm": ("mill_mm", scaled(EVENT_TOOLS, INCH), None),
}


@pytest.fixture(scope="module")
def mill():
    """Return a function that opens a machine of `MACHINES`, each once."""
    with ExitStack() as opened:

        @functools.cache
        def machine(name):
            ini, tools, overrides = MACHINES[name]
            return opened.enter_context(
                Tracer(SIM / f"{ini}.ini", tools=tools, overrides=overrides)
            )

        yield machine


# ---------------------------------------------------------------- modes, units, work offsets


def haas_block(scale, incremental):
    x, y, z = (1.0, -1.0, -0.4) if incremental else (1.5, -0.75, -0.3)
    words = mode_matrix.words(scale, X=x, Y=y, I=0.2, K=0.9, Q=0.22, Z=z, F=12.0)
    return f"G13 {words} D1"


def yasnac_block(scale, incremental):
    lengths = mode_matrix.words(scale, I=1.9, R=0.7, K=1.1, Q=0.3, F=12.0)
    return f"G13 {lengths} D10 L2"


def mitsubishi_block(plane, scale, incremental):
    return f"{plane}\nG13 {mode_matrix.words(scale, I=1.9, F=12.0)} D10\nG17"


def event_block(scale, incremental):
    x, y, z = (1.0, -1.0, -0.6) if incremental else (1.5, -0.75, -0.5)
    lengths = mode_matrix.words(
        scale, X=x, Y=y, Z=z, I=0.1, E=0.4, R=1.2, K=0.25, J=0.3, Q=0.02, P=5.0, F=12.0
    )
    return f"G13.2 {lengths} D2 H2"


def event_call(scale, incremental):
    x, y, z = (1.0, -1.0, -0.6) if incremental else (1.5, -0.75, -0.5)
    lengths = dict(x=x, y=y, z=z, w=0.1, o=0.4, r=0.8, k=0.25, l=-0.02, p=5.0, f=12.0, v=9.0)
    return call(**{name: f"{value * scale:.10f}" for name, value in lengths.items()}, d=3, c=2)


CASES = [
    ("haas", haas_block),
    ("yasnac", yasnac_block),
    *(("mitsubishi", functools.partial(mitsubishi_block, each)) for each in ("G17", "G18", "G19")),
    ("event", event_block),
    ("event", event_call),
]


@pytest.mark.parametrize(("dialect", "block"), CASES)
def test_all_modes_make_the_same_machine_path(mill, dialect, block):
    inch, metric = mill(f"{dialect} inch"), mill(f"{dialect} mm")
    mode_matrix.check_same_path(inch, metric, mode_matrix.Case(block, feed=12.0))


# ---------------------------------------------------------------- refusals

AT = [IN_INCHES, "G1 X1 Y1 Z.1"]
AFTER_G40 = ["G41", "G1 X30", "Y30", "G40"]
OFFSET = "needs a move after G40: the tool is still beside the programmed point"
PLACE = "X1 Y2 Z-.5 I.1 R1.5"
POCKET_CALL = call(x=0, y=0, z=0, w=0.1, r=1, c=2)
REFUSED = [  # what a block says by itself is in unit/test_cycles.py
    ("haas inch", [IN_INCHES, "T3 M6"], "G12 I.75 Z-.1", "T3 in the spindle has the negative"),
    ("haas inch", AT, "G93 G12 I.5 Z-1 D1 F1", "needs G94 or G95, not G93"),
    ("haas helix", AT, "G12 I.13 Z-2 D1", "a helix of radius 0.005 needs "),
    *(("haas inch", AT, f"{other} G12 I.5 K1 Z-1 D1{more}",
       f"{other.split()[0]} cannot be in the same block")
      for other, more in (("G43.1 X1", ""), ("G64 P.1", ""), ("G43", " H2"), ("M6 T2", ""),
                          ("M61 Q2", ""), ("M68 E1 Q.1", ""), ("M19 R1", ""), ("M62 P5", ""),
                          ("G96 S100", ""))),
    *(("haas inch", AT, f"G12 I.5 Z-1 D1 {word}", f"{word} is not a word of this cycle, which")
      for word in ("E1", "H1", "@1", "^1")),
    ("yasnac mm", [FIRST, "T1 M6", *AFTER_G40], "G12 I30 R20 D10", OFFSET),
    ("event inch", [*EVENT_FIRST, "T0 M6"], f"G13.2 {PLACE} H2", "no tool is loaded: its"),
    ("event inch", [*EVENT_FIRST, "G41 D1"], POCKET_CALL, "needs G40"),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "before", "block", "rule"), REFUSED)
def test_a_refused_block_moves_nothing_and_changes_nothing(mill, machine, before, block, rule):
    code = next((word for word in block.split() if word[:3] in ("G12", "G13")), "circle_mill")
    keeps = ["motion_mode"] if machine == "haas inch" else None  # modes beside it may change
    mode_matrix.check_refused(mill(machine), before, block, f"{code}: {rule}", keeps)


STEPS = st.dictionaries(st.sampled_from("gworkjlpvdc"), mode_matrix.VALUES)
ANY = [
    ("haas inch", [IN_INCHES, "G0 Z.1"], "G13", mode_matrix.blocks("G13", "XYIKQLDZRJ")),
    ("yasnac mm", [FIRST, "G91 G0 X3"], "G13", mode_matrix.blocks("G13", "IRJKQLDX")),
    ("mitsubishi mm", [FIRST, "G91 G0 X3 G19"], "G13", mode_matrix.blocks("G13", "IDQ")),
    ("haas inch", [IN_INCHES, "G0 Z.1"], "G13.5", mode_matrix.blocks("G13.5", "XYIKQLDZRPEH")),
    ("haas inch", [IN_INCHES, "G0 Z.1"], "G12.6", mode_matrix.blocks("G12.6", "XYIKQLDZRPEHJ")),
    ("haas inch", [IN_INCHES, "G0 Z.1"], "G13.7", mode_matrix.blocks("G13.7", "XYIJKQDZRPEHL")),
    ("event inch", EVENT_FIRST, "G13.2",
     mode_matrix.blocks("G13.2", "IERDHKJQLP").map("{} X1 Y2 Z-3".format)),
    ("event inch", EVENT_FIRST, "circle_mill",
     STEPS.map(lambda values: call(**{"x": 1, "y": 2, "z": -3, "r": 1, "c": 2, "w": 0.1, **{
         letter: f"{value:.5f}" for letter, value in values.items()}}))),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "before", "name", "blocks"), ANY)
@settings(max_examples=30)
@given(data=st.data())
def test_any_block_cuts_or_is_refused_in_words(mill, machine, before, name, blocks, data):
    mode_matrix.check_cut_or_refused(mill(machine), before, data.draw(blocks), name)


# ---------------------------------------------------------------- messages

CUTTERS = {1: 6.0, 2: 10.0, 3: 6.1}


@pytest.mark.parametrize("machine", ["mill_mm", "mill_yasnac_mm", "mill_mitsubishi_mm"])
def test_one_message_for_each_tool_that_d_does_not_name(machine):
    """T1 and D3 differ by wear; the two D2 with T1 are one message; no radius but D's is cut."""
    lines = ["F300 T1 M6", "G12 I20 D2", "G13 I20 D2", "G12 I20 D3", "T2 M6", "G12 I20 D2"]
    with Tracer(SIM / f"{machine}.ini", tools=CUTTERS) as mill:
        traced = mill.trace_text([*lines, "G20", "G13 I1 D1", "G12 I1 D1", "M2"])
    assert traced.error is None
    assert [tuple(message) for message in traced.messages] == [
        (2, "G12: the cycle uses D2, diameter 10; the loaded tool T1 has 6"),
        (8, "G13: the cycle uses D1, diameter 0.23622 in; the loaded tool T2 has 0.393701 in"),
    ]
    reported = next(event for event in traced.events if "the cycle uses D2" in event.text)
    assert [move.block for move in traced.moves[: reported.at]] == []
    radii = [move.radius for move in traced.moves if move.block == 2 and move.kind == "arc"]
    assert max(radii) == pytest.approx(15.0)


def test_a_d_that_still_counts_is_reported_with_the_next_tool():
    lines = ["F300 T1 M6", "G12 I20 D1", "T2 M6", "G12 I20", "G12 I20", "M2"]
    with Tracer(SIM / "mill_mm.ini", tools=CUTTERS) as mill:
        traced = mill.trace_text(lines)
        refused = mill.trace_text(["F300 T1 M6", "G12 I3 D2", "M2"])
    text = "G12: the cycle uses the D last commanded, diameter 6; the loaded tool T2 has 10"
    assert [tuple(message) for message in traced.messages] == [(4, text)]
    assert refused.error and refused.messages == []


# ---------------------------------------------------------------- Yasnac


def test_an_approach_however_short_is_made_and_taken_back(mill):
    approach = 0.00006  # inches: LinuxCNC's NE takes it for 0
    block = f"G12 I1.5 R{10 / INCH + approach:.9f} D10"
    traced = mill("yasnac inch").trace_text([IN_INCHES, "G0 X1 Y2 Z-.1", block])
    assert traced.error is None, traced.error
    *_, last = traced.moves
    assert last.start[0] - last.end[0] == pytest.approx(approach * INCH, rel=1e-3)
    assert last.end[:2] == pytest.approx((1 * INCH, 2 * INCH), abs=1e-9)


def test_the_last_d_commanded_is_left_alone(mill):
    before = [FIRST, "G41 D1", "G40"]
    metric = mill("yasnac mm")
    assert metric.trace_text([*before, "G12 I50 D10"]).state == metric.trace_text(before).state
