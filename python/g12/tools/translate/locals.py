# SPDX-License-Identifier: GPL-2.0-or-later
"""Local variables of macros: one that no call gives and no line sets is empty on the control.

There an empty variable makes its word vanish; LinuxCNC takes 0. So such a macro is refused.
"""

from __future__ import annotations

from collections.abc import Iterator

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.lexer import ForeignBlock
from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.rules.subprograms import ARGUMENTS

LETTERS = {number: letter for letter, number in ARGUMENTS.items()}


def unset_locals(followed: FollowedProgram) -> Iterator[tuple[int, str]]:
    """Yield line and sentence for each block that reads a variable nothing has set."""
    given = {n: given_by_all(calls) for n, calls in followed.calls.items()}
    for index, block in enumerate(followed.structure.blocks):
        number = followed.program_of(index)
        if followed.kinds.get(number) != "macro" or not followed.drafts[index]:
            continue
        for variable in sorted(read_by(block) - given[number]):
            yield block.line, unset_sentence(number, variable)
        given[number] |= {set_by(block)}


def given_by_all(calls: list[Draft]) -> set[int]:
    """Return the variables that every call of a macro gives."""
    found = [{variable for variable, _ in draft.call.arguments} for draft in calls]
    return set.intersection(*found)


def read_by(block: ForeignBlock) -> set[int]:
    """Return the local variables that a block reads."""
    read = set().union(*(word.read for word in block.words))
    for part in (block, block.then):
        read |= part.expression.read if part and part.expression else set()
    return read


def set_by(block: ForeignBlock) -> int:
    """Return the variable that a block sets whatever happens, 0 if none."""
    return block.variable if block.kind == "assign" and not block.skipped else 0


def unset_sentence(number: int, variable: int) -> str:
    """Return what is wrong."""
    letter = LETTERS.get(variable)
    name = f"#{variable} ({letter} of the call)" if letter else f"#{variable}"
    return f"O{number} reads {name}, which not every G65 P{number} gives: it would be 0 on LinuxCNC"
