# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that an INI's [FILTER] rewrites: every command opens them as the screens do."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from g12.tools.commands import main
from g12.tools.machine.filter import OpenedProgram, filter_for, lines_of_source, opened_program
from g12.tools.machine.ini import read_ini
from g12.tools.system import PYTHON
from support.foreign_programs import FOREIGN
from support.sim_machines import ROOT, SIM, copy_of_machines
from support.small_configs import put_in, write_config

POCKET = """\
%
O1 (POCKET)
T2 M6
G20 G90 G154 P1 G0 X0 Y0
S2000 M3
G43 H2 Z.1
M98 P10
G12 I.6 K1. Q.3 Z-.25 D02 F20.
G0 Z.1
M30
O10
G91 G1 X.5 F20.
G90 M99
%
"""


def without_progress(errors):
    """Return what a command said but for the lines that it has on a busy machine."""
    return "".join(line for line in errors.splitlines(True) if line.startswith("g12 "))


TRANSLATE = f"python3 {ROOT / 'python' / 'g12'} translate --control haas-mill"


@pytest.fixture(scope="module")
def sim(tmp_path_factory):
    return copy_of_machines(tmp_path_factory.mktemp("mill"))


def mill_with(sim, command):
    """Return the INI of a mill that opens .nc files with a filter's command."""
    text = (sim / "mill_inch.ini").read_text()
    (sim / "own.ini").write_text(text.replace("[FILTER]\n", f"[FILTER]\nnc = {command}\n"))
    return sim / "own.ini"


@pytest.fixture
def reported(sim, tmp_path, capsys):
    """Return a function: exit code, output and errors of a command on a filtered program."""

    def tell(name, text, *words, command=TRANSLATE):
        program = tmp_path / "part.nc"
        program.write_text(text)
        code = main.main([name, str(program), "--ini", str(mill_with(sim, command)), *words])
        said = capsys.readouterr()
        return code, said.out, without_progress(said.err).replace(str(program), "PROGRAM")

    return tell


def test_moves_and_cuts_have_the_lines_of_the_users_file(reported):
    code, out, errors = reported("trace", POCKET)
    assert (code, errors) == (0, "")
    assert [int(line.split()[0]) for line in out.splitlines()[:5]] == [1, 4, 6, 7, 8]
    code, out, errors = reported("verify", POCKET, "--json")
    assert (code, errors) == (0, "")
    assert [pocket["line"] for pocket in json.loads(out)["pockets"]] == [8]


# A filter of another's, which writes lines that are not the user's.
WRITTEN = "G20 G90 G0 X0\\n(A)\\nG1 X1 F9\\nG1 X2\\nT2 M6\\nG12 I.1 Z-.2 D2 F20\\nM2\\n"
OTHER = f"printf '{WRITTEN}'"
FAILED = "PROGRAM: the filter {} failed: {}\n"
ERRORS = [  # a program, its filter, what is said
    (POCKET.replace("I.6", "I.1"), TRANSLATE, "PROGRAM:8: G12: I0.1 must be greater than"),
    (POCKET.replace("M98 P10", "G150 P10"), TRANSLATE, "PROGRAM:7: G150: the pocket of any shape"),
    ("import nothing\n", OTHER, "PROGRAM (filtered):6: G12: I0.1 must be greater"),
    (POCKET, "false", FAILED.format("false", "without a word")),
    (POCKET, "nowhere", FAILED.format("nowhere", "[FILTER]: 1: nowhere: not found")),
    (
        POCKET,
        "ls --nothing",
        FAILED.format("ls --nothing", "Try 'ls --help' for more information."),
    ),
]


@pytest.mark.parametrize("name", ["trace", "verify"])
@pytest.mark.parametrize(("program", "command", "says"), ERRORS)
def test_an_error_is_that_of_the_users_file(reported, name, program, command, says):
    code, _, errors = reported(name, program, command=command)
    assert code == 2
    assert f"g12 {name}: {says}" in errors


def test_a_picture_has_the_lines_of_the_users_file(reported, tmp_path):
    picture = tmp_path / "part.svg"
    code, out, _ = reported("plot", POCKET.replace("D02", "D03"), "-o", str(picture))
    assert (code, "in red, line 8: T2 is ⌀ 0.5" in out) == (0, True)
    assert "finding in line 8" in picture.read_text()
    code, *_ = reported("plot", POCKET.replace("I.6", "I.1"), "-o", str(picture))
    assert (code, "refused in line 8: G12: I0.1 must" in picture.read_text()) == (2, True)


def test_a_recording_has_the_users_file_and_its_lines(sim, tmp_path, capsys):
    program, folder = tmp_path / "part.nc", tmp_path / "recordings"
    program.write_text(POCKET)
    words, ini = ["-d", str(folder)], str(mill_with(sim, TRANSLATE))
    assert main.main(["regress", "record", str(program), "--ini", ini, *words]) == 0
    recorded = next(folder.glob("*.trace")).read_text()
    assert "G12 I.6 K1. Q.3 Z-.25 D02 F20." in recorded
    assert main.main(["regress", "check", *words]) == 0
    program.write_text(POCKET.replace("Z-.25", "Z-.26"))
    capsys.readouterr()
    assert main.main(["regress", "check", *words]) == 1
    assert "8" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("machine", "program"),
    [
        ("mill_inch", "haas-mill/counterbore"),
        ("mill_yasnac_mm", "yasnac-mill/with_points"),
        ("mill_mitsubishi_mm", "mitsubishi-mill/circle"),
        ("lathe_mm", "fanuc-lathe/hexagon"),
    ],
)
def test_each_machine_opens_programs_of_its_control(capsys, machine, program):
    path, ini = FOREIGN / f"{program}.nc", SIM / f"{machine}.ini"
    assert main.main(["trace", str(path), "--ini", str(ini)]) == 0, capsys.readouterr().err


