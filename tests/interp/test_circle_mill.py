# SPDX-License-Identifier: GPL-2.0-or-later
"""The circle mill event on the stock interpreter: both front ends, geometry, modes, refusals."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from g12.tools.preview.tracer import Tracer
from support import cut_geometry, mode_matrix
from support.sim_machines import SIM

INCH = 25.4
TOOLS = {1: 0.5, 2: 0.0, 3: 12.0 / INCH}
FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94"
BEFORE = [FIRST, "F20", "T1 M6", "G0 X-1 Y-1 Z1"]
OUT = -9999


@pytest.fixture(scope="module")
def inch():
    with Tracer(SIM / "mill_inch.ini", tools=TOOLS) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def metric():
    tools = {number: diameter * INCH for number, diameter in TOOLS.items()}
    with Tracer(SIM / "mill_mm.ini", tools=tools) as tracer:
        yield tracer


def cut(tracer, *blocks, **options):
    """Trace blocks that all must be good; the moves before them are left out."""
    traced = tracer.trace_text([*BEFORE, *blocks], **options)
    assert traced.error is None, traced.error
    return traced


def event_of(traced):
    """Return the moves behind the approach of BEFORE, in inches."""
    return cut_geometry.moving(traced.moves)[1:]


def described(moves):
    """Return kind, end and, for arcs, turns of each move in inches."""
    return [
        (
            move.kind,
            *(round(value / INCH, 6) + 0.0 for value in move.end[:3]),
            *((move.turns,) if move.kind == "arc" else ()),
        )
        for move in moves
    ]


def call(**entries):
    """Return the call with these entries, the others left out."""
    values = " ".join(f"[{entries.get(letter, OUT)}]" for letter in "gxyzwordckjlpfv")
    return f"o<circle_mill> call {values}"


# ---------------------------------------------------------------- golden cases


def test_golden_pocket_move_by_move(inch):
    traced = cut(inch, "G13.2 X1 Y2 Z-.3 I.1 E.5 R1 H2 K.25 Q.02 P5")
    low, high = -0.15, 0.1
    rings = [(0.365, low), (0.73, low), (0.365, -0.28), (0.73, -0.28), (0.365, -0.3), (0.73, -0.3)]

    def level(first, second):
        return [
            ("feed", 1, 2, first[1]),
            *(
                move
                for radius, z in (first, second)
                for move in (("feed", 1, 2 - radius, z), ("arc", 1, 2 - radius, z, -1))
            ),
        ]

    def back(height):
        return [("rapid", 1, 1.27, height), ("rapid", 1, 2, height)]

    assert described(event_of(traced)) == [
        ("rapid", 1, 2, 1),
        ("rapid", 1, 2, high),
        *level(*rings[0:2]),
        *back(-0.05),
        *level(*rings[2:4]),
        *back(-0.18),
        *level(*rings[4:6]),
        ("arc", 1, 1.25, -0.3, -1),
        ("arc", 1, 1.25, -0.3, -1),
        ("arc", 1, 1.27, -0.3, -1),
        ("rapid", 1, 1.27, 0.5),
        ("rapid", -1, -1, 0.5),
    ]


def test_golden_outside_perimeter_move_by_move(inch):
    traced = cut(inch, "G12.2 X1 Y2 Z-.3 I.1 R1 D3 H2 K.25 Q.02 L0")
    assert described(event_of(traced)) == [
        ("rapid", 1, 0.73, 1),
        ("rapid", 1, 0.73, 0.1),
        ("feed", 1, 0.73, -0.15),
        ("arc", 1, 0.73, -0.15, 1),
        ("feed", 1, 0.73, -0.3),
        ("arc", 1, 0.73, -0.3, 1),
        ("arc", 1, 0.75, -0.3, 1),
        ("arc", 1, 0.75, -0.3, -1),
        ("arc", 1, 0.73, -0.3, 1),
        ("rapid", 1, 0.73, 0.1),
        ("rapid", -1, -1, 0.1),
    ]


# ---------------------------------------------------------------- both front ends

ENTRIES = dict(x=1, y=2, z=-0.5, w=0.1, o=0.5, r=1.5, d=2, c=2, k=0.2, l=0.02, p=5, f=30)
CODE_WORDS = "X1 Y2 Z-.5 I.1 E.5 R1.5 D2 H2 K.2 Q.02 P5 F30"


@pytest.mark.parametrize(("g", "code"), [(0, "G12.2"), (7, "G13.2"), (OUT, "G12.2")])
def test_the_call_is_the_code(inch, g, code):
    by_code, by_call = cut(inch, f"{code} {CODE_WORDS}"), cut(inch, call(g=g, **ENTRIES))
    assert [move._replace(line=0, remap="") for move in by_call.moves] == [
        move._replace(line=0, remap="") for move in by_code.moves
    ]
    assert by_call.modes == by_code.modes


def test_feeds_of_plunges_rings_and_side_finish(inch):
    traced = cut(inch, call(**ENTRIES, g=7, v=15))
    *roughing, entry, circle, leave = cut_geometry.cutting(traced.moves)
    plunges = [move for move in roughing if move.start[:2] == move.end[:2] and move.kind == "feed"]
    rings = [move for move in roughing if move not in plunges]
    assert {round(move.feed / INCH, 6) for move in plunges} == {5}
    assert {round(move.feed / INCH, 6) for move in rings} == {30}
    assert [move.feed / INCH for move in (entry, circle, leave)] == pytest.approx([15] * 3)
    assert len(plunges) == len(cut_geometry.levels(traced.moves))


def test_f_of_the_call_is_modal_p_and_v_are_not(inch):
    assert cut(inch, call(**ENTRIES, g=7, v=15)).modes.feed == 30
    without = {key: value for key, value in ENTRIES.items() if key not in "fp"}
    traced = cut(inch, call(**ENTRIES), call(**without, v=11))
    assert traced.modes.feed == 30
    feeds = [round(move.feed / INCH, 6) for move in cut_geometry.cutting(traced.moves)]
    assert set(feeds[len(feeds) // 2 :]) == {30, 11}


def test_the_call_works_inside_other_subs_loops_and_expressions(inch):
    program = [
        "o<row> sub",
        "  #<pitch> = 3",
        "  o100 repeat [#1]",
        "    #2 = [#2 + #<pitch>]",
        "    " + call(g=7, x="#2", y=0, z=-0.1, w=0.1, r=1, d=1, c="2 - 1"),
        "  o100 endrepeat",
        "o<row> endsub",
        "o<row> call [3] [0]",
    ]
    traced = cut(inch, *program)
    centres = [round(circle.x / INCH, 6) for circle in cut_geometry.full_circles(traced.moves)]
    assert sorted(set(centres)) == [3, 6, 9]


def test_parameters_and_globals_are_left_alone(inch):
    numbers = list(range(1, 31))
    set_them = [f"#{number} = {number * 1.5}" for number in numbers]
    traced = cut(inch, *set_them, call(**ENTRIES), f"G13.2 {CODE_WORDS}", ask=numbers)
    assert traced.numbered == {number: number * 1.5 for number in numbers}
    assert traced.globals == {}
    assert traced.printed == ""


# ---------------------------------------------------------------- modal entries


def test_w_is_modal_and_o_is_not(inch):
    traced = cut(
        inch,
        "G13.2 X0 Y0 Z-.1 I.1 E.5 R.5 H2",
        "G13.2 X2 Y0 Z-.1 R.5 H2",
        call(g=7, x=4, y=0, z=-0.1, r=0.5, c=2),
        "G13.2 X6 Y0 Z-.1 I.2 R.5 H2",
        "G13.2 X8 Y0 Z-.1 R.5 H2",
    )
    returns = [
        round(move.start[2] / INCH, 6)
        for move in cut_geometry.moving(traced.moves)[1:]
        if (move.end[0] / INCH, move.end[1] / INCH) == (-1, -1) != move.start[:2]
        and move.start[2] == move.end[2]
    ]
    assert returns == [0.5, 0.1, 0.1, 0.2, 0.2]


def test_w_follows_the_units(inch, metric):
    for tracer in (inch, metric):
        traced = cut(tracer, "G13.2 X0 Y0 Z-.1 I.1 R.5 H2", "G21", "F500", "G13.2 X0Y0 Z-2 R12 H2")
        assert traced.moves[-1].end[2] == pytest.approx(2.54)
        metric_first = ["G21", "F500", "G13.2 X0 Y0 Z-2 I2.54 R12 H2"]
        back = cut(tracer, *metric_first, "G20", "F20", "G13.2X0Y0Z-.1R.5H2")
        assert back.moves[-1].end[2] == pytest.approx(2.54)


def test_a_tool_below_w_is_raised_before_it_goes_sideways(inch):
    traced = cut(inch, "G0 Z0", "G13.2 X1 Y2 Z-.5 I.1 R1.5 H2")
    assert described(event_of(traced)[1:4]) == [
        ("rapid", -1, -1, 0.1),
        ("rapid", 1, 2, 0.1),
        ("feed", 1, 2, -0.5),
    ]


# ---------------------------------------------------------------- any valid event

ROUGH_TURNS = {0: -1, 1: 1, 2: -1, 3: 1}
FINISH_TURNS = {0: -1, 1: 1, 2: 1, 3: -1}
INSIDE = {(0, 2), (2, 2), (1, 1), (3, 1)}


def length(least, most):
    return st.decimals(least, most, places=4).map(float)


@st.composite
def events(draw):
    """Return a valid block in inches with its numbers; the tool is 0.5."""
    pocket = draw(st.booleans())
    pairs = sorted(INSIDE) if pocket else itertools.product(range(4), range(3))
    d, h = draw(st.sampled_from(list(pairs)))
    side = 0 if h == 0 else (-1 if (d, h) in INSIDE else 1)
    finish = draw(length("0.005", "0.04")) if side and draw(st.booleans()) else 0.0
    bottom = bool(finish) and draw(st.booleans())
    radius = draw(length("0.3", "2"))
    first, depth = draw(length("-0.2", "0.4")), draw(length("0.05", "1"))
    second = first + draw(st.sampled_from([0.0, 0.3]))
    peck = draw(st.none() | length("0.03", "0.6"))
    width = draw(st.none() | length("0.05", "0.5")) if pocket else None
    words = ["X1.5", "Y-0.75", f"Z{first - depth:.4f}", f"I{first:.4f}", f"R{radius:.4f}"]
    words += [f"D{d}"] if d or draw(st.booleans()) else []
    words += [f"H{h}"]
    words += [f"E{second:.4f}"] if second != first else []
    words += [f"K{peck:.4f}"] if peck else []
    words += [f"J{width:.4f}"] if width else []
    words += [f"Q{finish:.4f}"] if finish else []
    words += ["L0"] if finish and not bottom else []
    return {
        "block": " ".join(["G13.2" if pocket else "G12.2", *draw(st.permutations(words))]),
        "pocket": pocket,
        "side": side,
        "rough": radius + side * (0.25 + finish),
        "finished": radius + side * 0.25,
        "finish": finish,
        "bottom": bottom,
        "first": first,
        "second": second,
        "z": round(first - depth, 4),
        "peck": peck or 99,
        "width": (width or 0.49) if pocket else 99,
        "turns": (ROUGH_TURNS[d], FINISH_TURNS[d]),
    }


def polar(points):
    return np.hypot(points[:, 0] / INCH - 1.5, points[:, 1] / INCH + 0.75)


def check_approach_and_return(moves, event):
    """Rapid in XY at the start's height, to W; at the end to O, back to the start."""
    plunge = -0.75 - (0.0 if event["pocket"] else event["rough"])
    across, down = described(moves[:2])
    assert across[:3] == ("rapid", 1.5, pytest.approx(plunge, abs=2e-6))
    assert across[3] == 1
    assert down == ("rapid", *across[1:3], pytest.approx(event["first"], abs=2e-6))
    up, home = described(moves[-2:])
    assert (up[0], up[3]) == ("rapid", pytest.approx(event["second"], abs=2e-6))
    assert home == ("rapid", -1, -1, up[3])


