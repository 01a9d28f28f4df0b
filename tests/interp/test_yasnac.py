# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Yasnac dialect on the stock interpreter: geometry, modes, refusals."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.preview.tracer import Tracer
from support import cut_geometry, mode_matrix
from support.sim_machines import PROGRAMS, ROOT, SIM

TOOLS = {1: 6.0, 3: -4.0, 10: 20.0}
FIRST = "G21 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F300"
REMAPS = {"RS274NGC": {"REMAP": mode_matrix.remaps(ROOT / "configs/include/g12_yasnac.inc")}}


@pytest.fixture(scope="module")
def metric():
    with Tracer(SIM / "mill_yasnac_mm.ini", tools=TOOLS) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def inch():
    tools = {number: diameter / mode_matrix.INCH for number, diameter in TOOLS.items()}
    with Tracer(SIM / "mill_inch.ini", overrides=REMAPS, tools=tools) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def traversing():
    settings = {"G12": {"YASNAC_TRAVERSE": 1500}}
    with Tracer(SIM / "mill_yasnac_mm.ini", overrides=settings, tools=TOOLS) as tracer:
        yield tracer


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


def described(traced):
    """Return kind, end, and for an arc turns and its half-way point of each move, in XY."""
    return [
        (
            move.kind,
            *np.round(move.end[:2], 9),
            *((move.turns, *np.round(move.point(0.5)[:2], 9)) if move.kind == "arc" else ()),
        )
        for move in traced.moves
    ]


GOLDEN = [
    ("rapid", 30, 0),
    ("arc", 40, 0, -1, 35, 5),
    ("arc", 40, 0, -1, -40, 0),
    ("arc", 30, 0, -1, 35, -5),
    ("rapid", 0, 0),
]


def test_golden_circle_with_a_traverse_section(metric):
    assert described(cut(metric, "G12 I50 R40 D10")) == GOLDEN
    assert described(cut(metric, "G12 I50 J40 D10")) == GOLDEN


def test_the_manual_s_example(metric):
    traced = metric.trace(PROGRAMS / "yasnac" / "example.ngc")
    assert traced.error is None
    (down,) = [index for index, move in enumerate(traced.moves) if move.end[2] == -10.0][:1]
    assert described(traced)[down + 1 : -1] == GOLDEN
    assert {move.end[2] for move in traced.moves[down:-1]} == {-10.0}
    assert traced.position[:3] == (0, 0, 30)


def test_golden_spiral(metric):
    traced = cut(metric, "G13 I50 R20 K46 Q3 L2 D10")
    assert described(traced) == [
        ("rapid", 10, 0),
        ("arc", 36, 0, 1, 23, -13),
        ("arc", -37.5, 0, 1, -0.75, 36.75),
        ("arc", 39, 0, 1, 0.75, -38.25),
        ("arc", -39.5, 0, 1, -0.25, 39.25),
        ("arc", 40, 0, 1, 0.25, -39.75),
        ("arc", 40, 0, 1, -40, 0),
        ("arc", 40, 0, 1, -40, 0),
        ("arc", 10, 0, 1, 25, 15),
        ("rapid", 0, 0),
    ]


def test_without_d_the_circle_is_not_compensated(metric):
    traced = cut(metric, "T10 M6", "G12 I60 D10", "G12 I50")
    assert cut_geometry.radii(traced.moves) == pytest.approx([50, 50])


# ---------------------------------------------------------------- any valid block


@st.composite
def circles(draw):
    """Return a valid block with its numbers, in mm."""
    number, radius = draw(st.sampled_from([(None, 0.0), (0, 0.0), (1, 3.0), (10, 10.0)]))
    steps = [round(draw(st.floats(0.05, 20.0)), 4) for _ in range(3)]
    traversed, spiralling = draw(st.booleans()), draw(st.booleans())
    side = draw(st.sampled_from([1, -1]))
    inner = radius + (steps[0] if traversed else 0.0)
    first = (inner if traversed else radius) + steps[1]
    finished = first + steps[2]
    pitch = round(draw(st.floats(0.2, 15.0)), 4)
    circles = draw(st.integers(1, 3))
    words = [f"I{side * finished:.4f}"]
    words += [f"{draw(st.sampled_from('RJ'))}{side * inner:.4f}"] if traversed else []
    words += [f"K{side * first:.4f}", f"Q{pitch:.4f}"] if spiralling else []
    words += [] if number is None else [f"D{number}"]
    words += [f"L{circles}"] if circles > 1 or draw(st.booleans()) else []
    code = draw(st.sampled_from(["G12", "G13"]))
    return {
        "block": " ".join([code, *draw(st.permutations(words))]),
        "side": side,
        "approach": side * (inner - radius) if traversed else 0.0,
        "first": first - radius if spiralling else None,
        "pitch": pitch,
        "radius": finished - radius,
        "circles": circles,
        "turns": -1 if code == "G12" else 1,
    }


