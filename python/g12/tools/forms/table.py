# SPDX-License-Identifier: GPL-2.0-or-later
"""The table of forms: what an operator fills in for each cycle, shape and kind of holes.

It is the data of `forms.toml`; ngcgui's files (`.ci/forms.py`, one for each unit) and the Cycles
page (`tools/cycles_page`) are made from it.
"""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

FILE = Path(__file__).with_name("forms.toml")
NONE: Mapping[str, Any] = MappingProxyType({})

LENGTH, FEED, ANGLE, COUNT, CHOICE, TOOL, SPEED, SECONDS = (
    *("length", "feed", "angle", "count", "choice", "tool", "speed", "seconds"),
)  # and a ratio
MILL, ROUND = "from above", "on the unrolled surface"  # how a form is seen; else on the face
HANDLERS = {  # of each feature with forms: one that the REMAP lines of a machine with it name
    "haas": "g12_haas",
    "yasnac": "g12_yasnac",
    "mitsubishi": "g12_mitsubishi",
    "circle-mill": "circle_mill_pocket",
    "bore": "g12_bore",
    "thread": "g12_thread",
    "frame": "g12_frame",
    "polar-shapes": "polar_shape",
}
UNITS = {  # of an entry's kind, by a form's unit
    "mm": {LENGTH: "mm", FEED: "mm/min", ANGLE: "°", SPEED: "1/min", SECONDS: "s"},
    "inch": {LENGTH: "in", FEED: "in/min", ANGLE: "°", SPEED: "1/min", SECONDS: "s"},
}


class Entry(NamedTuple):
    """One entry of a form."""

    name: str  # of the sub's local
    words: str  # beside the entry in ngcgui, at most 18 letters
    label: str  # beside the entry on the page
    kind: str = LENGTH  # to SECONDS
    mm: float = 0  # the default, lengths in mm
    inch: float | None = None  # the default of an inch form, where it is another
    choices: tuple[tuple[float, str], ...] = ()  # of CHOICE: value and words, the default first
    zero: str = ""  # what 0 leaves out; empty where 0 is a value like another
    omitted: bool = False  # 0 becomes -9999 in the call
    of_tool: float = 0.0  # the page proposes this share of the tool's diameter
    needs: str = ""  # an entry that must not be 0 for this one to matter

    def caption(self, unit: str) -> str:
        """Return what stands beside the entry on the page: label and unit."""
        return ", ".join(filter(None, (self.label, UNITS[unit].get(self.kind))))

    def default(self, unit: str) -> float:
        """Return the default of a form of ``unit``, mm or inch."""
        return self.mm if unit == "mm" or self.inch is None else self.inch


class Form(NamedTuple):
    """One form."""

    name: str  # of its files: form_NAME_mm.ngc
    feature: str  # of `install`, which has its codes
    title: str  # on the page
    info: str  # above ngcgui's entries; {lengths} is the unit
    page: str  # which says what its entries mean
    place: str  # MILL, ROUND, on the face: decides its start, its end, its machine and its view
    entries: tuple[Entry, ...]
    body: str = ""  # of a mill's form: from the start's call to the end's
    sub: str = ""  # which is called with the entries
    heights: Sequence[str] = ("retract", "top")  # of a mill's form: where it ends, begins to cut


def read_forms() -> tuple[Form, ...]:
    data = tomllib.loads(FILE.read_text(encoding="utf-8"))
    return tuple(_form(data["groups"], **form) for form in data["forms"])


def _form(
    groups: Mapping[str, Any],
    entries: Sequence[Any],
    change: Mapping[str, Any] = NONE,
    **others: Any,
) -> Form:
    written = [each for one in entries for each in (groups[one] if isinstance(one, str) else [one])]
    made = [_entry(*each, change=change.get(each[0], {})) for each in written]
    return Form(entries=tuple(made), **others)


def _entry(
    name: str, words: str, label: str, given: Mapping[str, Any] = NONE, *, change: Mapping[str, Any]
) -> Entry:
    values = {"name": name, "words": words, "label": label, **given, **change}
    if "left_out" in values:
        values |= {"zero": values.pop("left_out"), "omitted": True}
    if "choices" in values:
        choices = tuple(map(tuple, values["choices"]))
        values |= {"kind": CHOICE, "choices": choices, "mm": choices[0][0]}
    return Entry(**values)


FORMS = read_forms()
