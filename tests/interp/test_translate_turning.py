# SPDX-License-Identifier: GPL-2.0-or-later
"""Turning cycles: what their moves cut, judged from the moves and from the contour alone."""

import random

import numpy as np
import pytest

from g12.tools.path.part import arc_points
from g12.tools.translate.program import translate_program
from support.foreign_programs import assert_same_part, control_of, kept_tracer_of, near

HEAD = {"fanuc-lathe": "G21 G99 G97 S500 M3 F.2\n", "haas-lathe": "G20 G99 G97 S500 M3 F.01\n"}
GRID = 0.02  # mm
AIR = 15  # cells between the start and the stock
SLIP = 0.002  # mm, what the grid can miss at a slope
STEPS = 0.01  # mm between the points of a move


tracer = kept_tracer_of("fanuc-lathe")


def moves_of(tracer, text, control="fanuc-lathe"):
    """Return the moves of a foreign program, which must be translated and read to its end."""
    result = translate_program(f"{text}\nM30\n", control_of(control))
    assert result.refused == []
    return traced_moves(tracer, result.text)


def traced_moves(tracer, text):
    """Return the moves of LinuxCNC's text."""
    traced = tracer.trace_text(text, alone=True)
    assert traced.error is None, traced.error
    return traced.moves


def points_of(move):
    """Return points of a move as Z + X * 1j, X a radius."""
    if move.kind == "arc":
        count = max(3, int(abs(complex(*np.subtract(move.end, move.start)[[2, 0]])) / STEPS * 2))
        found = arc_points(move, np.linspace(0, 1, count))
        return found[:, 2] + 1j * found[:, 0]
    start, end = (complex(place[2], place[0]) for place in (move.start, move.end))
    return start + (end - start) * np.linspace(0, 1, max(2, int(abs(end - start) / STEPS)))


class Part:
    """A contour with its allowance in cells along the cuts: how deep it is where, low and high."""

    def __init__(self, tracer, contour, allowance, along_x, outside):
        drawn = traced_moves(tracer, f"G7 G18 G21 G90 G94 F99\n{contour}\nM2\n")[2:]
        drawn = drawn[: -1 if drawn[-1].kind == "rapid" else None]  # the way back is no contour
        self.along_x, self.outside, self.first = along_x, outside, 0
        cells, depths = self.seen(np.concatenate([points_of(m) for m in drawn]) + allowance)
        self.first = cells.min()
        self.low, self.high = (np.full(np.ptp(cells) + 1, end) for end in (np.inf, -np.inf))
        np.minimum.at(self.low, cells - self.first, depths)
        np.maximum.at(self.high, cells - self.first, depths)

    def seen(self, points):
        """Return the cells of points and their depths, which grow away from the part."""
        along, depth = (points.real, points.imag)[:: -1 if self.along_x else 1]
        return np.round(along / GRID).astype(int) - self.first, depth * (1 if self.outside else -1)


def beside(values, extreme):
    """Return the extreme of each cell and the two beside it."""
    wide = np.pad(values, 1, mode="edge")
    return extreme(extreme(wide[:-2], wide[2:]), values)


def check_roughing(part, moves, depth, start):
    """Assert what roughing must be; return what is uncut before the last cut along the contour."""
    (first,), (top,) = part.seen(np.array([start]))
    uncut = np.full(len(part.low), top)
    uncut[min(first, len(uncut) - 1) - AIR :] = -np.inf
    at_start = [n for n, move in enumerate(moves[:-1]) if points_of(move)[-1] == near(start)]
    floor = beside(part.low, np.minimum)
    before = None
    for number, move in enumerate(moves):
        before = uncut.copy() if number == at_start[-1] + 1 else before
        cells, depths = part.seen(points_of(move))
        inside = (cells >= 0) & (cells < len(uncut))
        cells, depths = cells[inside], depths[inside]
        assert (depths >= floor[cells] - SLIP).all(), ("into the contour", move)
        thin = beside(uncut, np.minimum)[cells]
        if move.kind == "rapid":
            assert (depths >= thin - SLIP).all(), ("a rapid in material", move)
        elif number <= at_start[-1]:
            assert (thin - depths <= depth + SLIP).all(), ("too deep a cut", move)
        np.minimum.at(uncut, cells, depths)
    assert (uncut <= part.high + 0.03).all(), "left after the last cut"
    return before


