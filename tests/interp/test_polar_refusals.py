# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 on the stock interpreter: its refusals, with their lines, before anything moves.

Those that the planners make have their sentences in unit.
"""

from types import SimpleNamespace

import pytest

from g12.host import kinematics_switch
from g12.tools.preview.tracer import Tracer
from support.polar_programs import FIRST, feed_moves, refused, section, texts
from support.sim_machines import SIM, kept_tracer

lathe = kept_tracer("lathe_mm")


# ---------------------------------------------------------------- codes and words inside


INSIDE = [  # unit/test_section.py has every code
    (
        "G0 X12",
        "G0 is refused: a rapid leaves the contour. Is the section's end missing above? "
        "Else use G1 with a high F, or set [G12] POLAR_G0 = feed",
    ),
    ("G12.1", "the section is already on: G13.1 ends it"),
    ("M2", "G13.1 is missing: M2 comes before it"),
    ("G1 @5 ^3", "@ is refused: the section's words are X, C (or Y), Z, U and H"),
    ("G1 X12 Z3", "Z needs a block of its own, or [G12] POLAR_Z = allow"),
    ("G13.1 X5", "G13.1 must be alone in its block"),
    ("G13.1 G0 Z2", "G13.1 must be alone in its block"),
    ("M33 M8", "M33 is remapped: inside a section it needs a block of its own"),
    ("M72", "M72: no modes were saved in this section"),
    ("o<s> sub", "a sub cannot be defined inside the section"),
    ("o<s> endsub", "G13.1 is missing: endsub comes before it"),
    ("M99", "G13.1 is missing: M99 comes before it"),
    ("X12 M99", "M99 is refused: it needs a block of its own"),
    ("X12 M98 P99", "M98 is refused: it needs a block of its own"),
    ("%", "G13.1 is missing: the program ends before it"),
    ("o<nowhere> call", "there is no sub for o<nowhere>call, in the program or as a file"),
    ("M98 P99", "there is no sub for m98p99, in the program or as a file"),
    ("o1 if [0]", "the program ends before what belongs to o1if[0]"),
]
IN_ITS_OWN_WORDS = [  # how the interpreter begins; its versions go on differently
    ("G1 X5 X6", "Multiple x words on one line"),
    ("G1 G2 X5", "Two g codes used from same modal group"),
    ("G1 X5 R3", "R word with no g code that uses it"),
    ("G1 X[1/0]", "Attempt to divide by zero"),
    ("M3 S[10**300]", "Command too long"),
    ("G1 X#<a>", "Named parameter #<a> not defined"),
]


@pytest.mark.parametrize(("block", "reason"), INSIDE)
def test_refused_inside(lathe, block, reason):
    program = section("G1 X15", "(x)", block, "G1 X10")
    assert refused(lathe, program) == (f"G12.1 line 8: {reason}", 8)


@pytest.mark.parametrize(("block", "reason"), IN_ITS_OWN_WORDS)
def test_what_the_interpreter_refuses(lathe, block, reason):
    text, shown = refused(lathe, section("G1 X15", "(x)", block, "G1 X10"))
    assert text.startswith(f"G12.1 line 8: {reason}")
    assert shown == 8


HEAD = [FIRST, "G0 X20 Z5 C0", "F100"]
PROGRAMS = [
    (section("G1 X15")[:-2], 6, "G13.1 is missing: the program ends before it"),
    (["o<s> sub", "G13.1", "o<s> endsub", *section("G1 X15", "o<s> call")], 2,
     "G13.1 is missing: the sub called here has one, but not the code that it ends"),
    (["o<s> sub", "G12.1", "G1 X15", "o<s> endsub", *HEAD, "o<s> call", "G13.1", "M2"], 4,
     "G13.1 is missing: endsub comes before it"),
    (section("G1 X30", "X310", "X20"), 7,
     "the X axis would go to 310 mm, beyond its limit 300 mm"),
    (section("G1 X14", first=FIRST.replace("G21", "G20"), start="G0 X1 Z1", feed="F4"), 6,
     "the X axis would go to 355.6 mm, beyond its limit 300 mm (G20 is active)"),
    (section("G1 X30", "C360"), 7, "the X axis would go to 302.141163 mm, beyond its limit 300 mm:"
     " C and H are lengths here, not degrees"),
    (section("G1 X30", "X310 C5"), 7,
     "the X axis would go to 310.04032 mm, beyond its limit 300 mm"),
    ([line for line in section("G1 G41 X12") if line != "T1 M6"], 5,
     "G41 needs a tool in the spindle: its radius is compensated"),
]  # fmt: skip


@pytest.mark.parametrize(("program", "line", "reason"), PROGRAMS)
def test_a_section_is_refused_on_its_line(lathe, program, line, reason):
    assert refused(lathe, program) == (f"G12.1 line {line}: {reason}", line)


# ---------------------------------------------------------------- entry


SHIFTED = (
    "X0 must be the spindle's axis: G52 or G92 shifts X by {};"
    " cancel it with G92.1 (an X offset of G54 may stay)"
)
OFFSET = ["G18 G0 X60 Z50", "G42 D1 G1 X30 Z50", "X30 Z5"]
ENTRY = [
    ("\n".join([*OFFSET, "G40"]), "G12.1",
     "needs a move after G40: the tool is still beside the programmed point"),
    ("G52 X1.5", "G12.1", SHIFTED.format(1.5)),
    ("G92 X17", "G12.1", SHIFTED.format(3)),
    ("", "G12.1 T1", "must be alone in its block"),
]  # fmt: skip


@pytest.mark.parametrize(("before", "block", "reason"), ENTRY)
def test_refused_entry(lathe, before, block, reason):
    program = [line if line != "G12.1" else block for line in section("G1 X12", before=[before])]
    traced, line = lathe.trace_text(program), 6 + before.count("\n")
    assert traced.error.text == f"G12.1 line {line}: {reason}"
    assert traced.error.line == line
    assert not [move for move in traced.moves if move.line >= line]


@pytest.mark.parametrize(("cycle", "code"), [("G17 G81 X20 Z4 R5", "G81"), ("G38.3 Z4", "G38.3")])
def test_bare_words_of_a_code_that_is_no_contour(lathe, cycle, code):
    traced = lathe.trace_text(section("X15", before=[cycle]))
    assert traced.error.text == (
        f"G12.1 line 7: {code} is active: the block needs G1, G2 or G3 of its own"
    )
    assert not [move for move in traced.moves if move.line > 6]


def test_words_beside_the_code_that_ends_no_section(lathe):
    traced = lathe.trace_text([FIRST, "G13.1 D5", "M2"])
    assert traced.error.text == "G13.1 line 2: must be alone in its block"


def test_a_machine_without_a_c_axis():
    with Tracer(SIM / "lathe_mm.ini", overrides={"TRAJ": {"COORDINATES": "X Z"}}) as lathe:
        program = section("G1 X12", start="G0 X20 Z5")
        text, line = refused(lathe, program)
    assert (text, line) == ("G12.1 line 5: needs a machine with an X and a C axis", 5)


def test_a_comment_beside_the_codes_is_no_word(lathe):
    program = ["G12.1 (on)" if line == "G12.1" else line for line in section("G1 X12")]
    program = ["N9 G13.1 (off)" if line == "G13.1" else line for line in program]
    assert len(feed_moves(lathe.trace_text(program))) == 1


# ---------------------------------------------------------------- contour


def test_beyond_the_travel_of_c():
    with Tracer(SIM / "lathe_mm.ini", overrides={"AXIS_C": {"MAX_LIMIT": 400}}) as lathe:
        assert feed_moves(lathe.trace_text(section("G1 X12", "G3 I-12")))
        text, line = refused(lathe, section("G1 X12", "G3 I-12", "G3 X0 C12 R12"))
    assert text.startswith("G12.1 line 8: the C axis would go to 4")
    assert text.endswith("beyond its limit 400 degrees")
    assert line == 8


@pytest.mark.parametrize("machine", ["lathe_mm", "lathe_mm_kinematics"])
def test_a_line_number_is_taken_for_no_code(machine):
    """LinuxCNC tells G90.1 as 901, G96 as 960, M52 as 52, and in front of them a line's number."""
    modes = "(DEBUG,#<_ijk_absolute_mode>)"
    with Tracer(SIM / f"{machine}.ini") as lathe:
        for code in (52, 901, 960):
            for first in range(code - 6, code + 5):
                blocks = section("G1 X20 C5", "X10")
                trace = lathe.trace_text([*[""] * (first - 1), *blocks[:-1], modes, blocks[-1]])
                assert texts(trace)[-1] == "0.000000", first


