# SPDX-License-Identifier: GPL-2.0-or-later
"""What a machine's INI file says of its units, its axes X, Z and C, and its remapped codes."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import NamedTuple

from g12.errors import Refusal, number
from g12.lengths import MM_PER_INCH
from g12.settings import section_entries

NO_LIMIT = 1e99
AXIS_KEYS = (  # with what LinuxCNC takes where there is none
    ("MIN_LIMIT", -NO_LIMIT),
    ("MAX_LIMIT", NO_LIMIT),
    ("MAX_VELOCITY", 1.0),
    ("MAX_ACCELERATION", 1.0),
)
INCHES = ("in", "inch", "imperial")


class Axis(NamedTuple):
    """One axis in machine units (degrees for C) and seconds: where it may go, and how fast."""

    low: float
    high: float
    velocity: float
    acceleration: float


def millimetres_of(text: str) -> float:
    """Return the length of a machine unit in mm."""
    unit = dict(section_entries(text, "TRAJ")).get("LINEAR_UNITS", "mm").split()[0].lower()
    return MM_PER_INCH if unit in INCHES else 1.0


def coordinates_of(text: str) -> set[str]:
    """Return the letters of the machine's axes."""
    return set(dict(section_entries(text, "TRAJ")).get("COORDINATES", "").upper()) - {" "}


def axes_of(text: str) -> dict[str, Axis]:
    """Return the axes X, Z and C; raise Refusal for a value that no axis can have."""
    return {letter: _axis(f"AXIS_{letter}", text) for letter in "XZC"}


def _axis(section: str, text: str) -> Axis:
    entries = dict(section_entries(text, section))
    low, high, *speeds = (_number(section, entries, *key) for key in AXIS_KEYS)
    for (key, _), speed in zip(AXIS_KEYS[2:], speeds):
        if speed <= 0.0:
            raise Refusal(f"[{section}] {key} = {number(speed)}: must be above 0")
    return Axis(low, high, *speeds)


def _number(section: str, entries: Mapping[str, str], key: str, default: float) -> float:
    words = entries.get(key, "").split() or [f"{default}"]
    try:
        return float(words[0])
    except ValueError:
        raise Refusal(f"[{section}] {key} = {words[0]}: must be a number") from None


def remaps_of(text: str) -> dict[str, dict[str, str]]:
    """Return the REMAP lines: code in upper case, then its options."""
    lines = [value.split() for key, value in section_entries(text, "RS274NGC") if key == "REMAP"]
    return {
        code.upper(): dict(option.split("=", 1) for option in options if "=" in option)
        for code, *options in lines
    }


def refuse_owned_codes(remaps: Container[str], owned: bool) -> None:
    """Refuse a REMAP of G12.1 where the interpreter has that code itself, and ignores the line."""
    codes = [code for code in ("G12.1", "G13.1") if code in remaps]
    if owned and codes:
        raise Refusal(
            f"REMAP = {codes[0]}: this LinuxCNC has a G12.1 of its own (kinematics selection). "
            "Use configs/include/polar_g12_3.inc, and G12.3 and G13.3 in programs"
        )


def owns_g12_1(version: str) -> bool:
    """Tell whether a version of LinuxCNC ("2.9.10") selects kinematics by G12.1."""
    major, minor = (int(part) for part in version.split(".")[:2])
    return (major, minor) >= (2, 10)
