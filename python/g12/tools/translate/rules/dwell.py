# SPDX-License-Identifier: GPL-2.0-or-later
"""G04: the time in seconds, whatever letter and unit the control has for it."""

from decimal import Decimal

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord


def dwell(draft: Draft, code: ForeignWord) -> None:
    """Write a dwell as ``G4 P`` with seconds."""
    seconds = draft.control.value("dwell", "seconds")
    milliseconds = draft.control.value("dwell", "milliseconds")
    times = [word for letter in seconds + milliseconds if (word := draft.take(letter))]
    if len(times) != 1:
        known = " or ".join(seconds + milliseconds)
        raise NotTranslated(f"{code.code} needs its time as {known}, once")
    (time,) = times
    written = time_in_seconds(draft, time, time.letter in milliseconds)
    draft.words += [ForeignWord("G", "4"), written]


def time_in_seconds(draft: Draft, word: ForeignWord, thousandths: bool) -> ForeignWord:
    """Return the P word of a time."""
    if word.kind == "number" and word.number < 0:
        raise NotTranslated(f"{word.text}: a time below 0")
    if thousandths:
        if "." in word.value and word.kind == "number":
            return with_point(draft, word)
        return _divided(word)
    if word.kind == "number" and "." not in word.value and word.number:
        return _without_point(draft, word)
    return word._replace(letter="P")


def with_point(draft: Draft, word: ForeignWord) -> ForeignWord:
    """Return milliseconds that are written with a decimal point."""
    if draft.control.value("dwell", "with_point", "refuse") != "seconds":
        raise NotTranslated(f"{word.text}: milliseconds have no decimal point on this control")
    return word._replace(letter="P")


def _without_point(draft: Draft, word: ForeignWord) -> ForeignWord:
    if not draft.control.decimals:
        raise NotTranslated(
            f"{word.text} has no decimal point: thousandths or seconds? set decimals (--decimals)"
        )
    return _divided(word) if draft.control.decimals == "least" else word._replace(letter="P")


def _divided(word: ForeignWord) -> ForeignWord:
    if word.kind == "expression":
        return word._replace(letter="P", value=f"[[{word.value}] / 1000]")
    return word._replace(letter="P", value=f"{Decimal(word.value) / 1000:f}")
