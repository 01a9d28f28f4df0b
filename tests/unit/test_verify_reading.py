# SPDX-License-Identifier: GPL-2.0-or-later
"""What a program's text says: words as LinuxCNC reads them, targets and contours from words."""

import cmath
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import (
    LONGEST_REPORT_LINE,
    STATE_NAMES,
    TAG,
    Block,
    blocks_in,
    read_line,
    reports_after,
    reports_before,
)
from g12.tools.preview.moves import Event
from g12.tools.verify.expected.cylinder import SurfacePen
from g12.tools.verify.expected.polar import Pen
from g12.tools.verify.reading import sections as section_reading
from g12.tools.verify.reading.circles import CircleReader
from g12.tools.verify.reading.codes import SHAPES, Codes
from g12.tools.verify.reading.executed_subs import Copies
from g12.tools.verify.reading.sections import INSIDE, doubts_of, lines_of_copy
from support.made_moves import Hand

REMAPS = (
    "[RS274NGC]",
    "REMAP = G12 modalgroup=1 prolog=g12_haas ngc=g12_haas epilog=cycle_done",
    "REMAP = G13 modalgroup=1 prolog=g13_haas ngc=g12_haas epilog=cycle_done",
    "REMAP = G12.1 modalgroup=1 python=polar_on",
    "REMAP = G13.1 modalgroup=1 python=polar_off",
    "REMAP = G7.1 modalgroup=1 python=cylinder_mode",
    "REMAP = M6 modalgroup=6 ngc=change",
)
INI = Ini(Path("x.ini"), REMAPS)
CODES = Codes(INI)
YASNAC = Codes(Ini(Path("x.ini"), tuple(line.replace("haas", "yasnac") for line in REMAPS)))


# ---------------------------------------------------------------- words


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("n10g12i.5 z - 1. (a comment X9) d01; Y9", "N10 G12 I.5 Z-1. D01"),
        ("(only a comment)", ""),
        ("X[#1+[2*3]] Y#<a b> Z-#2", "X[#1+[2*3]] Y#<ab> Z-#2"),
        ("X sin[30] Y-atan[1]/[2]Z##3", "Xsin[30] Y-atan[1]/[2] Z##3"),
        ("%", ""),
    ],
)
def test_words_are_read_as_linuxcnc_reads_them(line, words):
    assert " ".join(letter + value for letter, value in read_line(1, line).words) == words


@pytest.mark.parametrize("line", ["o100 while [#1 LT 5]", "N5 o<sub> call [1]", "/o1 if"])
def test_control_lines_are_told(line):
    assert read_line(1, line).control


def test_only_expressions_are_asked_of_linuxcnc():
    lines = list(reports_before(read_line(4, "G12 I.5 K[#1] Z-1 D#2")))
    scaled = "#<@>=[#<@>*1000000]"
    read = [line for line in lines if line.startswith("#<@>=")]
    assert read == ["#<@>=[#1]", scaled, "#<@>=#2", scaled]
    assert all(line.startswith("/") for line in reports_before(read_line(4, "/G12 I#1")))


@pytest.mark.parametrize("shape", SHAPES)
def test_no_call_of_a_shape_is_too_long_to_be_asked(shape):
    call = f"o<{shape}>call["
    line = f"{call}{'1' * (LONGEST_REPORT_LINE - len(call) - 1)}]"
    longest = read_line(1, line.replace("11", "+1"))
    assert len(line) == LONGEST_REPORT_LINE and longest.call == shape and not longest.too_long


def reported(texts, *lines):
    """Return the blocks of a trace whose messages are those, one move after each."""
    events = [Event(at, 0, f"message {TAG} {line}") for at, line in enumerate(lines)]
    trace = Hand().trace()
    return blocks_in(type(trace)(**{**vars(trace), "events": events}), texts)


def test_blocks_are_put_together_from_messages():
    state = "1e6 2e6 3e6 .5 1 1 0"
    end = "end 1 4e6 5e6 6e6 0 1 1 0"
    (block,) = reported([read_line(1, "G12 I#1 Z-1")], f"begin 1 {state}", "value 1 750000", end)
    assert (block.words, block.codes) == ({"I": 0.75, "Z": -1.0}, (12.0,))
    assert (block.at, block.end) == (0, 2)
    assert block.state == dict(zip(STATE_NAMES, (1, 2, 3, 5e-7, 1, 1, 0)))
    assert (block.state_after["_x"], block.state_after["_z"]) == (4, 6)