CONTOURS = [  # control's blocks P to Q, the same as LinuxCNC's, start, cycle, depth, allowance
    pytest.param(
        "N10 G0 X20.\nG1 Z-10.\nX30. Z-15.\nG2 X40. Z-20. R5.\nN20 G1 X50.",
        "G0 X20 Z2\nG1 Z-10\nX30 Z-15\nG2 X40 Z-20 R5\nG1 X50",
        "G0 X50. Z2.", "G71 U2. R.5\nG71 P10 Q20 U.4 W.1 F.3", 2.0, 0.1 + 0.2j, False, True,
        id="outside",
    ),
    pytest.param(
        "N10 G1 X0\nG1 Z0\nG3 X30. Z-15. R15.\nG1 W-5.\nU4. W-2.\nN20 X46.",
        "G1 X0 Z1\nZ0\nG3 X30 Z-15 R15\nG1 Z-20\nX34 Z-22\nX46",
        "G0 X46. Z1.", "G71 U1.5 R1.\nG71 P10 Q20 U.5 W0 F.3", 1.5, 0.25j, False, True,
        id="round",
    ),
    pytest.param(
        "N10 G0 X40.\nG1 Z-6.\nG3 X36. Z-8. R2.\nG1 X32.\nX30. Z-9.\nZ-20.\nN20 X18.",
        "G0 X40 Z2\nG1 Z-6\nG3 X36 Z-8 R2\nG1 X32\nX30 Z-9\nZ-20\nX18",
        "G0 X18. Z2.", "G71 U1. R.5\nG71 P10 Q20 U-.4 W.1 F.3", 1.0, 0.1 - 0.2j, False, False,
        id="bore",
    ),
    pytest.param(  # as Haas programs have it: the last block is the way back
        "N10 G0 G42 X-1. Z2.\nG1 Z0.\nX28.\nX30. Z-1.\nZ-20.\nX50.\nN20 G0 G40 Z2.",
        "G0 X-1 Z2\nG1 Z0\nX28\nX30 Z-1\nZ-20\nX50\nG0 Z2",
        "G0 X50. Z2.", "G71 U2. R.5\nG71 P10 Q20 U.4 W.1 F.3", 2.0, 0.1 + 0.2j, False, True,
        id="haas",
    ),
    pytest.param(
        "N10 G0 X40. Z1.\nG1 Z-5.\nX30. Z-10.\nZ-14.\nG2 X40. Z-19. R5.\nG1 X44. Z-20.\n"
        "G2 X44. Z-30. R8.\nN20 G1 X50.",
        "G0 X40 Z1\nG1 Z-5\nX30 Z-10\nZ-14\nG2 X40 Z-19 R5\nG1 X44 Z-20\nG2 X44 Z-30 R8\nG1 X50",
        "G0 X50. Z2.", "G71 U1.5 R.5\nG71 P10 Q20 U.4 W0 F.3", 1.5, 0.2j, False, True,
        id="pockets",
    ),
    pytest.param(
        "N10 G0 Z-12.\nG1 X30.\nX20. Z-8.\nG3 X10. Z-3. R5.\nN20 G1 Z2.",
        "G0 X52 Z-12\nG1 X30\nX20 Z-8\nG3 X10 Z-3 R5\nG1 Z2",
        "G0 X52. Z2.", "G72 W1.5 R.5\nG72 P10 Q20 U.4 W.2 F.3", 1.5, 0.2 + 0.2j, True, True,
        id="facing",
    ),
    pytest.param(  # the way back is over the collar, which is higher than the start
        "N10 G0 X22.\nG1 Z-10.\nX60.\nZ-20.\nX52. Z-25.\nN20 X56.",
        "G0 X22 Z2\nG1 Z-10\nX60\nZ-20\nX52 Z-25\nX56",
        "G0 X50. Z2.", "G71 U2. R.5\nG71 P10 Q20 U.4 W0 F.3", 2.0, 0.2j, False, True,
        id="collar",
    ),
    pytest.param(  # a level at the top of an arc, which rounding puts beyond it
        "N10 G0 X12.6\nG1 Z-9.\nG3 X12.6 Z-21. R7.5\nG1 Z-24.\nN20 X32.6",
        "G0 X12.6 Z2\nG1 Z-9\nG3 X12.6 Z-21 R7.5\nG1 Z-24\nX32.6",
        "G0 X30.6 Z2.", "G71 U1.5 R.5\nG71 P10 Q20 U0 W0 F.3", 1.5, 0.0, False, True,
        id="crest",
    ),
]  # fmt: skip


