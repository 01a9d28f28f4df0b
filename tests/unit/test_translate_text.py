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
from g12.tools.translate.program import translate_program
from support.growth import growth
from support.sim_machines import ROOT

HAAS, FANUC = read_control("haas-mill"), read_control("fanuc-mill")
LATHE, HAAS_LATHE = read_control("fanuc-lathe"), read_control("haas-lathe")
PAGE = ROOT / "python" / "g12" / "tools" / "translate" / "README.md"
MILL = "(HEAD)\nG20 G90 G54 G0 X0 Y0 Z1.\n"
TURN = "(HEAD)\nG0 X50. Z5.\n"


def lines(control, text, **options):
    """Return the lines of a translation that must succeed."""
    result = translate_program(text, control, **options)
    assert result.refused == []
    return result.text.splitlines()


def lines_after(control, text, head=None):
    """Return the lines after those of a head."""
    head = head or (TURN if control.is_lathe else MILL)
    return lines(control, head + text)[head.count("\n") :]


def sentence(control, text, **options):
    """Return the first refusal of a text: its line and its sentence."""
    result = translate_program(text, control, **options)
    assert (result.text, bool(result.refused)) == ("", True)
    return result.refused[0]


# ---------------------------------------------------------------- lines, comments, text


def test_a_line_stays_a_line_and_further_ones_say_theirs():
    translated = lines_after(HAAS, "G154 P2 G0 X1.\n\n(PLAIN)\nG0 X2. M98 P5\nM30\nO5\nM99\n")
    assert translated == [
        "o<unset_2> if [[#4011 EQ 0] AND [#4012 EQ 0] AND [#4013 EQ 0]] (G154 P2 overwrites G59.3)",
        "(line 3) (MSG, G154 P2 was never set, it counts as 0: X is #4011)",
        "o<unset_2> endif (line 3)",
        "G10 L2 P9 R0 G59.3 #5381=#4011 #5382=#4012 #5383=#4013 (line 3)",
        "G0 X1. (line 3)",
        "",
        "(PLAIN)",
        "G0 X2.",
        "M98 P5 (line 6)",
        "M30",
        "O5",
        "M99",
    ]


def test_numbers_keep_their_text():
    assert lines_after(HAAS, "G01 X+1.500 Y-.50 F010.\nM30\n")[0] == "G01 X+1.500 Y-.50 F010."


@pytest.mark.parametrize(
    ("comment", "kept"),
    [
        ("(A (B) C)", "(A [B] C)"),
        ("(MSG, HELLO)", "(- MSG, HELLO)"),
        ("( print,#1)", "(- print,#1)"),
        ("(DEBUG,X)(LOG,Y)", "(- DEBUG,X)(- LOG,Y)"),
        ("(PY,x=1)", "(- PY,x=1)"),
        ("(AXIS,hide)", "(- AXIS,hide)"),
        ("(ABORT, no)", "(- ABORT, no)"),
        ("(SÄGE 5° — ½)", "(SÄGE 5° — ½)"),
        ("(X;Y)", "(X,Y)"),
        ("{BRACES}", "(BRACES)"),
        ("(ONE { BRACE)", "(ONE { BRACE)"),
        ("(TAB\tHERE)", "(TAB HERE)"),
    ],
)
def test_comments_stay_and_do_nothing(comment, kept):
    assert lines_after(HAAS, f"{comment}\nM30\n")[0] == kept


def test_words_that_a_cycle_does_not_use_are_comments_in_their_order():
    for words, kept in (("Q.1 P500", "(Q.1)(P0.5)"), ("P500 Q.1", "(P0.5)(Q.1)")):
        assert (
            lines_after(HAAS, f"G81 X1. Z-.5 R.1 {words} F8.")[0] == f"G81 X1. Z-.5 R.1 F8. {kept}"
        )


def test_a_comment_that_has_no_room_has_lines_of_its_own():
    translated = lines_after(HAAS, f"G0 X1. ({'A' * 300})\nM30\n")
    assert translated[:3] == ["G0 X1.", f"({'A' * 200}) (line 3)", f"({'A' * 100}) (line 3)"]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends(end):
    assert lines_after(HAAS, "G0 X1.\nM30\n".replace("\n", end)) == ["G0 X1.", "M30"]


def test_blanks_and_small_letters_do_not_count():
    assert lines_after(HAAS, "g 0 x 1 . 5 y - 2 .\nM30\n")[0] == "G0 X1.5 Y-2."


def test_bytes_of_any_kind_are_text():
    assert program_text(b"(\xe4)") == program_text("(ä)".encode()) == "(ä)"
    assert program_text(b"\xef\xbb\xbfG0") == "\ufeffG0"
    assert lines(HAAS, "\ufeff%\nG0 X0\nM30\n")[0].endswith("(%)")


def test_what_is_after_the_percent_sign_is_a_comment():
    assert lines(HAAS, "%O5°(A)\nG0 X0\nM30\n")[0].endswith("(%O5°)(A)")


def test_a_minus_sign_is_a_minus_and_a_dash_is_not():
    assert lines_after(HAAS, "X\N{MINUS SIGN}1.\nM30\n")[0] == "X-1."
    assert sentence(HAAS, "G0 X\N{EN DASH}1.\n").sentence.startswith("X has no value: –1.")


def test_several_blocks_on_a_line():
    assert lines_after(HAAS, "G0 X1.; Y1.;\nM30\n")[:2] == ["G0 X1.", "Y1. (line 3)"]


def test_a_program_that_nobody_calls_is_a_comment():
    assert lines_after(HAAS, "M30\nO5\nG47 X1.\nM99\n")[1:] == [
        "(not reached: O5)", "(not reached: G47 X1.)", "(not reached: M99)",
    ]  # fmt: skip


