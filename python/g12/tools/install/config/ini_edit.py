# SPDX-License-Identifier: GPL-2.0-or-later
"""Machine INI files on disk: the location of lines, and edits that change nothing else.

Bytes that are no UTF-8, line ends and a missing last line end survive. Insertions are enclosed in
two marker comments, by which they are found and removed again.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from g12.machine_ini import entries_of, included_file, key_and_value, section_extent
from g12.tools.machine.ini import Ini, IniError, as_included

BEGIN_MARK = "# >>> g12 install"
END_MARK = "# <<< g12 install"
WAS = "# was: "
NOW = "# now: "  # the inserted text, several separated by NEXT, to detect later edits
NEXT = "; "
LINE = re.compile(r"[^\n]*\n|[^\n]+")
CONTINUED = re.compile(r"\\\r?\n?\Z")


class IniLine(NamedTuple):
    """A line of the expanded INI: ``row`` counts from 0 in ``file``, ``text`` has no line end.

    ``host`` is the index of the INI's own line for it: itself or an #INCLUDE.
    """

    file: Path
    row: int
    text: str
    host: int

    @property
    def location(self) -> str:
        return f"{self.file.name}:{self.row + 1}"


class InsertionPoint(NamedTuple):
    """A gap between lines: before line ``row`` of ``file``."""

    file: Path
    row: int


def lines_with_ends(path: Path) -> list[str]:
    """Return a text file's lines with their line ends, exactly as they are."""
    return LINE.findall(path.read_bytes().decode("utf-8", "surrogateescape"))


def to_bytes(lines: Sequence[str]) -> bytes:
    """Return the file that `lines_with_ends` read the lines from."""
    return "".join(lines).encode("utf-8", "surrogateescape")


def line_end(lines: Sequence[str]) -> str:
    return "\r\n" if lines and lines[0].endswith("\r\n") else "\n"


def belongs(text: str) -> bool:
    """Return whether a line belongs to the section before it; comments may not."""
    return bool(key_and_value(text)[0]) or text.startswith(END_MARK)


def without(lines: Sequence[str], removed: set[int]) -> list[str]:
    """Return lines without those at the indices; a missing last line end remains missing."""
    kept = [line for index, line in enumerate(lines) if index not in removed]
    unended = lines and not lines[-1].endswith("\n") and len(lines) - 1 in removed
    return [*kept[:-1], kept[-1].rstrip("\r\n")] if unended and kept else kept


