# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact traces: positions, feeds, errors with text and line, and a clean start for each program."""

import math
import subprocess

import pytest

from g12.tools.install.config.ini_edit import IniText
from g12.tools.preview.tracer import TraceFailure, Tracer
from g12.tools.system import PYTHON
from support.sim_machines import trace_text
from support.small_configs import content_of

INI = """\
[EMC]
VERSION = 1.1
[RS274NGC]
PARAMETER_FILE = machine.var
SUBROUTINE_PATH = subs
REMAP = G88.5 modalgroup=1 prolog=check ngc=body argspec=I
REMAP = G88.6 modalgroup=1 python=straight argspec=I
REMAP = G88.7 modalgroup=1 ngc=clamped
REMAP = M35 modalgroup=10 ngc=clamp
[PYTHON]
TOPLEVEL = code/toplevel.py
PATH_PREPEND = code
[G12]
WORD = plain
[EMCIO]
EMCIO = io
TOOL_TABLE = tool.tbl
[TRAJ]
COORDINATES = X Y Z C
LINEAR_UNITS = mm
"""
REMAP = """\
import os, re
from emccanon import CANON_ERROR, MESSAGE
from interpreter import INTERP_ERROR, INTERP_OK

def refused(self, words):
    if words["i"] > 5:
        self.set_errormsg(f"I{words['i']:g} is too much")
    return words["i"] > 5

def check(self, **words):
    MESSAGE("checking")
    return INTERP_ERROR if refused(self, words) else INTERP_OK

def straight(self, **words):
    if refused(self, words):
        return INTERP_ERROR
    with open(os.environ["INI_FILE_NAME"]) as ini:
        MESSAGE(re.search("WORD = (.*)", ini.read()).group(1))
    CANON_ERROR("not that bad")
    self.execute(f"G1 X{words['i']} F10")
    return INTERP_OK
"""
FILES = {
    "machine.ini": INI,
    "tool.tbl": "T1 P1 D6 Z10\nT2 P2 D8 Z20\n",
    "code/toplevel.py": "import remap\n",
    "code/remap.py": REMAP,
    "subs/body.ngc": "o<body> sub\n(first a comment)\nG1 X#<i> F100\nG1 Y1\no<body> endsub\n",
    "subs/clamp.ngc": "o<clamp> sub\no<clamp> endsub\n",
    "subs/clamped.ngc": "o<clamped> sub\nG1 X2 F9 M35\nX3\no<clamped> endsub\n",
    "subs/sub.ngc": "o<sub> sub\nG1 X9 F100\nG88.5 I#1\no<sub> endsub\n",
}


@pytest.fixture(scope="module")
def ini(tmp_path_factory):
    folder = tmp_path_factory.mktemp("machine")
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    return folder / "machine.ini"


@pytest.fixture(scope="module")
def mill(ini):
    with Tracer(ini) as tracer:
        yield tracer


def test_the_tool_table_is_linuxcncs_own_reading(ini, tmp_path):
    table = tmp_path / "tool.tbl"
    table.write_text(
        "; T9 P9 D99 is no tool\nT1 P1 D0.25 Z1.0 ;1/4 D8 end mill\nt2 p7 z3\n"
        " D+12.5 P3 T3\nT4 P4 D1.2.3\nT5 P5 D--\nT1 P6 D7\n"
    )
    with Tracer(ini, tools=table) as tracer:
        assert tracer.diameters == {1: 0.25, 2: 0.0, 3: 12.5, 4: 1.2}
        assert tracer.trace_text(["M2"]).diameters == tracer.diameters


def test_a_diameter_that_the_program_sets_is_the_tools(mill):
    """As on a machine: by G10 L1, of a tool that is loaded later or is in the spindle."""
    size = "G10 L1 P1 R4"
    for first, second in ((size, "T1 M6"), ("T1 M6", size), (f"{size}\nG10 L0", "T1 M6")):
        program = [first, second, "(print,#5410)", "T2 M6", "T1 M6", "(print,#5410)", "M2"]
        traced = mill.trace_text(program)
        assert traced.printed.split() == ["8.000000", "8.000000"]
        assert traced.diameters == {1: 8.0, 2: 8.0} and mill.diameters == {1: 6.0, 2: 8.0}
    assert mill.trace_text(["T1 M6", "M2"]).diameters == mill.diameters


