# SPDX-License-Identifier: GPL-2.0-or-later
"""Macro statements as LinuxCNC's O-words, and local variables of macros that may be empty.

A local variable that no call gives and no line sets is empty on the control, and its word vanishes;
LinuxCNC takes 0. Such a macro is refused, and elsewhere a word whose variable nothing sets before.
"""

from collections.abc import Iterator

from g12.tools.translate.blocks.draft import Draft, line_as_word
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.expressions import LOCAL_VARIABLES, UNSIGNED
from g12.tools.translate.rules.subprograms import ARGUMENTS
from g12.tools.translate.structure import Structure

ARGUMENT_LETTERS = {number: letter for letter, number in ARGUMENTS.items()}


def _tape(draft: Draft, structure: Structure) -> None:
    draft.comments.insert(0, f"%{draft.block.label}")


def _assign(draft: Draft, structure: Structure) -> None:
    block, text = draft.block, draft.block.expression.text
    value = text if UNSIGNED.fullmatch(text) else f"[{text}]"
    draft.words = [*block.words, line_as_word(f"#{block.variable}={value}")]
    if not block.skipped:
        draft.state = draft.state.giving(frozenset((block.variable,)))


def _opening(draft: Draft, structure: Structure) -> None:
    _refuse_skipped_loop(draft)
    kind = draft.block.kind
    _labelled(draft, f"o<{kind}_{draft.index}> {kind} {draft.block.expression.text}")


def _closing(draft: Draft, structure: Structure) -> None:
    _refuse_skipped_loop(draft)
    start = structure.partners[draft.index]
    kind = structure.blocks[start].kind
    _labelled(draft, f"o<{kind}_{start}> end{kind}")


def _stop(draft: Draft, structure: Structure) -> None:
    """Write #3000, an alarm, or #3006, a stop, with the comment as its text."""
    message = ", ".join(draft.comments) or "stopped by the program"
    draft.comments = []
    text = f"M0 (MSG, {message})" if draft.block.label == "3006" else f"(ABORT, {message})"
    draft.words = [*draft.block.words, line_as_word(text)]


def _labelled(draft: Draft, text: str) -> None:
    """Write an O-word; a block number before it becomes a comment."""
    draft.comments = [*(word.text for word in draft.block.words), *draft.comments]
    draft.words = [line_as_word(text)]


def _refuse_skipped_loop(draft: Draft) -> None:
    if draft.block.skipped and draft.block.kind in ("while", "end"):
        raise NotTranslated("the head or the end of a loop cannot be skipped with /")


STATEMENTS = {
    "tape": _tape,
    "assign": _assign,
    "while": _opening,
    "end": _closing,
    "if": _opening,
    "endif": _closing,
    "stop": _stop,
}


def unset_variables(draft: Draft, macro: int) -> Iterator[str]:
    """Yield a sentence for each variable that a block reads and that may be empty.

    ``macro`` is the number of the block's program where G65 calls it, else 0.
    """
    block = draft.block
    if macro:
        for number in sorted(block.read.intersection(LOCAL_VARIABLES) - draft.start.given):
            letter = f" ({ARGUMENT_LETTERS[number]} of the call)" * (number in ARGUMENT_LETTERS)
            yield (
                f"O{macro} reads #{number}{letter}, which not every G65 P{macro} gives: it would "
                "be 0 on LinuxCNC"
            )
        return
    for word in block.words:
        for number in word.read.intersection(LOCAL_VARIABLES) - draft.start.touched:
            if word.value.lstrip("-") == f"#{number}":
                yield f"{word.text}: nothing sets #{number} before, LinuxCNC takes 0"