def test_a_block_inside_a_call_leaves_the_call_its_own():
    """As the section of a shape's sub, whose end comes before that of the call."""
    state = "0 0 0 0 1 1 0"
    texts = [read_line(1, "o<polar_slot> call [#1]"), read_line(2, "G12.1 X#2")]
    lines = (f"begin 1 {state}", "value 0 8e6", f"begin 2 {state}", "value 1 5e6")
    inner, call = reported(texts, *lines, f"end 2 {state}", f"end 1 {state}")
    assert (inner.words, inner.at, inner.end) == ({"X": 5.0}, 2, 4)
    assert (call.arguments, call.at, call.end) == ((8.0,), 0, 5)


def test_a_block_that_ends_the_program_has_all_moves_that_follow():
    (block,) = reported([read_line(1, "G12 I1 M2")], "begin 1 0 0 0 0 1 1 0")
    assert (block.at, block.end) == (0, 0)  # there are no moves


def test_after_tells_the_same_number():
    *_, line = reports_after(read_line(12, "G12 I1"))
    assert line.startswith(f"(DEBUG,{TAG} end 12 ")


# ---------------------------------------------------------------- targets


def block(line, number=1, at=1, end=2, **state):
    """Return an executed block with plain numbers, metric and absolute unless told otherwise."""
    text = read_line(number, line)
    values = [(letter, float(value)) for letter, value in text.words]
    found = {"_x": 0, "_y": 0, "_z": 0, "_c": 0, "_metric": 1, "_absolute": 1, "_feed": 600}
    return Block(
        text,
        {letter: value for letter, value in values if letter != "G"},
        tuple(value for letter, value in values if letter == "G"),
        tuple(value for letter, value in values if letter == "M"),
        (),
        {**dict.fromkeys(STATE_NAMES, 0), **found, **state},
        at,
        end,
    )


def target(line, moves=None, **state):
    moves = moves or Hand().rapid(x=3, y=4, z=5).line(z=4).moves
    reader = CircleReader(CODES, INI, moves, {1: 6.0, 2: 10.0})
    return next(found for _, found in reader.targets([block(line, **state)]))


HERE = {"_x": 3, "_y": 4, "_z": 5}


def test_haas_words_tell_wall_core_and_depth():
    found = target("G12 I4 K20 Q3 Z-2 D2", **HERE)
    assert (found.wall.radius, found.cutter.radius, found.wall.cleared) == (20, 5, 0)
    assert np.allclose(found.wall.origin, [3, 4, 5])
    assert found.deepest == pytest.approx(-7)
    assert (found.words.turn, found.wall.inside) == (-1, True)
    assert (found.cutter.tool, found.cutter.loaded, found.cutter.named) == (1, 3, 2)


@pytest.mark.parametrize(("line", "core"), [("G13 I15.1 Z-2 D2", 5.1)])
def test_one_ring_leaves_its_core_but_what_the_way_down_has_cleared(line, core):
    assert target(line, **HERE).wall.cleared == pytest.approx(core)


def test_d0_puts_the_tool_centre_on_the_circle():
    found = target("G12 I4 Z-2 D0", **HERE)
    assert (found.wall.radius, found.cutter.radius) == (7, 3)
    assert (found.words.final, found.words.word) == (4, "I")


@pytest.mark.parametrize(
    ("words", "core", "bore"),
    [
        ("I50 D2", 40, 0),
        ("I50 K35 Q4 L2 D2", 29, 0),
        ("I50 R40 D2", 40, 40),
        ("I50 R40", 43, 43),
    ],
)
def test_yasnac_leaves_the_middle_by_design(words, core, bore):
    found = CircleReader(YASNAC, INI, Hand().rapid(z=5).line(z=4).moves, {1: 6.0, 2: 10.0})
    ((_, expected),) = found.targets([block(f"G13 {words}")])
    assert (expected.wall.cleared, expected.wall.bore) == (core, bore)


def test_incremental_words_count_from_the_tool():
    found = target("G13 G91 I4 Z-.5 L4 X1 Y-2 D1", **HERE)
    assert np.allclose(found.wall.origin, [4, 2, 5])
    assert found.deepest == pytest.approx(-2)


def test_inch_words_become_millimetres():
    found = target("G20 G12 I1 Z-1 D1", **HERE)
    assert (found.wall.radius, found.deepest) == pytest.approx((25.4, -30.4))
    found = target("G21 G12 I8 Z-2 D1", **{**HERE, "_metric": 0})
    assert (found.wall.radius, found.deepest) == (8, pytest.approx(-2 - 5 * 25.4))


