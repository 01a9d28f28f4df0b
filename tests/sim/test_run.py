# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 run``: what it says of a program that ends, and of one that does not."""

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import pytest

from g12.tools.commands import main, run
from g12.tools.machine.ini import read_ini
from g12.tools.preview.moves import Error
from g12.tools.system import COMMAND
from support.sim_machines import ROOT, SIM, copy_of_machines


@pytest.fixture
def g12_run(tmp_path, capsys):
    """Run a text by ``g12 run``; return exit code, lines and errors, with PROGRAM for its path."""

    def run_text(text, *words, machine="mill_mm", name="part.ngc"):
        program, ini = tmp_path / name, SIM / f"{machine}.ini"
        program.write_text(text)
        code = main.main(["run", str(program), "--ini", str(ini), *map(str, words)])
        said = capsys.readouterr()
        return code, said.out.splitlines(), said.err.replace(str(program), "PROGRAM")

    return run_text


RUNNING = "running part.ngc in real time"
SAID = [  # a machine, a program, exit code, the first lines, errors
    ("mill_inch", "G20 G90 F100\nG1 X.1 Y.25\n(MSG, there)\nM2\n", 0,
     ["message: there", "ends at X0.1 Y0.25 Z0 (machine position, in)"],
     f"{RUNNING}, 0.2 s without acceleration\n"),
    ("lathe_mm", "M2\n", 0, ["ends at X0 Z0 C0 (machine position, mm and degrees)"],
     f"{RUNNING}, 0.0 s without acceleration\n"),
    ("mill_mm", "G21 G90 F3000\nG1 C5\nM2\n", 2, [],
     f"{RUNNING}\n"
     "g12 run: PROGRAM:2: Bad character 'c' used: this INI's machine has axes X Y Z\n"),
    ("lathe_mm", "G21 G90\nM154\nM2\n", 2, [],
     f"{RUNNING}, 0.0 s without acceleration\n"
     "g12 run: PROGRAM: Unknown m code used: M154, a code of haas-lathe: "
     f"{COMMAND} translate --control NAME makes a LinuxCNC program of it\n"),
]  # fmt: skip


@pytest.mark.parametrize(("machine", "text", "code", "out", "error"), SAID)
def test_what_a_run_says(g12_run, machine, text, code, out, error):
    ended, lines, errors = g12_run(text, machine=machine)
    assert (ended, lines[: len(out)], errors) == (code, out, error)
    assert [line.partition(" ")[2] for line in lines[len(out) :]] == ["s in motion"] * bool(out)


def test_a_run_that_is_refused_on_its_way_says_where_it_stopped(g12_run):
    text = "G21 G90 F3000\nT1 M6\nG1 X5\nG12 I20 Z-1 D6\nM66 E0 L0\nG12 R5\nM2\n"
    code, (message, place, seconds), errors = g12_run(text)
    assert code == 2
    assert message == ("message: G12: the cycle uses D6, diameter 20; the loaded tool T1 has 6.35")
    assert place == "stopped at X5 Y0 Z-1 (machine position, mm)"
    assert float(seconds.removesuffix(" s in motion")) > 0
    assert ": G12 line 6: R5 is not a word of this cycle" in errors


def test_the_refusal_of_a_filtered_program_is_reported(g12_run):
    text = "%\nO1\nT2 M6\nG20 G90 G0 X0\nG12 I.1 Z-.2 D2 F20.\nM30\n%\n"
    code, _, errors = g12_run(text, machine="mill_inch", name="part.nc")
    assert code == 2
    assert "PROGRAM (filtered): G12 line 5: I0.1 must be greater than the tool radius" in errors


def test_a_run_starts_with_the_tools_and_offsets_of_files(g12_run, tmp_path):
    stored, table = tmp_path / "shop.var", tmp_path / "shop.tbl"
    stored.write_text("5220\t1\n5221\t10\n")
    table.write_text("T7 P1 D3.5\n")
    text = "G21 G90 G54 F3000\nT7 M6\n(DEBUG, #5410)\nG1 X1\nM2\n"
    code, lines, _ = g12_run(text, "--var", stored, "--tools", table)
    place = "ends at X11 Y0 Z0 (machine position, mm)"
    assert (code, lines[:2]) == (0, ["message: 3.500000", place])


