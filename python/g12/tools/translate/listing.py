# SPDX-License-Identifier: GPL-2.0-or-later
"""The codes and settings of a control as a list, and those that its file lacks for a program."""

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from textwrap import wrap

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import AXIS_NUMBERS
from g12.tools.translate.blocks.lexer import ForeignBlock

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
    if control.is_lathe:
        yield f"  F of a block with C and a slide: {control.feed_of_c}"
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


CHOICES = '"…" # "comment", "machine", "same" or codes of LinuxCNC'


def missing_lines(
    blocks: Iterable[ForeignBlock], control: Control, settings: Iterable[tuple[str, str]]
) -> list[str]:
    """Return the lines; ``settings`` are the tables and lines that rules need."""
    tables: dict[str, list[str]] = {"": []}
    words = [w for block in blocks for w in block.words if w.kind == "number"]
    letters = {control.value("words", w.letter, w.letter) for w in words}
    has_section = {"polar on", "cylinder"} & {control.meanings.get(w.code) for w in words}
    known = {*control.axes, *("Y" if has_section else "")}  # where Y is C
    axes = "".join(sorted((letters & AXIS_NUMBERS.keys()) - known))
    if axes and not control.onto and not control.on_machine:
        tables[""].append(f'axes = "{control.axes}{axes}"')
    for table, line in settings:
        tables.setdefault(table, []).append(line)
    for code in sorted({w.code for w in words} - {""}, key=_number):
        meaning = control.meanings.get(code, "")
        if not meaning or (
            meaning == "machine" and control.on_machine and not control.is_machines(code)
        ):
            name = f'"{code}"' if "." in code else code
            tables.setdefault(f"{code[0].lower()}_codes", []).append(f"{name} = {CHOICES}")
    top = tables.pop("")
    named = [[f"[{table}]", *dict.fromkeys(lines)] for table, lines in tables.items()]
    return [*dict.fromkeys(top), *chain(*named)]
