# SPDX-License-Identifier: GPL-2.0-or-later
"""What verify reports of a program: the codes of its findings and notes, and their lines.

A row is a beginning, the blocks after it, the codes, and the stock if it is given.
"""

import math

import numpy as np
import pytest

from g12.tools.commands.main import main
from g12.tools.plot.scene import scene_of_proof
from g12.tools.units import MM
from g12.tools.verify.report import as_text
from support.clamped import with_clamp
from support.judged_programs import prove_lines
from support.made_moves import samples_of
from support.sim_machines import SIM

BEGINNINGS = {  # the machine, and the blocks before a row's
    "mill": ("mill_mm", "G21 G17 G40 G49 G90 G94 F600|T4 M6|G43 H4|S900 M3|G0 X0 Y0 Z1"),
    "lathe": ("lathe_mm", "G21 G18 G7 G40 G90 G94|T1 M6|S900 M3|G0 X60 Z2 C0"),
    "radii": ("lathe_mm", "G21 G18 G8 G40 G90 G94|T3 M6|S900 M3|G0 X18 Z2 C0"),
    "two spindles": ("lathe_spindle_c_mm", "G21 G18 G7 G40 G90 G94|T1 M6|M254|G0 X60 Z2 C0"),
    "inch": ("mill_inch", "G20 G17 G40 G49 G90 G94 G64 P.001|T1 M6 G43|S3000 M3|G0 X0 Y0 Z.1"),
    "yasnac": ("mill_yasnac_mm", "G21 G17 G40 G49 G90 G94|T10 M6 G43|S3000 M3|G0 X0 Y0 Z2"),
    "helix": ("mill_helix_mm", "G21 G17 G40 G49 G90 G94 F600|T4 M6 G43|S3000 M3|G0 X0 Y0 Z1"),
    "mitsubishi": ("mill_mitsubishi_mm", "G21 G17 G40 G49 G90 G94 F600|T10 M6 G43|S3000 M3"),
    "face": ("lathe_mm_kinematics", "G21 G18 G7 G40 G90 G94 G64 P.01|T1 M6|S900 M3|G0 X120 Z5 C0"),
    "any mill": ("mill_mm", "G21 G17 G40 G49 G90 G94 F600"),
    "any lathe": ("lathe_mm", "G21 G18 G7 G40 G90 G94 F600"),
}
BEGIN, END = "G12.1|G1 C25 F2000|G41 X27 F1000|Z-5", "G40 X60 F2000|G13.1|G0 Z2"
FLAT = f"{BEGIN}|C-25|{END}"
SLOT = "G12.1|G1 Z-1 F800|X-18|X18|Z2|G13.1"
SIDES = "C-7.7942|X0 C-15.5885|X-27 C-7.7942|C7.7942|X0 C15.5885|X27 C7.7942"
HEXAGON = f"G0 X70|G12.1|G1 G41 X27 F1000|Z-5|{SIDES}|C0|G40 X70|Z2|G13.1"
SOCKET = "G0 X2|G12.1|G1 Z-3 F300|G41 X10|C10|X-10|C-10|X10|C0|G40 X2|G13.1"
LOW, HIGH = "G13 I9 Z-2 D4", "G13 I9 Z-3 D4|G0 Z1"
RING, CLEARED, SHALLOW = "G13 I20.2 Z-4 D4", "G13 I7 K20 Q6 Z-4 D4", "G13 I7 K20 Q6 Z-2 D4"
FACE_HOLE = "o<face_hole_at> call [20] [0] [8] [2] [120] [0] [0] [0]"
SIDE_HOLE = "o<side_holes> call [1] [-30] [0] [-9999] [60] [8] [2] [120] [0] [0] [0]"
TAP, SIDE_TAP = (
    hole.replace("[120]", "[1.5]").removesuffix("[0]") + "[1]" for hole in (FACE_HOLE, SIDE_HOLE)
)
HOLES = "o<side_holes> call [4] [-15] [0] [90] [30] [6] [2] [100] [0] [.1] [0]"
POCKET = "G13 I.2 K.45 Q.2 Z-.3 D1 F20"
GROOVE = "G0 Z-20|G7.1 C25|G1 X48 F200|G1 Z-40 C60 F250"
P = "G13 I7 K20 Q6 Z-3 D4"
NARROW = FLAT.replace("C25", "C6")
TURNED_BACK = FLAT.replace("G40 X60", "G40 X60 C0")
OTHER_FLAT = "X-80|G41 X-27 C-25|Z-5|C25|G40 X-80 C0|Z2|G13.1"
FLANK = "G0 X44 Z-20|G7.1 C20|G1 X36 F500|C90"
AROUND = "o<side_holes> call [3] [-10] [20] [-9999] [40] [8] [2] [120] [-3] [0] [0]"
ON_FACE = "o<face_holes> call [3] [30] [20] [-9999] [8] [2] [120] [3] [.5] [0]"
ELSEWHERE = "T3 M6|S900 M3|G10 L2 P1 X90|G0 X60 Z2"
POLYGON = "o<polar_polygon> call [6] [24] [4] [30] [0] [2] [.3] [600] [300] [0]"
FLATS = "o<polar_polygon> call [2] [24] [4] [30] [0] [2] [0] [600] [300] [30]"
ROUND = "o<polar_pocket> call [24] [0] [{}] [3] [1.5] [0] [600] [200]"
EVENT = "G13.2 Y0 I2 R20 K5 D2 H2"
R38 = "G1 Z-5 F100|G12 I40 R38 D10 F300|G0 Z2"
AIR = "T4 M6 G43|S900 M3|G0 X0 Y0 Z30"
LONGEST, LONGEST_CALL = (  # as long as LinuxCNC reads a line
    begin + "+0" * ((251 - len(begin)) // 2) + "]"
    for begin in ("G12 Z-2 I[9", "o<polar_slot> call [24][40][3][1.5][.3][600][200][30")
)
HOLE = "o<hole> sub|G0 Z1|G12 I#1 Z#2 D4|G0 Z1|o<hole> endsub|T4 M6 G43|S900 M3"
CALLED = "G0 X40|{0}|G0 X40 C0|G12.1|G1 X30 F800|Z-1|{0}|C8|Z2|G13.1|{0}|M2|{1}|G1 X24 F900|C3|{2}"
SQUARE_AND_PIN = (  # in one section, the pin at a place beside the square
    "T1 M6|S900 M3|G0 X80 Z2 C0|G12.1|G1 X80 F300|G41 X20|Z-1|C-10|X-20|C10|X20|C0|G40 X80|"
    "G41 X{0}|G2 X{0} C0 I-4 J0|G1 G40 X80|Z2|G13.1"
)
TRIANGLE = (
    "G12.1|G1 X3.07783 C-11.27755|G41 X2.32495 C-7.17287|Z-3.6|X-13.93686 C-10.15559|"
    "X-0.52437 C22.3497|X18.58676 C-4.19015|X2.32495 C-7.17287|G40 X3.07783 C-11.27755|G13.1|G0 X60"
)
ROUND_A_FLAT = "G0 X30 Z2 C0|G12.1|G1 X20 C3 F900|G42 X14 C0 F600|Z-1 F200|C10 F600|X-10|C-10|X14|"
ROUND_A_FLAT += "C0|G40 X20 C-3|Z2|G13.1"

CASES = [
    # other ways to write a pocket
    ("mill", "#2=0|o100 while [#2 LT 3]|G0 Z1|X[#2 * 60] Y[0 - #2]|#2 = [#2 + 1]|"
     "N5 G12 I[8 + #2] Z-[1 + 1] D4 (X99 Y99)|o100 endwhile", ""),
    ("any mill", f"{HOLE}|o<hole> call [9] [-2]|G0 X40|o<hole> call [8] [-3]", ""),
    ("mill", "G12 I7 K20 Q6 Z-2 D4 M2", ""),
    ("mill", "G[10 + 2] I7 K20 Q6 Z-2 D4", ""),
    ("mill", "#5=12|G#5 I7 K20 Q6 Z-2 D4", ""),
    ("mill", LONGEST, ""),
    ("mill", f"{P}|G91 G13 I20.5 L3 D4|G90 G0 Z1", ""),  # where the tool stands
    ("mill", "G20 G0 Z.1|G12 I.3 K.8 Q.2 Z-.1 L3 D4 F20", ""),  # it does not move down again
    ("mill", "G20 G0 Z.1|G21 G13 I8 K40 Q5 Z-12 D4 F500", "feed-cut-down 7"),
    ("mill", "G64 P.02|G0 Z3|G20 G13 I.3 K1. Q.3 Z-.5 D4 F20", ""),
    ("mill", "G64 P.02|G0 Z3|G20 G13.2 X0 Y0 Z-.2 I.1 R1. D1 H1 F20", ""),
    ("mill", "G0 X10 Y10 Z5|G91|o<circle_mill> call [7] [50] [7] [-6] [2] [10] [40] [2] [2] [3] "
     "[-9999] [.3] [150] [800] [400]", ""),
    ("mill", f"G92 X4 Y5 Z1|G0 X10 Y20 Z1|G90.1|{P}", "offset-left 6"),
    # X words are diameters under G7
    ("mill", f"G7|G0 X60|{P} X60|G0 Z1|G91|{P} X96 G8|G90|G0 Z1", ""),
    ("mill", f"{P} X20 G7|G0 Z1|{P} X140|G0 Z1", ""),
    ("mill", f"G7|{EVENT} Z-5 X60|o<circle_mill> call [7] [90] [0] [-5] [2] [-9999] [20] [0] [2] "
     "[5] [-9999] [-9999] [150] [800] [-9999]", ""),
    # a hole that the program has drilled is not assumed; nor is the next pocket's
    ("mill", f"G1 Z-5|G0 Z1|Z-2.5|{P}|G0 Z1", ""),
    ("mill", f"G83 X0 Z-5 R1 Q2|X40|G80|G0 X0 Y0|Z-2.5|{P}|G0 Z1|X80|Z-2.5|{P}|G0 Z1",
     "rapid-into 14"),
    ("any mill", f"T3 M6 G43|S900 M3|G0 X0 Y0 Z5|G1 Z-5|G0 Z50|T4 M6 G43|S900 M3|G0 Z1|Z-2.5|{P}",
     "bored-assumed 10"),  # of a smaller tool
    # what G71 makes has no line of its own
    ("lathe", f"{FLAT}|G0 X80 Z5|T2 M6|o7 sub|G0 X50|G1 Z-9 X60|o7 endsub|"
     "G71 Q7 X64 Z2 D.3 I2 R.5|G0 Z5", "rapid-idle-tool 19"),
    # where C is
    ("lathe", f"{FLAT}|{FLAT}", "zero-line-turned 13"),
    ("lathe", f"{FLAT}|G0 X60 Z5 (C0)|{FLAT}", "zero-line-turned 14"),
    ("lathe", f"{FLAT}|G0 C0|{FLAT}", ""),
    ("lathe", f"{FLAT}|G0 C180|{FLAT}", ""),
    ("lathe", f"{FLAT}|G0 C-39.805571|{FLAT}", ""),
    ("lathe", f"{FLAT}|G91 G0 C180|G90|{FLAT}", "zero-line-turned 15"),
    ("lathe", f"{TURNED_BACK}|G91 G0 C60|G90|{TURNED_BACK}", ""),
    ("lathe", f"{FLAT}|G91 G0 C39.805571|C180|G90|{FLAT}", ""),
    ("lathe", f"G0 C30|{FLAT}|G0 Z10 C0|{ON_FACE.replace('[3]', '[1]', 1).replace('[20]', '[30]')}"
     f"|G0 X60 Z2|{FLAT}", ""),
    ("lathe", f"{FLAT}|G92 C0|{FLAT}", "offset-left 13"),
    ("lathe", f"{FLAT}|G10 L20 P1 C0|{FLAT}", ""),
    ("lathe", f"{FLAT}|G10 L2 P1 C30|{FLAT}", "zero-line-turned 14"),
    ("lathe", f"G10 L2 P2 C30|{FLAT}|G55|{FLAT}|G54", "zero-line-turned 15"),
    ("lathe", f"G10 L2 P2 C30|{FLAT}|G55|G0 C0|{FLAT}|G54", ""),
    ("lathe", f"o<turn> sub|G0 C0|o<turn> endsub|{FLAT}|o<turn> call|{FLAT}", ""),
    ("lathe", f"{FLAT}|o1 if [1]|G0 X60 C[10 - 10]|o1 endif|{FLAT}", ""),
    ("any lathe", f"T1 M6|S900 M3|G0 X60 Z2|{FLAT}", "zero-line-unknown 5"),
    ("lathe", f"G0 Z5|{POLYGON}|{FLAT}", "zero-line-turned 7"),
    ("lathe", f"G0 Z5|{POLYGON}|G0 C0|{FLAT}", ""),
    ("lathe", f"G0 Z5|{POLYGON}|G0 Z5 C-1050|{FLAT}", ""),
    ("lathe", f"G0 Z5|{POLYGON}|G28 C0|{FLAT}", "place-not-set 7"),
    ("lathe", f"G0 Z5|{POLYGON}|G92 C0|{FLAT}", "offset-left 7"),
    ("lathe", f"G0 Z5|{POLYGON}|{POLYGON}", ""),
    ("lathe", f"G0 Z10|{ON_FACE}|G0 X60 Z2|{FLAT}", "zero-line-turned 8"),
    ("lathe", f"G0 Z10|{ON_FACE}|G0 X60 Z2 C260|{FLAT}", ""),
    ("lathe", f"G0 Z10|{ON_FACE.replace('[3] [30] [20]', '[1] [30] [0]')}|G0 X60 Z2|{FLAT}", ""),
    ("lathe", f"G0 Z10|{AROUND}|G0 X60 Z2|{FLAT}", "rapid-turned 7, zero-line-left 8"),
    ("lathe", f"{FLANK}|X44|G7.1 C0|G0 Z2|X60|{FLAT}", "zero-line-left 13"),
    ("lathe", f"{FLANK}|X44|G7.1 C0|G0 Z2|X60 C90|{FLAT}", ""),
    ("lathe", f"{FLAT}|G0 C0|{FLANK}|X44|G7.1 C0|G0 Z2|X60|{FLAT}",
     "rapid-turned 13, zero-line-turned 22"),
    # where C never moves, and X0 is elsewhere
    ("any lathe", f"{ELSEWHERE}|C0|Z-2|G12.1|G1 X20|X60|Z2|G13.1", "", "40"),
    ("any lathe", f"{ELSEWHERE}|{FACE_HOLE.replace('[20]', '[0]')}", "", "40"),
    ("any lathe", f"{ELSEWHERE}|C0|X24 Z-2|G12.1|G1 X20|Z2|G13.1", "rapid-through 7", "40"),
    ("any lathe", f"{ELSEWHERE}|X44|Z-20|X38|G7.1 C20|G1 X36|Z-30|X44|G7.1 C0",
     "rapid-into 8, inside-surface 9", "40"),
    # in a system that the end of the program leaves
    ("any lathe", f"G10 L2 P2 X90|G55|T3 M6|S900 M3|G0 X60 Z9|{FACE_HOLE}|M2", "", "40"),
    ("any lathe", "G10 L2 P2 X90|G55|T3 M6|S900 M3|G0 X44 Z9|Z-9|X38|G7.1 C20|G1 X36|X44|G7.1 C0"
     "|M2", "rapid-into 8, inside-surface 9", "40"),
    # at the centre
    ("radii", f"{SLOT}|{SLOT}", "rubs 5, rubs 11"),
    ("radii", "G12.1|G1 X-18 F800|Z-1|X-10|G13.1|G0 Z2", ""),
    ("radii", "G0 Z5|o<polar_slot> call [6] [24] [2] [-9999] [0] [600] [300] [0]", "rubs 6"),
    # the side of compensation
    ("lathe", "G12.1|G1 X100 F2000|G42 X60 F1000|Z-5|C-30|X-60|C30|X60|C0|Z2|G40 X100|G13.1",
     "side-other 5"),
    ("lathe", FLAT.replace("G41", "G42"), "side-crossed 5"),
    ("lathe", "G12.1|G1 G41 X-27 C-25 F1000|Z-5|C25|Z2|G40 X-70|G13.1", ""),
    ("lathe", f"{BEGIN}|C-25|Z2|G40 X60|G41 X-27 C-25|Z-5|C25|Z2|G40 X-70|G13.1", ""),
    ("lathe", "G12.1|G1 Z-5 F1000|G41 X-27 C-25|C25|Z2|G40 X-70|G13.1", "side-crossed 5"),
    ("lathe", "G12.1|G1 X10 F1000|Z-1|G41 X40|C20|X-40|C-20|X40|C0|G40 X10|Z2|G13.1", ""),
    ("lathe", f"{BEGIN}|{SIDES}|{END}", ""),
    ("lathe", f"{BEGIN}|{SIDES}|{END}".replace("X-27", "X27"), "goes-back 11, goes-back 14"),
    # depth
    ("mill", "G13 I9 Z3 D4", "cuts-air 6, above-zero 6"),
    ("mill", "G0 Z-4|G13 I9 Z-3 D4", "bored-assumed 6, cuts-air 7"),
    ("mill", "G91|G13 I9 Z3 D4", "cuts-air 7, above-zero 7"),
    ("mill", "G13 I9 D4", "above-zero 6"),
    ("mill", "G0 Z-4|G13 I9 Z-4 D4|G0 Z1", "bored-assumed 6"),
    ("mill", "G0 X9 Z30|X0 Y0|Z1|G13 I9 Z5 D4|G0 Z1|X40|G13 I9 Z-2|G0 Z1",
     "cuts-air 9, above-zero 9"),
    ("lathe", FLAT.replace("Z-5", "Z5"), "above-zero 5, above-start 9"),
    ("lathe", FLAT.replace("Z-5", "Z2"), "above-zero 5"),
    ("lathe", f"G1 Z-5 F1000|{FLAT.replace('|Z-5', '').replace('G13.1', 'Z2|G13.1')}", ""),
    # the travel
    ("mill", f"{HIGH}|G0 X3000|{HIGH}", "travel 9"),
    ("mill", f"{HIGH}|G55 G0 X3000|{HIGH}", "travel-perhaps 9"),
    ("mill", f"{HIGH}|G0 X300|{HIGH}", ""),
    # the spindle
    ("any mill", f"T4 M6 G43|G0 Z1|{LOW}", "spindle-off 4"),
    ("any mill", f"T4 M6 G43|G0 Z1|{LOW} S900 M3", ""),
    ("mill", f"M5|{LOW}", "spindle-off 7"),
    ("mill", f"T4 M6|{LOW}", "spindle-off 7"),
    ("mill", f"{LOW}|M5", ""),
    ("any mill", f"T4 M6 G43|G0 Z1|M3|{LOW}", "spindle-off 5"),
    ("mill", f"M5|M3|G0 X1|{LOW}", ""),
    ("any mill", f"T4 M6 G43|G0 Z1|M103 P1|{LOW}", ""),  # a user's code may turn a spindle
    ("mill", f"S900 M4|{LOW}", "spindle-m4 7"),
    ("any lathe", f"T1 M6|G0 X60 Z2 C0|{FLAT}", "tool-spindle 4"),
    ("lathe", f"G0 Z5|M5|{POLYGON}", "tool-spindle 7"),
    ("lathe", FLAT.replace("|C-25", "|M5|C-25"), "tool-spindle 10"),  # the move without it
    ("lathe", FLAT.replace("|C-25", "|M4|C-25"), "spindle-m4 10"),
    ("lathe", FLAT.replace("|C-25", "|M5|M3|C-25"), ""),
    ("any lathe", f"T1 M6|G0 X60 Z2 C0|{FLAT.replace('|C-25', '|M5|C-25')}", "tool-spindle 4"),
    ("any mill", f"S900 M3|G43 H4|G0 X0 Y0 Z1|{LOW}", "none-loaded 5"),
    # tool length: T1 is 25.4 long, T3 25, T4 30
    ("mill", f"{LOW}|G0 Z50|T4 M6|G43|S900 M3|G0 X60 Z1|{LOW}", ""),
    ("any mill", f"T4 M6|S900 M3|G43 H0|G0 Z1|{LOW}", ""),  # the loaded tool's, in LinuxCNC
    ("any mill", f"T4 M6|S900 M3|G43 H1|G0 Z1|{LOW}", "length-deeper 6"),
    ("any mill", f"T4 M6|S900 M3|G43 H6|G0 Z1|{LOW}", "length-higher 6"),
    ("any mill", f"T4 M6|S900 M3|G0 Z1|{LOW}", "length-not-used 5"),
    ("any mill", f"T1 M6|S900 M3|G43|G0 Z1|G12 I5 Z-1|G0 Z50|T4 M6|S900 M3|G0 Z1|{LOW}",
     "length-deeper 11"),
    ("mill", f"G49|G0 Z1|{LOW}", "length-not-used 8"),
    ("any mill", f"G10 L1 P4 Z20 R5|T4 M6|S900 M3|G43|G0 Z1|{LOW}", ""),
    ("any mill", f"T4 M6|S900 M3|G43|G43.2 H1|G0 Z1|{LOW}", "length-commanded 7"),
    ("any mill", f"T4 M6|S900 M3|G43.1 Z24|G0 Z1|{LOW}", "length-deeper 6"),
    ("any mill", f"T4 M6|S900 M3|G43.1 Z31|G0 Z1|{LOW}", "length-commanded 6"),
    ("any mill", f"T3 M6|S900 M3|G43.2 H3|T4 M6|S900 M3|G0 Z1|{LOW}", "length-deeper 8"),
    ("any mill", f"T4 M6|S900 M3|G43 H1|o1 if [0]|G43.2 H1|o1 endif|G0 Z1|{LOW}",
     "length-deeper 9"),
    ("any lathe", f"G10 L1 P1 X20 R6|G10 L1 P3 X5 R3|T1 M6 G43|S900 M3|G0 X60 Z50 C0|T3 M6|"
     f"S900 M3|G0 X60 Z2|{FLAT}", "offset-beside 10"),
    ("any lathe", f"G10 L1 P1 X20 R6|T1 M6 G43|S900 M3|G0 X60 Z2 C0|{FLAT}", ""),
    ("any lathe", f"G10 L1 P1 X20 R6|T1 M6 G43|S900 M3|G0 X90|G49|G0 X60 Z2 C0|{FLAT}", ""),
    # a length that changes before a cycle, with no move between
    ("any mill", "T4 M6|S900 M3|G0 X0 Y0 Z50|G43|G13 I9 Z-2 D4|G0 Z9", ""),
    ("any mill", "T4 M6|S900 M3|G0 X0 Y0 Z50|G43.1 Z30|G13 I9 Z-2 D4|G0 Z9", ""),
    ("any mill", "T4 M6|S900 M3|G43|G0 X0 Y0 Z50|G43.2 H3|G13 I9 Z-2 D4", "length-commanded 7"),
    ("any mill", "T4 M6|S900 M3|G43|G0 X0 Y0 Z5|G49|G13 I9 Z-2 D4|G0 Z9", "length-not-used 7"),
    ("any mill", "T4 M6|S900 M3|G0 X0 Y0 Z50|G91 G43|G13 I9 Z-22 D4|G0 Z9", ""),
    ("any mill", "T4 M6|S900 M3|G43.1 Z20|G0 X0 Y0 Z5|G13 I9 Z-2 D4", "length-deeper 6"),
    ("any mill", f"T4 M6 G43|S900 M3|G0 X0 Y0 Z1|{LOW}|G0 Z20|T10 M6 G43|S900 M3|G0 X40 Z9|G49|"
     f"T4 M6|S900 M3|G43|G0 X80 Z1|{LOW}|G0 Z9", ""),
    # a tool that is 10 mm longer has its tip in the pocket
    ("any mill", f"T4 M6 G43|S900 M3|G0 X0 Y0 Z1|{LOW}|G0 Z9|T10 M6 G43|S900 M3|G0 X40 Z9",
     "rapid-through 9"),
    ("any mill", f"T4 M6 G43|S900 M3|G0 X0 Y0 Z1|{LOW}|G0 Z9|G49|T10 M6 G43|S900 M3|G0 X40|Z9",
     "rapid-through 10"),
    # a rapid with another length than the tool's
    ("any mill", f"T3 M6|S900 M3|G0 X0 Y0|Z5|G43 H3|G0 Z5|{LOW.replace('D4', 'D3')}",
     "rapid-length 5"),
    ("any mill", f"T3 M6|S900 M3|G0 X0 Y0|Z50|G43 H3|G0 Z5|{LOW.replace('D4', 'D3')}", ""),
    ("mill", f"{LOW}|G0 Z1|G49|G0 Z10|X80", "rapid-length 9"),
    ("mill", f"{LOW}|G0 Z50|T3 M6|S900 M3|G49|G0 X40|Z5", "rapid-length-not-used 12"),
    ("mill", f"{LOW}|G0 Z1|G49|G0 Z60|X80", ""),
    ("mill", f"{LOW}|G0 Z1|G49|X80|Z1|{LOW}", "length-deeper 11"),
    # the tool table as it is at a cut
    ("mill", f"{LOW}|G10 L1 P4 R2 Z99", ""),
    ("mill", f"{LOW}|G0 Z1|X40|G10 L1 P4 R4|{LOW}|G0 Z1|X80|G10 L1 P4 R5 Z9|{LOW}",
     "length-higher 14"),
    ("any lathe", f"G10 L1 P1 X4 R6|T1 M6 G43|S900 M3|G0 X60 Z2 C0|{FLAT}|G10 L1 P1 R3|"
     f"G0 X60 Z10 C0|{FACE_HOLE}|G10 L1 P1 R9 X9", ""),
    # a Z0 that blocks compute each for itself
    ("any mill", "T3 M6 G43|S900 M3|G0 X0 Y0 Z5|G13 I3.5 K10 Q2.5 Z-6 D3|G0 Z5|X40|X40 Z-2|"
     "G13 I3.5 K10 Q2.5 Z-6 D3|G0 Z5", "rapid-into 8"),
    # the cutter and D
    ("mill", "G12 I7 K20 Q6 Z-3 D5", "wrong-cutter 6, uncut 6"),
    ("mill", "G10 L1 P6 R5.1|G12 I7 K20 Q6 Z-3 D6", "worn-cutter 7"),
    ("any mill", "G10 L1 P4 R0|T4 M6 G43|S900 M3|G0 X0 Y0 Z1|G13 I9 Z-2 D3", "loaded-unknown 6"),
    ("mill", f"M61 Q3|{LOW}", "wrong-cutter 7, uncut 7, length-higher 7"),
    ("mill", f"M61 Q3|G43|G0 Z1|{LOW.replace('D4', 'D3')}", ""),
    # words of other kinds in the block of a cycle
    ("mill", "G13 I9 Z-2 D4 M8|G0 Z1|G61|G13 X40 I9 Z-2 M9|G0 Z1", ""),
    # what the preview executes otherwise than a machine may
    ("mill", f"{LOW}|/X40|G0 Z1|X40|{LOW}|/G0 Z9", "block-delete 7"),
    # feeds, return levels, C
    ("mill", f"G95 F60|{LOW}|G94", "feed-per-revolution 7"),
    ("mill", f"F.2|{LOW}", "feed-per-minute 7"),
    ("mill", f"F20000|{LOW}", "feed-cut-down 7"),
    ("lathe", "S2000|G95 F9|G12.1|G1 X27|Z-5|C-25|X60|G13.1",
     "feed-per-revolution 7, feed-cut-down 7"),
    ("lathe", "S500|G95 F5|G12.1|G1 X27|Z-5|C-25|X60|G13.1", "feed-per-revolution 7"),
    ("lathe", "S500|G95 F1|G12.1|G1 X27|Z-5|C-25|X60|G98 F900|C5|G13.1", ""),
    ("lathe", "S500|G95 F5|G0 X64 Z-20|G7.1 C25|G1 X48|C60|X64|G7.1 C0", "feed-per-revolution 8"),
    ("lathe", f"S500|G95|G0 Z5|{POLYGON.replace('[600] [300]', '[5] [1]')}",
     "feed-per-revolution 8"),
    ("lathe", "F.9|G12.1|G1 X27|Z-5|C-25|X60|G13.1", "feed-per-minute 6"),
    ("lathe", f"G99 F.3|G0 X60 Z2 C0|G1 X50 C90 F500|{FLAT}", "return-level 5, native-c 7"),
    ("lathe", f"G0 X60 Z10|{FACE_HOLE.replace('120', '12000')}|G0 Z10", "feed-cut-down 6"),
    # pockets that meet
    ("mill", f"{CLEARED}|G0 Z1|{RING}", ""),
    ("mill", RING, "core-remains 6"),
    ("mill", f"{SHALLOW}|G0 Z1|{RING}", "core-remains 8"),
    ("mill", f"{CLEARED}|G0 Z1|X50|{CLEARED}", ""),
    ("mill", f"{CLEARED}|G0 Z1|X20|{CLEARED}", "cuts-wall 9"),
    ("mill", f"{P}|G0 Z1|X10|G10 L2 P1 Z-20|G0 Z1|{P}|G0 Z30", "rapid-into 10"),  # far below it
    ("mill", f"{CLEARED}|G0 Z1|X2|{SHALLOW.replace('K20', 'K8')}", "cut-before 9"),
    ("mill", f"{CLEARED}|G0 Z1|{CLEARED}", "cut-before 8"),
    ("mill", f"{SHALLOW}|G0 Z1|{CLEARED}", ""),
    ("mill", f"{CLEARED}|G0 Z1|o1 if [0]|{CLEARED}|o1 endif", "never-run 9"),
    ("mill", f"{CLEARED}|M2|{CLEARED}", "never-run 8"),
    ("helix", "G13 I9 K18 Q4 Z-3 D4 F500|G13 I18 F300|G0 Z5", "cut-before 6"),
    # rapids
    ("mill", f"{CLEARED}|G0 Z1|X40|Z-2|Z1", "rapid-beside 9"),
    ("mill", f"{CLEARED}|G0 Z-2|Z1", ""),
    ("mill", f"{P}|G0 X100 Z1", "rapid-through 7"),
    ("mill", f"{P}|G0 X10 Y8|X0 Y0|Z2", ""),
    ("mill", f"Z10|{P}|G0 Z1|X100", ""),
    ("mill", f"Z10|{P}|G0 Z-1|X100", "rapid-through 9"),
    ("mill", f"{P}|G1 X60|{P}|G0 X0|Z2", ""),  # along the channel
    ("mill", f"{RING}|G0 X-15.2|Z1", "core-remains 6, rapid-through 7"),
    ("mill", f"{SHALLOW}|G0 Z1|Z-4|{CLEARED}|G0 Z1", "rapid-into 8"),
    ("mill", f"Z-2|{CLEARED}|G0 Z-2|X60|{CLEARED}", "bored-assumed 6, rapid-beside 9"),
    ("yasnac", "G0 Z-3|G12 I40 R38 D10 F300|G0 X20 Y2|Z2", "bored-assumed 6"),
    ("mitsubishi", "G0 X0 Y0 Z5|G18 G1 Z-5|G12 I30 D10|G0 X100|Z5", "upright 6"),
    # the top of a pocket that is not below Z0 is where it began to feed
    ("any mill", f"{AIR}|Z10|G13 I7 K20 Q6 Z5 D4|G0 Z10|X100", "above-zero 6"),
    ("any mill", f"{AIR}|Z10|G13 I7 K20 Q6 Z5 D4|G0 Z7|X100", "above-zero 6, rapid-through 8"),
    ("any mill", f"{AIR}|G13.2 X0 Y0 Z5 I7 R20 K5 D2 H2|G0 Z7|X100", "above-zero 5"),
    ("any mill", f"{AIR}|G13.2 X0 Y0 Z5 I7 R20 K5 D2 H2|G0 Z6|X100",
     "above-zero 5, rapid-through 7"),
    ("mill", f"X-100|Z-1|X0|{LOW}|G0 Z1", "rapid-beside 7"),
    ("mill", f"G91 X30 Z-2|G90|{LOW}|G0 Z1", "rapid-beside 6"),
    ("mill", f"{CLEARED}|G0 Z-2|G53 G0 X90 Z0", "rapid-by-machine 8"),
    ("mill", f"{CLEARED}|G0 Z1|G53 G0 X90 Z0", ""),
    ("any mill", f"T4 M6|S900 M3|G43|G0 X0 Y0|Z1|{LOW}|G53 G0 Z0|T3 M6|G43|G0 X60|Z1",
     "rapid-by-machine 8"),
    ("inch", f"G0 X0|{POCKET}|G0 Z-.01|X2|{POCKET}|G0 Z.1", "rapid-through 8"),
    ("inch", f"G0 X0|{POCKET}|G0 Z-.1|X2|{POCKET}|G0 Z.1", "rapid-through 8"),
    ("inch", f"G0 X0|{POCKET}|G0 Z-.3|X2|{POCKET}|G0 Z.1", "rapid-through 8"),
    ("inch", f"G0 X0|{POCKET}|G0 Z.1|X2|{POCKET}|G0 Z.1", ""),
    ("inch", f"G0 X-2|{POCKET}|G0 Z.1|G0 X0|{POCKET}|G0 Z-.01|X2|{POCKET}|G0 Z.1",
     "rapid-through 11"),
    ("inch", f"G0 X-2|{POCKET}|G0 Z.1|G0 X0|{POCKET}|G0 Z.1|X2|{POCKET}|G0 Z.1", ""),
    ("inch", f"G0 Z-.3|{POCKET.replace(' Z-.3', '')}|G0 Z.1", "bored-assumed 5"),
    ("inch", f"G0 Z-.3|{POCKET.replace(' Z-.3', '')}|G0 Z.1", "rapid-into 5", "4x4x1"),
    ("inch", f"G0 Z-.3|{POCKET.replace(' Z-.3', '')}|G0 Z.1", "", "4x4x1 bore .7"),
    ("inch", f"{POCKET}|G0 Z.1|G53 G0 Z0", "plunge-into-stock 5", "4x4x1"),
    ("yasnac", R38, "plunge-into-stock 5, rapid-through 6, core-remains 6", "200x200x20"),
    ("yasnac", R38, "rapid-through 6, core-remains 6", "200x200x20 bore 30"),
    ("yasnac", R38, "no-stock-met 6", "200x200x20 bore 80"),
    ("lathe", f"G0 X60 Z10|{FACE_HOLE}|G0 Z10", ""),
    ("lathe", f"G0 X60 Z10|{FACE_HOLE}|G0 X20 Z-3|X30", "rapid-through 8"),
    ("lathe", f"{HEXAGON}|G0 X70 Z5 C0", ""),
    ("lathe", f"{HEXAGON}|G0 X70 Z-3|X0|Z5", "rapid-through 20"),
    ("lathe", f"{HEXAGON}|G53 G0 X200|G53 G0 Z0", "plunge-into-stock 8", "40"),
    ("lathe", f"{HEXAGON}|G0 X70 Z5 C0|X80|G0 X70 Z5|{SIDE_HOLE}", "rapid-turned 20"),
    ("lathe", f"{HEXAGON}|G0 X70 Z5 C0|G0 X70 Z5|{SIDE_HOLE}|G0 X0",
     "bar-remains 6, plunge-into-stock 8, rapid-into 22", "60"),
    ("lathe", f"{HEXAGON}|G0 X70 Z-3|X0|Z5|X70 Z2 C0|{HEXAGON}|G0 X70 Z5|{SIDE_HOLE}",
     "rapid-through 20, rapid-turned 37"),
    ("lathe", "G0 X40|G12.1|G1 Z-2 F200|X20 F600|G13.1|G0 C180|Z2",
     "rapid-through 10"),
    ("lathe", "G0 X40|G12.1|G1 Z-2 F200|X20 F600|G13.1|G0 Z2|C180", ""),
    ("any lathe", "T1 M6|S900 M3|G0 X10 Z-3 C0|G12.1|G1 X20 F600|Z2|G13.1",
     "rapid-into 4", "30"),
    ("lathe", f"G0 Z10|Z-15|{HOLES}|G0 X80", "rapid-into 7", "40"),
    ("lathe", f"G0 Z10|Z-15|{HOLES}|G0 X20|Z-10|X80", "rapid-through 9"),
    ("lathe", f"G0 Z10|Z-15|{HOLES}|G0 X80", "", "9"),
    ("lathe", f"G0 Z10|Z-15|X10|X60|{HOLES.replace('30', '40')}|G0 X80", "rapid-into 7", "40"),
    ("lathe", f"{HEXAGON}|G0 X70 Z-20|X36|G7.1 C25|G1 X36 F200|Z-40 C60|X70|G7.1 C0",
     "plunge-into-stock 8, rapid-into 20, inside-surface 21", "50"),
    ("lathe", f"{HEXAGON}|G0 X70 Z-20|X56|G7.1 C25|G1 X36 F200|Z-40 C60|X70|G7.1 C0",
     "plunge-into-stock 8", "50"),
    ("lathe", f"{GROOVE.replace('G7', 'X44|G7')}|G1 X60|G7.1 C0",
     "rapid-into 6, inside-surface 7", "50"),
    ("lathe", f"{GROOVE.replace('G7', 'X52|G7')}|G1 X60|G7.1 C0", "", "50"),
    ("lathe", f"{HEXAGON.replace('Z-5', 'Z-15')}|G0 Z5|T2 M6|G0 X70 Z-3|"
     f"{HOLES.replace('-15', '-3')}|G0 X80",
     "plunge-into-stock 8, rapid-after-cuts 22, over-the-edge 22, tool-spindle 22", "40"),
    ("lathe", f"{HEXAGON}|G0 Z5|T2 M6|G0 X70 Z-3|{HOLES.replace('-15', '-3')}|G0 X80",
     "plunge-into-stock 8, rapid-into 22, over-the-edge 22, tool-spindle 22", "40"),
    ("lathe", f"{HEXAGON}|T3 M6|G0 X60 Z-4|X0|X60|Z5", "rapid-idle-tool 20"),
    ("mill", f"{CLEARED}|G0 Z5|X200|Z-3|{CLEARED}",
     "plunge-into-stock 6, rapid-into 9, no-stock-met 10",
     "100x100x20"),
    ("lathe", f"G0 Z10|{HOLES.replace('[-15]', '[-1]')}|G0 X80", "over-the-edge 6", "30"),
    # cylinders
    ("lathe", "G0 X44 Z10|G7.1 C20|G1 X34 F200|Z25 C180|X44|G7.1 C0", "above-zero 6"),
    ("lathe", f"{GROOVE}|G7.1 C0|G0 Z5", "rapid-through 10"),
    ("lathe", f"{GROOVE}|G7.1 C0|G0 C0", "rapid-through 10"),
    ("lathe", f"{GROOVE}|G7.1 C0|G0 C420", "rapid-through 10"),
    ("lathe", f"{GROOVE}|G1 X60|G7.1 C0|G0 C0", ""),
    ("lathe", "G0 X46 Z-30|G7.1 C20|G1 X36 F200|C90|X46|G7.1 C0", ""),
    ("lathe", "G0 X46 Z-30|G7.1 C10|G1 X36 F200|C90|X46|G7.1 C0", "above-surface 6"),
    # where the work offset has the spindle
    *(("radii", f"G0 X31 Z9 C0|{offset}|{ROUND_A_FLAT}", "")
      for offset in ("G10 L2 P1 X4 Z-3 C20", "G10 L2 P1 X-9", "G55 G10 L2 P2 X70 C9")),
    ("radii", f"G0 X31 Z9 C0|G10 L20 P1 X35 Z4|{ROUND_A_FLAT}|G20",
     "rapid-from-unknown 4, rapid-beside 5"),
    ("any mill", f"T4 M6 G43|S900 M3|G0 X0 Y0|Z-2|{LOW}|G0 Z1", "rapid-from-unknown 5"),
    ("any mill", f"T4 M6 G43|S900 M3|G0 X0 Y0|Z1|{LOW}|G0 Z1", ""),
    # what LinuxCNC does slower than its words ask
    ("face", "G12.1|F1008.844|G1 X-57.93351 C0.11121|G13.1", "above-zero 5"),
    ("lathe", "G64 P.01|G0 X120 Z5|G12.1|F1008.844|G1 X-57.93351 C0.11121|G13.1", "above-zero 7"),
    ("face", "G0 X60|G12.1|G1 X20 C-30 F5000|C30|G13.1", "above-zero 6"),
    ("face", "G0 X60 C-45|G12.1|F6637.24|G1 X-15.50263 C-22.13613|X-8 C-12|X-20 F200|G13.1",
     "above-zero 6"),
    # subs that are called in a section and outside of it, and by themselves
    ("radii", CALLED.format("o100 call", "o100 sub", "o100 endsub"), ""),
    ("radii", CALLED.format("M98 P100", "O100", "M99"), ""),
    ("radii", "o100 sub|o1 if [#1 gt 0]|G1 X30 F800|C[#1]|X40|C0|o100 call [#1-1]|o1 endif|"
     "o100 endsub|G0 X40 Z2 C0|G12.1|G1 Z-1 F99|o100 call [3]|Z2|G13.1", ""),
    # a passage narrower than the cutter
    ("any lathe", SQUARE_AND_PIN.format(62), ""),
    ("any lathe", SQUARE_AND_PIN.format(58), "cuts-contour 9, cuts-contour 16"),
    # full circles, and modes that are saved and restored, in a section
    ("radii", "G12.1|G1 X11.902 C-25.519 F500|Z-1|G2 I-3.314 J5.371|G3 I.1 J.7|G2 I-7.3 J.003|"
     "G1 Z2|G13.1", ""),
    ("radii", "G12.1|G1 X30 F500|Z-1|M73|G91 G3 X-1 R9|M72|X20 C5|M70|G91|M72 X15|M70|G91|M71|"
     "X-1|Z4|G13.1", ""),
    # what comes before the first move of a section, and after an element that makes none
    ("radii", "G12.1|M8|G1 X30 F500|Z-1|X30|M9|X20|G13.1", ""),
    # a contour of a line and an arc, a radius of 0 in a sub, words that cannot be read
    ("radii", "G0 X40|G12.1|G1 C30 F900|G41 X12|C-16|G2 X12 C16 R-20|G1 G40 X40|Z-2|G13.1",
     "contour-above 9"),
    ("lathe", "o7 sub|G7.1 C#1|G1 X40 F300|C90|X60|G7.1 C0|o7 endsub|G0 X60 Z-20|o7 call [0]|"
     "o7 call [25]", ""),
    ("radii", f"G12.1|G1 X30 F800|Z-1|X[28{'+0' * 122}]|G13.1", "contour-unread 5"),
    ("radii", "o7 sub|o2 if [#<_x> GT 1]|G1 X15 F800|Z-1|o2 endif|o7 endsub|G12.1|o7 call|G13.1|"
     "o7 call", "contour-unread 11"),
    ("radii", "o9 sub|o9 endsub [25]|o9 call|G12.1|G1 X30 F500|Z-1|X[#<_value>]|G13.1", ""),
    ("lathe", f"G0 Z9|{LONGEST_CALL}", ""),
    ("any mill", f"o<polar_slot> sub|G1 X#1|o<polar_slot> endsub|T4 M6 G43|S900 M3|G0 Z1|"
     f"o<polar_slot> call [8]|{LOW}", ""),  # another sub of that name
    # a sub that is called twice, a sub's own file, two flats round the outside of the bar
    ("any lathe", f"o7 sub|G0 C#1|{FLAT.replace('G41', 'G42')}|o7 endsub|T1 M6|S900 M3|"
     f"G0 X60 Z2|o7 call [0]|o7 call [180]",
     "side-crossed 4, side-crossed 4"),
    ("lathe", f"G0 Z5|{POLYGON}", "plunge-into-stock 6", "40"),
    ("lathe", "G0 X80|G12.1|G1 C25 F2000|G41 X27 F1000|Z-5|C-25|G40 X80|Z2|C-45|X-80|C-25|"
     "G41 X-27|Z-5|C25|G40 X-80|Z2|G13.1",
     "", "40"),
    # what a pass before has cleared
    ("mill", "o7 sub|G13 I9 K18 Q4 Z-3 D4|G13 I18|o7 endsub|o7 call|G0 Z5", "cut-before 8"),
    ("mill", "G13 I9 K18 Q4 Z-3 D4|G13 I18|G0 Z5", "cut-before 7"),
    ("mill", "G13 I9 K15 Q4 Z-3 D4|G13 I20 K24 Q4|G0 Z5", ""),
    ("mill", "G13 I20 K24 Q4 Z-3 D4|G0 Z5", "uncut 6"),
    ("mill", "G13 I9 K15 Q4 Z-1 D4|G13 I20 K24 Q4 Z-3|G0 Z5", "uncut 7"),
    # a spindle that starts in a cut, an offset that is left, what is beyond the axis
    ("mill", f"M5|{P}|M3|G0 Z1", "spindle-off 7, start-in-cut 9"),
    ("mill", f"M5|{P}|G0 Z1|M3|X1", "spindle-off 7"),
    ("two spindles", "G12.1|G1 X20 F900|Z-5|X50|G13.1|M3 S100|G0 Z2",
     "tool-spindle-unseen 5, plunge-into-stock 7, start-in-cut 11", "40"),
    ("mill", f"G92 X0|{P}|G0 Z1|G52 Y9|X0", "offset-left 9"),
    ("mill", f"G52 X4|{P}|G0 Z1|G92.1", ""),
    ("mill", f"{P}|G0 Z1|G52 X4|G52 X0", ""),
    ("lathe", f"{FLAT}|G92 C0", "offset-left 13"),
    ("lathe", f"{FLAT}|G92 C[#<_c>-720]", ""),
    ("lathe", f"{FLANK}|X-6|X44|G7.1 C0", "beyond-axis 6"),
    # a tap without a hole, into a hole that is not as deep, in place of it
    ("lathe", f"G0 Z10|{FACE_HOLE}|{TAP}", ""),
    ("lathe", f"G0 Z10|{TAP}|{TAP.replace('[0]', '[9]', 1)}|{FACE_HOLE}", "tap-undrilled 6"),
    ("lathe", f"G0 Z10|{FACE_HOLE}|{TAP.replace('[8]', '[9]')}|{TAP}", "tap-undrilled 7"),
    ("lathe", f"G0 X80 Z10|{SIDE_HOLE}|{SIDE_TAP}", ""),
    ("lathe", f"G0 X80 Z10|{SIDE_HOLE}|{SIDE_TAP.replace('[8]', '[9]')}", "tap-undrilled 7"),
    ("lathe", f"G0 Z10|{FACE_HOLE}|{TAP.replace('[0]', '[9]', 1)}|{TAP}", "tap-undrilled 7"),
    # a section without a move
    ("lathe", "G12.1|M8|G13.1", "empty 5"),
    ("lathe", "G0 X44 Z-20|G7.1 C20|G7.1 C0|G0 Z2|X60", "empty 6"),
    # a retract that is missing between two, a circle where the tool came down
    ("mill", f"{P}|G13 X60 I7 K20 Q6 Z-3|G0 Z2", "rapid-through 7"),
    ("mill", f"{P}|G0 Z2|G13 X60 I7 K20 Q6 Z-3|G0 Z2", ""),
    ("helix", "G13 X30 I10 K20 Q6 Z-3 D4|G12 X90 Y9 I10 K20 Q6 Z-3|G0 Z1",
     "rapid-through 6"),
    ("helix", "G13 X30 I10 K20 Q6 Z-3 D4|G0 Z1|G12 X90 Y9 I10 K20 Q6 Z-3|G0 Z1", ""),
    ("mitsubishi", "G0 X0 Y0 Z5|Z-5|G12 I30 D10|G0 X100|G12 I30 D10|G0 Z5",
     "bored-assumed 5, rapid-through 7"),
    ("mill", f"o7 sub|{P}|G0 X60|G0 Z1|o7 endsub|o7 call",
     "rapid-through 8"),
    # feeds and path control before, in and after a section
    ("radii", "G0 X30|G12.1|G95 F.5|G1 X20 C5|G94|G13.1|G0 Z5", "above-zero 6"),
    ("radii", "G0 X30|G12.1|G95 F.5|G1 X20 C5|G94 F300|G95|G13.1|G0 Z5", "above-zero 6"),
    ("radii", "G0 X30|G61|G12.1|G1 X20 C5 F500|G13.1|G0 X30 C0|G64|G12.1|G1 X15 C-5|X9|G13.1|G0 Z5",
     "above-zero 7, above-zero 12"),
    ("radii", "G0 X30|G12.1|G61|G1 X20 C5 F500|G64|G13.1|G0 X30 C0|G12.1|G1 X15 C-5|X9|G13.1|G0 Z5",
     "above-zero 6, above-zero 12"),
    ("radii", "G0 X30|G1 X28 F900|G61|G12.1|G1 X28 C9|G13.1|G0 Z5", "above-zero 8"),
    ("radii", "G0 X30|G61.1|G1 X28 F900|G64|G12.1|G1 X28 C9|X20 C4|G13.1|G0 Z5", "above-zero 9"),
    # contours of one section: crossed without compensation, in the air, compensation lost
    ("radii", "G0 X30|G12.1|G1 C3 F900|G41 X12 C20|Z-5|C-20|G40 X30 C3|X-30|Z2|G13.1",
     "cuts-contour 12"),
    ("lathe", HEXAGON.replace("G40 X70", "G40 X70|X0"), "cuts-contour 17"),
    ("lathe", HEXAGON.replace("Z2|G13.1", "Z2|X0|X70|G13.1"), ""),
    ("lathe", f"G0 X80|G12.1|G1 G41 X27 C25 F1000|Z5|C-25|G40 X80 C0|Z2|{OTHER_FLAT}",
     "above-start 9"),
    ("lathe", f"G0 X80|G12.1|G1 G41 X27 C25 F1000|C-25|G40 X80 C0|{OTHER_FLAT}",
     "contour-above 8"),
    ("lathe", FLAT.replace("G41 ", ""), "side-cancelled 10"),
    ("radii", SLOT.replace("|Z2", "|Z2|G40"), "rubs 5"),
    ("lathe", "G0 X80|G12.1|G1 C25 F2000|G41 X27 F1000|Z-5|C-25|G40 X80|C-45|X-80|C-25|G41 X-30|"
     "Z-3|C25|G40 X-80|Z2|G13.1|G0 Z5", ""),
    # the tool: no diameter, changed in a cut; the second spindle, which no preview shows
    ("mill", "G10 L1 P4 R0|T4 M6 G43|S900 M3|G0 X0 Y0 Z1|G13 I9 Z-3 D3|G0 X100|Z1",
     "loaded-unknown 10, rapid-through 11"),
    ("radii", f"G10 L1 P3 R0|T3 M6|S900 M3|G0 X18 Z2 C0|{SLOT.replace('|Z2', '')}|G0 C180|Z2",
     "rubs 9, rapid-no-diameter 14"),
    ("mill", "G13 I9 Z-25 D4|T6 M6|G43 H6|G0 Z50", "change-in-cut 7"),
    ("yasnac", "Z-4|G12 I45 R28 D10 F400|T6 M6|G43 H6|G0 Z50", "change-in-cut 7",
     "160x160x30 bore 56"),
    ("mill", "G13 I9 Z-25 D4|G0 Z1|T6 M6|G43 H6|G0 Z50", ""),
    ("radii", f"{SOCKET}|T1 M6|G0 Z9", "change-in-cut 16, rapid-idle-tool 17"),
    ("radii", f"{SOCKET}|M5|G0 X3|M3|Z9", ""),
    ("radii", f"{SOCKET}|G0 Z9|T1 M6", ""),
    ("lathe", f"{FLAT.replace('|G0 Z2', '')}|T3 M6|G0 Z9", "rapid-idle-tool 13"),
    ("lathe", f"{GROOVE}|G7.1 C0|T3 M6|G0 X60|Z5",
     "change-in-cut 10, rapid-idle-tool 11"),
    ("two spindles", FLAT, "tool-spindle-unseen 5"),
    # rapids before the first section, and a hole for it; in front of the face
    ("lathe", f"G0 X70 Z-3|X0|Z5|X70|{HEXAGON}", "rapid-beside 5, rapid-through 6"),
    # two points of the first are one but for rounding; so is their shape when it is turned
    ("any lathe", f"G8|T3 M6|S900 M3|G0 X60 Z5 C-45|{TRIANGLE}|Z5|C15|{TRIANGLE}|Z5",
     "rapid-beside 16, rapid-through 29"),
    ("lathe", "G0 X60 Z-20|X10|X60|G7.1 C20|G1 X34 F80|Z-40|X60|G7.1 C0", "rapid-into 6"),
    ("lathe", "G0 X10|Z-3|G12.1|G1 X20 F600|Z2|G13.1", "bored-assumed 6"),
    ("lathe", f"G0 X10 Z50|X70 Z5|{SIDE_HOLE}", ""),
    ("lathe", "G0 X34 Z10|G7.1 C20|G1 Z-20 F100|C90|X44|G7.1 C0", "", "40"),
    ("lathe", f"G0 Z10|{FACE_HOLE}|G0 Z10", "", "40"),
    # a boss that another cut removes, a tap faster than the machine
    ("mill", "G12.2 X0 Y0 Z-3 I2 R15 D0 H1|G13 I9 K18 Q8 Z-3 D4|G0 Z1", "boss-cut 6, cuts-wall 7"),
    ("mill", "G13 I9 K40 Q8 Z-3 D4|G0 Z1|G12.2 X0 Y0 Z-3 I2 R15 D0 H1", "boss-cut 8"),
    ("mill", "G12.2 X0 Y0 Z-8 I2 R15 D0 H1|G0 Z5|G13 I9 K40 Q8 Z-7 D4|G0 Z1", "boss-cut 6"),
    ("mill", "G13 I9 K40 Q8 Z-2 D4|G0 Z5|G12.2 X0 Y0 Z-8 I2 R15 D0 H1", ""),  # its top
    ("mill", "G12.2 X0 Y0 Z-2 I2 E8 R20 D1 H1|G12.2 X0 Y0 Z-6 I2 R15 D0 H1",
     "core-remains 6, cuts-wall 7"),
    ("mill", "G12.2 X0 Y0 Z-6 I2 E8 R25 D0 H1|G0 Z50|T6 M6 G43|S900 M3|G0 X0 Y0 Z1|"
     "G12.2 X0 Y0 Z-6 I2 E8 R40 D1 H1", "core-remains 11, cuts-wall 11"),
    ("mill", "G12.2 X0 Y0 Z-6 I2 E8 R25 D0 H1|G12.2 X0 Y0 Z-6 I2 R40 D1 H1", "core-remains 7"),
    ("mill", "G13 I6 K9 Q3 Z-8 D4|G13 I6 K14 Q3 Z-4|G0 Z5", ""),  # from below upwards
    ("mill", f"{CLEARED}|G0 Z5|X60|Z-5|G1 Y40|G0 Z5", "rapid-beside 9"),
    ("mill", f"{CLEARED}|G0 Z5|X60|Z2|G1 Z-2|Y40|G0 Y10|Z2", ""),
    ("mill", f"{CLEARED}|G0 Z5|X60|Z2|G1 Z-2|Y40|G0 Z-5|Z2", "rapid-beside 12"),
    ("lathe", "G0 Z10|o<face_hole_at> call [0] [0] [6] [5] [120] [0] [0] [1]",
     "tap-undrilled 6, feed-per-revolution 6, feed-cut-down 6"),
    # holes with C
    ("any lathe", f"G10 L1 P1 R0|T1 M6|S900 M3|G0 X60 Z10 C0|{ON_FACE}",
     "no-diameter 6, rapid-no-diameter 6"),
    ("any lathe", f"G10 L1 P1 R0|T1 M6|S900 M3|G0 X60 Z10 C0|{AROUND}",
     "no-diameter 6, rapid-no-diameter 6"),
    ("lathe", f"G0 Z10|{AROUND}", ""),
    ("lathe", f"G0 Z10|{AROUND.replace('[-10]', '[10]')}", "above-zero 6"),
    ("lathe", f"G0 Z10|G95|{ON_FACE}", "feed-per-revolution 7"),
    ("lathe", f"G0 Z10|G95|{ON_FACE.replace('[120]', '[.1]')}", ""),
    ("lathe", f"G0 Z10|{AROUND}|G0 Z10|{ON_FACE}", "rapid-into 6, rapid-turned 7", "50"),
    ("lathe", f"G0 Z10|{AROUND}|G0 Z10|{ON_FACE}", "rapid-turned 7, over-the-edge 8", "40"),
    # the stock
    ("mill", P, "", "100x80x20 bore 12"),
    ("mill", P, "", "bore 12"),
    ("mill", P, "below-block 6", "100x80x2 bore 12"),
    ("mill", f"X80|Z-3|X30|G0 Z1|X0|{P}|G0 Z1",
     "rapid-through 8, plunge-into-stock 11", "100x80x20"),
    ("mill", f"X36|X80|Z-3|G0 Z1|X0|{P}|G0 Z1", "", "60x80x20@-30,-40 bore 12"),
    ("mill", f"Z-3|{P}|G0 Z1", "", "100x80x20 bore 12"),
    ("mill", f"Z-3|{P}|G0 Z1", "rapid-into 6", "100x80x20"),
    # its sides are along the axes of the program, which may be turned on the machine
    ("mill", f"G10 L2 P1 R30|G0 X30 Y0|{P}|G0 Z1", "", "100x60x20@-20,-30 bore 12"),
    ("mill", f"G10 L2 P1 R90|G0 X0 Y30|{P}|G0 Z1", "over-the-edge 8", "100x60x20 bore 12"),
    ("mill", "X40|G12 I9 Z-1 D4", "no-stock-met 7", "20x20x9"),
    ("mill", "X40|G12 I9 Z-1 D4", "plunge-into-stock 7", "99x20x9"),
    ("lathe", FLAT, "", "40"),
    ("lathe", NARROW, "bar-remains 5, plunge-into-stock 8", "40"),
    ("lathe", FLAT.replace("Z-5", "Z5"),
     "no-stock-met 5, bar-remains 5, above-zero 5, above-start 9", "40"),
    ("lathe", f"{FLAT}|G0 C0|{FLAT.replace('X27', 'X44')}", "no-stock-met 14", "40"),
    ("lathe", f"{FLAT}|G0 C180|G12.1|G1 C25 F2000|G13.1|G0 Z-3|X20|Z2",
     "no-stock-met 14, above-zero 14, rapid-through 18", "40"),
    ("lathe", "G12.1|G1 Z-2 F300|Z2|G13.1", "no-stock-met 5", "40"),
    ("lathe", f"{FLANK}|G1 X44|G7.1 C0|G0 C0", "", "40"),
    ("mill", f"X31|{P}|G0 Z1", "plunge-into-stock 7, over-the-edge 7", "100x80x20"),
    ("mill", f"X29|{P}|G0 Z1", "", "100x80x20 bore 12"),
    ("lathe", f"G0 Z10|{FACE_HOLE.replace('20', '27', 1)}", "", "40"),
    ("lathe", f"G0 Z10|{FACE_HOLE.replace('20', '29', 1)}", "over-the-edge 6", "40"),
    ("lathe", f"G0 Z9|{ROUND.format(15)}", "", "40"),
    ("lathe", f"G0 Z9|{ROUND.format(18)}", "over-the-edge 6", "40"),
    ("lathe", f"G0 Z5|{POLYGON}", "plunge-into-stock 6, bar-remains 6", "60"),
    ("lathe", f"G0 Z5|{FLATS}", "", "32"),
    ("lathe", f"{FLANK}|G1 Z-19|G7.1 C0|G0 C0", "rapid-through 11", "40"),
]  # fmt: skip
SAME = ("travel-unplaced", "plain-moves")  # of every program; of moves that are no cut


@pytest.fixture
def proof_of(tmp_path):
    """Return a function: the proof of a program whose blocks follow a beginning."""

    def proof(beginning, blocks, stock="", **more):
        machine, head = BEGINNINGS[beginning]
        lines = f"{head}|{blocks}".split("|")
        return prove_lines(tmp_path, lines, machine, stock=stock, **more)

    return proof


@pytest.fixture
def codes(proof_of):
    """Return a function: the codes and lines of what verify reports of a program."""

    def judged(*case, **more):
        found = (each for each in proof_of(*case, **more).judged if each.code not in SAME)
        return ", ".join(f"{each.code} {each.line}" for each in found)

    return judged


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case[0]}, {case[1]}"[:60])
def test_the_codes_of_a_program(case, codes):
    beginning, blocks, expected, *stock = case
    assert codes(beginning, blocks, *stock) == expected


