# SPDX-License-Identifier: GPL-2.0-or-later
"""Valid sections that are hard to compare with their words, and broken ones beside them."""

import math
import random
import re

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.verify.proof import prove
from support.sim_machines import SIM
from support.valid_programs import machine_of, valid_program

HEAD = ["G21 G18 G8 G40 G90 G94 G64", "T3 M6", "S1000 M3", "G0 X40 Z2 C0", "G12.1"]
FLATS = ["Z-3", "C-12", "X[-20-#1]", "C12", "X[20+#1]", "C11", "G40 X40", "G1 C12"]
OUT = ["Z2", "G13.1", "M2", ""]


@pytest.fixture
def found(tmp_path):
    """Return a function: the codes and lines that verify finds in a program's lines."""

    def codes(*lines):
        program = tmp_path / "program.ngc"
        program.write_text("\n".join(lines))
        proof = prove(program, read_ini(SIM / "lathe_mm_headless.ini"))
        assert proof.sections
        return [(each.code, each.line) for each in proof.judged if each.is_finding]

    return codes


@pytest.mark.parametrize("short", [0.0, 0.00002, 0.0002, 0.002])
def test_an_inside_arc_that_closes_as_well_as_its_decimals(short, found):
    """Its end is nearer to the centre; an outside corner of 90 degrees follows."""
    start, centre = complex(20, math.sqrt(48)), 24 + 0j
    end = centre + (start.conjugate() - centre) * (1 - short / 8)
    arc = f"G3 X{end.real:.6f} C{end.imag:.6f} I{4:.6f} J{-start.imag:.6f}"
    lead = ["G1 X40 C20 F1000", "G41 X20 C15", "Z-3", f"C{start.imag:.6f}"]
    beyond = [f"G1 X0 C{end.imag - 3:.6f}", "C-30", "G40 X-10 C-40"]
    assert found(*HEAD, *lead, arc, *beyond, *OUT) == []


@pytest.mark.parametrize("step", [0.03, 0.01])
def test_compensated_lines_that_are_as_short_as_their_decimals(step, found):
    count = int(2 * math.pi * 5 / step)
    angles = (-2 * math.pi * k / count for k in range(1, count + 1))
    lines = [f"X{5 * math.cos(a):.4f} C{3.7 * math.sin(a):.4f}" for a in angles]
    lead = ["G1 X30 C10 F1000", "Z-2", "G41 X5 C0 F800"]
    assert found(*HEAD, *lead, *lines, "G40 X30", *OUT) == []


def rough_and_finish(form):
    """Return two flats cut with an allowance and without, in one section."""
    lead = ["G1 X40 C12 F1000"]
    if form == "loop":
        loop = ["#1=0.3", "o1 while [#1 GE -0.1]", "G41 X[20+#1] C12", *FLATS]
        return [*HEAD, *lead, *loop, "#1=[#1-0.3]", "o1 endwhile", *OUT]
    if form == "sub":
        sub = ["o100 sub", "G41 X[20+#1] C12", *FLATS, "o100 endsub"]
        return [*sub, *HEAD, *lead, "o100 call [0.3]", "o100 call [0]", *OUT]
    passes = [f"#1={allowance}\nG41 X[20+#1] C12" for allowance in (0.3, 0)]
    return [*HEAD, *lead, passes[0], *FLATS, passes[1], *FLATS, *OUT]


@pytest.mark.parametrize("form", ["lines", "loop", "sub"])
def test_rough_with_an_allowance_and_finish_in_one_section(form, found):
    assert found(*rough_and_finish(form)) == []


@pytest.mark.parametrize(
    ("begin", "end", "call"),
    [("o100 sub", "o100 endsub", "o100 call"), ("O100", "M99", "M98 P100")],
)
def test_a_sub_that_is_called_outside_too_is_read(begin, end, call, found):
    """What follows goes on where it ends; outside of the section it makes moves of its own."""
    lines = [*HEAD[:4], call, *HEAD[3:], "G1 X30 F800", call, "C8", *OUT[:2], call, "M2"]
    assert found(*lines, begin, "G1 X24 F900", "C3", end, "") == []


