# SPDX-License-Identifier: GPL-2.0-or-later
"""Modes that a block sets, and the words that no rule has read."""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, PARTNERS, Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    GROUP_OF,
    MOTIONS,
    REFERENCES,
    UNKNOWN,
)
from g12.tools.translate.rules.reference import cancel_length

INSIDE = {"on": "UH", "cylinder": "UWH"}  # what polar mode and a cylinder have besides
BLOCK_LETTERS = frozenset("NGMFSTDHIJKLPQR$")
MACHINES_OWN = REFERENCES | {"G53"}
SECTION_ENDS = {"polar on": "on", "polar off": "off"}
ORIGIN_MEANINGS = ("offset by program", "speed limit or origin")


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
    would move each axis without them, a drilling cycle would not be repeated.
    """
    control, increments = draft.control, draft.increments() if draft.control.is_lathe else []
    lacking = set(control.at_zero) - set(control.axes)
    words = [*draft.axis_words(), *increments]
    zeros = [w for w in words if PARTNERS.get(w.letter, w.letter) in lacking and w.is_zero]
    alone = bool(zeros) and len(zeros) == len(words)
    in_section = draft.state.polar != "off" or {"polar on", "cylinder"} & draft.meanings.keys()
    if in_section or (alone and _repeats_cycle(draft)):
        return
    draft.drop(zeros)
    if alone:
        _drop_codes_of_axes(draft)
    draft.comments += [word.text for word in zeros]


def _repeats_cycle(draft: Draft) -> bool:
    ended = "cancel cycle" in draft.meanings or not MOTIONS.isdisjoint(draft.codes())
    return bool(draft.state.cycle) and not ended


def _drop_codes_of_axes(draft: Draft) -> None:
    """Keep the codes as comments that would have nothing to act on, or another axis."""
    codes = draft.take_codes(MACHINES_OWN | {"G52"})
    draft.comments += codes
    if not REFERENCES.isdisjoint(codes):
        cancel_length(draft)
    for meaning in ORIGIN_MEANINGS:
        if meaning in draft.meanings and draft.letters().isdisjoint("RS"):
            words = [draft.meanings.pop(meaning), *draft.take_each("LP")]
            draft.comments.append(" ".join(word.text for word in words))


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