CLAMPED = [  # M10 closes the clamp of C, M11 opens it: a program, and C_CLAMP_SHAPES
    ("M10|G0 C90|C180|M11|C0", "clamp-closed 6"),
    ("M10|G0 C90|M11|C0|M10|C90", "clamp-closed 6, clamp-closed 10"),
    ("M10|G0 X70|M11|C90", ""),
    (f"M10|{FLAT}|M11", "clamp-closed 7"),
    (f"G0 Z5|M10|{POLYGON}|M11", "clamp-closed 7"),
    (f"M10|G0 Z10|{ON_FACE}|G0 C0", ""),
    (f"M10|{FLAT}|G0 C0", "", "M10"),
    (f"G0 Z5|M10|{POLYGON}", "", "M12"),
    (f"M10|G0 C180|{FLAT}", "clamp-closed 6", "M12"),
]


@pytest.mark.parametrize("case", CLAMPED)
def test_c_turns_only_where_its_clamp_is_open(case, proof_of, tmp_path):
    blocks, expected, *drag = case
    settings = {"C_CLAMP_SHAPES": drag[0]} if drag else {}
    changed = with_clamp("lathe_mm", tmp_path, **settings)
    judged = proof_of("lathe", blocks, changed=changed).judged
    found = [f"{each.code} {each.line}" for each in judged if "clamp" in each.code]
    assert ", ".join(found) == expected


