# SPDX-License-Identifier: GPL-2.0-or-later
"""Machine INI files on disk: the location of lines, and edits that change nothing else.

Bytes that are no UTF-8, line ends and a missing last line end survive. What is written is between
two markers: the first names the words of ``install``, the second has a digest of each line. A line
between them with another digest is the user's.
"""

import hashlib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from g12.errors import LONGEST_BLOCK
from g12.machine_ini import entries_of, key_and_value, section_extent
from g12.tools.errors import UsageError
from g12.tools.machine.files import existing
from g12.tools.machine.ini import IniError, IniFiles, IniLine, broken_line

BEGIN_MARK, END_MARK = MARKS = "# >>> g12 install", "# <<< g12 install"
WAS = "# was: "  # before the user's line that one of ours replaces
CONTINUED = re.compile(r"\\\r?\n?\Z")
DIGITS = 4  # of a digest: a section of ours has 30 lines at most


def belongs(text: str) -> bool:
    """Return whether a line belongs to the section before it; comments may not."""
    return bool(key_and_value(text)[0]) or text.startswith(END_MARK)


def digest_of(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:DIGITS]


def between_marks(words: str, lines: Sequence[str]) -> list[str]:
    """Return a block: lines between the markers, with the words of ``install``."""
    digests = " ".join(digest_of(line.rstrip("\r\n")) for line in lines)
    return [f"{BEGIN_MARK} {words}", *lines, f"{END_MARK} {digests}"]


