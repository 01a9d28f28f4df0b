# SPDX-License-Identifier: GPL-2.0-or-later
"""Subprograms and macros: calls, returns and statements as LinuxCNC's O-words, local variables.

LinuxCNC's own M98 P L, O100 and M99 do what M98 does on a macro control, #1 to #30 shared with the
caller. M98 Q calls a block of its own program, as M97 does. G65 starts with its letters as #1 to
#26 and gives the caller its own back: an O-word sub.

A local variable that no call gives and no line sets is empty on the control, and its word vanishes;
LinuxCNC takes 0. Such a macro is refused, and elsewhere a word whose variable nothing sets before.
"""

from collections.abc import Iterator

from g12.tools.translate.blocks.draft import Draft, SubprogramCall, line_as_word
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.expressions import LOCAL_VARIABLES, UNSIGNED
from g12.tools.translate.blocks.lexer import NO_JUMPS, ForeignWord
from g12.tools.translate.structure import LOCAL_BLOCKS, Structure, called_program

ARGUMENTS = dict(zip("ABCIJKDEFHMQRSTUVWXYZ", (*range(1, 10), 11, 13, *range(17, 27))))
ARGUMENT_LETTERS = {number: letter for letter, number in ARGUMENTS.items()}


def _called_number(draft: Draft, code: str, word: ForeignWord | None) -> int:
    if not word or word.kind != "number" or not word.value.isdigit():
        raise NotTranslated(f"{code} needs P and the number of a program of this file")
    return int(word.value)


def call_macro(draft: Draft) -> None:
    """Take the words of G65, M98, M97 and M99 out; the lines are written when the block is done."""
    if draft.meanings.pop("macro call", None):
        draft.call = _macro_call(draft)
    for meaning in ("subprogram", "local subprogram"):
        code = draft.meanings.pop(meaning, None)
        if code:
            draft.call = _subprogram_call(draft, code.code, meaning)
    if code := draft.meanings.pop("return", None):
        if word := draft.take("P"):
            raise NotTranslated(f"{code.code} {word.text}: {NO_JUMPS}")
        draft.returns = True


def _subprogram_call(draft: Draft, code: str, meaning: str) -> SubprogramCall:
    local = meaning == "local subprogram"
    start = None if local else draft.take("Q")
    if start and "P" in draft.letters():
        raise NotTranslated(f"{code} P with {start.text}: a program is called from its beginning")
    number = _called_number(draft, code, start or draft.take("P"))
    word = draft.take("L")
    count = word.value if word else ""
    if local or start:
        number += LOCAL_BLOCKS
    elif not count:
        number, count = called_program(number, draft.control, draft.programs)
    return SubprogramCall(number, "sub", count)


def _macro_call(draft: Draft) -> SubprogramCall:
    number, times = _called_number(draft, "G65", draft.take("P")), draft.take("L")
    arguments: dict[int, str] = {}
    for word in draft.words:
        if word.letter == "N":
            continue
        if word.letter not in ARGUMENTS or word.kind == "bare":
            raise NotTranslated(f"{word.text} cannot be an argument of G65")
        if ARGUMENTS[word.letter] in arguments:
            raise NotTranslated(f"{word.letter} is given twice: LinuxCNC has one variable for it")
        plain = word.lacks_point and word.number and word.letter not in "DHMST"
        if plain and draft.control.decimals != "whole":
            raise NotTranslated(f"{word.text} has no decimal point: write {word.text}. in G65")
        arguments[ARGUMENTS[word.letter]] = word.value
    draft.words = [word for word in draft.words if word.letter == "N"]
    return SubprogramCall(
        number, "macro", times.value if times else "", tuple(sorted(arguments.items()))
    )


def finish_call(draft: Draft) -> None:
    """Write the lines of a call or a return after the block's other words."""
    lines = _call_lines(draft) if draft.call else []
    if draft.returns:
        lines.append(draft.return_text)
    if not lines:
        return
    if draft.is_empty() and lines[0].startswith("o"):  # a block number becomes a comment
        draft.comments += [word.text for word in draft.words]
        draft.words = []
    draft.write(lines)


def _call_lines(draft: Draft) -> list[str]:
    call = draft.call
    if call.kind == "sub":
        return [f"M98 P{call.number}{f' L{call.repeats}' if call.repeats else ''}"]
    given = dict(call.arguments)
    values = "".join(f" [{given.get(n, '0')}]" for n in range(1, max(given, default=0) + 1))
    line = f"o<macro_{call.number}> call{values}"
    if not call.repeats:
        return [line]
    label = f"o<again_{draft.index}>"
    return [f"{label} repeat [{call.repeats}]", line, f"{label} endrepeat"]


# ---------------------------------------------------------------- statements


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
}


def unset_variables(draft: Draft, macro: int) -> Iterator[str]:
    """Yield a sentence for each variable that a block reads and that may be empty.

    ``macro`` is the number of the block's program where G65 calls it, else 0.
    """
    block = draft.block
    if macro:
        for number in sorted(block.read.intersection(LOCAL_VARIABLES) - draft.start.given):
            letter = ARGUMENT_LETTERS.get(number)
            named = f" ({letter} of the call)" if letter else ""
            yield (
                f"O{macro} reads #{number}{named}, which not every G65 P{macro} gives: it would "
                "be 0 on LinuxCNC"
            )
        return
    for word in block.words:
        for number in word.read.intersection(LOCAL_VARIABLES) - draft.start.touched:
            if word.value.lstrip("-") == f"#{number}":
                yield f"{word.text}: nothing sets #{number} before, LinuxCNC takes 0"
