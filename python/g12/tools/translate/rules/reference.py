# SPDX-License-Identifier: GPL-2.0-or-later
"""G28, G30 and G53: rapid moves to the machine's own places, whatever motion mode is active.

LinuxCNC's G28 and G30 mean the same (the places are those of G28.1 and G30.1); here they are
given what a lathe writes with U, V, W and H, and lose the motion code beside them.
"""

from g12.tools.translate.blocks.draft import PARTNERS, Draft, position, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, MOVES

POINTS = frozenset(("G28", "G30"))


def reference_point(draft: Draft) -> None:
    """Rewrite the axes of G28 and G30."""
    code = next((code for code in draft.codes() if code in POINTS), "")
    if not code:
        return
    second = draft.take("P") if code == "G30" else None
    if second and second.value.lstrip("0") != "2":
        raise NotTranslated(f"G30 {second.text}: LinuxCNC has two reference points, G28 and G30")
    if code in draft.control.value("reference", "unset", ()):
        draft.comments.append(f"{code}.1 was never set on this machine: machine zero")
    if draft.control.is_lathe:
        _from_here(draft, code)
    if draft.control.value("reference", "cancels_length", False):
        _cancel_length(draft)


def _from_here(draft: Draft, code: str) -> None:
    """Write U, V, W and H as absolute positions of the intermediate point."""
    for word in draft.increments():
        axis = PARTNERS[word.letter]
        if axis in draft.letters():
            raise NotTranslated(f"{word.text} beside {axis} in {code}")
        incremental = draft.sure("distance", f"{code} with {word.letter}") == "G91"
        draft.replace(
            word, word._replace(letter=axis) if incremental else place_of_increment(draft, word)
        )


def place_of_increment(draft: Draft, word: ForeignWord) -> ForeignWord:
    """Return the absolute word for an increment from where the tool stands."""
    if draft.sure("compensation", f"{word.text} is an increment") != "G40":
        raise NotTranslated(f"{word.text} beside an absolute word, with G41 or G42 on")
    axis = PARTNERS[word.letter]
    here = position(axis)
    if axis == "X" and draft.sure("x_words", f"{word.text} is an increment") == "G7":
        here = f"2 * {here}"
    moved = word.kind == "expression" or word.number
    value = f"[{here} + [{word.value}]]" if moved else f"[{here}]"
    return ForeignWord(axis, value, "expression")


def _cancel_length(draft: Draft) -> None:
    """Cancel the tool length: at once without an intermediate point, else after the block."""
    draft.change(length="0")
    passes = any(w.kind == "expression" or w.number for w in draft.axis_words())
    if not passes and (draft.state.distance == "G91" or not draft.axis_words()):
        if not {"G43", "G49"}.intersection(draft.codes()):
            draft.words.append(word_of("G49"))
    else:
        draft.after.append("G49")


def machine_position(draft: Draft) -> None:
    """Make G53 a rapid move."""
    if "G53" not in draft.codes():
        return
    if draft.sure("distance", "G53 is absolute") == "G91":
        raise NotTranslated("G53 under G91: its words are absolute, write G90 with it")
    if draft.state.cycle:
        raise NotTranslated("G53 within a drilling cycle: write G80 before it")
    motions = draft.take_codes(MOVES)
    motion = motions[0] if motions else draft.state.motion
    draft.put_first("G0")
    draft.change(motion=motion, own_motion=AS_PROGRAMMED if motion == "G0" else "G0")
