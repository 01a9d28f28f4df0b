# SPDX-License-Identifier: GPL-2.0-or-later
"""G12.1 on the stock interpreter: whatever may stand in a program may stand in a section."""

from itertools import chain

import pytest

from g12.tools.preview.tracer import Tracer
from support.polar_programs import FIRST, START, cut, ends, feed_moves, lines, section, texts
from support.sim_machines import SIM, kept_tracer

lathe = kept_tracer("lathe_mm")


SIXTH = "\n" * 5  # lines before a file's sixth, where the first line of `section` is


@pytest.fixture(scope="module")
def subs(tmp_path_factory):
    """Open a lathe with subs and remapped codes in files of their own."""
    directory = tmp_path_factory.mktemp("subs")
    files = {
        "flat": "o<flat> sub\nG1 X#1\n#<depth>=[#2 * 2]\nC#<depth>\no<flat> endsub [#<depth>]\n",
        "outer": "o<outer> sub\no<flat> call [#1] [1]\nU1\no<outer> endsub\n",
        "round": "o<round> sub\nG12.1\no<flat> call [11] [2]\nG13.1\no<round> endsub\nM2\n",
        "m410": "o<m410> sub\nG1 X#<p>\nH1\no<m410> endsub\n",
        "exact": f"o<exact> sub{SIXTH}G9 G1 X14\nX13\no<exact> endsub\n",
        "smooth": f"o<smooth> sub{SIXTH}G1 X12\nX11\no<smooth> endsub\n",
        "200": "O200\nG1 X15\nM99\n",
    }
    for name, text in files.items():
        (directory / f"{name}.ngc").write_text(text)
    remaps = ("G12.1 modalgroup=1 python=polar_on", "G13.1 modalgroup=1 python=polar_off")
    overrides = {
        "RS274NGC": {
            "SUBROUTINE_PATH": f"{directory}:../../ngc:subs",
            "REMAP": (*remaps, "M410 modalgroup=10 argspec=P ngc=m410"),
        }
    }
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as opened:
        yield opened


# ---------------------------------------------------------------- words, values, parameters


def test_the_callers_local_parameters_go_in_and_out(lathe):
    traced = cut(
        lathe,
        "G1 X#<a>", "#<a>=[#<a> - 2]", "X#<a>", "#<new>=4",
        before=["#<a>=12", "#<b>=1"], after=["(DEBUG,#<a> #<b> #<new>)"],
    )  # fmt: skip
    assert ends(traced) == [(12, 0), (10, 0)]
    assert texts(traced) == ["10.000000 1.000000 4.000000"]


def test_local_parameters_of_a_sub_that_holds_a_section(lathe):
    program = [
        FIRST, "o<s> sub", "#<a>=#1", "G12.1", "G1 F100 X#<a>", "#<a>=[#<a> + 1] #<_deep>=3",
        "G13.1 #2=4", "(DEBUG,#<a> #1 #2)", "o<s> endsub", START, "#<a>=5", "o<s> call [9]",
        "(DEBUG,#<a>)", "M2",
    ]  # fmt: skip
    traced = lathe.trace_text(program)
    assert ends(traced) == [(9, 0)]
    assert texts(traced) == ["10.000000 9.000000 4.000000", "5.000000"]
    assert traced.globals["_deep"] == 3


def test_position_parameters_show_the_plane_and_behind_the_section_the_machine(lathe):
    body = ["G1 X-12 C3", "X[#5420 - 1] C[#<_c> + 1]", "(DEBUG,#<_x> #5425 #5422)", "Z-2"]
    traced = cut(lathe, *body, "(DEBUG,#<_z>)", "X20 C20", after=["(DEBUG,%.3f#5420 #5425)"])
    assert ends(traced)[1] == (-13, 4)
    assert texts(traced) == ["-13.000000 4.000000 5.000000", "-2.000000", "28.284 45.000"]


# ---------------------------------------------------------------- control flow


