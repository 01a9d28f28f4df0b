# SPDX-License-Identifier: GPL-2.0-or-later
"""``g12 trace`` on the stock interpreter, good and wrong uses."""

import os
import signal
import subprocess
import sys
import time

import pytest

from g12.tools.commands import main
from g12.tools.system import COMMAND
from support.processes import living, until
from support.sim_machines import ROOT, SIM
from support.small_configs import LATHE, MILL, with_lines, write_config

INI = SIM / "mill_mm.ini"


@pytest.fixture
def reported(tmp_path, capsys):
    """Return a function: exit code, lines and errors of a command on a program."""

    def tell(name, text, *words, ini=INI):
        program = tmp_path / "part.ngc"
        program.write_text(text)
        code = main.main([name, str(program), "--ini", str(ini), *words])
        said = capsys.readouterr()
        return code, said.out.splitlines(), said.err.replace(str(program), "PROGRAM")

    return tell


def test_moves_are_listed(reported):
    text = "G20 G90\nG0 X1\nG1 Y1 F10\nG2 X2 I.5 (half)\n(MSG,there)\nM2\n"
    code, lines, errors = reported("trace", text, "--digits", "1")
    assert (code, errors) == (0, "")
    assert lines == [
        "     2 rapid X25.4",
        "     3 feed  Y25.4 F254 G94",
        "     4 arc   X50.8 I38.1 J25.4 K0.0 turns -1 G17 F254 G94",
        "     5 message there",
    ]


