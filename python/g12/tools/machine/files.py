# SPDX-License-Identifier: GPL-2.0-or-later
"""Changes of a user's files: diffs, backups, atomic writes."""

import contextlib
import difflib
import glob
import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from itertools import chain, count
from pathlib import Path

from g12.tools.errors import UsageError

BACKUP = ".before-g12"
NO_UTF8 = re.compile("[\udc80-\udcff]")  # bytes by surrogateescape


def existing(path: Path) -> Path:
    """Return the path of a file that can be read; raise UsageError or OSError."""
    if path.is_dir():
        raise UsageError(f"{path}: is a folder")
    if not path.is_file():
        raise UsageError(f"{path}: no such file")
    with open(path, "rb"):
        return path


def utf8_text(text: str) -> str:
    """Return a text or name with a ``?`` for each byte that is no UTF-8."""
    return NO_UTF8.sub("?", text)


def as_utf8(content: bytes) -> bytes:
    return utf8_text(content.decode(errors="surrogateescape")).encode()


def difference(path: Path, content: bytes) -> Iterator[str]:
    """Yield the lines of a unified diff from the present file to its new content."""
    old, new = (
        text.decode("utf-8", "replace").splitlines() for text in (path.read_bytes(), content)
    )
    return difflib.unified_diff(old, new, str(path), f"{path} (new)", lineterm="", n=2)


def write(path: Path, content: bytes, model: Path | None = None) -> None:
    """Write a file atomically; mode and owner stay, or are those of another file."""
    path = path.resolve()  # replaces a link's target, not the link
    unfinished = f".{path.name}.g12-"
    for left in path.parent.glob(f"{glob.escape(unfinished)}????????"):  # by one that was killed
        left.unlink(missing_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=unfinished)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        take_after(Path(name), model or path)
        os.replace(name, path)
    except BaseException:
        os.unlink(name)
        raise


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
        os.chown(new, owner.st_uid, owner.st_gid, follow_symlinks=False)


def backups_of(path: Path) -> list[Path]:
    return sorted(path.parent.glob(f"{path.name}{BACKUP}*"))


def free_name(path: Path) -> Path:
    """Return a path that nothing has: this one, or with a number behind it."""
    numbered = (path.with_name(f"{path.name}.{number}") for number in count(2))
    return next(each for each in chain([path], numbered) if not os.path.lexists(each))


def equal_backups(path: Path) -> list[Path]:
    """Return the backups that equal the file."""
    return [backup for backup in backups_of(path) if backup.read_bytes() == path.read_bytes()]


def backup_of(path: Path) -> Path:
    """Return the backup that equals the file, or the place for one."""
    equal = equal_backups(path)
    return equal[0] if equal else free_name(path.with_name(f"{path.name}{BACKUP}"))