class IniText(IniFiles):
    """An INI file with the files it includes; edits stay in memory until they are written."""

    def changes(self) -> dict[Path, bytes]:
        """Return the changed files with their content, that with the codes last."""
        codes = {line.file for line in self.section("RS274NGC")}
        files = sorted(self.files, key=lambda file: (file in codes, file == self.path))
        contents = {file: "".join(self.files[file]).encode("utf-8", "surrogateescape")
                    for file in files}  # fmt: skip
        return {file: content for file, content in contents.items() if content != file.read_bytes()}

    def section(self, section: str) -> list[IniLine]:
        """Return the lines LinuxCNC finds in a section, its header first: 2.9 reads one of each."""
        lines = self.lines()
        extent = section_extent([line.text for line in lines], section)
        return list(lines[extent.start - 1 : extent.stop]) if extent.start else []

    def entries(self, section: str, key: str) -> list[tuple[IniLine, str]]:
        """Return the values of a key in the section LinuxCNC reads, with their first lines."""
        lines = self.lines()
        found = entries_of([line.text for line in lines], section)
        return [(lines[entry.row], entry.value) for entry in found if entry.key == key]

    def end_of_section(self, section: str) -> tuple[Path, int] | None:
        """Return file and row after the section's last entry, in the INI itself if possible.

        A section that goes on in an included file ends behind that #INCLUDE, unless another section
        begins in the file: then before it. Where the file has the header, too, it is in the file.
        """
        found = self.section(section)
        last_of = {line.host: line for line in self.lines()}  # of each line of the INI
        last_inside = {line.host: line for line in found}
        for host, line in reversed(last_inside.items()):
            included = line.file != self.path
            if line == last_of[host] and (included or belongs(line.text)):
                return (self.path, self._after(self.path, host))
        for line in reversed(found):
            if belongs(line.text):
                return (line.file, self._after(line.file, line.row))
        return None

    def _after(self, file: Path, index: int) -> int:
        """Index after the line at ``index`` and its continuation lines."""
        lines = self.files[file]
        while CONTINUED.search(lines[index]) and index + 1 < len(lines):
            index += 1
        return index + 1

    def add(self, section: str, lines: Sequence[str], words: str) -> None:
        """Add a block to a section; a new one goes into [RS274NGC]'s file.

        In an included file that is before a header, where it divides no other section. At the end
        of a file without a last line end the block has none either.
        """
        point = self.end_of_section(section)
        if not point:
            lines = [f"[{section}]", *lines]
            point = self.path, len(self.files[self.path])
            if self.end_of_section("RS274NGC")[0] != self.path:
                header = self.section("RS274NGC")[0]
                point = header.file, header.row
        file, row = point
        self._put(file, slice(row, row), between_marks(words, lines))

    def replace(self, section: str, key: str, value: str, words: str) -> None:
        """Replace the first value of a key by a block, in which the user's lines are comments.

        A second line of that key would be read by nobody, but LinuxCNC's check_config refuses it.
        """
        (line, _), *_ = self.entries(section, key)
        extent = slice(line.row, self._after(line.file, line.row))
        users = [WAS + text for text in self.files[line.file][extent]]
        if max(map(len, users)) > LONGEST_BLOCK:
            raise IniError(f"{line.location}: {key} is too long; break it with a backslash")
        ours = broken_line(f"{key} = {value}")
        self._put(line.file, extent, between_marks(words, [*users, *ours]))

    def _put(self, file: Path, extent: slice, texts: Sequence[str]) -> None:
        """Put lines in place of others; a missing last line end remains missing."""
        hosts = {line.host for line in self.lines() if line.file == file}
        if file != self.path and len(hosts) > 1:  # a line of it is one of several sections
            cure = f"write the lines of one of them into {self.path.name} itself"
            raise IniError(f"{file.name}: would have to change, and is included twice: {cure}")
        present = self.files[file]
        end = "\r\n" if present and present[0].endswith("\r\n") else "\n"
        at_end = extent.stop == len(present)
        new = [text if text.endswith("\n") else text + end for text in texts]
        if at_end and present and not present[-1].endswith("\n"):
            present[-1] += end
            new[-1] = texts[-1]
        present[extent] = new

    def blocks(self) -> list[list[IniLine]]:
        """Return the blocks, markers included, of the INI and its included files, each once."""
        lines = list({line.place: line for line in self.lines()}.values())
        marks = [row for row, line in enumerate(lines) if line.text.startswith(MARKS)]
        pairs = zip(marks[::2], [*marks[1::2], *marks[-1:]])
        blocks = [lines[first : last + 1] for first, last in pairs]
        for first, last in ((block[0], block[-1]) for block in blocks):
            if not first.text.startswith(BEGIN_MARK) or not last.text.startswith(END_MARK):
                cure = "put it back, or take out what install wrote there"
                text = f"a marker of install without its other one: {cure}"
                raise IniError(f"{first.location}: {text}")
        return blocks

    def words(self) -> list[str]:
        """Return the words of ``install`` in its blocks, each once."""
        found = (word for block in self.blocks()
                 for word in block[0].text[len(BEGIN_MARK) :].split())  # fmt: skip
        return list(dict.fromkeys(found))

    def take_out(self, shared: Sequence[Path] = ()) -> list[IniLine]:
        """Remove the blocks, but for those in the files ``shared``; return the user's lines there.

        A header of ours stays where the section has other entries by now.
        """
        users: list[IniLine] = []
        removed: list[IniLine] = []
        for first, *lines, last in self.blocks():
            if first.file in shared:
                continue
            digests = set(last.text[len(END_MARK) :].split())
            removed += [first, last]
            for line in lines:
                own = digest_of(line.text) in digests
                (removed if own and not line.text.startswith(WAS) else users).append(line)
        ours = {line.place for line in removed}
        for line in (each for each in removed if each.text.startswith("[")):
            others = [each for each in self.section(line.text[1:-1]) if each.place not in ours]
            if any(key_and_value(each.text)[0] for each in others):
                removed.remove(line)
        for line in (each for each in users if each.text.startswith(WAS)):
            self.files[line.file][line.row] = self.files[line.file][line.row][len(WAS) :]
        for file in {line.file for line in removed}:
            self._remove(file, {line.row for line in removed if line.file == file})
        return [line for line in users if not line.text.startswith(WAS)]

    def _remove(self, file: Path, rows: set[int]) -> None:
        """Remove lines; a missing last line end remains missing."""
        lines = self.files[file]
        kept = [line for row, line in enumerate(lines) if row not in rows]
        if kept and len(lines) - 1 in rows and not lines[-1].endswith("\n"):
            kept[-1] = kept[-1].rstrip("\r\n")
        self.files[file] = kept


def read_config_text(ini: Path) -> IniText:
    """Return the INI of a machine; refuse a file that is none."""
    existing(ini)
    if ini.suffix == ".expanded":
        raise UsageError(f"{ini}: LinuxCNC makes this file anew at every start; name {ini.stem}")
    text = IniText(ini)
    if not text.section("RS274NGC"):
        raise UsageError(f"{ini}: no [RS274NGC] section: this is no machine's INI file")
    return text


def other_inis(text: IniText) -> Iterator[IniText]:
    """Yield the folder's other INIs, without links, with the edits of files that they include."""
    for path in sorted(text.path.parent.glob("*.ini")):
        if path.is_file() and not path.samefile(text.path):
            other = IniText(path)
            other.files |= {file: text.files[file] for file in other.files.keys() & text.files}
            yield other
