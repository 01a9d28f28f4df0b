# SPDX-License-Identifier: GPL-2.0-or-later
"""G7.1 on the stock interpreter: its words, its moves on the unrolled surface, every refusal."""

import math
import re
from itertools import groupby

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from g12.tools.preview.tracer import Tracer
from support.contour_geometry import Round, Straight, distance
from support.polar_programs import feed_moves, lines, texts
from support.sim_machines import PROGRAMS, ROOT, SIM

R = 20.0
FIRST = "G21 G18 G8 G40 G49 G54 G64 G80 G90 G91.1 G94 G97"
X, Z, C = 0, 2, 5
TOLERANCE = 0.005


def section(*body, before=(), after=(), first=FIRST, start="G0 X22 Z0 C0", on=f"G07.1 C{R:g}"):
    """Return a program whose section holds ``body``, from line 6 on (``before`` adds lines)."""
    return [first, start, "T3 M6", "F250", *before, on, *body, "G07.1 C0", *after, "M2"]


def opened(**overrides):
    return Tracer(SIM / "lathe_mm.ini", overrides={"G12": overrides} if overrides else None)


@pytest.fixture(scope="module")
def lathe():
    with opened() as tracer:
        yield tracer


def place(position, radius=R):
    """Return a machine position on the unrolled surface: C as a length is real, Z imaginary."""
    return complex(math.radians(position[C]) * radius, position[Z])


def ends(traced):
    """Return X, Z and C at the end of each block that moved at a feed."""
    blocks = groupby(feed_moves(traced), key=lambda move: move.line)
    last = [list(moves)[-1].end for _, moves in blocks]
    return [tuple(round(end[axis], 6) + 0.0 for axis in (X, Z, C)) for end in last]


def path(traced, radius=R):
    """Return places so near to each other on the moves that no deviation falls between."""
    return places(feed_moves(traced), radius)


def places(moves, radius=R):
    parts = np.linspace(0.0, 1.0, 9)
    lay = [(place(move.start, radius), place(move.end, radius)) for move in moves]
    return np.concatenate([start + (end - start) * parts for start, end in lay])


TINY = 1e-7  # mm: less is no move of an axis, to LinuxCNC


def seconds(move):
    """Return how long LinuxCNC takes: F is for X and Z, or for C where neither moves."""
    dx, dz, dc = (move.end[axis] - move.start[axis] for axis in (X, Z, C))
    length = math.hypot(dx, dz)
    return 60.0 * (length if length > TINY else abs(dc)) / move.feed


# ---------------------------------------------------------------- words


def test_z_is_a_length_and_c_an_angle_and_a_line_is_one_move(lathe):
    traced = lathe.trace_text(section("G1 X18", "Z-10", "C90", "Z-20 C-720.5"))
    assert ends(traced) == [(18, 0, 0), (18, -10, 0), (18, -10, 90), (18, -20, -720.5)]
    assert len(feed_moves(traced)) == 4


def test_c_is_where_the_program_has_it_wherever_the_section_begins(lathe):
    traced = lathe.trace_text(section("G1 C30", "G91 C5 Z1", "C-10", start="G0 X22 C370"))
    assert [end[2] for end in ends(traced)] == [30, 35, 25]


def test_w_h_and_u_are_increments(lathe):
    traced = lathe.trace_text(section("G1 W-5 C10", "H-30 Z-7", "W1 H1", "U-4", "G91 W1", "H2"))
    assert ends(traced) == [
        (22, -5, 10), (22, -7, -20), (22, -6, -19), (18, -6, -19), (18, -5, -19), (18, -5, -17),
    ]  # fmt: skip


def test_x_is_a_diameter_in_g7(lathe):
    traced = lathe.trace_text(section("G1 X36", "U-2", start="G0 G7 X44 Z0 C0"))
    assert [end[0] for end in ends(traced)] == [18, 17]


