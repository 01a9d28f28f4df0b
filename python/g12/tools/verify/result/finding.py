# SPDX-License-Identifier: GPL-2.0-or-later
"""A finding or a note of verify: a code of the table of sentences, a line, values and a place."""

from __future__ import annotations

import string
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from g12.tools.units import MM, Unit, plain
from g12.tools.verify.result.sentences import FINDINGS, NOT_JUDGED, NOTES

SENTENCES = {**FINDINGS, **NOTES, **NOT_JUDGED}


@dataclass(frozen=True)
class Finding:
    """Something that is not as expected, that a user should know, or that was not judged.

    ``code`` names a sentence of ``sentences``, ``values`` are what stands in its braces: mm, mm²,
    mm/min, degrees. ``line`` is that of the program as LinuxCNC reads it, ``file`` the name of a
    sub's own file, "" in the program. ``place`` is where it is, as machine coordinates (X, Y, Z)
    in mm, for pictures and the report.
    """

    code: str
    line: int
    values: Mapping[str, Any] = field(default_factory=dict)
    place: Sequence[float] | None = None
    file: str = ""

    @property
    def is_finding(self) -> bool:
        """Tell whether it is a fault."""
        return self.code in FINDINGS

    @property
    def is_note(self) -> bool:
        """Tell whether it is a note."""
        return self.code in NOTES

    def text(self, unit: Unit = MM) -> str:
        """Return the sentence with sizes in a unit."""
        return _Writer(unit).vformat(SENTENCES[self.code], (), self.values)


class _Writer(string.Formatter):
    """Formats the values of a sentence: what follows the colon says what a value is.

    ``mm`` and ``length`` a length, ``fine`` a small one, ``mm2`` an area, ``feed`` a feed, ``xyz``
    a place (of X, Y and Z, or of other letters, each with its length or with a text), ``place``
    one with its letters, ``list`` several lengths; each with its unit but ``mm`` and ``list``. A
    number stands for decimals.
    """

    def __init__(self, unit: Unit) -> None:
        self._forms: dict[str, Callable[[Any], str]] = {
            "mm": unit.text,
            "length": lambda value: f"{unit.text(value)} {unit.name}",
            "fine": lambda value: f"{unit.fine(value)} {unit.name}",
            "mm2": unit.area,
            "place": lambda words: " ".join(
                letter + (plain(at, 3) if letter == "C" else unit.text(at)) for letter, at in words
            ),
            "feed": lambda value: f"{unit.text(value)} {unit.name}/min",
            "xyz": lambda value: words_of_place(value, unit),
            "list": lambda value: ", ".join(map(unit.text, value)),
            "said": lambda value: value(unit),
        }

    def format_field(self, value: Any, format_spec: str) -> str:
        """Return one value as text."""
        if format_spec in self._forms:
            return self._forms[format_spec](value)
        return plain(value, int(format_spec)) if format_spec.isdigit() else str(value)


def words_of_place(place: Sequence[Any], unit: Unit) -> str:
    """Return a place in words: its letters and values."""
    words = place if isinstance(place[0], tuple) else zip("XYZ", place)
    return " ".join(a + (at if isinstance(at, str) else unit.text(at)) for a, at in words)