def test_a_file_without_a_block_is_refused():
    assert sentence(HAAS, "%\n(COMMENT)\n%\n") == (1, "there is no block in the file")


def test_a_line_that_linuxcnc_would_cut_is_refused():
    assert "at most 254" in sentence(HAAS, f"#1={'+'.join(['#2'] * 90)}\n").sentence


# ---------------------------------------------------------------- numbers


def test_least_increments_follow_the_units(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text('based_on = "fanuc-mill"\ndecimals = "least"\n')
    own = read_control(str(path))
    assert lines_after(own, "G21 G0 X1234\nM30\n", "(HEAD)\n")[0] == "G21 G0 X1.234"
    assert lines_after(own, "G20 G0 X1234\nM30\n", "(HEAD)\n")[0] == "G20 G0 X0.1234"
    assert "neither G20 nor G21" in sentence(own, "G0 X1234\n").sentence
    path.write_text('based_on = "fanuc-mill"\ndecimals = "whole"\n')
    whole = read_control(str(path))
    assert lines_after(whole, "G0 X1234\nM30\n", "(HEAD)\n")[0] == "G0 X1234"


# ---------------------------------------------------------------- codes


def test_zeros_of_an_axis_that_the_machine_lacks_are_dropped():
    written = lines_after(HAAS, "G0 X1. A0. B0\nA0.\nG1 Y1. A0 F5.\nM30\n")
    assert written[0] == "G0 X1. (A0.: no A here)(B0: no B here)"
    assert written[1:3] == ["(A0.: no A here)", "G1 Y1. F5. (A0: no A here)"]
    blocks = "G28 A0.|G53 A0.|G91 G28 A0|G92 A0.|#1=0\nG0 A#1|G81 X0 Z-1. R.1\nA0."
    for block in blocks.split("|"):
        assert "the axes XYZ" in sentence(HAAS, f"{MILL}G0 F5.\n{block}\nM30\n").sentence, block


def test_an_m_code_that_the_machine_knows_stays():
    known = frozenset(["M31", "M88", "M137"])
    text = f"{MILL}M31\nM88\nM137\nM30\n"
    assert lines(HAAS, text, machine_codes=known)[2:] == ["M31", "M88", "M137", "M30"]
    assert lines_after(HAAS, "M31\nM88\nM30\n") == ["(M31)", "M88", "M30"]
    refused = sentence(HAAS, f"{MILL}M88\nM30\n", machine_codes=frozenset())
    assert (refused.line, refused.sentence[:24]) == (3, "M88 is the machine build")


@pytest.mark.parametrize(
    ("control", "block", "start"),
    [
        (HAAS, "G68 X0", "G68 needs R, the angle"),
        (HAAS, "G52 X0 Y1.\nG68 R9.\nG52 X[0.] Y1. Z3.\nG52 Y0", "a local offset within G68"),
        (HAAS, "#1=1.\nG52 X#1\nG68 R9.\n#1=2.\nG52 X#1", "a local offset within G68"),
        (HAAS, "G76 X1. Z-1.", "G76: fine boring"),
        (HAAS, "G-1 X1.", "G-1 is not known of haas-mill"),
        (HAAS, "G#1 X1.", "G#1: a code must be a number"),
        (HAAS, "G0 G1 X1.", "G0 and G1 in one block"),
        (HAAS, "G0 X1. X2.", "X is given twice in this block"),
        (HAAS, "G0 U1.", "U1. is not understood in this block"),
        (HAAS, "G0 X", "X has no value"),
        (HAAS, "G1 X1. R.1 F5.", "R beside G1: write the arc of the corner"),
        (HAAS, "G1 X1. ,C.1 F5.", ",C.1: a corner that is broken or rounded by a word"),
        (HAAS, "G84 Z-1. R.1 J2 F5.", "G84 with J is not translated"),
        (LATHE, "G10.9 X2.", "G10.9 needs X0, radii, or X1, diameters, and no other axis"),
        (HAAS, "G0 X1.)", ") without its opening bracket before it"),
        (HAAS, "G0 X1. {a", "a comment is not closed: } is missing"),
        (HAAS, "H1", "H without G43"),
        (HAAS, "G43 Z1.", "G43 without H"),
        (HAAS, "G41 X1.", "G41 or G42 without D"),
        (HAAS, "G19 G41 D1 Y1. F5.", "G41 or G42 in G19: LinuxCNC compensates in G17 and G18"),
        (HAAS, "G4", "G4 needs its time as P, once"),
        (HAAS, "G4 P-1", "P-1: a time below 0"),
        (FANUC, "G4 P1.5", "P1.5: milliseconds have no decimal point"),
        (FANUC, "G4 X5", "X5 has no decimal point: thousandths or seconds?"),
        (HAAS, "G30 P3 Z0", "G30 P3: LinuxCNC has two reference points"),
        (HAAS, "G91 G53 Z0", "G53 under G91"),
        (HAAS, "G81 R.1", "G81 without Z"),
        (HAAS, "G83 Z-1. R.1", "G83 needs Q"),
        (HAAS, "G81 Z-1. R.1 L0 X1.", "G81 with L0 only stores"),
        (HAAS, "G154 P100", "G154 P100 must be from 1 to 99"),
        (HAAS, "G54 G154 P1", "G54 and G154 in one block"),
        (HAAS, "G154", "G154 needs P and a whole number"),
        (HAAS, "G10 L5 P1 X1.", "G10 needs L2"),
        (HAAS, "G10 L12 P3 G91 R.1", "G10 for the diameter of T3"),
        (HAAS, "M98", "M98 needs P"),
        (HAAS, "M98 P5 Q7", "M98 P with Q7: a program is called from its beginning"),
        (HAAS, "M99 P5", "there is no N5 in this program"),
        (HAAS, "GOTO#1", "GOTO #1: only a number of a block is translated"),
        (HAAS, "M19 R1. P2", "M19 with R and P"),
        (HAAS, "G65 P5 O1", "O1 cannot be an argument"),
        (HAAS, "G65 P5 X1", "X1 has no decimal point: write X1."),
        (HAAS, "IF[1 EQ 1] WHILE[#1 LT 2]DO1", "after IF […] only GOTO, #… = … and words"),
        (HAAS, "WHILE[1 EQ 1]", "WHILE […] needs DO"),
        (HAAS, "DO1", "DO without WHILE"),
        (HAAS, "END1", "END1 without WHILE"),
        (HAAS, "WHILE[1 EQ 1]DO1", "WHILE […] DO1 has no END1"),
        (HAAS, "#1=#4001", "#4001 means something else"),
        (HAAS, "#1=#[2400+#3026]", "#[2400 + #5400]: #2400 means something else"),
        (HAAS, "#1=#3020\n#102=#1+1\nX#102", "this depends on the control's clock"),
        (HAAS, "IF[#3001GT5.]X1.", "this depends on the control's clock"),
        (HAAS, "G0 X#0", "X has no value: #0, the empty variable"),
        (HAAS, "G0 X[#1EQ#0]", "X: #0, the empty variable, is translated in conditions only"),
        (HAAS, "IF[#1EQ#0]THEN#1=2.", "#0, the empty variable, is translated in a program of G65"),
        (HAAS, "#1=[#2 AND 3]", "AND is translated between comparisons"),
        (HAAS, "#1=1 EQ 2 EQ 3", "two comparisons in a row"),
        (HAAS, "#1=#2*3 MOD 2", "MOD beside other operators"),
        (HAAS, "G0 X[ROUND[#1]]", "X: ROUND in a word rounds to the least increment there"),
        (HAAS, "G0 X1. ?", "? does not start with a word"),
        (HAAS, "#1=BIN[#2]", "BIN[#2] is no number, variable or function"),
        (HAAS, "#1=[[[[[[[[[1]]]]]]]]]", "more than 8 brackets"),
        (HAAS, "#1=[1", "] is missing before the end"),
        (LATHE, "T30303", "T30303 has 5 digits"),
        (LATHE, "G0 X1. U1.", "U1. and X in one block"),
        (LATHE, "G50", "G50 needs S, a speed limit, or X and Z"),
        (LATHE, "G12.1 X5.", "G12.1 moves nothing"),
        (LATHE, "G107", "G107 needs C"),
        (LATHE, "G12.1\nG41 G1 X10. D5", "D5 in polar mode"),
        (HAAS_LATHE, "G112\nG0 X1.", "G0 in polar mode: its speed needs the units"),
    ],
)  # fmt: skip
def test_what_is_refused_is_reported(control, block, start):
    head = TURN if control.is_lathe else MILL
    refused = sentence(control, f"{head}{block}\nM30\n")
    assert refused.line == 2 + 1 + block.count("\n")
    assert refused.sentence.startswith(start)


@pytest.mark.parametrize(
    ("blocks", "line", "start"),
    [
        ("GOTO5\nWHILE[#1LT2]DO1\nN5 X1.\nEND1", 3, "N5 is in a loop: no jump leads into"),
        ("N5 X1.\nGOTO5", 4, "the program never ends"),
        ("/WHILE[#1LT2]DO1\nEND1", 3, "the head or the end of a loop cannot be skipped"),
        ("M98 P5\nN1 M30\nO5\n/M99\nM99 P1", 7, "M99 with and without P in one program"),
        ("M98 P5 L2\nN1 M30\nO5\nM99 P1", 3, "the called program returns by M99 P"),
        ("M98 P5\nM30\nO5\nG0 X[#1+1.]\nZ-#3\nWHILE[#1LT2]DO1\n#3=1.\nEND1\nM99", 7, "Z-#3: n"),
        ("G65 P5\nG65 P6\nM30\nO5\n#31=1\nM99\nO6\n#31=1\nM99", 10, "#31 is used in two pr"),
        ("G65 P5\nM30\nO5\nIF[#33EQ#0]GOTO9\nN9 M99", 6, "#33 EQ #0: no letter of G65"),
        ("G65 P5 A1.\nM30\nO5\nIF[#1EQ2]GOTO9\n#2=1\nN9 X#2\nM99", 8, "O5 reads #2 (B of"),
    ],
)  # fmt: skip
def test_jumps_and_variables_that_are_not_sound(blocks, line, start):
    refused = sentence(HAAS, f"{MILL}{blocks}\nM30\n")
    assert (refused.line, refused.sentence[: len(start)]) == (line, start)


@pytest.mark.parametrize(
    "blocks",
    [
        "G65 P5\nM30\nO5\nIF[[#2NE#0]AND[#3NE#0]]GOTO9\nM99\nN9 X#2 Y#3\nM99",
        "G65 P5\nM30\nO5\nIF[#2EQ#0]THEN#2=3.\nX#2\nM99",
        "M98 P5\nX#1\nM30\nO5\nIF[#100EQ1]THEN#1=2.\nM99",
        "G65 P5\nM30\nO5\nGOTO8\nN7 X#2\nM99\nN8 #2=1\nGOTO7\n",
    ],
)
def test_a_macro_that_asks_for_empty_variables(blocks):
    assert lines(HAAS, f"{MILL}{blocks}\n")


def test_a_jump_leaves_the_lines_between_at_their_numbers():
    text = "N1 G1 X1. F9.\n#1=#1+1\nIF[#1LT3]GOTO1\nX2.\nM30\n"
    assert lines_after(HAAS, text) == [
        "#<jump_2>=0",
        "o<jump_2> do (line 3)",
        "o<jump_2_0> if [#<jump_2> LE 0] (line 3)",
        "N1 G1 X1. F9. (line 3)",
        "#1=[#1 + 1]",
        "o<if_4> if [#1 LT 3]",
        "#<jump_2>=0 (line 5)",
        "o<jump_2> continue (line 5)",
        "o<if_4> endif (line 5)",
        "o<jump_2_0> endif (line 5)",
        "#<jump_2>=-1 (line 5)",
        "o<jump_2> while [#<jump_2> GE 0] (line 5)",
        "X2.",
        "M30",
    ]


def test_spindle_and_coolant_stop_after_a_cut():
    assert lines_after(HAAS, "G3 X1. R1. F9. M5 M9\nM30\n")[:-1] == [
        "G3 X1. R1. F9.",
        "M5 M9 (line 3)",
    ]
    assert lines_after(HAAS, "G0 X1. M9\nM30\n")[:-1] == ["G0 X1. M9"]


def test_the_orientation_of_the_spindle():
    assert lines_after(HAAS, "M19\nG0 X1. M19 R90.\nM19 P45\nM30\n")[:4] == [
        "M19 Q30", "M19 R90. Q30", "G0 X1. (line 4)", "M19 R45 Q30",
    ]  # fmt: skip


def test_a_number_whose_unit_is_not_said():
    refused = sentence(FANUC, "G0 X0\nG1 X1. F60\n")
    assert refused.sentence.endswith("and neither is programmed before it (--units)")


ROUGH = "G0 X2. Z.1\nG71 P1 Q2 U.02 W0 D.05 F.01\nN1 G0 X1.\nG1 Z-1.\nN2 X2.\nM30\n"


def test_a_setting_of_the_control_whose_unit_is_not_said():
    refused = sentence(HAAS_LATHE, f"G99 S99 M3\n{ROUGH}")
    assert refused.line == 3
    assert refused.sentence.startswith("the control's setting for the retract depends on G20")
    assert "G0 X2. Z-0.95 (line 3)" in lines(HAAS_LATHE, f"G20 G99 S99 M3\n{ROUGH}")


@pytest.mark.parametrize(
    ("before", "change"),
    [
        ("M3 S99", "T2 M6 G43 H2 M3"),
        ("M4 S99", "T2 M6 G43 H2 M4"),
        ("M3 S99\nM5", "T2 M6 G43 H2"),
        ("M3 S99\nM19", "T2 M6 G43 H2"),
        ("M3 S99\nM35", "T2 M6 G43 H2"),  # the spindle is C
    ],
)
def test_a_spindle_that_turns_is_started_again_after_a_tool_change(before, change):
    assert change in lines(read_control("doosan-lathe"), f"G0 X50. Z5.\n{before}\nT0202\nM30\n")


def test_the_spindle_of_a_bar_that_is_fed_in_a_loop():
    bar = "G0 X50. Z5.\nT0202 {}\nM3 S99\nG1 X1. F.1\nM99\n"
    assert "T2 M6 G43 H2 M5" in lines(LATHE, bar.format("M5"))
    refused = sentence(LATHE, bar.format("")).sentence
    assert "(say M3, M4 or M5 in the block of T)" in refused


def test_subprograms_with_names():
    okuma = read_control("okuma-lathe")
    text = "G0 X50. Z5.\nCALL OSUB1 Q2\nCALL O12\nM2\nOSUB1\nX40.\nRTS\nO12\nX41.\nRTS\n"
    assert lines_after(okuma, text, "(HEAD)\n") == [
        "G0 X50. Z5.", "M98 P6345645 L2", "M98 P12", "M2", "O6345645 (OSUB1)", "X40.", "M99",
        "O12", "X41.", "M99",
    ]  # fmt: skip
    missing = sentence(okuma, "CALL OSUB1\nM2\n").sentence
    assert missing.startswith("O6345645 (OSUB1) is not in this file")
    assert sentence(okuma, "CALL OSUBX1\n").sentence.startswith("CALLOSUBX1: only a program and Q")


def test_a_speed_limit_within_surface_speed_is_written_at_once():
    assert lines_after(LATHE, "G96 S90 M3\nG50 S900\nM30\n")[1] == "G96 S90 D900 (G50 S900)"


def test_the_end_of_a_loop_is_a_way_to_its_beginning():
    loop = "WHILE[#1LT2]DO1\nG53 Z0\nG91\n#1=#1+1\nEND1\nM30\n"
    assert sentence(HAAS, f"{MILL}#1=0\n{loop}").sentence.startswith(
        "G53 is absolute, but the dist"
    )


# ---------------------------------------------------------------- the order of programs


def test_a_main_program_after_its_subprograms_is_written_first():
    text = "%\nO5\nX1.\nM99\nO1 (MAIN)\nG20 G90 G0 X0\nM98 P5\nM30\n%\n"
    assert lines(HAAS, text) == [
        f"{' '.join(HAAS.start)} (%)",
        "(O1)(MAIN) (line 5)",
        "G20 G90 G0 X0 (line 6)",
        "M98 P5 (line 7)",
        "M30 (line 8)",
        "O5 (line 2)",
        "X1. (line 3)",
        "M99 (line 4)",
        "(%) (line 9)",
    ]


def test_a_subprogram_that_is_reached_in_two_modes_is_written_for_each():
    text = "M98 P5\nG91\nM98 P5\nM30\nO5\nG28 U5.\nM99\n"
    own = read_control("okuma-lathe")
    assert lines(own, f"G94 G0 X1.\n{text}")[3:] == [
        "G91",
        "M98 P10000005",
        "M30",
        "O5",
        "G28 X[2 * #5420 + [5.]]",
        "M99",
        "O10000005 (line 6)",
        "G28 X5. (line 7)",
        "M99 (line 8)",
    ]


def test_the_copies_of_a_subprogram_are_copied_with_what_they_call():
    text = "M98 P5\nG91\nM98 P5\nM30\nO5\nM98 P6\nM99\nO6\nG28 U5.\nM99\n"
    written = lines(read_control("okuma-lathe"), f"G94 G0 X1.\n{text}")
    calls = [line.partition(" (")[0] for line in written if line.startswith(("O", "M98"))]
    assert calls == [
        "M98 P5", "M98 P10000005", "O5", "M98 P6", "O6",
        "O10000005", "M98 P10000006", "O10000006",
    ]  # fmt: skip


def test_m97_calls_a_block_of_its_own_program():
    text = "O1\nG20 G90 G0 X0\nM98 P2\nM97 P100\nM30\n{}X1.\nM99\nO2\nM99\nN100 X5.\nM99\n"
    assert "N100 X1. (line 6)" in lines(HAAS, text.format("N100 "))
    refused = sentence(HAAS, text.format(""))
    assert refused == (4, "N100 is not in this program: M97 calls a block of it")


def test_a_block_number_that_two_programs_call_is_refused():
    text = "G20 G0 X0\nM97 P9\nM98 P2\nM30\nN9 X1.\nM99\nO2\nM97 P9\nM99\nN9 X2.\nM99\n"
    assert sentence(HAAS, text).sentence.startswith("N9 is in this file twice")


@pytest.mark.parametrize("head", ["", "%\n"])
def test_a_local_subprogram_that_begins_the_file_is_refused(head):
    refused = sentence(HAAS, f"{head}N100 G20 G0 X1.\nM97 P100\nM30\n")
    assert refused.sentence.startswith("N100 ")


def test_programs_are_not_compared_each_with_each():
    def planned(count):
        subs = "".join(f"O{n}\nM98 P{n - 1}\nM99\n" for n in range(2, count))
        text = f"G20 G0 X0\nM98 P{count - 1}\nM30\nO1\nM99\n{subs}"
        return lambda: lines(HAAS, text)

    assert planned(750)()[4] == "O749 (line 2247)"
    assert growth(planned, 150) < 10


# ---------------------------------------------------------------- cylinder, builder's words


@pytest.mark.parametrize(
    ("block", "written"),
    [
        ("G17XC", "G17 (X C)"),
        ("G17 U0 H0", "G17 (U0 H0)"),
    ],
)
def test_the_axes_that_a_plane_code_names_are_a_comment(block, written):
    assert lines_after(LATHE, f"{block}\nM30\n")[0] == written


def test_the_feed_comes_back_after_a_rapid_of_polar_mode():
    text = "G20 G98 G1 X5. F9.\nG112\nG0 X2. F8.\nG1 X1.\nG0 X2.\nG113\nG99 G1 X2.5\nX3.\nM30\n"
    written = lines_after(HAAS_LATHE, text, "(HEAD)\nG0 Z1.\n")
    assert [line for line in written if "X" in line] == [
        "G20 G94 G1 X5. F9.",
        "X2. G1 G94 F100",
        "G1 X1. F8. G94",
        "X2. G1 G94 F100",
        "G95 G1 X2.5 F8.",
        "X3.",
    ]


@pytest.mark.parametrize(
    ("cut", "written"),
    [
        ("G81 Z-.5 R.2", "G1 Z-0.5 (line 9)"),
        ("G83 Z-.5 R.2 Q9.", "G1 Z-0.5 (line 9)"),
        ("G90 X.3 Z-.5", "G1 Z-0.5 (line 9)"),
    ],
)
def test_a_cut_after_a_rapid_of_polar_mode_has_the_programs_feed(cut, written):
    text = f"G1 X5. F9.\nG112\nG1 X4.\nG0 X5.\nG113\nG0 X1. Z1.\n{cut}\nM30\n"
    found = lines_after(HAAS_LATHE, text, "(HEAD)\nG20 G98 G0 X6. Z6.\n")
    outside = found[found.index("G13.1") : found.index(written) + 1]
    assert "G0 X1. Z1." in outside
    assert any("F9. G94" in line for line in outside)


def test_cylinder():
    text = "G107 C25.\nG1 Z-5. C30.\nU1. W2. H3.\nG41 D1 Z0\nG7.1 C0\nM30\n"
    translated = lines_after(LATHE, text, "(HEAD)\nT101\nG0 X50. Z5.\n")
    assert translated == [
        "G7.1 C25.", "G1 Z-5. C30.", "U1. W2. H3.", "G41 Z0", "G7.1 C0", "M30",
    ]  # fmt: skip


def test_a_cylinder_onto_which_y_is_mapped():
    text = "G107 Y0 C0 {}\nG1 Y2. F9.\nG2 Y3. Z-1. J1. K0\nV1. W1.\nG107\nX3.\nM30\n"
    translated = lines_after(HAAS_LATHE, text.format("R2."), "(HEAD)\nG20 G0 X1. Z1.\n")
    assert translated == [
        "G7.1 C2.",
        "G1 C[[2.] * 57.295779513082 / 2.] F9.",
        "G2 C[[3.] * 57.295779513082 / 2.] Z-1. J1. K0",
        "H[[1.] * 57.295779513082 / 2.] W1.",
        "G7.1 C0",
        "G2 X3.",
        "M30",
    ]
    assert lines_after(HAAS_LATHE, text.format("Q4."))[0] == "G7.1 C[4. / 2]"
    refused = sentence(HAAS_LATHE, "G107 C25.\nM30\n").sentence
    assert refused == "G107 needs Y0, C0 and R or Q, radius or diameter; alone it ends"
    refused = sentence(HAAS_LATHE, "G0 X1.\nG107 Y0 C0 R2.\nG1 C3.\nM30\n").sentence
    assert refused.startswith("C while Y is mapped onto the cylinder")


def test_the_cylinders_code_and_word_are_those_of_the_machine():
    other = replace(LATHE, cylinder_code=("G107", "diameter"))
    assert lines_after(other, "G7.1 C25.\nG7.1 C0\nM30\n") == ["G107 C[2 * 25.]", "G107 C0", "M30"]


def test_the_polar_codes_are_those_of_the_machine():
    other = replace(LATHE, polar_codes=("G12.3", "G13.3"))
    assert lines_after(other, "G112\nG1 X40. F5.\nG113\nM30\n")[::2] == ["G12.3", "G13.3"]


def test_the_word_of_the_cylinder_is_the_controls_and_the_machines():
    tables = {**LATHE.tables, "cylinder": {"word": "diameter"}}
    other = replace(LATHE, tables=tables, cylinder_code=("G7.1", "radius"))
    assert lines_after(other, "G107 C25.\nG107 C0\nM30\n")[0] == "G7.1 C[25. / 2]"


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


# ---------------------------------------------------------------- hostile text

PARTS = """
G0 G1 G2 G28 G53 G91 G90 G81 G80 G10 L2 L10 G154 G65 M98 M97 M99 M30 P1 P100 O1 O100 N100
X1. Y-1 Z.5 U1. W-2. H0 T0101 G12.1 G13.1 G112 G50 S100 G96 #1=2 #100=[1+2] WHILE[#1LT2]DO1
G70 G71 G73 G76 G90 G92 G94 G32 P1 Q2 N1 N2 D.5 M24 G68 G69 G72 I1. J0. L3 ,C1. ,R2. ,A30. X0 M99
END1 IF[#1EQ1]THEN#2=3 GOTO5 K0 L0 R Q.1 D1 G41 G40 ( ) [ ] % ; / # = é
"""
WORDS = st.sampled_from([*PARTS.split(), *"\n\n\n\n\0\t "])


@hypothesis_settings(max_examples=300)
@given(st.lists(WORDS, max_size=60), st.sampled_from([HAAS, FANUC, LATHE, HAAS_LATHE]))
def test_any_text_is_translated_or_refused(words, control):
    result = translate_program("".join(words), control)
    assert bool(result.text) != bool(result.refused)
    for line in result.text.splitlines():
        assert len(line.encode()) <= 254


@given(st.text(max_size=200))
def test_any_characters_are_translated_or_refused(text):
    result = translate_program(text, HAAS)
    assert bool(result.text) != bool(result.refused)


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
        text = f"{MILL}{start}{part * count}{end}\nM30\n"
        return lambda: translate_program(text, HAAS)

    assert growth(planned, 8000 // len(part)) < 10


# ---------------------------------------------------------------- C beside a slide


@pytest.mark.parametrize(
    ("control", "text", "line", "start"),
    [
        (LATHE, "G1 X40. C30. F100.\n", 3, "C beside a slide at a feed: its time depends"),
        (LATHE, "G99 C0\nG1 X40. C30. F.1\n", 4, "C beside a slide needs a feed per minute"),
        (LATHE, "C0\nG1 X40. C30. F#100\n", 4, "C beside a slide at a feed: F must be a"),
        (
            LATHE,
            "G98 C0\nG1 X50.001 C30. F100.\nG55\nG1 Z0.\n",
            6,
            "a slide of LinuxCNC's is behind",
        ),
        (LATHE, "C0\nG2 X40. Z0 C30. R5. F9.\n", 4, "C beside an arc"),
        (HAAS_LATHE, "C0\nG1 X40. C30. F100.\n", 4, "C beside a slide at a feed: say what"),
    ],
)
def test_a_feed_of_c_that_cannot_be_known_is_refused(control, text, line, start):
    refused = sentence(control, f"G21 G98\n{TURN[7:]}{text}M30\n")
    assert refused.line == line
    assert refused.sentence.startswith(start)


def test_c_that_does_not_turn_or_slides_that_stand_need_no_other_feed():
    text = "G1 X40. C0 F100.\nX40. C30.\nG0 X50. C40.\n"
    head = "G21 G98\nG0 X50. Z5. C0\n"
    assert lines_after(LATHE, f"{text}M30\n", head)[1:] == [*text.splitlines(), "M30"]


# ---------------------------------------------------------------- all that is missing, at once


def test_all_that_a_control_lacks_is_named_at_once(tmp_path):
    text = "G21\nM51\nG5.3 Y3.\nM52 M14\nG0 X1\nM30\n"
    control = read_control("okuma-lathe")
    missing = translate_program(text, control, frozenset(("M14",))).missing
    assert [line for line in missing if line[0] != "["] == [
        'axes = "XZCY"',
        'decimals = "least" # or "whole"',
        '"G5.3" = "…" # "comment", "machine", "same" or codes of LinuxCNC',
        'M51 = "…" # "comment", "machine", "same" or codes of LinuxCNC',
        'M52 = "…" # "comment", "machine", "same" or codes of LinuxCNC',
    ]
    own = tmp_path / "own.toml"
    own.write_text('based_on = "okuma-lathe"\n' + "\n".join(missing).replace("…", "comment"))
    assert translate_program(text.replace("X1", "X1."), read_control(str(own))).missing == []


def test_every_refused_block_is_named_with_its_reason():
    refused = translate_program("G31\nG66\nG31\nG4\nM30\n", LATHE).refused
    sentence = translate.refusal_sentence(refused)
    assert sentence.startswith("1: G31: a skip function: LinuxCNC probes with G38.2; line 3 too; ")
    assert sentence.endswith(
        "; line 2: G66: a modal macro: write G65 in each block; line 4: G4 "
        "needs its time as X or U or P, once"
    )


# ---------------------------------------------------------------- text as shops have it


@pytest.mark.parametrize("head", ["(A)\n%\nO5\n", "O1\n%\nO5\n"])
def test_what_is_before_the_first_percent_sign_is_no_program(head):
    translated = lines(HAAS, f"{head}G20 G0 X1.\nM30\n%\nG0 X9.\n")
    assert translated[head.count("\n") :] == ["G20 G0 X1.", "M30", "(%)", "(not reached: G0 X9.)"]
    assert not any(line.startswith("O") for line in translated)


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("G0 X2.; rapid to the part", ["G0 X2. (rapid to the part)"]),
        ("G0 X2. ; 2 mm above Z0; ---", ["G0 X2. (2 mm above Z0)(---)"]),
        ("G0 X2.; Y3.", ["G0 X2.", "Y3. (line 3)"]),
    ],
)
def test_what_cannot_be_words_is_a_remark(text, kept):
    assert lines_after(HAAS, f"{text}\nM30\n")[: len(kept)] == kept


