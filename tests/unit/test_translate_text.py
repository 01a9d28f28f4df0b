# SPDX-License-Identifier: GPL-2.0-or-later
"""The translation as text: lines, comments, sentences; that it is the same part: interp."""

import re
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from g12.tools.commands import translate
from g12.tools.machine.ini import read_ini
from g12.tools.translate.blocks.control import read_control
from g12.tools.translate.blocks.lexer import program_text
from g12.tools.translate.on_machine import on_machine
from g12.tools.translate.program import translate_program
from support.foreign_programs import control_of
from support.growth import growth
from support.sim_machines import ROOT, SIM

HAAS, FANUC = control_of("haas-mill"), control_of("fanuc-mill")
LATHE, HAAS_LATHE = control_of("fanuc-lathe"), control_of("haas-lathe")
OKUMA, INTEGREX = control_of("okuma-lathe"), control_of("mazak-integrex")
PAGE = ROOT / "python" / "g12" / "tools" / "translate" / "README.md"
MILL, TURN = "G20 G90 G54 G0 X0 Y0 Z1.", "G0 X50. Z5."


def program(control, text):
    """Return a program: a line of comment, a head (before ``|``, or the usual one) and the text."""
    head, bar, rest = text.partition("|")
    own = head if bar else TURN if control.is_lathe else MILL
    return f"(HEAD)\n{own}\n{rest if bar else text}\nM30\n", 2 + own.count("\n")


def lines(control, text):
    """Return the lines of a translation that must succeed."""
    result = translate_program(text, control)
    assert result.refused == []
    return result.text.splitlines()


def lines_after(control, text):
    """Return the lines after the head."""
    whole, head = program(control, text)
    return lines(control, whole)[head:]


def refusal(control, text):
    """Return the first refusal of a program: its line after the head and its sentence."""
    whole, head = program(control, text)
    result = translate_program(whole, control)
    assert (result.text, bool(result.refused)) == ("", True)
    return result.refused[0].line - head, result.refused[0].sentence


# ---------------------------------------------------------------- what is written


