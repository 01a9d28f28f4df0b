# SPDX-License-Identifier: GPL-2.0-or-later
"""G and M codes by their meanings in the control's file; modes; words that no rule has read."""

from collections.abc import Mapping
from typing import Any

from g12.tools.translate.blocks.control import MEANINGS, PLACES
from g12.tools.translate.blocks.draft import AXIS_NUMBERS, PARTNERS, Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    GROUP_OF,
    REFERENCES,
    UNKNOWN,
)
from g12.tools.translate.rules.motion import cancel_length

RULES = frozenset((*MEANINGS["G"], *MEANINGS["M"]))
BUILDERS = frozenset(("machine", *PLACES))
INSIDE = {"on": "UH", "cylinder": "UWH"}  # what polar mode and a cylinder have besides
BLOCK_LETTERS = frozenset("NGMFSTDHIJKLPQR$")
MACHINES_OWN = REFERENCES | {"G53"}
SECTION_ENDS = {"polar on": "on", "polar off": "off"}


def keep_as_comments(draft: Draft) -> None:
    """Make comments of the codes that need nothing done, and of the words that are theirs."""
    for word in [word for word in draft.words if word.code]:
        meaning, *letters = draft.control.meanings.get(word.code, "").split(" ")
        if meaning != "comment" or draft.control.is_machines(word.code):
            continue
        own = [w for w in draft.words if w.letter in letters]
        draft.drop([word, *own])
        draft.comments.append(" ".join([word.code, *(w.text for w in own)]))


def map_codes(draft: Draft) -> None:
    """Replace every code, keep it, hand it to its rule, or refuse it."""
    _refuse_two_of_builders(draft)
    named: Mapping[str, Any] = draft.control.tables.get("words", {})
    live = _speed_by_p(draft)
    words: list[ForeignWord] = []
    for word in draft.words:
        if word.letter in "GM":
            words += mapped(draft, word)
        else:
            words.append(word._replace(letter=named.get(word.letter, word.letter)))
    draft.words = [*words, *live]


def _speed_by_p(draft: Draft) -> list[ForeignWord]:
    """Take a code whose P is a speed out, ``M133 P1500``; return LinuxCNC's words for it."""
    meanings = draft.control.meanings
    word = next((w for w in draft.words if "S=P" in meanings.get(w.text, "")), None)
    if not word or draft.control.is_machines(word.text):
        return []
    draft.drop([word])
    speed = draft.take("P")
    meaning = meanings[word.text].replace("S=P", f"S{speed.value}" if speed else "")
    return _own_words(draft, word, meaning)


def _own_words(draft: Draft, code: ForeignWord, meaning: str) -> list[ForeignWord]:
    """Return LinuxCNC's words for a code; the first spindle has no ``$``."""
    words = {"$live": "", "$all": "$-1" if draft.control.live_spindle not in ("", "0") else ""}
    if "$live" in meaning:
        words["$live"] = live_spindle(draft, code)
    return [word_of(text) for one in meaning.split() if (text := words.get(one, one))]


def live_spindle(draft: Draft, code: ForeignWord) -> str:
    """Return the ``$`` word of the spindle that drives the tool, "" for the first spindle."""
    live = draft.control.live_spindle
    if not live:
        raise NotTranslated(
            f"{code.text} is the live tool's: say [G12] LIVE_SPINDLE in the INI, LinuxCNC's "
            "spindle that drives the tool (install --with programs-… sets it)"
        )
    return f"${live}" if live != "0" else ""


def _refuse_two_of_builders(draft: Draft) -> None:
    codes = [w.code for w in draft.words if w.code[:1] == "M" and is_own(draft, w)]
    if len(codes) > 1:
        raise NotTranslated(f"{codes[0]} and {codes[1]} in one block: give one a block of its own")


def is_own(draft: Draft, word: ForeignWord) -> bool:
    """Whether a code is one that the machine has besides LinuxCNC's."""
    meaning = draft.control.meanings.get(word.code, "")
    known = draft.control.is_machines(word.code) or draft.control.is_machines(meaning)
    return (known and meaning not in RULES) or meaning in BUILDERS