@pytest.mark.parametrize(
    ("in_force", "flag", "notes", "x"),
    [
        (1, "", ["a G92 or G52 from before is in force at the start, and shifts everything by X2 "
                 "Z-5"], "X13.000000"),
        (0, "", [], "X11.000000"),
        (1, "DISABLE_G92_PERSISTENCE = 1\n", [], "X11.000000"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("name", ["trace", "plot"])
def test_a_var_file_has_the_offsets_to_start_with_and_one_of_g92_is_said(
    reported, tmp_path, name, in_force, flag, notes, x
):
    stored, ini = tmp_path / "shop.var", write_config(tmp_path, with_lines(MILL, "RS274NGC", flag))
    stored.write_text(f"5210\t{in_force}\n5211\t2\n5213\t-5.0\n5220\t1\n5221\t10\n")
    picture = ["-o", str(tmp_path / "part.png")] if name == "plot" else []
    text = "G21 G90 F100\nG0 X1 Z0\nG1 Z2\nM2\n"
    code, lines, _ = reported(name, text, "--var", str(stored), *picture, ini=ini)
    said = [line for line in lines if "note" in line and "G92" in line]
    assert (code, [line.partition("note")[2].lstrip(": ") for line in said]) == (
        0, [f"{note} (machine units): G92.1 ends it" for note in notes],
    )  # fmt: skip
    assert name == "plot" or any(f"rapid {x}" in line for line in lines)


@pytest.mark.parametrize(
    ("name", "ini", "block", "error"),
    [
        ("trace", "mill_mm", "G154 P1", "G-code out of range: G154, a code of haas-mill"),
        ("verify", "mill_mm", "G0 X1 G54.1 P1", "Unknown g code used: G54.1, a code of fanuc-mill, "
         "yasnac-mill, mitsubishi-mill"),
        ("plot", "lathe_mm", "G112", "G-code out of range: G112, a code of haas-lathe, "
         "fanuc-lathe, fanuc-lathe-b and others"),
        ("trace", "mill_mm", "G0 X1 (G68)\nG68.1", "Unknown g code used: G68.1"),
    ],
)  # fmt: skip
def test_a_code_of_another_control_is_named_with_that(reported, tmp_path, name, ini, block, error):
    picture = ["-o", str(tmp_path / "part.png")] if name == "plot" else []
    text = f"G0 X1\n{block}\nM2\n"
    code, _, errors = reported(name, text, *picture, ini=SIM / f"{ini}.ini")
    line = 2 + block.count("\n")
    translated = f": {COMMAND} translate --control NAME makes a LinuxCNC program of it"
    knows = translated if "a code of" in error else ""
    assert (code, errors) == (2, f"g12 {name}: PROGRAM:{line}: {error}{knows}\n")


@pytest.mark.parametrize(
    ("name", "words", "text", "error"),
    [
        ("trace", [], "G0 X1\nG0 Q1 X\nM2\n", "PROGRAM:2: "),
        ("trace", [], "", "PROGRAM: File ended with no percent sign"),
        ("verify", [], "G0 X1\nG0 C1\nM2\n", "PROGRAM:2: Bad character 'c' used: this INI's "
         "machine has axes"),
        ("plot", ["-o", "no.png"], "G0 X1\nG0 Q1 X\nM2\n", "PROGRAM:2: "),
    ],
)  # fmt: skip
def test_a_program_with_an_error_is_named(
    reported, name, words, text, error, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)  # a refused program is drawn up to there
    code, _, errors = reported(name, text, *words)
    assert code == 2
    assert errors.startswith(f"g12 {name}: {error}")
    assert errors.count("\n") == 1


def test_an_error_comes_after_the_moves_before_it(tmp_path):
    program = tmp_path / "part.ngc"
    program.write_text("G0 X1\nG0 Q1 X\nM2\n")
    command = [sys.executable, str(ROOT / "python" / "g12"), "trace", str(program)]
    both = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    buffered = {**os.environ, "PYTHONUNBUFFERED": ""}
    said = subprocess.run([*command, "--ini", str(INI)], env=buffered, **both).stdout
    assert said.startswith("     1 rapid X1.000000\ng12 trace: ")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_a_command_that_is_ended_leaves_nothing_behind(tmp_path, number, start):
    program, scratch = tmp_path / "part.ngc", tmp_path / "tmp"
    program.write_text("o1 while [1]\no1 endwhile\nM2\n")
    scratch.mkdir()
    command = [sys.executable, str(ROOT / "python" / "g12"), "trace", str(program)]
    environment = {**os.environ, "TMPDIR": str(scratch)}
    process = start(*command, "--ini", str(INI), env=environment)
    deadline = time.monotonic() + 120
    while not list(scratch.glob("*/trace.var")) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert list(scratch.iterdir())
    process.send_signal(number)
    killed = number == signal.SIGKILL
    assert process.wait(timeout=120) == (-number if killed else 128 + number)
    assert until(lambda: not list(scratch.iterdir()), 60 * killed)
    assert until(lambda: not living(process.pid), 60 * killed)


def test_what_is_told_to_ignore_a_closed_terminal_ignores_it(tmp_path, start):
    program = tmp_path / "part.ngc"
    program.write_text("G4 P1\nM2\n" + "(end)\n" * 1000)
    command = [sys.executable, str(ROOT / "python" / "g12"), "trace", str(program)]
    ignored = {"ignored": [signal.SIGHUP]}  # as nohup does
    process = start(*command, "--ini", str(INI), stdout=subprocess.DEVNULL, **ignored)
    while process.poll() is None:
        process.send_signal(signal.SIGHUP)
        time.sleep(0.1)
    assert process.returncode == 0


def test_an_error_is_told_with_what_the_package_said_when_linuxcnc_came_up(tmp_path, capsys):
    python = "[PYTHON]\nTOPLEVEL = python/top.py\nPATH_APPEND = python\n"
    ini = write_config(
        tmp_path,
        with_lines(LATHE, "RS274NGC", "REMAP = G12.1 modalgroup=1 python=polar_on\n") + python,
        python__top_py="import sys, remap\nprint('g12: not this G12.1', file=sys.stderr)\n",
        python__remap_py="def polar_on(self, **words):\n    return 0\n",
    )
    program = tmp_path / "part.ngc"
    program.write_text("G21\nG4\nM2\n")
    assert main.main(["trace", str(program), "--ini", str(ini)]) == 2
    said = capsys.readouterr().err
    assert "part.ngc:2: " in said
    assert said.endswith(": not this G12.1\n")
