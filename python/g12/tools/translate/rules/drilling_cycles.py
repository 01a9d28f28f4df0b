# SPDX-License-Identifier: GPL-2.0-or-later
"""Drilling cycles of mills, G73 and G81 to G89.

LinuxCNC gets the words that the control stores:

- L0 (or K0) only stores the cycle; without R the tool's Z level is R
- levels given under G90 hold under G91 as they are, and the other way round
- a new cycle code keeps the words of an earlier one; dwell is in the control's unit
- G80 beside a motion is the motion
"""

from g12.tools.translate.blocks.draft import Draft, position, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    CONSUMERS,
    IN_CYCLE,
    MOTIONS,
    UNKNOWN,
    UNSURE,
)
from g12.tools.translate.rules.decimals import time_in_seconds

KEPT = "ZRQP"
ALONE = frozenset("NXYMSTF")  # words of a hole of whatever cycle is on
NEEDS = {"G73": "Q", "G83": "Q", "G82": "P", "G86": "P", "G89": "P"}


def drilling_cycle(draft: Draft) -> None:
    if draft.control.is_lathe:
        return
    cancelled = draft.meanings.pop("cancel cycle", None)
    code = draft.meanings.pop("drilling cycle", None)
    if cancelled:
        _cancel(draft)
    if code:
        _begin(draft, code.code)
    elif draft.state.cycle and set(draft.codes()) & (MOTIONS | CONSUMERS):
        draft.change(cycle=UNKNOWN, cycle_words=())
    elif draft.state.cycle and draft.letters() & set("XYZR"):
        if draft.state.cycle == UNSURE:
            _drill_as_before(draft)
        else:
            _drill(draft, draft.state.cycle, _stored_words(draft))


def _drill_as_before(draft: Draft) -> None:
    """Leave a hole to the cycle that LinuxCNC is in, such as the caller's of a subprogram."""
    in_cycle = draft.state.own_motion == IN_CYCLE and draft.state.own_distance == AS_PROGRAMMED
    if not in_cycle or draft.letters() - ALONE:
        raise NotTranslated(
            "a drilling cycle is on, but not the same one on every way to this block: here X and Y "
            "alone, and each way drills its first hole with the cycle, not by L0"
        )


def _cancel(draft: Draft) -> None:
    """G80: leave it to the motion code beside it, or to the one that is needed next."""
    moving = set(draft.codes()) & MOTIONS or draft.axis_words()
    own = draft.state.own("motion") if moving else "G80"
    draft.change(cycle=UNKNOWN, cycle_words=(), own_motion=own)
    if moving:
        draft.comments.append("G80")
    else:
        draft.put_first("G80")


def _begin(draft: Draft, code: str) -> None:
    motions = draft.take_codes(MOTIONS)
    if motions:
        draft.change(motion=motions[0])
    given = {word.letter for word in draft.words}
    is_complete = draft.state.cycle_words == UNSURE and given >= {"Z", "R", *NEEDS.get(code, "")}
    kept = {} if is_complete else _stored_words(draft)
    draft.change(cycle=code)
    _drill(draft, code, kept)


def _stored_words(draft: Draft) -> dict[str, str]:
    """Return the stored words by letter; ``@`` is the distance mode they were given in."""
    words = draft.state.cycle_words
    if words == UNSURE:
        raise NotTranslated(
            "a drilling cycle is not given the same on every way to this block: write it in here"
        )
    return dict(words)


def _drill(draft: Draft, code: str, kept: dict[str, str]) -> None:
    distance = draft.sure("distance", f"{code} has Z and R")
    seconds_of_dwell(draft)
    given = {word.letter: word.value for word in draft.words if word.letter in KEPT}
    under = kept.pop("@", distance)
    values = {**kept, **given}
    _check_words(draft, code, values)
    repeats = repeats_of(draft)
    if {"Z", "R"} <= given.keys():
        under = distance
    if under != distance:
        _positions_under(draft, code, given, under)
    if repeats == "0":
        _store(draft, code)
    else:
        _write_cycle(draft, code, values, given, under)
        _repeat(draft, repeats)
    draft.change(cycle_words=tuple(sorted({"R": UNKNOWN, **values, "@": under}.items())))