def mapped(draft: Draft, word: ForeignWord) -> list[ForeignWord]:
    if word.kind != "number":
        raise NotTranslated(f"{word.letter}{word.value}: a code must be a number")
    code, control = word.code, draft.control
    meaning = control.meanings.get(code, "")
    if meaning in RULES:
        if meaning in draft.meanings:
            raise NotTranslated(f"{draft.meanings[meaning].code} and {code} in one block")
        draft.meanings[meaning] = word
        return []
    if meaning == "same" or control.is_machines(code):
        return [word]
    if meaning in BUILDERS and control.on_machine:
        raise NotTranslated(
            f"{code} is the machine builder's, and this machine has neither a REMAP line nor "
            f"a file for it: say under [m_codes] of your control what it does"
        )
    if meaning.startswith("refuse: "):
        raise NotTranslated(f"{code}: {meaning.removeprefix('refuse: ')}")
    if not meaning:
        table = f"[{code[0].lower()}_codes]"
        raise NotTranslated(f"{code} is not known of {control.name}: say under {table} what it is")
    return [word] if meaning in BUILDERS else _own_words(draft, word, meaning)


def follow_modes(draft: Draft) -> None:
    modes: dict[str, str] = {}
    for word in draft.words:
        if word.code in GROUP_OF:
            group = GROUP_OF[word.code]
            if group in modes:
                raise NotTranslated(
                    f"{modes[group]} and {word.code} in one block: give one a block of its own"
                )
            modes[group] = word.code
        elif word.letter == "F":
            modes["feed"] = word.value
    modes.pop("motion", None)
    if "distance" in modes:
        modes["own_distance"] = AS_PROGRAMMED
    if modes:
        draft.change(**modes)
    _follow_surface_speed(draft)


def keep_modes(draft: Draft) -> None:
    """Follow the modes of a refused block, or the next ones would be refused for another's."""
    for word in draft.block.words:
        meaning = draft.control.meanings.get(word.code, "")
        code = word.code if meaning == "same" else meaning
        if code in GROUP_OF:
            draft.change(**{GROUP_OF[code]: code})
        elif meaning in SECTION_ENDS:
            draft.change(polar=SECTION_ENDS[meaning])


def _follow_surface_speed(draft: Draft) -> None:
    word = draft.word("S")
    if word and draft.state.spindle_mode == "G96" and not draft.meanings:
        draft.change(surface=word.value)


def axes_at_zero(draft: Draft) -> None:
    """Keep words of an axis that the machine lacks as comments: it is always at their 0.

    CAM writes them for an axis that a job does not use. A block of nothing else does nothing: G28
    would move each axis without them.
    """
    control, increments = draft.control, draft.increments() if draft.control.is_lathe else []
    lacking = set(control.at_zero) - set(control.axes)
    words = [*draft.axis_words(), *increments]
    zeros = [w for w in words if PARTNERS.get(w.letter, w.letter) in lacking and w.is_zero]
    alone = bool(zeros) and len(zeros) == len(words)
    in_section = draft.state.polar != "off" or {"polar on", "cylinder"} & draft.meanings.keys()
    if in_section:
        return
    draft.drop(zeros)
    codes = draft.take_codes(MACHINES_OWN | {"G52"}) if alone else []
    if not REFERENCES.isdisjoint(codes):
        cancel_length(draft)
    draft.comments += [*codes, *(word.text for word in zeros)]


def radius_or_diameter(draft: Draft, code: ForeignWord) -> None:
    word = draft.take("X")
    modes = {"0": "G8", "1": "G7"}
    if not word or word.value.rstrip(".") not in modes or draft.axis_words():
        raise NotTranslated(f"{code.code} needs X0, radii, or X1, diameters, and no other axis")
    mode = modes[word.value.rstrip(".")]
    draft.put_first(mode)
    draft.change(x_words=mode, at_x=UNKNOWN)


def refuse_leftovers(draft: Draft) -> None:
    if draft.meanings:
        word = next(iter(draft.meanings.values()))
        raise NotTranslated(f"{word.code} cannot be in this block")
    letters: set[str] = set()
    for word in draft.words:
        if word.kind == "text" or word.letter in "GM":
            continue
        if word.letter in letters:
            raise NotTranslated(f"{word.letter} is given twice in this block")
        letters.add(word.letter)
        inside = word.letter in INSIDE.get(draft.state.polar, "")
        if word.letter in AXIS_NUMBERS and not inside:
            check_axis(draft, word)
        if word.letter not in BLOCK_LETTERS and word.letter not in AXIS_NUMBERS and not inside:
            raise NotTranslated(f"{word.text} is not understood in this block")


def check_axis(draft: Draft, word: ForeignWord) -> None:
    axes = draft.control.axes
    if word.letter in axes:
        return
    if draft.control.on_machine:
        raise NotTranslated(f"{word.text}: the INI's machine has the axes {axes}")
    raise NotTranslated(
        f"{word.text}: this control's machine has the axes {axes}; for another one say "
        f'axes = "{axes}{word.letter}" in a control of your own'
    )