@pytest.mark.parametrize(
    ("control", "text", "part"),
    [
        (LATHE, "$1", "$1 begins the program of one of two channels"),
        (HAAS, "G54:", "G54: is a label, which these controls do not have"),
        (HAAS, "M98 P7\nM30\nN7 M99", "O7 is not in this file, but N7 is: M97 P calls a block"),
    ],
)
def test_other_texts_are_named_as_what_they_are(control, text, part):
    assert part in sentence(control, f"{MILL if control is HAAS else TURN}{text}\nM30\n").sentence


# ---------------------------------------------------------------- sections


SECTION = "(HEAD)\nG98 G0 X60. Z2. C0\nG12.1\n"


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("G1 X50. C5. W-1. F100.", ["G1 X50. C5. Z1. F100."]),
        ("G1 X[#1] C5. W[#2] F100.", ["G1 X[#1] C5. Z[#5422 + [[#2]]] F100."]),
        ("G42 G1 X60. C0 F9.\nX50.", ["G1 F9. (G42 with the next move)", "G42 X50."]),
        ("G41 G1 X50. F9.\nG40 G1 Z9.\nZ8.\nX70.",
         ["G41 G1 X50. F9.", "G1 Z9. (G40 with the next move)", "Z8.", "G40 X70."]),
        ("G1 X50. C1. Z2. F9.", ["G1 X50. C1. F9. (Z2.)"]),
    ],
)  # fmt: skip
def test_a_section_as_shops_write_it(text, written):
    translated = lines_after(LATHE, f"{text}\nG13.1\nM30\n", SECTION)
    assert translated[: len(written)] == written


