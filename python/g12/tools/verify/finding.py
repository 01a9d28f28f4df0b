# SPDX-License-Identifier: GPL-2.0-or-later
"""A finding or a note of verify: a code of the table of sentences, a line, values and a place."""

from __future__ import annotations

import string
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from g12.tools.units import MM, Unit, plain
from g12.tools.verify.sentences import FINDINGS, NOTES


@dataclass(frozen=True)
class Finding:
    """Something that is not as expected, or that a user should know (a note).

    ``code`` names a sentence of ``sentences``, ``values`` are what stands in its braces: mm, mm²,
    mm/min, degrees. ``line`` is the user's line, ``file`` the name of a sub's own file. ``place``
    is where it is, as machine coordinates (X, Y, Z) in mm, for pictures and the report.
    """

    code: str
    line: int
    values: Mapping[str, Any] = field(default_factory=dict)
    place: Sequence[float] | None = None
    file: str = ""

    @property
    def is_note(self) -> bool:
        """Tell whether it is a note."""
        return self.code in NOTES

    def text(self, unit: Unit = MM) -> str:
        """Return the sentence, with sizes in a unit."""
        sentence = NOTES[self.code] if self.is_note else FINDINGS[self.code]
        return _InUnit(unit).vformat(sentence, (), self.values)


class _InUnit(string.Formatter):
    """Formats the values of a sentence: what follows the colon says what a value is.

    ``mm`` a length, ``fine`` a small one, ``mm2`` an area, ``feed`` a feed, ``xyz`` a place,
    ``list`` several lengths; each with its unit but ``mm`` and ``list``. A number stands for its
    decimals.
    """

    def __init__(self, unit: Unit) -> None:
        self._unit = unit

    def format_field(self, value: Any, spec: str) -> str:
        """Return one value as text."""
        unit = self._unit
        forms = {
            "mm": lambda: unit.text(value),
            "fine": lambda: f"{unit.fine(value)} {unit.name}",
            "mm2": lambda: unit.area(value),
            "feed": lambda: f"{unit.text(value)} {unit.name}/min",
            "xyz": lambda: " ".join(a + unit.text(at) for a, at in zip("XYZ", value)),
            "list": lambda: ", ".join(map(unit.text, value)),
        }
        if spec in forms:
            return forms[spec]()
        return plain(value, int(spec)) if spec.isdigit() else str(value)
