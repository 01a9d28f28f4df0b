# SPDX-License-Identifier: GPL-2.0-or-later
"""A finding or a note of verify: a code of the table of sentences, a line, values and a place."""

import string
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from g12.tools.units import MM, Unit, plain
from g12.tools.verify.result.sentences import FINDINGS, NOT_JUDGED, NOTES

SENTENCES = {**FINDINGS, **NOTES, **NOT_JUDGED}
MOST_LINES = 10  # that a report names of a finding
WHOLE_PROGRAM = 0  # in place of a line


@dataclass(frozen=True)
class Finding:
    """Something that is not as expected, that a user should know, or that was not judged.

    ``code`` names a sentence of ``sentences``, ``values`` are what stands in its braces: mm, mm²,
    mm/min, degrees. ``line`` is that of the program as LinuxCNC reads it, the first one of
    ``values["lines"]`` where it is of several, or ``WHOLE_PROGRAM``; ``file`` the name of a sub's
    own file, "" in the program. ``place`` is where it is, as machine coordinates (X, Y, Z) in mm,
    for pictures and the report.
    """

    code: str
    line: int
    values: Mapping[str, Any] = field(default_factory=dict)
    place: Sequence[float] | None = None
    file: str = ""

    @property
    def is_finding(self) -> bool:
        return self.code in FINDINGS

    @property
    def is_note(self) -> bool:
        return self.code in NOTES

    @property
    def is_not_judged(self) -> bool:
        return self.code in NOT_JUDGED

    @property
    def lines(self) -> Sequence[int]:
        """The lines that it is of, none where it is of the whole program."""
        return self.values.get("lines") or [self.line] * (self.line != WHOLE_PROGRAM)

    def text(self, unit: Unit = MM) -> str:
        return in_words(SENTENCES[self.code], self.values, unit)


def once_a_line(found: Iterable[Finding]) -> Iterator[Finding]:
    """Yield the first finding of each line."""
    lines: dict[int, Finding] = {}
    for each in found:
        lines.setdefault(each.line, each)
    yield from lines.values()


def minus_hint(level: float, zero: float) -> str:
    """Return a hint for a depth above the tool: one below Z0 has its sign."""
    return " (a lost minus sign?)" if level > zero else ""


def _lines_in_words(lines: Collection[int]) -> str:
    """Return lines in words, of many the first ones."""
    own = sorted(set(lines))
    more = f" and {len(own) - MOST_LINES} more" if len(own) > MOST_LINES else ""
    return f"line{'s' * (len(own) > 1)} {', '.join(map(str, own[:MOST_LINES]))}{more}"


def in_words(sentence: str, values: Mapping[str, Any], unit: Unit) -> str:
    """Return a sentence with its values, sizes in a unit."""
    return _Writer(unit).vformat(sentence, (), values)


def is_known(sentence: str, values: Mapping[str, Any]) -> bool:
    """Tell whether there is a value for each of a sentence's braces, and none is None."""
    writer = string.Formatter()
    names = [name for _, name, _, _ in writer.parse(sentence) if name]
    try:
        return all(writer.get_field(name, (), values)[0] is not None for name in names)
    except (LookupError, TypeError):  # no such measure, or None in its place
        return False


class _Writer(string.Formatter):
    """Formats the values of a sentence: what follows the colon says what a value is.

    ``mm`` and ``length`` a length, ``fine`` a small one, ``mm2`` an area, ``feed`` a feed,
    ``feeds`` a least and a greatest, once where they are the same in words, ``xyz``
    a place (of X, Y and Z, or of other letters, each with its length or with a text),
    ``list`` several lengths, ``span`` a least and a greatest, ``pace`` a feed
    that was measured, ``turns`` angles, ``words`` entries by name, ``twice`` a radius as
    a diameter, ``lines`` and ``also`` line numbers; lengths with their unit but ``mm``, ``twice``,
    ``list``. A number is of decimals.
    """

    def __init__(self, unit: Unit) -> None:
        self._forms: dict[str, Callable[[Any], str]] = {
            "mm": unit.text,
            "length": lambda value: f"{unit.text(value)} {unit.name}",
            "fine": lambda value: f"{unit.fine(value)} {unit.name}",
            "mm2": unit.area,
            "feed": lambda value: f"{unit.text(value)} {unit.name}/min",
            "feeds": lambda ends: " to ".join(
                dict.fromkeys(f"{unit.text(feed)} {unit.name}/min" for feed in ends)
            ),
            "xyz": lambda value: _words_of_place(value, unit),
            "twice": lambda value: unit.text(2 * value),
            "turns": lambda angles: ", ".join(plain(angle, 3) for angle in angles),
            "words": lambda words: ", ".join(
                f"{name} {plain(at, 4)}" for name, at in words.items()
            ),
            "lines": _lines_in_words,
            "also": lambda lines: f" (also in {_lines_in_words(lines)})" if lines else "",
            "list": lambda value: ", ".join(map(unit.text, value)),
            "span": lambda ends: f"{unit.text(ends[0])} to {unit.text(ends[1])} {unit.name}",
            "pace": lambda value: f"{plain(value / unit.mm, 1)} {unit.name}/min",
        }

    def format_field(self, value: Any, format_spec: str) -> str:
        if format_spec in self._forms:
            return self._forms[format_spec](value)
        return plain(value, int(format_spec)) if format_spec.isdigit() else str(value)


def _words_of_place(place: Sequence[Any], unit: Unit) -> str:
    words = place if isinstance(place[0], Sequence) else zip("XYZ", place)
    return " ".join(a + (at if isinstance(at, str) else unit.text(at)) for a, at in words)
