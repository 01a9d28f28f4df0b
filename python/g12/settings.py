# SPDX-License-Identifier: GPL-2.0-or-later
"""Section ``[G12]`` of the INI file: one table of key, default and legal values.

Read once, when the handlers load. An unknown key or an illegal value is a start-up error, so that
no machine runs with the default of a misspelt setting.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from g12.errors import Refusal, number
from g12.ini_sections import entries_of, with_included
from g12.lengths import is_inch

INI_SECTION = "G12"
M_CODE = re.compile(r"M\d{1,3}")
TOLERANCE_MM, TOLERANCE_INCH = 0.005, 0.0002  # defaults of POLAR_TOLERANCE


@dataclass(frozen=True)
class Choice:
    """A setting that is one of a few words."""

    words: tuple[str, ...]

    def read(self, text: str) -> str:
        """Return the word in lower case, or raise ValueError."""
        if text.lower() not in self.words:
            raise ValueError(text)
        return text.lower()

    @property
    def legal(self) -> str:
        """The legal values, for the start-up error."""
        return " or ".join(self.words)


@dataclass(frozen=True)
class Number:
    """A setting that is a finite number, from ``least`` on (-inf: any); without one, above zero.

    ``most`` is the greatest that is legal, if there is one.
    """

    least: float | None = None
    most: float = math.inf

    def read(self, text: str) -> float:
        """Return the number, or raise ValueError."""
        value = float(text.replace("_", " "))  # Python alone would take 1_0 for 10
        enough = value > 0 if self.least is None else value >= self.least
        if not (enough and math.isfinite(value) and value <= self.most):
            raise ValueError(text)
        return value

    @property
    def legal(self) -> str:
        """The legal values, for the start-up error."""
        if self.least == -math.inf:
            return "a number"
        above = "a number above 0" if self.least is None else f"a number from {number(self.least)}"
        return above if math.isinf(self.most) else f"{above}, {number(self.most)} at most"


@dataclass(frozen=True)
class MachineCodes:
    """A setting of some M codes, as many as its ``example`` has; none by default."""

    example: str

    @property
    def legal(self) -> str:
        """The legal values, for the start-up error."""
        return f"{'two M codes' if ' ' in self.example else 'an M code'} such as {self.example}"

    def read(self, text: str) -> tuple[int, ...]:
        """Return the numbers of the codes, or raise ValueError."""
        words = text.upper().split()
        known = all(M_CODE.fullmatch(word) for word in words)
        if not known or len(words) != len(self.example.split()):
            raise ValueError(text)
        return tuple(int(word[1:]) for word in words)


TABLE: dict[str, Choice | Number | MachineCodes] = {
    "CLEARING": Choice(("rings", "spiral")),
    "ENTRY": Choice(("plunge", "helix")),
    "ENTRY_ANGLE": Number(most=45.0),
    "PLUNGE_FEED": Number(most=100.0),
    "YASNAC_TRAVERSE": Number(least=0.0),
    "POLAR_X": Choice(("inherit", "diameter", "radius")),
    "POLAR_Z": Choice(("refuse", "allow")),
    "POLAR_G0": Choice(("refuse", "feed")),
    "POLAR_G0_FEED": Number(),
    "POLAR_TOLERANCE": Number(least=0.00001),  # below the resolution of any machine
    "POLAR_POLE": Choice(("rotate", "refuse")),
    "POLAR_KINEMATICS": Choice(("0", "1")),
    "POLAR_SWITCH_TIME": Number(most=3600.0),
    "POLAR_TOOL_OFFSET": Number(least=-math.inf),
    "CYLINDER_WORD": Choice(("radius", "diameter")),
    "CYLINDER_X": Choice(("refuse", "allow")),
    "C_CLAMP": MachineCodes("M10 M11"),
    "C_CLAMP_SHAPES": MachineCodes("M12"),
    "LIVE_SPINDLE": Choice(tuple("01234567")),
}


@dataclass(frozen=True)
class Settings:
    """The settings of section ``[G12]``.

    Lengths and feeds are in machine units (per minute), ``entry_angle`` in degrees,
    ``plunge_feed`` in per cent of F, ``polar_switch_time`` in seconds. ``None`` means that the
    default depends on the machine: a tolerance of 0.005 mm or 0.0002 in.
    """

    clearing: str = "rings"
    entry: str = "plunge"
    entry_angle: float = 3.0
    plunge_feed: float = 100.0
    yasnac_traverse: float = 0.0
    polar_x: str = "inherit"
    polar_z: str = "refuse"
    polar_g0: str = "refuse"
    polar_g0_feed: float | None = None
    polar_tolerance: float | None = None
    polar_pole: str = "rotate"
    polar_kinematics: str = "0"
    polar_switch_time: float = 10.0
    polar_tool_offset: float = 0.0
    cylinder_word: str = "radius"
    cylinder_x: str = "refuse"
    c_clamp: tuple[int, ...] = ()
    c_clamp_shapes: tuple[int, ...] = ()
    live_spindle: str = ""

    def tolerance(self, millimetres: float) -> float:
        """Return POLAR_TOLERANCE in machine units, which are ``millimetres`` long."""
        usual = TOLERANCE_INCH if is_inch(millimetres) else TOLERANCE_MM / millimetres
        return self.polar_tolerance or usual


def settings_from_lines(lines: Sequence[str]) -> Settings:
    """Return the settings of an INI file's lines; raise `Refusal` on a bad key or value."""
    values: dict[str, Any] = {}
    for _, key, text in entries_of(lines, INI_SECTION):
        if key not in TABLE:
            (nearest,) = get_close_matches(key.upper(), TABLE, 1, 0.0)
            raise Refusal(f"[{INI_SECTION}] {key:.40} is not a setting; the nearest is {nearest}")
        if key.lower() in values:
            raise Refusal(f"[{INI_SECTION}] {key} occurs twice")
        try:
            values[key.lower()] = TABLE[key].read(text)
        except ValueError:
            rule = f"must be {TABLE[key].legal}"
            raise Refusal(f"[{INI_SECTION}] {key} = {text:.40}: {rule}") from None
    settings = Settings(**values)
    if settings.polar_g0 == "feed" and settings.polar_g0_feed is None:
        raise Refusal(f"[{INI_SECTION}] POLAR_G0 = feed needs POLAR_G0_FEED, a number above 0")
    return settings


def settings_from_ini(path: str | os.PathLike[str] | None) -> Settings:
    """Return the settings of an INI file; the defaults if there is no file."""
    if not path:
        return Settings()
    lines = list(with_included(Path(path)))
    check_section(lines)
    return settings_from_lines(lines)


def check_section(lines: Sequence[str]) -> None:
    """Refuse a section that LinuxCNC would not read: one in other letters, or a second one."""
    headers = [line for line in map(str.strip, lines) if line.startswith("[")]
    names = [line.split("]")[0][1:] for line in headers]
    found = [name for name in names if name.strip().upper() == INI_SECTION]
    if any(name != INI_SECTION for name in found):
        raise Refusal(f"[{min(set(found) - {INI_SECTION})}] must be written [{INI_SECTION}]")
    if len(found) > 1:
        raise Refusal(f"[{INI_SECTION}] occurs twice: LinuxCNC reads the first one only")
