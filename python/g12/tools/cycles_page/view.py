# SPDX-License-Identifier: GPL-2.0-or-later
"""What both views show alike: colours, labels, pictures."""

from collections.abc import Callable
from pathlib import Path

from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.sketch import MESSAGE, READY, REFUSED
from g12.tools.errors import UsageError
from g12.tools.forms.table import ANGLE, FEED, LENGTH, SECONDS, SPEED, Entry, Form

NGC = Path(__file__).resolve().parents[4] / "ngc"
COLOURS = {
    READY: "#2b7a3d",
    MESSAGE: "#a86500",
    REFUSED: "#a8262a",
    "ground": "#15191e",
    "swept": "#3d5066",
    "path": "#ffffff",
    "rapid": "#d9534f",
}
KEYS = ("7", "8", "9"), ("4", "5", "6"), ("1", "2", "3"), ("-", "0", "."), ("⌫", "C")  # of a keypad
UNITS = {
    LENGTH: {"mm": "mm", "inch": "in"},
    FEED: {"mm": "mm/min", "inch": "in/min"},
    ANGLE: {"mm": "°", "inch": "°"},
    SPEED: {"mm": "1/min", "inch": "1/min"},
    SECONDS: {"mm": "s", "inch": "s"},
}


def pressed(text: str, key: str) -> str:
    """Return the text of an entry after a key of the keypad."""
    if key == "⌫":
        return text[:-1]
    if key == "C":
        return ""
    if key == "-":
        return text[1:] if text.startswith("-") else f"-{text}"
    return text + key


def label_of(entry: Entry, unit: str) -> str:
    """Return what stands beside an entry: words and unit."""
    measured = UNITS.get(entry.kind, {}).get(unit)
    return f"{entry.label}, {measured}" if measured else entry.label


def hint_of(entry: Entry) -> str:
    """Return what an entry's 0 leaves out."""
    return f"0: {entry.zero}" if entry.zero else ""


def picture_of(form: Form, unit: str) -> Path:
    return NGC / f"form_{form.name}_{unit}.png"


def tool_text(page: Page) -> str:
    """Return the tool that is typed: its diameter and its name in the table."""
    if not page.forms:
        return ""
    tool = page.tool()
    if tool is None:
        return f"T{page.texts['tool']}: not in the tool table"
    named = f", {tool.remark}" if tool.remark else ""
    return f"T{page.texts['tool']}: ⌀ {tool.diameter:g} {UNITS[LENGTH][page.unit]}{named}"


class StepButtons:
    """What the buttons of a view do: it shows the steps and says a sentence itself."""

    page: Page
    opened: Callable[[str], None]  # called with the path of a program to open
    edited: int | None = None  # the step that is shown

    def _say(self, state: str, text: str) -> None:
        raise NotImplementedError

    def _show_steps(self, row: int) -> None:
        raise NotImplementedError

    def _try(self, action: Callable[[], None], *_clicked) -> None:
        """Do what a button says; show why it cannot be."""
        try:
            action()
        except (UsageError, OSError) as problem:
            self._say(REFUSED, str(problem))

    def _add(self) -> None:
        self.page.add()
        self._show_steps(len(self.page.steps) - 1)

    def _replace(self) -> None:
        if self.edited is None:
            self._say(MESSAGE, "select a step first")
            return
        self.page.add(self.edited)
        self._show_steps(self.edited)

    def _move(self, by: int) -> None:
        if self.edited is not None:
            self._show_steps(self.page.move(self.edited, by))

    def _delete(self) -> None:
        if self.edited is not None:
            self.page.delete(self.edited)
            self._show_steps(min(self.edited, len(self.page.steps) - 1))

    def _open(self) -> None:
        self.opened(str(self.page.save(self.page.program_path())))