RUNS = [  # a program, the axis along which a run is beside its path, what is found
    ("mill", P, "Y", "uncut 6, wall-run 6"),
    ("lathe", HEXAGON, "X", "path-off 7"),
    ("lathe", "G0 X46 Z-30|G7.1 C20|G1 X36 F200|C90|X46|G7.1 C0", "Z", "path-off 7"),
]


@pytest.mark.parametrize(("beginning", "blocks", "axis", "found"), RUNS)
def test_a_run_beside_its_path_is_found(beginning, blocks, axis, found, proof_of, codes):
    axes = "XYZ" if beginning == "mill" else "XZC"
    samples = samples_of(proof_of(beginning, blocks).subject.path, 8000, axes=axes)
    assert codes(beginning, blocks, samples=samples) == ""
    samples.axes[axis] += 0.03
    assert codes(beginning, blocks, samples=samples) == found


@pytest.mark.parametrize(
    ("pocket", "found"),
    [("G13 I17 Z-3 D4", "core-remains 6, rapid-through 7, rapid-through 8"), (P, "")],
)
def test_a_run_that_rounds_the_corner_of_a_retract_is_found_if_it_cuts(
    pocket, found, proof_of, codes
):
    blocks = f"{pocket}|G0 Z2|X100"
    subject = proof_of("mill", blocks).subject
    samples = samples_of(subject.path, 8000)
    leaving = samples.time > subject.path.time[subject.path.vertices(len(subject.moves) - 1).start]
    samples.axes["Z"] -= leaving * np.clip(5 - samples.axes["X"] / 3, 0, 5)
    assert codes("mill", blocks, samples=samples) == found


