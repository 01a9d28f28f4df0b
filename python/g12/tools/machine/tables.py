# SPDX-License-Identifier: GPL-2.0-or-later
"""Checks of tool tables and var files, those that a command line names and a machine's own.

LinuxCNC reads them itself. It takes any file and any number, and hardly reports what it cannot
read.
"""

import math
import re
from collections.abc import Iterator
from pathlib import Path

from g12.machine_ini import leading_number
from g12.tools.errors import UsageError
from g12.tools.machine.files import existing

TOOL_WORD = re.compile(r"[TPDXYZABCUVWIJQ][-+.\d]")
MEASURE = re.compile(r"[PTDXYZABCUVWIJQ](.+)")
PARAMETER = re.compile(r"\s*(\d{1,9})\s+(\S+)")
NAN = re.compile(r"[-+]?nan", re.IGNORECASE)
NO_ENTRY = re.compile(r"\s*([#;].*)?")  # LinuxCNC ignores lines without two numbers
LAST_PARAMETER = 5601
POSITIONS = range(5161, 5391)  # parameters: of G28 and G30, offsets and rotations
MAX_MEASURE = 1e9  # machine units or degrees; above it a double is coarser than a path's tolerance


def tool_table(path: Path) -> Path:
    """Return the path of a tool table, which may be empty; refuse another file."""
    entries = [words for _, words in _tools(path)]
    if entries and not any(map(_is_tool, entries)):
        raise UsageError(f"{path}: is not a tool table: no line is like T1 P1 D6.0")
    return measured_tools(path)


def measured_tools(path: Path) -> Path:
    """Return the path of a tool table; refuse a number that no tool has."""
    for row, words in _tools(path):
        for word in words:
            measure = MEASURE.fullmatch(word)
            if measure:
                _check(path, row, word, measure[1], MAX_MEASURE)
    return path


def _tools(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that is not empty, without its remark."""
    for row, line in enumerate(_lines(path), start=1):
        words = line.partition(";")[0].upper().split()
        if words:
            yield row, words


def _is_tool(words: list[str]) -> bool:
    return all(map(TOOL_WORD.match, words)) and any(word[0] == "T" for word in words)


def var_file(path: Path) -> Path:
    """Return the path of a var file; refuse a file that LinuxCNC would silently not read as one."""
    rows = [(row, line) for row, line in enumerate(_lines(path), 1) if not NO_ENTRY.fullmatch(line)]
    numbers = []
    for row, line in rows:
        parameter = PARAMETER.match(line)
        if not parameter or _number(parameter[2]) is None:
            break
        numbers.append(int(parameter[1]))
        limit = MAX_MEASURE if numbers[-1] in POSITIONS else math.inf
        _check(path, row, " ".join(line.split()), parameter[2], limit)
    if len(numbers) < len(rows) or numbers != sorted({*numbers} - {0}):
        raise UsageError(f"{path}: is not a var file: lines like 5221 10.0, in ascending order")
    if numbers and numbers[-1] > LAST_PARAMETER:
        raise UsageError(f"{path}: {numbers[-1]}: the last parameter is {LAST_PARAMETER}")
    return path


def _lines(path: Path) -> list[str]:
    return existing(path).read_text(encoding="utf-8", errors="replace").splitlines()


def _number(text: str) -> float | None:
    """Return the number that a text begins with, as C reads it."""
    return math.nan if NAN.match(text) else leading_number(text)


def _check(path: Path, row: int, shown: str, text: str, limit: float) -> None:
    """Refuse a number that is not finite or beyond a limit."""
    value = _number(text)
    if value is not None and not (abs(value) <= limit and abs(value) < math.inf):
        most = f", {limit:g} is the most" if limit < math.inf else ""
        raise UsageError(f"{path}:{row}: {shown:.60}: no number that a machine can have{most}")
