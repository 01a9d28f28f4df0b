# SPDX-License-Identifier: GPL-2.0-or-later
"""What both views show alike, and what their buttons do."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from g12.tools.cycles_page.page import Page
from g12.tools.cycles_page.sketch import MESSAGE, READY, REFUSED
from g12.tools.cycles_page.steps import number_text
from g12.tools.errors import UsageError
from g12.tools.forms.table import LENGTH, UNITS, Entry, Form

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
SENTENCES = READY, MESSAGE, REFUSED
KEYS = "789", "456", "123", "-0.", "⌫C"  # of a keypad, row by row


def pressed(text: str, key: str) -> str:
    """Return the text of an entry after a key of the keypad."""
    if key in "⌫C":
        return text[:-1] if key == "⌫" else ""
    if key == "-":
        return text[1:] if text.startswith("-") else f"-{text}"
    return text + key


class View:
    """A page's view: it shows the steps and says a sentence in its toolkit's way."""

    page: Page
    opened: Callable[[str], None]  # called with the path of a program to open
    edited: int | None = None  # the step that is shown
    widgets: dict[str, Any]  # of the entries, by name
    _say: Callable[[str, str], None]  # a state and its sentence
    _show_form: Callable[[], None]
    _list_steps: Callable[[list[str], int], None]  # the titles, and the place of the selected one
    _ask_file: Callable[[str, Path], str | None]  # the button's name and the path proposed

    def _place(self, entry: Entry) -> int:
        """Return the place of an entry's text among its choices, -1 for another number."""
        places = {number_text(value): at for at, (value, _) in enumerate(entry.choices)}
        return places.get(self.page.texts[entry.name], -1)

    def _picture(self, form: Form) -> str:
        return str(NGC / f"form_{form.name}_{self.page.unit}.png")

    def _tool(self) -> str:
        """Return the tool that is typed: its diameter and its name in the table."""
        tool = self.page.tool()
        if tool:
            return f"⌀ {tool.diameter:g} {UNITS[self.page.unit][LENGTH]} {tool.remark}"
        return "not in the tool table" if self.page.forms else ""

    def _buttons(self) -> dict[str, Callable[[], None]]:
        """Return what each button does."""
        return {
            "Add": self._add,
            "Replace": self._replace,
            "▲": partial(self._move, -1),
            "▼": partial(self._move, 1),
            "✕": self._delete,
            "Load": self._load,
            "Save": self._save,
            "Open": self._open,
        }

    def _try(self, action: Callable[[], None], *_clicked) -> None:
        """Do what a button says; show why it cannot be."""
        try:
            action()
        except (UsageError, OSError) as problem:
            self._say(REFUSED, str(problem))

    def _select(self, row: int) -> None:
        self.page.select(self.page.forms[row])
        self._show_form()

    def _choose(self, entry: Entry, row: int) -> None:
        self.page.type(entry.name, number_text(entry.choices[row][0]))

    def _edit(self, row: int) -> None:
        self.edited = row
        self.page.select(self.page.steps[row].form, self.page.steps[row])
        self._show_form()

    def _show_steps(self, row: int | None) -> None:
        """Show the list of steps, that of the row selected."""
        self.edited = row if self.page.steps else None
        titles = [f"{at}  {step.form.title}" for at, step in enumerate(self.page.steps, 1)]
        self._list_steps(titles, -1 if self.edited is None else self.edited)

    def _add(self) -> None:
        self.page.add()
        self._show_steps(len(self.page.steps) - 1)

    def _of_selected(self) -> int:
        if self.edited is None:
            raise UsageError("select a step first")
        return self.edited

    def _replace(self) -> None:
        self.page.add(self._of_selected())
        self._show_steps(self.edited)

    def _move(self, by: int) -> None:
        self._show_steps(self.page.move(self._of_selected(), by))

    def _delete(self) -> None:
        del self.page.steps[self._of_selected()]
        self._show_steps(min(self._of_selected(), len(self.page.steps) - 1))

    def _load(self) -> None:
        name = self._ask_file("Load", self.page.program_path())
        if name:
            self.page.load(Path(name))
            self._show_steps(None)

    def _save(self) -> None:
        name = self._ask_file("Save", self.page.program_path())
        if name:
            self.page.save(Path(name))

    def _open(self) -> None:
        self.opened(str(self.page.save(self.page.program_path())))
