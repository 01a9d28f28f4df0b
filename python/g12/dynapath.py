# SPDX-License-Identifier: GPL-2.0-or-later
"""Dynapath event text to a LinuxCNC program: circle mill events only. Knows text, not motion.

An event is one line: ``N1800(4)G7X1.5Y2.Z-.5W.1O.5R1.5D0C2K.2J.3L.02P5F20V15$``, that is block
number, event type, entries, end mark. A ``/`` behind a letter marks an incremental entry. Each
becomes one ``o<circle_mill> call``; W and F are modal and carried from event to event.

Rules: every line is empty or an event of type 4; no entry twice; X, Y, Z, R, C in every event,
W and F in it or an earlier one; only X, Y, Z, L can be incremental.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from decimal import Decimal

from .circle_mill import ENTRIES, LEFT_OUT
from .errors import Refusal

EVENT = re.compile(r"N(?P<number>\d+)\((?P<type>\w+)\)(?P<entries>.*)\$")
ENTRY = re.compile(r"(?P<letter>[A-Z])(?P<incremental>/?)(?P<value>[+-]?(?:\d+\.?\d*|\.\d+))")
CIRCLE_MILL = "4"
REQUIRED = "XYZRC"
MODAL = "WF"
INCREMENTAL = "XYZL"
UNIT_CODES = {"inch": "G20 ", "mm": "G21 ", None: ""}


def program_from_events(text: str, units: str | None = None) -> str:
    """Return the LinuxCNC program of an event text, or raise `Refusal` naming the line.

    ``units`` (``inch``, ``mm``) are those of the text; None leaves the machine's active ones.
    """
    calls = list(calls_of_events(text))
    if not calls:
        raise Refusal("there is no event in the file")
    return "\n".join([f"{UNIT_CODES[units]}G17 G40 G90 G94", *calls, "M2", ""])


def calls_of_events(text: str) -> Iterator[str]:
    """Yield one block of G-code for each event."""
    modal: dict[str, Entry] = {}
    for line, row in enumerate(text.upper().splitlines(), start=1):
        for event in re.findall(r"[^$]*\$|[^$]+", re.sub(r"\s", "", row)):
            yield call_of_event(event, modal, line)


class Entry:
    """One entry of an event: its number as written, and whether it is incremental."""

    def __init__(self, value: str, incremental: bool) -> None:
        self.value = Decimal(value)
        self.incremental = incremental


def call_of_event(event: str, modal: dict[str, Entry], line: int) -> str:
    """Return the call of one event; its modal entries are added to ``modal``."""
    match = EVENT.fullmatch(event)
    if not match:
        raise refusal(line, f"{event[:40]} is not an event: N…(4)…$")
    if match["type"] != CIRCLE_MILL:
        raise refusal(line, f"event type {match['type']} is not the circle mill event, 4")
    entries = entries_of_event(match["entries"], line)
    modal.update((letter, entry) for letter, entry in entries.items() if letter in MODAL)
    entries = {**modal, **entries}
    check_entries(entries, line)
    values = " ".join(f"[{argument(letter, entries)}]" for letter in ENTRIES)
    return f"N{match['number']} o<circle_mill> call {values}"


def entries_of_event(text: str, line: int) -> dict[str, Entry]:
    """Return the entries by letter."""
    entries: dict[str, Entry] = {}
    position = 0
    while position < len(text):
        match = ENTRY.match(text, position)
        if not match or match["letter"] not in ENTRIES:
            raise refusal(line, f"{text[position:][:20]} does not start with an entry")
        if match["letter"] in entries:
            raise refusal(line, f"{match['letter']} stands twice")
        entries[match["letter"]] = Entry(match["value"], bool(match["incremental"]))
        position = match.end()
    return entries


def check_entries(entries: Mapping[str, Entry], line: int) -> None:
    """Refuse an event without a required entry, or with one that cannot be incremental."""
    for letter in REQUIRED:
        if letter not in entries:
            raise refusal(line, f"{letter} is missing")
    for letter in MODAL:
        if letter not in entries:
            raise refusal(line, f"{letter} is missing, and no event before has it")
    for letter, entry in entries.items():
        if entry.incremental and letter not in INCREMENTAL:
            raise refusal(line, f"{letter}/ cannot be incremental")
        if letter == "L" and entry.value < 0:
            raise refusal(line, f"L{entry.value} must not be negative; L/ is the side only")


def argument(letter: str, entries: Mapping[str, Entry]) -> str:
    """Return one entry as an argument of the call."""
    entry = entries.get(letter)
    if entry is None:
        return f"{LEFT_OUT:.0f}"
    if not entry.incremental:
        return f"{entry.value:f}"
    if letter == "Z":
        return f"{entries['W'].value + entry.value:f}"
    if letter == "L":
        return f"{-entry.value:f}"
    return f"#<_{letter.lower()}> + {entry.value:f}"


def refusal(line: int, rule: str) -> Refusal:
    """Return the refusal of a line (the caller raises it)."""
    return Refusal(f"line {line}: {rule}")