@settings(max_examples=60, deadline=None)
@given(circle=circles())
def test_any_valid_block_cuts_its_circle(metric, circle):
    traced = cut(metric, "G0 X7 Y-3 Z-2", circle["block"])
    moves = cut_geometry.moving(traced.moves)[1:]
    cutting = cut_geometry.cutting(moves)
    assert {round(move.end[2], 9) for move in moves} == {-2}
    assert {move.turns for move in cutting} == {circle["turns"]}
    assert cut_geometry.largest_jump(cutting) < 0.001
    rapids = [tuple(np.round(move.end[:2], 6)) for move in moves if move.kind == "rapid"]
    approach = (round(7 + circle["approach"], 6), -3)
    assert rapids == ([approach, (7, -3)] if circle["approach"] else [])
    assert cutting[0].start[:2] == pytest.approx(approach, abs=1e-6)
    assert cutting[-1].end[:2] == pytest.approx(approach, abs=1e-6)
    check_circles(cut_geometry.full_circles(cutting), circle)
    check_spiral(cutting, circle)
    points = cut_geometry.dense_points(cutting, step=1.0)
    distance = np.hypot(points[:, 0] - 7, points[:, 1] + 3)
    assert distance.max() <= circle["radius"] + 1e-6


def test_an_approach_however_short_is_made_and_taken_back(inch):
    approach = 0.00006  # inches: LinuxCNC's NE takes it for 0
    offset = 0.5 * TOOLS[10] / mode_matrix.INCH
    traced = cut(inch, "G20 F10", "G0 X1 Y2 Z-.1", f"G12 I1.5 R{offset + approach:.9f} D10")
    *_, last = traced.moves
    assert last.start[0] - last.end[0] == pytest.approx(approach * mode_matrix.INCH, rel=1e-3)
    assert last.end[:2] == pytest.approx((1 * mode_matrix.INCH, 2 * mode_matrix.INCH), abs=1e-9)


def check_circles(found, circle):
    assert len(found) == circle["circles"]
    for each in found:
        assert (each.x, each.y, each.radius) == pytest.approx((7, -3, circle["radius"]), abs=1e-6)


def check_spiral(cutting, circle):
    """Check the half turns between the lead-in and the finished circle."""
    half_turns = cutting[1 : -1 - circle["circles"]]
    if circle["first"] is None:
        assert half_turns == []
        return
    ends = [cutting[0].end, *(move.end for move in half_turns)]
    across = [end[0] - 7 for end in ends]
    assert [end[1] for end in ends] == pytest.approx([-3] * len(ends), abs=1e-9)
    assert across[0] == pytest.approx(circle["side"] * circle["first"], abs=1e-6)
    assert np.sign(across[1:]) == pytest.approx(-np.sign(across[:-1]))
    growth = np.diff(np.abs(across))
    assert growth.max() <= circle["pitch"] / 2 + 1e-5
    assert growth.min() > 0
    assert len(half_turns) == 2 * math.ceil(
        (circle["radius"] - circle["first"] - 1e-6) / circle["pitch"]
    )


@pytest.mark.parametrize("words", ["I50 R40 D10", "I50 R30 K36 Q6 D10", "I-50 R-40 D10 L2"])
def test_swept_area_is_what_a_bored_hole_leaves(metric, words):
    traced = cut(metric, f"G12 {words}")
    swept = cut_geometry.swept(cut_geometry.cutting(traced.moves), 10.0)
    finished, bored = cut_geometry.disc(0, 0, 50.0), cut_geometry.disc(0, 0, 32.0)
    assert swept.difference(finished.buffer(0.001)).area == pytest.approx(0, abs=1e-6)
    assert finished.buffer(-0.001).difference(bored.union(swept)).area == pytest.approx(0, abs=1e-3)


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


def test_without_r_nothing_moves_fast(traversing):
    traced = cut(traversing, "G12 I50 D10")
    assert [move.kind for move in traced.moves] == ["arc"] * 3


# ---------------------------------------------------------------- modes, units, work offsets


def spiral_block(scale, incremental):
    lengths = mode_matrix.words(scale, I=1.9, R=0.7, K=1.1, Q=0.3, F=12.0)
    return f"G13 {lengths} D10 L2"


@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates):
    mode_matrix.check_same_path(
        inch, metric, coordinates, mode_matrix.Case(spiral_block, feed=12.0)
    )


@pytest.mark.parametrize("motion", ["G0", "G1", "G2", "G3", "G80"])
def test_the_motion_mode_is_what_it_was(metric, motion):
    first = {"G2": "G2 I1", "G3": "G3 I1", "G80": "G80"}.get(motion, f"{motion} X0")
    assert motion in cut(metric, first, "G12 I50 R40 D10").modes.gcodes


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
    message = "G12: the tool still stands offset: after G40 move in X or Y first"
    before = [FIRST, "T1 M6", "G41", "G1 X30", "Y30", "G40"]
    mode_matrix.check_refused(metric, before, "G12 I30 R20 D10", message)


@settings(max_examples=40, deadline=None)
@given(block=mode_matrix.blocks("G13", "IRJKQLDX"))
def test_any_block_cuts_or_is_refused_in_words(metric, block):
    mode_matrix.check_cut_or_refused(metric, [FIRST, "G91 G0 X3"], block, "G13")
