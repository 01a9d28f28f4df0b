# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill event on the stock interpreter: both front ends, and what is modal of them.

Modes, units and refusals are in test_cycles.py.
"""

import pytest

from support import cut_geometry
from support.mode_matrix import INCH, OUT
from support.mode_matrix import event_call as call
from support.sim_machines import kept_tracer

TOOLS = {1: 0.5, 2: 0.0, 3: 12.0 / INCH}
FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94"
BEFORE = [FIRST, "F20", "T1 M6", "G0 X-1 Y-1 Z1"]


inch = kept_tracer("mill_inch", tools=TOOLS)


def cut(tracer, *blocks, **options):
    """Trace blocks that all must be good; the moves before them are left out."""
    traced = tracer.trace_text([*BEFORE, *blocks], **options)
    assert traced.error is None, traced.error
    return traced


# ---------------------------------------------------------------- both front ends

ENTRIES = dict(x=1, y=2, z=-0.5, w=0.1, o=0.5, r=1.5, d=2, c=2, k=0.2, l=0.02, p=5, f=30)
CODE_WORDS = "X1 Y2 Z-.5 I.1 E.5 R1.5 D2 H2 K.2 Q.02 P5 F30"


@pytest.mark.parametrize(("g", "code"), [(7, "G13.2"), (OUT, "G12.2")])
def test_the_call_is_the_code(inch, g, code):
    by_code, by_call = cut(inch, f"{code} {CODE_WORDS}"), cut(inch, call(g=g, **ENTRIES))
    assert [move._replace(line=0, remap="") for move in by_call.moves] == [
        move._replace(line=0, remap="") for move in by_code.moves
    ]
    assert by_call.modes == by_code.modes


def test_f_of_the_call_is_modal_p_and_v_are_not(inch):
    assert cut(inch, call(**ENTRIES, g=7, v=15)).modes.feed == 30
    without = {key: value for key, value in ENTRIES.items() if key not in "fp"}
    traced = cut(inch, call(**ENTRIES), call(**without, v=11))
    assert traced.modes.feed == 30
    feeds = [round(move.feed / INCH, 6) for move in cut_geometry.cutting(traced.moves)]
    assert set(feeds[len(feeds) // 2 :]) == {30, 11}


def test_parameters_and_globals_are_left_alone(inch):
    numbers = list(range(1, 31))
    set_them = [f"#{number} = {number * 1.5}" for number in numbers]
    prints = [f"(print,#{number})" for number in numbers]
    traced = cut(inch, *set_them, call(**ENTRIES), f"G13.2 {CODE_WORDS}", *prints)
    assert traced.printed.split() == [f"{number * 1.5:.6f}" for number in numbers]
    assert traced.globals == {}


# ---------------------------------------------------------------- modal entries


def returns(traced):
    """Return the height of each rapid back to where the event started."""
    return [
        round(move.start[2] / INCH, 6)
        for move in cut_geometry.moving(traced.moves)[1:]
        if (move.end[0] / INCH, move.end[1] / INCH) == (-1, -1) != move.start[:2]
        and move.start[2] == move.end[2]
    ]


def test_planes_from_above_a_loop_hold_in_each_of_its_turns(inch):
    loop = ["#1 = 0", "o1 while [#1 LT 2]", "G12.2 X1 Y2 Z-.5 R.3 H1 D1", "#1 = [#1 + 1]"]
    traced = cut(inch, f"G13.2 {CODE_WORDS}", *loop, "o1 endwhile")
    assert traced.moves[-1].end[2] == pytest.approx(0.5 * INCH)


def test_w_and_o_are_modal(inch):
    traced = cut(
        inch,
        "G13.2 X0 Y0 Z-.1 I.1 R.5 H2",
        "G13.2 X0 Y0 Z-.1 I.2 R.5 H2",
        "G13.2 X0 Y0 Z-.1 I.1 E.5 R.5 H2",
        "G13.2 X2 Y0 Z-.1 R.5 H2",
        call(g=7, x=4, y=0, z=-0.1, r=0.5, c=2),
        "G13.2 X6 Y0 Z-.1 I.2 R.5 H2",
        call(g=7, x=4, y=0, z=-0.1, r=0.5, c=2, o=0.6),
        "G13.2 X8 Y0 Z-.1 R.5 H2",
    )
    assert returns(traced) == [0.1, 0.2, 0.5, 0.5, 0.5, 0.5, 0.6, 0.6]


def test_a_program_that_runs_again_returns_at_the_same_heights(inch):
    """A repeated block begins as a second run does: the second plane below it is not in force."""
    events = ["G13.2 X0 Y0 Z-.1 I.2 R.5 H2", "G13.2 X2 Y0 Z-.1 I.1 E.15 R.5 H2"]
    sub = ["o<events> sub", *events, "o<events> endsub"]
    for body, before in ((events, []), (["o<events> call"], sub)):
        traced = cut(inch, *before, "o1 repeat [2]", *body, "o1 endrepeat")
        assert returns(traced) == [0.2, 0.15, 0.2, 0.15]


# ---------------------------------------------------------------- refusals


@pytest.mark.parametrize("word", ["K1", "X1 Y2 Z-3"])
def test_a_word_of_the_code_inside_the_subroutine_is_refused(inch, word):
    edited = ["o<circle_mill> sub", f"  G12.2 {word}", "o<circle_mill> endsub"]
    event = call(g=7, x=0, y=0, z=-0.1, w=0.1, r=1, c=2)
    traced = inch.trace_text([*edited, *BEFORE, event])
    rule = "is not a word of this cycle, which knows no words inside o<circle_mill>"
    assert traced.error.text == f"G12.2 line 2: {word[:2]} {rule}"
    assert len(traced.moves) == 1