CUT = {  # what stands in a section, and where its blocks end; #1 is 1, and what the last sets
    "expressions": (["G1 X[10 + 2] C[sin[30] * 4]", "X-[3]C-#7", "Xatan[1]/[1] C+1"],
                    [(12, 2), (-3, -7), (45, 1)], ["#7=7"]),
    "no blanks": (["g01x14c3", "n7x 1 0 c-2.", "G1X+8C.5"], [(14, 3), (10, -2), (8, 0.5)]),
    "assignments act after": (["#1=8 G1 X#1 #<a>=2", "X#1 C#<a>"], [(12, 0), (8, 2)],
                               ["#1=12", "#<a>=0"]),
    "U and H": (["G1 U-8 H3", "U2", "H-1.5"], [(12, 3), (14, 3), (14, 1.5)]),
    "U and H in G91": (["G91 G1 U-8 H3", "X2 C1"], [(12, 3), (14, 4)]),
    "Y is C": (["G1 X12 Y5", "G3 X8 Y1 R4"], [(12, 5), (8, 1)]),
    "letters of names": (["G1 Ufup[#<yhu>-12.5]Y[#<_hy>+round[1.2]]", "H#<yh u>"],
                         [(11, 3), (11, 6)], ["#<yh u>=3", "#<_hy>=2"]),
    "G9": (["G9 G1 X12", "G1 G09 X10", "G9", "G90 X8"], [(12, 0), (10, 0), (8, 0)]),
    "U between o words": (["G1 X10", "o1 repeat [2]", "U1", "H1 (one)", "/U9", "", "o1 endrepeat"],
                          [(10, 0), (11, 0), (11, 1), (12, 1), (12, 2)]),
    "block delete": (["G1 X12", "/G1 X99", "/ U3", "/o1 if [1]", "/M30", " / H1", "C3", "/",
                      "/(MSG, no)"], [(12, 0), (12, 3)]),
    "elseif": (
        ["o1 if [0]", "U1", "o1 elseif [#1]", "G1 X12", "o1 elseif [1]", "G1 X99", "o1 endif"],
        [(12, 0)],
    ),
    "do": (
        ["#2=3", "o1 do", "G1 X[10+#2]", "#2=[#2-1]", "H1", "o1 while [#2 GT 1]"],
        [(13, 0), (13, 1), (12, 1), (12, 2)],
    ),
    "repeat none": (
        ["o1 repeat [0]", "G1 X12", "U1", "#<a>=1", "o1 endrepeat", "G1 C1"],
        [(20, 1)],
    ),
    "break": (
        ["o1 while [1]", "G1 U-1", "o2 if [#5420 LT 18]", "o1 break", "o2 endif", "C3", "C0",
         "o1 endwhile"],
        [(19, 0), (19, 3), (19, 0), (18, 0), (18, 3), (18, 0), (17, 0)],
    ),
    "continue": (
        ["#2=0", "o1 while [#2 LT 2]", "#2=[#2+1]", "G1 U-1", "o2 if [#2 EQ 1]", "o1 continue",
         "o2 endif", "C3", "o1 endwhile"],
        [(18, 0), (18, 3)],
    ),
    "nested": (
        ["o1 repeat [2]", "o2 if [#1 EQ 1]", "G1 X11", "o2 else", "G1 X12", "o2 endif",
         "#1=[#1+1]", "o1 endrepeat"],
        [(11, 0), (12, 0)],
    ),
    "assignments of a waiting block's result": (
        ["G1 X12", "M66 P0 L0", "#1=[10 - #5399]", "X#1 C2", "M66 E0 L0 X9", "C0"],
        [(12, 0), (10, 2), (9, 2), (9, 0)],
    ),
    "the spindle that a parameter of its line names": (
        ["G1 X12", "#1=0", "#1=5 S500 $#1", "#1=7", "X11"], [(12, 0), (11, 0)],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CUT)
def test_a_section_is_cut_as_it_is_written(lathe, name):
    body, expected, *before = CUT[name]
    assert ends(cut(lathe, *body, before=["#1=1", *chain(*before)])) == expected


SUBS = {  # lines of a sub in front, of a section that calls it, and where the blocks end
    "recursion": (
        ["o<down> sub", "G1 U-1", "o1 if [#1 LE 1]", "o<down> return", "o1 endif",
         "o<down> call [#1 - 1]", "H1", "o<down> endsub"],
        ["o<down> call [3]", "X5"],
        [(17, 0), (17, 2), (5, 2)],  # moves of one line in a row count as one
    ),
    "modes restored at its end": (
        ["o<s> sub", "M73", "G91 G1 U1 F50", "X1", "o<s> endsub"], ["G1 X12", "o<s> call", "X9"],
        [(12, 0), (13, 0), (14, 0), (9, 0)],
    ),
    "modes restored at the end of the sub that saved them alone": (
        ["o<s> sub", "M73", "G91", "o<s> endsub", "o<t> sub", "G91 G1 U1", "o<t> endsub"],
        ["G1 X12", "o<s> call", "o<t> call", "X2"],
        [(12, 0), (13, 0), (15, 0)],
    ),
    "value returned": (
        ["o<next> sub", "o<next> endsub [#1 + 1]"],
        ["o<next> call [11]", "o<next> call [#<_value>]", "G1 X#<_value>"],
        [(13, 0)],
    ),
    "in other files": (
        [], ["o<outer> call [12]", "C0", "o<flat> call [9] [3]"],
        [(12, 0), (12, 2), (13, 2), (13, 0), (9, 0), (9, 6)],
    ),
    "remapped codes": (
        [], ["M410 P12", "X9", "U1", "M410 P8"],
        [(12, 0), (12, 1), (9, 1), (10, 1), (8, 1), (8, 2)],
    ),
    **{
        f"called by a computed name {name}": (
            ["o100 sub", "G1 U-2", "o100 endsub", "#<n>=100", "#<_g>=100"],
            ["G1 X12", f"o{name} call", "C5"], [(12, 0), (10, 0), (10, 5)],
        )
        for name in ("#<_g>", "[abs[-#<n>]]")
    },
}  # fmt: skip


@pytest.mark.parametrize("name", SUBS)
def test_a_sub_is_cut_where_it_is_called(subs, name):
    sub, body, expected = SUBS[name]
    assert ends(subs.trace_text([*sub, *section(*body)])) == expected


def test_labels_are_those_of_the_program_around(lathe):
    one = ["o1 if [1]", "G1 X11", "o1 endif"]
    sub = ["o<s> sub", "G12.1", "G1 F100", *one, "G13.1", "o<s> endsub"]
    program = [FIRST, *sub, START, "o<s> call", "G12.1", *one, "G13.1", "M2"]
    assert ends(lathe.trace_text(program)) == [(11, 0)]


def test_fanuc_subs_with_repeats(lathe):
    body = ["M98 P100 L0", "M98 P100 L2", "M98 P100 L0", "U1"]
    program = [*section(*body), "O100", "G1 U-2", "G91 C1", "G90", "M99"]
    assert ends(lathe.trace_text(program)) == [(18, 0), (18, 1), (16, 1), (16, 2), (17, 2)]


def test_a_section_in_a_sub_of_another_file(subs):
    traced = subs.trace_text([FIRST, START, "F100", "o<round> call", "C0", "M2"])
    assert ends(traced)[:2] == [(11, 0), (11, 4)]
    assert traced.moves[-1].line == 5


def test_beyond_the_travel_in_another_file_nothing_is_read_of_the_line_of_that_number(subs):
    """C is on the section's own second line, X alone on the sub's."""
    error = subs.trace_text(section("o<flat> call [400] [0]")).error
    rule = "the X axis would go to 400 mm, beyond its limit 300 mm"
    assert error.text == f"G12.1 line 2 of flat.ngc: {rule}"


@pytest.mark.parametrize(
    ("body", "stops"),
    [
        (["X16", "o<exact> call", "X12"], [14, 12]),  # X16 is in line 6 too
        (["X16", "o<exact> call", "o<smooth> call"], [14, 11]),
    ],
)
def test_g9_stops_its_own_line_and_none_of_the_same_number(subs, body, stops):
    traced = cut(subs, f"G1 {body[0]}", *body[1:])
    assert [round(move.end[0], 6) for move in feed_moves(traced) if move.exact] == stops


# ---------------------------------------------------------------- comments, files


def test_messages_reports_and_comments(lathe):
    body = [
        "(MSG, one)",
        "#3=4 (DEBUG,three #3 %d#3 %.1f#3 #9999999)",
        "(DEBUG,#3)",
        "; (MSG, no)",
        "G1 X9 (x)",
    ]
    *said, longer = texts(cut(lathe, *body, f"(DEBUG,{30 * '#5420 '})", before=["#3=1"]))
    assert said == ["one", "three 1.000000 1 1.0 ######", "4.000000"]
    assert longer.startswith("9.000000 9.000000") and len(longer) > 200  # and cut
    assert cut(lathe, "#3=4", "(PRINT,a #3)", "(print, b %d#3)").printed == "a 4.000000\n b 4\n"


PYTHON = "py,this.params[7] = this.current_x"


@pytest.mark.parametrize(
    ("line", "found"),
    [
        (f"({PYTHON})", 15),
        (f";{PYTHON}", 15),
        (f" ;{PYTHON}", 0),
        (f"G4 P0 ;{PYTHON}", 0),
        (f"o1 if [0]\n;{PYTHON}\n({PYTHON})\no1 endif", 0),
    ],
)
def test_python_comments_act_in_their_place(lathe, line, found):
    """LinuxCNC runs one after a semicolon if the line begins with it."""
    for program in (
        [FIRST, "#7=0", "G1 X15 F100", line, "G1 X9", "(DEBUG,#7)", "M2"],
        section("G1 X15", line, "G1 X9", before=["#7=0"], after=["(DEBUG,#7)"]),
    ):
        traced = lathe.trace_text(program)
        assert traced.error is None, traced.error
        assert texts(traced) == [f"{found:.6f}"]


FILES = {  # how the lines of a section become a file
    "crlf": lambda lines: "\r\n".join([*lines, ""]),
    "empty lines": lambda lines: "\n\n".join([*lines, ""]),
    "blanks": lambda lines: " \t\n".join([*lines, ""]),
    "percents": lambda lines: "\n".join(["%", *lines, "%"]),
    "without a last newline": "\n".join,
    "not utf-8": lambda lines: "\n".join(lines).replace("X12", f"X12 (Fläche \xb0{'ä' * 200})"),
}


@pytest.mark.parametrize("kind", FILES)
def test_a_file_is_cut_however_it_is_written(lathe, tmp_path, kind):
    program = tmp_path / "cut.ngc"
    lines = section("G1 X12", "U-2", "o1 repeat [2]", "H1", "o1 endrepeat", "X9 C0", after=["X30"])
    program.write_bytes(FILES[kind](lines).encode("latin-1"))
    assert ends(lathe.trace(program)) == [(12, 0), (10, 0), (10, 2), (9, 0), (30, 0)]


@pytest.mark.parametrize("word", ["X12", "U-8"])
def test_lines_as_long_as_the_parser_reads(lathe, word):
    assert ends(cut(lathe, f"G1 {word}".ljust(252), "C1")) == [(12, 0), (12, 1)]
    traced = cut(lathe, f"G1 {word}".ljust(300), "C1")
    assert traced.error.text == "G12.1 line 6: Command too long"
    assert traced.error.line == 6


# ---------------------------------------------------------------- line numbers


def test_line_numbers_inside_and_behind(lathe):
    body = ["G1 X12", "(one)", "U-1", "", "H2 (two)", "o1 if [1]", "X8", "o1 endif"]
    traced = cut(lathe, *body, after=["X31", "(MSG, x)", "X32"])
    assert lines(traced) == [6, 8, 10, 12, 15, 17]
    assert lines(cut(lathe, "G1 X12", "U-1", "", after=["X31"])) == [6, 7, 10]


def test_off_outside_the_mode_does_nothing(lathe):
    traced = lathe.trace_text([FIRST, "G13.1", START, "F100", "G1 X15", "G13.1", "M2"])
    assert ends(traced) == [(15, 0)]


def test_the_spindle_in_use_gives_the_feed_per_revolution():
    overrides = {"TRAJ": {"SPINDLES": "2"}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        body = ["G99 F.1 G1 X15", "S3000 $1", "X14", "S50 $0", "X13"]
        traced = lathe.trace_text(section(*body, before=["M3 S100 $0", "M3 S2000 $1"]))
        wrong = lathe.trace_text(section("S100 $2"))
    assert [round(move.feed) for move in feed_moves(traced)] == [10, 10, 5]
    assert wrong.error.text == "G12.1 line 6: $2: this machine has 2 spindles"


def test_a_sub_whose_line_has_the_number_of_the_line_before_it(tmp_path):
    sub = ["o<far> sub", *[""] * 6, "G41 G1 X20", "C-15", "G40 X30", "o<far> endsub"]
    (tmp_path / "far.ngc").write_text("\n".join([*sub, ""]))
    overrides = {"RS274NGC": {"SUBROUTINE_PATH": f"{tmp_path}:../../ngc:subs"}}
    with Tracer(SIM / "lathe_mm.ini", overrides=overrides) as lathe:
        program = section("(six)", "(seven)", "G1 X30 C9", "o<far> call", start="G0 X40 Z5 C0")
        assert feed_moves(lathe.trace_text(program))[0].line == 8


# ---------------------------------------------------------------- waiting for the machine


def test_waiting_for_an_input_before_and_behind_compensation(lathe):
    body = ["G1 C9", "G41 X12", "C-9", "G40 X20", "X15"]
    waited = cut(lathe, body[0], "M66 P0 L0", *body[1:4], "M66 P0 L0", body[4])
    assert ends(waited) == ends(cut(lathe, *body))