class IniText:
    """An INI file with the files it includes; edits stay in memory until they are written."""

    def __init__(self, path: Path) -> None:
        self.path = path.absolute()
        self.files: dict[Path, list[str]] = {self.path: self._read(self.path)}
        self.unreadable: list[IniLine] = []
        self._lines: list[IniLine] = []
        self._files_of_lines: dict[Path, list[str]] = {}
        for line in self._lines_of(self.path):
            included = included_file(line.text, self.path.parent)
            if included and included.is_file():
                self.files[included] = self._read(included)
            elif included or line.text.split() == ["#INCLUDE"]:
                self.unreadable.append(line)

    def _read(self, path: Path) -> list[str]:
        try:
            return lines_with_ends(path)
        except OSError as error:
            raise IniError(f"{path}: {error.strerror}") from error

    def _lines_of(self, file: Path, host: int | None = None) -> Iterator[IniLine]:
        for row, text in enumerate(self.files[file]):
            yield IniLine(file, row, text.rstrip("\r\n"), row if host is None else host)

    def lines(self) -> Sequence[IniLine]:
        """Return every line as LinuxCNC reads it, an #INCLUDE before the lines that it includes.

        They are cached until an edit: `install` reads them some hundred times.
        """
        if self._files_of_lines != self.files:
            self._lines = list(self._expanded())
            self._files_of_lines = {file: list(lines) for file, lines in self.files.items()}
        return self._lines

    def _expanded(self) -> Iterator[IniLine]:
        for line in self._lines_of(self.path):
            yield line
            included = included_file(line.text, self.path.parent)
            if included in self.files:
                yield from self._lines_of(included, line.row)

    def ini(self) -> Ini:
        """Return the expanded INI, edits included, as `read_ini` returns it."""
        folder = self.path.parent
        kept = [line for line in self.lines() if included_file(line.text, folder) not in self.files]
        texts = (line.text if line.file == self.path else as_included(line.text) for line in kept)
        return Ini(self.path, tuple(texts))

    def contents(self) -> dict[Path, bytes]:
        """Return the content of each file, that with the codes last: it needs the others."""
        codes = {line.file for line in self.section("RS274NGC")}
        files = sorted(self.files, key=lambda file: (file in codes, file == self.path))
        return {file: to_bytes(self.files[file]) for file in files}

    def headers(self, section: str) -> list[IniLine]:
        """Return every header of that section; LinuxCNC 2.9 reads the first one's lines only."""
        return [line for line in self.lines() if line.text.lstrip().startswith(f"[{section}]")]

    def section(self, section: str) -> list[IniLine]:
        """Return the lines LinuxCNC finds in a section, its header first."""
        lines = self.lines()
        extent = section_extent([line.text for line in lines], section)
        return list(lines[extent.start - 1 : extent.stop]) if extent.start else []

    def entries(self, section: str, key: str) -> list[tuple[IniLine, str]]:
        """Return the values of a key in the section LinuxCNC reads, with their first lines."""
        lines = self.lines()
        found = entries_of([line.text for line in lines], section)
        return [(lines[entry.row], entry.value) for entry in found if entry.key == key]

    def end_of_section(self, section: str) -> InsertionPoint | None:
        """Return the point after the section's last entry, in the INI itself if possible.

        For RS274NGC that is before the empty line here::

            [RS274NGC]
            PARAMETER_FILE = mill.var
            #INCLUDE remaps.inc

            # Axes.
            [TRAJ]

        unless remaps.inc ends in another section: then it is before the #INCLUDE. Where another
        file has the header, too, it is in that file.
        """
        found = self.section(section)
        last_of = {line.host: line for line in self.lines()}  # of each line of the INI
        last_inside = {line.host: line for line in found}
        for host, line in reversed(last_inside.items()):
            included = line.file != self.path
            if line == last_of[host] and (included or belongs(line.text)):
                return InsertionPoint(self.path, self._after(self.path, host))
        for line in reversed(found):
            if belongs(line.text):
                return InsertionPoint(line.file, self._after(line.file, line.row))
        return None

    def _after(self, file: Path, index: int) -> int:
        """Index after the line at ``index`` and its continuation lines."""
        lines = self.files[file]
        while CONTINUED.search(lines[index]) and index + 1 < len(lines):
            index += 1
        return index + 1

    def insert(self, point: InsertionPoint, texts: Sequence[str]) -> None:
        """Insert lines. At the end of a file without a last line end they have none either."""
        lines = self.files[point.file]
        end = line_end(lines)
        new = [text + end for text in texts]
        if point.row == len(lines) and lines and not lines[-1].endswith("\n"):
            lines[-1] += end
            new[-1] = texts[-1]
        lines[point.row : point.row] = new

    def put_in_place(self, line: IniLine, text: str, begin: str) -> None:
        """Insert an entry between markers instead of a line, which becomes a comment."""
        if CONTINUED.search(self.files[line.file][line.row]):
            raise IniError(f"{line.location}: goes on in the next line; write it in one line")
        self.insert(InsertionPoint(line.file, line.row + 1), [NOW + text, text, END_MARK])
        self.replace(line, WAS + line.text)
        self.insert(InsertionPoint(line.file, line.row), [begin])

    def replace(self, line: IniLine, text: str) -> None:
        """Replace the text of a line, but not its line end."""
        lines = self.files[line.file]
        lines[line.row] = text + lines[line.row][len(line.text) :]

    def append_to_value(self, line: IniLine, text: str) -> None:
        index = self._after(line.file, line.row) - 1
        lines = self.files[line.file]
        body = lines[index].rstrip()
        lines[index] = body + text + lines[index][len(body) :]

    def remove_from_value(self, line: IniLine, entry: str) -> None:
        """Remove an entry from the list, separated by colons, that begins at ``line``."""
        lines = self.files[line.file]
        lines[line.row] = re.sub(rf"(=\s*){re.escape(entry)}:", r"\1", lines[line.row], count=1)
        for index in range(line.row, self._after(line.file, line.row)):
            lines[index] = re.sub(rf":{re.escape(entry)}(?=[:\s]|$)", "", lines[index])

    def blocks(self) -> list[list[IniLine]]:
        """Return the marked blocks, markers included, of the INI and its included files."""
        blocks: list[list[IniLine]] = []
        block: list[IniLine] = []
        for line in self.lines():
            begins, ends = map(line.text.startswith, (BEGIN_MARK, END_MARK))
            if begins and block:
                break
            if ends and not block:
                raise IniError(
                    f'{line.location}: the line "{BEGIN_MARK}" that begins this is missing: '
                    "put it in front of the first line that install wrote"
                )
            if begins or block:
                block.append(line)
            if ends:
                blocks.append(block)
                block = []
        if block:
            raise IniError(
                f'{block[0].location}: the line "{END_MARK}" that ends this is missing: '
                "put it after the last line that install wrote there"
            )
        return blocks

    def remove(self, removed: Sequence[IniLine]) -> None:
        for file in {line.file for line in removed}:
            indices = {line.row for line in removed if line.file == file}
            self.files[file] = without(self.files[file], indices)


def other_inis(text: IniText) -> Iterator[IniText]:
    """Yield the folder's other INIs, without links, with the edits of files that they include."""
    for path in sorted(text.path.parent.glob("*.ini")):
        if path.is_file() and not path.samefile(text.path):
            other = IniText(path)
            other.files |= {file: text.files[file] for file in other.files.keys() & text.files}
            yield other
