# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page without a toolkit: forms of this machine, values, steps, the sketch of a change.

A view shows it and calls its methods; ``changed`` is called from another thread when a new sketch
is there. The interpreter works in that thread and in a process of its own, never in the screen's.
"""

import contextlib
import os
import threading
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from g12.machine_ini import remap_lines
from g12.settings import INI_SECTION, LIVE_TOOL
from g12.tools.cycles_page.machine import Tool, machine_state, tools_of
from g12.tools.cycles_page.sketch import REFUSED, Sketch
from g12.tools.cycles_page.steps import Step, number_text, program_text, read_entry, read_program
from g12.tools.errors import UsageError
from g12.tools.forms.table import FORMS, HANDLERS, TOOL, Entry, Form
from g12.tools.machine.files import write
from g12.tools.machine.ini import Ini, IniError, read_ini
from g12.tools.units import name_of_unit

NICE = 5  # of the sketches: LinuxCNC's own threads and the screen come first
INTERPRETER = "g12.tools.cycles_page.interpreter"
PATIENCE = 15.0  # s, of a button for a sketch
LONGEST = 300  # letters of a sentence, of an interpreter that dies


class Page:
    """The page of one machine."""

    def __init__(self, ini_path: str | os.PathLike, changed: Callable[[], None]) -> None:
        self.unit = "mm"
        self.sketch = Sketch(REFUSED, "no cycle is set up in this machine: see check")
        self.forms: Sequence[Form] = ()
        self.entries: Sequence[Entry] = ()
        self.texts: dict[str, str] = {}  # as typed, by the name of the entry
        try:
            self.ini = read_ini(ini_path)
            self.unit = name_of_unit(self.ini.mm)
            handlers = {name for remap in remap_lines(self.ini.all) for name in remap.handlers}
            self.forms = [form for form in FORMS if HANDLERS[form.feature] in handlers]
        except IniError as problem:
            self.ini = Ini(Path(ini_path), ())
            self.sketch = Sketch(REFUSED, str(problem))
        self.steps: list[Step] = []
        self._last: dict[str, Step] = {}  # the step that each form was added as
        self._changed = changed
        self._sketcher: Any = None
        self._wanted: tuple[Form, str] | None = None  # until it is drawn
        self._wake, self._ended = threading.Condition(), False
        self._thread = threading.Thread(target=self._work, name="cycles page", daemon=True)
        self._thread.start()
        if self.forms:
            self.select(self.forms[0])

    def close(self) -> None:
        with self._wake:
            self._ended = True
            self._wake.notify()
        self._thread.join(timeout=5)

    # The form.

    def select(self, form: Form, step: Step | None = None) -> None:
        """Show a form, with its last values or those of a step."""
        self.form, self.entries = form, form.entries
        step = step or self._last.get(form.name)
        self.texts = {
            entry.name: number_text(step.values[entry.name]) if step else self.default(entry)
            for entry in form.entries
        }
        self._ask()

    def default(self, entry: Entry) -> str:
        """Return the text that an entry begins with on this machine."""
        tools, number = tools_of(self.ini), machine_state(self.ini).tool
        if number not in tools:  # it is not the loaded tool, but the first that has a diameter
            number = next((each for each, tool in tools.items() if tool.diameter > 0), 1)
        if entry.kind == TOOL:
            return number_text(number)
        if entry.of_tool and number in tools and tools[number].diameter > 0:
            return f"{entry.of_tool * tools[number].diameter:.3g}"
        live = (self.ini.get(INI_SECTION, LIVE_TOOL) or "").upper().replace("M", " ").split()
        if entry.name in ("on", "off") and len(live) == 2:
            return live[("on", "off").index(entry.name)]
        return number_text(entry.default(self.unit))

    def tool(self) -> Tool | None:
        """Return the line of the tool table of the tool that is typed, for 0 of the loaded one."""
        with contextlib.suppress(ValueError):
            number = int(self.texts.get("tool", "")) or machine_state(self.ini).tool
            return tools_of(self.ini).get(number)
        return None

    def type(self, name: str, text: str) -> None:
        """Take what the operator has typed into an entry."""
        self.texts[name] = text
        self._ask()

    def values(self) -> dict[str, float]:
        """Return the numbers of the form; refuse the first that is none."""
        return {entry.name: read_entry(entry, self.texts[entry.name]) for entry in self.entries}

    def shown(self, entry: Entry) -> bool:
        """Return whether an entry matters as the others stand."""
        return not entry.needs or self.texts[entry.needs].strip() not in ("0", "")

    # The steps.

    def add(self, at: int | None = None) -> None:
        """Add the form to the program, or put it in place of the step ``at``."""
        with self._wake:
            if not self._wake.wait_for(lambda: self._wanted is None, PATIENCE):
                raise UsageError("it is not drawn yet")
        if self.sketch.state == REFUSED:
            raise UsageError(self.sketch.text)
        step = Step(self.form, self.unit, self.values())
        if at is None:
            self.steps.append(step)
        else:
            self.steps[at] = step
        self._last[self.form.name] = step

    def move(self, at: int, by: int) -> int:
        """Move a step up or down; return its new place."""
        new = min(max(at + by, 0), len(self.steps) - 1)
        self.steps.insert(new, self.steps.pop(at))
        return new

    def load(self, path: Path) -> None:
        """Take the steps of a program of the page."""
        steps = read_program(path.read_text(encoding="utf-8", errors="replace"))
        if any(step.unit != self.unit for step in steps):
            raise UsageError(f"{path.name}: its forms are not those of a machine in {self.unit}")
        self.steps = steps

    def save(self, path: Path) -> Path:
        """Write the program of the steps, of the form alone if there are none."""
        if not self.steps:
            self.add()
        write(path, program_text(self.steps).encode())
        return path

    def program_path(self) -> Path:
        """Return where Open writes: PROGRAM_PREFIX, else the config's folder."""
        prefix = self.ini.file("DISPLAY", "PROGRAM_PREFIX")
        return (prefix if prefix and prefix.is_dir() else self.ini.directory) / "cycles.ngc"

    # The sketch.

    def _ask(self) -> None:
        """Have the form as it is drawn."""
        try:
            wanted = self.form, Step(self.form, self.unit, self.values()).call
        except UsageError as problem:
            self._wanted = None
            self._show(None, Sketch(REFUSED, str(problem)))
            return
        with self._wake:
            self._wanted = wanted
            self._wake.notify_all()

    def _show(self, wanted: Any, sketch: Sketch) -> None:
        """Show the sketch of a request, unless another one came meanwhile."""
        with self._wake:
            if self._wanted is not wanted:
                return
            self._wanted, self.sketch = None, sketch
            self._wake.notify_all()
        self._changed()

    def _work(self) -> None:
        os.setpriority(os.PRIO_PROCESS, 0, NICE)  # of this thread, and of the interpreter it starts
        while True:
            with self._wake:
                self._wake.wait_for(lambda: self._ended or self._wanted)
                wanted = self._wanted
            if self._ended:
                break
            self._show(wanted, self._sketched(*wanted))
        if self._sketcher:
            self._sketcher.close()

    def _sketched(self, form: Form, text: str) -> Sketch:
        """Return a sketch, of a new interpreter where the last one failed."""
        try:
            # here, for its libraries take time to load, and one may be missing
            self._sketcher = self._sketcher or import_module(INTERPRETER).Sketcher(self.ini)
            return self._sketcher.sketch(form, text, machine_state(self.ini))
        except Exception as problem:  # whatever it is, the page goes on
            if self._sketcher:
                self._sketcher.close()
            return Sketch(REFUSED, str(problem)[:LONGEST] or type(problem).__name__)