def test_f_is_converted_with_the_units_and_needed(mill):
    """As on a machine; the preview by itself goes on with F1."""
    for blocks in (["G1 X1"], ["G20", "(x)", "G21", "(x)", "G1 X1"]):
        error = mill.trace_text([*blocks, "M2"]).error
        assert error == ("Cannot do g1 with zero feed rate", len(blocks))
    lines = ["G21 F254", "G20", "G0 X1", "(print,#<_feed>)", "G21", "G0 X1", "(print,#<_feed>)"]
    assert mill.trace_text([*lines, "M2"]).printed.split() == ["10.000000", "254.000000"]
    moves = mill.trace_text([*lines, "F1 G1 X2", "G20", "X3 F1"]).moves
    assert [move.feed for move in moves[2:]] == near([1.0, 25.4])


def near(values):
    return pytest.approx(values, abs=1e-9)


def ends(traced):
    assert traced.error is None
    return [move.end[:3] for move in traced.moves]


# Positions and feeds.


def test_work_offset_g92_and_rotation_are_resolved(mill):
    offsets = {5221: 100.0, 5222: 50.0, 5230: 90.0}
    assert ends(mill.trace_text("G1 X10 Y5 F100", parameters=offsets)) == [near((95.0, 60.0, 0.0))]
    shifted = mill.trace_text("G0 X1\nG92 X0 Y0\nG1 X10 F100", parameters=offsets)
    assert shifted.moves[-1].end[:3] == near((100.0, 61.0, 0.0))


def test_an_arc_is_turned_with_the_work_coordinates(mill):
    (_, arc) = mill.trace_text("G18 G0 X1\nG3 X0 Z1 I-1 F10", parameters={5230: 90.0}).moves
    assert arc.start[:3] == near((0.0, 1.0, 0.0))
    assert arc.end[:3] == near((0.0, 0.0, 1.0))
    assert math.degrees(arc.sweep) == near(270.0)


@pytest.mark.parametrize("change", ["T2 M6\nG43", "T2 M6 G43", "M61 Q2\nG43", "T1 M6\nM61 Q2 G43"])
def test_tool_length_is_reported_beside_the_position(mill, change):
    (move,) = mill.trace_text(f"{change}\nG1 Z5 F100").moves
    assert move.end[2] == near(5.0)
    assert move.tool_offset[2] == near(20.0)
    assert move.tool == 2


@pytest.mark.parametrize("change", ["T2 M6\nG43", "T2 M6 G43", "G43 H2\nT2 M6", "T2 M6"])
@pytest.mark.parametrize("system", ["", "G55\n", "G92 Y7\n", "G10 L2 P1 Z-3\n"])
def test_an_axis_that_is_not_commanded_starts_where_it_ends(mill, system, change):
    offsets = {5221: 100.1, 5222: 50.7, 5223: -99.9, 5242: 1.3, 5243: 7.7}
    first, second, _ = mill.trace_text(f"{system}{change}\nG0 X1\nX2\nY3", parameters=offsets).moves
    assert first.start[1:3] == first.end[1:3] == second.start[1:3] == second.end[1:3]
    assert second.start == first.end


