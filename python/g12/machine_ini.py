# SPDX-License-Identifier: GPL-2.0-or-later
"""A machine's INI file: its text as LinuxCNC reads it, and its units, axes and remapped codes.

Of the text, as LinuxCNC 2.9 does, the first section of a name is read, a backslash at a line's end
continues it, and of several lines with one key the first counts. (2.10 reads later sections of the
name too.) ``#INCLUDE`` is a line of its own: see ``with_included``.

The other functions take a ``find`` (section, key: the first value or None) or a ``find_all`` (every
value). Inside LinuxCNC these are its own reader's, in the tools those of `tools.machine.ini`, which
also reads texts that are in no file.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from g12.errors import Refusal, number

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


Find = Callable[[str, str], str | None]
FindAll = Callable[[str, str], Sequence[str]]

AXIS_LETTERS = "XYZABCUVW"
NO_LIMIT = 1e99  # LinuxCNC's default of a travel limit
KINEMATICS_PARAMETER = b"_kins_type"  # a library symbol of interpreters that have G12.1 themselves
TRAVEL_KEYS = ("MIN_LIMIT", -NO_LIMIT), ("MAX_LIMIT", NO_LIMIT)  # with LinuxCNC's defaults
SPEED_KEYS = ("MAX_VELOCITY", 1.0), ("MAX_ACCELERATION", 1.0)
SPINDLE_C_SECONDS, LONGEST_SPINDLE_C = 30.0, 3600.0  # [SPINDLE_C] TIMEOUT
KEYWORDS = ("modalgroup", "argspec", "prolog", "epilog", "ngc", "python")  # in LinuxCNC's order
HANDLERS = ("prolog", "epilog", "python")
M_FILES = tuple(f"M{code}" for code in range(100, 200))  # names of the user's own commands
M_FILES_FOLDER, MOST_M_FOLDERS = "nc_files", 5  # LinuxCNC's default; of USER_M_PATH
CODE_PATTERN = re.compile(r"([A-Za-z])(\d{0,9})(?:\.(\d{1,9}))?\Z")


FACE_KINEMATICS = "polar_xzc"  # configs/kinematics
ACCELERATION_PINS = ("ini.x.max_acceleration", "ini.y.max_acceleration")  # of the face, in HAL


class Axis(NamedTuple):
    """An axis's travel, speed and acceleration, machine units (degrees for A, B, C) and seconds."""

    low: float
    high: float
    velocity: float
    acceleration: float


class FaceAxes(NamedTuple):
    """X and Y of the part's face, the slide that makes them, and the highest feed override."""

    x: Axis
    y: Axis
    slide: Axis
    override: float


@dataclass(frozen=True)
class Remap:
    """A REMAP line: its code and its keywords."""

    text: str
    code: str
    keywords: Mapping[str, str] = field(hash=False)

    @property
    def number(self) -> tuple[str, int]:
        """The code as LinuxCNC compares it: letter and ten times the number."""
        return code_number(self.code)

    @property
    def handlers(self) -> list[str]:
        return [self.keywords[word] for word in HANDLERS if word in self.keywords]


def coordinates_of(find: Find) -> str:
    """Return the letters of the machine's axes, each once."""
    letters = (find("TRAJ", "COORDINATES") or "XYZ").upper()
    return "".join(dict.fromkeys(letter for letter in letters if letter in AXIS_LETTERS))


def axes_of(find: Find, letters: Iterable[str]) -> dict[str, Axis]:
    """Return axes by their letters; raise Refusal for a value that no axis can have.

    With the kinematics of the face the X slide's travel is that of its joint.
    """
    axes = {letter: _axis(f"AXIS_{letter}", find) for letter in letters}
    face = face_of(find)
    if face and "X" in axes:
        axes["X"] = axes["X"]._replace(low=face.slide.low, high=face.slide.high)
    return axes


def face_of(find: Find) -> FaceAxes | None:
    """Return the axes of the part's face, None for a machine without its kinematics."""
    joints = face_joints(find)
    if "X" not in joints:
        return None
    return FaceAxes(
        _axis("AXIS_X", find),
        _axis("AXIS_Y", find),
        _axis(f"JOINT_{joints.index('X')}", find),
        positive_in(find, "DISPLAY", "MAX_FEED_OVERRIDE", 1.0),
    )


def face_joints(find: Find) -> str:
    """Return the letter of each joint of a machine with the kinematics of the face, else ""."""
    module, *parameters = (find("KINS", "KINEMATICS") or "trivkins").split()
    if module != FACE_KINEMATICS:
        return ""
    named = dict(parameter.partition("=")[::2] for parameter in parameters)
    return named.get("coordinates", "XZC").upper()


def _axis(section: str, find: Find) -> Axis:
    speeds = (positive_in(find, section, *key) for key in SPEED_KEYS)
    return Axis(*_range(section, find), *speeds)