def test_a_program_that_cannot_be_opened_is_named_as_the_user_did(g12_run):
    code, _, errors = g12_run("")
    assert code == 2
    assert errors.startswith("running part.ngc in real time\n")
    assert "of PROGRAM " in errors
    assert "can't open PROGRAM" in errors


def test_a_run_with_an_override_tells_it_and_how_long_it_will_take(g12_run):
    code, lines, errors = g12_run("G21 G90 F600\nG1 X50\nM2\n", "--override", 500)  # 5 s at 100 %
    assert errors == "running part.ngc at 500 % feed, 1.0 s without acceleration\n"
    assert code == 0
    assert 1.0 < float(lines[-1].split()[0]) < 1.5


def test_an_interrupted_run_is_one_line(tmp_path, start):
    (tmp_path / "long.ngc").write_text("G21 G90 F10\nG1 X50\nM2\n")
    words = ["run", "long.ngc", "--ini", str(SIM / "mill_mm.ini")]
    command = [sys.executable, str(ROOT / "python" / "g12"), *words]
    process = start(*command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    running = "running long.ngc in real time, 5 min 0 s without acceleration\n"
    assert process.stderr.readline() == running
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, said = process.communicate(timeout=60)
    assert (process.returncode, said) == (130, "g12 run: interrupted\n")


@pytest.mark.parametrize(
    ("block", "override", "seconds"),
    [
        ("F600\nG1 X50", 100, 600),
        ("F1\nG1 X50", 100, 6000),
        ("F1\nG1 X50", 500, 1200),
        ("F600\nG1 X5\nG4 P1000", 500, 2000.2),
    ],
)
def test_a_run_is_waited_for_as_long_as_its_program_needs(block, override, seconds, tmp_path):
    program = tmp_path / "part.ngc"
    program.write_text(f"G21 G90 {block}\nM2\n")
    ini = read_ini(SIM / "mill_mm.ini")
    preview = run.preview_of(program, ini.path, None, None)
    assert run.default_timeout(preview, ini, override) == pytest.approx(seconds)
    assert run.default_timeout(None, ini, override) == run.USUAL_TIMEOUT  # of unknown length


@pytest.mark.parametrize(
    ("met", "text", "line"),
    [
        ("Bad character ',' used", "Bad character ',' used", 7),
        ("Bad character ',' used", "joint 0 following error", 0),
        ("G13 line 3 of sub.ngc: K1 needs Q", "G13 line 3 of sub.ngc: K1 needs Q", 0),
    ],
)
def test_an_error_whose_text_names_no_line_has_that_of_the_preview(met, text, line):
    preview = SimpleNamespace(error=Error(met, 7))
    assert run.line_of_preview(Error(text, 0), preview) == line
    assert run.line_of_preview(Error(text, 0), None) == 0


def test_bytes_that_are_no_utf8_run(tmp_path, capsys):
    """In the INI and the program, whose message LinuxCNC's own screens could not show."""
    machines = copy_of_machines(tmp_path)
    text = (machines / "mill_mm.ini").read_bytes()
    (machines / "mill_mm.ini").write_bytes(b"# K\xf6ln\n" + text)
    program = tmp_path / os.fsdecode(b"Fr\xe4se.ngc")
    program.write_bytes(b"(Fr\xe4sen)\nG21 G90 F3000\nG1 X1\n(MSG, L\xe4nge)\nM2\n")
    assert main.main(["run", str(program), "--ini", str(machines / "mill_mm.ini")]) == 0
    assert capsys.readouterr().out.splitlines()[:2] == [
        "message: L?nge",
        "ends at X1 Y0 Z0 (machine position, mm)",
    ]