def test_the_last_d_is_remembered():
    moves = Hand().rapid(z=5).line(z=4).line(z=3).moves
    reader = CircleReader(CODES, INI, moves, {1: 6.0, 2: 10.0})
    again = block("G12 I9 Z-1", at=2, end=3)
    blocks = [block("G41 D2 X1", at=0, end=1), block("G12 I9 Z-1"), block("G12 I9 Z-1 D1")]
    cutters = [found.cutter.radius for _, found in reader.targets([*blocks, again])]
    assert cutters == [5, 3, 3]


def test_a_centre_word_turns_with_the_work_coordinates():
    moves = [move._replace(rotation=90.0) for move in Hand().rapid(x=3, y=4).line(z=-1).moves]
    found = target("G12 X10 Y0 I5 Z-1 D1", moves)
    assert np.allclose(found.wall.origin, [3, 14, 0])


def test_codes_know_cycles_and_sections_by_their_handlers():
    assert CODES.cycle_of("", (12.0,)).dialect == "haas"
    assert CODES.cycle_of("", (1.0,)) is None
    assert CODES.cycle_of("circle_mill", ()).dialect == "circle-mill"
    assert CODES.switch(read_line(1, "G12.1"), False) == "on"
    assert CODES.switch(read_line(1, "N5 G13.1"), True) == "off"
    assert CODES.switch(read_line(1, "G1 X5"), False) == ""


@pytest.mark.parametrize(
    ("line", "inside", "does"),
    [
        ("G7.1 C0.", False, "off"),
    ],
)
def test_one_code_switches_sections_on_a_cylinder_on_and_off(line, inside, does):
    assert CODES.switch(read_line(1, line), inside) == does
    lines = ["T1 M6", "G[13] I5", "G#5 I5", "G41 D1", "G12.1", "G41 X1", "G13.1"]
    texts = [read_line(number, line) for number, line in enumerate(lines)]
    assert {text.number for text in CODES.selected_in(texts)} == {1, 2, 3, 4, 6}
    known = [code for code in ("G13", "G12.1", "G2", "M6", "") if CODES.knows(code)]
    assert known == ["G13", "G12.1"]


def test_a_radius_that_is_found_to_be_0_begins_no_section():
    """G7.1 C#1 in a sub: the text of two blocks is the same, their values are not."""
    text = read_line(1, "G7.1 C#1")
    empty, full = (replace(block(f"G7.1 C{radius}"), text=text) for radius in (0, 20))
    run = [empty, block("G1 Z-5"), block("G7.1 C0"), full, block("G7.1 C0")]
    assert [group[0] for group in section_reading.grouped(run, CODES)] == [full]


@pytest.mark.parametrize(("handler", "turn"), [("g12", -1)])
def test_the_turn_is_that_of_the_handler_whatever_the_code(handler, turn):
    line = f"REMAP = G22 modalgroup=1 prolog={handler}_haas ngc=g12_haas epilog=cycle_done"
    codes = Codes(Ini(Path("x.ini"), ("[RS274NGC]", line)))
    moves = Hand().rapid(z=5).line(z=4).moves
    reader = CircleReader(codes, INI, moves, {1: 6.0})
    ((_, found),) = reader.targets([block("G22 I9 Z-1")])
    assert (found.words.turn, found.code) == (turn, "G22")


def test_a_cycle_with_a_prolog_of_the_machines_own_is_known_by_its_sub():
    lines = ("[RS274NGC]", "REMAP = G12 modalgroup=1 prolog=mine ngc=g12_haas")
    cycle = Codes(Ini(Path("x.ini"), lines)).cycle_of("", (12.0,))
    assert (cycle.dialect, cycle.turn) == ("haas", 0)
    lines = ("[RS274NGC]", "REMAP = G13.2 modalgroup=1 prolog=mine ngc=g12_circle_mill")
    codes = Codes(Ini(Path("x.ini"), lines))
    assert codes.cycle_of("", (13.2,)) is None and codes.knows("G13.2")


def test_loops_are_spring_passes_or_further_levels():
    assert target("G12 I4 Z-2 L3 D1", **HERE).words.depths == pytest.approx([-7, -7, -7])
    assert target("G12 G91 I4 Z-2 L3 D1", **HERE).words.depths == pytest.approx([-2, -4, -6])
    assert target("G12 G91 I4 L2 D1", **HERE).words.depths == [0, 0]