def check_depths(moves, event):
    """From W down in steps of at most K to Z, or to the finish dimension above it and then Z."""
    levels = [z / INCH for z in cut_geometry.levels(moves)]
    drops = -np.diff([event["first"], *levels])
    assert levels[-1] == pytest.approx(event["z"], abs=1e-6)
    rough = drops[:-1] if event["bottom"] else drops
    assert rough.max() <= event["peck"] + 1e-6
    assert rough[:-1] == pytest.approx(event["peck"], abs=1e-5)
    if event["bottom"]:
        assert drops[-1] == pytest.approx(event["finish"], abs=1e-6)
    return levels


def check_rings(moves, event, levels):
    """Equal steps to the rough radius at each level, in the rough direction; then the finish."""
    circles = cut_geometry.full_circles(moves)
    if event["finish"]:
        last = circles.pop()
        assert last.radius / INCH == pytest.approx(event["finished"], abs=1e-6)
        assert last.z / INCH == pytest.approx(event["z"], abs=1e-6)
        assert last.turns == event["turns"][1]
    assert {circle.turns for circle in circles} == {event["turns"][0]}
    count = math.ceil(event["rough"] / event["width"] - 1e-6) if event["pocket"] else 1
    radii = [event["rough"] * (ring + 1) / count for ring in range(count)]
    assert [circle.radius / INCH for circle in circles] == pytest.approx(
        radii * len(levels), abs=1e-5
    )
    for circle in circles:
        assert (circle.x / INCH, circle.y / INCH) == pytest.approx((1.5, -0.75), abs=1e-6)
    assert [circle.z / INCH for circle in circles] == pytest.approx(
        np.repeat(levels, count), abs=1e-6
    )


