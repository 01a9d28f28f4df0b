# SPDX-License-Identifier: GPL-2.0-or-later
"""What the commands share: wrong words and files in one line, interrupts, closed outputs."""

import os
import subprocess
import sys
from types import SimpleNamespace

import pytest

from g12.tools.commands import arguments, main
from g12.tools.errors import UsageError
from g12.tools.headless.machine import StartupError
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


@pytest.mark.parametrize("name", COMMANDS)
def test_wrong_words_are_reported_in_one_line(name, capsys):
    code, said = ends(capsys, name, "--nonsense", "3")
    assert code == 2
    assert said.startswith(f"g12 {name}: ")
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
    ("reader", "text", "says"),
    [
        (arguments.number_above(0), "0", "'0' is not a number above 0"),
        (arguments.number_above(0), "x", "'x' is not a number above 0"),
        (arguments.number_from(0), "nan", "'nan' is not a number from 0"),
    ],
)
def test_numbers_of_the_command_line(reader, text, says):
    with pytest.raises(arguments.argparse.ArgumentTypeError, match=f"^{says}$"):
        reader(text)


def test_good_numbers_of_the_command_line():
    assert arguments.number_above(0)("0.5") == 0.5
    assert arguments.number_from(0)("0") == 0
    assert arguments.count_from(1)("1") == 1


@pytest.fixture
def files(tmp_path):
    ini = write_config(tmp_path)
    (tmp_path / "part.ngc").write_text("G21\nT1 M6\nM2\n")
    return SimpleNamespace(folder=tmp_path, ini=ini, program=tmp_path / "part.ngc")


@pytest.mark.parametrize("name", ["run", "trace", "verify", "plot"])
def test_wrong_files_are_reported_in_one_line(name, files, capsys):
    rest = ["-o", "x.png"] if name == "plot" else []
    wrong = [
        (files.folder / "no.ngc", files.ini, (), "no.ngc: no such file"),
        (files.folder, files.ini, (), f"{files.folder}: is a folder"),
        (files.program, files.folder, (), f"{files.folder}: is a folder"),
        (files.ini, files.program, (), f"{files.program}: is not a machine INI"),
        (files.program, files.ini, ("--tools", files.ini), "mill.ini: is not a tool table"),
        (files.program, files.ini, ("--tools", files.folder), f"{files.folder}: is a folder"),
        (files.program, files.ini, ("--var", files.ini), "mill.ini: is not a var file"),
        (files.program, files.ini, ("--var", files.folder), f"{files.folder}: is a folder"),
    ]
    for program, ini, more, says in wrong:
        code, said = ends(capsys, name, program, "--ini", ini, *more, *rest)
        assert code == 2
        assert said.startswith(f"g12 {name}: ")
        assert says in said
        assert said.count("\n") == 1


ANY_TABLE = ["", "; none yet\n", TOOLS, "P1 T1 D6 ; mill\nd.25 t2\n", "T3\n"]
NO_TABLE = [MILL, "G21\nT1 M6\nM2\n", "P1 D6\n"]
ANY_VAR = ["", "5220\t1.000000\n5221\t-10.5\n\n", " 31 5 kept\n"]
NO_VAR = [MILL, TOOLS, "5221 1\n5220 1\n", "5221 1\n5221 2\n", "5221\n"]


@pytest.mark.parametrize(
    ("reader", "right", "wrong", "says"),
    [
        (tables.tool_table, ANY_TABLE, NO_TABLE, "not a tool table"),
        (tables.var_file, ANY_VAR, NO_VAR, "not a var file"),
    ],
)
def test_tool_tables_and_var_files(tmp_path, reader, right, wrong, says):
    path = tmp_path / "any"
    for text in right:
        path.write_text(text)
        assert reader(path) == path
    for text in wrong:
        path.write_text(text)
        with pytest.raises(UsageError, match=says):
            reader(path)


def test_an_axis_that_the_machine_lacks_is_explained(files):
    said = explained_text("Bad character 'c' used", files.ini)
    assert said == "Bad character 'c' used: this INI's machine has axes X Y Z"
    for text in ("Bad character 'z' used", "Bad character 'q' used"):
        assert explained_text(text, files.ini) == text


