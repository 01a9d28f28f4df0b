# SPDX-License-Identifier: GPL-2.0-or-later
"""The codes and settings of a control as a list."""

import re
from collections.abc import Iterator
from textwrap import wrap

from g12.tools.translate.blocks.control import Control

MEANT = {"same": "as on LinuxCNC", "comment": "kept as comments", "machine": "the machine's own"}
WIDTH = 96


def listing_of(control: Control) -> str:
    return "\n".join([*_head(control), *_codes(control), *_tables(control), ""])


def _head(control: Control) -> Iterator[str]:
    yield f"{control.name}: {control.title} ({control.machine}, axes {control.axes})"
    yield from (f"  source: {text}" for text in control.sources)
    yield from (f"  our reading: {text}" for text in control.readings)
    yield f"  holds at the start: {' '.join(control.start)}"
    yield f"  numbers without a point: {control.decimals or 'refused where it matters'}"


def _codes(control: Control) -> Iterator[str]:
    for meaning in sorted(set(control.meanings.values()), key=lambda m: (m[:6] == "refuse", m)):
        codes = sorted(
            (c for c, of in control.meanings.items() if of == meaning),
            key=lambda c: (c[0], float(c[1:])),
        )
        kind, _, rest = meaning.partition(" ")
        text = f"{' '.join([MEANT.get(kind, kind), rest]).strip()}: {' '.join(codes)}"
        yield from wrap(text, WIDTH, subsequent_indent="  ", break_on_hyphens=False)


def _tables(control: Control) -> Iterator[str]:
    for name, table in control.tables.items():
        values = (f"{key} = {re.sub(r'[][]', '', str(value))}" for key, value in table.items())
        yield f"[{name}] {', '.join(values)}"