@pytest.mark.parametrize(("word", "radius"), [("radius", 40), ("diameter", 20)])
def test_the_word_is_the_radius_or_the_diameter(word, radius):
    with opened(CYLINDER_WORD=word) as tracer:
        (move,) = feed_moves(tracer.trace_text(section("G1 C90", on="G7.1 C40")))
    assert seconds(move) == pytest.approx(math.pi / 2 * radius / 250 * 60)


@pytest.mark.parametrize("plane", ["G17", "G18", "G19"])
@pytest.mark.parametrize(
    ("code", "by", "centre"),
    [("G3", "R10", 10j), ("G2", "R10", 10), ("G3", "K10", 10j), ("G2", "J10", 10),
     ("G2", "I10", 10), ("G2", "R-10", 10j), ("G3", "R-10", 10), ("G2", "J0 K10", 10j)],
)  # fmt: skip
def test_arcs_turn_as_seen_from_outside_with_c_to_the_right(lathe, plane, code, by, centre):
    """From (0, 0) to (10, 10): a quarter turn, or three of them."""
    to = math.degrees(10 / R)
    traced = lathe.trace_text(section(plane, f"{code} Z10 C{to:.9f} {by}"))
    assert (abs(abs(path(traced) - centre) - 10) <= TOLERANCE).all()
    turn = {"G2": -1, "G3": 1}[code]
    angles = np.unwrap(np.angle(path(traced) - centre))
    quarters = turn if (turn == 1) == (centre == 10j) else 3 * turn
    assert (angles[-1] - angles[0]) / (math.pi / 2) == pytest.approx(quarters, abs=1e-6)


def test_a_full_circle(lathe):
    traced = lathe.trace_text(section("G2 K-8"))
    assert (abs(abs(path(traced) + 8j) - 8) <= TOLERANCE).all()
    assert ends(traced) == [(22, 0, 0)]


def test_x_with_the_others_where_it_is_allowed():
    with opened(CYLINDER_X="allow") as tracer:
        traced = tracer.trace_text(section("G1 X20 Z-3", "G3 K5 X18", "G1 X19 C90"))
    assert ends(traced) == [(20, -3, 0), (18, -3, 0), (19, -3, 90)]
    first, *arc, last = feed_moves(traced)
    assert seconds(first) == pytest.approx(math.hypot(2, 3) / 250 * 60)
    assert sum(map(seconds, arc)) == pytest.approx(math.hypot(2, 10 * math.pi) / 250 * 60)
    assert seconds(last) == pytest.approx(math.hypot(1, R * math.pi / 2) / 250 * 60)


@pytest.mark.parametrize(
    ("before", "body", "speed"),
    [
        ((), "G1 Z-5 C100", 250),
        ((), "G1 C-400", 250),
        ((), "G1 Z-5", 250),
        ((), "G1 Z-5 C10 F60", 60),
        ((), "G98 G1 Z-5 C10 F70", 70),
        (("S1000",), "G99 G1 Z-5 C10 F.1", 100),
        (("S500", "G95 F.2"), "G1 Z-5 C10", 100),
    ],
)
def test_feed_is_the_speed_on_the_surface(lathe, before, body, speed):
    moves = feed_moves(lathe.trace_text(section(body, before=before)))
    length = sum(abs(place(move.end) - place(move.start)) for move in moves)
    assert length / sum(map(seconds, moves)) * 60 == pytest.approx(speed)


def test_inches_and_millimetres_make_the_same_machine_path(lathe):
    body = ["G1 X{:.6f}", "Z{:.6f} C50", "G3 Z{:.6f} C80 R{:.6f}", "G1 C720"]
    sizes = [[18], [-10], [-16, 12], []]
    one, other = (
        lathe.trace_text(
            section(
                *[
                    text.format(*(size / unit for size in size_))
                    for text, size_ in zip(body, sizes)
                ],
                first=FIRST.replace("G21", code),
                start=f"G0 X{22 / unit:.6f} Z0 C0",
                before=[f"F{250 / unit:.6f}"],
                on=f"G7.1 C{R / unit:.6f}",
            )
        )
        for code, unit in (("G21", 1.0), ("G20", 25.4))
    )
    assert len(one.moves) == len(other.moves)
    for a, b in zip(one.moves, other.moves):
        assert a.end == pytest.approx(b.end, abs=1e-3)


