# SPDX-License-Identifier: GPL-2.0-or-later
"""The package's own copy inside a machine config: folder ``g12`` with a list of its files."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

from g12.cli.features import ROOT
from g12.cli.safe_write import take_owner

NAME = "g12"  # of the folder in the config's folder
MANIFEST = "MANIFEST"  # as sha256sum writes and checks it
PARTS = ("LICENSE", "ngc/*.ngc", "configs/include/*.inc", "python/*.py", "python/g12/**/*.py")
EDITED = ".edited"


def package_files() -> dict[str, bytes]:
    """Return the files of this package, by their names below its folder."""
    paths = sorted(path for part in PARTS for path in ROOT.glob(part))
    return {path.relative_to(ROOT).as_posix(): path.read_bytes() for path in paths}


def digest(content: bytes) -> str:
    """Return a file's SHA-256 in hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def is_package(folder: Path) -> bool:
    """Tell whether a folder holds the package, copied by whomever."""
    return (folder / "python" / "g12" / "__init__.py").is_file() and (folder / "ngc").is_dir()


def is_copy(folder: Path) -> bool:
    """Tell whether a folder is a copy that `install` made."""
    return (folder / MANIFEST).is_file()


def listed(folder: Path) -> dict[str, str]:
    """Return the files of a copy with the digest they were installed with."""
    lines = (folder / MANIFEST).read_text(encoding="utf-8").splitlines() if is_copy(folder) else []
    return {name: value for value, name in (line.split("  ", 1) for line in lines)}


def edited(folder: Path) -> list[str]:
    """Return the files of a copy that somebody changed since they were installed."""
    return [
        name
        for name, value in listed(folder).items()
        if (folder / name).is_file() and digest((folder / name).read_bytes()) != value
    ]


def stale(folder: Path) -> list[str]:
    """Return the files of this package that a copy lacks or has in another version."""
    there = listed(folder)
    return [name for name, content in package_files().items() if there.get(name) != digest(content)]


def write_copy(folder: Path) -> list[str]:
    """Make a copy of this package or bring it up to date.

    Returns the names of edited files that were put aside for a newer version.
    """
    old = listed(folder)
    aside = [name for name in edited(folder) if name in stale(folder)]
    for name in aside:
        (folder / name).rename(folder / f"{name}{EDITED}")
    files = package_files()
    for name in stale(folder):
        make_folder((folder / name).parent, folder.parent)
        (folder / name).write_bytes(files[name])
        take_owner(folder / name)
    for name in set(old) - set(files):
        (folder / name).unlink(missing_ok=True)
    lines = [f"{digest(content)}  {name}\n" for name, content in files.items()]
    (folder / MANIFEST).write_text("".join(lines), encoding="utf-8")
    return aside


def make_folder(folder: Path, above: Path) -> None:
    """Create a folder and those it is in, with the owner of the config's folder."""
    below = [path for path in (folder, *folder.parents) if above in path.parents]
    for path in reversed([path for path in below if not path.exists()]):
        path.mkdir()
        take_owner(path)


def remove_copy(folder: Path) -> list[str]:
    """Take a copy away; return the names of files in it that somebody edited or added."""
    changed = set(edited(folder))
    for name in set(listed(folder)) - changed:
        (folder / name).unlink(missing_ok=True)
    (folder / MANIFEST).unlink()
    for cache in sorted(folder.rglob("__pycache__")):
        shutil.rmtree(cache)
    for path in sorted(folder.rglob("*"), reverse=True):
        if path.is_dir() and not any(path.iterdir()):
            path.rmdir()
    if not any(folder.iterdir()):
        folder.rmdir()
        return []
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