@pytest.mark.parametrize(
    ("line", "core"),
    [("G13 I18 Z-2 D2", 0), ("G13 I18 D2", 8)],
)
def test_only_a_helix_that_goes_down_clears_the_core_of_one_ring(line, core):
    moves = Hand().rapid(x=3, y=4, z=5).line(z=4).moves
    ini = INI.replaced({"G12": {"ENTRY": "helix"}})
    reader = CircleReader(CODES, ini, moves, {1: 6.0, 2: 10.0})
    ((_, found),) = reader.targets([block(line, **HERE)])
    assert found.wall.cleared == pytest.approx(core)


@pytest.mark.parametrize(
    ("line", "state", "feed"),
    [
        ("G12 I4 Z-2 F50", {}, 50),
        ("G12 I4 Z-2", {"_feed": 2, "_metric": 0}, 50.8),
        ("G20 G12 I4 Z-2 F50", {}, None),  # LinuxCNC reads F before it changes the units
        ("G12 I4 Z-2", {"_feed": 1}, None),
    ],
)
def test_the_feed_is_the_blocks_or_the_one_in_force(line, state, feed):
    words = target(line, **state).words
    assert (words.feed, words.plunge_feed) == (feed, feed)


# ---------------------------------------------------------------- contours


def drawn(*lines, reading="inherit", **state):
    """Return the elements that lines inside a section describe; it begins at X20."""
    ini = INI.replaced({"G12": {"POLAR_X": reading}})
    pen = Pen(block("G12.1", **{"_x": 20, "_motion_mode": 10, **state}), ini)
    return [e for number, line in enumerate(lines, 2) for e in pen.draw(block(line, number))]


def test_bare_words_repeat_the_motion_and_coordinates_stay():
    one, two, three = drawn("G1 C5", "X10", "U-2 H1")
    assert (one.end, two.end, three.end) == (20 + 5j, 10 + 5j, 8 + 6j)


def test_x_is_halved_in_diameter_mode_only():
    assert drawn("X10", _lathe_diameter_mode=1)[0].end == 5
    assert drawn("X10", reading="diameter")[0].end == 5
    assert drawn("X10", reading="radius", _lathe_diameter_mode=1)[0].end == 10


@pytest.mark.parametrize(
    ("words", "centre", "quarters"),
    [
        ("G2 I-5", 15, -4),
        ("G3 X0 C20 R-20", 20 + 20j, 3),
    ],
)
def test_arcs_by_their_centre_and_by_their_radius(words, centre, quarters):
    (arc,) = drawn(words)
    assert arc.centre == pytest.approx(centre, abs=1e-12)
    assert arc.sweep == pytest.approx(quarters * math.pi / 2)
    middle = arc.centre + (20 - arc.centre) * cmath.exp(0.5j * arc.sweep)
    assert abs(arc.curve.point(0.5) - middle) < 1e-12


@pytest.mark.parametrize(("code", "turn"), [("G2", -1), ("G3", 1)])
def test_a_full_circle_is_whole_whatever_its_centre_rounds_to(code, turn):
    for words in ("I-3.314 J5.371", "I.1 J.7", "I-7.3 J.003"):
        circle = drawn("G1 X11.902 C-25.519", f"{code} {words}")[-1]
        assert circle.sweep == turn * 2 * math.pi


def test_ramps_are_where_compensation_changes():
    found = drawn("G1 C5", "G41 X10", "C0", "Z-1", "G40 X20")
    ways = [(e.side, e.ramp) for e in found if e.length]
    assert ways == [(0, False), (1, True), (1, False), (0, True)]


def test_incremental_mode_holds_for_both_axes():
    assert drawn("G91 G1 X-5 C2", "C2")[-1].end == 15 + 4j


@pytest.mark.parametrize("save", ["M70", "M73"])
def test_saved_modes_come_back(save):
    found = drawn(save, "G91 G3 X-1 R9", "M72", "X20 C5")
    assert found[-1].end == 20 + 5j and found[-1].centre is None
    back, gone = drawn(save, "G91", "M72 X15", "M71")[0], drawn(save, "G91", "M71", "X-1")[0]
    assert (back.end, gone.end) == (15, 19)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("o<flat> call", "calls o<flat>"),
        ("X[#<_x>+1]", "asks for a position"),
        (f"X[1{'+1' * 124}]", "is too long"),
        ("X[#<_value>]", ""),
        ("o77 call", ""),
    ],
)
def test_what_cannot_be_followed_is_a_doubt(line, why, tmp_path):
    copies = copies_of(tmp_path, "G12.1", "G1 C5", line, "G13.1", "o77 sub", "o77 endsub")
    assert doubts_of(copies) == ({copies.texts[2]: f"line 3 {why}"} if why else {})


