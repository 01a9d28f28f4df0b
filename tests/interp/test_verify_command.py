# SPDX-License-Identifier: GPL-2.0-or-later
"""The commands plot and verify as they are called: output, exit codes, wrong uses."""

import json
import re

import pytest

from g12.tools.commands.main import main
from g12.tools.verify.compare import section
from support.sim_machines import PROGRAMS, SIM, copy_of_machines

MILL = str(SIM / "mill_mm_headless.ini")
LATHE = str(SIM / "lathe_mm_headless.ini")
HEAD = "G21 G17 G40 G49 G54 G80 G90 G94 F600\nT4 M6\nG0 X0 Y0 Z1\n"
GOOD = HEAD + "S900 M3\nG12 I7 K20 Q6 Z-3 D4\nM2\n"
WIDE = HEAD + "G12 I7 K40 Q15 Z-3 D4\nM2\n"
PLAIN = HEAD + "G1 X50 Y20 F300\nM2\n"
WRONG = HEAD + "G12 I4 Z-3 D4\nM2\n"
STILL = "G21\nM2\n"


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "program.ngc"
        path.write_text(text)
        return str(path)

    return write


def verify(capsys, *arguments):
    code = main(["verify", *arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


def test_a_good_pocket_ends_with_0(written, capsys):
    code, out, err = verify(capsys, written(GOOD), "--ini", MILL)
    assert (code, err) == (0, "")
    assert out.startswith("line 5  G12 (haas)  ⌀ 40 to Z−3  0 mm off (0.005 allowed)  ")
    assert out.endswith("verdict: good, 1 note, 1 not judged\n")


def test_a_finding_ends_with_1_and_is_told(written, capsys):
    code, out, _ = verify(capsys, written(WIDE), "--ini", MILL)
    assert code == 1
    assert "findings\n  line 4: " in out
    assert out.endswith("verdict: 1 finding, 2 notes, 1 not judged\n")


def test_notes_are_findings_on_demand(written, capsys):
    code, out, _ = verify(capsys, written(GOOD), "--ini", MILL, "--strict")
    assert code == 1 and out.endswith("verdict: 1 finding, 1 not judged\n")
    code, out, _ = verify(capsys, written(GOOD), "--ini", MILL, "--strict", "--json")
    assert code == 1 and not json.loads(out)["good"]


def test_a_cycle_out_of_sight_is_no_good(capsys, written, tmp_path):
    machines = copy_of_machines(tmp_path)
    body = "o<flat> sub\nG12.1\nG1 X20 F500\nG13.1\no<flat> endsub\n"
    (machines / "flat.ngc").write_text(body)
    program = written("G21 G18 G8 G40 G90 G94\nT3 M6\nG0 X30 Z2 C0\no<flat> call\nM2\n")
    lathe = str(machines / "lathe_mm_headless.ini")
    code, out, _ = verify(capsys, program, "--ini", lathe)
    reported = json.loads(verify(capsys, program, "--ini", lathe, "--json")[1])
    assert code == 1 and out.endswith("verdict: 1 finding, 1 not judged\n")
    assert (reported["good"], reported["unseen"]) == (False, [{"line": 4, "code": "G12.1"}])


def test_json_has_the_same_in_millimetres(written, capsys):
    code, out, _ = verify(capsys, written(WIDE), "--ini", MILL, "--json", "--units", "inch")
    reported = json.loads(out)
    (pocket,) = reported["pockets"]
    assert (code, reported["good"], reported["real"], reported["sections"]) == (1, False, False, [])
    assert pocket["radius"] == pytest.approx(40) and pocket["reached"] == pytest.approx(40)
    assert pocket["stepover"] == pytest.approx(15, abs=0.01) and pocket["left"] > 100
    assert [found["line"] for found in reported["findings"]] == [4]


def test_json_tells_the_way_down(written, capsys):
    (straight,) = json.loads(verify(capsys, written(WIDE), "--ini", MILL, "--json")[1])["pockets"]
    assert straight["entry"] == {"way": "straight"}
    program = str(SIM / "samples" / "mill_helix_mm.ngc")
    code, out, _ = verify(capsys, program, "--ini", str(SIM / "mill_helix_mm.ini"), "--json")
    one, two = (pocket["entry"] for pocket in json.loads(out)["pockets"])
    assert code == 0
    assert (one["way"], one["count"], two["count"]) == ("helix", 1, 2)
    assert one["radius"] == pytest.approx(3) and two["radius"] == pytest.approx(4.5)
    assert 1 < one["angle"] <= 3 and 1 < two["angle"] <= 3


def test_json_of_a_polar_section(capsys):
    program = str(PROGRAMS / "polar" / "hexagon.ngc")
    code, out, _ = verify(capsys, program, "--ini", LATHE, "--json")
    (section,) = json.loads(out)["sections"]
    assert code == 0
    assert section["radii"][0] == pytest.approx(13.5)
    assert 0 < section["deviation"] < 0.005 and section["c_speed"] < section["c_limit"] == 360
    assert section["segments"] > 20 and section["shortest"] <= section["longest"]
    assert section["seconds_planned"]["segments"] == pytest.approx(10.3, rel=0.01)  # of a run


def test_what_a_section_gains_from_kinematics(written, capsys):
    hexagon = (PROGRAMS / "polar" / "hexagon.ngc").read_text().replace("F1000", "F2000")
    _, out, _ = verify(capsys, written(hexagon), "--ini", LATHE, "--full")
    (row,) = [line for line in out.splitlines() if line.startswith("  kinematics ")]
    segments, face, least = map(float, re.findall(r"([0-9.]+) s ", row))
    assert (segments, face) == pytest.approx((7.7, 5.8), rel=0.05)  # of runs
    assert 5.5 < least <= face
    _, out, _ = verify(capsys, written(hexagon), "--ini", LATHE)
    assert "kinematics" not in out
    round_part = str(PROGRAMS / "cylinder" / "helix.ngc")
    reported = json.loads(verify(capsys, round_part, "--ini", LATHE, "--json")[1])
    assert reported["sections"] and not any(
        each["seconds_planned"] for each in reported["sections"]
    )


def test_a_contour_that_is_not_cut_is_told(written, capsys, monkeypatch):
    lay = section.lay
    monkeypatch.setattr(section, "lay", lambda path, *more: lay([*path, *path], *more))
    program = str(PROGRAMS / "polar" / "slot.ngc")
    code, out, _ = verify(capsys, program, "--ini", LATHE)
    assert code == 1 and "is not cut" in out
    code, out, _ = verify(capsys, program, "--ini", LATHE, "--json")
    assert code == 1 and json.loads(out)["sections"][0]["deviation"] is None


def test_a_polar_section_is_told_as_it_is_programmed(written, capsys):
    lines = ["G21 G18 G7 G40 G90 G94", "T3 M6", "G0 X80 Z2 C90", "G12.1", "G1 Z-2 F500"]
    lines += ["G42 X40 C-16", "C10 F100", "G40 X80 F600", "G13.1", "M2", ""]
    code, out, _ = verify(capsys, written("\n".join(lines)), "--ini", LATHE, "--full")
    assert code == 0
    rows = dict(line.strip().split("  ", 1) for line in out.splitlines() if "  " in line.strip())
    rows = {name: text.strip() for name, text in rows.items()}
    assert rows["cutter"] == "⌀ 6, right of the contour (G42)"
    assert (rows["zero line"], rows["depth"]) == ("C 90", "−2")
    assert rows["X words"] == "diameters (G7)"
    assert rows["lowest feed"].startswith("100 mm/min at X45.99")


def test_a_rapid_through_material_is_told_in_words_and_json(written, capsys):
    text = written(HEAD + "G12 I7 K20 Q6 Z-3 D4\nG0 X60\nM2\n")
    code, out, _ = verify(capsys, text, "--ini", MILL)
    assert code == 1 and "  line 5: a rapid goes through" in out
    code, out, _ = verify(capsys, text, "--ini", MILL, "--json")
    reported = json.loads(out)
    (hit,) = reported["rapids"]
    assert (code, reported["good"], hit["line"]) == (1, False, 5)
    assert hit["place"] == pytest.approx([15.372, 0, -3], abs=0.1)


def test_a_circle_of_the_tool_centre_and_one_on_its_side_are_told(written, capsys):
    head = HEAD.replace("T4", "T10")
    text = head + "G12 I50 D0\nG18 G13 I50 D10\nM2\n"
    ini = str(SIM / "mill_mitsubishi_mm_headless.ini")
    code, out, _ = verify(capsys, written(text), "--ini", ini, "--full")
    assert code == 0
    assert "programmed I50 (tool centre), wall 60, reached 60 mm" in out
    assert "plane at Y0, Z from −39 to 41" in out


def test_a_tolerance_of_ones_own(written, capsys):
    program = str(PROGRAMS / "polar" / "hexagon.ngc")
    code, out, _ = verify(capsys, program, "--ini", LATHE, "--tolerance", "0.001")
    assert code == 1 and "off the toolpath" in out


def test_limits_are_compared_with_the_offsets_of_the_var_file_given(written, tmp_path, capsys):
    stored = tmp_path / "its.var"
    stored.write_text("5221\t490\n")
    code, out, _ = verify(capsys, written(GOOD), "--ini", MILL, "--var", str(stored))
    assert code == 1 and "line 5: the X axis would go to 505, its limit is 500 mm" in out
    assert verify(capsys, written(GOOD), "--ini", MILL)[0] == 0


def test_lengths_are_shown_in_inches_on_demand(written, capsys):
    _, out, _ = verify(capsys, written(GOOD), "--ini", MILL, "--units", "inch", "--full")
    assert "programmed 0.7874, reached 0.7874 in" in out


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        (WRONG, 2, "program.ngc:4: G12: I4 must be greater than the tool radius 5"),
        (PLAIN, 2, "has no pocket, no section and no holes to verify"),
    ],
)
def test_verify_says_in_one_line_why_it_cannot(text, code, said, written, capsys):
    found, out, err = verify(capsys, written(text), "--ini", MILL)
    assert (found, out) == (code, "")
    assert err.startswith("g12 verify: ") and said in err and err.count("\n") == 1


