# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands plot and verify as they are called: output, exit codes, wrong uses."""

import json
import re
from functools import partial

import pytest

from g12.tools.commands.main import main
from support.sim_machines import PROGRAMS, SIM, copy_of_machines

MILL, LATHE = (SIM / f"{name}_mm_headless.ini" for name in ("mill", "lathe"))
HEXAGON = PROGRAMS / "polar" / "hexagon.ngc"
HEAD = "G21 G17 G40 G49 G54 G80 G90 G94 F600\nT4 M6 G43 S3000 M3\nG0 X0 Y0 Z1\n"
UP = "G0 Z30\nM2\n"
GOOD = HEAD + f"G12 I7 K20 Q6 Z-3 D4\n{UP}"
WIDE = HEAD + f"G12 I7 K40 Q15 Z-3 D4\n{UP}"
CORED = HEAD + f"G12 I18 K20 Q2 Z-3 D4\n{UP}"
PLAIN = HEAD + f"G1 X50 Y20 F300\n{UP}"
WRONG = HEAD + "G12 I4 Z-3 D4\nM2\n"
STILL = "G21\nM2\n"
THROUGH = HEAD + "G12 I7 K20 Q6 Z-3 D4\nG0 X60\nM2\n"  # a rapid through the wall


@pytest.fixture
def command(tmp_path, capsys):
    """Return a function: a command's exit code, what it printed and its errors."""

    def called(name, program, *words, ini=MILL):
        if isinstance(program, str):
            text, program = program, tmp_path / "program.ngc"
            program.write_text(text)
        code = main([name, str(program), "--ini", str(ini), *map(str, words)])
        return code, *capsys.readouterr()

    return called


@pytest.fixture
def verify(command):
    return partial(command, "verify")


@pytest.fixture
def as_json(verify):
    """Return a function: verify's exit code and report."""

    def report(*arguments, **options):
        code, out, _ = verify(*arguments, "--json", **options)
        return code, json.loads(out)

    return report


@pytest.fixture
def plot(command, tmp_path):
    """Return a function: plot's exit code, what it printed and its errors."""
    return lambda *arguments, to="x.svg", **options: command(
        "plot", *arguments, "-o", tmp_path / to, **options
    )


def test_a_right_pocket_ends_with_0(verify):
    code, out, err = verify(GOOD, "--strict")
    assert (code, err) == (0, "")
    assert out.startswith("line 4  G12 (haas)  ⌀ 40 to Z−3  0 mm off (0.005 allowed)  ")
    assert out.endswith(
        " s\n\nassumed: solid below Z0; the tool starts clear of it\n\nverdict: no finding\n"
    )


def test_a_finding_ends_with_1_and_is_reported(verify):
    code, out, _ = verify(WIDE)
    assert code == 1
    assert "findings\n  line 4: " in out and "remain uncut at Z−3 [uncut]\n" in out
    assert out.endswith("verdict: 1 finding\n")


def test_the_core_of_a_ring_is_said_in_its_line(verify):
    code, out, _ = verify(CORED.replace("I18 K20 Q2", "I20"), "--strict")
    assert code == 0 and ", a core of ⌀ 20 stays  0 mm off" in out
    cleared = GOOD.removesuffix(UP) + f"G0 X0 Y0 Z1\nG12 I20 Z-3 D4\n{UP}"
    assert "core" not in verify(cleared)[1]


def test_warnings_count_on_demand(verify):
    code, out, _ = verify(CORED)
    assert code == 0 and out.endswith("verdict: no finding, 1 warning\n")
    assert verify(CORED, "--strict")[0] == 1


def test_what_is_not_judged_is_in_the_verdict_and_counts_on_demand(verify):
    text = GOOD.replace("G0 Z30", "G53 G0 X0 Z0")
    code, out, _ = verify(text)
    assert (code, out.splitlines()[-1]) == (0, "verdict: no finding; not judged: rapid-by-machine")
    assert verify(text, "--strict")[0] == 1


def test_a_warning_is_accepted_in_the_program_or_by_an_argument(verify, as_json):
    expected = CORED.replace("D4", "D4 (g12: expect core)")
    for text, *words in (expected,), (CORED, "--accept", "core"):
        code, out, _ = verify(text, "--strict", *words)
        assert code == 0 and out.endswith("verdict: no finding\n")
        assert "accepted\n  line 4: a core of " in out
        assert [each["code"] for each in as_json(text, *words)[1]["accepted"]] == ["core"]


def test_an_acceptance_that_meets_nothing_is_a_warning(verify):
    code, out, _ = verify(GOOD, "--accept", "core")
    assert code == 0 and out.endswith("verdict: no finding, 1 warning\n")


def test_a_rapid_through_the_part_is_never_accepted(verify):
    code, out, _ = verify(THROUGH.replace("G0 X60", "G0 X60 (g12: expect rapid)"))
    assert code == 1 and "[rapid]" in out and "only a warning can be accepted" in out