@pytest.mark.parametrize("c", [-300, 361, 660])
def test_a_wall_of_a_groove_at_any_turn_of_c(c, codes):
    groove = f"{GROOVE.replace('C60', f'C{c}')}|G7.1 C0"
    assert codes("lathe", f"{groove}|G0 Z5") == "rapid-through 10"
    assert codes("lathe", f"{groove}|G0 X60|Z5|C{c - 720}") == ""
    assert codes("lathe", f"{groove}|G0 C{c}|X60") == ""


@pytest.mark.parametrize("change", ["T4 M6|G43", "T4 M6 G43", "G43 H4|T4 M6"])
@pytest.mark.parametrize("system", ["G54", "G55"])
def test_with_a_work_offset_no_z_is_known_before_the_first_one(system, change, codes):
    offsets = {5220: 1} | {first + axis: -99.7 for first in (5221, 5241) for axis in range(3)}
    blocks = f"{system}|{change}|S900 M3|G0 X0 Y0|X5|Z1|X0|{LOW}"
    assert codes("any mill", blocks, parameters=offsets) == ""


def test_cuts_are_listed_as_they_are_run(proof_of):
    blocks = f"G0 Z10|{ON_FACE}|G0 X60 Z5|{POLYGON}|G0 Z2 C0|{FLAT}|G0 Z10|{AROUND}"
    lines = as_text(proof_of("lathe", blocks), MM).splitlines()[:4]
    assert [line.split()[1] for line in lines] == ["6", "8", "10", "19"]