def _range(section: str, find: Find) -> tuple[float, float]:
    """Return the lowest and the highest position of an axis or a joint."""
    low, high = (number_in(find, section, *key) for key in TRAVEL_KEYS)
    if low > high:
        least, most = (key for key, _ in TRAVEL_KEYS)
        rule = f"must not be above {most} = {number(high)}"
        raise Refusal(f"[{section}] {least} = {number(low)}: {rule}")
    return low, high


def ranges_of(find: Find, letters: Iterable[str]) -> dict[str, tuple[float, float]]:
    """Return the lowest and the highest position of axes by their letters, in machine units."""
    return {letter: _range(f"AXIS_{letter}", find) for letter in letters}


def number_in(find: Find, section: str, key: str, default: float) -> float:
    """Return the number at the start of a value: ``20 # mm`` is 20."""
    text = find(section, key)
    value = default if text is None else leading_number(text)
    if value is None:
        raise Refusal(f"[{section}] {key} = {text:.40}: must be a number")
    return value


def positive_in(
    find: Find, section: str, key: str, default: float, most: float = math.inf
) -> float:
    """Return the number above 0, and up to ``most``, at the start of a value."""
    value = number_in(find, section, key, default)
    if not 0.0 < value <= most:
        rule = "must be above 0" if math.isinf(most) else f"must be above 0, {number(most)} at most"
        raise Refusal(f"[{section}] {key} = {number(value)}: {rule}")
    return value


def spindle_c_timeout(find: Find) -> float:
    """Return how long the spindle may take to become C, in seconds."""
    return positive_in(find, "SPINDLE_C", "TIMEOUT", SPINDLE_C_SECONDS, LONGEST_SPINDLE_C)


def remap_lines(find_all: FindAll) -> list[Remap]:
    return [remap_from_value(value) for value in find_all("RS274NGC", "REMAP")]


def m_codes_of(find: Find, remaps: Iterable[Remap], directory: Path = Path()) -> frozenset[int]:
    """Return the numbers of the M codes that the machine has besides LinuxCNC's.

    They are those of REMAP lines, and of the executable files that `emcTaskInit` (emctask.cc) finds
    in folders relative to ``directory``.
    """
    numbers = (remap.number for remap in remaps)
    remapped = {tenths // 10 for letter, tenths in numbers if letter == "M"}
    names = (find("RS274NGC", "USER_M_PATH") or "").split(":")[:MOST_M_FOLDERS]
    names.insert(0, find("DISPLAY", "PROGRAM_PREFIX") or M_FILES_FOLDER)
    folders = [directory / os.path.expanduser(name) for name in names if name]
    files = (folder / name for name in M_FILES for folder in folders)
    return frozenset(remapped | {int(file.name[1:]) for file in files if os.access(file, os.X_OK)})


def code_of_prolog(remaps: Iterable[Remap], prolog: str) -> str:
    """Return the code that is remapped with a prolog, "" if none is."""
    return next((remap.code for remap in remaps if remap.keywords.get("prolog") == prolog), "")


def remap_from_value(value: str) -> Remap:
    """Return the REMAP line of an INI value; keywords may be shortened as LinuxCNC allows."""
    code, *options = value.split("#")[0].split() or [""]
    keywords: dict[str, str] = {}
    for option in options:
        word, _, argument = option.partition("=")
        full = next((key for key in KEYWORDS if key.startswith(word.lower())), word)
        keywords[full] = argument
    return Remap(value, code.upper(), keywords)


def code_number(code: str) -> tuple[str, int]:
    """Return a code's letter and ten times its number, ("", 0) if it is none.

    LinuxCNC adds the digits after the point as a whole number: G12.10 is 130, which is G13.
    """
    match = CODE_PATTERN.match(code)
    if not match:
        return "", 0
    return match[1].upper(), 10 * int(match[2] or 0) + int(match[3] or 0)


def refuse_owned_codes(codes: Container[str], owned: bool) -> None:
    """Refuse a REMAP of G12.1 where the interpreter has that code itself and ignores the line."""
    remapped = [code for code in ("G12.1", "G13.1") if code in codes]
    if owned and remapped:
        raise Refusal(
            f"REMAP = {remapped[0]}: this LinuxCNC has a G12.1 of its own (kinematics selection). "
            "Use configs/include/polar_g12_3.inc, and G12.3 and G13.3 in programs"
        )


def owns_g12_1(maps: str) -> bool:
    """Return whether the interpreter loaded in a process has a G12.1 that selects kinematics.

    ``maps`` is the text of the process's /proc/self/maps. The version number does not decide it:
    2.10 was developed for years without that code.
    """
    libraries = {line.split(maxsplit=5)[5] for line in maps.splitlines() if "/librs274" in line}
    return any(KINEMATICS_PARAMETER in Path(library).read_bytes() for library in libraries)
