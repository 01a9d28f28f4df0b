# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of the tool tables and var files that a command line names.

LinuxCNC reads them itself. It takes any file, and hardly reports what it cannot read.
"""

import re
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.machine.files import existing

TOOL_WORD = re.compile(r"[TPDXYZABCUVWIJQ][-+.\d]")
PARAMETER = re.compile(r"\s*(\d+)\s+[-+]?[\d.]")


def tool_table(path: Path) -> Path:
    """Return the path of a tool table, which may be empty; refuse another file."""
    lines = existing(path).read_text(encoding="utf-8", errors="replace").splitlines()
    entries = list(filter(None, (line.partition(";")[0].upper().split() for line in lines)))
    if entries and not any(map(_is_tool, entries)):
        raise UsageError(f"{path}: is not a tool table: no line is like T1 P1 D6.0")
    return path


def _is_tool(words: list[str]) -> bool:
    return all(map(TOOL_WORD.match, words)) and any(word[0] == "T" for word in words)


def var_file(path: Path) -> Path:
    """Return the path of a var file; refuse a file that LinuxCNC would silently not read as one."""
    lines = existing(path).read_text(encoding="utf-8", errors="replace").splitlines()
    found = [PARAMETER.match(line) for line in lines if line.strip()]
    numbers = [int(parameter[1]) if parameter else 0 for parameter in found]
    if 0 in numbers or numbers != sorted(set(numbers)):
        raise UsageError(f"{path}: is not a var file: lines like 5221 10.0, in ascending order")
    return path
