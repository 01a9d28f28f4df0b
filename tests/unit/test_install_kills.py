# SPDX-License-Identifier: GPL-2.0-or-later
"""install, an update and uninstall, killed before each call that changes the file system."""

import os
import shutil
import signal
import sys
from itertools import product

import pytest

from g12.tools.install import package_copy
from support.small_configs import (
    MILL,
    content_of,
    files_of_package,
    package_of,
    put_in,
    take_out,
    write_config,
)

OLD = {
    "ngc/g12_mitsubishi.ngc": b"(one)\n",
    "ngc/gone.ngc": b"(one)\n",
    "python/g12/__init__.py": b"",
    **files_of_package("python/toplevel.py"),
}
NEW = {**{name: OLD[name] for name in OLD if "gone" not in name},
       "ngc/g12_mitsubishi.ngc": b"(two)\n"}  # fmt: skip
CHANGES = {f"os.{name}" for name in ("mkdir", "rename", "remove", "rmdir", "chmod", "chown")}
RS274NGC = "[RS274NGC]\nPARAMETER_FILE = mill.var\n"
TWO_FILES = MILL.replace(RS274NGC, "[PYTHON]\nPATH_APPEND = own\n") + "#INCLUDE codes.inc\n"
EDITED = "g12/ngc/g12_mitsubishi.ngc"
small_package = package_of(OLD)


def killed_at(number, work):
    """Work in a process that is killed at a call of the file system; return whether it was."""
    child = os.fork()
    if not child:
        left = iter(range(number))

        def count(event, arguments):
            changes = event in CHANGES or (event == "open" and arguments[2] & os.O_ACCMODE)
            if changes and next(left, None) is None:
                signal.raise_signal(signal.SIGKILL)

        sys.addaudithook(count)
        try:
            work()
        finally:
            os._exit(0)
    return os.waitpid(child, 0)[1] == signal.SIGKILL


def install(ini):
    package_copy.recover(ini.parent / "g12")
    put_in(ini, "mitsubishi")


@pytest.mark.parametrize(
    ("command", "exchanges"),
    [("install", True), *product(("update", "uninstall"), (True, False))],
)
def test_every_file_is_old_or_new_and_a_second_run_completes_it(
    tmp_path, monkeypatch, command, exchanges
):
    folder, kept = tmp_path / "mill", tmp_path / "kept"
    folder.mkdir()
    ini = write_config(folder, TWO_FILES, codes_inc=f"{RS274NGC}[EMCMOT]\n")
    work = take_out if command == "uninstall" else install
    if not exchanges:  # as on NFS
        monkeypatch.setattr(package_copy.LIBC, "renameat2", lambda *_: -1)
    if command != "install":
        install(ini)
        (folder / EDITED).write_text("(mine)\n")
    if command == "update":
        monkeypatch.setattr(package_copy, "package_files", lambda: dict(NEW))
    shutil.copytree(folder, kept)
    before = content_of(folder)
    work(ini)
    after, number = content_of(folder), 0
    renew(folder, kept)
    while killed_at(number, lambda: work(ini)):
        now = content_of(folder)
        for name in (ini.name, "codes.inc"):
            assert now[name] in (before[name], after[name])
        if b"REMAP" in now["codes.inc"]:  # without its Python LinuxCNC would not start
            assert b"TOPLEVEL" in now[ini.name]
        if exchanges:
            assert copy_in(now) in (copy_in(before), copy_in(after))
        work(ini)
        assert content_of(folder) == after
        renew(folder, kept)
        number += 1
    assert number > 10


def renew(folder, kept):
    shutil.rmtree(folder)
    shutil.copytree(kept, folder)


def copy_in(content):
    """Return the files of the copy."""
    return {name: text for name, text in content.items() if name.startswith("g12/")}