def test_work_offsets_go_along(lathe):
    """Machine positions: 7 of Z and 30 of C are added."""
    after = ["G10 L2 P1 Z0 C0"]
    traced = lathe.trace_text(
        section("G1 Z-3 C10", "C370", before=["G10 L2 P1 Z7 C30", "G0 Z0 C0"], after=after)
    )
    assert ends(traced) == [(22, 4, 40), (22, 4, 400)]


@pytest.mark.parametrize("name", ["#5422 #5425", "#<_z> #<_c>"])
def test_position_parameters_show_the_programmed_position(lathe, name):
    z, c = name.split()
    body = ["G41 G1 Z-20", f"G1 Z[{z}-1] C[{c}+15]", f"C[{c}+15]", "G40 Z0"]
    traced = lathe.trace_text(section(*body, start="G0 X22 Z0 C33"))
    plain = ["G41 G1 Z-20", "G1 Z-21 C48", "C63", "G40 Z0"]
    assert ends(traced) == ends(lathe.trace_text(section(*plain, start="G0 X22 Z0 C33")))


def test_codes_and_words_behind_the_section_mean_what_they_meant(lathe):
    traced = lathe.trace_text(section("G1 Z-5", "G91 G99 F.1", after=["G94 F100", "C5", "Z1"]))
    assert ends(traced)[-2:] == [(22, -5, 5), (22, -4, 5)]


def test_off_outside_a_section_does_nothing(lathe):
    traced = lathe.trace_text([FIRST, "G07.1 C0", "G1 Z5 F100", "M2"])
    assert ends(traced) == [(0, 5, 0)]


def test_line_numbers_inside_and_behind(lathe):
    traced = lathe.trace_text(section("G1 Z-5", "(note)", "G3 K3", after=["G1 Z5"]))
    assert lines(traced) == [6, 8, 10]


def test_o_words_parameters_and_two_sections(lathe):
    body = ["#1=0", "o1 repeat [3]", "#1=[#1+1]", "G1 Z[-#1] C[10*#1]", "o1 endrepeat"]
    again = ["G0 C0", "G7.1 C10", "G1 C90", "G7.1 C0"]
    traced = lathe.trace_text(section(*body, after=again))
    assert ends(traced)[-1] == (22, -3, 90)
    assert [move.end[C] for move in feed_moves(traced)] == pytest.approx([10, 20, 30, 90])
    assert seconds(feed_moves(traced)[-1]) == pytest.approx(math.pi / 2 * 10 / 250 * 60)


def test_sections_on_the_face_and_on_the_surface_in_one_program(lathe):
    face = ["G12.1", "G1 X10", "C5 F100", "G13.1", "G0 X22 C0"]
    traced = lathe.trace_text(section("G1 C90", before=face, after=["G0 C0", *face[:-1]]))
    places = ends(traced)
    corner = (round(math.hypot(10, 5), 6), 0.0, round(math.degrees(math.atan2(5, 10)), 6))
    assert [places[1], places[2], places[-1]] == [corner, (22, 0, 90), corner]


def test_rapids_as_feeds_where_they_are_allowed():
    with opened(POLAR_G0="feed", POLAR_G0_FEED="4000") as tracer:
        moves = feed_moves(tracer.trace_text(section("G0 C90", "G1 C0")))
    assert [seconds(move) for move in moves] == pytest.approx(
        [math.pi / 2 * R / feed * 60 for feed in (4000, 250)]
    )


def test_a_wrapped_axis_winds_too():
    with Tracer(SIM / "lathe_mm.ini", overrides={"AXIS_C": {"WRAPPED_ROTARY": "1"}}) as tracer:
        traced = tracer.trace_text(section("G1 C400", "C-100"))
    assert [end[2] for end in ends(traced)] == [400, -100]


def test_actions_keep_their_place_and_messages_are_shown(lathe):
    traced = lathe.trace_text(section("G1 Z-5", "(msg,deep)", "M8", "C30"))
    assert texts(traced) == ["deep"]


