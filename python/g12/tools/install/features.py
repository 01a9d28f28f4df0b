# SPDX-License-Identifier: GPL-2.0-or-later
"""What of the package a machine can have, and REMAP lines as LinuxCNC reads them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from pathlib import Path

from g12.tools.machine.ini import ENTRY

ROOT = Path(__file__).resolve().parents[4]  # the folder that holds ngc, python and configs
INCLUDES = ROOT / "configs" / "include"

FILES = {
    "haas": "g12_haas.inc",
    "yasnac": "g12_yasnac.inc",
    "mitsubishi": "g12_mitsubishi.inc",
    "circle-mill": "circle_mill.inc",
    "polar": "polar.inc",
    "polar-g12.3": "polar_g12_3.inc",
}
ONE_OF = (("haas", "yasnac", "mitsubishi"), ("polar", "polar-g12.3"))
POLAR = ("polar", "polar-g12.3")
MEANING = {
    "haas": "G12/G13 circular pocket, Haas words",
    "yasnac": "G12/G13 circle cutting, Yasnac words",
    "mitsubishi": "G12/G13 circular cutting, Mitsubishi words",
    "circle-mill": "circle mill event, perimeter and pocket",
    "polar": "polar coordinate interpolation on and off",
    "polar-g12.3": "polar coordinate interpolation on and off",
}
SHARED = {"cycle_done"}  # the epilog of every cycle does not tell which one it is
SUBS = {"circle-mill": ("circle_mill",)}  # what a program calls besides the codes

CLOSE = 0.8  # share of letters in common that makes a name a misspelt one
KEYWORDS = ("modalgroup", "argspec", "prolog", "epilog", "ngc", "python")
HANDLERS = ("prolog", "epilog", "python")
CODE = re.compile(r"([A-Za-z])(\d*)(?:\.(\d+))?\Z")


@dataclass(frozen=True)
class Remap:
    """A REMAP line: the code it gives a meaning to, and its keywords."""

    text: str
    code: str
    keywords: Mapping[str, str] = field(hash=False)

    @property
    def number(self) -> tuple[str, int]:
        """The code as LinuxCNC compares it: letter and ten times the number."""
        return code_number(self.code)

    @property
    def handlers(self) -> list[str]:
        """The Python functions the line names."""
        return [self.keywords[word] for word in HANDLERS if word in self.keywords]

    @property
    def own_names(self) -> set[str]:
        """What tells the line from those of other cycles: its subs and functions."""
        names = {self.keywords[word] for word in ("ngc", *HANDLERS) if word in self.keywords}
        return names - SHARED

    def like(self, model: Remap) -> str:
        """Return the line as the package writes it today, with this line's own code."""
        return f"REMAP = {' '.join([self.code, *model.text.split()[1:]])}"


def code_number(code: str) -> tuple[str, int]:
    """Return a code's letter and ten times its number, ("", 0) if it is none."""
    match = CODE.match(code)
    if not match:
        return "", 0
    return match[1].upper(), 10 * int(match[2] or 0) + int(match[3] or 0)


def remap_from_value(value: str) -> Remap:
    """Return the REMAP line of an INI value; keywords may be shortened as LinuxCNC allows."""
    code, *options = value.split("#")[0].split() or [""]
    keywords: dict[str, str] = {}
    for option in options:
        word, _, argument = option.partition("=")
        full = next((key for key in KEYWORDS if key.startswith(word.lower())), word)
        keywords[full] = argument
    return Remap(value, code.upper(), keywords)


@cache
def remaps_of(feature: str) -> tuple[Remap, ...]:
    """Return the REMAP lines of a feature, from its file in configs/include."""
    lines = (INCLUDES / FILES[feature]).read_text(encoding="utf-8").splitlines()
    entries = (ENTRY.match(line) for line in lines)
    return tuple(remap_from_value(entry[2]) for entry in entries if entry and entry[1] == "REMAP")


def model_of(remap: Remap) -> tuple[str, Remap] | None:
    """Return the feature that a REMAP line of a machine belongs to and the package's own line."""
    models = [(feature, model) for feature in FILES for model in remaps_of(feature)]

    def likeness(candidate: tuple[str, Remap]) -> tuple[int, bool]:
        _, model = candidate
        return len(model.own_names & remap.own_names), model.number == remap.number

    best = max(models, key=likeness)
    if likeness(best)[0]:
        return best
    return next((found for found in models if is_misspelt(remap, found[1])), None)


def is_misspelt(remap: Remap, model: Remap) -> bool:
    """Tell whether a REMAP line of the same code names nothing but what a line names, misspelt."""
    names = remap.own_names if remap.number == model.number else ()
    close = [get_close_matches(name, model.own_names, cutoff=CLOSE) for name in names]
    return bool(close) and all(close)


def names_of(feature: str) -> list[str]:
    """Return the NGC subs that a feature's codes and programs call."""
    called = [remap.keywords["ngc"] for remap in remaps_of(feature) if "ngc" in remap.keywords]
    return list(dict.fromkeys([*called, *SUBS.get(feature, ())]))


def handlers_of(feature: str) -> list[str]:
    """Return the Python functions that a feature's codes call."""
    return list(dict.fromkeys(name for remap in remaps_of(feature) for name in remap.handlers))
