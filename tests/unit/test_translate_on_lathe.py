# SPDX-License-Identifier: GPL-2.0-or-later
"""A mill's program on a lathe as text: where sections begin and end, and what is refused."""

import re

import pytest

from g12.tools.commands import translate
from g12.tools.errors import UsageError
from g12.tools.translate.blocks.control import read_control
from g12.tools.translate.program import translate_program
from support.sim_machines import PROGRAMS, ROOT

HEAD = "G21 G90 G54\nT1 M6\nG43 H1\nG0 X10. Y5. S900 M3\nZ20.\nZ3.\n"
CUT = "G1 Z-1. F100.\nX12.\n"
DRILL = "G98 G81 X10. Y5. Z-6. R3. F80.\n"


def with_options(name, *options):
    words = ["--control", name, "part.nc", *options]
    return translate.changed(read_control(name), translate.command_parser().parse_args(words))


FACE = with_options("mill-on-face")


def lines(text, control=FACE):
    result = translate_program(text, control)
    assert result.refused == []
    return [re.sub(r" *\((line.*|%)\)", "", line) for line in result.text.splitlines()]


def refused(text, control=FACE):
    first, *_ = translate_program(f"{text}M30\n", control).refused
    return first


def test_a_section_begins_with_the_first_cut_and_ends_before_the_tool():
    assert lines(f"{HEAD}{CUT}G0 Z20.\nM5\nT2 M6\nM30\n")[4:] == [
        "G0 S900 M3 $1 (X10. with the next cut)(Y5. with the next cut)",
        "Z20.", "Z3.", "G0 X22.3607 C0", "G8", "G12.1", "G1 X10. C5. G94 F2500",
        "G1 Z-1. F100. G94", "X12.", "Z20. G1 G94 F2500", "M5 $1", "G13.1", "G7", "T2 M6", "M30",
    ]  # fmt: skip


def test_the_first_line_of_the_stock_linuxcnc_post_is_understood():
    posted = f"N10 G90 G94 G17 G91.1\nN15 G21\nN20 G53 G0 Z0.\n{HEAD}{CUT}M30\n"
    first = ["N10 G90 G94 G91.1 (G17)", "N15 G21", "N20 (G53)(Z0.)", "G91 G28 Z0", "G90"]
    assert lines(posted)[1:6] == first


def test_holes_are_calls_outside_of_sections():
    more = "Y-5.\nG73 X0 Z-8. R-1. Q2. F60.\nG82 X1. Z-2. R1. P.5\nG80\nG0 Z20.\nM30\n"
    assert lines(HEAD + CUT + "G0 Z20.\n" + DRILL + more)[-10:-1] == [
        "Z20. G1 G94 F2500", "G13.1 (G98)", "G7",
        "o<face_hole_at> call [20.] [5.] [6.] [3.] [80.] [0] [0] [0]",
        "o<face_hole_at> call [20.] [-5.] [6.] [3.] [80.] [0] [0] [0]",
        "o<face_hole_at> call [0.] [-5.] [8.] [2] [60.] [-2.] [0] [0]",
        "o<face_hole_at> call [2.] [-5.] [2.] [1.] [60.] [0] [.5] [0]",
        "(G80)", "G0 Z20.",
    ]  # fmt: skip


def test_a_motion_ends_a_drilling_cycle_as_g80_does():
    assert lines(f"{HEAD}{DRILL}G0 Z20.\nX3.\nM30\n")[-3:-1] == [
        "G0 Z20.",
        "(X3. with the next cut)",
    ]


def test_a_call_and_a_loop_begin_a_section_before_them():
    called = lines(f"{HEAD}M98 P5\nG0 Z20.\nM30\nO5\n{CUT}G0 Z3.\nM99\n")
    assert called.index("G12.1") < called.index("M98 P5") < called.index("G13.1")
    loop = "#1=0\nWHILE [#1 LT 2] DO1\nG0 X[10.+#1] Y5.\nG1 Z-1. F9.\nG0 Z3.\n#1=#1+1\nEND1\nM30\n"
    looped = lines(HEAD + loop)
    assert looped.index("G12.1") < looped.index("o<while_7> while [#1 LT 2]")
    whole = lines(f"G21 G90\nM98 P5\nM98 P5\nM30\nO5\n{HEAD}{CUT}G0 Z20.\nM99\n")
    assert whole.index("G13.1") < whole.index("M99")


