# SPDX-License-Identifier: GPL-2.0-or-later
"""The package's own copy inside a machine config: folder ``g12`` with a list of its files.

A new copy is made whole in a folder beside the old one, and takes its place in one step.
"""

import ctypes
import hashlib
import os
import re
import shutil
from collections.abc import Mapping
from pathlib import Path

from g12.tools.install.config.features import ROOT
from g12.tools.machine.files import free_name, take_owner

MANIFEST = "MANIFEST"  # as sha256sum writes and checks it
FILES = (  # the code, and the pages that a machinist reads at the machine
    "LICENSE",
    "ngc/**/*.*",
    "configs/*.md",
    "configs/include/*.*",
    "configs/include/probe_basic/**/*.py",
    "configs/kinematics/*.*",
    "python/**/*.py",
    "python/**/*.md",
    "python/**/*.toml",
)
EDITED_SUFFIX = ".edited"
MANIFEST_ENTRY = re.compile(r"([0-9a-f]{64})  (\S.*)", re.MULTILINE)
BESIDE, ASIDE = ".g12-new", ".g12-old"  # the new copy; the old one, where two cannot be exchanged
RENAME_EXCHANGE, AT_FDCWD = 2, -100  # of Linux
LIBC = ctypes.CDLL(None)


def package_files() -> dict[str, bytes]:
    """Return the files of this package, by their names below its folder."""
    paths = sorted(path for part in FILES for path in ROOT.glob(part))
    return {path.relative_to(ROOT).as_posix(): path.read_bytes() for path in paths}


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def digests(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: digest(content) for name, content in files.items()}


def is_copy(folder: Path) -> bool:
    """Return whether a folder is a copy that `install` made."""
    return (folder / MANIFEST).is_file()


def listed(folder: Path) -> dict[str, str]:
    """Return the files of a copy with the digests they were installed with."""
    text = (folder / MANIFEST).read_text(errors="replace") if is_copy(folder) else ""
    return {name: value for value, name in MANIFEST_ENTRY.findall(text)}


def changed(folder: Path) -> dict[str, str]:
    """Return the files of a copy that are not as installed, with their digests, "" of lost ones."""
    now = {name: digest_of(folder / name) for name in listed(folder)}
    return dict(now.items() - listed(folder).items())


def digest_of(file: Path) -> str:
    return digest(file.read_bytes()) if file.is_file() else ""


def is_current(folder: Path) -> bool:
    """Return whether a copy is one of this package, with all its files, or is this package."""
    if folder.exists() and folder.samefile(ROOT):
        return True
    is_whole = "" not in changed(folder).values()
    return is_whole and listed(folder) == digests(package_files())


def replace(copy: Path, files: Mapping[str, bytes]) -> list[str]:
    """Put a new copy in the place of the present one, with the user's files of that.

    ``files`` is the package, nothing for an uninstallation: there is no folder without files.
    Returns the user's files that get another name.
    """
    new, old = recover(copy)
    renamed = build(new, copy, files)
    os.sync()
    put_in_place(new, copy, old)
    os.sync()
    remove(new)
    remove(old)
    return renamed


def recover(copy: Path) -> tuple[Path, Path]:
    """Remove what a killed command left beside a copy; return the names of these folders.

    The old copy goes back if it was killed between two renames.
    """
    new, old = copy.with_name(BESIDE), copy.with_name(ASIDE)
    if old.exists() and not copy.exists():
        old.rename(copy)
    remove(new)
    remove(old)
    return new, old


def build(new: Path, copy: Path, files: Mapping[str, bytes]) -> list[str]:
    """Write a new copy with the user's files of the present one; return those renamed.

    A file keeps its name unless the package brings another version of it, or none any more.
    """
    present, coming = listed(copy), digests(files)
    manifest = "".join(f"{value}  {name}\n" for name, value in coming.items())
    for name, content in {**files, MANIFEST: manifest.encode()}.items() if files else ():
        (new / name).parent.mkdir(parents=True, exist_ok=True)
        (new / name).write_bytes(content)
    renamed = []
    for name in files_below(copy):
        versions, target = (present.get(name), coming.get(name)), name
        if name == MANIFEST or digest_of(copy / name) in versions:
            continue
        if versions[0] != versions[1] or (new / name).is_dir():  # a link in place of a folder
            aside = free_name(copy / f"{name}{EDITED_SUFFIX}")
            target = aside.relative_to(copy).as_posix()
            renamed.append(target)
        (new / target).parent.mkdir(parents=True, exist_ok=True)
        (new / target).unlink(missing_ok=True)
        shutil.copy2(copy / name, new / target, follow_symlinks=False)
    for path in (new, *new.rglob("*")) if new.exists() else ():
        take_owner(path, copy.parent)
    return renamed


def files_below(folder: Path) -> list[str]:
    """Return the files and links below a folder, but for Python's caches."""
    below = sorted(folder.rglob("*"))
    files = [path.relative_to(folder) for path in below if path.is_symlink() or not path.is_dir()]
    return [file.as_posix() for file in files if "__pycache__" not in file.parts]


def put_in_place(new: Path, copy: Path, old: Path) -> None:
    """Let a new folder, if there is one, take the place of a copy in one step.

    A file system that cannot exchange folders (NFS, exFAT) renames both: between these moments the
    folder is missing.
    """
    names = os.fsencode(new), os.fsencode(copy)
    exchanged = LIBC.renameat2(AT_FDCWD, names[0], AT_FDCWD, names[1], RENAME_EXCHANGE) == 0
    if not exchanged and copy.exists():
        copy.rename(old)
    if not exchanged and new.exists():
        new.rename(copy)


def remove(path: Path) -> None:
    if path.exists():
        shutil.rmtree(path)
