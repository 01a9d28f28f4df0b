# SPDX-License-Identifier: GPL-2.0-or-later
"""The package's own copy inside a machine config: folder ``g12`` with a list of its files."""

import hashlib
import re
import shutil
import tempfile
from collections.abc import Iterable
from itertools import chain, count
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install.config.features import ROOT
from g12.tools.machine.files import take_owner, write

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
    "configs/include/forms.ui",
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
    entries, here = [MANIFEST_ENTRY.fullmatch(line) for line in lines], folder.resolve()
    for number, (line, entry) in enumerate(zip(lines, entries), start=1):
        if not entry or not is_below(here, entry[2]):
            raise UsageError(f"{manifest}:{number}: not a line that install wrote: {line[:80]!r}; "
                             "take that line out")  # fmt: skip
    return {entry[2]: entry[1] for entry in entries}


def is_below(folder: Path, name: str) -> bool:
    """Return whether a file's name is below a folder with all its links followed."""
    above = (folder / name).parent
    return ".." not in above.parts and above.resolve().is_relative_to(folder)


def edited(folder: Path) -> list[str]:
    """Return the files of a copy that were changed since their installation."""
    found = ((name, value, digest_of(folder / name)) for name, value in listed(folder).items())
    return [name for name, value, present in found if present not in ("", value)]


def missing(folder: Path) -> list[str]:
    """Return the missing files of a copy, and those that have become empty."""
    return [name for name, value in listed(folder).items() if is_damaged(folder / name, value)]


def is_damaged(path: Path, value: str) -> bool:
    """Return whether a file is missing, or empty with another digest in the list."""
    found = digest_of(path)
    return found in LOST_DIGESTS and found != value


def stale(folder: Path) -> list[str]:
    """Return the files of this package that a copy lacks or has in another version."""
    installed = listed(folder)
    return [
        name
        for name, content in package_files().items()
        if installed.get(name) != digest(content) or is_damaged(folder / name, digest(content))
    ]


def leftovers(folder: Path) -> list[str]:
    """Return the files of a folder if all are of the kinds that `uninstall` leaves, else none."""
    names, known = files_below(folder), package_files()
    return names if all(name.partition(EDITED_SUFFIX)[0] in known for name in names) else []


def files_below(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def write_copy(folder: Path) -> list[str]:
    """Make a copy of this package, or update it.

    Returns the new names of edited files that a newer version replaces.
    """
    for unfinished in abandoned(folder):
        shutil.rmtree(unfinished)
    if folder.exists():
        return update_copy(folder)
    new = Path(tempfile.mkdtemp(dir=folder.parent, prefix=f".{folder.name}."))
    try:
        new.chmod(0o755)
        take_owner(new)
        update_copy(new)
        new.rename(folder)
    except BaseException:
        shutil.rmtree(new)
        raise
    return []


def abandoned(folder: Path) -> list[Path]:
    """Return the unfinished copies beside a folder, of an `install` that was killed."""
    ours = {*package_files(), MANIFEST}
    return [
        path
        for path in folder.parent.glob(f".{folder.name}.????????")
        if path.is_dir()
        and all(name in ours or Path(name).name.startswith(".") for name in files_below(path))
    ]


def update_copy(folder: Path) -> list[str]:
    """Update a copy; return the new names of edited files."""
    files, old, outdated = package_files(), listed(folder), stale(folder)
    new = {name: digest(content) for name, content in files.items()}
    obsolete = [name for name in old if name not in files]
    present = {name: digest_of(folder / name) for name in (*outdated, *obsolete)}
    renamed = [
        rename_edited(folder, name)
        for name, found in present.items()
        if found not in (*LOST_DIGESTS, old.get(name), new.get(name))
    ]
    write_files(folder, {name: files[name] for name in outdated})
    lines = [f"{value}  {name}\n" for name, value in new.items()]
    write_files(folder, {MANIFEST: "".join(lines).encode()})
    remove_files(folder, obsolete)
    return renamed


def rename_edited(folder: Path, name: str) -> str:
    """Rename an edited file to a free name; return that."""
    first = f"{name}{EDITED_SUFFIX}"
    names = chain([first], (f"{first}.{number}" for number in count(2)))
    free = next(name for name in names if not (folder / name).exists())
    (folder / name).rename(folder / free)
    return free


def write_files(folder: Path, files: dict[str, bytes]) -> None:
    """Write files below a folder, each atomically, in folders with the owner of those above."""
    for name, content in files.items():
        path = folder / name
        for parent in reversed(path.parents):
            if not parent.exists():
                parent.mkdir()
                take_owner(parent)
        write(path, content)


def remove_files(folder: Path, names: Iterable[str]) -> None:
    """Remove files, and the folders that become empty."""
    for name in names:
        (folder / name).unlink(missing_ok=True)
    for cache in sorted(folder.rglob("__pycache__")):
        shutil.rmtree(cache)
    for path in sorted(folder.rglob("*"), reverse=True):
        if path.is_dir() and not path.is_symlink() and not any(path.iterdir()):
            path.rmdir()


def remove_copy(folder: Path) -> list[str]:
    """Remove a copy; return the names of edited or added files in it."""
    remove_files(folder, set(listed(folder)) - set(edited(folder)))
    (folder / MANIFEST).unlink()  # the list last: it identifies the copy until then
    if not any(folder.iterdir()):
        folder.rmdir()
        return []
    return files_below(folder)