def test_waiting_for_an_input_cuts_the_section_in_two(lathe):
    traced = lathe.trace_text(section("G1 Z-5 C30", "M66 P0 L0", "C60", "G2 J5"))
    assert ends(traced) == [(22, -5, 30), (22, -5, 60), (22, -5, 60)]


PAGE = re.compile(r"(?:^ {4}.*\n)+?^ {4}M2\n", re.MULTILINE)


@pytest.mark.parametrize(("number", "name"), enumerate(["textbook", "cam_groove", "helix"]))
def test_the_pages_programs_are_the_samples(lathe, number, name):
    text = (ROOT / "ngc" / "cylinder.md").read_text(encoding="utf-8")
    program = [match[0] for match in PAGE.finditer(text)][number].splitlines()
    sample = (PROGRAMS / "cylinder" / f"{name}.ngc").read_text().splitlines()
    there, here = (feed_moves(lathe.trace_text(text)) for text in (program, sample))
    assert [move.end for move in there] == [move.end for move in here]


def test_the_sample_of_the_simulated_lathe_is_the_cam_groove(lathe):
    texts_of = [SIM / "samples/lathe_mm_cylinder.ngc", PROGRAMS / "cylinder/cam_groove.ngc"]
    there, here = (feed_moves(lathe.trace(text)) for text in texts_of)
    assert [move.end for move in there] == [move.end for move in here]


# ---------------------------------------------------------------- compensation


@pytest.mark.parametrize(("code", "z"), [("G41", 3), ("G42", -3)])
def test_compensation_is_on_that_side_of_the_way_as_seen_from_outside(lathe, code, z):
    """Along +C, which is to the right: the left is +Z. Tool 3 has a radius of 3."""
    traced = lathe.trace_text(section("G1 C-90", f"{code} C-60", "C60", "G40 C90"))
    assert ends(traced)[2] == (22, z, 60)


def test_an_outside_corner_is_an_arc_and_an_inside_corner_the_crossing(lathe):
    body = ["G1 C-90", "G42 C-60", "C0", "Z20", "C60", "G40 C90"]
    shapes = [Straight(place_of(-60, -3), place_of(0, -3)), Round(-3j, 0j, math.pi / 2),
              Straight(3, 3 + 17j), Straight(3 + 17j, place_of(60, 17))]  # fmt: skip
    moves = [move for move in feed_moves(lathe.trace_text(section(*body))) if 8 <= move.line <= 10]
    assert place(moves[0].start) == pytest.approx(shapes[0].start)
    assert place(moves[-1].end) == pytest.approx(shapes[-1].end)
    assert distance(places(moves), shapes).max() <= TOLERANCE


def place_of(degrees, z):
    return complex(math.radians(degrees) * R, z)


# ---------------------------------------------------------------- refusals


INSIDE = [
    ("G0 X12", "G0 is refused: a rapid leaves the contour. Is the section's end missing above? "
     "Else use G1 with a high F, or set [G12] POLAR_G0 = feed"),
    ("G12.1", "G12.1 is refused: only G1, G2 and G3 move inside the section"),
    ("G7.1 C30", "the section is already on: G7.1 C0 ends it"),
    ("G7.1", "the section is already on: G7.1 C0 ends it"),
    ("G7.1 C0 Z5", "G7.1 C0 stands alone in its block"),
    ("G7.1 H0", "G7.1 C0 stands alone in its block"),
    ("G1 A5", "A is refused: the section's words are Z, C, X, W, H and U"),
    ("G1 X5 U3", "X and U both move X: only one of them"),
    ("G2 Z5 I2 J2", "I and J both move the centre along C: only one of them"),
    ("G1 X5 Z3", "X needs a block of its own, or [G12] CYLINDER_X = allow"),
    ("G1 U1 C3", "X needs a block of its own, or [G12] CYLINDER_X = allow"),
    ("G2 Z5 K2 R3", "G2: either R or J and K, not both"),
    ("G2 Z5", "G2 needs R, or the centre in J and K"),
    ("G2 R5", "G2 R5: a full circle needs J and K, not R"),
    ("G3 Z30 R5", "G3 R5 does not close: the ends are 30 apart, R must be at least 15"),
    ("G2 Z9 K5", "G2 does not close: its centre is 5 from the start, 4 from the end"),
    ("G41", "G41 needs a G1 with C or Z in its own block"),
    ("G41 G1 Z2", "the G1 with G41 is 2 long: it must be at least the tool radius 3"),
    ("G1 Z501", "the Z axis would go to 501 mm, beyond its limit 500 mm"),
    ("G1 C100000", "the C axis would go to 100000 degrees, beyond its limit 99999 degrees"),
    ("G1 X301", "the X axis would go to 301 mm (radius), beyond its limit 300 mm"),
    ("G2 Z5 K2000000", "K2000000 is no length: at most 1000000"),
    ("M2", "G7.1 C0 is missing: M2 comes before it"),
    ("T1 M6", "M6 is refused: the tool cannot change inside the section"),
]  # fmt: skip