def check_finish(moves, event):
    """Tangent half circles of the finish dimension's diameter on the rough side of the wall."""
    if not event["finish"]:
        return
    entry, circle, leave = cut_geometry.cutting(moves)[-3:]
    assert cut_geometry.largest_jump([entry, circle, leave]) < 0.01
    assert 2 * entry.radius / INCH == pytest.approx(event["finish"], abs=1e-6)
    assert 2 * leave.radius / INCH == pytest.approx(event["finish"], abs=1e-6)
    assert (abs(entry.sweep), abs(leave.sweep)) == pytest.approx((math.pi, math.pi), abs=1e-5)
    distance = polar(cut_geometry.dense_points([entry, leave], step=0.05))
    bounds = sorted((event["rough"], event["finished"]))
    assert bounds[0] - 1e-5 <= distance.min() <= distance.max() <= bounds[1] + 1e-5


def check_rapids_stay_out_of_material(moves, event):
    """Below W a rapid only goes up, or sideways within what the level just above it has cut."""
    bottom = math.inf
    for move in moves:
        if move.kind != "rapid":
            bottom = min(bottom, move.end[2])
            continue
        low = min(move.start[2], move.end[2])
        if low >= event["first"] * INCH - 1e-6:
            continue
        sideways = math.dist(move.start[:2], move.end[:2]) > 1e-9
        assert sideways or move.end[2] > move.start[2]
        if sideways:
            assert event["pocket"]
            retract = min(bottom + 2.54, event["first"] * INCH)
            assert low == pytest.approx(retract, abs=1e-6)
            assert low > bottom
            assert polar(cut_geometry.dense_points([move])).max() <= event["rough"] + 1e-6