def test_the_depth_of_a_groove_is_its_x_word(proof_of):
    blocks = f"{ELSEWHERE}|X44|Z-20|G7.1 C20|G1 X36|Z-30|X44|G7.1 C0"
    assert ", on the contour, to X36 " in as_text(proof_of("any lathe", blocks), MM)


MOVED = "positions below are the machine's; the program's zero is at machine"
AT_X10 = "X0, the spindle's axis, is at machine X10\n"
SAID = [  # a program, and a part of its report
    ("lathe", f"{FLAT}|{FLAT}",
     "line 13: C is where line 11 left it, turned by −39.8° against the cut of line 5: G0"),
    ("lathe", f"G0 Z5|{POLYGON}|{FLAT}",
     "line 7: C is where line 6 left it, turned by 30° against the cut of line 6: G0"),
    ("lathe", f"{FLANK}|X44|G7.1 C0|G0 Z2|X60|{FLAT}",
     "line 13: C is where line 10 left it: the contour begins turned on the part by 90°; G0"),
    ("any lathe", f"T1 M6|G0 X60 Z2|{FLAT}", "its zero line is where C is, at 0°"),
    ("radii", SLOT, "C turns in place at the centre, by 360° in all: there the tool rubs for 1 s"),
    ("lathe", "G12.1|G1 X100 F2000|G42 X60|Z-5|C-30|X-60|C30|X60|C0|Z2|G40 X100|G13.1",
     "the tool is inside the closed contour, it comes from outside: G41? "
     "(else go inside before the line with G42)"),
    ("any lathe", f"o7 sub|G0 C#1|{FLAT.replace('G41', 'G42')}|o7 endsub|T1 M6|G0 X60 Z2|"
     "o7 call [0]|o7 call [180]",
     "line 4 (2 times): the tool crosses the contour on its way in: G41?"),
    ("any lathe", f"o7 sub|{FLAT}|o7 endsub|T1 M6|G0 X60 Z2 C0|o7 call",
     "lines 3 to 9, called in line 14: G12.1\n"),
    ("mill", "G0 Z-4|G13 I9 Z-3 D4", "its depth Z−3 lies above Z−4, where the tool comes from"),
    ("mill", "G91|G13 I9 Z3 D4", "its depth Z4 lies above Z1"),
    ("lathe", FLAT.replace("Z-5", "Z5"), "its contour at Z5 lies above Z2"),
    ("lathe", f"T3 M6|G0 X60 C0|{FLAT}",
     "the driven tool does not turn: no M3 or M4 with an S is in force here, M5 and M6 end it; "),
    ("mill", f"G0 Z-4|{LOW}",
     "a hole of radius 5 mm at X0 Y0 Z−4 counts as bored before: a rapid"),
    ("yasnac", R38,
     "a hole of radius 38 mm at X0 Y0 Z−5 counts as bored before: its word R or J names it"),
    ("mill", f"G0 X60 Z10|Z-4|{RING}|G0 Z10|X0|Z-4|{RING}",
     "goes into it (also in line 11); --stock"),
    ("radii", "G12.1|G1 X30 F800|X[#<_x>-5]|G13.1",
     "line 5: nothing of the section is judged: its contour cannot be read from the words, line 7 "
     "asks for a position"),
    ("mill", "G10 L1 P6 R5.1|G12 I7 K20 Q6 Z-3 D6",
     "the loaded tool T4 (⌀ 10) is not D6 (⌀ 10.2): measured with the cutter of D6"),
    ("any mill", "G10 L1 P4 R0|T4 M6|G0 X0 Y0 Z1|G13 I9 Z-2 D3",
     "T4 has no diameter: measured with the diameter of D3"),
    ("lathe", "G0 X60 Z5|G1 Z4 C9 F500|Z5", "alone: the part's edge sees 2408.657 mm/min\n"),
    ("mill", f"{HIGH}|G0 X3000|{HIGH}", "the X axis would go to 3004, its limit is 500 mm"),
    ("mill", f"G10 L2 P1 X2 Z-30|G0 X0 Y0 Z1|{LOW}", f"{MOVED} X2 Y0 Z−30"),
    ("mill", f"G10 L2 P1 X2 R30|G0 X0 Y0 Z1|{LOW}", f"{MOVED} X2 Y0 Z0, its axes turned by 30°"),
    ("mill", f"G10 L2 P1 R-30|G0 X0 Y0 Z1|{LOW}", f"{MOVED} X0 Y0 Z0, its axes turned by −30°"),
    ("mill", f"G92 X-2 Y0 Z31|{LOW}", f"{MOVED} X2 Y0 Z−30"),
    ("radii", f"G10 L2 P1 X10 Z-90 C30|G0 X18 Z2 C0|{SLOT}", f"{MOVED} Z−90; {AT_X10}"),
    ("radii", "G10 L2 P1 X10 Z-90 C30|G0 X23 Z2 C0|G7.1 C20|G1 Z-40 C60 F250|G7.1 C0", AT_X10),
    ("any lathe", f"{ELSEWHERE}|X44|Z-20|G7.1 C20|G1 X36|Z-30|G7.1 C0|G0 Z5",
     "a rapid goes through material, from X36 C0 Z−"),
    ("any lathe", f"{ELSEWHERE}|Z9|{FACE_HOLE.replace('[20]', '[0]')}|G0 X30|Z-1",
     "line 9: a rapid goes down into 27.337 mm² of material, at X30 C0 Z−1\n", "40"),
    ("lathe", f"{BEGIN}|{SIDES}|{END}", "  from centre     programmed 13.5 to "),
    ("lathe", f"{BEGIN.replace('C25', 'C12')}|{SIDES}|{END}", "programmed 13.5 to 15.58"),
    ("lathe", f"{BEGIN}|{SIDES}|{END}", "  across flats    programmed 27, reached 27"),
    ("mill", RING, "  core            radius 10.2 mm, by design of a single ring"),
    ("mill", CLEARED, "  left inside     0 mm²"),
    ("mill", f"{P}|G13 X60 I7 K20 Q6 Z-3|G0 Z2",
     "line 7: a rapid goes through material, from X15.372 Y0 Z−3 to "),
    ("lathe", f"G8 G0 X30|G12.1|G1 X20 F900|Z-5|Z2|G13.1|G7|G0 X60 C0|{FLAT}|G0 X20 Z-4|X12",
     "line 22: a rapid goes through material, from X20 C−39.806 Z−4 to X12 "),
    ("lathe", f"{FLAT}|G0 X22 Z-4|X9 G8|X8", "through material, from X11 C−39.806 Z−4 to X9 C"),
    ("mill", "G12 I20 Z-1 D6",
     "the loaded tool T4 (⌀ 10) is not D6 (⌀ 20): the wall comes out at radius 15, not 20"),
    *(("mill", P, f"it plunges with {share} % of the cutter into the stock, at X0 Y0", stock)
      for stock, share in (("100x80x20", 100), ("100x80x20@0,0", 25), ("bore 8", 36))),
    ("lathe", NARROW, "of the cutter into the stock, at X39 C6\n", "40"),
    ("lathe", f"G0 Z5|{FLATS}", "422.852 mm² of the bar remain beyond the contour at Z−4", "60"),
    ("lathe", f"G0 Z5|{POLYGON.replace('600', '600000')}", "line 6: a feed of 600000 mm/min"),
    ("mill", f"{LOW}|G0 Z1|X9|{LOW}|G0 Z1|X12|{LOW}",
     "line 12: its cut at X12 Y0 and that of line 6 at X0 Y0"),
    ("mill", f"{LOW}|G0 Z1|X80|{LOW}", "\n\nverdict: good, 1 not judged"),
    ("any mill", f"T4 M6 G43 H0|S900 M3|G0 X0 Y0 Z1|{LOW}",
     "no tool length is in force (no G43, H0"),
    ("mill", P, "the lowest cut is 1 mm below the block", "100x80x2 bore 12"),
    ("mill", f"X80|Z-3|X30|G0 Z1|X0|{P}", "line 8: a rapid goes through material, from X54.752 Y0 ",
     "100x80x20"),
    ("mill", f"Z-3|{P}", "line 6: a rapid goes down into 76.969 mm² of material", "100x80x20"),
]  # fmt: skip