@pytest.mark.parametrize(
    ("blocks", "drawn", "start", "cycle", "depth", "allowance", "along_x", "outside"), CONTOURS
)
def test_roughing_leaves_the_allowance_and_finishing_is_the_contour(
    tracer, blocks, drawn, start, cycle, depth, allowance, along_x, outside
):
    first = traced_moves(tracer, f"G7 G18 G21 G90\n{start}\nM2\n")[-1].end
    corner = complex(first[2], first[0])
    moves = moves_of(tracer, f"{HEAD['fanuc-lathe']}{start}\n{cycle}\n{blocks}")[1:]
    part = Part(tracer, f"{start}\n{drawn}", allowance, along_x, outside)
    uncut = check_roughing(part, moves, depth, corner)
    assert moves[-1].end == near(first)
    high = beside(part.high, np.maximum)
    assert (uncut - high <= depth + SLIP).all()
    assert (uncut - high > depth / 2).any()  # the last level does not lie on the contour
    finished = moves_of(tracer, f"{HEAD['fanuc-lathe']}{start}\n{cycle}\n{blocks}\nG70 P10 Q20")
    expected = traced_moves(tracer, f"G7 G18 G21 G90 G94 F99\n{start}\n{drawn}\nM2\n")[1:]
    own = finished[len(moves) + 1 :][: len(expected)]
    assert len(own) == len(expected)
    for move, there in zip(own, expected):
        assert move.end == near(there.end)
        assert move.kind == there.kind
        if move.kind == "arc":
            assert move.centre == pytest.approx(there.centre, abs=0.001)
            assert move.turns == there.turns
    assert finished[-1].end == near(first)
    back = [points_of(move) for move in finished[len(moves) + len(own) :]]
    cells, depths = part.seen(np.concatenate(back) + allowance)
    inside = (cells >= 0) & (cells < len(part.low))
    assert (depths[inside] >= beside(part.low, np.minimum)[cells[inside]] - SLIP).all()


@pytest.mark.parametrize("seed", range(8))
def test_roughing_of_random_contours(tracer, seed):
    chance = random.Random(seed)
    z, rows = 1.0, []
    for _ in range(chance.randint(3, 9)):
        z -= chance.choice((0, 0.5, 2, 5)) * chance.random()
        rows.append(f"X{chance.uniform(10, 50):.3f} Z{z:.3f}")
    rows = [rows[0].split()[0] + " Z1.", *rows[1:], f"X52. Z{z - 1:.3f}"]
    text = "\n".join(["N10 G0 " + rows[0], "G1 " + rows[1], *rows[2:-1], f"N20 {rows[-1]}"])
    depth = chance.choice((0.7, 1.0, 2.3))
    start = "G0 X52. Z1."
    cycle = f"G71 U{depth} R.4\nG71 P10 Q20 U.3 W0 F.3"
    moves = moves_of(tracer, f"{HEAD['fanuc-lathe']}{start}\n{cycle}\n{text}")[1:]
    drawn = text.replace("N10 ", "").replace("N20 ", "")
    part = Part(tracer, f"{start}\n{drawn}", 0.15j, False, True)
    check_roughing(part, moves, depth, 1 + 26j)


