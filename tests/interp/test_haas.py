# SPDX-License-Identifier: GPL-2.0-or-later
"""G12/G13 of the Haas dialect on the stock interpreter: geometry, modes, refusals."""

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
TOOLS = {1: 0.25, 2: 0.5, 3: -0.25, 4: 0.0}
FIRST = "G20 G17 G40 G49 G54 G64 G80 G90 G91.1 G94 F10"


@pytest.fixture(scope="module")
def inch():
    with Tracer(SIM / "mill_inch.ini", tools=TOOLS) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def metric():
    tools = {number: diameter * INCH for number, diameter in TOOLS.items()}
    with Tracer(SIM / "mill_mm.ini", tools=tools) as tracer:
        yield tracer


@pytest.fixture(scope="module")
def spiral():
    with Tracer(
        SIM / "mill_inch.ini", tools=TOOLS, overrides={"G12": {"CLEARING": "spiral"}}
    ) as tracer:
        yield tracer


def cut(tracer, *blocks):
    """Trace blocks that all must be good."""
    traced = tracer.trace_text([FIRST, *blocks])
    assert traced.error is None, traced.error
    return traced


def test_a_tool_of_the_table_has_its_unit_where_the_programs_is_another(inch, metric):
    for tracer, unit, radius in ((inch, "G21", "3.175 mm"), (metric, "G20", "0.125 in")):
        traced = tracer.trace_text([FIRST.replace("G20", unit), "G13 I.05 Z-1 D1"])
        told = f"G13 line 2: I0.05 must be greater than the tool radius {radius} (D1)"
        assert traced.error.text == told


# ---------------------------------------------------------------- golden cases


@pytest.mark.parametrize("distance", ["G90", "G91"])
@pytest.mark.parametrize(("repeats", "passes"), [("", 1), ("L3", 3)])
@pytest.mark.parametrize("machine", ["inch", "spiral"])
def test_without_z_the_cut_is_made_where_the_tool_stands(
    request, distance, repeats, passes, machine
):
    tracer = request.getfixturevalue(machine)
    block = f"{distance} G13 I.3 K.7 Q.2 {repeats} D1"
    traced = cut(tracer, "G0 X1 Y2 Z.1", "G1 Z-.3", block)
    deep = cut(tracer, "G0 X1 Y2 Z.1", "G1 Z-.3", block.replace("G91", "G90") + " Z-.3")
    moves = cut_geometry.moving(traced.moves)
    assert moves == cut_geometry.moving(deep.moves)
    assert len(cut_geometry.radii(traced.moves)) == len(cut_geometry.radii(deep.moves))
    assert len(cut_geometry.full_circles(traced.moves)) % passes == 0
    assert {move.end[2] for move in moves[2:]} == {-0.3 * INCH}
    assert traced.messages == []
    assert moves[-1].end[:3] == pytest.approx([1 * INCH, 2 * INCH, -0.3 * INCH])


def test_the_finishing_block_of_the_controls_workbook(inch):
    """It roughs with Z, then finishes with I, D and F alone."""
    rough = "G12 I.3 K1. Q.2 Z-.5 D2 F20"
    traced = cut(inch, "G0 X1 Y2 Z.1", rough, "G12 I1. D1 F12.5", "G0 Z.1")
    *_, last = cut_geometry.full_circles(traced.moves)
    assert (last.radius / INCH, last.z / INCH) == pytest.approx((0.875, -0.5))


def test_every_level_of_g91_begins_at_plus_x(inch):
    """Two links from ring to ring turn the vector by half a turn, four of them by a whole one."""
    for growth, links in (("K.5 Q.2", 1), ("K.7 Q.2", 2), ("K.9 Q.2", 3)):
        traced = cut(inch, "G0 X0 Y0 Z.1", f"G91 G13 I.3 {growth} Z-.2 L3 D1")
        arcs = [move for move in traced.moves if move.kind == "arc"]
        lead_ins = [
            arc
            for before, arc in itertools.pairwise(traced.moves)
            if arc.kind == "arc" and before.start[2] > before.end[2]
        ]
        assert len(lead_ins) == 3 and len(arcs) == 3 * (links * 2 + 3), links
        for arc in lead_ins:
            assert arc.end[:2] == pytest.approx((0.175 * INCH, 0), abs=1e-9)