def test_what_a_section_lacks_is_named():
    refused = sentence(LATHE, f"{SECTION}G41 G1 X50. F9.\nG40 Z9.\nG13.1\nM30\n")
    assert (refused.line, refused.sentence[:29]) == (6, "G40 is after the last move of")
    haas = replace(HAAS_LATHE, tables={**HAAS_LATHE.tables, "polar": {"rapid": "feed"}})
    text = "G21 G0 X60. Z2.\nG107 Y0 C0 R20.\nG0 Y1.\nM30\n"
    assert sentence(haas, text) == (
        3,
        "G0 on a cylinder needs its speed: say rapid_feed_mm under [polar]",
    )


def test_diameters_of_c_and_the_speed_of_a_live_tool(tmp_path):
    own = tmp_path / "own.toml"
    own.write_text('based_on="fanuc-lathe"\npolar.c="diameter"\nm_codes.M133="M3 $1 S=P"\n')
    text = "M133 P1500\nG1 X50. C8. F9.\n"
    translated = lines_after(read_control(str(own)), f"{text}G13.1\nM30\n", SECTION)
    assert translated[:2] == ["M3 $1 S1500", "G1 X50. C[8. / 2] F9."]


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


@pytest.mark.parametrize(("name", "text", "expected"), LIVE_TOOLS)
@pytest.mark.parametrize(("spindle", "dollar"), [("1", True), ("0", False)])
def test_the_live_tool_is_a_spindle_of_the_machine(tmp_path, name, text, expected, spindle, dollar):
    (tmp_path / "m.ini").write_text(f"{TWO}[G12]\nLIVE_SPINDLE = {spindle}\n")
    control = translate.with_facts_of(read_control(name), read_ini(tmp_path / "m.ini"))
    expected = expected if dollar else [re.sub(r" \$\S+", "", line) for line in expected]
    assert lines_after(control, f"{text}\nM30\n", TURN)[:-1] == expected
    (tmp_path / "m.ini").write_text(TWO)
    control = translate.with_facts_of(read_control(name), read_ini(tmp_path / "m.ini"))
    assert "say [G12] LIVE_SPINDLE" in sentence(control, f"{TURN}{text}\nM30\n").sentence


