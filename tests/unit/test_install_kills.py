# SPDX-License-Identifier: GPL-2.0-or-later
"""install, an update and uninstall, killed before each call that changes the file system.

`interp/test_install_kills.py` kills the real commands.
"""

import os
import shutil
import signal
import sys
from itertools import product

import pytest

from g12.tools.install import installation, package_copy, placing, removal
from g12.tools.install.config.ini_edit import IniText
from g12.tools.install.rules import findings_of
from support.small_configs import (
    MILL,
    config_of,
    content_of,
    files_of_package,
    package_of,
    write_config,
)

OLD = {
    "ngc/g12_mitsubishi.ngc": b"(one)\n",
    "ngc/gone.ngc": b"(one)\n",
    "python/g12/__init__.py": b"",
    **files_of_package("python/toplevel.py", "python/remap.py"),
}
NEW = {**{name: OLD[name] for name in OLD if "gone" not in name},
       "ngc/g12_mitsubishi.ngc": b"(two)\n"}  # fmt: skip
INI = MILL + "[PYTHON]\nPATH_PREPEND = python\nTOPLEVEL = python/toplevel.py\n"
CHANGES = {f"os.{name}" for name in ("mkdir", "rename", "remove", "rmdir", "chmod", "chown")}
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


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """Return the INI of a config with Python of its own; no LinuxCNC loads it."""
    modules = {"python__toplevel_py": "import remap\n", "python__remap_py": "x = 1\n"}
    (tmp_path / "mill").mkdir()
    ini = write_config(tmp_path / "mill", INI, **modules)
    own = {"remap": {"x": "remap"}, "remap_file": str(ini.parent / "python" / "remap.py")}
    monkeypatch.setattr(installation, "load_config", lambda text: config_of(text.path, **own))
    monkeypatch.setattr(installation, "try_out", lambda _: [])
    return ini


def no_exchange(*_arguments):
    return -1


def no_folder_is_renamed(folder, target):
    """Rename as in a lower layer of an overlay: not a folder that was there before."""
    if folder.name == "g12" and folder.parent.name == "mill":
        raise OSError(placing.EXDEV, "Invalid cross-device link")
    os.rename(folder, target)


def replace_folders(monkeypatch, file_system):
    """Replace folders as a file system does it."""
    if file_system != "exchange":
        monkeypatch.setattr(placing.LIBC, "renameat2", no_exchange)
    if file_system == "overlay":
        monkeypatch.setattr(placing.Path, "rename", no_folder_is_renamed)


def install(ini):
    return list(installation.install(IniText(ini), ["mitsubishi"], dry_run=False))


def uninstall(ini):
    return list(removal.uninstall(IniText(ini), dry_run=False))


def update(monkeypatch):
    """Return the installation of a newer package, which replaces an edited file."""
    return lambda ini: monkeypatch.setattr(package_copy, "package_files", lambda: dict(NEW)) or (
        install(ini))  # fmt: skip


@pytest.mark.parametrize(
    ("command", "file_system"),
    [
        ("install", "exchange"),
        *product(("update", "uninstall"), ("exchange", "renames", "overlay")),
    ],
)
def test_a_second_run_completes_it(machine, monkeypatch, command, file_system):
    replace_folders(monkeypatch, file_system)
    work = {"install": install, "update": update(monkeypatch), "uninstall": uninstall}[command]
    folder, kept = machine.parent, machine.parent.with_name("kept")
    if command != "install":
        install(machine)
        (folder / EDITED).write_text("(mine)\n")
    shutil.copytree(folder, kept)
    before = content_of(folder)
    work(machine)
    after, number = content_of(folder), 0
    renew(folder, kept)
    while killed_at(number, lambda: work(machine)):
        now = content_of(folder)
        assert now[machine.name] in (before[machine.name], after[machine.name])
        if file_system == "exchange":
            assert copy_in(now) in (copy_in(before), copy_in(after))
        found = {finding.kind for finding in findings_of(config_of(machine))}
        assert "unfinished" in found or now in (before, after)
        assert (folder / placing.BESIDE).exists() == ("unfinished" in found)
        work(machine)
        assert content_of(folder) == after
        assert not (folder / placing.BESIDE).exists()
        renew(folder, kept)
        number += 1
    assert number > 20


def renew(folder, kept):
    shutil.rmtree(folder)
    shutil.copytree(kept, folder)


def copy_in(content):
    """Return the files of the copy."""
    return {name: text for name, text in content.items() if name.startswith("g12/")}