def refused(lathe, program):
    """Return text and line of the refusal; nothing of the section may have moved."""
    traced = lathe.trace_text(program)
    assert traced.error is not None
    assert [move.kind for move in traced.moves] == ["rapid"], "the section moved"
    assert len(traced.error.text) <= 255
    return traced.error.text, traced.error.line


@pytest.mark.parametrize(("block", "why"), INSIDE)
def test_refused_inside(lathe, block, why):
    text, line = refused(lathe, section("G1 Z0", "C1", "C0", block, "G1 Z1"))
    why = why.replace(" (radius)", "")
    assert (text, line) == (f"G7.1 line 9: {why}", 9)


TIGHT = "the tool of radius 3 cannot reach both lines 8 and 9: their corner is too tight"


@pytest.mark.parametrize(
    ("body", "line", "why"),
    [
        (["G1 C-90", "G41 C-60", "C0", "Z1", "C60", "G40 C90"], 9, TIGHT),
        (["G1 C-90", "G41 C-60", "C0", "G3 C11.459155902616466 R2", "G1 G40 C90"], 9,
         "the arc of radius 2 is smaller than the tool radius 3 (between lines 8 and 10)"),
        (["G41 G1 Z9", "C90"], 8, "G41 of line 6 is still on: G40 is missing"),
    ],
)  # fmt: skip
def test_what_the_tool_cannot_cut_is_refused(lathe, body, line, why):
    text, at = refused(lathe, section(*body))
    assert at == line
    assert text.startswith(f"G7.1 line {line}: ")
    assert text.endswith(why)


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"on": "G7.1"}, "needs C, the cylinder's radius; C0 ends a section"),
        ({"on": "G7.1 C-5"}, "C-5, the cylinder's radius, must be above 0 and at most 1000000"),
        (
            {"on": "G7.1 C5000000"},
            "C5000000, the cylinder's radius, must be above 0 and at most 1000000",
        ),
        ({"on": "G7.1 C20 Z5"}, "stands alone in its block"),
        ({"on": "G7.1 C20 M3"}, "stands alone in its block"),
        ({"on": "G7.1 H20"}, "stands alone in its block"),
        ({"first": FIRST.replace("G94", "G93")}, "needs G94 or G95, not G93"),
        (
            {"first": FIRST.replace("G97", "G96 S100 D500")},
            "needs G97: with G96 the speed would change with X",
        ),
        (
            {"first": "G52 X-1 " + FIRST},
            "X0 must be the spindle's axis: G52 or G92 shifts X by -1;"
            " cancel it with G92.1 (an X offset of G54 may stay)",
        ),
    ],
)  # fmt: skip
def test_refused_to_begin(lathe, given, why):
    assert refused(lathe, section("G1 Z5", **given)) == (f"G7.1 line 5: {why}", 5)


@pytest.mark.parametrize("words", ["X7", "Z-5", "K3", "D5", "R2", "I1"])
def test_words_beside_the_code_that_ends_no_section(lathe, words):
    traced = lathe.trace_text([FIRST, f"G7.1 C0 {words}", "M2"])
    assert traced.error.text == "G7.1 line 2: C0 stands alone in its block"


