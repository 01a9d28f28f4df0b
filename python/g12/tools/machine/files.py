# SPDX-License-Identifier: GPL-2.0-or-later
"""Changes of a user's files: diffs, backups, atomic writes."""

import contextlib
import difflib
import filecmp
import glob
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from g12.tools.errors import UsageError

BACKUP = ".before-g12"


def existing(path: Path) -> Path:
    """Return the path of a file that can be read; raise UsageError or OSError."""
    if path.is_dir():
        raise UsageError(f"{path}: is a folder")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    with open(path, "rb"):
        return path


def difference(path: Path, content: bytes) -> Iterator[str]:
    """Yield the lines of a unified diff from the present file to its new content."""
    old, new = (
        text.decode("utf-8", "replace").splitlines() for text in (path.read_bytes(), content)
    )
    return difflib.unified_diff(old, new, str(path), f"{path} (new)", lineterm="", n=2)


def write(path: Path, content: bytes) -> None:
    """Write a file atomically; mode and owner stay."""
    path = path.resolve()  # replaces a link's target, not the link
    remove_unfinished(path)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=unfinished(path))
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        take_after(Path(name), path)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


def unfinished(path: Path) -> str:
    """Return how the names begin under which a file's new content is written."""
    return f".{path.name}.g12-"


def remove_unfinished(path: Path) -> None:
    """Remove what a `write` left that was killed."""
    for left in path.parent.glob(f"{glob.escape(unfinished(path))}????????"):
        left.unlink(missing_ok=True)


def require_writable(paths: Iterable[Path]) -> None:
    """Raise OSError for the first file that its owner protects from being changed."""
    for path in paths:
        with open(path, "r+b"):
            pass


def take_after(new: Path, path: Path) -> None:
    """Give a new file the mode and owner of the one at ``path``, if there is one."""
    if path.exists():
        shutil.copymode(path, new)
    else:
        new.chmod(0o644)
    take_owner(new, path if path.exists() else None)


def take_owner(new: Path, model: Path | None = None) -> None:
    """Give a new file the owner of another, or of its folder: the user may be root."""
    owner = (model or new.parent).stat()
    with contextlib.suppress(PermissionError):
        os.chown(new, owner.st_uid, owner.st_gid)


def write_all(changes: Mapping[Path, bytes]) -> None:
    """Write several files; if one cannot be written, restore the others."""
    old = {path: path.read_bytes() for path in changes}
    written: list[Path] = []
    try:
        for path, content in changes.items():
            write(path, content)
            written.append(path)
    except BaseException:
        for path in written:
            write(path, old[path])
        raise


def backups_of(path: Path) -> list[Path]:
    return sorted(path.parent.glob(f"{path.name}{BACKUP}*"))


def back_up(path: Path) -> Path:
    """Copy the file to a backup, and return the backup's path."""
    backups = backups_of(path)
    for backup in backups:
        if filecmp.cmp(path, backup, shallow=False):
            return backup
    number = f".{len(backups) + 1}" if backups else ""
    backup = path.with_name(f"{path.name}{BACKUP}{number}")
    shutil.copy2(path, backup)
    take_after(backup, path)
    return backup


def drop_backup(path: Path) -> list[Path]:
    """Delete the backup that equals the file; return the remaining ones."""
    for backup in backups_of(path):
        if filecmp.cmp(path, backup, shallow=False):
            backup.unlink()
    return backups_of(path)