def test_a_code_that_the_machine_lacks_points_to_what_is_set_up(files):
    said = "Unknown g code used: of G12, G13 and G7.1 this INI has"
    see = f"see {COMMAND} check"
    assert explained_text("Unknown g code used", files.ini) == f"{said} none; {see}"
    there = "G12.1 G13.1 G7.1 G12.4 G13.4"
    lathe = SIM / "lathe_mm.ini"
    assert explained_text("Unknown g code used", lathe) == f"{said} {there}; {see}"


def test_a_handler_that_linuxcnc_cannot_call_points_to_check(files):
    said = "pycall(remap.g13_haas) failed"
    assert explained_text(said, files.ini) == f"{said}; see {COMMAND} check"


def test_events_that_are_not_there(tmp_path, capsys):
    assert ends(capsys, "dynapath", tmp_path / "no.dyn") == (
        2,
        f"g12 dynapath: {tmp_path / 'no.dyn'}: no such file\n",
    )
    (tmp_path / "bad.dyn").write_text("nonsense\n")
    code, said = ends(capsys, "dynapath", tmp_path / "bad.dyn")
    assert code == 1
    assert said.startswith(f"g12 dynapath: {tmp_path / 'bad.dyn'}: ")
    assert said.count("\n") == 1


def test_a_folder_that_cannot_be_made(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    pictures = tmp_path / "file" / "pictures"
    assert ends(capsys, "demo", "--output", pictures) == (
        2,
        f"g12 demo: {pictures}: Not a directory\n",
    )


def test_the_command_is_named_as_it_was_typed(tmp_path):
    """The copy that `install` makes stands in another folder."""
    (tmp_path / "my g12").symlink_to(ROOT)
    for folder, typed in (("my g12/", "'my g12/python/g12'"), (f"{ROOT}/", f"{ROOT}/python/g12")):
        command = [sys.executable, f"{folder}python/g12"]
        said = subprocess.run(
            [*command, "nonsense"], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert said.stderr == f"g12: no command 'nonsense' (usage: python3 {typed} --help)\n"
        said = subprocess.run(
            [*command, "trace", "--help"], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert f"usage: python3 {typed} trace" in " ".join(said.stdout.split())
        assert f"\n  python3 {typed} trace pocket.ngc --ini mill.ini" in said.stdout


def test_an_interrupt_is_one_line(monkeypatch, capsys):
    def interrupted(_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(main, "import_module", lambda _name: SimpleNamespace(main=interrupted))
    assert ends(capsys, "verify") == (130, "g12 verify: interrupted\n")


@pytest.mark.parametrize("words", [["--help"], ["install", "--help"], ["dynapath", "events.dyn"]])
def test_an_output_that_nobody_reads_is_no_error(tmp_path, words):
    (tmp_path / "events.dyn").write_text(
        "N1(4)G7X1.5Y2.Z-.5W.1O.5R1.5D0C2K.2J.3L.02P5F20V15$\n" * 3000
    )
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run(
        [sys.executable, PROGRAM, *words],
        cwd=tmp_path,
        stdout=write,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(write)
    assert done.stderr == ""
    assert done.returncode == 141


def test_a_pipe_that_breaks_elsewhere_is_reported(monkeypatch, capsys):
    def broken(_arguments):
        raise BrokenPipeError(32, "Broken pipe")

    monkeypatch.setattr(main, "import_module", lambda _name: SimpleNamespace(main=broken))
    monkeypatch.setattr(main, "nobody_reads", lambda: False)
    assert ends(capsys, "run") == (1, "g12 run: [Errno 32] Broken pipe\n")


@pytest.mark.parametrize(
    ("log", "tells"),
    [
        (["Starting", "./c.hal:57: Pin 'iocontrol.0.lube' does not exist", "Recommend: both"], 1),
    ],
)
def test_of_a_log_the_most_specific_line_is_reported(log, tells, capsys):
    @arguments.one_line("run")
    def command(_words):
        raise StartupError("\n".join(["lathe.ini: LinuxCNC ended; its log ends:", *log]))

    assert command([]) == 1
    said = capsys.readouterr().err
    assert said == f"g12 run: lathe.ini: LinuxCNC ended; its log ends: … {log[tells]}\n"