SAME = [  # a control's blocks, and those of LinuxCNC that make the same moves
    ("fanuc-lathe", "G0 X50. Z2.\nG90 X46. Z-20.\nX42.\nX38. R-1.\nG0 X60.",
     "G0 X50 Z2\nX46\nG1 Z-20\nX50\nG0 Z2\nX42\nG1 Z-20\nX50\nG0 Z2\nX36\nG1 X38 Z-20\nX50\nG0 Z2\n"
     "X60"),
    ("fanuc-lathe-b", "G90 G0 X50. Z2.\nG77 X46. Z-20.\nG91 X-8.\nG0 X10.\nG90",
     "G0 X50 Z2\nX46\nG1 Z-20\nX50\nG0 Z2\nX42\nG1 Z-20\nX50\nG0 Z2\nX60"),
    ("fanuc-lathe-c", "G71\nG0 X50. Z2.\nG20 X46. Z-20.\nG24 X40. Z1.\nG0 X60.",
     "G21 G0 X50 Z2\nX46\nG1 Z-20\nX50\nG0 Z2\nZ1\nG1 X40\nZ2\nG0 X50\nX60"),
    ("fanuc-lathe", "G0 X50. Z2.\nG94 X20. Z0\nZ-1. R-.5\nG0 Z5.",
     "G0 X50 Z2\nZ0\nG1 X20\nZ2\nG0 X50\nZ-1.5\nG1 X20 Z-1\nZ2\nG0 X50\nZ5"),
    ("haas-lathe", "M24\nG0 X2. Z.1\nG90 X1.8 Z-1. I-.1\nG94 X1. Z-.1 K-.05\n"
     "G92 X1.7 Z-1. I-.2 F.1",
     "G0 X2 Z.1\nX1.6\nG1 X1.8 Z-1\nX2\nG0 Z.1\nZ-.15\nG1 X1 Z-.1\nZ.1\nG0 X2\nF.1\nX1.3\n"
     "G33 X1.7 Z-1 K.10163945\nG0 X2\nZ.1"),
    ("fanuc-lathe", "G0 X0 Z3.\nG74 R.5\nG74 Z-10. Q6000 F.1",
     "G0 X0 Z3\nF.1 G1 Z-3\nG0 Z-2.5\nG1 Z-9\nG0 Z-8.5\nG1 Z-10\nG0 Z3"),
    ("fanuc-lathe", "G0 X50. Z-5.\nG75 R1.\nG75 X40. Z-8. P3000 Q2000 F.1",
     "G0 X50 Z-5\nF.1\n" + "".join(
         f"G0 X50 Z{z}\nG1 X44\nG0 X46\nG1 X40\nG0 X50\n" for z in (-5, -7, -8)) + "Z-5"),
    ("haas-lathe", "G0 X2. Z-.2\nG75 X1.6 Z-.3 I.1 K.1 F.01",
     "G0 X2 Z-.2\nF.01\n" + "".join(
         f"G0 X2 Z{z}\nG1 X1.8\nG0 X1.9\nG1 X1.6\nG0 X2\n" for z in (-0.2, -0.3)) + "Z-.2"),
    ("fanuc-lathe", "G0 X30. Z5.\nG32 Z-10. F2.\nX32. Z-12.\nG0 X40.",
     "G0 X30 Z5\nF2\nG33 Z-10 K2\nG33 X32 Z-12 K2.23606798\nG0 X40"),
    ("fanuc-lathe", "G0 X40. Z5.\nG92 X29. Z-20. F2.\nX28.4 R-1.\nG0 X40.",
     "G0 X40 Z5\nF2\nX29\nG33 Z-18 K2\nG33 X33 Z-20 K2.82842712\nG0 X40\nZ5\n"
     "X26.4\nG33 X28.24 Z-18 K2.00159936\nG33 X32.24 Z-20 K2.82842712\nG0 X40\nZ5"),
]  # fmt: skip