@pytest.mark.parametrize("command", ["verify", "plot"])
def test_an_override_of_no_run_is_refused(command, written, tmp_path, capsys):
    words = [command, written(GOOD), "--ini", MILL, "--override", "200"]
    assert main(words + (["-o", str(tmp_path / "x.png")] if command == "plot" else [])) == 2
    assert "--override is the feed override of --run" in capsys.readouterr().err


def test_plot_draws_a_rapid_through_material(written, tmp_path):
    text, path = HEAD + "G12 I7 K20 Q6 Z-3 D4\nG0 X60\nM2\n", tmp_path / "x.svg"
    assert main(["plot", written(text), "--ini", MILL, "-o", str(path)]) == 0
    assert "rapid through material" in path.read_text()


def test_plot_tells_what_it_draws_in_red(written, tmp_path, capsys):
    text, path = HEAD + "G12 I7 K40 Q15 Z-3 D5\nG0 X60\nM2\n", tmp_path / "x.svg"
    assert main(["plot", written(text), "--ini", MILL, "-o", str(path)]) == 0
    red = [line for line in capsys.readouterr().out.splitlines() if line.startswith("in red, line")]
    for line, says in [
        (5, "a rapid goes through"),
        (4, "of material remain uncut"),
        (4, "the loaded tool T4 (⌀ 10) is not D5 (⌀ 12)"),
    ]:
        assert any(text.startswith(f"in red, line {line}: ") and says in text for text in red), says


