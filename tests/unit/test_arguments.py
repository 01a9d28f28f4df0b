# SPDX-License-Identifier: GPL-2.0-or-later
"""What the commands share: wrong words and files in one line, interrupts, closed outputs."""

import argparse
import os
import subprocess
import sys
from functools import partial
from types import SimpleNamespace

import pytest

from g12.tools.commands import arguments, main
from g12.tools.errors import UsageError
from g12.tools.headless.errors import StartupError
from g12.tools.machine import tables
from g12.tools.preview.ended import explained_text
from g12.tools.system import COMMAND
from support.sim_machines import ROOT, SIM
from support.small_configs import MILL, TOOLS, write_config

PROGRAM = str(ROOT / "python" / "g12")
COMMANDS = [name for name in main.COMMANDS if name != "demo"]


def ends(capsys, *words):
    """Return the exit code of a command line, and what it says on standard error."""
    try:
        code = main.main([*map(str, words)])
    except SystemExit as end:
        code = end.code
    return code, capsys.readouterr().err


TRANSLATE = "--control and a program are needed, or --list alone"
WRONG_WORDS = [
    *((f"{name} --nonsense 3", "") for name in COMMANDS),
    ("translate --list --control haas-mill", TRANSLATE),
    ("translate part.nc", TRANSLATE),
    ("install", "the INI is missing, --with is missing"),
    ("install mill.ini --with", "expected at least one argument"),
    ("install mill.ini --with heidenhain", "no feature 'heidenhain'"),
]


@pytest.mark.parametrize(("words", "says"), WRONG_WORDS)
def test_wrong_words_are_reported_in_one_line(words, says, capsys):
    name, *rest = words.split()
    code, said = ends(capsys, name, *rest)
    assert code == 2
    assert said.startswith(f"g12 {name}: ") and says in said
    assert said.endswith(f"(usage: python3 python/g12 {name} --help)\n")
    assert said.count("\n") == 1


@pytest.mark.parametrize("name", COMMANDS)
def test_help_is_plain_text_with_examples(name, capsys):
    sub = ["record"] if name == "regress" else []
    with pytest.raises(SystemExit) as end:
        main.main([name, *sub, "--help"])
    assert end.value.code == 0
    said = capsys.readouterr().out
    assert f"usage: python3 python/g12 {name} " in said
    assert f"\n  python3 python/g12 {name} " in said.partition("example")[2]
    assert "\n  g12 " not in said
    assert "`" not in said


@pytest.mark.parametrize(
    ("reader", "right", "wrong", "rule"),
    [
        (arguments.number_above(0), "0.5", "0", "a number above 0"),
        (arguments.number_above(0), "1e300", "inf", "a number above 0"),
        (arguments.number_from(0), "0", "nan", "a number from 0"),
        (arguments.count_from(1), "1", "0", "a whole number from 1"),
        (arguments.count_from(1), "2", "x", "a whole number from 1"),
    ],
)
def test_numbers_of_the_command_line(reader, right, wrong, rule):
    assert reader(right) == float(right)
    with pytest.raises(argparse.ArgumentTypeError, match=f"^'{wrong}' is not {rule}$"):
        reader(wrong)


@pytest.fixture
def files(tmp_path):
    ini = write_config(tmp_path)
    (tmp_path / "part.ngc").write_text("G21\nT1 M6\nM2\n")
    return SimpleNamespace(folder=tmp_path, ini=ini, program=tmp_path / "part.ngc")


@pytest.mark.parametrize("name", ["run", "trace", "verify", "plot"])
def test_a_wrong_file_is_reported_in_one_line(name, files, capsys):
    rest = ["-o", "x.png"] if name == "plot" else []
    folder = f"{files.folder}: is a folder"
    for program, ini, more, says in (
        (files.folder / "no.ngc", files.ini, (), "no.ngc: no such file"),
        (files.folder, files.ini, (), folder),
        (files.program, files.folder, (), folder),
        (files.ini, files.program, (), f"{files.program}: is not a machine INI"),
        (files.program, files.ini, ("--tools", files.ini), "mill.ini: is not a tool table"),
        (files.program, files.ini, ("--tools", files.folder), folder),
        (files.program, files.ini, ("--var", files.ini), "mill.ini: is not a var file"),
        (files.program, files.ini, ("--var", files.folder), folder),
    ):
        code, said = ends(capsys, name, program, "--ini", ini, *more, *rest)
        assert (code, said.count("\n")) == (2, 1)
        assert said.startswith(f"g12 {name}: ") and says in said


