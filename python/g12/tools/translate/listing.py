# SPDX-License-Identifier: GPL-2.0-or-later
"""The codes and settings of a control as a list."""

import re
from collections.abc import Iterator, Mapping
from textwrap import wrap

from g12.tools.translate.blocks.control import Control

REFUSE_PREFIX = "refuse: "
HEADINGS = {
    "same": "as on LinuxCNC",
    "comment": "nothing to do, kept as comments",
    "machine": "the builder's: the machine must know them",
}
WIDTH = 96


def listing_of(control: Control) -> str:
    return "\n".join([*_head(control), *_codes(control.meanings), *_tables(control), ""])


def _head(control: Control) -> Iterator[str]:
    yield f"{control.name}: {control.title} ({control.machine}, axes {control.axes})"
    yield from (f"  source: {text}" for text in control.sources)
    yield from (f"  our reading: {text}" for text in control.readings)
    yield f"  holds at the start: {' '.join(control.start)}"
    yield f"  numbers without a point: {control.decimals or 'refused where it matters'}"


def _codes(meanings: Mapping[str, str]) -> Iterator[str]:
    for meaning in sorted(set(meanings.values()), key=_order):
        codes = " ".join(sorted((c for c in meanings if meanings[c] == meaning), key=_number))
        if meaning.startswith(REFUSE_PREFIX):
            yield f"refused {codes}: {meaning.removeprefix(REFUSE_PREFIX)}"
        else:
            text = f"{_heading(meaning)}: {codes}"
            yield from wrap(text, WIDTH, subsequent_indent="  ", break_on_hyphens=False)


def _heading(meaning: str) -> str:
    kind, *letters = meaning.split(" ") if meaning.startswith("comment") else [meaning]
    beside = f", with their {' '.join(letters)}" if letters else ""
    return f"{HEADINGS.get(kind, kind)}{beside}"


def _order(meaning: str) -> tuple[int, str]:
    kind = "comment" if meaning.startswith("comment") else meaning
    first = [*HEADINGS].index(kind) if kind in HEADINGS else len(HEADINGS)
    return first + meaning.startswith(REFUSE_PREFIX), meaning


def _number(code: str) -> tuple[str, float, str]:
    is_number = code[1:].replace(".", "").isdigit()
    return code[0], float(code[1:]) if is_number else 0.0, code


def _tables(control: Control) -> Iterator[str]:
    for name, table in control.tables.items():
        values = (f"{key} = {re.sub(r'[][]', '', str(value))}" for key, value in table.items())
        yield f"[{name}] {', '.join(values)}"