def test_p_names_a_spindle_beside_m3_only():
    doosan = read_control("doosan-lathe")
    assert sentence(doosan, f"{TURN}S9 M3 P13\nM30\n").sentence == (
        "P13: no spindle of the machine: there are P11, P12"
    )
    assert "M98 P12" in lines(doosan, f"{TURN}M98 P12\nM30\nO12\nM99\n")


@pytest.mark.parametrize(
    ("ini", "expected"),
    [
        ("", ["(M35)", "(M89)", "(M90)", "(M34)"]),
        (
            "[G12]\nC_CLAMP = M10 M11\n[RS274NGC]\n"
            "REMAP = M254 modalgroup=10 prolog=spindle_c_on ngc=spindle_c_on\n"
            "REMAP = M255 modalgroup=10 prolog=spindle_c_off ngc=spindle_c_off\n",
            ["M254", "M10", "M11", "M255"],
        ),
    ],
)
def test_clamp_and_c_are_the_machines_own(tmp_path, ini, expected):
    (tmp_path / "m.ini").write_text(TWO + ini)
    control = translate.with_facts_of(read_control("doosan-lathe"), read_ini(tmp_path / "m.ini"))
    assert lines_after(control, "M35\nM89\nM90\nM34\nM30\n", TURN)[:-1] == expected
    codes = frozenset(code for code in expected if code[0] == "M")
    parted = lines(control, f"{TURN}M35 M89\nM30\n", machine_codes=codes)[2:]
    assert parted[:2] == (["M254", "M10 (line 3)"] if codes else ["(M35)(M89)", "M30"])


