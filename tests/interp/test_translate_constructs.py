# SPDX-License-Identifier: GPL-2.0-or-later
"""Each construct of other controls, alone: the motion it makes and the modes it leaves.

The blocks on the left are a foreign program's, those on the right say the same in LinuxCNC's words.
Behind both stands a bare word, so that the motion and distance modes show, and no end.
"""

import pytest

from g12.tools.translate.program import translate_program
from support.foreign_programs import assert_same_part, control_of, kept_tracers

MILL = "G20 G17 G90 G94 G98 G54 G0 X1. Y1. Z1. S100 F9.\n"
TURN = "G21 G18 G54 G0 X50. Z5. C0 F.2 S100 M3\n"
HEADS = {"mill": (MILL, MILL), "lathe": (TURN, f"G7 G90 G95\n{TURN}")}  # foreign, LinuxCNC's
TAILS = {"mill": "X3. Y2.\n", "lathe": "X40. Z2.\n"}

CONSTRUCTS = [
    # G53, G28, G30: rapid moves, whatever mode they stand in; the mode stays
    ("haas-mill", "G1 X2.\nG53 Z0", "G1 X2\nG53 G0 Z0\nG1"),
    ("haas-mill", "G1 X2.\nG0 G53 Z0", "G1 X2\nG53 G0 Z0"),
    ("haas-mill", "G1 X2.\nG28", "G1 X2\nG53 G0 X0 Y0 Z0\nG1"),
    ("haas-mill", "G1 X2.\nG91 G28 Z0\nG90", "G1 X2\nG53 G0 Z0\nG1"),
    ("haas-mill", "G1 X2.\nG0 G28 Z.5", "G1 X2\nG0 Z.5\nG53 Z0"),
    ("fanuc-mill", "G1 X2.\nG30 P2 Z.5", "G1 X2\nG0 Z.5\nG53 Z0\nG1"),
    ("haas-mill", "T2 M6\nG43 H2 Z2.\nG28 Z3.", "T2 M6\nG43 H2 Z2\nZ3\nG53 Z0\nG49"),
    ("fanuc-mill", "T2 M6\nG43 H2 Z2.\nG91 G28 Z0\nG90", "T2 M6\nG43 H2 Z2\nG53 G0 Z0"),
    # G80 beside a motion, and alone
    ("haas-mill", "G80 G1 X2.", "G1 X2"),
    ("haas-mill", "G1 X2.\nG80\nX2.5", "G1 X2\nX2.5"),
    ("haas-mill", "G81 X2. Z.5 R.9\nG80 X2.5", "G81 X2 Z.5 R.9\nG80\nG0 X2.5"),
    ("haas-mill", "G1 X1.5\nG82 X2. Z.5 R.9 P100\nG80", "G1 X1.5\nG82 X2 Z.5 R.9 P.1\nG80\nG1"),
    # what a condition rules: words, an assignment and words, nothing, a return
    ("haas-mill", "#1=1.\nIF[#1EQ1]G1 X2. F5.\nIF[#1EQ2]THEN G0 Y2.\nIF[#1EQ1]", "G1 X2 F5"),
    ("haas-mill", "#1=1.\nIF[#1EQ1]THEN#2=3. Y#2\nIF[#1EQ2]THEN#2=4. Y#2\nX#2", "Y3\nX3"),
    ("haas-mill", "#100=0.\nM98 P5\nM98 P5\nM30\nO5\n#100=#100+1.\nIF[#100EQ2]M99\nX3.\nM99",
     "X3"),
    ("haas-mill", "G65 P5 A2.\nG65 P5 A3.\nM30\nO5\nIF[#1EQ2]M99\nX#1\nM99", "X3"),
    # drilling cycles
    ("haas-mill", "G81 Z.5 R.9 L0\nX2.\nG80", "G81 X2 Z.5 R.9\nG80\nG0"),
    ("haas-mill", "G81 Z.5 R.9 L0\n#1=0\nWHILE[#1LT3]DO1\nX[2.+.5*COS[120.*#1]] "
     "Y[.5*SIN[120.*#1]]\n#1=#1+1\nEND1\nG80",
     "G81 X2.5 Y0 Z.5 R.9\nX1.75 Y.4330127\nY-.4330127\nG80\nG0"),
    ("haas-mill", "G81 X2. Z.5\nG80", "G81 X2 Z.5 R1\nG80\nG0"),
    ("haas-mill", "G91 G81 X.5 Z-.4 L2\nG80 G90", "G91 G81 X.5 Z-.4 R0 L2\nG80\nG90 G0"),
    ("haas-mill", "G83 X2. Z.5 R.9 Q.2\nG81 X3.\nG80",
     "G83 X2 Z.5 R.9 Q.2\nG81 X3 Z.5 R.9\nG80\nG0"),
    ("fanuc-mill", "G81 X2. Z.5 R.9\nG91 X.5 K2\nG80 G90",
     "G81 X2 Z.5 R.9\nX2.5\nX3\nG80\nG0"),
    ("fanuc-mill", "G81 X2. Z.5 R.9\nG91 X.5 K2 M98 P5\nG80 G90\nM30\nO5\nY1.\nM99",
     "G81 X2 Z.5 R.9\nX2.5\nX3\nY2\nG80\nG0"),
    ("fanuc-mill", "G91 G81 X1. Z-.4 R-.1\nG90 X3. Y2.\nY[3.]\nX1.\nG80",
     "G81 X2 Z.5 R.9\nX3 Y2\nY3\nX1\nG80\nG0"),
    ("fanuc-mill", "G91 G99 G81 X1. Z-.4 R-.1\nG90 X3.\nG91 Y1.\nG80 G90",
     "G99 G81 X2 Z.5 R.9\nX3\nY2\nG80\nG0"),
    ("fanuc-mill", "G83 X2. Z.5 R.9 Q2000\nG80", "G83 X2 Z.5 R.9 Q.2\nG80\nG0"),
    *((control, f"G81 Z.5 R.9 {none}0\nX2.\nG91 X.5 {none}2\nG80 G90",
       "G81 X2 Z.5 R.9\nX2.5\nX3\nG80\nG0")
      for control in ("fanuc-mill", "mitsubishi-mill") for none in "KL"),
    ("haas-mill", "#1=2.\nWHILE[#1LT4]DO1\nG81 X#1 Z.5 R.9\n#1=#1+1.\nEND1\nG80",
     "G81 X2 Z.5 R.9\nX3\nG80\nG0"),
    # holes that two cycles share
    ("haas-mill", "G81 X1.5 Z.5 R.9\nM98 P5\nG83 X1.5 Z.6 R.9 Q.2\nM98 P5\nM30\nO5\n"
     "X2.\nX3.\nG80\nM99",
     "G81 X1.5 Z.5 R.9\nX2\nX3\nG80\nG0\nG83 X1.5 Z.6 R.9 Q.2\nX2\nX3\nG80\nG0"),
    # G41 before the first move in the plane: it waits for that
    ("haas-mill", "T1 M6\nG0 Y1.5\nG41 D1\nG0 Z.5\nG1 X2.\nY3.\nG40 X4.",
     "T1 M6\nG0 Y1.5\nZ.5\nG41 D1 G1 X2\nY3\nG40 X4"),
    ("fanuc-mill", "T1 M6\nG1 G42 D1 Z.5\nZ.4\nX2.\nY3.\nG40 X4.",
     "T1 M6\nG1 Z.5\nZ.4\nG42 D1 X2\nY3\nG40 X4"),
    ("haas-mill", "T1 M6\nG0 X1. Y1.\nG1 G41 D1 X1. Y1.\nX2.\nY3.\nG40 X4.",
     "T1 M6\nG0 X1 Y1\nG41 D1 G1 X2\nY3\nG40 X4"),
    ("haas-mill", "T1 M6\nG41 D1\nG1 Z.5\nM98 P5\nG40 X4.\nM30\nO5\nX2.\nY3.\nM99",
     "T1 M6\nG1 Z.5\nG41 D1 X2\nY3\nG40 X4"),
    ("haas-mill", "T1 M6\nG41 D1\nG1 Z.5\nG40 Z.4\nX2.", "T1 M6\nG1 Z.5\nZ.4\nX2"),
    # what needs nothing done, with the words that are its own
    ("fanuc-lathe", "G22 X90. Z90. I-9. K-9.\nG26\nG1 X45.", "G1 X45"),
    # cutter compensation and lengths
    ("haas-mill", "T2 M6\nD2\nG41 G1 X2.\nY3.\nG40 X4.",
     "T2 M6\nG41 D2 G1 X2\nY3\nG40 X4"),
    ("haas-mill", "T1 M6\nG43 H2 Z2.\nG43 H0", "T1 M6\nG43 H2 Z2\nG49"),
    ("haas-mill", "T1 M6\nG43 H2 Z2.\nG43 Z1.5", "T1 M6\nG43 H2 Z2\nG43 H2 Z1.5"),
    # dwell, offsets
    ("haas-mill", "G4 P250\nG4 P1.5", "G4 P.25\nG4 P1.5"),
    ("haas-mill", "G10 L2 P0 X.5\nX1.\nG10 L2 P0 X0", "G52 X.5\nX1\nG52 X0"),
    ("haas-mill", "G10 L20 P3 X.5 Y0 Z0\nG112 X1. Y1.\nG54", "X1.5 Y1"),
    ("haas-mill", "G10 L20 P2 X.5 Y0\nG10 L2 P1 X1. G90\nG154 P2 X1. Y1.\nG54 X1.\nG10 L2 P1 X0",
     "X1.5 Y1\nX2\nG10 L2 P1 X0"),
    # subprograms, macros
    ("haas-mill", "G65 P5 X2. Z.5\nX2.\nM30\nO5\nG1 X#24 Z#26\nM99", "G1 X2 Z.5\nX2"),
    # the last D is a pocket's, wherever it stood; a T is no tool before its M6
    ("haas-mill", "T2 M6\nG43 H2 D1 Z.5\nG12 I1. F9.\nD0\nG13 I1.", "T2 M6\nG43 H2 Z.5\n"
     "G12 I1 D1 F9\nG13 I1 D0"),
    ("fanuc-mill", "M98 P30012\nM98 P12 L2\nM30\nO0012\nG91 G1 X.5\nG90 M99",
     "G1 X1.5\nX2\nX2.5\nX3\nX3.5"),
    ("fanuc-mill", "M98 Q5 L2\nG90\nM98 Q6\nM30\nN5 G91 G1 X.5\nM99\nN6 G0 Y3.\nM99",
     "G91 G1 X.5\nX.5\nG90\nG0 Y3"),
    ("haas-mill", "T2 M6\nM3 S100\nG1 X2. M9\nX3. M5", "T2 M6\nM3 S100\nG1 X2\nM9\nX3\nM5"),
    ("haas-mill", "G9 G1 X2.\nG0 X3.", "G1 X2\nG4 P0\nG0 X3"),
    # a lathe's words
    ("fanuc-lathe", "G98 G1 X45. F100.\nG99 F.3", "G94 G1 X45 F100\nG95 F.3"),
    ("fanuc-lathe", "G1 U-5.\nW-2.\nX40. W-1.\nU2. Z0", "G1 X45\nZ3\nX40 Z2\nX42 Z0"),
    ("fanuc-lathe", "G3 U10. W-5. R5.\nG1", "G3 X60 Z0 R5\nG1"),
    ("fanuc-lathe", "G1 G93 X45. C20. F2.\nG98 F9.", "G1 G93 X45 C20 F2\nG94 F9"),
    ("okuma-lathe", "CALL O12 Q2\nM30\nO12\nG1 X41.\nX40.\nRTS", "G1 X41\nX40\nX41\nX40"),
    ("okuma-lathe", "G94 G0 C5.\nG1 F100. Z5. C20.", "G94 G0 C5\nG1 F100 C20"),
    ("fanuc-lathe", "G1 X45.\nG28 U0 W0", "G1 X45\nG53 G0 X0 Z0\nG1"),
    ("fanuc-lathe", "G1 X45.\nG30 U2. W1.", "G1 X45\nG0 X47 Z6\nG53 X0 Z0\nG1"),
    ("fanuc-lathe", "T0101\nT0100", "T1 M6 M3\nG49"),
    # T0102: tool 1 with the length and the radius of offset 2, in cycles as well
    ("fanuc-lathe", "T0102\nG0 X80. Z20.\nG1 G42 X40. Z10.\nZ-20.\nG40 X80.",
     "T1 M6 G43 H2 M3\nG0 X80 Z20\nG1 G42 D2 X40 Z10\nZ-20\nG40 X80"),
    ("fanuc-lathe", "T0102\nG0 X80. Z20.\nG70 P1 Q2\nN1 G0 G42 X40. Z10.\nN2 G1 Z-20.\nG0 X90.",
     "T1 M6 G43 H2 M3\nG0 X80 Z20\nG42 D2 X40 Z10\nG1 Z-20\nG40 G0 X80\nZ20\nX90"),
    ("fanuc-lathe", "T0102\nG0 X100. Z20.\nG1 G42 X80.\nG71 U20. R1.\nG71 P1 Q2\nN1 G0 X40.\n"
     "N2 G1 Z-20.\nG1 X60. Z10.\nZ-20.\nG40 X80.",
     "T1 M6 G43 H2 M3\nG0 X100 Z20\nG1 G42 D2 X80\nG40\nG0 X40\nG1 Z-20\nG0 X80\nZ20\n"
     "G42 D2\nG1 X60 Z10\nZ-20\nG40 X80"),
    ("fanuc-lathe", "G50 S900\nG96 S100 M3\nX45.\nG97 S50 M5\nX46.",
     "(G50)\nG96 D900 S100 M3\nX45\nG97 S50 M5\nX46"),
    ("fanuc-lathe", "G50 X10. Z0\nX20.\nG50 X60. Z5.", "G0 X60\nG92 X60 Z5"),
    ("fanuc-lathe", "G4 X.5\nG4 U1.\nG4 P100", "G4 P.5\nG4 P1\nG4 P.1"),
    ("okuma-lathe", "G4 F.5\nG91 G1 X-5.\nG90 G94 F50.", "G4 P.5\nG1 X45\nG94 F50"),
]  # fmt: skip