@settings(max_examples=80, deadline=None)
@given(event=events())
def test_any_valid_event_cuts_its_circle(inch, event):
    moves = event_of(cut(inch, event["block"]))
    check_approach_and_return(moves, event)
    levels = check_depths(moves, event)
    check_rings(moves, event, levels)
    check_finish(moves, event)
    check_rapids_stay_out_of_material(moves, event)
    reach = polar(cut_geometry.dense_points(cut_geometry.cutting(moves), step=1.0)).max()
    assert reach <= max(event["rough"], event["finished"]) + 1e-6


# ---------------------------------------------------------------- what is cut


def test_a_roughing_width_above_the_tool_diameter_says_what_it_leaves(inch):
    traced = cut(inch, "G13.2 X0 Y0 Z-.1 I.1 R1.5 H2 J.7")
    (message,) = traced.messages
    assert message.text.startswith("G13.2: the roughing width 0.625 is greater than the tool")
    swept = cut_geometry.swept(cut_geometry.cutting(traced.moves), 0.25 * INCH)
    assert cut_geometry.disc(0, 0, 1.4 * INCH).difference(swept).area > 10


# ---------------------------------------------------------------- modes, units, work offsets


def pocket_block(scale, incremental):
    x, y, z = (1.0, -1.0, -0.6) if incremental else (1.5, -0.75, -0.5)
    lengths = mode_matrix.words(
        scale, X=x, Y=y, Z=z, I=0.1, E=0.4, R=1.2, K=0.25, J=0.3, Q=0.02, P=5.0, F=12.0
    )
    return f"G13.2 {lengths} D2 H2"


def outside_call(scale, incremental):
    x, y, z = (1.0, -1.0, -0.6) if incremental else (1.5, -0.75, -0.5)
    lengths = dict(x=x, y=y, z=z, w=0.1, o=0.4, r=0.8, k=0.25, l=-0.02, p=5.0, f=12.0, v=9.0)
    scaled = {name: f"{value * scale:.10f}" for name, value in lengths.items()}
    return call(**scaled, d=3, c=2)


@pytest.mark.parametrize("block", [pocket_block, outside_call])
@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates, block):
    mode_matrix.check_same_path(inch, metric, coordinates, mode_matrix.Case(block, feed=12.0))


@pytest.mark.parametrize("motion", ["G0", "G1", "G2", "G3", "G80"])
@pytest.mark.parametrize("event", [f"G13.2 {CODE_WORDS}", call(**ENTRIES)])
def test_the_motion_mode_is_what_it_was(inch, motion, event):
    first = {"G2": "G2 I.1", "G3": "G3 I.1", "G80": "G80"}.get(motion, f"{motion} X0")
    assert motion in cut(inch, first, event).modes.gcodes


