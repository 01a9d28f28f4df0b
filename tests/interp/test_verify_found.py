# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs of machinists: those that break a tool are found, valid ones are good.

Each is a whole program on a simulated machine with its stock, and the codes that ``verify`` must
report, among others (``found``), or that it must not have any finding (``found`` empty).
"""

import pytest

from g12.tools.machine.ini import read_ini
from g12.tools.verify.proof import StockText, prove
from support.sim_machines import SIM

INCH = "G20 G17 G40 G49 G54 G80 G90 G94 G64 P.001\nT1 M6 G43\nS3000 M3\n"
METRIC = "G21 G17 G40 G49 G54 G80 G90 G94 G64 P.01\nT10 M6 G43\nS3000 M3\n"  # 20 mm
FACE = "G21 G18 G7 G40 G90 G94 G64 P.01\nT1 M6\n"  # 12 mm, X is a diameter
POCKET = "G13 I.2 K.45 Q.2 Z-.3 D1 F20\n"
HEXAGON = """G0 X70 Z2 C0
G12.1
G1 G41 X27 F1000
Z-5 F300
C-7.7942 F1000
X0 C-15.5885
X-27 C-7.7942
C7.7942
X0 C15.5885
X27 C7.7942
C0
G40 X70
Z2
G13.1
"""
GROOVE = "G0 X60 Z-20 C0\nG7.1 C25\nG1 X48 F200\nG1 Z-40 C60 F250\n"


@pytest.fixture
def codes(tmp_path):
    """Return a function: the codes of the findings and notes of a program."""

    def judged(text, machine, stock=None):
        program = tmp_path / "program.ngc"
        program.write_text(text + "M2\n")
        ini = read_ini(SIM / f"{machine}_headless.ini")
        proof = prove(program, ini, stock=StockText(stock) if stock else None)
        return [(each.code, each.is_finding) for each in proof.judged]

    return judged


def findings(judged):
    return [code for code, is_finding in judged if is_finding]


# ---------------------------------------------------------------- rapids through material


@pytest.mark.parametrize("level", ["-.01", "-.1", "-.3"])
@pytest.mark.parametrize("before", [0, 1])
def test_a_lost_minus_sign_between_two_pockets(level, before, codes):
    good = "".join(f"G0 X{-2 - 2 * k} Z.1\n{POCKET}G0 Z.1\n" for k in range(before))
    text = INCH + "G0 X0 Y0 Z.1\n" + good + f"G0 X0\n{POCKET}G0 Z{level}\nX2\n{POCKET}G0 Z.1\n"
    assert findings(codes(text, "mill_inch"))
    right = text.replace(f"G0 Z{level}\nX2", "G0 Z.1\nX2")
    assert findings(codes(right, "mill_inch")) == []


@pytest.mark.parametrize("stock", ["200x200x20", "200x200x20 bore 30"])
def test_a_traverse_into_solid_stock(stock, codes):
    text = METRIC + "G0 X0 Y0 Z2\nG1 Z-5 F100\nG12 I40 R38 D10 F300\nG0 Z2\n"
    assert findings(codes(text, "mill_yasnac_mm", stock))
    assert findings(codes(text, "mill_yasnac_mm", "200x200x20 bore 80")) == []


def test_a_plunge_by_rapid_is_an_assumption_or_a_finding(codes):
    text = INCH + "G0 X0 Y0 Z.1\nG0 Z-.3\nG13 I.2 K.45 Q.2 D1 F20\nG0 Z.1\n"
    judged = codes(text, "mill_inch")
    assert findings(judged) == [] and any("bored" in code for code, _ in judged)
    assert findings(codes(text, "mill_inch", "4x4x1"))
    assert findings(codes(text, "mill_inch", "4x4x1 bore .7")) == []


def test_a_rapid_through_a_finished_hexagon(codes):
    assert findings(codes(FACE + HEXAGON + "G0 X70 Z5 C0\n", "lathe_mm")) == []
    assert findings(codes(FACE + HEXAGON + "G0 X70 Z-3\nX0\nZ5\n", "lathe_mm"))


DRILLED = "G0 X70 Z5\no<side_holes> call [1] [-30] [0] [-9999] [60] [8] [2] [120] [0] [0] [0]\n"


def test_a_tool_on_the_face_and_in_the_side_is_judged_beside_both(codes):
    valid = codes(f"{FACE}{HEXAGON}G0 X70 Z5 C0\nX80\n{DRILLED}", "lathe_mm")
    assert findings(valid) == []
    assert ("rapid-turned", False) in valid
    assert findings(codes(f"{FACE}{HEXAGON}G0 X70 Z5 C0\n{DRILLED}G0 X0\n", "lathe_mm", "60"))
    program = FACE + HEXAGON + "G0 X70 Z-3\nX0\nZ5\n" + HEXAGON + DRILLED
    assert findings(codes(program, "lathe_mm"))


def test_c_turned_by_rapid_at_depth(codes):
    slot = "G0 X40 Z2 C0\nG12.1\nG1 Z-2 F200\nX20 F600\nG13.1\n"
    assert findings(codes(FACE + slot + "G0 C180\nZ2\n", "lathe_mm"))
    assert findings(codes(FACE + slot + "G0 Z2\nC180\n", "lathe_mm")) == []


@pytest.mark.parametrize("end", ["G0 Z5\n", "G0 C0\n", "G0 C420\n"])
def test_a_cylinder_without_a_retract(end, codes):
    assert findings(codes(FACE + GROOVE + "G7.1 C0\n" + end, "lathe_mm"))
    right = FACE + GROOVE + "G0 X60\n".replace("G0", "G1") + "G7.1 C0\n" + end
    assert findings(codes(right, "lathe_mm")) == []


@pytest.mark.parametrize("c", [-660, -300, 60, 200, 361, 400, 540, 660, 720, 1100])
def test_a_wall_of_a_groove_at_any_turn_of_c(c, codes):
    groove = FACE + GROOVE.replace("C60", f"C{c}") + "G7.1 C0\n"
    assert findings(codes(groove + "G0 Z5\n", "lathe_mm")) == ["rapid-through"]
    assert findings(codes(groove + f"G0 X60\nZ5\nC{c - 720}\n", "lathe_mm")) == []
    assert findings(codes(groove + f"G0 C{c}\nX60\n", "lathe_mm")) == []


def test_the_first_move_into_the_bar(codes):
    text = FACE + "G0 X10 Z-3 C0\nG12.1\nG1 X20 F600\nZ2\nG13.1\n"
    assert findings(codes(text, "lathe_mm", "30"))


HOLES = "o<side_holes> call [4] [-15] [0] [90] [{surface}] [6] [2] [100] [0] [.1] [0]\n"
SIDE = FACE + "G0 X60 Z10 C0\nZ-15\n"


@pytest.mark.parametrize(
    "text", [HOLES.format(surface=30), "X10\nX60\n" + HOLES.format(surface=40)]
)
def test_a_rapid_into_the_bar_from_the_side(text, codes):
    assert findings(codes(SIDE + text + "G0 X80\n", "lathe_mm", "40")) == ["rapid-into"]
    assert findings(codes(SIDE + text + "G0 X80\n", "lathe_mm", "9")) == []


def test_a_rapid_into_the_bar_between_cuts_of_one_tool_on_the_face_and_in_the_side(codes):
    groove = "G0 X70 Z-20 C0\nX{x}\nG7.1 C25\nG1 X36 F200\nZ-40 C60\nX70\nG7.1 C0\n"
    assert findings(codes(FACE + HEXAGON + groove.format(x=36), "lathe_mm", "50")) == ["rapid-into"]
    assert findings(codes(FACE + HEXAGON + groove.format(x=56), "lathe_mm", "50")) == []


def test_a_rapid_into_the_bar_before_a_groove(codes):
    into = FACE + GROOVE.replace("C0\n", "C0\nX44\n", 1) + "G1 X60\nG7.1 C0\n"
    assert findings(codes(into, "lathe_mm", "50")) == ["rapid-into"]
    assert findings(codes(into.replace("X44", "X52"), "lathe_mm", "50")) == []


@pytest.mark.parametrize(("depth", "found"), [("Z-15", []), ("Z-5", ["rapid-into"])])
def test_a_bar_is_known_from_the_side_below_what_is_cut_from_the_face(depth, found, codes):
    holes = "T2 M6\nG0 X70 Z-3 C0\n" + HOLES.format(surface=30).replace("-15", "-3") + "G0 X80\n"
    hexagon = HEXAGON.replace("Z-5", depth)
    judged = codes(FACE + hexagon + "G0 X70 Z5\n" + holes, "lathe_mm", "40")
    assert findings(judged) == found and (("rapid-after-cuts", False) in judged) is not bool(found)


# ---------------------------------------------------------------- valid programs


def test_a_finishing_pass_after_a_helix(codes):
    text = (
        METRIC.replace("T10", "T4")
        + "G0 X0 Y0 Z1\nG13 I9 K18 Q4 Z-3 D4 F500\nG13 I18 F300\nG0 Z5\n"
    )
    assert findings(codes(text, "mill_helix_mm")) == []


def test_two_flats_in_one_section_round_the_outside_of_the_bar(codes):
    flat = "G1 G41 X{x} C25 F1000\nZ-5 F300\nC-25 F1000\nG40 X{o}\nZ2\n"
    text = FACE + "G0 X80 Z2 C0\nG12.1\nG1 C25 F2000\n" + flat.format(x=27, o=80)
    text += (
        "C-45\nX-80\nC-25\n"
        + "G1 G41 X-27 F1000\nZ-5 F300\nC25 F1000\nG40 X-80\nZ2\nG13.1\nG0 Z5\n"
    )
    assert findings(codes(text, "lathe_mm", "40")) == []


@pytest.mark.parametrize("machine", ["mill_inch", "lathe_mm"])
def test_home_at_the_end_with_a_stock(machine, codes):
    if machine == "mill_inch":
        text, stock = INCH + "G0 X0 Y0 Z.1\n" + POCKET + "G0 Z.1\nG53 G0 Z0\n", "4x4x1"
    else:
        text, stock = FACE + HEXAGON + "G53 G0 X200\nG53 G0 Z0\n", "40"
    assert findings(codes(text, machine, stock)) == []
