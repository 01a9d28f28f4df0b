# SPDX-License-Identifier: GPL-2.0-or-later
"""Bytes that are no UTF-8, in files and their names: every command reads them as LinuxCNC does."""

import os
from pathlib import Path

import pytest

from g12.tools.commands import main
from support.sim_machines import copy_of_machines
from support.small_configs import MILL, write_config

PROGRAM = b"""\
(Fr\xe4sen \xd8 20)
G21 G17 G90 G0 X0 Y0 Z5
T4 M6 S3000 M3
(MSG, L\xe4nge)
G13 I10 Z-1 D4 F500 (\xfc)
G0 Z5
M2
"""
FOREIGN = b"%\nO1 (FR\xc4SEN)\nG21 G90 G54 G0 X0. Y0. (\xfc)\nM30\n%\n"


def named(folder, name):
    """Return a path whose name is bytes."""
    return Path(os.fsdecode(os.path.join(os.fsencode(folder), name)))


@pytest.fixture
def shop(tmp_path, monkeypatch):
    """Return a folder with a machine, a table, a var file and programs, all with such bytes."""
    monkeypatch.chdir(tmp_path)
    folder = named(tmp_path, b"Dr\xe4hen")
    folder.mkdir()
    machines = copy_of_machines(folder)
    ini = (machines / "mill_mm.ini").read_bytes()
    named(machines, b"M\xfchle.ini").write_bytes(b"# K\xf6ln\n" + ini)
    named(folder, b"t\xe4ble.tbl").write_bytes(b"; \xe4\nT4 P4 D10 ;Fr\xe4ser\n")
    named(folder, b"v\xe4r.var").write_bytes(b"# \xe4\n5220\t1\n5221\t10\n")
    named(folder, b"Fr\xe4se.ngc").write_bytes(PROGRAM)
    named(folder, b"Fr\xe4se.NC").write_bytes(FOREIGN)
    return folder


TOOLS = "--tools", "t\udce4ble.tbl", "--var", "v\udce4r.var"
MACHINE = "--ini", "configs/sim/M\udcfchle.ini"
COMMANDS = [
    ("trace", "Fr\udce4se.ngc", *MACHINE, *TOOLS),
    ("trace", "Fr\udce4se.NC", *MACHINE),
    ("verify", "Fr\udce4se.ngc", *MACHINE, *TOOLS),
    ("plot", "Fr\udce4se.ngc", *MACHINE, *TOOLS, "-o", "B\udce4ld.svg"),
    ("regress", "record", "Fr\udce4se.ngc", *MACHINE, *TOOLS, "-d", "Aufn\udce4hmen"),
    ("translate", "--control", "haas-mill", "Fr\udce4se.NC"),
    ("translate", "--control", "haas-mill", *MACHINE, "Fr\udce4se.NC"),
    ("check", "configs/sim/M\udcfchle.ini"),
]


@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_a_command_reads_them(shop, monkeypatch, capfd, words):
    monkeypatch.chdir(shop)
    assert main.main(list(words)) == 0, capfd.readouterr().err
    assert "Traceback" not in capfd.readouterr().err


def test_messages_and_errors_have_the_lines_of_the_users_file(shop, monkeypatch, capfd):
    monkeypatch.chdir(shop)
    main.main(["trace", "Fr\udce4se.ngc", *MACHINE, *TOOLS])
    assert "     4 message  L?nge\n" in capfd.readouterr().out
    Path("Fr\udce4se.ngc").write_bytes(PROGRAM.replace(b"I10", b"I1"))
    assert main.main(["trace", "Fr\udce4se.ngc", *MACHINE, *TOOLS]) == 2
    assert capfd.readouterr().err.startswith("g12 trace: Fr\\udce4se.ngc:5: G13: I1 must be")


def test_a_sub_that_the_preview_cannot_read_is_named(tmp_path, capfd):
    ini = write_config(tmp_path, MILL)
    (tmp_path / "part.ngc").write_text("G21\nG0 X1\no<own> call\nM2\n")
    (tmp_path / "own.ngc").write_bytes(b"o<own> sub\n(Fr\xe4sen)\no<own> endsub\nM2\n")
    program = str(tmp_path / "part.ngc")
    assert main.main(["trace", program, "--ini", str(ini)]) == 2
    says = f"g12 trace: {program}:3: own.ngc:2: a byte that is no UTF-8: LinuxCNC runs it, its"
    assert capfd.readouterr().err.startswith(says)


def test_a_value_of_the_ini_that_is_no_utf8_is_refused_by_its_key(tmp_path, capfd):
    """LinuxCNC 2.9 reads such an INI, 2.10 does not."""
    ini = copy_of_machines(tmp_path) / "mill_mm.ini"
    ini.write_bytes(ini.read_bytes().replace(b"MAX_LIMIT = 300", b"MAX_LIMIT = \xe4300", 1))
    program = tmp_path / "part.ngc"
    program.write_bytes(PROGRAM)
    assert main.main(["trace", str(program), "--ini", str(ini)]) == 2
    said = capfd.readouterr().err
    assert "[AXIS_Z] MAX_LIMIT: has a byte that is no UTF-8" in said or "does not read it" in said