def test_a_bare_word_after_the_event_moves_in_the_mode_before_it(inch):
    traced = cut(inch, "G1 X0", f"G13.2 {CODE_WORDS}", "X5")
    assert (traced.moves[-1].kind, traced.moves[-1].end[0]) == ("feed", 5 * INCH)


# ---------------------------------------------------------------- refusals on the interpreter

PLACE = "X1 Y2 Z-.5 I.1 R1.5"
REFUSED = [  # the sentences are those of unit/test_circle_mill.py
    ("G13.2 X1 Y2 Z-.5 R1.5 H2", "G13.2: I is missing"),
    (f"G12.2 {PLACE}", "G12.2: H is missing"),
    (f"G13.2 {PLACE} H2 D4", "G13.2: D4 must be at most 3"),
    ("G91 G13.2 X1 Y2 Z.2 I.1 R1.5 H2", "G13.2: Z0.2 must be below the first"),
    (call(g=7, x=0, y=0, z=-0.1, w=0.1, r=0.2, c=2), "circle_mill: R0.2 must be greater"),
    (call(g=7, x=0, y=0, z=-0.1, w=0.1, c=2), "circle_mill: R is missing"),
    ("o<circle_mill> call [7] [0] [0] [-.1] [.1] [.1] [1] [0] [2]", "circle_mill: V0 must be"),
]


@pytest.mark.parametrize(("block", "message"), REFUSED)
def test_a_bad_event_moves_nothing_and_changes_nothing(inch, block, message):
    distance = "G91" if "G91" in block else "G90"
    mode_matrix.check_refused(inch, [*BEFORE, distance], block.replace("G91 ", ""), message)


EVENTS = [("G13.2", f"G13.2 {PLACE} H2"), ("circle_mill", call(x=0, y=0, z=0, w=0.1, r=1, c=2))]


@pytest.mark.parametrize(("name", "event"), EVENTS)
@pytest.mark.parametrize(
    ("mode", "rule"),
    [
        ("G93", "needs feed per minute or revolution (G94, G95), but G93 is active"),
        ("G41 D1", "brings its own cutter compensation: program G40 first"),
        ("F0", "F0 must be greater than 0 (no feed commanded?)"),
        ("G18", "needs the XY plane G17, but G18 is active"),
        ("G19", "needs the XY plane G17, but G19 is active"),
        ("T0 M6", "no tool is loaded: its diameter sets the path"),
        ("T2 M6", "T2 in the spindle needs a diameter above 0 in the tool table, not 0"),
    ],
)
def test_a_mode_that_cannot_work_is_refused(inch, name, event, mode, rule):
    if mode == "G93" and name == "G13.2":
        event += " F100"
    elif mode == "G93":
        event = event.replace("-9999] [-9999]", "-9999] [10]")
    traced = inch.trace_text([*BEFORE, mode, event])
    assert traced.error.text == f"{name} line {len(BEFORE) + 2}: {rule}"
    assert len(traced.moves) == 1


def test_a_second_motion_code_in_the_block_is_refused(inch):
    traced = inch.trace_text([*BEFORE, f"G13.2 G4 P1 {PLACE} H2"])
    assert traced.error is not None
    assert len(traced.moves) == 1


@settings(max_examples=60, deadline=None)
@given(block=mode_matrix.blocks("G13.2", "IERDHKJQLP").map(lambda block: f"{block} X1 Y2 Z-3"))
def test_any_block_cuts_or_is_refused_in_words(inch, block):
    mode_matrix.check_cut_or_refused(inch, BEFORE, block, "G13.2")


@settings(max_examples=80, deadline=None)
@given(values=st.dictionaries(st.sampled_from("gworkjlpvdc"), mode_matrix.VALUES))
def test_any_call_cuts_or_is_refused_in_words(inch, values):
    texts = {letter: f"{value:.5f}" for letter, value in values.items()}
    block = call(**{"x": 1, "y": 2, "z": -3, "r": 1, "c": 2, "w": 0.1, **texts})
    mode_matrix.check_cut_or_refused(inch, BEFORE, block, "circle_mill")


@pytest.mark.parametrize("word", ["K1", "X1 Y2 Z-3"])
def test_a_word_of_the_code_inside_the_subroutine_is_refused(inch, word):
    edited = ["o<circle_mill> sub", f"  G12.2 {word}", "o<circle_mill> endsub"]
    event = call(g=7, x=0, y=0, z=-0.1, w=0.1, r=1, c=2)
    traced = inch.trace_text([*edited, *BEFORE, event])
    rule = "is not a word of this cycle, which knows no words inside o<circle_mill>"
    assert traced.error.text == f"G12.2 line 2: {word[:2]} {rule}"
    assert len(traced.moves) == 1