def test_a_sub_that_calls_itself_is_read(tmp_path):
    body = ["o1 if [#1 gt 0]", "G1 X30 F800", "C[#1]", "X40", "C0", "o100 call [#1-1]", "o1 endif"]
    program = tmp_path / "program.ngc"
    lines = ["o100 sub", *body, "o100 endsub", *HEAD, "o100 call [3]", *OUT]
    program.write_text("\n".join(lines))
    (section,) = prove(program, read_ini(SIM / "lathe_mm_headless.ini")).sections
    assert section.deviation < 0.005 and section.judged == ()


def test_a_section_that_asks_for_a_position_is_a_note(tmp_path):
    program = tmp_path / "program.ngc"
    program.write_text("\n".join([*HEAD, "G1 X30 F800", "X[#<_x>-5]", *OUT]))
    proof = prove(program, read_ini(SIM / "lathe_mm_headless.ini"))
    (each,) = [each for each in proof.judged if each.code == "contour-unread"]
    assert (each.line, each.is_note) == (5, True)
    assert proof.findings == [] and proof.sections[0].sound


@pytest.mark.parametrize(("pin", "notes"), [(31, 0), (29, 2)])
def test_a_passage_narrower_than_the_cutter_is_a_note(pin, notes, tmp_path):
    """A square and a pin beside it: the cutter of 12 mm goes between them."""
    square = ["G1 X40 F300", "G41 X10", "Z-1", "C-10", "X-10", "C10", "X10", "C0", "G40 X40"]
    lines = [*HEAD[:1], "T1 M6", *HEAD[2:], *square, f"G41 X{pin}", f"G2 X{pin} C0 I-4",
             "G1 G40 X40", *OUT]  # fmt: skip
    program = tmp_path / "program.ngc"
    program.write_text("\n".join(lines))
    proof = prove(program, read_ini(SIM / "lathe_mm.ini"))
    found = [each for each in proof.judged if each.code == "cuts-contour"]
    assert sorted((each.line, each.values["line"]) for each in found) == [(9, 16), (16, 9)][:notes]
    assert all(each.values["size"] == pytest.approx(1.0, abs=0.01) for each in found)
    assert not any(each.is_finding for each in proof.judged)


def test_a_line_that_a_copy_puts_into_a_section_does_not_change_its_plan(tmp_path):
    """On the face a message between two moves counts as a corner, which decides between ways."""
    ini = read_ini(SIM / "lathe_mm_kinematics_headless.ini")
    program, head = tmp_path / "program.ngc", "G21 G18 G8 G40 G90 G94 G61"
    ramp = ["G1 X20.06308 C-0.64048 F1448.16", "G41 X10.62862 C-0.3393", "Z-2.282"]
    corners = ["X10.45765 C-5.69514", "X0.43899 C-11.89976", "X-10.43434 C-5.73773"]
    corners += ["X-9.92562 C6.57868", "X1.71171 C11.78419", "X10.7996 C5.01654"]
    end = ["X10.62862 C-0.3393", "G40 X20.06308 C-0.64048", "G13.1", "G0 Z5", "M2", ""]
    start = [head, "T1 M6", "S500", "G0 X60 Z5 C0", "G12.1"]
    program.write_text("\n".join([*start, *ramp, *corners, *end]))
    assert prove(program, ini.replaced({"G12": {"POLAR_TOOL_OFFSET": "-0.7"}})).findings == []


@pytest.mark.parametrize("kind", ["polar kinematics", "polar beside kinematics"])
def test_feeds_beyond_what_the_face_can_do_are_cut_down(kind, tmp_path):
    text = valid_program(kind, random.Random(f"fast {kind}"), 6)
    program = tmp_path / "program.ngc"
    program.write_text(re.sub(r"\bF([\d.]+)", lambda word: f"F{10 * float(word[1]):g}", text))
    proof = prove(program, machine_of(kind))
    assert proof.findings == []
    assert "feed-cut-down" in [each.code for each in proof.judged]