def test_a_spring_pass_begins_on_the_first_ring_however_large_the_pocket(inch):
    traced = cut(inch, "G0 X0 Y0 Z-.1", "G12 I.1252 K2.5 Q.2 L2 D1")
    radii = cut_geometry.radii(traced.moves)
    levels = radii[: len(radii) // 2], radii[len(radii) // 2 :]
    assert levels[0][0] == pytest.approx(0.0002 * INCH) and len(levels[0]) == 13
    assert levels[1] == pytest.approx(levels[0])


def test_golden_trace_of_one_pocket(inch):
    """Clockwise, I.3 K1 Q.4 with a .25 cutter: plunge, lead-in, ring, links and rings, lead-out."""
    traced = cut(inch, "G0 Z.1", "G12 I.3 K1. Q.4 Z-1.2 D1")
    moves = [
        (move.kind, *(round(value / INCH, 9) + 0.0 for value in move.end[:2]))
        for move in cut_geometry.cutting(traced.moves)
    ]
    assert moves == [
        ("feed", 0, 0),
        ("arc", 0.175, 0),
        ("arc", 0.175, 0),
        ("feed", 0.175, -0.4),
        ("arc", 0, -0.575),
        ("arc", 0, -0.575),
        ("feed", -0.3, -0.575),
        ("arc", -0.875, 0),
        ("arc", -0.875, 0),
        ("arc", 0, 0),
    ]


# ---------------------------------------------------------------- what every pocket obeys


def assert_pocket(moves, *, centre, first, last, step, levels, turns):
    """Prove one pocket from its moves: ``first``, ``last``, ``step`` of the tool centre, mm."""
    (span,) = cut_geometry.spans(moves)
    circles = cut_geometry.full_circles(span)
    assert {circle.turns for circle in circles} == {turns}
    for circle in circles:
        assert (circle.x, circle.y) == pytest.approx(centre, abs=1e-6)
    assert cut_geometry.levels(span) == pytest.approx(sorted(set(levels), reverse=True), abs=1e-6)
    points = cut_geometry.dense_points(cut_geometry.in_plane(span), step=1.0)
    distance = np.hypot(points[:, 0] - centre[0], points[:, 1] - centre[1])
    assert distance.max() <= last + 1e-6
    assert (span[0].start[:2], span[-1].end[:2]) == (
        pytest.approx(centre, abs=1e-6),
        pytest.approx(centre, abs=1e-6),
    )
    per_level = len(circles) // len(levels)
    assert len(circles) == per_level * len(levels)
    for index, level in enumerate(levels):
        rings = circles[index * per_level : (index + 1) * per_level]
        assert [ring.z for ring in rings] == pytest.approx([level] * per_level, abs=1e-6)
        assert rings[0].radius == pytest.approx(first, abs=1e-6)
        assert rings[-1].radius == pytest.approx(last, abs=1e-6)
        assert rings[0].radius <= rings[-1].radius
        if step is not None:
            assert np.diff([ring.radius for ring in rings]).max(initial=0) <= step + 1e-5
            assert np.diff([ring.radius for ring in rings]).min(initial=1) > 0
    for sideways in sideways_stretches(span):
        assert cut_geometry.largest_jump(sideways) <= 0.01  # degrees; the figure to reach is 1


def sideways_stretches(span):
    """Return the motion of each level, from the end of its plunge (or of the level before)."""
    stretches = [[]]
    for move in span:
        if abs(move.tangent(0.5)[2]) > 0.5:
            stretches.append([])
        else:
            stretches[-1].append(move)
    return [stretch for stretch in stretches if stretch]


CUTTERS = st.sampled_from([(0, 0.0), (1, 0.125), (2, 0.25)])
ROUNDED = st.decimals(min_value="0.001", max_value="3", places=4).map(float)


@st.composite
def pockets(draw):
    """Return a valid block in inches with its numbers."""
    number, radius = draw(CUTTERS)
    first = radius + draw(ROUNDED)
    outward = draw(st.booleans())
    stepover = draw(st.decimals(min_value="0.02", max_value="1.5", places=4).map(float))
    finished = first + draw(ROUNDED) if outward else first
    code, levels = draw(st.sampled_from(["G12", "G13"])), draw(st.integers(1, 3))
    incremental = draw(st.booleans())
    words = [f"I{first:.6f}", f"Z{-0.2 if incremental else -0.4:.6f}", f"D{number}"]
    if outward:
        words += [f"K{finished:.6f}", f"Q{stepover:.6f}"]
    if levels > 1 or draw(st.booleans()):
        words.append(f"L{levels}")
    centre = draw(st.sampled_from([None, (1.25, -0.5)]))
    if centre:
        words += [f"X{centre[0]}", f"Y{centre[1]}"]
    block = " ".join([code, *draw(st.permutations(words))])
    depths = [0.1 - 0.2 * (level + 1) for level in range(levels)] if incremental else [-0.4]
    return {
        "blocks": ["G91" if incremental else "G90", block],
        "centre": [INCH * value for value in centre or (0, 0)],
        "first": INCH * (first - radius),
        "last": INCH * (finished - radius),
        "step": INCH * stepover,
        "levels": [INCH * depth for depth in depths] * (1 if incremental else levels),
        "turns": -1 if code == "G12" else 1,
    }


def check_any_pocket(tracer, pocket, step):
    traced = cut(tracer, "G0 X0 Y0 Z.1", *pocket["blocks"])
    assert_pocket(
        traced.moves,
        centre=pocket["centre"],
        first=pocket["first"],
        last=pocket["last"],
        step=step,
        levels=pocket["levels"],
        turns=pocket["turns"],
    )


@settings(max_examples=60, deadline=None)
@given(pocket=pockets())
def test_any_valid_block_cuts_its_pocket_in_rings(inch, pocket):
    check_any_pocket(inch, pocket, pocket["step"])


@settings(max_examples=40, deadline=None)
@given(pocket=pockets())
def test_any_valid_block_cuts_its_pocket_in_a_spiral(spiral, pocket):
    check_any_pocket(spiral, pocket, None)


@settings(max_examples=40, deadline=None)
@given(pocket=pockets())
def test_the_spiral_s_arcs_grow_by_half_the_increment(spiral, pocket):
    traced = cut(spiral, "G0 X0 Y0 Z.1", *pocket["blocks"])
    x, y = pocket["centre"]
    ends = [
        math.hypot(move.end[0] - x, move.end[1] - y)
        for move in cut_geometry.in_plane(cut_geometry.cutting(traced.moves))
    ]
    growth = np.diff(ends[: len(ends) // len(pocket["levels"])][:-1])
    assert growth.max(initial=0) <= pocket["step"] / 2 + 1e-5


@pytest.mark.parametrize("clearing", ["rings", "spiral"])
@pytest.mark.parametrize("code", ["G12", "G13"])
@pytest.mark.parametrize("words", ["I.2 K1.3 Q.249", "I.3 K1.31 Q.2", "I.126 K.2 Q.249", "I.3"])
def test_swept_area_is_the_finished_disc(inch, spiral, clearing, code, words):
    tracer = {"rings": inch, "spiral": spiral}[clearing]
    traced = cut(tracer, "G0 X1 Y2 Z.1", f"{code} {words} Z-.5 D1")
    area = cut_geometry.swept(cut_geometry.cutting(traced.moves), 0.125 * INCH)
    numbers = {word[0]: float(word[1:]) for word in words.split()}
    finished = cut_geometry.disc(1 * INCH, 2 * INCH, numbers.get("K", numbers["I"]) * INCH)
    assert area.difference(finished.buffer(0.001)).area == pytest.approx(0, abs=1e-6)
    assert finished.buffer(-0.001).difference(area).area == pytest.approx(0, abs=1e-3)


def test_a_stepover_above_the_tool_diameter_leaves_what_the_message_says(inch):
    traced = cut(inch, "G0 Z.1", "G13 I.3 K1.5 Q.3 Z-.5 D1")
    area = cut_geometry.swept(cut_geometry.cutting(traced.moves), 0.125 * INCH)
    assert cut_geometry.disc(0, 0, 1.499 * INCH).difference(area).area > 1.0
    assert len(traced.messages) == 1


def test_links_stay_inside_the_larger_ring(inch):
    traced = cut(inch, "G0 Z.1", "G13 I.3 K1.5 Q1. Z-.5 D1")
    reached = 0.0
    for move in reversed(cut_geometry.in_plane(cut_geometry.cutting(traced.moves))[:-1]):
        points = cut_geometry.dense_points([move])
        distance = np.hypot(points[:, 0], points[:, 1])
        if move.kind == "arc" and math.dist(move.start, move.end) < cut_geometry.SAME_POINT:
            reached = move.radius
        assert distance.max() <= reached + 1e-6


# ---------------------------------------------------------------- modes, units, work offsets


def pocket_block(scale, incremental):
    x, y, z = (1.0, -1.0, -0.4) if incremental else (1.5, -0.75, -0.3)
    words = mode_matrix.words(scale, X=x, Y=y, I=0.2, K=0.9, Q=0.22, Z=z, F=12.0)
    return f"G13 {words} D1"


POCKET = mode_matrix.Case(pocket_block, feed=12.0)


@mode_matrix.any_coordinates
def test_all_modes_make_the_same_machine_path(inch, metric, coordinates):
    mode_matrix.check_same_path(inch, metric, coordinates, POCKET)


def machine_path(traced):
    return cut_geometry.dense_points(
        cut_geometry.in_plane(cut_geometry.cutting(traced.moves)), step=5.0
    )[:, :2]


@pytest.mark.parametrize("coordinates", ["shifted", "rotated"])
def test_a_work_offset_moves_and_turns_the_pocket(inch, coordinates):
    parameters = mode_matrix.COORDINATES[coordinates]
    before, block = POCKET.program("G20", "G90", "G91.1", "G94", "G8", "G64")
    plain = machine_path(inch.trace_text([*before, block]))
    moved = machine_path(inch.trace_text([*before, block], parameters=parameters))
    angle = math.radians(parameters.get(5230, 0.0))
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    offset = np.array([parameters[5221], parameters[5222]]) * INCH
    assert moved == pytest.approx(plain @ turn.T + offset, abs=1e-6)


@pytest.mark.parametrize("motion", ["G0", "G1", "G2", "G3", "G80"])
def test_the_motion_mode_is_what_it_was(inch, motion):
    first = {"G2": "G2 I.1", "G3": "G3 I.1", "G80": "G80"}.get(motion, f"{motion} X0")
    traced = cut(inch, first, "G12 I.3 Z-.1 D1")
    assert motion in traced.modes.gcodes


def test_a_bare_word_after_the_cycle_moves_in_the_mode_before_it(inch):
    traced = cut(inch, "G0 Z.1", "G12 I.3 Z-.1 D1", "Z.1", "X5.")
    assert [move.kind for move in traced.moves[-2:]] == ["rapid", "rapid"]
    assert traced.position[0] == pytest.approx(5 * INCH)


def test_a_g91_in_the_block_stays(inch):
    assert "G91" in cut(inch, "G12 G91 I.3 Z-.1 D1").modes.gcodes


def test_g7_in_the_block_reads_x_as_a_diameter_and_nothing_else(inch):
    plain = cut(inch, "G12 X1 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    traced = cut(inch, "G7 G12 X2 Y.5 I.3 K.6 Q.2 Z-.1 D1")
    assert machine_path(traced) == pytest.approx(machine_path(plain))
    assert "G7" in traced.modes.gcodes


def test_the_block_s_feed_is_the_feed_of_the_cut_and_stays(inch):
    traced = cut(inch, "G12 I.3 K.6 Q.2 Z-.1 D1 F7.5")
    feeds = [move.feed for move in cut_geometry.cutting(traced.moves)]
    assert feeds == pytest.approx([7.5 * INCH] * len(feeds))
    assert traced.modes.feed == 7.5


def test_expressions_parameters_and_case_are_the_interpreter_s(inch):
    plain = cut(inch, "G13 I.3 K.6 Q.2 Z-.1 D1 L2")
    written = cut(inch, "#1=.1", "#<r>=.3", "g13i#<r>k[2*#<r>]q[#1*2]z-#1d[3-2]l2")
    assert machine_path(written) == pytest.approx(machine_path(plain))


def test_a_tool_length_offset_does_not_move_the_path(inch):
    with_offset = cut(inch, "G43.1 Z.5", "G12 I.3 Z-.1 D1")
    assert cut_geometry.levels(with_offset.moves) == pytest.approx([-0.1 * INCH])


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
    ("G13 I.125 Z-1 D1", "G13: I0.125 must be greater than the tool radius 0.125 (D1)"),
    ("G12 I.5 Z-1 D9", "G12: D9 is not in the tool table"),
    ("G12 I.5 Z-1 D3", "G12: D3 has the negative diameter -0.25 in the tool table"),
    ("G12 I.5 Z-1", "G12: D is missing, none was commanded before and no tool"),
    ("G12 I.5 Z-1 D1 G4 P1", "G12: G4 cannot stand in the same block"),
    ("G93 G12 I.5 Z-1 D1 F1", "G12: needs feed per minute or revolution (G94, G95), but G93"),
    ("G18 G12 I.5 Z-1 D1", "G12: needs the XY plane G17, but G18 is active"),
    ("G19 G13 I.5 Z-1 D1", "G13: needs the XY plane G17, but G19 is active"),
    ("G95 S0 F.1 G12 I.5 Z-1 D1", "G12: needs a spindle speed for feed per revolution (G95)"),
    ("G43.1 Z1 G12 I.5 D1", "G12: G43.1 cannot stand in the same block"),
    ("G64 P.1 G12 I.5 Z-1 D1", "G12: G64 cannot stand in the same block"),
    ("G43 G12 I.5 Z-1 D1 H2", "G12: G43 cannot stand in the same block"),
    ("G12 I.5 Z-1 T2 M6", "G12: M6 cannot stand in the same block"),
    ("M61 Q2 G12 I.5 K1 Z-1 D1", "G12: M61 cannot stand in the same block"),
    ("M68 E1 Q.1 G12 I.5 K1 Z-1 D1", "G12: M68 cannot stand in the same block"),
    ("M19 R1 G12 I.5 Z-1 D1", "G12: M19 cannot stand in the same block"),
    ("M62 P5 G12 I.5 Z-1 D1", "G12: M62 cannot stand in the same block"),
    ("G64 G12 I.5 K1 Q.1 Z-1 D1", "G12: G64 cannot stand in the same block"),
    ("G96 S100 G12 I.5 Z-1 D1", "G12: G96 cannot stand in the same block"),
    ("G41 D1 G12 I.5 Z-1", "G12: brings its own cutter compensation: program G40 first"),
    *(
        (f"G12 I.5 Z-1 D1 {word}", f"G12: {word} is not a word of this cycle, which knows X Y Z")
        for word in ("E1", "H1", "J1", "P1", "R1", "@1", "^1")
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
    message = "G12: the tool still stands offset: after G40 move in X or Y first"
    mode_matrix.check_refused(inch, [*offset, "G40"], "G12 I.26 Z-1", message)
    moved = inch.trace_text([*offset, "G40", "G12 X1 Y1 I.26 Z-1"])
    (plunge,) = [
        move for move in cut_geometry.cutting(moved.moves) if abs(move.tangent(0.5)[2]) > 0.1
    ]
    assert plunge.start[:2] == pytest.approx(plunge.end[:2])


def test_a_refused_block_keeps_the_radius_of_the_last_d(inch):
    for block, _ in REFUSED:
        if "G41" not in block:
            traced = inch.trace_text([FIRST, "G12 I.6 Z-.1 D2", block])
            assert traced.state["cutter_comp_radius"] == pytest.approx(0.25)


BREAKING = st.sampled_from(
    [
        lambda words: {**words, "I": 0.1},
        lambda words: {**words, "I": -words["I"]},
        lambda words: {**words, "K": words["I"] * 0.99, "Q": 0.1},
        lambda words: {**words, "K": words["I"]} | {"Q": 0.1},
        lambda words: {**words, "K": words["I"] + 1},
        lambda words: {**words, "Q": 0.25},
        lambda words: {**words, "L": 0},
        lambda words: {**words, "D": 1.25},
        lambda words: {**words, "D": 8},
        lambda words: {**words, "F": 0},
        lambda words: {**words, "R": 0.5},
        lambda words: {**words, "J": 0.5},
        lambda words: {letter: value for letter, value in words.items() if letter != "I"},
    ]
)


@settings(max_examples=60, deadline=None)
@given(
    code=st.sampled_from(["G12", "G13"]),
    first=st.floats(0.2, 2.0),
    depth=st.floats(-2.0, 2.0),
    breaking=BREAKING,
    mode=st.sampled_from(["G90", "G91", "G91 G61", "G90.1", "G95 S100 M3 F.1", "G7"]),
)
def test_any_bad_block_is_refused(inch, code, first, depth, breaking, mode):
    words = breaking({"I": first, "Z": depth, "D": 1})
    block = " ".join([code, *(f"{letter}{value:.6f}" for letter, value in words.items())])
    block = block.replace("L0.000000", "L0")
    before = [FIRST, mode, "G1 X1 Z.1"]
    mode_matrix.check_refused(inch, before, block, f"{code}: ", keeps=["motion_mode"])


@pytest.mark.parametrize("code", ["M8", "M3 S100", "M9", "M48", "S200", "T2"])
def test_spindle_coolant_and_tool_preparation_may_stand_in_the_block(inch, code):
    traced = cut(inch, "G0 Z.1", f"G12 I.5 Z-.1 D1 {code}")
    assert [r / INCH for r in cut_geometry.radii(traced.moves)] == pytest.approx([0.375])


def test_the_program_goes_on_after_an_operator_message(inch):
    traced = cut(inch, "G12 I.3 K1 Q.4 Z-.1 D1", "G0 Z1")
    assert traced.position[2] == pytest.approx(INCH)
    assert [message.line for message in traced.messages] == [2]
