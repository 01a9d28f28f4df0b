# SPDX-License-Identifier: GPL-2.0-or-later
"""The Cycles page without a toolkit: forms of this machine, values, steps, the sketch of a change.

A view shows it and calls its methods; ``changed`` is called from another thread when a new sketch
is there. The interpreter works in that thread and in a process of its own, never in the screen's.
"""

import contextlib
import json
import os
import threading
from collections.abc import Callable, Sequence
from pathlib import Path

from g12.lengths import is_inch
from g12.machine_ini import remap_lines
from g12.settings import INI_SECTION, LIVE_TOOL
from g12.tools.cycles_page.machine import Tool, machine_state, tools_of
from g12.tools.cycles_page.sketch import REFUSED, MachineState, Sketch, Sketcher
from g12.tools.cycles_page.steps import (
    Step,
    number_text,
    program_text,
    read_entry,
    read_program,
)
from g12.tools.errors import UsageError
from g12.tools.forms.table import CHOICE, FORMS, TOOL, Entry, Form
from g12.tools.machine.files import write
from g12.tools.machine.ini import read_ini

HANDLERS = {  # of a REMAP line: the feature whose forms it makes possible
    "g12_haas": "haas",
    "g12_yasnac": "yasnac",
    "g12_mitsubishi": "mitsubishi",
    "circle_mill_pocket": "circle-mill",
    "g12_bore": "bore",
    "g12_thread": "thread",
    "g12_frame": "frame",
    "polar_shape": "polar-shapes",
}
KEPT = "g12/cycles-page.json"  # below XDG_STATE_HOME


class Page:
    """The page of one machine."""

    def __init__(
        self,
        ini_path: str | os.PathLike,
        changed: Callable[[], None],
        state: Callable[[], MachineState] | None = None,
    ) -> None:
        self.ini = read_ini(ini_path)
        self.unit = "inch" if is_inch(self.ini.mm) else "mm"
        self.forms = forms_of_machine(self.ini)
        self.tools = tools_of(self.ini)
        self.steps: list[Step] = []
        self.sketch = Sketch(REFUSED, "no cycle is set up in this machine: see check")
        self._state = state or (lambda: machine_state(self.ini))
        self._kept = _read_kept()
        self._changed = changed
        self._sketcher = Sketcher(self.ini)
        self._wanted: tuple[Form, str] | None = None
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
        self._sketcher.close()

    # The form.

    def select(self, form: Form, step: Step | None = None) -> None:
        """Show a form, with its last values or those of a step."""
        self.form = form
        if step:
            self.texts = {name: number_text(value) for name, value in step.values.items()}
        else:
            kept = self._kept.get(f"{form.name}_{self.unit}", {})
            self.texts = {
                entry.name: str(kept.get(entry.name, self.default(entry))) for entry in form.entries
            }
        self._ask()

    def default(self, entry: Entry) -> str:
        """Return the text that an entry begins with on this machine."""
        if entry.kind == TOOL:
            return number_text(self._default_tool())
        tool = self.tools.get(self._default_tool())
        if entry.of_tool and tool and tool.diameter > 0:
            return f"{entry.of_tool * tool.diameter:.3g}"
        live = (self.ini.get(INI_SECTION, LIVE_TOOL) or "").upper().replace("M", " ").split()
        if entry.name in ("on", "off") and len(live) == 2:
            return live[("on", "off").index(entry.name)]
        return number_text(entry.default(self.unit))

    def _default_tool(self) -> int:
        """Return the loaded tool, else the first of the table that has a diameter."""
        loaded = self._state().tool
        if loaded in self.tools:
            return loaded
        return next((tool for tool, row in self.tools.items() if row.diameter > 0), 1)

    def tool(self) -> Tool | None:
        """Return the line of the tool table of the tool that is typed."""
        try:
            return self.tools.get(int(self.values()["tool"]))
        except UsageError:
            return None

    def type(self, name: str, text: str) -> None:
        """Take what the operator has typed into an entry."""
        self.texts[name] = text
        self._ask()

    def values(self) -> dict[str, float]:
        """Return the numbers of the form; refuse the first that is none."""
        return {
            entry.name: read_entry(entry, self.texts[entry.name]) for entry in self.form.entries
        }

    def shown(self, entry: Entry) -> bool:
        """Return whether an entry matters as the others stand."""
        return not (entry.name == "q" and self.texts.get("k") in ("0", ""))

    # The steps.

    def add(self, at: int | None = None) -> None:
        """Add the form to the program, or put it in place of the step ``at``."""
        step = Step(self.form, self.unit, self.values())
        if self.sketch.state == REFUSED:
            raise UsageError(self.sketch.text)
        if at is None:
            self.steps.append(step)
        else:
            self.steps[at] = step
        self._keep(step)

    def move(self, at: int, by: int) -> int:
        """Move a step up or down; return its new place."""
        new = min(max(at + by, 0), len(self.steps) - 1)
        self.steps.insert(new, self.steps.pop(at))
        return new

    def delete(self, at: int) -> None:
        del self.steps[at]

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
        prefix = self.ini.get("DISPLAY", "PROGRAM_PREFIX")
        folder = self.ini.directory / Path(prefix).expanduser() if prefix else self.ini.directory
        return (folder if folder.is_dir() else self.ini.directory) / "cycles.ngc"

    # The sketch.

    def _ask(self) -> None:
        """Have the form as it is drawn; a request that has not begun is dropped."""
        try:
            step = Step(self.form, self.unit, self.values())
        except UsageError as problem:
            with self._wake:
                self._wanted = None
                self.sketch = Sketch(REFUSED, str(problem))
            self._changed()
            return
        with self._wake:
            self._wanted = (self.form, step.call + "\n")
            self._wake.notify()

    def _work(self) -> None:
        while True:
            with self._wake:
                self._wake.wait_for(lambda: self._ended or self._wanted)
                if self._ended:
                    return
                (form, text), self._wanted = self._wanted, None
            sketch = self._sketcher.sketch(form, text, self._state())
            with self._wake:
                if self._wanted is None:
                    self.sketch = sketch
            self._changed()

    def _keep(self, step: Step) -> None:
        """Keep the values for the next time."""
        self._kept[f"{step.form.name}_{step.unit}"] = {
            name: number_text(value) for name, value in step.values.items()
        }
        with contextlib.suppress(OSError):  # a home that cannot be written: kept until the end
            path = _kept_path()
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            write(path, json.dumps(self._kept, indent=1).encode())


def forms_of_machine(ini) -> Sequence[Form]:
    """Return the forms whose codes the machine has."""
    handlers = {name for remap in remap_lines(ini.all) for name in remap.handlers}
    features = {feature for handler, feature in HANDLERS.items() if handler in handlers}
    return [form for form in FORMS if form.feature in features]


def choice_of(entry: Entry, text: str) -> int:
    """Return the place of an entry's text among its choices, -1 for another number."""
    assert entry.kind == CHOICE
    values = [number_text(value) for value, _ in entry.choices]
    return values.index(text) if text in values else -1


def _kept_path() -> Path:
    state = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(state) / KEPT


def _read_kept() -> dict[str, dict[str, str]]:
    """Return the values kept by form; whatever else the file holds is no value."""
    try:
        kept = json.loads(_kept_path().read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return {}
    forms = kept.items() if isinstance(kept, dict) else ()
    return {name: values for name, values in forms if isinstance(values, dict)}