def test_a_cycle_in_a_file_of_its_own_has_its_line_there(verify, tmp_path):
    machines = copy_of_machines(tmp_path)
    body = "o<flat> sub\nG12.1\nG1 X20 F500\nG13.1\no<flat> endsub\n"
    (machines / "flat.ngc").write_text(body)
    program = "G21 G18 G8 G40 G90 G94\nT3 M6 S900 M3\nG0 X30 Z2 C0\no<flat> call\nM2\n"
    code, out, _ = verify(program, ini=machines / LATHE.name)
    assert code == 1 and "line 2 of flat.ngc: it cuts nothing" in out


def test_json_has_the_same_in_millimetres(as_json):
    code, reported = as_json(WIDE, "--units", "inch")
    (pocket,) = reported["pockets"]
    assert (code, reported["real"], reported["sections"]) == (1, False, [])
    assert pocket["radius"] == pytest.approx(40) and pocket["reached"] == pytest.approx(40)
    assert pocket["rings"] == pytest.approx([2, 17, 32, 35])
    assert [found["line"] for found in reported["findings"]] == [4]
    assert reported["verdict"] == "1 finding"


def test_json_of_a_polar_section(as_json):
    code, reported = as_json(HEXAGON, ini=LATHE)
    (section,) = reported["sections"]
    assert code == 0
    assert 0 < section["deviation"] < 0.005 and section["c_speed"] < section["c_limit"] == 360
    assert section["segments"] > 20 and section["shortest"] <= section["longest"]
    assert section["seconds_planned"]["segments"] == pytest.approx(10.3, rel=0.03)  # of a run


def test_what_a_section_gains_from_kinematics(verify, as_json):
    hexagon = HEXAGON.read_text().replace("F1000", "F2000")
    _, out, _ = verify(hexagon, "--full", ini=LATHE)
    (row,) = [line for line in out.splitlines() if line.startswith("  kinematics ")]
    segments, face, least = map(float, re.findall(r"([0-9.]+) s ", row))
    assert (segments, face) == pytest.approx((7.7, 5.8), rel=0.05)  # of runs
    assert 5.5 < least <= face
    assert "kinematics" not in verify(hexagon, ini=LATHE)[1]
    _, reported = as_json(PROGRAMS / "cylinder" / "helix.ngc", ini=LATHE)
    assert {each["seconds_planned"] for each in reported["sections"]} == {None}


def test_json_of_a_rapid_through_material(as_json):
    code, reported = as_json(THROUGH)
    (hit,) = reported["rapids"]
    assert (code, hit["code"], hit["line"]) == (1, "rapid", 5)
    assert hit["place"] == pytest.approx([15.372, 0, -3], abs=0.1)


def test_a_circle_of_the_tool_centre_and_one_on_its_side_are_reported(verify):
    text = HEAD.replace("T4", "T10") + "G1 Z-1\nG12 I50 D0\nG0 Z30\nG18 G13 I50 D10\nM2\n"
    _, out, _ = verify(text, "--full", ini=SIM / "mill_mitsubishi_mm_headless.ini")
    assert "wall 60, reached 50 mm" in out and "depth           0" in out
    assert "the material around a circle in another plane than G17 [upright]" in out


def test_a_tolerance_of_ones_own(verify):
    code, out, _ = verify(HEXAGON, "--tolerance", "0.001", ini=LATHE)
    assert code == 1 and "off its contour" in out


def test_limits_are_compared_with_the_offsets_of_the_var_file_given(verify, tmp_path):
    stored = tmp_path / "its.var"
    stored.write_text("5221\t490\n")
    code, out, _ = verify(GOOD, "--var", stored)
    assert code == 1 and "line 4: X would go to 504, its limit is 500 mm" in out


def test_lengths_are_shown_in_inches_on_demand(verify):
    _, out, _ = verify(GOOD, "--units", "inch", "--full")
    assert "wall 0.7874, reached 0.7874 in" in out


def test_verify_says_in_one_line_why_it_cannot(verify):
    code, out, err = verify(WRONG)
    assert (code, out) == (2, "") and err.startswith("g12 verify: ") and err.count("\n") == 1
    assert "program.ngc:4: G12: I4 must be greater than the tool radius 5" in err


def test_an_override_of_no_run_is_refused(verify, plot):
    for command in (verify, plot):
        code, _, err = command(GOOD, "--override", "200")
        assert code == 2 and "--override is the feed override of --run" in err


def test_plot_draws_a_rapid_through_material(plot, tmp_path):
    assert plot(THROUGH)[0] == 0
    assert "rapid through material" in (tmp_path / "x.svg").read_text()


