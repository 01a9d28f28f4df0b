# SPDX-License-Identifier: GPL-2.0-or-later
"""Machine INI files read the way LinuxCNC reads them.

``#INCLUDE`` lines are expanded as the ``linuxcnc`` script of 2.9 does it: one level deep, relative
to the INI's directory.  A value is looked up in the first section of its name only, as LinuxCNC
2.9 does; 2.10 reads all of them.
"""

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple, Self, TypeVar

from g12.errors import Refusal
from g12.lengths import MM_PER_INCH
from g12.machine_ini import (
    INCLUDE,
    Axis,
    axes_of,
    continued,
    coordinates_of,
    entries_of,
    included_file,
    key_and_value,
    leading_number,
    number_in,
    section_extent,
)
from g12.settings import Settings, settings_from_lines
from g12.tools.errors import UsageError
from g12.tools.machine.files import existing

NS_PER_S = 1e9
MACHINE_SECTION = re.compile(r"\s*\[(EMC|KINS|RS274NGC|TRAJ)\]", re.MULTILINE)
LONGEST_PART = 250
MM_OF_UNIT = {  # with their lengths in mm
    "mm": 1.0,
    "metric": 1.0,
    "in": MM_PER_INCH,
    "inch": MM_PER_INCH,
    "imperial": MM_PER_INCH,
}
LINE = re.compile(r"[^\n]*\n|[^\n]+")

Value = str | int | float | None | Sequence
Overrides = Mapping[str, Mapping[str, Value]]
T = TypeVar("T")


class IniError(ValueError):
    """An INI file that cannot be read as LinuxCNC would read it."""


@dataclass(frozen=True)
class Ini:
    """An expanded INI; ``lines`` are without newlines."""

    path: Path
    lines: tuple[str, ...]

    @property
    def directory(self) -> Path:
        """Directory of the INI file, which relative names in it are relative to."""
        return self.path.parent

    @property
    def text(self) -> str:
        """The expanded file."""
        return "\n".join(self.lines) + "\n"

    @property
    def mm(self) -> float:
        """The length of a machine unit in mm."""
        return self._valid(lambda: millimetres_of(self.get))

    @property
    def axes(self) -> str:
        return coordinates_of(self.get)

    @property
    def axis_limits(self) -> dict[str, Axis]:
        """The limits of each of the machine's axes, in machine units (degrees for A, B, C)."""
        return self._valid(lambda: axes_of(self.get, self.axes))

    @property
    def settings(self) -> Settings:
        return self._valid(lambda: settings_from_lines(self.lines))

    @property
    def servo_period(self) -> float:
        """The servo period in seconds, LinuxCNC's 1 ms without an entry."""
        return self.number("EMCMOT", "SERVO_PERIOD", 1e6) / NS_PER_S

    @property
    def tool_beside(self) -> float:
        """The tool's distance from the X line, mm; 0 where the settings are wrong."""
        try:
            return self.settings.polar_tool_offset * self.mm
        except IniError:
            return 0.0

    @property
    def swaps_pockets(self) -> bool:
        """Whether the tool changer is random: the loaded tool's pocket becomes that of the last."""
        return self.get("EMCIO", "RANDOM_TOOLCHANGER", "0") not in ("0", "")

    def _valid(self, read: Callable[[], T]) -> T:
        try:
            return read()
        except Refusal as refusal:
            raise IniError(f"{self.path}: {refusal}") from None

    def all(self, section: str, key: str) -> list[str]:
        """Return every value of a repeated key, in order."""
        return [entry.value for entry in entries_of(self.lines, section) if entry.key == key]

    def get(self, section: str, key: str, default: str | None = None) -> str | None:
        """Return the value LinuxCNC finds: the first one."""
        return next(iter(self.all(section, key)), default)

    def number(self, section: str, key: str, default: float) -> float:
        """Return the number at the start of a value (``20 # mm`` is 20)."""
        return self._valid(lambda: number_in(self.get, section, key, default))

    def file(self, section: str, key: str) -> Path | None:
        """Return a file name of the INI as an absolute path."""
        name = self.get(section, key)
        return self.directory / os.path.expanduser(name) if name else None

    def replaced(self, overrides: Overrides) -> Self:
        """Return an INI with values replaced or added.

        ``overrides`` maps section to key to value; a list or tuple gives one line of the key per
        item, None removes the key.
        """
        ini = self
        for section, values in overrides.items():
            for key, value in values.items():
                ini = ini._with(section, key, value)
        return ini

    def _with(self, section: str, key: str, value: Value) -> Self:
        body = section_extent(self.lines, section)
        head, tail = self.lines[: body.start], self.lines[body.stop :]
        if not body.start:
            head, tail = (*self.lines, f"[{section}]"), ()
        kept = _without(self.lines[body.start : body.stop], key)
        return replace(self, lines=(*head, *_entries(key, value), *kept, *tail))


