# SPDX-License-Identifier: GPL-2.0-or-later
"""Sections and keys of an INI file's text, as LinuxCNC 2.9 reads them.

The first section of a name is read, a backslash at a line's end continues it, and of several
lines with one key the first counts.  (2.10 reads later sections of the name too.)
``#INCLUDE`` is a line of its own: see ``with_included``.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

INCLUDE = re.compile(r"\s*#INCLUDE\s+(\S.*)")
EXPANDED = ".expanded"  # suffix of the expanded file that the linuxcnc script of 2.9 writes
DEEPEST_INCLUDE = 16  # files that include each other, as LinuxCNC 2.10 allows
LEADING_NUMBER = re.compile(r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|inf)", re.IGNORECASE)


class Entry(NamedTuple):
    """An entry; ``row`` is its line, counted from 0, the first of a continued one."""

    row: int
    key: str
    value: str


def included_file(line: str, directory: Path) -> Path | None:
    """Return the file that a line of an INI in ``directory`` includes, if it includes one."""
    include = INCLUDE.match(line)
    if not include:
        return None
    return directory / os.path.expandvars(os.path.expanduser(include.group(1).strip()))


def with_included(path: Path, depth: int = 1) -> Iterator[str]:
    """Yield the lines of the INI file that LinuxCNC runs with, included files expanded.

    2.10 reads the INI itself, and follows the includes of included files. 2.9 runs with an expanded
    file, in which a remaining ``#INCLUDE`` is a comment.
    """
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        included = None if path.suffix == EXPANDED else included_file(line, path.parent)
        if not included:
            yield line
        elif depth < DEEPEST_INCLUDE and os.access(included, os.R_OK):
            yield from with_included(included, depth + 1)


def section_extent(lines: Sequence[str], section: str) -> range:
    """Return the indices of a section's lines, without its header."""
    first = 0
    for index, line in enumerate(map(str.lstrip, lines), start=1):
        if first and line.startswith("["):
            return range(first, index - 1)
        if line.startswith(f"[{section}]"):
            first = index
    return range(first, len(lines) if first else 0)


def continued(lines: Sequence[str]) -> Iterator[list[str]]:
    """Yield lines joined with their continuation lines after a backslash."""
    group: list[str] = []
    for line in lines:
        group.append(line)
        if not line.endswith("\\"):
            yield group
            group = []


def entries_of(lines: Sequence[str], section: str) -> Iterator[Entry]:
    """Yield the entries of a section; one without a ``=`` is all key."""
    extent = section_extent(lines, section)
    index = extent.start
    for group in continued(lines[extent.start : extent.stop]):
        key, value = key_and_value("".join([*(line[:-1] for line in group[:-1]), group[-1]]))
        if key:
            yield Entry(index, key, value)
        index += len(group)


def value_in(lines: Sequence[str], section: str, key: str) -> str | None:
    """Return the first value of a key, "" where nothing is behind the ``=``; None without one."""
    return next((entry.value for entry in entries_of(lines, section) if entry.key == key), None)


def key_and_value(line: str) -> tuple[str, str]:
    """Return key and value of a line inside a section; two empty texts for a comment."""
    key, _, value = line.strip().partition("=")
    return ("", "") if key[:1] in "#;" else (key.rstrip(), value.lstrip())


def leading_number(text: str) -> float | None:
    """Return the number that a value begins with, as LinuxCNC reads numbers; None without one."""
    found = LEADING_NUMBER.match(text)
    return float(found[0]) if found else None