def copies_of(folder, *lines):
    """Return the copies of a program without files of subs."""
    (folder / "program.ngc").write_text("\n".join(lines))
    return Copies(folder / "program.ngc", [])


def in_copy(folder, *lines):
    """Return the copy's lines, without those that report blocks."""
    copies = copies_of(folder, *lines)
    copied = [line for some in lines_of_copy(copies, CODES, doubts_of(copies)) for line in some]
    return [line for line in copied if "DEBUG" not in line and "#<@" not in line]


def test_motion_is_taken_out_of_the_copy_and_control_stays(tmp_path):
    loop = ["#1=2", "o1 while [#1]", "X#1 #1=[#1-1]", "o1 endwhile"]
    kept = ["#1=2", "o1 while [#1]", "#1=[#1-1]", "o1 endwhile"]
    lines = in_copy(tmp_path, "G0 X5", "G12.1", *loop, "G13.1", "G0 X9")
    assert lines == ["G0 X5", f"{INSIDE}=1", *kept, f"{INSIDE}=0", "G0 X9"]


def test_a_sub_that_a_section_calls_moves_outside_of_it_alone(tmp_path):
    sub = ["o<flat> sub", "M8 X1", "o<flat> endsub", "O1000", "G1 X5", "M99"]
    calls = ["G12.1", "o<flat> call [1]", "M98 P1000", "G13.1", "o<flat> call [2]"]
    lines = in_copy(tmp_path, *sub, *calls)
    one = [f"o<g12_line_1> if [{INSIDE}]", "M8", "o<g12_line_1> else", "M8 X1"]
    two = [f"o<g12_line_4> if [{INSIDE}]", "o<g12_line_4> else", "G1 X5"]
    bodies = [sub[0], *one, "o<g12_line_1> endif", *sub[2:4], *two, "o<g12_line_4> endif", "M99"]
    section = [f"{INSIDE}=1", *calls[1:3], f"{INSIDE}=0"]
    assert lines == [*bodies, *section, calls[4]]


def test_a_condition_on_a_position_is_reported_where_a_section_has_called_it(tmp_path):
    sub = ["o<flat> sub", "o2 if [#<_x> GT 1]", "o2 endif", "o<flat> endsub"]
    lines = in_copy(tmp_path, *sub, "G12.1", "o<flat> call", "G13.1")
    label = "o<g12_line_1>"
    assert lines[1:4] == [f"{label} if [{INSIDE}]", f"{label} endif", sub[1]]


# ---------------------------------------------------------------- contours on a cylinder

DEGREE = math.radians(20)  # mm on a radius of 20


def unrolled(*lines, radius="C20", reading="radius", **state):
    """Return a pen on a cylinder, and what it draws; it begins at X24 C10 Z-5."""
    place = {"_x": 24, "_z": -5, "_c": 10, "_motion_mode": 10}
    first = block(f"G7.1 {radius}", **{**place, **state})
    pen = SurfacePen(first, INI.replaced({"G12": {"CYLINDER_WORD": reading}}))
    return pen, [e for number, line in enumerate(lines, 2) for e in pen.draw(block(line, number))]


def test_x_is_the_height_above_the_axis():
    pen, (down, up) = unrolled("X18", "U2", _lathe_diameter_mode=1)
    assert (down.depth, down.length, up.depth) == (9.0, 0.0, 10.0)
    assert pen.surface == 20.0


def test_the_word_of_the_surface_may_be_its_diameter():
    assert unrolled(radius="C40", reading="diameter")[0].surface == 20.0


def test_arcs_on_a_cylinder_have_their_centre_along_c_and_z():
    end = math.degrees(0.5)
    for words in ("J10", "I10", "R10"):  # a quarter, clockwise as seen from outside
        _, (arc,) = unrolled(f"G2 H{end:.9f} W10 {words}")
        assert arc.centre == pytest.approx(10 * DEGREE + 10 - 5j)
        assert arc.sweep == pytest.approx(-math.pi / 2)
    _, (arc,) = unrolled(f"G3 H{end:.9f} W10 K10")
    assert arc.centre == pytest.approx(10 * DEGREE + 5j)
    assert arc.sweep == pytest.approx(math.pi / 2)


def test_what_a_section_on_a_cylinder_leaves():
    pen, _ = unrolled("C400 Z2 F300", "X18")
    left = pen.leaves({"_metric": 1.0, "_c": 10.0})
    place = [left[name] for name in ("_x", "_c", "_z", "_feed")]
    assert place == pytest.approx([18, 400, 2, 300])
