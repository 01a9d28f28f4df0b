# SPDX-License-Identifier: GPL-2.0-or-later
"""Modes that a block sets, and the words that no rule has read."""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, PARTNERS, Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, GROUP_OF, REFERENCES, UNKNOWN

INSIDE = {"on": "UH", "cylinder": "UWH"}  # what polar mode and a cylinder have besides
BLOCK_LETTERS = frozenset("NGMFSTDHIJKLPQR$")
MACHINES_OWN = REFERENCES | {"G53"}


def zero_of_missing_axis(draft: Draft) -> None:
    """Drop ``A0`` on a machine without A: CAM writes it for a fourth axis that is not used.

    A lathe's A and C beside X or Z are an angle and a chamfer, so this is for a machine with Y.
    A block keeps the word where it would mean another thing without it, as G28 does.
    """
    axes = draft.control.axes
    words = [w for w in draft.axis_words() if w.letter not in axes and w.letter in "ABC"]
    zeros = [word for word in words if word.is_zero]
    if "Y" not in axes or not zeros or draft.meanings:
        return
    if zeros == draft.axis_words() and not _only_positions(draft):
        return
    draft.drop(zeros)
    draft.comments += [f"{word.text}: no {word.letter} here" for word in zeros]


def _only_positions(draft: Draft) -> bool:
    straight = draft.motion() in ("G0", "G1") and not draft.state.cycle
    return straight and all(code in GROUP_OF for code in draft.codes())


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


def _follow_surface_speed(draft: Draft) -> None:
    word = draft.word("S")
    if word and draft.state.spindle_mode == "G96" and not draft.meanings:
        draft.change(surface=word.value)


def axes_at_zero(draft: Draft) -> None:
    """Keep words of an axis that the machine lacks as comments: it is always at their 0."""
    if draft.state.polar != "off" or {"polar on", "cylinder"}.intersection(draft.meanings):
        return
    lacking = set(draft.control.at_zero) - set(draft.control.axes)
    letters = [*lacking, *(inc for inc, axis in PARTNERS.items() if axis in lacking)]
    unmoved = [w for w in draft.words if w.letter in letters and w.is_zero]
    draft.drop(unmoved)
    if unmoved and not draft.axis_words() and not draft.increments():
        draft.comments += draft.take_codes(MACHINES_OWN)  # without an axis G28 moves each of them
    draft.comments += [word.text for word in unmoved]


def radius_or_diameter(draft: Draft, code: ForeignWord) -> None:
    word = draft.take("X")
    modes = {"0": "G8", "1": "G7"}
    if not word or word.value.rstrip(".") not in modes or draft.axis_words():
        raise NotTranslated(f"{code.code} needs X0, radii, or X1, diameters, and no other axis")
    mode = modes[word.value.rstrip(".")]
    draft.put_first(mode)
    draft.change(x_words=mode, at_x=UNKNOWN)


def refuse_leftovers(draft: Draft) -> None:
    axes = draft.control.axes
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
        if word.letter in AXIS_NUMBERS and word.letter not in axes and not inside:
            raise NotTranslated(
                f"{word.text}: this control's machine has the axes {axes}; for another one say "
                f'axes = "{axes}{word.letter}" in a control of your own'
            )
        if word.letter not in BLOCK_LETTERS and word.letter not in AXIS_NUMBERS and not inside:
            raise NotTranslated(f"{word.text} is not understood in this block")
