# SPDX-License-Identifier: GPL-2.0-or-later
"""Write ngcgui's file of every form, in mm and inch, from the table: python3 .ci/forms.py."""

import re
import sys
from itertools import combinations
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))

from g12.tools.forms.table import FEED, FORMS, MILL, UNITS, Entry, Form  # noqa: E402

LICENCE = "(SPDX-License-Identifier: GPL-2.0-or-later)\n"
LENGTHS = {"mm": "mm", "inch": "inches"}
CODES = {"mm": 21, "inch": 20}
OF_START_AND_END = ("tool", "speed", "on", "off", "coolant", "retract", "clear", "spindle")
LOADED = "#<tool> = [#<tool> + #5400 * [#<tool> EQ 0]]\n"  # 0 is the tool in the spindle
UNCHECKED = ("code", "event")  # by a cycle: they decide which one is called


def file_name(form: Form, unit: str) -> str:
    return f"form_{form.name}_{unit}.ngc"


def form_text(form: Form, unit: str) -> str:
    """Return the file of a form of ``unit``, mm or inch."""
    name = file_name(form, unit).removesuffix(".ngc")
    on_mill = form.place == MILL
    restored = "G{} and restores the units" if on_mill else "G{} G7 and restores the modes"
    entries = "".join(
        f"#<{entry.name}> = #{number} (={entry.default(unit):g}"
        f" {entry.words.format(feed=UNITS[unit][FEED])})\n"
        for number, entry in enumerate(form.entries, 1)
    )
    kept = "#<imperial> = #<_imperial>\n"
    if not on_mill:
        kept += "#<diameters> = #<_lathe_diameter_mode>\n"
    checks = "".join(map(_check, form.entries))
    return (
        f"{LICENCE}(info: {form.info.format(lengths=LENGTHS[unit])})\n"
        f"(Form of ngc/{form.page}.md. Sets {restored.format(CODES[unit])}.)\n"
        f"o<{name}> sub\n{_indented(entries + kept + LOADED + checks + _body(form, unit))}"
        f"o<{name}> endsub\n"
    )


def _check(entry: Entry) -> str:
    """Return the check of an entry that decides which cycle is called, "" for another one."""
    if entry.name not in UNCHECKED:
        return ""
    values = sorted(f"{value:g}" for value, _ in entry.choices)
    wrong = " AND ".join(f"#<{entry.name}> NE {value}" for value in values)
    return (
        f"o<no_{entry.name}> if [{wrong}]\n"
        f"  (ABORT,form: G must be {' or '.join(values)}, not #<{entry.name}>)\n"
        f"o<no_{entry.name}> endif\n"
    )


def _body(form: Form, unit: str) -> str:
    """Return the lines from the start's call to the end's."""
    if form.place == MILL:
        height, top = form.heights
        begin, start = "form_start", f"tool speed coolant x y {height} {top} z"
        end = f"o<form_end> call {_arguments(height, 'imperial')}\n"
    else:
        begin, start = "form_face_start", "tool speed on coolant retract spindle"
        end = f"o<form_face_end> call {_arguments('off', 'imperial', 'diameters', 'spindle')}\n"
    start = f"o<{begin}> call [{CODES[unit]}] {_arguments(*start.split())}\n"
    return _written(form).replace("START\n", start) + end


def _written(form: Form) -> str:
    """Return a form's own lines, else the call of its sub; ``WORDS`` is a block in any case."""
    lines = form.body or _call(form)
    return re.sub("^WORDS (.*)", lambda found: block(*found[1].split(" | ")), lines, flags=re.M)


def block(words: str, *optional: str) -> str:
    """Return a block with those of its optional words whose first one's entry is not 0."""
    lines: list[str] = []
    for number in range(len(optional), -1, -1):
        for chosen in combinations(optional, number):
            needed = " AND ".join(f"#<{word[0].lower()}>" for word in chosen)
            begin = f"{'elseif' if lines else 'if'} [{needed}]" if needed else "else"
            lines += [f"o<words> {begin}", " ".join([f"  {words}", *chosen])]
    return "\n".join([*lines, "o<words> endif"])


def _call(form: Form) -> str:
    """Return the start and the call of a form's sub, with its entries in their order."""
    called = [entry for entry in form.entries if entry.name not in OF_START_AND_END]
    omitted = "".join(
        f"#<{entry.name}> = [#<{entry.name}> - 9999 * [#<{entry.name}> EQ 0]]\n"
        for entry in called
        if entry.omitted
    )
    clear = "G0 X#<clear>\n" if any(entry.name == "clear" for entry in form.entries) else ""
    entries = _arguments(*(entry.name for entry in called))
    return f"START\n{clear}{omitted}o<{form.sub}> call {entries}\n"


def _arguments(*names: str) -> str:
    return " ".join(f"[#<{name}>]" for name in names)


def _indented(text: str) -> str:
    return "".join(f"  {line}\n" for line in text.splitlines())


def files() -> dict[str, str]:
    """Return the text of every file, by its name."""
    return {file_name(form, unit): form_text(form, unit) for form in FORMS for unit in CODES}


if __name__ == "__main__":
    for name, text in files().items():
        (ROOT / "ngc" / name).write_text(text)
