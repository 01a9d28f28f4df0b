# SPDX-License-Identifier: GPL-2.0-or-later
"""The steps of a program: a form filled in each, as the text of a file and back.

The file is an LinuxCNC program like any other: a call of a form in each line, which runs without
the page. The page reads back what it has written, also after an edit of the numbers.
"""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from g12.tools.errors import UsageError
from g12.tools.forms.table import CHOICE, COUNT, FORMS, TOOL, Entry, Form

HEAD = "(Cycles page: a call of a form in each line, its entries in their order)"
CALL = re.compile(r"o<form_(\w+)_(mm|inch)> call((?: \[[-+.\d]+\])+)(?: \((.*)\))?")
NUMBER = re.compile(r"[-+]?(\d{1,9}(\.\d*)?|\.\d+)", re.ASCII)  # longer ones are no length
END = "M2"
BY_NAME = {form.name: form for form in FORMS}


class Step(NamedTuple):
    """A form filled in."""

    form: Form
    unit: str  # mm or inch
    values: Mapping[str, float]  # of every entry, by its name

    @property
    def call(self) -> str:
        """The line of the program."""
        values = (self.values[entry.name] for entry in self.form.entries)
        entries = " ".join(f"[{number_text(value)}]" for value in values)
        return f"o<form_{self.form.name}_{self.unit}> call {entries} ({self.form.title})"


def number_text(value: float) -> str:
    """Return a number as LinuxCNC reads it, without an exponent."""
    return f"{value:.6f}".rstrip("0").rstrip(".") if value else "0"


def read_entry(entry: Entry, text: str) -> float:
    """Return the number of an entry's text; a comma is a point. Refuse what is no number."""
    written = text.strip().replace(",", ".")
    if not NUMBER.fullmatch(written):
        shown = f"{text.strip()} is no number" if written else "a number is missing"
        raise UsageError(f"{entry.label}: {shown}")
    value = float(written)
    if entry.kind in (COUNT, TOOL) and value != int(value):
        raise UsageError(f"{entry.label}: {written} must be a whole number")
    if entry.kind == CHOICE and value not in dict(entry.choices):
        raise UsageError(f"{entry.label}: {written} is none of its choices")
    return value


def program_text(steps: Sequence[Step]) -> str:
    """Return the program of the steps."""
    return "\n".join([HEAD, *(step.call for step in steps), END, ""])


def read_program(text: str) -> list[Step]:
    """Return the steps of a program that the page has written; refuse any other line."""
    steps = []
    for row, line in enumerate(text.splitlines(), 1):
        try:
            steps += _steps_in(line.strip())
        except UsageError as problem:
            raise UsageError(f"line {row}: {problem}") from problem
    return steps


def _steps_in(line: str) -> list[Step]:
    """Return the step of a line, none for one that only begins or ends the program."""
    call = CALL.fullmatch(line)
    if call is None:
        if line in ("", HEAD, END):
            return []
        raise UsageError(f"{line:.60}: is no step of the Cycles page")
    name, unit, written, _ = call.groups()
    form, numbers = BY_NAME.get(name), re.findall(r"\[(.*?)\]", written)
    if form is None or len(numbers) != len(form.entries):
        needed = f" has {len(form.entries)} entries, not {len(numbers)}" if form else " is no form"
        raise UsageError(f"form_{name}_{unit}{needed}")
    values = {entry.name: read_entry(entry, text) for entry, text in zip(form.entries, numbers)}
    return [Step(form, unit, values)]
