# SPDX-License-Identifier: GPL-2.0-or-later
"""A program as LinuxCNC's screens open it: through the [FILTER] that the INI has for its suffix.

LinuxCNC runs bytes that are no UTF-8, in comments, but its preview and its messages are UTF-8: such
a program is read with a ``?`` for each of these bytes.

Line numbers are those of the user's file where the filter marks its lines, ``(line 12)``, as
`translate` does; else those of the filter's output, with a note.
"""

import os
import re
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from g12.tools.errors import ProgramError
from g12.tools.machine.files import as_utf8, utf8_text
from g12.tools.machine.ini import Ini

MARK = re.compile(rb" \(line ([0-9]+)\)\s*$|^\(line ([0-9]+)\) ")
LINE_NUMBER = re.compile(r"[0-9]+")
NAMED_LINES = re.compile(r"\blines? [0-9]+\b(?:(?:, | and | to )[0-9]+\b(?![.°]?[0-9]| mm| in\b))*")
PROGRESS = "FILTER_PROGRESS="
OWN_ERROR = re.compile(r"g12 \w+: ")


@dataclass(frozen=True)
class OpenedProgram:
    """A program: the user's file, the text that LinuxCNC reads, and the user's line numbers.

    ``path`` is the user's file, or a text made of it. Of the first, and where lines are unknown,
    ``lines`` is empty. ``other_case`` is the suffix that has a filter where this one has none.
    """

    source: Path
    path: Path
    lines: tuple[int, ...] = ()
    other_case: str = ""

    @property
    def is_filtered(self) -> bool:
        """Whether LinuxCNC reads another text than the user's file."""
        return self.path != self.source

    @property
    def listed(self) -> Path:
        """The file to which line numbers refer."""
        return self.source if self.lines else self.path

    @property
    def name(self) -> str:
        """The user's file as named before a line number."""
        known = self.lines or not self.is_filtered
        return f"{self.source}{'' if known else ' (filtered)'}"

    @property
    def note(self) -> str:
        """A note on the text or its line numbers, "" if they are the user's."""
        if self.other_case:
            return (
                f"{self.source}: LinuxCNC reads it as it is: the INI's [FILTER] has "
                f"{self.other_case}, not {self.source.suffix[1:]}"
            )
        if self.lines or not self.is_filtered:
            return ""
        return f"{self.source}: lines are those of the program that the INI's [FILTER] makes of it"

    def source_line(self, line: int) -> int:
        """Return the line of the user's file for a line that LinuxCNC reads."""
        return self.lines[line - 1] if 0 < line <= len(self.lines) else line

    def in_source(self, text: str) -> str:
        """Return a text about the program with the user's file name and line numbers."""
        if not self.is_filtered:
            return text

        def renumbered(match: re.Match[str]) -> str:
            return LINE_NUMBER.sub(lambda number: str(self.source_line(int(number[0]))), match[0])

        text = NAMED_LINES.sub(renumbered, text)
        text = re.sub(rf"(?<={re.escape(str(self.path))}):[0-9]+:", renumbered, text)
        return text.replace(str(self.path), self.name)


def filter_for(program: Path, ini: Ini) -> str | None:
    """Return the command of the INI's [FILTER] for a program's suffix, None if there is none.

    As on the screens the suffix is looked up as it is written: NC is not nc.
    """
    suffix = program.suffix[1:]
    return ini.get("FILTER", suffix) if suffix else None


def case_with_filter(program: Path, ini: Ini) -> str:
    """Return a program's suffix in the case that has a filter, "" if none has."""
    suffix = program.suffix[1:]
    cases = {suffix.lower(), suffix.upper()} - {suffix}
    return next((case for case in sorted(cases) if ini.get("FILTER", case)), "")


@contextmanager
def opened_program(program: Path, ini: Ini) -> Iterator[OpenedProgram]:
    """Yield a program as LinuxCNC reads it; an error inside names the user's file and lines."""
    command, source = filter_for(program, ini), program.read_bytes()
    other_case = "" if command else case_with_filter(program, ini)
    content = as_utf8(filtered(program, command, ini) if command else source)
    location = str(program.absolute())
    if content == source and utf8_text(location) == location:
        yield OpenedProgram(program, program, other_case=other_case)
        return
    with tempfile.TemporaryDirectory(prefix="g12-filter-") as folder:
        path = Path(folder, utf8_text(program.name))
        path.write_bytes(content)
        rows = content.splitlines()
        lines = lines_of_source(rows) if command else range(1, len(rows) + 1)
        opened = OpenedProgram(program, path, tuple(lines), other_case)
        try:
            yield opened
        except ProgramError as problem:
            raise ProgramError(opened.in_source(str(problem))) from None


def filtered(program: Path, command: str, ini: Ini) -> bytes:
    """Return a filter's output for a program; it runs as LinuxCNC's screens run it."""
    done = subprocess.run(
        ["sh", "-c", f'{command} "$1"', "[FILTER]", str(program.absolute())],
        cwd=ini.directory,
        env={**os.environ, "INI_FILE_NAME": str(ini.path)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        check=False,
    )
    if done.returncode:
        raise ProgramError(filter_error(done.stderr.decode(errors="replace"), command, program))
    return done.stdout


def filter_error(text: str, command: str, program: Path) -> str:
    """Return the error of a filter of the package, of any other its command and last line."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith(PROGRESS)]
    last = lines[-1].strip() if lines else "without a word"
    own = OWN_ERROR.match(last)
    said = last[own.end() :] if own else f"{program}: the filter {command} failed: {last}"
    return said.replace(str(program.absolute()), str(program))


def lines_of_source(written: Sequence[bytes]) -> tuple[int, ...]:
    """Return the line of the user's file for each line a filter has written, () without marks."""
    marks = [MARK.search(row) for row in written]
    if not any(marks):
        return ()
    found: list[int] = []
    own = 0
    for mark in marks:
        own += not mark
        found.append(int(mark[1] or mark[2]) if mark else own)
    return tuple(found)