POLAR = "G20 G98 G0 X6. Z6.\nG1 X5. F9.\nG112\nG1 X4.\nG0 X5.\nG113"
WRITTEN = [  # control, text (or head|text), the lines after the head
    (HAAS, "G01 X+1.500 Y-.50 F010.", ["G01 X+1.500 Y-.50 F010."]),
    (HAAS, "g 0 x 1 . 5 y - 2 .", ["G0 X1.5 Y-2."]),
    (HAAS, "X\N{MINUS SIGN}1.", ["X-1."]),
    (HAAS, "G0 X1.; Y1.;", ["G0 X1.", "Y1. (line 3)"]),
    # comments stay and do nothing
    (HAAS, "(A (B) C)(ONE { BRACE)(X;Y)(TAB\tHERE)(SÄGE 5° — ½)",
     ["(A [B] C)(ONE { BRACE)(X,Y)(TAB HERE)(SÄGE 5° — ½)"]),
    (HAAS, "(MSG, A)( print,#1)(DEBUG,X)(LOG,Y)(PY,x=1)(AXIS,hide)(ABORT, no)(PROBEOPEN,f)",
     ["(- MSG, A)(- print,#1)(- DEBUG,X)(- LOG,Y)(- PY,x=1)(- AXIS,hide)(- ABORT, no)"
      "(- PROBEOPEN,f)"]),
    (HAAS, f"G0 X1. ({'A' * 300})",
     ["G0 X1.", f"({'A' * 200}) (line 3)"]),
    (HAAS, "G0 X2.; rapid to the part", ["G0 X2. (rapid to the part)"]),
    # ; where its lines show that it begins remarks: they cannot be words
    (HAAS, "; T2 ENDMILL (X)\n;G1 Z-1. F5.\nG0 X1.; Z5.5.5 (Y)\n;; ---",
     ["(X)(T2 ENDMILL)", "(G1 Z-1. F5.)", "G0 X1. (Y)(Z5.5.5)", "(---)"]),
    (HAAS, "G0 X2. ; 2 mm above Z0; ---", ["G0 X2. (2 mm above Z0)(---)"]),
    (HAAS, "M30\nO5\nG47 X1.\nM99",
     ["M30", "(not reached: O5)", "(not reached: G47 X1.)", "(not reached: M99)"]),
    # words and codes that are not LinuxCNC's
    (HAAS, "G81 X1. Z-.5 R.1 Q.1 P500 F8.", ["G81 X1. Z-.5 R.1 F8. (Q.1)(P0.5)"]),
    (HAAS, "G0 X1. A0. B0\nA0.\nG1 Y1. A0 F5.",
     ["G0 X1. (A0.)(B0)", "(A0.)", "G1 Y1. F5. (A0)"]),
    (HAAS, "G28 A0.\nG53 A0.\nG91 G28 A0.\nG90 G52 A0.",
     ["G49 (G28)(A0.)", "(G53)(A0.)", "G91 G49 (G28)(A0.)", "G90 (G52)(A0.)"]),
    (HAAS, "G81 X0 Y0 Z-1. R.1 A0. F5.\nG80 A0.", ["G81 X0 Y0 Z-1. R.1 F5. (A0.)", "G80 (A0.)"]),
    (HAAS, "M31\nM88", ["(M31)", "M88"]),
    (HAAS, "G187 P1 E.01\nG103 P1\nG103\nG69",
     ["(G187 P1 E.01)", "(G103 P1)", "(G103)", "(G69)"]),
    (HAAS, "G3 X1. R1. F9. M5 M9\nG0 X2. M9", ["G3 X1. R1. F9.", "M5 M9 (line 3)", "G0 X2. M9"]),
    (HAAS, "G154 P2 G0 X1.\nG112\nG10 L20 P3 X1.\nG10 L2 P0 X1. G90", [
        "G59.2 G0 X1. (G154 P2)", "G59.3 (G112)", "G10 L2 P9 X1.", "G90 G52 X1.",
    ]),
    (FANUC, "G5.1 Q1\nG8 P1\nG54.1 P1", ["(G5.1 Q1)", "(G8 P1)", "G59.1 (G54.1 P1)"]),
    (HAAS_LATHE, "G390 G0 X1.\nG391 X-.1", ["G90 G0 X1.", "G91 X-.1"]),
    # the spindle, tools
    (LATHE, "G96 S90 M3\nG50 S900\nG97 S50\nG96",
     ["G96 S90 M3", "G96 S90 D900 (G50 S900)", "G97 S50", "G96 D900 S90"]),
    (LATHE, "G97\nG96 S90 M3\nM5\nG97", ["G97", "G96 S90 M3", "M5", "G97"]),
    (LATHE, "T0202 M5\nM3 S99\nG1 X1. F.1\nM99", ["T2 M6 G43 H2 M5"]),
    *((control_of("doosan-lathe"), f"{before}\nT0202", [*before.split("\n"), written])
      for before, written in [
        ("M3 S99", "T2 M6 G43 H2 M3"), ("M4 S99", "T2 M6 G43 H2 M4"),
        ("M3 S99\nM5", "T2 M6 G43 H2"), ("M3 S99\nM35", "T2 M6 G43 H2"),  # M35: it is C
      ]),
    # planes, sections, cylinders
    (LATHE, "G17XC\nG17 U0 H0", ["G17 (X C)", "G17 (U0 H0)"]),
    (HAAS_LATHE, "G0 Z1.|G20 G98 G1 X5. F9.\nG112\nG0 X2. F8.\nG1 X1.\nG0 X2.\nG113\nG99 G1 X2.5", [
        "G20 G94 G1 X5. F9.", "G8", "G12.1 (line 4)", "X2. G1 G94 F100", "G1 X1. F8. G94",
        "X2. G1 G94 F100", "G13.1", "G7 (line 8)", "G95 G1 X2.5 F8.",
    ]),
    (LATHE, "T101\nG0 X50. Z5.|G107 C25.\nG1 Z-5. C30.\nU1. W2. H3.\nG41 D1 Z0\nG7.1 C0",
     ["G7.1 C25.", "G1 Z-5. C30.", "U1. W2. H3.", "G41 Z0", "G7.1 C0"]),
    *((LATHE, f"G98 G0 X60. Z2. C0\nG12.1|{text}\nG13.1", written) for text, written in [
        ("G42 G1 X60. C0 F9.\nX50.", ["G1 F9. (G42 with the next move)", "G42 X50."]),
        ("G41 G1 X50. F9.\nG40 G1 Z9.\nZ8.\nX70.",
         ["G41 G1 X50. F9.", "G1 Z9. (G40 with the next move)", "Z8.", "G40 X70."]),
        ("G1 X50. C1. Z2. F9.", ["G1 X50. C1. F9. (Z2.)"]),
        ("G1 X50. F9.\nG40 Z9.", ["G1 X50. F9.", "Z9. (G40)"]),
    ]),
    (HAAS_LATHE, "G20 G0 X2. Z.1 C0\nG112\nG1 X1. Y0 F9.|G41 Y.5\nG40 Y1.\nG113",
     ["G1 X1. C0 F9.", "G41 C.5", "G40 C1.", "G13.1", "G7 (line 7)"]),
    # C beside a slide: no other feed where C does not turn or the slides do not move
    (LATHE, "G21 G98\nG0 X50. Z5. C0|G1 X40. C0 F100.\nX40. C30.\nG0 X50. C40.",
     ["G1 X40. C0 F100.", "X40. C30.", "G0 X50. C40."]),
    # words of axes that the machine lacks, radii
    (INTEGREX, "G0 G53 X9. Y0.\nG0 G53 B0.\nG28 V0.",
     ["G0 G53 X9. (Y0.)", "G0 (G53)(B0.)", "(G28)(V0.)"]),
    (INTEGREX, "G21 G10.9 X0|G0 X50. Z5. C0.\nG12.1\nG1 X20. F100.\nG13.1\nG10.9 X1\nG0 X60.",
     ["G0 X50. Z5. C0.", "G12.1", "G1 X20. F100.", "G13.1", "G7", "G0 X60."]),
    (LATHE, "G21 G10.9 X0\nG0 X50. Z5. C0.|G12.1\nG1 X20. F100.\nG13.1",
     ["G7", "G12.1 (line 4)", "G1 X20. F100.", "G13.1", "G8 (line 6)"]),
    # the program's feed after a rapid of polar mode
    *((HAAS_LATHE, f"{POLAR}|G0 X1. Z1.\n{cut}", ["G13.1", "G7 (line 7)", "G0 X1. Z1.", first])
      for cut, first in [
          ("G81 Z-.5 R.2", "F9. G94"), ("G83 Z-.5 R.2 Q9.", "F9. G94"),
          ("G90 X.3 Z-.5", "F9. G94 (G90)"),
      ]),
]  # fmt: skip
PROGRAMS = [  # control, a whole program, its lines
    (HAAS, "%\nO5\nX1.\nM99\nO1 (MAIN)\nG20 G90 G0 X0\nM98 P5\nM30\n%\n", [
        f"{' '.join(HAAS.start)} (%)", "(O1)(MAIN) (line 5)", "G20 G90 G0 X0 (line 6)",
        "M98 P5 (line 7)", "M30 (line 8)", "O5 (line 2)", "X1. (line 3)", "M99 (line 4)",
        "(%) (line 9)",
    ]),
    (HAAS, "(A)\n%\nO5\nG20 G0 X1.\nM30\n%\nG0 X9.\n", [
        f"{' '.join(HAAS.start)} (A)", "(%)", "(O5)", "G20 G0 X1.", "M30", "(%)",
        "(not reached: G0 X9.)",
    ]),
    (HAAS, "O1\n%O5°(A)\nO5\nG20 G0 X1.\nM30\n", [
        f"{' '.join(HAAS.start)} (O1)", "(%O5°)(A)", "(O5)", "G20 G0 X1.", "M30",
    ]),
    (OKUMA, "$PART1.MIN%\nG0 X50.\nM2\n", [
        f"{' '.join(OKUMA.start)} ($PART1.MIN%)", "G0 X50.", "M2",
    ]),
    (HAAS, "\ufeff%\nG0 X0\nM30\n", [f"{' '.join(HAAS.start)} (%)", "G0 X0", "M30"]),
]  # fmt: skip