def test_plot_says_the_notes_of_verify(written, tmp_path, capsys):
    text = HEAD + "G13 I7 K20 Q6 Z-3 D4\nG0 Z1\nX20\nG13 I7 K20 Q6 Z-3 D4\nM2\n"
    assert main(["plot", written(text), "--ini", MILL, "-o", str(tmp_path / "x.svg")]) == 0
    plotted = capsys.readouterr().out.splitlines()
    main(["verify", written(text), "--ini", MILL])
    notes = capsys.readouterr().out.partition("\nnotes\n")[2].partition("\n\n")[0].splitlines()
    assert len(notes) == 3
    assert [f"note, {note.strip()}" for note in notes] == plotted[1:4]


@pytest.mark.parametrize(
    "cut", [["G12.1", "G1 X40 C3", "G13.1"], ["G7.1 C20", "G1 X30", "C90", "X50", "G7.1 C0"]]
)
def test_plot_shows_where_x0_lies(cut, written, tmp_path, capsys):
    begin = ["G21 G18 G8 G94 F300", "G10 L2 P1 X12.5", "T1 M6 S500 M3", "G0 X50 Z2 C0"]
    path, says = tmp_path / "x.svg", "X0, the spindle's axis, is at machine X12.5"
    text = "\n".join([*begin, *cut, "M2", ""])
    assert main(["plot", written(text), "--ini", LATHE, "-o", str(path)]) == 0
    assert f"note: program {says}" in capsys.readouterr().out.splitlines()
    assert says in path.read_text()


