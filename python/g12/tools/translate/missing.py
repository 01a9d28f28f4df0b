# SPDX-License-Identifier: GPL-2.0-or-later
"""All that a control's file lacks for a program, as lines for one of your own."""

from collections.abc import Iterable

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import AXIS_NUMBERS
from g12.tools.translate.blocks.lexer import ForeignBlock

CHOICES = '"…" # "comment", "machine", "same" or codes of LinuxCNC'


def missing_lines(
    blocks: Iterable[ForeignBlock],
    control: Control,
    machine_codes: frozenset[str] | None,
    settings: Iterable[tuple[str, str]],
) -> list[str]:
    """Return the lines; ``settings`` are the tables and lines that rules have asked for."""
    tables: dict[str, list[str]] = {"": []}
    words = [w for block in blocks for w in block.words if w.kind == "number"]
    letters = {control.value("words", w.letter, w.letter) for w in words}
    axes = "".join(sorted((letters & AXIS_NUMBERS.keys()) - set(control.axes)))
    if axes and not control.onto:
        tables[""].append(f'axes = "{control.axes}{axes}"')
    for table, line in settings:
        tables.setdefault(table, []).append(line)
    for code in sorted({w.code for w in words if w.letter in "GM"}, key=_number):
        meaning = control.meanings.get(code, "")
        if not meaning or (meaning == "machine" and code not in (machine_codes or {code})):
            name = f'"{code}"' if "." in code else code
            tables.setdefault(f"{code[0].lower()}_codes", []).append(f"{name} = {CHOICES}")
    return [line for table in tables for line in _lines_of(table, tables[table])]


def _lines_of(table: str, lines: list[str]) -> list[str]:
    head = [f"[{table}]"] if table and lines else []
    return [*head, *dict.fromkeys(lines)]


def _number(code: str) -> tuple[str, float]:
    return code[0], float(code[1:]) if code[1:].replace(".", "").isdigit() else 0.0