@pytest.mark.parametrize(("control", "foreign", "own"), SAME)
def test_a_cycle_is_these_moves(tracer, control, foreign, own):
    unit = HEAD["haas-lathe" if control == "haas-lathe" else "fanuc-lathe"]
    head = unit if control in HEAD else unit.replace("G99", "G95").replace("G21 ", "")
    result = translate_program(f"{head}{foreign}\nM30\n", control_of(control))
    assert result.refused == []
    expected = f"G7 G18 G90 {unit.replace('G99', 'G95')}{own}\nM30\n"
    assert_same_part(
        tracer.trace_text(result.text, alone=True), tracer.trace_text(expected, alone=True)
    )


def test_m24_takes_the_chamfers_of_threads_away(tracer):
    text = f"{HEAD['haas-lathe']}G0 X1.4 Z.2\nM24\nG92 X1.2 Z-1. F.1\nM23\nG92 X1.1 Z-1. F.1"
    ends = [m.end[2] / 25.4 for m in moves_of(tracer, text, "haas-lathe") if m.kind == "feed"]
    assert ends == near((-1.0, -0.9, -1.0))


THREADS = [  # control, blocks, depths of the passes, shift of Z, lead
    ("fanuc-lathe", "G0 X32. Z5.\nG76 P020060 Q100 R.05\nG76 X28.16 Z-20. P920 Q300 F1.5",
     [0.3, 0.3 * 2**.5, *(0.3 * 2**.5 + 0.1 * n for n in range(1, 5)), 0.87, 0.92, 0.92],
     1 / 3**.5, 1.5),
    ("haas-lathe", "G0 X1.4 Z.2\nG76 X1.2 Z-1. K.05 D.02 F.1 A60",
     [25.4 * d for d in (0.02, 0.02 * 2**.5, 0.02 * 3**.5, 0.04, 0.02 * 5**.5, 0.02 * 6**.5, .05)],
     1 / 3**.5, 2.54),
]  # fmt: skip


@pytest.mark.parametrize(("control", "blocks", "depths", "shift", "lead"), THREADS)
def test_the_passes_of_a_thread_add_up_by_the_controls_rule(
    tracer, control, blocks, depths, shift, lead
):
    moves = moves_of(tracer, f"{HEAD[control]}{blocks}", control)
    start = moves[-1].end
    passes = [m for m in moves if m.kind == "feed" and m.end[0] == near(m.start[0])]
    full = passes[-1].start[0]
    assert [full + depths[-1] - m.start[0] for m in passes] == near(tuple(depths))
    for move, depth in zip(passes, depths):
        up = depths[-1] - depth
        assert move.start[2] == near(start[2] + up * shift)
    assert passes[-1].end[2] - moves[-1].end[2] < 0
    assert start[2] > 4
    assert {round(m.feed / lead, 6) for m in passes} == {1.0}


def test_the_chamfer_of_fanucs_g76_is_in_tenths_of_the_lead(tracer):
    cycle = "G0 X32. Z5.\nG76 P011060 Q100 R0\nG76 X28.16 Z-20. P920 Q920 F2."
    moves = moves_of(tracer, f"{HEAD['fanuc-lathe']}{cycle}")
    assert [m.end[2] for m in moves if m.kind == "feed"] == near((-18, -20))