def _positions_under(draft: Draft, code: str, given: dict[str, str], under: str) -> None:
    """Write the positions of holes in the distance mode in which the levels were given."""
    if given.keys() & {"Z", "R"}:
        raise NotTranslated(f"G90 or G91 changed within {code}: write both Z and R again")
    for word in draft.axis_words():
        here = position(word.letter)
        value = f"[{here} + {word.value}]" if under == "G90" else f"[{word.value} - {here}]"
        draft.replace(word, word._replace(value=value, kind="expression"))
    draft.take_codes({"G90", "G91"})
    draft.change(own_distance=under)
    draft.is_settled = True


def _repeat(draft: Draft, times: str) -> None:
    """Write how often: by L, or by a loop where LinuxCNC's L would stay in one place."""
    if times and draft.is_settled:
        label = f"o<again_{draft.index}>"
        draft.before.insert(0, f"{label} repeat [{times}]")
        draft.after.append(f"{label} endrepeat")
    elif times:
        draft.words.append(word_of(f"L{times}"))


def seconds_of_dwell(draft: Draft) -> None:
    unit = draft.control.value("dwell", "cycle", "refuse")
    if word := draft.word("P"):
        if unit == "refuse":
            raise NotTranslated(f"{word.text}: [dwell] cycle does not say the unit of a cycle's P")
        draft.replace(word, time_in_seconds(draft, word, unit == "milliseconds"))


def _check_words(draft: Draft, code: str, values: dict[str, str]) -> None:
    if "Z" not in values:
        raise NotTranslated(f"{code} without Z, and no depth before it")
    if NEEDS.get(code) == "Q" and "Q" not in values:
        raise NotTranslated(f"{code} needs Q, the depth of a peck")
    odd = draft.letters() & set("IJKUVWABC") - set(repeat_letters(draft))
    if odd:
        raise NotTranslated(f"{code} with {min(odd)} is not translated: only Z, R, Q, P, F and L")


def repeats_of(draft: Draft) -> str:
    """Return how often the cycle is repeated, "" if that is not said."""
    words = draft.take_each(repeat_letters(draft))
    if not words:
        return ""
    word = words[0]
    if len(words) > 1:
        raise NotTranslated(f"{word.text} and {words[1].text}: one of them says how often")
    if word.kind != "number" or not word.value.isdigit():
        raise NotTranslated(f"{word.text}: how often a cycle is repeated must be a whole number")
    return str(int(word.value))


def repeat_letters(draft: Draft) -> str:
    return draft.control.value("subprograms", "cycle_repeat", "L")


def _store(draft: Draft, code: str) -> None:
    if draft.letters() & set("XY"):
        raise NotTranslated(
            f"{code} with L0 only stores the cycle: move to X and Y in another block"
        )
    stored = [word for word in draft.words if word.letter in KEPT]
    draft.drop(stored)
    draft.comments.append(" ".join([code, *(word.text for word in stored), "for the next holes"]))
    draft.change(own_motion=UNSURE)


def _write_cycle(
    draft: Draft, code: str, values: dict[str, str], given: dict[str, str], distance: str
) -> None:
    """Write a block that drills, complete unless LinuxCNC is in the same cycle already."""
    used = f"ZR{NEEDS.get(code, '')}"
    for letter in given:
        if letter not in used:
            draft.comment_out(letter)
    if draft.state.own_motion != IN_CYCLE or draft.start.cycle != code:
        for letter in used:
            if letter not in given and values.get(letter):
                draft.words.append(ForeignWord(letter, values[letter]))
        if not values.get("R"):
            _write_level_as_r(draft, distance)
        if "P" in used and "P" not in values:
            draft.words.append(word_of("P0"))
        draft.put_first(code)
    draft.change(own_motion=IN_CYCLE)


def _write_level_as_r(draft: Draft, distance: str) -> None:
    if draft.sure("plane", "a cycle without R") not in ("G17", UNKNOWN):
        raise NotTranslated("a cycle without R in another plane than G17")
    draft.words.append(ForeignWord("R", "0" if distance == "G91" else position("Z"), "expression"))