def test_plot_reports_what_it_draws_in_red(plot):
    code, out, _ = plot(HEAD + "G12 I7 K40 Q15 Z-3 D5\nG0 X60\nM2\n")
    assert code == 0
    for says in (
        "line 5: a rapid goes through",
        r"line 4: T4 is ⌀ 10, the path is that of ⌀ 12 \(D5\)",
    ):
        assert re.search(f"^in red, {says}", out, re.MULTILINE), says


def test_plot_says_the_warnings_of_verify(verify, plot):
    text = HEAD + "G13 I7 K20 Q6 Z-3 D4\nG0 Z1\nG13 I7 K20 Q6 Z-3 D4\nG0 Z30\nM2\n"
    (said,) = verify(text)[1].partition("\nwarnings\n")[2].partition("\n\n")[0].splitlines()
    assert plot(text)[1].splitlines()[1] == f"warning, {said.strip().removesuffix(' [cut-before]')}"


def test_a_program_without_a_code_of_ours_is_judged(verify):
    code, out, _ = verify(PLAIN.replace("X50", "Z-2 X50") + "")
    assert (code, out.splitlines()[-1]) == (0, "verdict: no finding")
    assert verify(HEAD + "G1 Z-2\nX50\nG0 X90\nM2\n")[0] == 1


@pytest.mark.parametrize(
    "cut", [["G12.1", "G1 X40 C3", "G13.1"], ["G7.1 C20", "G1 X30", "C90", "X50", "G7.1 C0"]]
)
def test_plot_shows_where_x0_lies(cut, plot, tmp_path):
    begin = ["G21 G18 G8 G94 F300", "G10 L2 P1 X12.5", "T1 M6 S500 M3", "G0 X50 Z2 C0"]
    says = "X0, the spindle's axis, is at machine X12.5"
    code, out, _ = plot("\n".join([*begin, *cut, "M2", ""]), ini=LATHE)
    assert code == 0 and f"note: program {says}" in out.splitlines()
    assert says in (tmp_path / "x.svg").read_text()


@pytest.mark.parametrize(
    ("suffix", "extra"), [("png", []), ("svg", ["--units", "inch"]), ("pdf", [])]
)
def test_plot_writes_the_requested_picture(suffix, extra, plot, tmp_path):
    path = tmp_path / f"picture.{suffix}"
    code, out, err = plot(GOOD, *extra, to=path.name)
    assert (code, out.splitlines()[0], err) == (0, f"{path} written", "")
    assert path.stat().st_size > 5000


def test_messages_of_a_cycle_are_reported_by_the_commands(verify, as_json, plot):
    said = "message, line 4: G12: Q15 is greater than the tool diameter 10: material is left"
    assert said in plot(WIDE)[1] and said in verify(WIDE)[1]
    (message,) = as_json(WIDE)[1]["messages"]
    assert message["line"] == 4 and message["text"].startswith("G12: Q15 is greater")


@pytest.mark.parametrize(
    ("program", "ini"), [(PLAIN, MILL), (PROGRAMS / "polar" / "square.ngc", LATHE)]
)
def test_plot_draws_any_program_and_a_lathe_with_c(program, ini, plot, tmp_path):
    assert plot(program, ini=ini)[0] == 0
    assert (tmp_path / "x.svg").exists()


def test_plot_draws_a_refused_program_up_to_there(plot, tmp_path):
    code, _, err = plot(WRONG)
    assert code == 2 and "program.ngc:4: G12: I4 must be greater" in err
    assert (tmp_path / "x.svg").exists()


@pytest.mark.parametrize(
    ("text", "name", "said"),
    [
        (GOOD, "x.bmp", "x.bmp: the suffix must be one of .png, .svg, .pdf"),
        (GOOD, "nowhere/x.png", "nowhere: no such directory"),
        (STILL, "x.png", "moves nothing, so there is nothing to draw"),
    ],
)
def test_plot_says_in_one_line_why_it_cannot(text, name, said, plot, tmp_path):
    code, _, err = plot(text, to=name)
    assert code == 2
    assert err.startswith("g12 plot: ") and said in err and err.count("\n") == 1
    assert not (tmp_path / name).exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["verify"],
        ["verify", "x.ngc"],
        ["plot", "x.ngc", "--ini", MILL],
        ["plot", "x.ngc", "--ini", MILL, "-o", "x.png", "--units", "feet"],
        ["verify", "x.ngc", "--ini", MILL, "--run", "--override", "0"],
        *(
            ["verify", "x.ngc", "--ini", MILL, "--tolerance", wrong]
            for wrong in ("nan", "inf", "0", "-1", "fine")
        ),
    ],
)
def test_wrong_words_end_with_2(arguments, capsys):
    with pytest.raises(SystemExit) as end:
        main([*map(str, arguments)])
    assert end.value.code == 2
    assert f"usage: python3 python/g12 {arguments[0]} --help" in capsys.readouterr().err