class IniLine(NamedTuple):
    """A line of the expanded INI: ``row`` counts from 0 in ``file``, ``text`` has no line end.

    ``host`` is the index of the INI's own line for it: itself or an #INCLUDE.
    """

    file: Path
    row: int
    text: str
    host: int

    @property
    def place(self) -> tuple[Path, int]:
        """Where it is; a file that is included twice has its lines twice."""
        return self.file, self.row

    @property
    def location(self) -> str:
        return f"{self.file.name}:{self.row + 1}"


class IniFiles:
    """An INI file with the files that it includes, line by line; those not readable are left out.

    Bytes that are no UTF-8 are surrogates.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.absolute()
        self.files: dict[Path, list[str]] = {self.path: _lines_in(self.path)}
        for line in self._lines_of(self.path):
            included = included_file(line.text, self.path.parent)
            if included and included.is_file() and os.access(included, os.R_OK):
                self.files[included] = _lines_in(included)

    def _lines_of(self, file: Path, host: int | None = None) -> Iterator[IniLine]:
        for row, text in enumerate(self.files[file]):
            yield IniLine(file, row, text.rstrip("\r\n"), row if host is None else host)

    def lines(self) -> list[IniLine]:
        """Return every line as LinuxCNC reads it, an #INCLUDE before the lines that it includes."""
        lines: list[IniLine] = []
        for line in self._lines_of(self.path):
            lines.append(line)
            included = included_file(line.text, self.path.parent)
            if included in self.files:
                lines += self._lines_of(included, line.row)
        return lines

    def ini(self) -> Ini:
        """Return the expanded INI.

        The #INCLUDE of an included file is a comment, as it is for 2.9: 2.10 would look for that
        file beside a copy of the INI.
        """
        texts = []
        for line in self.lines():
            is_include = INCLUDE.match(line.text)
            if line.file != self.path:
                texts.append(f"# {line.text}" if is_include else line.text)
            elif not is_include:
                texts.append(line.text)
        return Ini(self.path, tuple(texts))


def _lines_in(path: Path) -> list[str]:
    content = path.read_bytes()
    if b"\0" in content:
        raise IniError(f"{path}: holds NUL bytes: it is no text")
    return LINE.findall(content.decode("utf-8", "surrogateescape"))


def read_ini(path: str | os.PathLike) -> Ini:
    """Return the INI file with its includes expanded."""
    try:
        return IniFiles(Path(path)).ini()
    except OSError as error:
        raise IniError(f"{error.filename}: {error.strerror}") from error


def read_machine_ini(path: Path) -> Ini:
    """Return the INI of a machine if it is one."""
    ini = read_ini(existing(path))
    if not MACHINE_SECTION.search(ini.text):
        raise UsageError(f"{path}: is not a machine INI: no section [RS274NGC] or [TRAJ]")
    return ini


def _without(lines: Sequence[str], key: str) -> Iterator[str]:
    """Yield lines but for the entries of a key; a broken line stays broken."""
    for group in continued(lines):
        if key_and_value(group[0])[0] != key:
            yield from group


def _entries(key: str, value: Value) -> list[str]:
    if value is None:
        return []
    values = value if isinstance(value, (list, tuple)) else [value]
    return [part for item in values for part in broken_line(f"{key} = {item}")]


def broken_line(line: str) -> list[str]:
    """Return a line, broken where it is longer than LinuxCNC reads."""
    starts = range(0, len(line), LONGEST_PART)
    *parts, last = (line[start : start + LONGEST_PART] for start in starts)
    return [*(f"{part}\\" for part in parts), last]


def millimetres_of(find: Callable[[str, str], str | None]) -> float:
    """Return the length of a machine unit in mm; LinuxCNC takes a name or units per mm."""
    text = find("TRAJ", "LINEAR_UNITS") or "mm"
    per_mm = leading_number(text)
    length = MM_OF_UNIT.get(text.split()[0].lower(), 0.0) if per_mm is None else per_mm
    if length <= 0.0:
        rule = f"must be {', '.join(MM_OF_UNIT)} or units per mm, a number above 0"
        raise Refusal(f"[TRAJ] LINEAR_UNITS = {text:.40}: {rule}")
    return length if per_mm is None else 1.0 / per_mm
