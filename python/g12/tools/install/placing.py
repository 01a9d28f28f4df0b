# SPDX-License-Identifier: GPL-2.0-or-later
"""Changes of a config's folder: made whole in a folder beside, then each put in place in one step.

Every file, and the copy of the package, is old or new at any moment, also after a kill. What a
killed command did not put in place stays in the folder beside; the next one removes it.
"""

import ctypes
import fcntl
import os
import shutil
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from errno import EXDEV
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.install.package_copy import NAME
from g12.tools.machine.files import take_after

BESIDE = ".g12-new"  # folder in the config's folder; the following are in it
NEW_FILES = "files"  # new files, by their names in the config's folder
ASIDE = "aside"  # the old copy, until the new one is in its place
GONE = "gone"  # the old copy after that
RENAME_EXCHANGE, AT_FDCWD = 2, -100  # of Linux
LIBC = ctypes.CDLL(None)

Move = tuple[Path, Path]  # a new file or folder, and the place that it takes


@contextmanager
def folder_beside(folder: Path) -> Iterator[Path]:
    """Yield an empty folder in a config's folder, for one command at a time."""
    place = folder / BESIDE
    handle = os.open(folder, os.O_DIRECTORY)
    try:
        lock(handle, place)
        if place.is_symlink():
            raise UsageError(f"{place}: is a link; remove it")
        place.mkdir(mode=0o700, exist_ok=True)
        clear(place)
        try:
            yield place
        finally:
            clear(place)
            place.rmdir()
    finally:
        os.close(handle)


def lock(handle: int, place: Path) -> None:
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        text = f"{place}: another install or uninstall is at work here; wait until it ends"
        raise UsageError(text) from None
    except OSError:  # NFS does not lock a folder
        pass


def clear(place: Path) -> None:
    """Empty the folder beside; an old copy that no new one has replaced goes back."""
    aside, copy = place / ASIDE, place.parent / NAME
    if aside.exists():
        remove(copy)
        aside.rename(copy)
    for path in place.iterdir():
        remove(path)


def remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def left_beside(folder: Path) -> list[str]:
    """Return the names of the files that a killed command did not put in place."""
    files = folder / BESIDE / NEW_FILES
    return [str(path.relative_to(files)) for path in files.rglob("*") if path.is_file()]


def tidy(folder: Path) -> Iterator[str]:
    """Remove what a killed command left; yield a line about it."""
    if (folder / BESIDE).exists():
        with folder_beside(folder) as place:
            pass
        yield f"{place}: removed, a command was stopped before its end"


def stage(place: Path, path: Path, content: bytes, model: Path) -> Move:
    """Write a file for a place, with the mode and owner of ``model``, which may be changed.

    Refuses one that could not take its place in one step.
    """
    path, here = path.resolve(), place.parent.resolve()
    if not path.is_relative_to(here) or path.parent.stat().st_dev != here.stat().st_dev:
        text = "is not on the file system of the config's folder, where it could be replaced whole"
        raise UsageError(f"{path}: {text}; copy it into {here} itself")
    with open(model, "r+b"):  # its owner may protect it
        pass
    new = place / NEW_FILES / path.relative_to(here)
    new.parent.mkdir(parents=True, exist_ok=True)
    new.write_bytes(content)
    take_after(new, model)
    return new, path


def put_in_place(place: Path, moves: Iterable[Move]) -> None:
    """Put new files and folders in their places, in order; all of them are on the disk by then."""
    sync(place, LIBC.syncfs)
    for new, target in moves:
        if target.is_dir() or new.is_dir():
            replace_folder(new, target)
        else:
            os.replace(new, target)
        sync(target.parent, os.fsync)


def sync(folder: Path, function: Callable[[int], object]) -> None:
    handle = os.open(folder, os.O_DIRECTORY)
    function(handle)
    os.close(handle)


def replace_folder(new: Path, old: Path) -> None:
    """Put a folder in the place of an old one; a new one that does not exist frees the place.

    A file system that cannot exchange folders (NFS, exFAT) renames both: between these moments the
    folder is missing.
    """
    names = os.fsencode(new), os.fsencode(old)
    if not old.exists():
        new.rename(old)
    elif LIBC.renameat2(AT_FDCWD, names[0], AT_FDCWD, names[1], RENAME_EXCHANGE) != 0:
        aside = new.with_name(ASIDE)
        move(old, aside)
        if new.exists():
            new.rename(old)
        aside.rename(new.with_name(GONE))


def move(folder: Path, target: Path) -> None:
    """Rename a folder; one in a lower layer of an overlay, which has no new name, is copied."""
    try:
        folder.rename(target)
    except OSError as error:
        if error.errno != EXDEV:
            raise
        copied = target.with_name(f"{target.name}.part")
        shutil.copytree(folder, copied, symlinks=True)
        copied.rename(target)
        shutil.rmtree(folder)