@pytest.mark.parametrize("case", SAID, ids=lambda case: case[2][:60])
def test_what_a_report_says(case, proof_of):
    beginning, blocks, said, *stock = case
    assert said in as_text(proof_of(beginning, blocks, *stock), MM, full=True)


@pytest.mark.parametrize(("blocks", "bar"), [(FLAT, 80), (FLAT.replace("|Z-5", ""), 40)])
def test_how_much_of_the_bar_remains(blocks, bar, proof_of):
    (found,) = (e for e in proof_of("lathe", blocks, str(bar)).judged if e.code == "bar-remains")
    radius, length = bar / 2, 50 if "Z-5" in blocks else 0
    segment = radius**2 * math.acos(13.5 / radius) - 13.5 * math.sqrt(radius**2 - 13.5**2)
    assert segment - 21 * length - 1 < found.values["area"] < segment - 12 * length + 1  # the leads


def test_what_a_flat_and_a_small_circle_have_not(proof_of):
    assert "across flats" not in as_text(proof_of("lathe", FLAT), MM, full=True)
    assert "  core  " not in as_text(proof_of("mill", "G13 I9 Z-3 D4"), MM, full=True)


def test_a_picture_shows_what_is_uncut_and_where_findings_are(proof_of):
    marks = scene_of_proof(proof_of("mill", "G12 I7 K40 Q15 Z-3 D5|G0 Z1")).marks
    assert [(each.code, each.line) for each in marks.signs] == [("wrong-cutter", 6)]
    assert [each.line for each in marks.uncut] == [6] and marks.uncut[0].values["shape"].area > 100
    (air,) = scene_of_proof(proof_of("mill", "G13 I9 Z3 D4")).marks.signs
    assert air.code == "cuts-air"
    (crossed,) = (
        each
        for each in scene_of_proof(proof_of("lathe", FLAT.replace("G41", "G42"))).marks.signs
        if each.code == "side-crossed"
    )
    assert crossed.place == pytest.approx((30, 0, 2))


