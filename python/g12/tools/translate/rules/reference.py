# SPDX-License-Identifier: GPL-2.0-or-later
"""G28, G30 and G53, rapids to positions of the machine; U V W H of a lathe, increments.

LinuxCNC's G28 and G30 mean the same (the positions are those of G28.1 and G30.1). They get what a
lathe writes with U, V, W and H, and lose the motion code beside them.

A block of increments alone is written under G91, and the next block of words restores G90. Beside
absolute words an increment is written from the tool's position. In polar mode U and H are words of
LinuxCNC's own and stay, on a cylinder W too.
"""

from g12.tools.translate.blocks.draft import PARTNERS, Draft, position, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, MOVES, REFERENCES


def reference_point(draft: Draft) -> None:
    code = next((code for code in draft.codes() if code in REFERENCES), "")
    if not code:
        return
    second = draft.take("P") if code == "G30" else None
    if second and second.value.lstrip("0") != "2":
        raise NotTranslated(f"G30 {second.text}: LinuxCNC has two reference points, G28 and G30")
    if code in draft.control.value("reference", "unset", ()):
        draft.comments.append(f"{code}.1 was never set on this machine: machine zero")
    if draft.control.is_lathe:
        _from_here(draft, code)
    cancel_length(draft)


def _from_here(draft: Draft, code: str) -> None:
    """Write U, V, W and H as absolute positions of the intermediate point."""
    for word in draft.increments():
        axis = PARTNERS[word.letter]
        if axis in draft.letters():
            raise NotTranslated(f"{word.text} beside {axis} in {code}")
        incremental = draft.sure("distance", f"{code} with {word.letter}") == "G91"
        own = word._replace(letter=axis) if incremental else _absolute(draft, word)
        draft.replace(word, own)


def _absolute(draft: Draft, word: ForeignWord) -> ForeignWord:
    """Return the absolute word for an increment from where the tool is."""
    if draft.sure("compensation", f"{word.text} is an increment") != "G40":
        raise NotTranslated(f"{word.text} beside an absolute word, with G41 or G42 on")
    axis = PARTNERS[word.letter]
    here = position(axis)
    if axis == "X" and draft.sure("x_words", f"{word.text} is an increment") == "G7":
        here = f"2 * {here}"
    moved = word.kind == "expression" or word.number
    value = f"[{here} + [{word.value}]]" if moved else f"[{here}]"
    return ForeignWord(axis, value, "expression")


def cancel_length(draft: Draft) -> None:
    """Cancel the tool length where the control does: at once without an intermediate point."""
    if not draft.control.value("reference", "cancels_length", False):
        return
    draft.change(length="0")
    passes = any(w.kind == "expression" or w.number for w in draft.axis_words())
    if not passes and (draft.state.distance == "G91" or not draft.axis_words()):
        if not {"G43", "G49"}.intersection(draft.codes()):
            draft.words.append(word_of("G49"))
    else:
        draft.after.append("G49")


def machine_position(draft: Draft) -> None:
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


def incremental_words(draft: Draft) -> None:
    if not draft.control.is_lathe or draft.meanings:
        return
    found = draft.increments()
    if draft.state.polar != "off":
        own = "UH" if draft.state.polar == "on" else "UWH"
        found = [word for word in found if word.letter not in own]
        if found and len(draft.axis_words()) + len(draft.increments()) > len(found):
            raise NotTranslated(f"{found[0].text} beside other axes in a section: write Z")
    for word in found:
        if PARTNERS[word.letter] in draft.letters():
            raise NotTranslated(f"{word.text} and {PARTNERS[word.letter]} in one block")
    if not found:
        return
    incremental = draft.sure("distance", f"{found[0].text} is an increment") == "G91"
    if not incremental and draft.axis_words():
        for word in found:
            draft.replace(word, _absolute(draft, word))
        return
    for word in draft.increments():
        draft.replace(word, word._replace(letter=PARTNERS[word.letter]))
    if not incremental:
        draft.change(own_distance="G91")
        draft.put_first("G91")
