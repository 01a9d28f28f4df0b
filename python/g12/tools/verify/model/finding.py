# SPDX-License-Identifier: GPL-2.0-or-later
"""What is found: a kind with its sentence, a line, values and a place; the verdict over all of it.

Values are mm, mm², mm/min, degrees; a sentence says by what follows a colon how each is written.
"""

import string
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

from g12.tools.units import MM, Unit, counted_as, plain

FINDING, WARNING, NOT_JUDGED = "finding", "warning", "not judged"
SEVERITIES = (FINDING, WARNING, NOT_JUDGED)
MOST_LINES = 10  # that a report names


class Kind(NamedTuple):
    """A kind of finding: its code, how bad it is, its sentence."""

    code: str
    severity: str
    sentence: str


KINDS: dict[str, Kind] = {}  # by code


def kind(code: str, severity: str, sentence: str) -> Kind:
    """Return a new kind, which the table has from then on."""
    KINDS[code] = Kind(code, severity, sentence)
    return KINDS[code]


@dataclass(frozen=True)
class Finding:
    """``place`` is a point of the part in mm, for pictures; ``lines`` are all of one cause.

    ``line`` is in ``file``, "" is the program as LinuxCNC reads it.
    """

    kind: Kind
    line: int
    values: Mapping[str, Any] = field(default_factory=dict)
    place: Sequence[float] | None = None
    file: str = ""
    lines: tuple[int, ...] = ()

    @property
    def code(self) -> str:
        return self.kind.code

    @property
    def severity(self) -> str:
        return self.kind.severity

    def text(self, unit: Unit = MM) -> str:
        return in_words(self.kind.sentence, self.values, unit)


def once_a_line(found: Iterable[Finding]) -> list[Finding]:
    """Return each code of a line once, and what is the same of several lines with all of them."""
    first: dict[tuple[str, str, int], Finding] = {}
    for each in found:
        first.setdefault((each.code, each.file, each.line), each)
    same: dict[tuple[str, str, str], list[Finding]] = {}
    for each in sorted(first.values(), key=lambda each: (each.file, each.line)):
        same.setdefault((each.code, each.file, each.text()), []).append(each)
    return [
        replace(own[0], lines=tuple(line for each in own for line in each.lines or [each.line]))
        for own in same.values()
    ]


def verdict(found: Sequence[Finding]) -> str:
    """Return the last line of a report, which never says that a program is good."""
    counts = ((name, sum(each.severity == name for each in found)) for name in SEVERITIES[:2])
    parts = [counted_as(n, name) for name, n in counts if n or name == FINDING]
    parts[0] = parts[0].replace("0 findings", "no finding")
    unjudged = dict.fromkeys(each.code for each in found if each.severity == NOT_JUDGED)
    return ", ".join(parts) + (f"; not judged: {', '.join(unjudged)}" if unjudged else "")


def lines_in_words(lines: Collection[int]) -> str:
    """Return lines in words, of many the first ones."""
    own = sorted(set(lines))
    more = f" and {len(own) - MOST_LINES} more" if len(own) > MOST_LINES else ""
    return f"line{'s' * (len(own) > 1)} {', '.join(map(str, own[:MOST_LINES]))}{more}"


def in_words(sentence: str, values: Mapping[str, Any], unit: Unit) -> str:
    return _Writer(unit).vformat(sentence, (), values)


def is_known(sentence: str, values: Mapping[str, Any]) -> bool:
    """Return whether there is a value for each of a sentence's braces, and none is None."""
    writer = string.Formatter()
    names = [name for _, name, _, _ in writer.parse(sentence) if name]
    try:
        return all(writer.get_field(name, (), values)[0] is not None for name in names)
    except (LookupError, TypeError):  # no such measure, or None in its place
        return False


class _Writer(string.Formatter):
    """Formats the values of a sentence: what follows the colon says what a value is.

    ``mm`` a length, ``length`` with its unit, ``small`` and ``fine`` the same of a small one,
    ``mm2`` an area, ``feed``, ``xyz`` a place as letters and lengths, ``to`` a second one or none,
    ``list`` lengths, ``twice`` a radius as a diameter, ``holes`` their number, ``turns`` angles,
    ``words`` entries by name. A number is of decimals.
    """

    def __init__(self, unit: Unit) -> None:
        self._forms: dict[str, Callable[[Any], str]] = {
            "mm": unit.text,
            "length": lambda value: f"{unit.text(value)} {unit.name}",
            "small": unit.fine,
            "fine": lambda value: f"{unit.fine(value)} {unit.name}",
            "mm2": unit.area,
            "feed": lambda value: f"{plain(value / unit.mm, 1)} {unit.name}/min",
            "xyz": lambda words: " ".join(
                letter + (at if isinstance(at, str) else unit.text(at)) for letter, at in words
            ),
            "to": lambda words: f" to {self._forms['xyz'](words)}" if words else "",
            "list": lambda value: ", ".join(dict.fromkeys(map(unit.text, value))),
            "holes": lambda count: counted_as(count, "hole"),
            "twice": lambda value: unit.text(2 * value),
            "turns": lambda angles: ", ".join(plain(angle, 3) for angle in angles),
            "words": lambda words: ", ".join(f"{n} {plain(at, 4)}" for n, at in words.items()),
        }

    def format_field(self, value: Any, format_spec: str) -> str:
        if format_spec in self._forms:
            return self._forms[format_spec](value)
        return plain(value, int(format_spec)) if format_spec.isdigit() else str(value)
