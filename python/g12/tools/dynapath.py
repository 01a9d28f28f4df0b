# SPDX-License-Identifier: GPL-2.0-or-later
"""Dynapath event text to a LinuxCNC program: circle mill events only. Knows text, not motion.

An event is one line: ``N1800(4)G7X1.5Y2.Z-.5W.1O.5R1.5D0C2K.2J.3L.02P5F20V15$``, that is block
number, event type, entries, end mark. A ``/`` after a letter marks an incremental entry. Each
becomes one ``o<circle_mill> call``; W, O and F are modal and carried from event to event. A control
with auxiliary axes W and C writes I for W and H for C.

Rules: every line is empty or an event of type 4; no entry twice, by either of its letters; X, Y,
Z, R, C in every event, W and F in it or an earlier one; only X, Y, Z, L can be incremental; G 0
or 7, D from 0 to 3, C from 0 to 2; L, R, K, J, P, F, V above 0; no value beyond any machine or that
the call would take for an entry left out; no call longer than a block of LinuxCNC can be.
"""

import re
from collections.abc import Iterator, Mapping
from decimal import Decimal
from typing import NamedTuple

from g12.cycles.circle_mill import (
    EVENT_ENTRIES,
    PERIMETER_CYCLE,
    POCKET_CYCLE,
    ROUGH_FINISH_ARCS,
    TOOL_SIDES,
)
from g12.errors import LONGEST_BLOCK, Refusal, number
from g12.lengths import LARGEST
from g12.request import CLOCKWISE, LEFT_OUT

EVENT = re.compile(r"N(?P<number>\d+)\((?P<type>\w+)\)(?P<entries>.*)\$", re.ASCII)
ENTRY = re.compile(
    r"(?P<letter>[A-Z])(?P<incremental>/?)(?P<value>[+-]?(?:\d+\.?\d*|\.\d+))", re.ASCII
)
CIRCLE_MILL = "4"
OTHER_LETTERS = {"I": "W", "H": "C"}  # of a control with auxiliary axes W and C
REQUIRED = "XYZRC"
MODAL = "WOF"
NEEDED = "WF"  # of them, in the first event
INCREMENTAL = "XYZL"
POSITIVE = "LRKJPFV"
ALLOWED_VALUES = {
    "G": (PERIMETER_CYCLE, POCKET_CYCLE),
    "D": range(len(ROUGH_FINISH_ARCS)),
    "C": range(len(TOOL_SIDES[CLOCKWISE])),
}
UNIT_PREFIXES = {"inch": "G20 ", "mm": "G21 ", None: ""}


def program_from_events(text: str, units: str | None = None) -> str:
    """Return the LinuxCNC program of an event text, or raise `Refusal` naming the line.

    ``units`` (``inch``, ``mm``) are those of the text; None: the machine's active ones.
    """
    calls = list(calls_of_events(text))
    if not calls:
        raise Refusal("there is no event in the file")
    return "\n".join([f"{UNIT_PREFIXES[units]}G17 G40 G90 G94", *calls, "M2", ""])


def calls_of_events(text: str) -> Iterator[str]:
    modal: dict[str, WrittenEntry] = {}
    for line, row in enumerate(text.upper().splitlines(), start=1):
        for event in re.findall(r"[^$]*\$|[^$]+", re.sub(r"\s", "", row)):
            try:
                yield call_of_event(event, modal)
            except Refusal as rule:
                raise Refusal(f"line {line}: {rule}") from None


class WrittenEntry(NamedTuple):
    """One entry of an event: letter and number as written, and whether it is incremental."""

    letter: str
    value: Decimal
    incremental: bool


def call_of_event(event: str, modal: dict[str, WrittenEntry]) -> str:
    """Return the call of one event; its modal entries are added to ``modal``."""
    match = EVENT.fullmatch(event)
    if not match:
        raise Refusal(f"{event[:40]} is not an event: N…(4)…$")
    if match["type"] != CIRCLE_MILL:
        raise Refusal(f"event type {match['type']} is not the circle mill event, 4")
    entries = entries_of_event(match["entries"])
    modal.update((letter, entry) for letter, entry in entries.items() if letter in MODAL)
    entries = {**modal, **entries}
    for rule in broken_rules(entries):
        raise Refusal(rule)
    values = " ".join(f"[{argument(letter, entries)}]" for letter in EVENT_ENTRIES)
    call = f"N{match['number']} o<circle_mill> call {values}"
    if len(call) > LONGEST_BLOCK:
        raise Refusal(
            f"the call of the event has {len(call)} characters, the most is {LONGEST_BLOCK}"
        )
    return call


def entries_of_event(text: str) -> dict[str, WrittenEntry]:
    entries: dict[str, WrittenEntry] = {}
    while text:
        match = ENTRY.match(text)
        written = match["letter"] if match else ""
        letter = OTHER_LETTERS.get(written, written)
        if not match or letter not in EVENT_ENTRIES:
            raise Refusal(f"{text[:20]} does not start with an entry")
        first = entries.get(letter)
        if first and first.letter == written:
            raise Refusal(f"{written} stands twice")
        if first:
            raise Refusal(f"{first.letter} and {written} are the same entry: give one of them")
        value, incremental = Decimal(match["value"]), bool(match["incremental"])
        entries[letter] = WrittenEntry(written, value, incremental)
        text = text[match.end() :]
    return entries


def broken_rules(entries: Mapping[str, WrittenEntry]) -> Iterator[str]:
    """Yield the rules that an event's entries break."""
    yield from (f"{letter} is missing" for letter in REQUIRED if letter not in entries)
    missing = (letter for letter in NEEDED if letter not in entries)
    yield from (f"{letter} is missing, and no event before has it" for letter in missing)
    for letter, entry in entries.items():
        yield from broken_by_entry(letter, entry)
        value = float(value_in_call(letter, entries))
        written = f"{entry.letter}{number(value)}"
        if abs(value) > LARGEST:
            yield f"{written} is beyond {number(LARGEST)}"
        if value == LEFT_OUT and not from_the_tool(letter, entry):
            yield f"{written} would be left out: {number(LEFT_OUT)} in the call means no entry"


def broken_by_entry(letter: str, entry: WrittenEntry) -> Iterator[str]:
    """Yield the rules that an entry breaks by itself."""
    value, written = float(entry.value), f"{entry.letter}{number(float(entry.value))}"
    if entry.incremental and letter not in INCREMENTAL:
        yield f"{entry.letter}/ cannot be incremental"
    if letter in ALLOWED_VALUES and entry.value not in ALLOWED_VALUES[letter]:
        yield f"{written} must be one of {', '.join(map(str, ALLOWED_VALUES[letter]))}"
    if letter in POSITIVE and not value > 0:
        yield f"{written} must be greater than 0"


def value_in_call(letter: str, entries: Mapping[str, WrittenEntry]) -> Decimal:
    """Return the value for the call: Z/ from W, L/ below zero."""
    entry = entries[letter]
    if entry.incremental and letter == "Z":
        return entries["W"].value + entry.value
    return -entry.value if entry.incremental and letter == "L" else entry.value


def from_the_tool(letter: str, entry: WrittenEntry) -> bool:
    """Return whether the call has to add the entry to the tool's position."""
    return entry.incremental and letter in "XY"


def argument(letter: str, entries: Mapping[str, WrittenEntry]) -> str:
    if letter not in entries:
        return f"{LEFT_OUT:.0f}"
    value = f"{value_in_call(letter, entries):f}"
    return f"#<_{letter.lower()}> + {value}" if from_the_tool(letter, entries[letter]) else value
