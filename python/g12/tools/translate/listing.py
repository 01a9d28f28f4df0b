# SPDX-License-Identifier: GPL-2.0-or-later
"""What a control understands, as a list to read."""

import re
from collections.abc import Iterable, Iterator, Mapping

from g12.tools.translate.blocks.control import Control

REFUSED = "refuse: "
HEADINGS = {
    "same": "as on LinuxCNC",
    "comment": "nothing to do, kept as comments",
    "machine": "the builder's: the machine must know them",
}
WIDTH = 96


def listing_of(control: Control) -> str:
    """Return the list of a control's codes, settings, sources and readings."""
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
        if meaning.startswith(REFUSED):
            yield f"refused {codes}: {meaning.removeprefix(REFUSED)}"
        else:
            yield from _wrapped(f"{_heading(meaning)}:", codes.split())


def _heading(meaning: str) -> str:
    kind, *letters = meaning.split(" ") if meaning.startswith("comment") else [meaning]
    beside = f", with their {' '.join(letters)}" if letters else ""
    return f"{HEADINGS.get(kind, kind)}{beside}"


def _order(meaning: str) -> tuple[int, str]:
    kind = "comment" if meaning.startswith("comment") else meaning
    first = [*HEADINGS].index(kind) if kind in HEADINGS else len(HEADINGS)
    return first + meaning.startswith(REFUSED), meaning


def _number(code: str) -> tuple[str, float]:
    return code[0], float(code[1:])


def _wrapped(head: str, words: Iterable[str]) -> Iterator[str]:
    line = head
    for word in words:
        if len(line) + len(word) >= WIDTH:
            yield line
            line = " "
        line += f" {word}"
    yield line


def _tables(control: Control) -> Iterator[str]:
    for name, table in control.tables.items():
        values = ", ".join(
            f"{key} = {re.sub(r'[][]', '', str(value))}" for key, value in table.items()
        )
        yield f"[{name}] {values}"
