# SPDX-License-Identifier: GPL-2.0-or-later
"""Local variables of macros that may be empty.

A local variable that no call gives and no line sets is empty on the control, and its word vanishes;
LinuxCNC takes 0. Such a macro is refused, and elsewhere a word whose variable nothing sets before it.
"""

from collections.abc import Iterator

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.expressions import LOCAL_VARIABLES
from g12.tools.translate.follow import FollowedProgram
from g12.tools.translate.rules.subprograms import ARGUMENTS

ARGUMENT_LETTERS = {number: letter for letter, number in ARGUMENTS.items()}


def unset_locals(followed: FollowedProgram) -> Iterator[tuple[int, str]]:
    """Yield line and sentence for each block that reads a variable which may be empty."""
    for number, draft in zip(followed.structure.programs, followed.drafts):
        if draft:
            is_macro = followed.kinds.get(number) == "macro"
            yield from _unset_in_macro(draft, number) if is_macro else _never_set(draft)


def _unset_in_macro(draft: Draft, number: int) -> Iterator[tuple[int, str]]:
    block = draft.block
    for variable in sorted(block.read.intersection(LOCAL_VARIABLES) - draft.start.given):
        yield block.line, _unset_sentence(number, variable)


def _never_set(draft: Draft) -> Iterator[tuple[int, str]]:
    """Yield the words outside macros that are a local variable which nothing sets before."""
    block = draft.block
    for word in block.words:
        for number in word.read.intersection(LOCAL_VARIABLES) - draft.start.touched:
            if word.value.lstrip("-") == f"#{number}":
                sentence = f"{word.text}: nothing sets #{number} before, LinuxCNC takes 0"
                yield block.line, sentence


def _unset_sentence(number: int, variable: int) -> str:
    letter = ARGUMENT_LETTERS.get(variable)
    name = f"#{variable} ({letter} of the call)" if letter else f"#{variable}"
    return f"O{number} reads {name}, which not every G65 P{number} gives: it would be 0 on LinuxCNC"
