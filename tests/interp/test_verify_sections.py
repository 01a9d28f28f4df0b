# SPDX-License-Identifier: GPL-2.0-or-later
"""Valid sections that are hard to compare with their words, and broken ones beside them."""

import math

import pytest

from support.judged_programs import prove_lines

HEAD = ["G21 G18 G8 G40 G90 G94 G64", "T3 M6", "S1000 M3", "G0 X40 Z2 C0", "G12.1"]
FLATS = ["Z-3", "C-12", "X[-20-#1]", "C12", "X[20+#1]", "C11", "G40 X40", "G1 C12"]
OUT = ["Z2", "G13.1"]


@pytest.fixture
def found(tmp_path):
    """Return a function: the codes and lines that verify finds in a section of some lines."""

    def codes(*lines, head=HEAD):
        proof = prove_lines(tmp_path, [*head, *lines, *OUT], "lathe_mm")
        assert proof.sections
        return proof.finding_codes

    return codes


@pytest.mark.parametrize("short", [0.0, 0.00002, 0.0002, 0.002])
def test_an_inside_arc_that_closes_as_well_as_its_decimals(short, found):
    """Its end is nearer to the centre; an outside corner of 90 degrees follows."""
    start, centre = complex(20, math.sqrt(48)), 24 + 0j
    end = centre + (start.conjugate() - centre) * (1 - short / 8)
    arc = f"G3 X{end.real:.6f} C{end.imag:.6f} I{4:.6f} J{-start.imag:.6f}"
    lead = ["G1 X40 C20 F1000", "G41 X20 C15", "Z-3", f"C{start.imag:.6f}"]
    beyond = [f"G1 X0 C{end.imag - 3:.6f}", "C-30", "G40 X-10 C-40"]
    assert found(*lead, arc, *beyond) == []


@pytest.mark.parametrize("step", [0.03, 0.01])
def test_compensated_lines_that_are_as_short_as_their_decimals(step, found):
    count = int(2 * math.pi * 5 / step)
    angles = (-2 * math.pi * k / count for k in range(1, count + 1))
    lines = [f"X{5 * math.cos(a):.4f} C{3.7 * math.sin(a):.4f}" for a in angles]
    lead = ["G1 X30 C10 F1000", "Z-2", "G41 X5 C0 F800"]
    assert found(*lead, *lines, "G40 X30") == []


PASS = ["G41 X[20+#1] C12", *FLATS]
SUB = ["o100 sub", *PASS, "o100 endsub"]
LOOP = ["#1=0.3", "o1 while [#1 GE -0.1]", *PASS, "#1=[#1-0.3]", "o1 endwhile"]
TWO_PASSES = {  # the lines before a section, and in it
    "lines": ([], ["#1=0.3", *PASS, "#1=0", *PASS]),
    "loop": ([], LOOP),
    "sub": (SUB, ["o100 call [0.3]", "o100 call [0]"]),
}


@pytest.mark.parametrize("form", TWO_PASSES)
def test_rough_with_an_allowance_and_finish_in_one_section(form, found):
    before, passes = TWO_PASSES[form]
    assert found("G1 X40 C12 F1000", *passes, head=[*before, *HEAD]) == []