@pytest.mark.parametrize(("suffix", "extra"), [("png", []), ("svg", ["--feeds"]), ("pdf", [])])
def test_plot_writes_the_picture_asked_for(suffix, extra, written, tmp_path, capsys):
    path = tmp_path / f"picture.{suffix}"
    assert main(["plot", written(GOOD), "--ini", MILL, "-o", str(path), *extra]) == 0
    assert path.stat().st_size > 5000
    said = capsys.readouterr()
    assert said.out.splitlines()[0] == f"{path} written"
    assert said.err == ""


def test_what_a_cycle_tells_the_operator_is_told_by_the_commands(written, tmp_path, capsys):
    said = "line 4: G12: Q15 is greater than the tool diameter 10: material is left"
    program, path = written(WIDE), str(tmp_path / "picture.png")
    assert main(["plot", program, "--ini", MILL, "-o", path]) == 0
    assert f"message, {said}" in capsys.readouterr().out
    assert f"message, {said}" in verify(capsys, program, "--ini", MILL)[1]
    (message,) = json.loads(verify(capsys, program, "--ini", MILL, "--json")[1])["messages"]
    assert message["line"] == 4 and message["text"].startswith("G12: Q15 is greater")


def test_plot_draws_any_program_and_a_lathe_with_c(written, tmp_path):
    for program, ini in ((written(PLAIN), MILL), (PROGRAMS / "polar" / "square.ngc", LATHE)):
        path = tmp_path / "picture.png"
        path.unlink(missing_ok=True)
        assert main(["plot", str(program), "--ini", ini, "-o", str(path)]) == 0
        assert path.exists()


def test_plot_draws_a_refused_program_up_to_there(written, tmp_path, capsys):
    path = tmp_path / "x.png"
    assert main(["plot", written(WRONG), "--ini", MILL, "-o", str(path)]) == 1
    assert path.exists()
    assert "program.ngc:4: G12: I4 must be greater" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "name", "code", "said"),
    [
        (GOOD, "x.bmp", 2, "x.bmp: the suffix must be one of .png, .svg, .pdf"),
        (GOOD, "nowhere/x.png", 2, "nowhere: no such directory"),
        (STILL, "x.png", 2, "moves nothing, so there is nothing to draw"),
    ],
)
def test_plot_says_in_one_line_why_it_cannot(text, name, code, said, written, tmp_path, capsys):
    path = tmp_path / name
    assert main(["plot", written(text), "--ini", MILL, "-o", str(path)]) == code
    err = capsys.readouterr().err
    assert err.startswith("g12 plot: ") and said in err and err.count("\n") == 1
    assert not path.exists()


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
        main(arguments)
    assert end.value.code == 2
    assert f"usage: python3 python/g12 {arguments[0]} --help" in capsys.readouterr().err
