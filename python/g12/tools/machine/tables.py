# SPDX-License-Identifier: GPL-2.0-or-later
"""Tool tables and var files that are named on a command line: whether they are such files.

LinuxCNC, which alone reads them, takes any file, and says little of what it cannot read.
"""

import re
from pathlib import Path

from g12.tools.errors import UsageError
from g12.tools.machine.files import existing

TOOL_WORD = re.compile(r"[TPDXYZABCUVWIJQ][-+.\d]")
PARAMETER = re.compile(r"\s*(\d+)\s+[-+]?[\d.]")


def tool_table(path: Path) -> Path:
    """Return the path of a tool table if it is one; an empty one is."""
    lines = existing(path).read_text(encoding="utf-8", errors="replace").splitlines()
    entries = list(filter(None, (line.partition(";")[0].upper().split() for line in lines)))
    if entries and not any(map(_is_tool, entries)):
        raise UsageError(f"{path}: is not a tool table: no line is like T1 P1 D6.0")
    return path


def _is_tool(words: list[str]) -> bool:
    return all(map(TOOL_WORD.match, words)) and any(word[0] == "T" for word in words)


def var_file(path: Path) -> Path:
    """Return the path of a var file if LinuxCNC, which says nothing of one, reads it as one."""
    lines = existing(path).read_text(encoding="utf-8", errors="replace").splitlines()
    found = [PARAMETER.match(line) for line in lines if line.strip()]
    numbers = [int(parameter[1]) if parameter else 0 for parameter in found]
    if 0 in numbers or numbers != sorted(set(numbers)):
        raise UsageError(f"{path}: is not a var file: lines like 5221 10.0, in ascending order")
    return path