def test_a_random_tool_changer_keeps_the_loaded_tools_size_in_a_preview(codes):
    changed = {"EMCIO": {"RANDOM_TOOLCHANGER": "1"}}
    assert codes("mill", f"G10 L1 P3 R3.1|{LOW}", changed=changed) == "tool-table-set 6"


def test_nothing_is_said_of_the_spindle_where_there_are_several(codes):
    blocks = f"T4 M6 G43|S900 M3 $1|G0 Z1|{LOW}"
    assert codes("any mill", blocks, changed={"TRAJ": {"SPINDLES": "2"}}) == ""


def test_plot_says_once_that_the_spindle_stands(tmp_path, capsys):
    program = tmp_path / "program.ngc"
    program.write_text(f"G21 G90 F600|T4 M6|G0 Z1|{LOW}|{LOW}|M2|".replace("|", "\n"))
    words = ["--ini", str(SIM / "mill_mm_headless.ini"), "-o", str(tmp_path / "picture.svg")]
    assert main(["plot", str(program), *words]) == 0
    said = capsys.readouterr().out.splitlines()
    assert [line[:13] for line in said if "spindle does not turn" in line] == ["note, line 4:"]


def test_c_beside_x_has_another_feed_at_the_edge_of_the_part(proof_of):
    judged = proof_of("lathe", "G1 X50 C90 F500").judged
    (native,) = (each for each in judged if each.code == "native-c")
    assert native.line == 5 and native.values["feeds"][1] > 1000


