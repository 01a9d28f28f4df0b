# SPDX-License-Identifier: GPL-2.0-or-later
"""Numbers in the units of LinuxCNC: lengths and feeds without a decimal point, times of G04."""

from decimal import Decimal

from g12.tools.translate.blocks.control import HOLE_MEANINGS
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord

LENGTH_WORDS = frozenset("XYZUVWIJKRQE")
ANGLE_WORDS = frozenset("ABC")
COUNTING = {  # words of turning cycles that count or name, or are read with their cycle
    "threading": "PQA",
    **dict.fromkeys(("finishing", "pecking along Z", "pecking along X", "thread pass"), "PQ"),
    **dict.fromkeys(("roughing along Z", "roughing along X", "thread"), "PQ"),
    **dict.fromkeys(HOLE_MEANINGS, "Q"),
}
UNIT = {"G20": "inch", "G21": "mm"}


def whole_units(draft: Draft) -> None:
    """Write every length, angle and feed with the value that it has on the control."""
    for at, word in enumerate(draft.words):
        kind = _quantity_of(draft, word) if word.lacks_point else ""
        if kind:
            draft.words[at] = in_units(draft, word, kind)
            if word.letter == "F":
                draft.change(feed=draft.words[at].value)


def _quantity_of(draft: Draft, word: ForeignWord) -> str:
    letter = word.letter
    if any(letter in COUNTING.get(name, "") for name in (*draft.meanings, draft.state.cycle)):
        return ""
    if letter == "R" and "P" in draft.letters() and "roughing along" in " ".join(draft.meanings):
        return ""  # the type of a Haas's contour
    if letter == "F":
        return "feed_rev" if draft.state.feed_mode == "G95" else "feed"
    cycles = {"drilling cycle", *HOLE_MEANINGS}
    is_cycle = bool(draft.state.cycle) or not cycles.isdisjoint(draft.meanings)
    if letter in "IJK" and is_cycle and {"G2", "G3"}.isdisjoint(draft.codes()):
        return ""  # K counts there, the others are refused
    if letter == "H" and "G43" in draft.codes():
        return ""
    if letter in "HC" and draft.control.is_lathe:
        return "length" if draft.state.polar == "on" else "angle"
    if letter in ANGLE_WORDS:
        return "angle"
    return "length" if letter in LENGTH_WORDS else ""


def in_units(draft: Draft, word: ForeignWord, kind: str) -> ForeignWord:
    if float(word.value) == 0:
        return word
    least = least_increment(draft, kind)
    rule = "least" if _is_increment(draft, word) else draft.control.decimals
    if rule == "whole" or least == 1:
        return word
    text = f"{Decimal(word.value) * Decimal(str(least)):f}" if least else "a least increment"
    if rule == "":
        raise NotTranslated(
            f"{word.text} has no decimal point: is it {text} or {word.value}.? write --decimals "
            f"least, or whole, behind --control {draft.control.name}, in the [FILTER] line too"
        )
    if not least:
        raise NotTranslated(
            f"{word.text} has no decimal point: what it is then depends on G20 or G21, and neither "
            "is programmed before it (--units)"
        )
    return word._replace(value=text if "." in text else f"{text}.")


def _is_increment(draft: Draft, word: ForeignWord) -> bool:
    """Whether a word of a drilling cycle is in least increments whatever ``decimals`` says."""
    drills = draft.state.cycle or "drilling cycle" in draft.meanings
    return bool(drills) and word.letter == "Q" and draft.control.value("holes", "q") == "increments"


def least_increment(draft: Draft, kind: str) -> float:
    """Return the increment of a class in the units of the block; 0 if none is set."""
    if kind == "angle":
        return float(draft.control.value("increments", kind, 0))
    unit = UNIT.get(draft.sure("units", "a number has no decimal point"))
    if unit:
        return float(draft.control.value("increments", f"{kind}_{unit}", 0))
    both = {float(draft.control.value("increments", f"{kind}_{u}", 0)) for u in ("mm", "inch")}
    return both.pop() if len(both) == 1 else 0.0


def dwell(draft: Draft, code: ForeignWord) -> None:
    seconds = draft.control.value("dwell", "seconds")
    milliseconds = draft.control.value("dwell", "milliseconds")
    times = draft.take_each(seconds + milliseconds)
    if len(times) != 1:
        known = " or ".join(seconds + milliseconds)
        raise NotTranslated(f"{code.code} needs its time as {known}, once")
    (time,) = times
    written = time_in_seconds(draft, time, time.letter in milliseconds)
    draft.words += [ForeignWord("G", "4"), written]


def time_in_seconds(draft: Draft, word: ForeignWord, thousandths: bool) -> ForeignWord:
    is_number, decimals = word.kind == "number", draft.control.decimals
    if is_number and word.number < 0:
        raise NotTranslated(f"{word.text}: a time below 0")
    if thousandths and is_number and not word.lacks_point:
        thousandths = False
        if draft.control.value("dwell", "with_point", "refuse") != "seconds":
            raise NotTranslated(f"{word.text}: milliseconds have no decimal point on this control")
    elif not thousandths and word.lacks_point and word.number:
        thousandths = decimals == "least"
        if not decimals:
            raise NotTranslated(
                f"{word.text} has no decimal point: thousandths or seconds? set decimals "
                "(--decimals)"
            )
    value = word.value
    if thousandths:
        value = f"{Decimal(value) / 1000:f}" if is_number else f"[[{value}] / 1000]"
    return word._replace(letter="P", value=value)
