# SPDX-License-Identifier: GPL-2.0-or-later
"""What only a whole program shows: that it is LinuxCNC's own, its G code system, mixed numbers.

LinuxCNC runs a program as it is that has what only LinuxCNC has: its O-words, named parameters,
G64 P, G33.1 and G38.2 to G38.5; and nothing that it lacks: other codes than its own and the
package's, and the statements of macro controls.

Many programs of G code system A have the modes of B besides: G90 G18 at their head, G91 and G95,
with G50 S and U W. G91 and G95 are no codes of A, so such a program is certain: G90, G91, G94 and
G95 are modes in it, if no G90 or G94 in it can be a cycle, and no G98 or G99 has two meanings.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.lexer import ForeignBlock, code_of
from g12.tools.translate.blocks.modal import MOTIONS

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
LACKING = ("G91", "G95")  # in system A
CYCLES = frozenset(("G90", "G94"))
FEED_MODES = (frozenset(("G94", "G95")), frozenset(("G98", "G99")))
OF_SYSTEM_B = frozenset(("G33", "G77", "G78", "G79"))
AXES = "XYZ"
OF_CYCLES = frozenset("XZUW")


def own_constructs(rows: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Yield line and text of what only LinuxCNC has, the first of each line."""
    for line, row in enumerate(rows, 1):
        text = _code_of(row)
        if found := O_WORD.match(text) or WORD.search(text):
            yield line, found[0]


def lacking_constructs(rows: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Yield line and text of what LinuxCNC lacks."""
    for line, row in enumerate(rows, 1):
        text = NAMED_PARAMETER.sub("", _code_of(row))
        if not O_WORD.match(text):
            codes = [code_of("G", number) for number in G_CODE.findall(text)]
            lacking = [code for code in codes if code not in CODES | OF_PACKAGE]
            yield from ((line, text) for text in [*lacking, *MACRO.findall(text)])


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


def control_of_program(control: Control, blocks: Sequence[ForeignBlock]) -> Control:
    """Return a control with what the program shows, and the messages about that."""
    notes = list(_mixed_numbers(control, blocks)) if control.decimals else []
    modes = _modes_of_b(control, blocks)
    if modes:
        notes.append(f"(MSG, {', '.join(modes)} are modes in this program, not cycles)")
        control = replace(control, meanings={**control.meanings, **dict.fromkeys(modes, "same")})
    return replace(control, notes=tuple(notes))


def _modes_of_b(control: Control, blocks: Sequence[ForeignBlock]) -> list[str]:
    """Return the codes that are modes in a program of system A, none where that is not certain."""
    lacking = {code for code in LACKING if control.meanings.get(code, "").startswith("refuse: ")}
    used: set[str] = set()
    for block in blocks:
        codes, letters = {w.code for w in block.words}, {w.letter for w in block.words}
        used |= codes
        cuts = codes & CYCLES and letters & OF_CYCLES and not codes & MOTIONS
        if cuts or ("G92" in codes and "S" in letters):
            return []
    is_a = control.meanings.get("G90") == "turning pass" and not used & OF_SYSTEM_B
    is_certain = is_a and used & lacking and not all(used & modes for modes in FEED_MODES)
    return sorted(CYCLES | lacking) if is_certain else []


def _mixed_numbers(control: Control, blocks: Sequence[ForeignBlock]) -> Iterator[str]:
    """Yield a message for each axis that has numbers with a decimal point and without."""
    lines: dict[tuple[str, bool], int] = {}
    for block in blocks:
        if not any(control.meanings.get(word.code) == "dwell" for word in block.words):
            for word in block.words:
                if word.letter in AXES and word.kind == "number" and not word.is_zero:
                    lines.setdefault((word.letter, word.lacks_point), block.line)
    for axis in AXES:
        with_point, without = (lines.get((axis, lacks)) for lacks in (False, True))
        if with_point and without:
            yield (
                f"(MSG, {axis} has a decimal point in line {with_point}, none in line {without}: "
                "look at both)"
            )