@pytest.mark.parametrize(
    ("before", "start"),
    [
        ("G2 X9 I4", (10.0, 2.0, 3.0)),
        ("G18 G2 X9 Z5 I4 K1", (10.0, 2.0, 5.0)),
        ("G92 X5 Y5 Z5", (2.0, 2.0, 3.0)),
        ("G10 L2 P1 Y9 R30", (2.0, 2.0, 3.0)),
        ("G55", (2.0, 2.0, 3.0)),
        ("G20", (2.0, 2.0, 3.0)),
        ("G43 H1", (2.0, 2.0, -7.0)),
        ("G10 L1 P2 X7 Z9", (2.0, 2.0, 3.0)),
        ("G43.1 X2 Z5", (0.0, 2.0, -2.0)),
    ],
)
@pytest.mark.parametrize("change", ["T2 M6", "M61 Q2", "G10 L0"])
def test_a_tool_change_does_not_move_the_tip(mill, before, start, change):
    """LinuxCNC then reads its position, which the preview does not know after such blocks."""
    lines = ["G0 X1 Y2 Z3", f"{before} F99", change, "G91 G0 C9"]
    move = mill.trace_text(lines, parameters={5221: 1.0, 5243: 7.7}).moves[-1]
    assert move.start[:3] == near(start)
    assert move.end == near((*start, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("block", "feed", "mode"),
    [
        ("G21\nG94 G1 X60 F300", 300.0, "G94"),
        ("G20\nG94 G1 X1 F10", 254.0, "G94"),
        ("G21\nG93 G1 X60 F2", 120.0, "G93"),
        ("G21\nG95 G1 X60 F.2", 0.2, "G95"),
        ("G21\nG94 G1 C90 F45", 45.0, "G94"),
        ("G20\nG94 G1 C90 F45", 45.0, "G94"),
    ],
)
def test_feed_is_in_mm_or_degrees_per_minute(mill, block, feed, mode):
    (move,) = mill.trace_text(f"S1000 M3\n{block}").moves
    assert move.feed == near(feed)
    assert move.feed_mode == mode


def test_a_new_origin_makes_the_same_words_a_move(mill):
    for offset in ("G92 X1", "G10 L2 P1 X1"):
        *_, move = mill.trace_text(f"G20 G94 G54 G0 X0\nF10\n{offset}\nG1 X0").moves
        assert move.feed == near(254.0)
    lift, turn = mill.trace_text("G20 G94 G1 Z[0.1 + 0.2] F10\nG1 Z0.3 C90 F45").moves
    assert lift.end[2] != turn.end[2] == near(0.3 * 25.4) and turn.feed == near(45.0)  # rounding


# Lines.


def test_block_is_the_line_of_the_program_however_deep(mill):
    blocks = "G1 X0 F100\n\nG88.5 I2\nG1 X7\nG88.6 I3\nG1 X8\no<sub> call [2]\nG1 X1\n"
    moves = mill.trace_text(blocks).moves
    assert [move.block for move in moves] == [1, 3, 3, 4, 5, 6, 7, 7, 7, 8]
    assert [move.line for move in moves] == [1, 3, 4, 4, 0, 6, 2, 3, 4, 8]


def test_a_compensated_move_is_that_of_its_own_block(mill):
    """LinuxCNC emits it while it executes the next one."""
    blocks = "T1 M6 F100\nG41 G1 X20 Y0\nX40\n(corner)\nY40\nX0\nG40 Y60\nG0 Z5\n"
    moves = mill.trace_text(blocks).moves
    assert [move.block for move in moves] == [move.line for move in moves] == [2, 3, 5, 6, 7, 8]


def test_the_remainder_of_a_block_is_no_move_of_its_remapped_m_code(mill):
    blocks = (
        "o<own> sub\nG1 X1 F9 M35\no<own> endsub\n\nG1 X2 F9 M35\no<own> call\nG88.7\nG0 X1 M35"
    )
    moves = mill.trace_text(blocks).moves
    found = [(move.block, move.remap) for move in moves]
    assert found == [(5, ""), (6, ""), (7, "G88.7"), (7, "G88.7"), (8, "")]


def test_the_repeats_of_m98_are_moves_of_its_line(mill):
    """LinuxCNC counts a line less while more are to come."""
    subs = "O100\nG91 G1 X1\nM99\nO200\nG91 G1 Y1\nM99\n"
    calls = "M98 P100 L2 (M98)\nG0 X5\nm98 l3 p 200\nM98 P100\nM98 P200\nM98 P100 L2\nM2\n"
    moves = mill.trace_text(f"F100\n{calls}{subs}").moves
    assert [move.block for move in moves] == [2, 2, 3, 4, 4, 4, 5, 6, 7, 7]


@pytest.mark.parametrize(
    ("block", "text"),
    [
        ("G88.5 I6", "I6 is too much"),
        ("G88.6 I6", "I6 is too much"),
        ("o<sub> call [7]", "I7 is too much"),
        ("G88.5", "user-defined G88.5: missing: I"),
        ("G1 Q", "No characters found in reading real value"),
        ("T9 M6", "Requested tool 9 not found in the tool table"),
        *((code, f"{code}: LinuxCNC accepts it, but U, V and W arcs are not traced")
          for code in ("G17.1", "G18.1", "G19.1")),
    ],
)  # fmt: skip
def test_an_error_has_the_interpreters_text_and_the_line(mill, block, text):
    before = "G1 X0 F100\nG88.5 I1\no<sub> call [2]\n\nG88.6 I1\n"
    assert mill.trace_text(f"{before}{block}\nG1 X5\nM2").error == (text, 6)


def test_messages_come_with_their_line(mill):
    traced = mill.trace_text("G88.5 I1\n(MSG, hello)\n\nG88.6 I1")
    expected = [(1, "checking"), (2, " hello"), (4, "plain"), (4, "not that bad")]
    assert traced.messages == expected


# State.


def test_modes_and_variables_after_the_program(mill):
    traced = mill.trace_text("G20\nG91 G18 G61 G95 F.1 S500\nG0 X1")
    for code in ("G0", "G20", "G91", "G18", "G61", "G95"):
        assert code in traced.modes.gcodes
    assert (traced.modes.feed, traced.modes.speed) == (0.1, 500.0)
    assert traced.state["distance_mode"] == 1
    assert traced.position[0] == near(25.4)
    assert "G90" in mill.trace_text("G91 G0 X1\nM2").modes.gcodes


def test_setup_and_parameters_come_first_and_are_not_reported(mill):
    traced = mill.trace_text("#<_mine> = 3\n(print,#5221)", parameters={5221: 7.0})
    assert (traced.globals, traced.printed) == ({"_mine": 3.0}, "7.000000\n")
    traced = mill.trace_text("G1 Y1 F100", setup=["G0 X5", "(MSG, setting up)", "G91"])
    assert ends(traced) == [near((5.0, 1.0, 0.0))]
    assert traced.messages == [] and "G91" in traced.modes.gcodes
    assert mill.trace_text("G0 X1", setup=["G1 Q"]).error.line == 0


def test_every_program_starts_clean(mill):
    fresh = mill.trace_text("G1 X1 F10")
    dirty = "T1 M6\nG20\nG43 G91 G61 G18 F99 S9\nG92 X5\nG10 L2 P1 X3 R30\n#<_left> = 1\n#5 = 5"
    assert mill.trace_text(dirty).error is None
    again = mill.trace_text("G1 X1 F10\n(print,#5)")
    assert (again.moves, again.modes, again.state) == (fresh.moves, fresh.modes, fresh.state)
    assert (again.globals, again.printed) == ({}, "0.000000\n")
    assert mill.trace_text("T2 M6\nG43 Z1 G1 F100").error is None
    assert mill.trace_text("G20\nG53 G0 Z0").position[2] == near(0.0)


# The machine.


def test_nothing_is_written_beside_the_ini(ini):
    before = content_of(ini.parent)
    trace_text("T1 M6\nG10 L2 P1 X5\nG10 L1 P1 Z3\nM2", ini)
    assert content_of(ini.parent) == before


def test_a_program_without_end_times_out_and_the_next_one_runs(mill):
    with pytest.raises(TraceFailure, match=r"no end within 0\.5 s"):
        mill.trace_text("o1 while [1]\no1 endwhile", timeout=0.5)
    assert ends(mill.trace_text("G1 X1 F1")) == [near((1.0, 0.0, 0.0))]


@pytest.mark.parametrize(
    "line", ["a line without its sign", "#INCLUDE nowhere.inc", "#INCLUDE one.inc"]
)
def test_an_ini_that_linuxcnc_does_not_read_is_reported_and_never_passed_over(ini, line):
    """2.10 reads nothing of such a file, and its interpreter goes on without the remaps."""
    odd = ini.with_name("odd.ini")
    odd.write_text(f"{ini.read_text()}{line}\n")
    odd.with_name("one.inc").write_text("[A]\n#INCLUDE two.inc\n")  # in 2.9 a comment there
    machine = IniText(odd).ini()  # which keeps an #INCLUDE of no file
    reading = "import linuxcnc, sys; linuxcnc.ini(sys.argv[1])"
    if subprocess.run([PYTHON, "-c", reading, odd], capture_output=True).returncode:
        with pytest.raises(TraceFailure, match=f"does not read it: .*{line}"):
            Tracer(machine)
    else:
        with Tracer(machine) as tracer:
            assert ends(tracer.trace_text("G88.6 I2\nM2")) == [near((2.0, 0.0, 0.0))]


def test_a_machine_whose_python_does_not_load_says_so(ini, tmp_path):
    broken = tmp_path / "toplevel.py"
    broken.write_text("import nothing_of_that_name\n")
    with pytest.raises(TraceFailure, match="nothing_of_that_name"):
        Tracer(ini, overrides={"PYTHON": {"TOPLEVEL": str(broken)}})


def test_a_crash_of_the_interpreter_is_no_word_about_the_program(ini, tmp_path):
    """Nor is its death by a signal: another one is started for the next program."""
    code = "import os\nfrom interpreter import *\ndef straight(self, **words): os.abort()\n"
    (tmp_path / "remap.py").write_text(code + "check = straight\n")
    with Tracer(ini, overrides={"PYTHON": {"PATH_PREPEND": str(tmp_path)}}) as tracer:
        with pytest.raises(TraceFailure, match="died"):
            tracer.trace_text("G88.6 I1")
        assert ends(tracer.trace_text("G1 X1 F1")) == [near((1.0, 0.0, 0.0))]
        tracer.kill()
        with pytest.raises(TraceFailure, match="died"):
            tracer.trace_text("G1 X1 F1")
        assert ends(tracer.trace_text("G1 X1 F1")) == [near((1.0, 0.0, 0.0))]
