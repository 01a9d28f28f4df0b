# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Mitsubishi dialect on the stock interpreter: three planes, modes, refusals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.preview.tracer import Tracer
from support import cut_geometry, mode_matrix
from support.sim_machines import ROOT, SIM

TOOLS = {1: 6.0, 3: -4.0, 10: 20.0}
FIRST = "G21 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F300"
REMAPS = {"RS274NGC": {"REMAP": mode_matrix.remaps(ROOT / "configs/include/g12_mitsubishi.inc")}}
AXES = {"G17": (0, 1), "G18": (2, 0), "G19": (1, 2)}  # first and second axis of the plane


@pytest.fixture(scope="module")
def metric():
    with Tracer(SIM / "mill_mitsubishi_mm.ini", tools=TOOLS) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def inch():
    tools = {number: diameter / mode_matrix.INCH for number, diameter in TOOLS.items()}
    with Tracer(SIM / "mill_inch.ini", overrides=REMAPS, tools=tools) as tracer:
        yield tracer


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


def in_its_plane(point, plane):
    return tuple(round(point[axis], 9) for axis in AXES[plane])


@pytest.mark.parametrize("plane", AXES)
@pytest.mark.parametrize(("code", "side"), [("G12", 1), ("G13", -1)])
def test_golden_circle_in_every_plane(metric, plane, code, side):
    traced = cut(metric, plane, f"{code} I50 D10")
    assert [move.kind for move in traced.moves] == ["arc"] * 3
    assert [in_its_plane(move.point(0.5), plane) for move in traced.moves] == [
        (20, side * 20),
        (-40, 0),
        (20, -side * 20),
    ]
    assert [in_its_plane(move.end, plane) for move in traced.moves] == [(40, 0), (40, 0), (0, 0)]
    assert {(move.plane, move.turns) for move in traced.moves} == {(int(plane[1:]), -side)}
    assert plane in traced.modes.gcodes


@settings(max_examples=60, deadline=None)
@given(
    plane=st.sampled_from(sorted(AXES)),
    code=st.sampled_from([("G12", -1), ("G13", 1)]),
    offset=st.sampled_from([("D0", 0.0), ("D1", 3.0), ("D10", 10.0), ("D3", -2.0)]),
    room=st.floats(0.0052, 90.0).map(lambda value: round(value, 4)),
    sign=st.sampled_from([1, -1]),
)
def test_any_valid_block_cuts_its_circle(metric, plane, code, offset, room, sign):
    radius = max(room, 0.0052 - offset[1])
    wanted = sign * (radius + offset[1])
    traced = cut(metric, f"G0 X3 Y-4 Z5 {plane}", f"{code[0]} I{wanted:.4f} {offset[0]}")
    lead_in, circle, lead_out = traced.moves[-3:]
    assert {move.turns for move in (lead_in, circle, lead_out)} == {code[1]}
    assert circle.radius == pytest.approx(radius, abs=1e-6)
    assert circle.centre == pytest.approx((3, -4, 5), abs=1e-6)
    assert lead_in.start[:3] == pytest.approx((3, -4, 5), abs=1e-9)
    assert lead_out.end[:3] == pytest.approx((3, -4, 5), abs=1e-9)
    assert cut_geometry.largest_jump((lead_in, circle, lead_out)) < 0.001
    points = cut_geometry.dense_points(traced.moves[-3:], step=1.0) - (3, -4, 5)
    third = ({0, 1, 2} - set(AXES[plane])).pop()
    assert np.abs(points[:, third]).max() < 1e-9
    assert np.hypot(*points.T[list(AXES[plane])]).max() <= radius + 1e-6


# ---------------------------------------------------------------- modes, units, work offsets


@pytest.mark.parametrize("plane", AXES)
@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates, plane):
    def block(scale, incremental):
        return f"{plane}\nG13 {mode_matrix.words(scale, I=1.9, F=12.0)} D10\nG17"

    case = mode_matrix.Case(block, feed=12.0)
    mode_matrix.check_same_path(inch, metric, coordinates, case)


@pytest.mark.parametrize("motion", ["G0", "G1", "G2", "G3", "G80"])
def test_the_motion_mode_is_what_it_was(metric, motion):
    first = {"G2": "G2 I1", "G3": "G3 I1", "G80": "G80"}.get(motion, f"{motion} X0")
    assert motion in cut(metric, first, "G12 I50 D10").modes.gcodes


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