@pytest.mark.parametrize(("control", "text", "written"), WRITTEN)
def test_what_is_written(control, text, written):
    assert lines_after(control, text)[: len(written)] == written


@pytest.mark.parametrize(("control", "text", "written"), PROGRAMS)
def test_a_whole_program(control, text, written):
    assert lines(control, text) == written


@pytest.mark.parametrize("end", ["\r\n", "\r"])
def test_line_ends(end):
    assert lines(HAAS, f"(HEAD){end}G0 X1.{end}M30{end}")[1:] == ["G0 X1.", "M30"]


def test_bytes_of_any_kind_are_text():
    assert program_text(b"(\xe4)") == program_text("(ä)".encode()) == "(ä)"
    assert program_text(b"\xef\xbb\xbfG0") == "\ufeffG0"


# ---------------------------------------------------------------- what is refused


LAST = [  # control, text, how the sentence about its last line begins
    (HAAS, "G#1 X1.", "G#1: a code must be a number"),
    (HAAS, "G0 G1 X1.", "G0 and G1 in one block"),
    (HAAS, "G0 X1. X2.", "X is given twice in this block"),
    (HAAS, "G0 U1.", "U1. is not understood in this block"),
    (HAAS, "G0 X", "X has no value"),
    (HAAS, "G1 X1. R.1 F5.", "R beside G1: write the corner's line or"),
    (HAAS, "G1 X1. ,C.1 F5.", ",C.1F5. draws a corner: write its line or arc"),
    (HAAS, "G84 Z-1. R.1 J2 F5.", "G84 with J is not translated"),
    (LATHE, "G10.9 X2.", "G10.9 needs X0, radii, or X1, diameters, and no other axis"),
    (HAAS, "; T2 ENDMILL\nG0 X1.; Y1.", "Y1. is a block or a remark: lines of ; are remarks here"),
    (HAAS, "G0 X1.)", ") without its opening bracket before it"),
    (HAAS, "G0 X1. (a", "a comment is not closed: ) is missing"),
    (HAAS, "H1", "H without G43"),
    (HAAS, "G43 Z1.", "G43 without H, and no H before it"),
    (HAAS, "/G43 H1 Z1.\nG43 Z2.", "G43 without H takes the last one, but the length here is not"),
    (FANUC, "G81 Z-1. R.1 K2 L3", "K2 and L3: one of them says how often"),
    (HAAS, "G41 X1.", "G41 or G42 without D"),
    (HAAS, "G19 G41 D1 Y1. F5.", "G41 or G42 in G19: LinuxCNC compensates in G17 and G18"),
    (HAAS, "G4", "G4 needs its time as P, once"),
    (HAAS, "G4 P-1", "P-1: a time below 0"),
    (FANUC, "G4 P1.5", "P1.5: milliseconds have no decimal point"),
    (FANUC, "G21 G90|X1. F60.", "no G0 or G1 is before these words: write G1 if they cut"),
    (FANUC, "G4 X5", "X5 has no decimal point: thousandths or seconds?"),
    (HAAS, "G30 P3 Z0", "G30 P3: LinuxCNC has two reference points"),
    (HAAS, "G91 G53 Z0", "G53 under G91"),
    (HAAS, "G81 R.1", "G81 without Z"),
    (HAAS, "G83 Z-1. R.1", "G83 needs Q"),
    (HAAS, "G81 Z-1. R.1 L0 X1.", "G81 with L0 only stores"),
    (HAAS, "G154 P100", "G154 P100: LinuxCNC has G54 to G59, and three more, G154 P1 to P3"),
    (HAAS, "G10 L2 P7 X1.", "G10 L2 P7 must be from 0 to 6"),
    (HAAS, "G54 G154 P1", "G54 and G154 in one block"),
    (HAAS, "G154", "G154 needs P and a whole number"),
    (HAAS, "G10 L5 P1 X1.", "G10 needs L2"),
    (HAAS, "M98", "M98 needs P"),
    (HAAS, "M98 P5 Q7", "M98 P with Q7: a program is called from its beginning"),
    (HAAS, "M99 P5", "M99 P5: LinuxCNC has no jumps: write IF […] before each block, or WHILE"),
    (HAAS, "G65 P5 O1", "O1 cannot be an argument"),
    (HAAS, "G65 P5 X1", "X1 has no decimal point: write X1."),
    (HAAS, "IF[1 EQ 1] WHILE[#1 LT 2]DO1", "after IF […] only #… = … and words"),
    (HAAS, "WHILE[1 EQ 1]", "WHILE […] needs DO"),
    (HAAS, "DO1", "DO1 without WHILE"),
    (HAAS, "END1", "END1 without WHILE"),
    (HAAS, "WHILE[1 EQ 1]DO1", "WHILE […] DO1 has no END1"),
    (HAAS, "#1=#[2400+#3026]", "#[2400+#5400]: write the variable by its number, or its v"),
    (HAAS, "G0 X#0", "X has no value: #0, the empty variable"),
    (HAAS, "#1=[#2 AND 3]", "AND is translated between comparisons"),
    (HAAS, "#1=1 EQ 2 EQ 3", "two comparisons in a row"),
    (HAAS, "#1=#2 MOD 3", "MOD has another sign on LinuxCNC: write a - b * FIX[a / b]"),
    (HAAS, "#1=ATAN[#2]", "ATAN needs two values, ATAN[…]/[…]: write /[1] behind it"),
    (HAAS, "IF[#1EQ2]THEN#3000=1(NO)", "#3000, an alarm: write M0 with a message, (MSG, …)"),
    (HAAS, "G92 A0.", "G92 needs S, a speed limit, or X and Z, an origin"),
    (HAAS, "D1\nG41 G1 X2. F9.\nY3.\nG41 X3.", "G41 or G42 is on here already: take it out"),
    (HAAS, "G41 D0 X1.", "G41 or G42 with D0, a radius of 0: take G41 and G42 out"),
    (HAAS, "G0 X[ROUND[#1]]", "X: ROUND in a word rounds to the least increment there"),
    (HAAS, "G0 X1. ?", "? does not start with a word"),
    (HAAS, "#1=BIN[#2]", "BIN[#2] is no number, variable or function"),
    (HAAS, "#1=[[[[[[[[[1]]]]]]]]]", "more than 8 brackets"),
    (HAAS, "#1=[1", "] is missing before the end"),
    (LATHE, "T01", "T01 is too short for tool and offset, TTOO: write both, as T0101"),
    (LATHE, "G0 X1. U1.", "U1. and X in one block"),
    (LATHE, "G96 S90 M3\nG97", "G97 without S, and the speed is not known: write S"),
    (LATHE, "G97 S90\nG96", "G96 without S, and the speed is not known: write S"),
    (LATHE, "G12.1 X5.", "G12.1 moves nothing"),
    (LATHE, "G107", "G107 needs C"),
    (LATHE, "G12.1\nG41 G1 X10. D5", "D5 in polar mode"),
    (LATHE, "G99 G97 S9 M3\nT0109\nG98 G0 X50. C0\nG12.1\nG41 G1 X10. F9.",
     "G41 or G42 in polar mode takes the loaded tool's radius, not that of offset 9"),
    (LATHE, "M3 S9\nT0101\nT0100\nG41 G1 X10. F9.", "G41 or G42, and T says no offset"),
    (LATHE, "M3 S9\nT0101\nG41 G1 X10. F9.\nT0111", "T0111 changes the radius of G41 or G42"),
    (HAAS_LATHE, "G112\nG0 X1.", "G0 in polar mode: its speed needs the units"),
    (HAAS, f"#1={'+'.join(['#2'] * 90)}", "the block has 452 characters on LinuxCNC, at most 254"),
    (HAAS, "G54:", "G54: is a label, which these controls do not have"),
    (LATHE, "$1", "$1 begins the program of one of two channels"),
    (HAAS, "M97 P100", "N100 is not in this program: M97 calls a block of it"),
    (OKUMA, "OSAMPLE", "OSAMPLE is a name: programs have numbers here, as O1"),
    (OKUMA, "G95 G1 X40. F0,2", "0,2 has a decimal comma: write a point"),
    (OKUMA, "N1 VC1=5", "VC1= sets a variable of the control's own: set it on the machine"),
    (OKUMA, "X=VC12", "VC12 is a variable of the control's own: write its value"),
    (OKUMA, "CALL OSUBX1", "CALLOSUBX1: only a program and Q"),
    (control_of("fanuc-lathe-c"), "G21", "G21 is a cycle here, the thread pass, with X and Z and "
     "no G0 or G1: where it is a mode, the control is another of fanuc-lathe, fanuc-lathe-b and"),
    (control_of("fanuc-lathe-b"), "G77\nX40. Z1.", "G77 is a cycle here, the turning pass, with X"),
    (LATHE, "G21 G99 G0 X50. Z5.\n/G90 X40. Z1. F.2\nX30.",
     "X and Z may repeat a turning cycle, but the turning cycle here is not the same"),
    (LATHE, "G21 G10.9 X0\nG90 X9. Z1. F9.", "a turning cycle where X words are radii"),
    (control_of("doosan-lathe"), "S9 M3 P13", "P13: no spindle of the machine: there are P11, P12"),
    *((HAAS, f"G0 F5.\n{block}", f"{block[-3:]}: this control's machine has the axes XYZ")
      for block in ("#1=0\nG0 A#1", "G10 L2 P1 X1. A5.")),
    *((LATHE, f"G21 G98 G0 X50. Z5.{text}", "C beside a slide at a feed: F has another")
      for text in (" C0\nG1 X40. C30. F9.", "\nG1 Z4. C30. F9.", " C0\nG1 U#100 H1. F9.")),
    (HAAS, "G91 G10 L2 P1 X1.", "G10 under G91 adds to the offset"),
    (LATHE, "G98 C0\nG12.1\nG1 X40. C1. F9.\nX39. C2. W-1.", "W-1. beside other axes in a section"),
]  # fmt: skip
ELSEWHERE = [  # control, text, the line and the beginning of its sentence
    (HAAS, "G81 Z-1. R.1 L0\nM98 P5\nG83 Z-1. R.1 Q.1 L0\nM98 P5\nM30\nO5\nX1.\nM99", 7,
     "a drilling cycle is on, but not the same one on every way"),
    (HAAS, "G81 Z-1. R.1\nM98 P5\nG83 Z-1. R.1 Q.1\nM98 P5\nM30\nO5\nX1. Z-2.\nM99", 7,
     "a drilling cycle is on, but not the same one on every way"),
    (HAAS, "/WHILE[#1LT2]DO1\nEND1", 1, "the head or the end of a loop cannot be skipped"),
    (HAAS, "M98 P5\nM30\nO5\nG0 X[#1+1.]\nZ-#3\nWHILE[#1LT2]DO1\n#3=1.\nEND1\nM99", 5, "Z-#3: n"),
    (HAAS, "/#1=5.\nG0 X#1", 2, "X#1: nothing sets #1 before, LinuxCNC takes 0"),
    (HAAS, "G65 P5 A1.\nM30\nO5\nIF[#1EQ2]THEN#2=1\nX#2\nM99", 5, "O5 reads #2 (B of"),
    (HAAS, "G65 P5 A1.\nM30\nO5\nX#30\nM99", 4, "O5 reads #30, which not every G65 P5 gives"),
    (HAAS, "M97 P9\nM98 P2\nM30\nN9 X1.\nM99\nO2\nM97 P9\nM99\nN9 X2.\nM99", 1,
     "N9 is in this file twice"),
    (HAAS, "#1=0\nWHILE[#1LT2]DO1\nG53 Z0\nG91\n#1=#1+1\nEND1", 3, "G53 is absolute, but the dist"),
    (LATHE, "T0202\nM3 S99\nG1 X1. F.1\nM99", 1, "LinuxCNC's tool change stops the spindle (say"),
    (HAAS_LATHE, "G99 S9\nG0 X2. Z.1\nG71 P1 Q2 D.05\nN1 G0 X1.\nG1 Z-1.\nN2 X2.", 3,
     "the control's setting for the retract depends on G20 or G21"),
    (LATHE, "G21 G99 G0 X50. Z2.|G71 U2. R1.\nG71 P1 Q2\nN1 G0 X9.\nG3 X19. Z-5. R5.\nN2 Z-9.", 2,
     "line 7 in the contour: G3 needs R, or I and K; a line is G1"),
    (LATHE, "G21 G0 X50. Z2.|G71 U2.\nG71 P1 Q2 U1.\nN1 G0 X20.\nG1 Z-5.\nN2 X50.\nG71 R3.\nM99", 2,
     "the retract here is not the same on every way"),
    (LATHE, "G98 G0 X60. Z2. C0\nG12.1|G41 G1 X50. F9.\nG40 Z9.\nG13.1", 3,
     "G40 is after the last move of"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("control", "text", "line", "start"),
    [
        *(
            (control, text, text.rpartition("|")[2].count("\n") + 1, start)
            for control, text, start in LAST
        ),
        *ELSEWHERE,
    ],
)
def test_what_is_refused_is_reported(control, text, line, start):
    found, sentence = refusal(control, text)
    assert (found, sentence[: len(start)]) == (line, start)


WHOLE = [  # control, a whole program, its first refused line, and how the sentence begins
    (LATHE, "T0101\nG0 X60. Z5. C0\nG12.1\nG0 X40. C10.\nG13.1\nM30", 4,
     'G0 in polar mode: write G1 with a high feed, or say rapid = "feed" in [polar]'),
    (OKUMA, "T010101\nG137 C0\nM2", 2, "G137: is X a diameter or a radius in it? say x ="),
    (FANUC, "G21 G0 X0\nM98 P1\nM30\nO1\nM98 P2\nM99\nO2\nM98 P1\nM99", 5,
     "O2 cannot be written below this call: it calls itself"),
    (HAAS, "G20 G0 X0\nM97 P100\nN100 X1.\nM99", 2, "N100 is called by M97 and also reached"),
    (HAAS, "G20 G0 X0\nM98 P100\nM30\nO100\nX1.", 5, "O100 ends here without M99"),
    (HAAS, "G20 G0 X0\nM98 P1\nM30\nO1\nM99\nO1\nM99", 2, "O1 is in this file twice"),
    (HAAS, "%\nO9000\nG0 X1.\nM99\nO1\nG20 G90 G0 X0\nM30\n%", 2,
     "which program is to run, O9000 and O1? nobody calls them"),
    (HAAS, "O1\nM98 P10\nM30\nO2\nM98 P1\nM30\nO3\nM98 P10\nM30\nO10\nM99", 1,
     "which program is to run, O2 and O3?"),
    (HAAS, "G20 G90 G0 X0\n/3 X1.\nM30", 2, "/3: LinuxCNC has one switch to skip blocks, / alone"),
    (HAAS, "%\n(COMMENT)\n%", 1, "there is no block in the file"),
    (LATHE, "G98 G0 X60. Z2. C0\nG12.1\nX30. C5.\nG13.1\nM30", 3,
     "G0 in polar mode: write G1 with a high feed, or G1 if this is a cut: no G1 is before it"),
]  # fmt: skip


@pytest.mark.parametrize(("control", "text", "line", "start"), WHOLE)
def test_a_program_that_is_refused(control, text, line, start):
    refused = translate_program(f"{text}\n", control).refused[0]
    assert (refused.line, refused.sentence[: len(start)]) == (line, start)


def test_every_refused_block_is_named_with_its_reason():
    refused = translate_program("G31\nG66\nG31\nG4\nM30\n", LATHE).refused
    assert translate.refusal_sentence(refused) == (
        "1: G31: a skip function: LinuxCNC probes with G38.2; line 3 too; line 2: G66: a modal "
        "macro: write G65 in each block; line 4: G4 needs its time as X or U or P, once"
    )


@pytest.mark.parametrize(
    ("own", "named"),
    [("G64 P.01", "G64P"), ("G33.1 Z1. K1.", "G33.1"), ("G38.2 Z0 F9.", "G38.2"),
     ("#<_a> = 5", "#<_A"), ("o<a> call", "O<a>CALL"), ("O5 SUB", "O5SUB")],
)  # fmt: skip
@pytest.mark.parametrize("other", ["G154 P1", "IF[#1EQ2]GOTO5", "N5 WHILE[#1LT2]DO1", "M97 P5"])
def test_a_mixture_of_two_languages_is_refused(own, named, other):
    line, sentence = refusal(HAAS, f"G0 X1.\n{own} (G64)\n{other}")
    name = other.partition("#")[0].removeprefix("N5 ").partition(" ")[0].partition("P")[0]
    text = f"{named.upper()} is LinuxCNC's, {name} in line 5 another control's: write the program"
    assert (line, sentence[: len(text)]) == (2, text)
    assert translate_program(f"{own}\nM2\n", HAAS).text.startswith(f"{own} (MSG, ") == (
        "CALL" not in named and "SUB" not in named
    )


@pytest.mark.parametrize("refused", ["G1 G9.9 X40. F9.", "G1 X?"])
def test_a_refused_block_sets_its_modes(refused):
    text = f"G98 G0 X60. Z2. C0\nG12.1\n{refused}\nX30. Y5.\nG13.1\nM30\n"
    result = translate_program(text, LATHE)
    assert [block.line for block in result.refused] == [3]


# ---------------------------------------------------------------- controls and machines


def test_least_increments_follow_the_units(tmp_path):
    own = tmp_path / "own.toml"
    own.write_text('based_on = "fanuc-mill"\ndecimals = "least"\naxes = "XYZA"\n')
    least = read_control(str(own))
    assert lines_after(least, "G0 X0|G21 G0 X1234 A1500")[0] == "G21 G0 X1.234 A1.500"
    assert lines_after(least, "G0 X0|G20 G0 X1234")[0] == "G20 G0 X0.1234"
    assert "depends on G20 or G21" in refusal(least, "G0 X0|G0 X1234")[1]
    own.write_text('based_on = "fanuc-mill"\ndecimals = "whole"\n')
    assert lines_after(read_control(str(own)), "G0 X0|G0 X1234")[0] == "G0 X1234"


def test_an_m_code_that_the_machine_knows_stays():
    known = frozenset(["M31", "M88", "M137"])
    assert lines_after(replace(HAAS, machine_codes=known), "M31\nM88\nM137")[:3] == [
        "M31",
        "M88",
        "M137",
    ]
    line, sentence = refusal(replace(HAAS, machine_codes=frozenset()), "M88")
    assert (line, sentence[:24]) == (1, "M88 is the machine build")


def test_the_speed_of_rapids_on_a_cylinder_is_needed():
    haas = replace(HAAS_LATHE, tables={**HAAS_LATHE.tables, "polar": {"rapid": "feed"}})
    assert refusal(haas, "G21 G0 X60. Z2.\nG7.1 C20.|G0 C1.") == (
        1,
        "G0 on a cylinder needs its speed: say rapid_feed_mm under [polar]",
    )


@pytest.mark.parametrize(
    ("codes", "text", "written"),
    [
        (
            {"cylinder_code": ("G107", "diameter")},
            "G7.1 C25.\nG7.1 C0",
            ["G107 C[2 * 25.]", "G107 C0"],
        ),
        ({"polar_codes": ("G12.3", "G13.3")}, "G112\nG113", ["G12.3", "G13.3"]),
    ],
)
def test_the_codes_of_sections_are_those_of_the_machine(codes, text, written):
    assert lines_after(replace(LATHE, **codes), text)[:2] == written


LIVE_TOOLS = [
    ("haas-lathe", "P3000 M133\nM135", ["M3 $1 S3000", "M5 $1"]),
    ("doosan-lathe", "G97 S30 M3 P12\nS40\nM5 P12\nS50 M3 P11", [
        "G97 S30 M3 $1", "S40 $1", "M5 $1", "S50 M3",
    ]),
    ("takisawa-lathe", "S30 M70\nM72\nS40", ["S30 M3 $1", "M5 $1", "S40"]),
    ("dmg-mori-lathe", "S30 M13\nM5\nS40", ["S30 M3 $1", "M5 $-1", "S40"]),
    ("mazak-integrex", "S30 M3\nM5\nS40 M203", ["S30 M3 $1", "M5 $1", "S40 M3"]),
]  # fmt: skip
TWO = "[TRAJ]\nSPINDLES = 2\nLINEAR_UNITS = mm\nCOORDINATES = XZC\n"


@pytest.fixture
def machine_of(tmp_path):
    """Return a function: a control on the machine of an INI's text."""

    def with_ini(name, text):
        (tmp_path / "m.ini").write_text(text)
        return on_machine(control_of(name), read_ini(tmp_path / "m.ini"))

    return with_ini


@pytest.mark.parametrize(
    ("name", "ini", "axes"),
    [
        ("haas-mill", "mill_mm", "XYZ"), ("fanuc-lathe", "lathe_mm", "XZC"),
        ("fanuc-lathe", "lathe_mm_kinematics", "XZC"),  # whose Y is the face's
        ("mazak-integrex", "mill_mm", "XYZ"), ("mill-on-face", "lathe_mm", "XYZC"),
        ("mill-round-part", "lathe_mm", "XYZC"), ("mill-round-part", "mill_a_mm", "XYZA"),
    ],
)  # fmt: skip
def test_the_axes_are_those_of_the_machine(name, ini, axes):
    assert on_machine(control_of(name), read_ini(SIM / f"{ini}.ini")).axes == axes


@pytest.mark.parametrize(("name", "text", "expected"), LIVE_TOOLS)
def test_the_live_tool_is_a_spindle_of_the_machine(machine_of, name, text, expected):
    second = machine_of(name, f"{TWO}[G12]\nLIVE_SPINDLE = 1\n")
    assert lines_after(second, text)[:-1] == expected
    first = machine_of(name, f"{TWO}[G12]\nLIVE_SPINDLE = 0\n")
    assert lines_after(first, text)[:-1] == [re.sub(r" \$\S+", "", line) for line in expected]
    assert "say [G12] LIVE_SPINDLE" in refusal(machine_of(name, TWO), text)[1]


@pytest.mark.parametrize(
    ("name", "clamp"),
    [("colchester-lathe", "M89 M90"), ("dmg-mori-lathe", "M68 M69"), ("mazak-lathe", "M210 M212")],
)
def test_a_hole_is_drilled_with_c_clamped_by_its_builders_codes(name, clamp):
    close, release = clamp.split()
    head = "G21 G97 S500 M3\nG0 X60. Z10. C0"
    written = lines_after(control_of(name), f"{head}|G83 X40. Z-5. F50. {close}\nG80")
    assert [line.split()[0] for line in written if line[:1] == "M"] == [close, release, "M30"]


@pytest.mark.parametrize(
    ("ini", "expected"),
    [
        ("", ["(M35)", "(M89)", "(M90)", "(M34)"]),
        (
            "[G12]\nC_CLAMP = M10 M11\n[RS274NGC]\n"
            "REMAP = M0254 modalgroup=10 prolog=spindle_c_off ngc=spindle_c_off\n"
            "REMAP = M254 modalgroup=10 prolog=spindle_c_on ngc=spindle_c_on\n"
            "REMAP = M255 modalgroup=10 prolog=spindle_c_off ngc=spindle_c_off\n",
            ["M254", "M10", "M11", "M255"],
        ),
    ],
)
def test_clamp_and_c_are_the_machines_own(machine_of, ini, expected):
    control = machine_of("doosan-lathe", TWO + ini)
    assert lines_after(control, "M35\nM89\nM90\nM34")[:-1] == expected
    codes = frozenset(code for code in expected if code[0] == "M")
    if codes:
        known = replace(control, machine_codes=codes)
        assert refusal(known, "M35 M89") == (
            1,
            "M35 and M89 in one block: give one a block of its own",
        )


def test_a_position_of_g28_that_was_never_set_is_reported(machine_of, tmp_path):
    ini = "[RS274NGC]\nPARAMETER_FILE = m.var\n[TRAJ]\nLINEAR_UNITS=mm\n"
    for value, note in (
        ("0.0", " (G28.1 was never set on this machine: machine zero)"),
        ("-1.5", ""),
    ):
        (tmp_path / "m.var").write_text(f"5161\t0.0\n5163\t{value}\n5181 0\n")
        control = machine_of("haas-mill", ini)
        assert lines_after(control, "G91 G28 Z0")[0] == f"G91 G28 Z0 G49{note}"


# ---------------------------------------------------------------- the order of programs


def test_programs_are_not_compared_each_with_each():
    def planned(count):
        subs = "".join(f"O{n}\nM98 P{n - 1}\nM99\n" for n in range(2, count))
        text = f"G20 G0 X0\nM98 P{count - 1}\nM30\nO1\nM99\n{subs}"
        return lambda: lines(HAAS, text)

    assert planned(750)()[4] == "O749 (line 2247)"
    assert growth(planned, 150) < 10


# ---------------------------------------------------------------- the page


def examples():
    """Return the programs before and after of the page."""
    text = PAGE.read_text(encoding="utf-8")
    blocks = re.findall(r"^(?:before|after).*:\n\n((?: {4}.*\n)+)", text, re.MULTILINE)
    texts = [re.sub("^ {4}", "", block, flags=re.MULTILINE) for block in blocks]
    return list(zip([HAAS, LATHE], texts[::2], texts[1::2]))


@pytest.mark.parametrize("number", [0, 1])
def test_the_page_shows_what_is_printed(number):
    control, before, after = examples()[number]
    assert translate_program(before, control).text == after


def test_the_pages_own_control_is_one(tmp_path):
    text = re.search(r"((?: {4}.*\n|\n)*? {4}# my_lathe.toml\n(?: {4}.*\n|\n)+)", PAGE.read_text())[
        1
    ]
    (tmp_path / "my_lathe.toml").write_text(re.sub("^ {4}", "", text, flags=re.MULTILINE))
    own = read_control(str(tmp_path / "my_lathe.toml"))
    assert (own.decimals, own.meanings["M51"]) == ("whole", "M64 P0")


REFUSED_OFTEN = [
    (FANUC, "G21 G90|G0 X1", "X1 has no decimal point"),
    (FANUC, "M137", "M137 is not known of "),
    (replace(FANUC, machine_codes=frozenset()), "M88", "M88 is the machine builder's"),
    (FANUC, "M98 P9810", "O9810 is not in this file"),
    (FANUC, "G0 A90.", "A90.: "),
    (LATHE, "T30303", "T30303 has 5 digits"),
    (LATHE, "G90\nX40. Z1.", "G90 is a cycle here"),
    (LATHE, "G95\nG90 X9. Z1.", "G95: feed per revolution"),
    (LATHE, "T0101|G90 X9. Z1. F.1", "this begins at the tool's position"),
    (FANUC, "#1=#4001", "#4001 means something else"),
    (FANUC, "GOTO10", "GOTO10 is a jump"),
    (HAAS, "G70 I1. J15. L6", "G70: holes on a circle"),
    (FANUC, "G31 Z1.", "G31: a skip function"),
    (LATHE, "G68", "G68: mirror image"),
]


@pytest.mark.parametrize(("control", "text", "sentence"), REFUSED_OFTEN)
def test_the_page_has_the_commonest_refusals(control, text, sentence):
    assert refusal(control, text)[1].startswith(sentence)
    table = PAGE.read_text(encoding="utf-8").partition("refused most often")[2].partition("##")[0]
    assert sentence in table


CURES = [  # a control of one's own: what it is based on and says; a program of it
    ("fanuc-mill", 'decimals = "whole"', "G21 G90|G0 X1"),
    ("fanuc-mill", '[m_codes]\nM137 = "comment"\nM88 = "M7"', "M137\nM88"),
    ("fanuc-mill", 'axes = "XYZA"', "G0 A90."),
    ("fanuc-mill", '[variables]\n4001 = "#500"', "#1=#4001"),
    ("fanuc-mill", "", "M98 P9810\nM30\nO9810\nM99"),
    ("fanuc-mill", "", "#1=0\nWHILE[#1LT2]DO1\nIF[#1EQ1]G0 X1.\n#1=#1+1\nEND1"),
    (
        "haas-mill",
        "",
        "G81 Z-1. R.1 F9. L0\n#1=0\nWHILE[#1LT6]DO1\n"
        "X[50.+30.*COS[60.*#1]] Y[40.+30.*SIN[60.*#1]]\n#1=#1+1\nEND1\nG80",
    ),
    ("fanuc-lathe", '[tools]\npatterns = ["TTTOO"]', "T30303"),
    ("fanuc-lathe-b", "", "G90\nG0 X40. Z1.\nG95\nG77 X9. Z1. F.1"),
    ("fanuc-lathe", "", "T0101|G0 X50. Z5.\nG90 X9. Z1. F.1"),
]


@pytest.mark.parametrize(("base", "says", "text"), CURES)
def test_the_pages_cures_of_refusals_are_true(tmp_path, base, says, text):
    own = tmp_path / "own.toml"
    own.write_text(f'based_on = "{base}"\n{says}\n')
    assert lines_after(read_control(str(own)), text)


# ---------------------------------------------------------------- hostile text

PARTS = """
G0 G1 G2 G28 G53 G91 G90 G81 G80 G10 L2 L10 G154 G65 M98 M97 M99 M30 P1 P100 O1 O100 N100
X1. Y-1 Z.5 U1. W-2. H0 T0101 G12.1 G13.1 G112 G50 S100 G96 #1=2 #100=[1+2] WHILE[#1LT2]DO1
G70 G71 G73 G76 G90 G92 G94 G32 P1 Q2 N1 N2 D.5 M24 G72 I1. J0. L3 ,C1. ,R2. ,A30. X0 M99
END1 IF[#1EQ1]THEN#2=3 GOTO5 K0 L0 R Q.1 D1 G41 G40 ( ) [ ] % ; / # = é
"""
WORDS = st.sampled_from([*PARTS.split(), *"\n\n\n\n\0\t "])


@hypothesis_settings(max_examples=300)
@given(
    st.lists(WORDS | st.characters(), max_size=60),
    st.sampled_from([HAAS, FANUC, LATHE, HAAS_LATHE]),
)
def test_any_text_is_translated_or_refused(words, control):
    result = translate_program("".join(words), control)
    assert bool(result.text) != bool(result.refused)
    for line in result.text.splitlines():
        assert len(line.encode()) <= 254


@pytest.mark.parametrize(
    ("start", "part", "end"),
    [
        ("", "(", ""), ("", ")", ""), ("", "[", ""), ("", "#", ""), ("#1=", "[", ""), ("", "X", ""),
        ("", "G0 ", ""), ("#1=", "1+", "1"), ("#1=", "-", "1"), ("", "1", ""), ("X", "1", ""),
        ("G", "9", ""), ("", ";", ""), ("M98 P", "1", ""), ("O", "1", ""), ("#", "1", "=1"),
        ("(", "é", ")"), ("", "N1 G02 X1.5 Y1.25 R10. F1. (ARC);\nG01X1.3Z-.5\n", "X1."),
    ],
)  # fmt: skip
def test_hostile_and_long_texts_take_not_the_square_of_their_length(start, part, end):
    def planned(count):
        text, _ = program(HAAS, f"{start}{part * count}{end}")
        return lambda: translate_program(text, HAAS)

    assert growth(planned, 8000 // len(part)) < 10