# ---------------------------------------------------------------- afterwards


def test_a_refused_section_changes_nothing(lathe):
    before = lathe.trace_text(section("G1 X12", before=["G91 G61 S200"])[:5]).modes
    refused_ = lathe.trace_text(
        section("G90 G95 F3 S5 M8 G64 P.1", "G1 X12", "G3 X5", before=["G91 G61 S200"])
    )
    assert refused_.error
    assert refused_.modes == before


@pytest.mark.parametrize(
    ("act", "why"),
    [
        ("open('{}', 'w').write('G1 X3')", "the file has been changed while the program runs"),
        ("open('{}', 'w').write('G1 X3\\n' * 99)",
         "the file has been changed while the program runs"),
        ("import os; os.unlink('{}')",
         "the program's file cannot be read while it runs: No such file or directory"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_stay_while_its_program_runs(lathe, tmp_path, act, why):
    """The interpreter goes on in what it has read: other lines are not those of the section."""
    program = tmp_path / "cut.ngc"
    program.write_text("\n".join(section("G1 X15", before=[f";py,{act.format(program)}"])))
    traced = lathe.trace(program)
    assert traced.error.text.endswith(f": {why}")
    assert [move.kind for move in traced.moves] == ["rapid"]


def test_the_line_after_an_abort_ends_no_request_in_a_preview(monkeypatch):
    written = []
    monkeypatch.setattr(kinematics_switch.hal, "set_p", lambda *pin: written.append(pin))
    monkeypatch.setattr(kinematics_switch.hal, "get_value", lambda pin: 0)
    for task, pins in ((0, []), (1, [(kinematics_switch.END_PIN, "1")])):
        kinematics_switch.leave(SimpleNamespace(task=task))
        assert written == pins