@pytest.mark.parametrize(
    ("beginning", "blocks", "stored", "expected"),
    [
        ("any lathe", "G28|G28", "", "place-not-set 2"),
        ("any lathe", "G28|G28", "5163\t-12.5\n", ""),
        ("any mill", "G28|G28", "", ""),
        ("any lathe", "G28.1|G28|G30", "", "place-not-set 4"),
    ],
)
def test_a_g28_whose_place_was_never_set_is_noted_on_a_lathe(
    beginning, blocks, stored, expected, codes, tmp_path
):
    (tmp_path / "own.var").write_text(stored)
    changed = {"RS274NGC": {"PARAMETER_FILE": str(tmp_path / "own.var")}}
    assert codes(beginning, blocks, changed=changed) == expected


FAR = "G0 X{} Z1|G12 I20 Z-1 D4"  # its axes have limits of -500 and 500
TRAVEL = [  # what the var file holds, a program, the axis that is beyond and where it would be
    (None, FAR.format(490), "travel-unplaced, travel-perhaps X505"),
    (None, "G0 X0 Z1|G12 I520 Z-1 D4", "travel X515, travel Y515"),
    ({}, "G55|" + FAR.format(0), "travel-unplaced"),
    ({5221: 10}, "G55|" + FAR.format(0), "travel-unplaced"),
    ({5221: 10, 5241: 10}, "G55|" + FAR.format(0), ""),
    ({5221: 100}, FAR.format(490), "travel X605"),
    ({5221: -100}, FAR.format(490), ""),
    ({5221: -1000}, FAR.format(490), "travel X-525"),
    ({5221: -1000}, "G10 L2 P1 X480|" + FAR.format(10), "travel X505"),
    ({5221: -900, 5241: 10}, "G55|" + FAR.format(480), "travel X505"),
    ({5221: 10, 5241: -900}, FAR.format(480), "travel X505"),
    *(({5221: 210}, f"{code}|{FAR.format(280)}", "travel X505")
      for code in ("G92.1", "G10 L1 P6 R10", "G92.2")),
    *(({5221: -200}, f"{code}|{FAR.format(490)}", "")
      for code in ("G92.1", "G10 L1 P6 R10", "G92.2")),
    ({5210: 1, 5211: 10}, FAR.format(480), "travel X505"),
    ({5210: 1, 5211: 10}, "G92.1|" + FAR.format(480), "travel-unplaced"),
    ({5221: 1, 5230: 90}, FAR.format(490), "travel Y505"),
    ({31: 1}, "o1 if [#31 GT 0]|G0 X5|G0 X6|o1 endif|" + FAR.format(490), "travel-unknown"),
]  # fmt: skip


@pytest.mark.parametrize(("stored", "blocks", "expected"), TRAVEL)
def test_the_travel_with_the_offsets_of_the_var_file(stored, blocks, expected, proof_of, tmp_path):
    changed = None
    if stored is not None:
        values = {5220: 1, **stored}
        (tmp_path / "its.var").write_text("".join(f"{n} {values[n]}\n" for n in sorted(values)))
        changed = {"RS274NGC": {"PARAMETER_FILE": str(tmp_path / "its.var")}}
    judged = proof_of("mill", blocks, changed=changed).judged
    found = [(each.code, each.values) for each in judged if "travel" in each.code]
    reported = [
        f"{code} {v['axis']}{v['position']:.0f}" if "axis" in v else code for code, v in found
    ]
    assert ", ".join(reported) == expected
