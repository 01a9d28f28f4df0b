# SPDX-License-Identifier: GPL-2.0-or-later
"""The package's own copy inside a machine config: folder ``g12`` with a list of its files."""

import hashlib
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install.config.features import ROOT
from g12.tools.machine.files import free_name, take_owner

NAME = "g12"  # of the folder in the config's folder
MANIFEST = "MANIFEST"  # as sha256sum writes and checks it
PAGE_FILES = (  # the pages that a machinist reads at the machine; they link only to each other
    "ngc/*.md",
    "ngc/pictures/*.png",
    "configs/README.md",
    "configs/spindle_c.md",
    "configs/kinematics/README.md",
    "python/README.md",
    "python/g12/tools/regress/README.md",
    "python/g12/tools/translate/README.md",
)
CODE_FILES = (
    "ngc/*.ngc",
    "ngc/*.png",
    "configs/include/*.inc",
    "configs/include/spindle_c*",
    "configs/include/*.ui",
    "configs/include/axis_face.py",
    "configs/include/probe_basic/**/*.py",
    "configs/kinematics/polar_*",
    "python/*.py",
    "python/g12/**/*.py",
    "python/g12/tools/translate/controls/*.toml",
)
FILES = ("LICENSE", *CODE_FILES, *PAGE_FILES)
EDITED_SUFFIX = ".edited"
MANIFEST_ENTRY = re.compile(r"([0-9a-f]{64})  (\S.*)")


def package_files() -> dict[str, bytes]:
    """Return the files of this package, by their names below its folder."""
    paths = sorted(path for part in FILES for path in ROOT.glob(part))
    return {path.relative_to(ROOT).as_posix(): path.read_bytes() for path in paths}


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def digest_of(path: Path) -> str:
    """Return the SHA-256 of a file in hexadecimal, "" if it is missing."""
    return digest(path.read_bytes()) if path.is_file() else ""


LOST_DIGESTS = ("", digest(b""))  # of a missing file, and of one that a crash left empty


def is_package(folder: Path) -> bool:
    """Return whether a folder holds the package, copied by `install` or by hand."""
    return (folder / "python" / "g12" / "__init__.py").is_file() and (folder / "ngc").is_dir()


def is_copy(folder: Path) -> bool:
    """Return whether a folder is a copy that `install` made."""
    return (folder / MANIFEST).is_file()


def listed(folder: Path) -> dict[str, str]:
    """Return the files of a copy with the digest they were installed with.

    Raises UsageError for a list with names outside the copy.
    """
    manifest = folder / MANIFEST
    content = manifest.read_bytes() if manifest.is_file() else b""
    lines = content.decode("utf-8", "replace").splitlines()
    entries = [MANIFEST_ENTRY.fullmatch(line) for line in lines]
    folders = {os.path.dirname(entry[2]) for entry in entries if entry}
    inside = {name for name in folders if is_inside(folder, name)}
    for number, (line, entry) in enumerate(zip(lines, entries), start=1):
        if not entry or os.path.dirname(entry[2]) not in inside:
            raise UsageError(f"{manifest}:{number}: not a line that install wrote: {line[:80]!r}; "
                             "take that line out")  # fmt: skip
    return {entry[2]: entry[1] for entry in entries}


def is_inside(folder: Path, name: str) -> bool:
    """Return whether a name is that of a folder in another one, with all its links followed."""
    found = (folder / name).resolve()
    return ".." not in Path(name).parts and found.is_relative_to(folder.resolve())


def differing(folder: Path) -> dict[str, str]:
    """Return the files of a copy that are not as they were installed, with their digests now."""
    found = ((name, value, digest_of(folder / name)) for name, value in listed(folder).items())
    return {name: present for name, value, present in found if present != value}


def edited(folder: Path) -> list[str]:
    return [name for name, found in differing(folder).items() if found not in LOST_DIGESTS]


def missing(folder: Path) -> list[str]:
    """Return the missing files of a copy, and those that have become empty."""
    return [name for name, found in differing(folder).items() if found in LOST_DIGESTS]


def digests(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: digest(content) for name, content in files.items()}


def is_current(folder: Path) -> bool:
    """Return whether a copy is one of this package, with all its files."""
    return listed(folder) == digests(package_files()) and not missing(folder)


def write_files(folder: Path, files: Mapping[str, bytes]) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def build(new: Path, copy: Path, files: Mapping[str, bytes]) -> list[str]:
    """Write the next copy of the package with the user's files of the present one.

    ``files`` is the package, nothing for an uninstallation. Returns the user's files that get
    another name. There is no folder without files.
    """
    lines = [f"{value}  {name}\n" for name, value in digests(files).items()]
    write_files(new, {**files, MANIFEST: "".join(lines).encode()} if files else {})
    names = dict(users_files(copy, digests(files)))
    for name, target in names.items():
        (new / target).parent.mkdir(parents=True, exist_ok=True)
        (new / target).unlink(missing_ok=True)
        shutil.copy2(copy / name, new / target, follow_symlinks=False)
    for path in (new, *new.rglob("*")) if new.exists() else ():
        take_owner(path, copy.parent)
    return [target for name, target in names.items() if target != name]


def users_files(copy: Path, new: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Yield the user's files of a copy, each with its name in the next one, whose list is ``new``.

    A file keeps its name unless the package brings another version of it, or none any more.
    """
    old = listed(copy)
    for name in files_below(copy):
        versions, found = (old.get(name), new.get(name)), digest_of(copy / name)
        lost = found in LOST_DIGESTS and any(versions)
        if name == MANIFEST or found in versions or lost:
            continue
        aside = free_name(copy / f"{name}{EDITED_SUFFIX}").relative_to(copy).as_posix()
        yield name, name if versions[0] == versions[1] else aside


def files_below(folder: Path) -> list[str]:
    """Return the files and links below a folder, but for Python's caches."""
    found = []
    for above, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if name != "__pycache__")
        links = [name for name in folders if os.path.islink(os.path.join(above, name))]
        here = Path(above).relative_to(folder)
        found += [(here / name).as_posix() for name in (*links, *sorted(files))]
    return found