def translated_part(control, blocks):
    """Return the translation of blocks without what the control holds at the start, and no end."""
    kind = control_of(control).machine
    (head, _), tail = HEADS[kind], TAILS[kind]
    main, _, subs = blocks.partition("\nM30\n")
    text = f"(HEAD)\n{head}{main}\n{tail}"
    result = translate_program(f"{text}M30\n{subs}\n" if subs else text, control_of(control))
    assert result.refused == []
    start, *lines = result.text.splitlines()
    return [start, *(line for line in lines if not (line.startswith("M2 (") and not subs))]


tracers = kept_tracers()


@pytest.mark.parametrize(("control", "foreign", "own"), CONSTRUCTS)
def test_a_construct_moves_the_same_and_leaves_the_same_modes(tracers, control, foreign, own):
    tracer = tracers(control)
    traced = tracer.trace_text(translated_part(control, foreign), alone=True)
    kind = control_of(control).machine
    (_, head), tail = HEADS[kind], TAILS[kind]
    end = "M30\n" if "\nM30\n" in foreign else ""
    expected = tracer.trace_text(f"{head}{own}\n{tail}{end}", alone=True)
    assert_same_part(traced, expected)
    assert traced.modes.gcodes == expected.modes.gcodes
    assert traced.modes.feed == pytest.approx(expected.modes.feed)