def test_zeros_of_axes_that_the_machine_lacks():
    integrex = read_control("mazak-integrex")
    assert lines_after(integrex, "G0 G53 X9. Y0.\nG0 G53 B0.\nM30\n", TURN)[:2] == [
        "G0 G53 X9. (Y0.)",
        "G0 (G53)(B0.)",
    ]
    assert lines_after(integrex, "G28 V0.\nM30\n", TURN)[0] == "(G28)(V0.)"
    assert "axes XZC" in sentence(integrex, f"{TURN}G0 B90.\nM30\n").sentence
    assert "axes XZC" in sentence(integrex, f"{TURN}G0 Y1.\nM30\n").sentence


def test_x_as_radii_by_g10_9():
    integrex = read_control("mazak-integrex")
    head = "(HEAD)\nG21 G10.9 X0\nG0 X50. Z5. C0.\n"
    inside = "G12.1\nG1 X20. F100.\nG13.1\nG10.9 X1\nG0 X60.\nM30\n"
    same = ["G12.1", "G1 X20. F100.", "G13.1"]
    behind_it = ["G7", "G0 X60.", "M30"]
    assert lines(integrex, head + inside)[1:] == [
        "G8 G21", "G0 X50. Z5. C0.", *same, *behind_it,
    ]  # fmt: skip
    fanuc = [re.sub(r" \(line.*", "", line) for line in lines(LATHE, head + inside)]
    assert fanuc[3:8] == ["G7", *same, "G8"]
    refused = sentence(LATHE, f"{head}G90 X9. Z1. F9.\nM30\n").sentence
    assert refused == "a turning cycle where X words are radii: write G10.9 X1 before it"


