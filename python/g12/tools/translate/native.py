# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that LinuxCNC runs as they are, in a file that a control's filter opens.

What only LinuxCNC has: its O-words, named parameters, G64 P, G33.1 and G38.2 to G38.5. What it
lacks: other codes than its own and the package's, and the statements of macro controls.
"""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from g12.tools.translate.blocks.lexer import code_of

CODES = frozenset(
    f"G{n}"
    for n in (
        *range(9), 10, *range(17, 22), 28, 30, 33, *range(40, 44), 49, *range(52, 60), 61,
        64, *range(70, 75), 76, *range(80, 100), 5.1, 5.2, 5.3, 6.1, 6.2, 6.3, 17.1, 18.1, 19.1,
        28.1, 30.1, 33.1, 38.2, 38.3, 38.4, 38.5, 41.1, 42.1, 43.1, 43.2, 59.1, 59.2, 59.3, 61.1,
        71.1, 71.2, 72.1, 72.2, 90.1, 91.1, 92.1, 92.2, 92.3,
    )
)  # fmt: skip
OF_PACKAGE = frozenset(f"G{n}" for n in (12, 13, 12.1, 12.2, 12.4, 13.1, 13.2, 13.4, 7.1))
SPACE = re.compile(r"\([^()]*\)|;.*|\s")  # and comments
O_WORD = re.compile(
    r"O(<[^>]+>|[0-9]+)(SUB|ENDSUB|CALL|RETURN|IF|ELSE|ELSEIF|ENDIF|WHILE|ENDWHILE|DO|REPEAT|"
    r"ENDREPEAT|BREAK|CONTINUE)(?![A-Z])"
)
WORD = re.compile(r"#<[A-Z_]+|G0*64P|G0*33\.1(?![0-9])|G0*38\.[2-5]")
MACRO = re.compile(r"(?:^|[0-9])((?:IF|WHILE)\[|GOTO|M97)")
G_CODE = re.compile(r"(?<![A-Z])G([0-9]{1,4}(?:\.[0-9])?)")
NAMED_PARAMETER = re.compile("#<[^>]*>")
ACTIVE = re.compile(r"[(;]\s*[A-Z]+\s*,", re.I)
LONGEST_ROW = 160
IS_NATIVE = "(MSG, this is a program of LinuxCNC: it runs as it is)"


class Construct(NamedTuple):
    """Something that not every control has: its line and its text."""

    line: int
    text: str


def own_constructs(rows: Sequence[str]) -> Iterator[Construct]:
    """Yield what only LinuxCNC has, the first of each line."""
    for line, row in enumerate(rows, 1):
        text = _code_of(row)
        if found := O_WORD.match(text) or WORD.search(text):
            yield Construct(line, found[0])


def lacking_constructs(rows: Sequence[str]) -> Iterator[Construct]:
    """Yield what LinuxCNC lacks."""
    for line, row in enumerate(rows, 1):
        text = NAMED_PARAMETER.sub("", _code_of(row))
        if not O_WORD.match(text):
            codes = [code_of("G", number) for number in G_CODE.findall(text)]
            lacking = [code for code in codes if code not in CODES | OF_PACKAGE]
            yield from (Construct(line, text) for text in [*lacking, *MACRO.findall(text)])


def _code_of(row: str) -> str:
    return SPACE.sub("", row).upper()


def with_message(rows: Sequence[str]) -> str:
    """Return a program as it is, with a message behind the first of its lines that can have one."""
    lines = list(rows)
    for at, row in enumerate(lines):
        text = _code_of(row)
        taken = text.startswith(("%", "/")) or O_WORD.match(text) or ACTIVE.search(row)
        if not taken and ";" not in row and len(row) < LONGEST_ROW:
            lines[at] = f"{row.rstrip()} {IS_NATIVE}".lstrip()
            break
    return "\n".join([*lines, ""])
