# SPDX-License-Identifier: GPL-2.0-or-later
"""Calls and returns: M98 and M97 as LinuxCNC's numbered programs, G65 as an O-word with arguments.

LinuxCNC's own M98 P L, O100 and M99 do what M98 does on a macro control, #1 to #30 shared with the
caller. M98 Q calls a block of its own program, as M97 does. G65 starts with its letters as #1 to
#26 and gives the caller its own back: an O-word sub.
"""

from collections.abc import Container

from g12.tools.translate.blocks.control import Control
from g12.tools.translate.blocks.draft import Draft, SubprogramCall, line_as_word
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import NO_JUMPS, ForeignWord

ARGUMENTS = dict(zip("ABCIJKDEFHMQRSTUVWXYZ", (*range(1, 10), 11, 13, *range(17, 27))))
LOCAL_BLOCKS = 100_000_000  # a block called by M97 P100 is program O100000100


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


def called_program(number: int, control: Control, programs: Container[int]) -> tuple[int, str]:
    """Return the program that M98 P calls and how often: P51001 can be O1001 five times."""
    digits = control.value("subprograms", "repeat_digits", False)
    if digits and number > 9999 and number not in programs:
        return number % 10000, str(number // 10000)
    return number, ""


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
    if draft.is_empty():
        number = draft.written()
        first, *rest = lines
        keeps = number and not first.startswith("o")
        draft.words = [line_as_word(f"{number} {first}" if keeps else first)]
        draft.comments += [number] if number and not keeps else []
        draft.after = rest
    else:
        draft.after += lines


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