REFUSED = [
    ("G71 U2. R.5\nG71 P10 Q30 U.4 W.1 F.3\nN10 G0 X20.\nN20 G1 X50.",
     "N30 is not in this program"),
    ("G71 U2. R.5\nG71 P10 Q20\nN10 G0 X20.\n/G1 Z-9.\nN20 X50.", "line 6 in the contour: /"),
    ("G71 U2. R.5\nG71 P10 Q20 U-.4\nN10 G0 X20.\nG1 Z-9.\nN20 X50.",
     "the allowance U or W has the"),
    ("G71 U2. R.5\nG71 P10 Q20\nN10 G0 X20.\nG1 Z-9.\nX30. Z-5.\nN20 X50. Z-10.",
     "line 7: the contour goes back in Z"),
    ("G71 P10 Q20 U.4\nN10 G0 X20.\nG1 Z-9.\nN20 X50.", "G71 needs a depth of cut above 0"),
    ("G71 U2. R.5\nG71 P10 Q20\nN10 G0 X20.\nG1 Z#1\nN20 X50.",
     "line 6 in the contour: Z#1: a turning"),
    ("G71 U2. R.5\nG71 P10 Q20\nN10 G0 X20.\nG2 X30. Z-9. R1.\nN20 X50.",
     "line 6 in the contour: R1 is too small"),
    ("M6", "M6 without T: the turret turns by T alone, take it out"),
    ("G92 X20. Z-5. F#1", "a thread needs F, its lead, as a number"),
    ("G76 X20. Z-5. P500 F1.", "the thread's height and the depth of its first pass"),
    ("G71 U2.\nG71 P1 Q2\nN1 G0 X20.\nG1 Z-9. R2.\nN2 X50.",
     "line 6 in the contour: R beside G1: write"),
    ("G1 X20. I1.", "I beside G1: write the corner's line or arc"),
    ("G76 X20. Z-9. K1. D.2 P3 F1.", "G76 P3: write P1: one flank"),
    ("G75 X40. Z-9. P100", "the cycle has no step to the next peck"),
    ("G12.1\nG71 P1 Q2", "a turning cycle in a section"),
    ("G94 X40. Z-5. C3.", "C3. is not understood in the block of a turning cycle"),
    ("G75 R1. H9.", "H9. is not understood in the first block of G75"),
    ("G32 Z-5. F2. C9.", "C9. is not understood beside a thread"),
]  # fmt: skip
HARMLESS = [
    ("G90 G54\nG1 X40. F.2", "G54 (G90)\nG1 X40. F.2"),
    ("G90 G0 X40. Z1.", "G0 X40. Z1. (G90)"),
    ("G90 G28 U0", "(G90)"),
    ("G90 G0 X40. Z1.\nG71 U2. R.5\nG71 P1 Q2\nN1 G0 X30.\nN2 G1 Z-5.", "G1 Z-5"),
    ("G70 P1 Q4\nN1 G0 X30.\nF.1\nN3 G1 Z-5.\nN4 X50.", "F.1 (line 3)\nG1 Z-5"),
    ("T0303 M6", "T3 M6 G43 H3 M3 (M6)"),
    ("T00", "G49"),
]


@pytest.mark.parametrize(("blocks", "lines"), HARMLESS)
def test_a_code_that_changes_nothing_is_a_comment(blocks, lines):
    text = f"G21 G99 S500 M3\nG0 X50. Z2.\n{blocks}\nM30\n"
    result = translate_program(text, control_of("fanuc-lathe"))
    assert not result.refused
    assert lines in result.text


def test_a_contour_ends_in_the_mode_in_which_it_begins():
    text = "G21 G95 S500 M3\nG90 G0 X50. Z2.\nG71 U2.\nG71 P1 Q2\nN1 G0 X30.\nN2 G91 G1 Z-5.\nM30\n"
    (refused,) = translate_program(text, control_of("fanuc-lathe-b")).refused
    assert refused.sentence.startswith("the contour ends in G91: end it in G90")


@pytest.mark.parametrize(("blocks", "sentence"), REFUSED)
def test_a_cycle_that_cannot_be_is_refused(blocks, sentence):
    text = f"G21 G99 S500 M3\nG0 X50. Z2.\n{blocks}\nM30\n"
    result = translate_program(text, control_of("fanuc-lathe"))
    assert result.text == ""
    assert any(refused.sentence.startswith(sentence) for refused in result.refused), result.refused