def test_y_alone_beside_g41_of_a_haas_moves():
    text = "G20 G0 X2. Z.1 C0\nG112\nG1 X1. Y0 F9.\nG41 Y.5\nG40 Y1.\nG113\nM30\n"
    assert [line for line in lines(HAAS_LATHE, text) if "G4" in line[:4]] == [
        "G41 C.5", "G40 C1.",
    ]  # fmt: skip


def test_a_place_of_g28_that_was_never_set_is_said(tmp_path):
    (tmp_path / "m.ini").write_text("[RS274NGC]\nPARAMETER_FILE = m.var\n[TRAJ]\nLINEAR_UNITS=mm\n")
    for value, said in (("0.0", True), ("-1.5", False)):
        (tmp_path / "m.var").write_text(f"5161\t0.0\n5163\t{value}\n5181 0\n")
        control = translate.with_facts_of(HAAS, read_ini(tmp_path / "m.ini"))
        text = translate_program("G20 G0 X1.\nG91 G28 Z0\nM30\n", control).text
        assert ("(G28.1 was never set on this machine: machine zero)" in text) == said


@pytest.mark.parametrize("block", ["N1 X10. ,A90. ,R1.", "G71 U1.\nG71 P1 Q2\nN1 X1.\nN2 ,C1."])
def test_drawing_that_goes_nowhere_is_refused(block):
    assert sentence(LATHE, f"G21 G98 G1 F9.\nX10. Z5.\n{block}\nM30\n")


def test_an_arc_without_a_centre_in_a_contour_is_named():
    text = "G21 G99 S9\nG0 X50. Z2.\nG71 U2. R1.\nG71 P1 Q2\nN1 G0 X9.\nG3 X19. Z-5. R5.\nN2 Z-9.\n"
    assert sentence(LATHE, text).sentence == "line 7: G3 needs R, or I and K; a line is G1"


def test_a_program_that_begins_again_may_rough(tmp_path):
    text = (
        "G21 G99 S9\nG0 X50. Z2.\nG71 U2. R1.\nG71 P1 Q2 U1.\nN1 G0 X20.\nG1 Z-5.\nN2 X50.\nM99\n"
    )
    assert lines(LATHE, text)[-1] == "M99"
    refused = sentence(LATHE, text.replace("G71 U2. R1.", "G71 U2.").replace("M99", "G71 R3.\nM99"))
    assert "retract here is not the same on every way" in refused.sentence