def test_x_beyond_its_limit_is_a_radius_where_words_are_diameters(lathe):
    text, _ = refused(lathe, section("G1 X610", start="G0 G7 X44 Z0 C0"))
    assert text == "G7.1 line 6: the X axis would go to 305 mm (radius), beyond its limit 300 mm"


def test_a_machine_without_z_is_told():
    overrides = {"TRAJ": {"COORDINATES": "X C"}, "KINS": {"KINEMATICS": "trivkins coordinates=XC"}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as tracer:
        error = tracer.trace_text([FIRST.replace("G18 ", ""), "G7.1 C5", "M2"]).error
    assert error.text == "G7.1 line 2: needs a machine with an X, Z and a C axis"


# ---------------------------------------------------------------- any contour


NUMBERS = st.floats(-40, 40).map(lambda value: round(value, 3))
STEPS = st.lists(
    st.tuples(st.sampled_from(["line", "left", "right"]), NUMBERS, NUMBERS, st.floats(0.5, 3.0)),
    min_size=1,
    max_size=5,
)


def drawn(steps, radius):
    """Return blocks, and the shapes that they mean, from (0, 0) on."""
    here, blocks, shapes = 0j, [], []
    for kind, s, z, share in steps:
        degrees = round(math.degrees(s / radius), 6)
        to = complex(math.radians(degrees) * radius, z)
        half = abs(to - here) / 2
        if half < 0.05:
            continue
        words = f"C{degrees:.6f} Z{z:.3f}"
        if kind == "line":
            blocks.append(f"G1 {words}")
            shapes.append(Straight(here, to))
        else:
            bend = round(half * (1.0 + share) + 0.001, 3)
            turn = 1 if kind == "left" else -1
            height = math.sqrt(bend**2 - half**2)
            centre = (here + to) / 2 + turn * 1j * (to - here) / (2 * half) * height
            blocks.append(f"{'G3' if turn > 0 else 'G2'} {words} R{bend:.3f}")
            shapes.append(Round(here, centre, turn * 2 * math.asin(half / bend)))
        here = to
    return blocks, shapes


@settings(max_examples=40)
@given(steps=STEPS, radius=st.sampled_from([3.0, 20.0, 57.299, 140.0]))
@example(steps=[("left", 0.25, 0.0, 1.0)], radius=20.0)
def test_any_contour_is_cut_as_it_is_drawn_at_its_feed(lathe, steps, radius):
    blocks, shapes = drawn(steps, radius)
    if not blocks:
        return
    traced = lathe.trace_text(section(*blocks, on=f"G7.1 C{radius}"))
    cut = path(traced, radius)
    assert distance(cut, shapes).max() <= TOLERANCE
    assert abs(cut[-1] - shapes[-1].end) < 1e-5
    for line, shape in enumerate(shapes, 6):
        made = [move for move in feed_moves(traced) if move.line == line]
        assert sum(map(seconds, made)) == pytest.approx(
            shape.length / 250 * 60, rel=0.001, abs=1e-3
        )
        for part in shape.points(7):
            assert abs(cut - part).min() <= max(0.3, 0.2 * shape.length)


BEYOND = "G1 Z600"
BAD = ["G0 Z1", "G1 Y2", "G2 Z1", "G20", BEYOND, "G3 Z99 R1", "T1", "G1 X1 C1", "G10 L2 P1 X0"]


@settings(max_examples=25)
@given(steps=STEPS, bad=st.sampled_from(BAD), at=st.integers(0, 4))
def test_any_bad_block_anywhere_means_that_nothing_moves(lathe, steps, bad, at):
    blocks, _ = drawn(steps, R)
    at = min(at, len(blocks))
    behind = [] if bad == BEYOND else blocks[at:]  # arcs would be wrong from there
    text, line = refused(lathe, section(*blocks[:at], bad, *behind))
    assert (line, text.split(":")[0]) == (6 + at, f"G7.1 line {6 + at}")