def test_what_a_mill_has_and_a_lathe_has_not():
    home = "G0 Z20.\nG91 G28 Z0. Y0.\nG53 G0 X0 Y0\nG53 Z0\nM30\n"
    translated = lines(f"G21 G17 G90\n{HEAD}{CUT}{home}")
    assert translated[-6:] == [
        "G13.1 (Y0.: no Y here)", "G7", "G91 G28 Z0.", "(G53)(X0)(Y0)",
        "G91 G28 Z0 (G53)(Z0)", "M30",
    ]  # fmt: skip


REFUSED = [
    (f"{HEAD}G1 Z-1. F9.\nG0 X3. Z5.\n", 8, "G0 at Z-1, below 2"),
    ("G21 G90\nG0 X1. Y1.\nG1 X2. F9.\n", 3, "a cut begins here with the tool at Z not known"),
    ("G21 G90\nG0 Z9.\nG1 X2. F9.\n", 3, "a cut begins here, and the position of X is not known"),
    (f"{HEAD}G1 A3. F9.\n", 7, "A3.: a program for mill-on-face has X, Y and Z"),
    (f"{HEAD}G18 G2 X1. Z1. R9. F9.\n", 7, "G18: arcs lie in X and Y here (G17)"),
    (f"{HEAD}G95 G1 X1. F.1\n", 7, "G95, a feed per revolution: write G94 and F per minute"),
    (f"{HEAD}G42 D1\n", 7, "G42 before the first cut: write it with the contour's first G1"),
    (f"{HEAD}G1 G41 D1 X1. F9.\nT2 M6\n", 8, "G41 or G42 is on where the section ends"),
    (f"{HEAD}G84 Z-3. R3. F1.\n", 7, "G84: G73 and G81 to G83 are translated here"),
    (f"{HEAD}G81 Z3. R5. F1.\n", 7, "G81 Z3.: the hole must end below Z0, the part's surface"),
    (f"{HEAD}G91 G81 Z-3. R-1. F1.\n", 7, "a drilling cycle under G91"),
    (f"{HEAD}G55 G1 Z-1. F9.\n", 7, "a cut begins here beside a tool, an offset or units"),
    ("G90\nG0 X1. Y1. Z9.\n", 2, "how high a rapid must be depends on the units: say G20 or G21"),
]


@pytest.mark.parametrize(("text", "line", "sentence"), REFUSED)
def test_what_is_refused(text, line, sentence):
    found = refused(text)
    assert (found.line, found.sentence[: len(sentence)]) == (line, sentence)


def test_the_safe_height_is_said():
    low = f"{HEAD}G0 Z1.\nG1 Z-1. F9.\n"
    assert "below 2" in refused(low).sentence
    assert lines(f"{low}M30\n", with_options("mill-on-face", "--safe", "0.5"))
    with pytest.raises(UsageError, match="--safe is for mill-on-face"):
        with_options("haas-mill", "--safe", "4")


def shown(page, heading):
    """Return the lines of an example on a page, before and after."""
    before, after = page.split(f"{heading}:\n")[1].split("\nbecomes")[:2]
    rest = after.split("\n\n")[1]
    return [re.findall("^    (.*)", text, re.MULTILINE) for text in (before, rest)]


def test_what_the_page_shows_is_what_is_printed():
    page = (ROOT / "configs" / "from_cam.md").read_text()
    program, printed = shown(page, "A mill's program for the face")
    assert lines("\n".join([*program, "M30"]))[1:-1] == printed
    posted = (PROGRAMS / "foreign" / "cam" / "doosan-lathe" / "ramp.nc").read_text()
    part, becomes = shown(page, "A ramp on a Doosan post, in part")
    assert set(part) <= set(posted.splitlines())
    assert set(becomes) <= set(lines(posted, read_control("doosan-lathe")))
    assert len(part) == len(becomes)