ANY = {  # a reader: texts that it takes
    tables.tool_table: ["", "; \udce4\n", TOOLS, "P1 T1 D6 ; mill\nd.25 t2\n", "T3\n"],
    tables.var_file: ["", "5220\t1.0\n5221\t-10.5\n\n", " 31 5 kept\n", "# \udce4\n31 1e300\n"],
}
TABLE, VAR, NO_NUMBER = "not a tool table", "not a var file", "no number that a machine can have"
WRONG = [  # a reader, a text, what is said of it
    *((tables.tool_table, text, TABLE) for text in (MILL, "G21\nT1 M6\nM2\n", "P1 D6\n")),
    *((tables.var_file, text, VAR) for text in (
        MILL, TOOLS, "5221 1\n5220 1\n", "5221 1\n5221 2\n", "5221\n", "9999999999 1\n")),
    (tables.var_file, "5221\t1e400\n", f":1: 5221 1e400: {NO_NUMBER}, 1e+09 is"),
    (tables.var_file, "5220 1\n5223 1e17\n", f":2: 5223 1e17: {NO_NUMBER}"),
    (tables.var_file, "31 nan\n", f":1: 31 nan: {NO_NUMBER}"),
    (tables.var_file, f"31 {'9' * 400}\n", ":1: 31 999"),
    (tables.var_file, "5602 1\n", ": 5602: the last parameter is 5601"),
    (tables.tool_table, "T1 P1 D1e400\n", f":1: D1E400: {NO_NUMBER}"),
    (tables.measured_tools, "T1\nT2 Znan\n", f":2: ZNAN: {NO_NUMBER}"),
]  # fmt: skip


@pytest.mark.parametrize("reader", ANY)
def test_tool_tables_and_var_files(tmp_path, reader):
    for text in ANY[reader]:
        (tmp_path / "any").write_bytes(text.encode(errors="surrogateescape"))
        assert reader(tmp_path / "any") == tmp_path / "any"


@pytest.mark.parametrize(("reader", "text", "says"), WRONG)
def test_another_file_or_a_number_beyond_all_measure_is_one_sentence(tmp_path, reader, text, says):
    (tmp_path / "any").write_text(text)
    with pytest.raises(UsageError) as refused:
        reader(tmp_path / "any")
    assert says in str(refused.value)
    assert len(str(refused.value)) < len(str(tmp_path)) + 160


def test_errors_of_linuxcnc_are_explained(files):
    see, unknown = f"see {COMMAND} check", "Unknown g code used"
    has = ": of G12, G13 and G7.1 this INI has"
    for text, ini, more in (
        ("Bad character 'c' used", files.ini, ": this INI's machine has axes X Y Z"),
        ("Bad character 'z' used", files.ini, ""),
        ("Bad character 'q' used", files.ini, ""),
        (unknown, files.ini, f"{has} none; {see}"),
        (unknown, SIM / "lathe_mm.ini", f"{has} G12.1 G13.1 G7.1 G12.4 G13.4; {see}"),
        ("pycall(remap.g13_haas) failed", files.ini, f"; {see}"),
    ):
        assert explained_text(text, ini) == text + more


def test_the_command_is_named_as_it_was_typed(tmp_path):
    """The copy that `install` makes stands in another folder."""
    (tmp_path / "my g12").symlink_to(ROOT)
    run = partial(subprocess.run, cwd=tmp_path, capture_output=True, text=True, check=False)
    for folder, typed in (("my g12/", "'my g12/python/g12'"), (f"{ROOT}/", f"{ROOT}/python/g12")):
        command = [sys.executable, f"{folder}python/g12"]
        said = run([*command, "nonsense"])
        assert said.stderr == f"g12: no command 'nonsense' (usage: python3 {typed} --help)\n"
        said = run([*command, "trace", "--help"])
        assert f"usage: python3 {typed} trace" in " ".join(said.stdout.split())
        assert f"\n  python3 {typed} trace pocket.ngc --ini mill.ini" in said.stdout


def raise_in(monkeypatch, raised):
    """Let every command raise an exception."""

    def ended(_options):
        raise raised

    module = SimpleNamespace(main=ended, command_parser=argparse.ArgumentParser)
    monkeypatch.setattr(main, "import_module", lambda _name: module)


@pytest.mark.parametrize(
    ("raised", "code", "said"),
    [
        (KeyboardInterrupt(), 130, "interrupted"),
        (BrokenPipeError(32, "Broken pipe"), 2, "[Errno 32] Broken pipe"),  # not of the output
    ],
)
def test_what_ends_a_command_is_one_line(monkeypatch, capsys, raised, code, said):
    monkeypatch.setattr(main, "nobody_reads", lambda: False)
    raise_in(monkeypatch, raised)
    assert ends(capsys, "verify") == (code, f"g12 verify: {said}\n")


@pytest.mark.parametrize("words", [["--help"], ["install", "--help"]])
def test_an_output_that_nobody_reads_is_no_error(tmp_path, words):
    read, write = os.pipe()
    os.close(read)
    call = [sys.executable, PROGRAM, *words]
    done = subprocess.run(call, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


NO_SUB = "INTERP_REMAP: NGC file not found: ngc=g12_haas"


@pytest.mark.parametrize(
    ("line", "cure"),
    [
        ("./c.hal:57: Pin 'iocontrol.0.lube' does not exist", ""),
        (NO_SUB, f"; see {COMMAND} check"),
    ],
)
def test_of_a_log_the_most_specific_line_is_reported(line, cure, monkeypatch, capsys):
    log = ["lathe.ini: LinuxCNC ended; its log ends:", "Starting", line, "Recommend: both"]
    raise_in(monkeypatch, StartupError("\n".join(log)))
    said = f"g12 run: lathe.ini: LinuxCNC ended; its log ends: … {line}{cure}\n"
    assert ends(capsys, "run") == (2, said)
