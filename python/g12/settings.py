# SPDX-License-Identifier: GPL-2.0-or-later
"""Section ``[G12]`` of the INI file: one table of key, default and legal values.

Read once, when the handlers load. An unknown key or an illegal value is a start-up error, so that
no machine runs with the default of a misspelt setting.
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Container, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, NamedTuple

from g12.errors import Refusal, number
from g12.lengths import is_inch
from g12.machine_ini import entries_of, with_included

INI_SECTION = "G12"
CLAMP_CODES = range(3, 10)  # of LinuxCNC's own M codes, those that may serve a clamp
MOST_FEED = 1e9  # program units per minute: a block of LinuxCNC can have its digits
M_CODE = re.compile(r"M\d{1,3}")
TOLERANCE_MM, TOLERANCE_INCH = 0.005, 0.0002  # defaults of POLAR_TOLERANCE


class ValueRule(NamedTuple):
    """The legal values of a setting, as a text, and what reads one or raises ValueError."""

    legal: str
    read: Callable[[str], Any]


def words(*known: str) -> ValueRule:
    """Return the rule of one of a few words, without regard to case."""
    return ValueRule(" or ".join(known), lambda text: known[known.index(text.lower())])


FLAG = ValueRule("0 or 1", lambda text: bool(("0", "1").index(text)))


def number_rule(least: float | None = None, most: float = math.inf) -> ValueRule:
    """Return the rule of a finite number up to ``most``, from ``least`` on (None: above zero)."""

    def read(text: str) -> float:
        value = float(text.replace("_", " "))  # Python alone would take 1_0 for 10
        enough = value > 0 if least is None else value >= least
        if not (enough and math.isfinite(value) and value <= most):
            raise ValueError(text)
        return value

    legal = "a number above 0" if least is None else f"a number from {number(least)}"
    if least == -math.inf:
        legal = "a number"
    return ValueRule(legal if math.isinf(most) else f"{legal}, {number(most)} at most", read)


def m_codes(example: str) -> ValueRule:
    """Return the rule of as many M codes as the example has; they are read as their numbers."""

    def read(text: str) -> tuple[int, ...]:
        codes = text.upper().split()
        if len(codes) != len(example.split()) or not all(map(M_CODE.fullmatch, codes)):
            raise ValueError(text)
        return tuple(int(code[1:]) for code in codes)

    return ValueRule(f"{'two M codes' if ' ' in example else 'an M code'} such as {example}", read)


def setting(default: Any, rule: ValueRule) -> Any:
    return field(default=default, metadata={"rule": rule})


@dataclass(frozen=True)
class Settings:
    """The settings of section ``[G12]``; their keys there are in capitals.

    Lengths and feeds are in machine units (per minute), ``entry_angle`` in degrees,
    ``plunge_feed`` in per cent of F, ``polar_switch_time`` in seconds. ``None`` means that the
    default depends on the machine: a tolerance of 0.005 mm or 0.0002 in.
    """

    clearing: str = setting("rings", words("rings", "spiral"))
    entry: str = setting("plunge", words("plunge", "helix"))
    entry_angle: float = setting(3.0, number_rule(most=45.0))
    plunge_feed: float = setting(100.0, number_rule(most=100.0))
    yasnac_traverse: float = setting(0.0, number_rule(least=0.0, most=MOST_FEED))
    polar_x: str = setting("inherit", words("inherit", "diameter", "radius"))
    polar_z: str = setting("refuse", words("refuse", "allow"))
    polar_g0: str = setting("refuse", words("refuse", "feed"))
    polar_g0_feed: float | None = setting(None, number_rule(most=MOST_FEED))
    # From 0.00001 on: that is below the resolution of any machine.
    polar_tolerance: float | None = setting(None, number_rule(least=0.00001))
    polar_pole: str = setting("rotate", words("rotate", "refuse"))
    polar_kinematics: bool = setting(False, FLAG)
    polar_switch_time: float = setting(10.0, number_rule(most=3600.0))
    polar_tool_offset: float = setting(0.0, number_rule(least=-math.inf))
    cylinder_word: str = setting("radius", words("radius", "diameter"))
    cylinder_x: str = setting("refuse", words("refuse", "allow"))
    rotary_sense: str = setting("standard", words("standard", "reversed"))
    rotary_drag: tuple[int, ...] = setting((), m_codes("M12 M11"))
    c_clamp: tuple[int, ...] = setting((), m_codes("M10 M11"))
    c_clamp_shapes: tuple[int, ...] = setting((), m_codes("M12"))
    on_abort_command: str = setting("", ValueRule("a block", str))

    def tolerance(self, millimetres: float) -> float:
        """Return POLAR_TOLERANCE in machine units, which are ``millimetres`` long."""
        usual = TOLERANCE_INCH if is_inch(millimetres) else TOLERANCE_MM / millimetres
        return self.polar_tolerance or usual

    def drag(self, turn: str) -> tuple[int, ...]:
        """Return the codes that begin and end the drag of a rotary axis in a section, if any."""
        if turn != "C":
            return self.rotary_drag
        return (*self.c_clamp_shapes, self.c_clamp[1]) if self.c_clamp_shapes else ()

    @property
    def opening_codes(self) -> tuple[int, ...]:
        """The codes that open the clamps, for an abort."""
        return self.c_clamp[1:] + self.rotary_drag[1:]

    def unknown_clamp_code(self, m_codes: Container[int]) -> str:
        """Return which code of the clamp the machine does not know, "" if it knows all of them.

        ``m_codes`` are those that it has besides LinuxCNC's.
        """
        for key in ("c_clamp", "c_clamp_shapes", "rotary_drag"):
            for code in getattr(self, key):
                if code not in m_codes and code not in CLAMP_CODES:
                    cure = "a REMAP line" if code < 100 else f"an executable file M{code}"
                    where = f"[{INI_SECTION}] {key.upper()}"
                    return f"{where}: M{code} is no code of this machine: {cure}?"
        return ""


# Keys that the handlers do not read: those of the tools, and that of `toplevel.py`.
LIVE_SPINDLE, LIVE_TOOL, TOPLEVEL = "LIVE_SPINDLE", "LIVE_TOOL", "TOPLEVEL"
OF_OTHERS = {
    LIVE_SPINDLE: words(*"01234567"),
    LIVE_TOOL: m_codes("M33 M35"),
    TOPLEVEL: ValueRule("a file", str),
}
TABLE: dict[str, ValueRule] = {
    each.name.upper(): each.metadata["rule"] for each in fields(Settings)
} | OF_OTHERS


def settings_from_lines(lines: Sequence[str]) -> Settings:
    """Return the settings of an INI file's lines; raise `Refusal` on a bad key or value."""
    values: dict[str, Any] = {}
    for _, key, text in entries_of(lines, INI_SECTION):
        if key not in TABLE:
            from difflib import get_close_matches  # not needed at LinuxCNC's start

            (nearest,) = get_close_matches(key.upper(), TABLE, 1, 0.0)
            raise Refusal(f"[{INI_SECTION}] {key:.40} is not a setting; the nearest is {nearest}")
        if key.lower() in values:
            raise Refusal(f"[{INI_SECTION}] {key} occurs twice")
        try:
            values[key.lower()] = TABLE[key].read(text)
        except ValueError:
            rule = f"must be {TABLE[key].legal}"
            raise Refusal(f"[{INI_SECTION}] {key} = {text:.40}: {rule}") from None
    read = {key: value for key, value in values.items() if key.upper() not in OF_OTHERS}
    settings = Settings(**read)
    if settings.polar_g0 == "feed" and settings.polar_g0_feed is None:
        raise Refusal(f"[{INI_SECTION}] POLAR_G0 = feed needs POLAR_G0_FEED, a number above 0")
    if settings.c_clamp_shapes and not settings.c_clamp:
        needed = "needs C_CLAMP, whose second code opens the clamp"
        raise Refusal(f"[{INI_SECTION}] C_CLAMP_SHAPES {needed}")
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