def test_screens_open_both_cases_through_the_filter(tmp_path):
    """By LinuxCNC's own reader, in AXIS's function; those of gmoccapy and QtVCP equal it."""
    ini = write_config(tmp_path)
    put_in(ini, "programs-okuma-lathe")
    ask = "import linuxcnc, os, re, sys\ninifile = linuxcnc.ini(sys.argv[1])\n"
    source = Path(shutil.which("axis")).read_text()
    ask += re.search(r"def get_filter\(.*?(?=\ndef )", source, re.DOTALL)[0]
    ask += "\nfor name in sys.argv[2:]: print(get_filter(name))\n"
    names = ["PART.MIN", "part.min", "PART.NC", "part.nc", "part.ngc", "part"]
    done = subprocess.run([PYTHON, "-c", ask, str(ini), *names], capture_output=True, text=True)
    command = "python3 g12/python/g12 translate --control okuma-lathe"
    assert done.stdout.splitlines() == [command] * 4 + ["None"] * 2
    own = read_ini(ini)
    assert [filter_for(Path(name), own) for name in names] == [command] * 4 + [None] * 2
    (shown,) = own.all("FILTER", "PROGRAM_EXTENSION")
    assert shown.split()[0].split(",") == [".min", ".MIN", ".nc", ".NC"]


def test_a_program_whose_case_has_no_filter_is_said_to_be_read_as_it_is(sim, tmp_path, capsys):
    program, ini = tmp_path / "PART.NC", mill_with(sim, TRANSLATE)
    program.write_text("G20 G0 X1\nM2\n")
    ini.write_text(ini.read_text().replace("\nNC = ", "\n# NC = "))
    assert main.main(["trace", str(program), "--ini", str(ini)]) == 0
    says = f"{program}: LinuxCNC reads it as it is: the INI's [FILTER] has nc, not NC\n"
    assert capsys.readouterr().err == f"g12 trace: {says}"


def test_any_filter_is_applied_and_without_one_the_program_is_the_users_file(sim, tmp_path):
    program = tmp_path / "one.nc"
    program.write_text("G0 X1\n")
    own = read_ini(mill_with(sim, "sed s/X1/X2/"))
    with opened_program(program, own) as opened:
        assert opened.path.read_text() == "G0 X2\n"
        assert opened.path.name == program.name
    assert not opened.path.exists()
    program = program.rename(tmp_path / "one.ngc")
    with opened_program(program, own) as opened:
        assert (opened.path, opened.lines) == (program, ())
        assert opened.in_source(f"{program}:5: line 6") == f"{program}:5: line 6"


def test_lines_that_a_filter_adds_say_theirs():
    rows = [b"G0", b"(a) (line 1)", b"G1 (line 7 of it)", b"", b"M2 (line 4)", b"(line 9) M2 (a)"]
    assert lines_of_source(rows) == (1, 1, 2, 3, 4, 9)


def test_each_of_several_lines_in_a_text_is_the_users(tmp_path):
    opened = OpenedProgram(tmp_path / "own", tmp_path / "made", (7, 8, 9))
    several = "both lines {} and {}: (also in line {}, {}) 3 in, lines {} to {} line {}, 2 mm"
    assert opened.in_source(several.format(*[1, 3] * 3, 1)) == several.format(*[7, 9] * 3, 7)


def test_findings_in_lines_that_the_user_has_not_are_said_to_be_there(reported):
    command = OTHER.replace("I.1", "I.5").replace("G1 X1", "G0 Z1")
    _, out, errors = reported("verify", "import nothing\n", command=command)
    assert "line 6  G12 (haas)" in out
    assert errors.endswith(
        "PROGRAM: lines are those of the program that the INI's [FILTER] makes of it\n"
    )


def test_what_install_is_told_of_numbers_rules_the_programs(tmp_path, capsys):
    ini = copy_of_machines(tmp_path / "machines") / "lathe_mm.ini"
    ini.write_text(ini.read_text().replace("[FILTER]\n", "[OLD_FILTER]\n"))
    program = tmp_path / "part.nc"
    program.write_text("G0 X1500 Z5.\nM30\n")
    words = ["install", str(ini), "--with", "programs-fanuc-lathe"]
    assert main.main([*words, "--dry-run"]) == 0
    asked = "asked: X1500 has no decimal point. With --decimals least it is 1.5 mm, with"
    assert capsys.readouterr().out.startswith(asked)
    assert main.main([*words, "--decimals", "least", "--units", "inch"]) == 0
    assert "asked:" not in capsys.readouterr().out
    assert main.main(["trace", str(program), "--ini", str(ini), "--digits", "3"]) == 0
    assert capsys.readouterr().out == "     1 rapid X1.905 Z127.000\n"
    assert main.main(["install", str(ini), "--with", "polar", "--units", "mm"]) == 2
    assert main.main(["uninstall", str(ini)]) == 0
    assert "--decimals" not in ini.read_text()
