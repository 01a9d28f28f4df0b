# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion: G28, G30 and G53, a lathe's increments, and motion and distance mode.

LinuxCNC's G28 and G30 mean the same (the positions are those of G28.1 and G30.1). They get what a
lathe writes with U, V, W and H, and lose the motion code beside them.

A block of increments alone is written under G91, and the next block of words restores G90. Beside
absolute words an increment is written from the tool's position. In polar mode U and H are words of
LinuxCNC's own and stay, on a cylinder W too.

A mode is written where LinuxCNC would be in another than the program is.
"""

from g12.tools.translate.blocks.draft import PARTNERS, Draft, position, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import (
    AS_PROGRAMMED,
    CONSUMERS,
    MOTIONS,
    MOVES,
    REFERENCES,
    UNKNOWN,
    UNSURE,
)
from g12.tools.translate.blocks.positions import axis_of, is_unmoved

INDIFFERENT = frozenset("NMSTFHD$")


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


def motion_mode(draft: Draft) -> None:
    codes = draft.codes()
    if "G53" in codes or draft.state.cycle or draft.has_motion:
        return
    motion = next((code for code in codes if code in MOTIONS), "")
    _refuse_corners(draft, motion or draft.state.motion)
    consumed = not CONSUMERS.isdisjoint(codes)
    if motion and consumed and (draft.axis_words() or not REFERENCES.isdisjoint(codes)):
        _take_motion(draft, motion)
    elif motion:
        draft.change(motion=motion, own_motion=AS_PROGRAMMED)
    elif not consumed and _moves(draft):
        _bare_words(draft)


def _refuse_corners(draft: Draft, motion: str) -> None:
    """Refuse the words of a straight line by which some controls break or round its corner."""
    straight = motion in ("G0", "G1") and not CONSUMERS.intersection(draft.codes())
    words = "IKR" if draft.control.is_lathe else "R"
    found = sorted(draft.letters().intersection(words))
    if straight and found and draft.axis_words():
        raise NotTranslated(
            f"{found[0]} beside {motion}: write the corner's line or arc as a block"
        )


def _moves(draft: Draft) -> bool:
    """Whether words without a motion code move something."""
    return not draft.letters().isdisjoint(
        "XYZABC" if draft.state.polar == "off" else "XYZABCUWHIJR"
    )


def _take_motion(draft: Draft, motion: str) -> None:
    """Take out a motion code that sets the mode of the following blocks only."""
    own = draft.state.own("motion")
    draft.take_codes(MOTIONS)
    draft.change(motion=motion, own_motion=AS_PROGRAMMED if own == motion else own)


def _bare_words(draft: Draft) -> None:
    state = draft.state
    if state.motion == UNKNOWN:
        _assume_rapid(draft)
        return
    if state.own_motion == AS_PROGRAMMED:
        return
    if state.motion == UNSURE:
        raise NotTranslated("words without G0 or G1, which is not the same on every way here")
    draft.put_first(state.motion)
    draft.change(own_motion=AS_PROGRAMMED)


def _assume_rapid(draft: Draft) -> None:
    """Write G0, in which the control powers up, with a message; what may be a cut must say it."""
    if "F" in draft.letters() or draft.state.polar != "off":
        raise NotTranslated("no G0 or G1 is before these words: write G1 if they cut, else G0")
    draft.before.append(f"(MSG, line {draft.block.line}: no G0 or G1 before it, it runs as G0)")
    draft.put_first("G0")
    draft.change(motion="G0")


def distance_mode(draft: Draft) -> None:
    """Write G90 (or G91) after a block of increments."""
    state = draft.state
    if draft.is_settled or state.own_distance == AS_PROGRAMMED or not draft.letters() - INDIFFERENT:
        return
    if {"G90", "G91"}.intersection(draft.codes()):
        return
    draft.put_first(draft.sure("distance", "a block of increments is before this one"))
    draft.change(own_distance=AS_PROGRAMMED)


def needs_g90(draft: Draft) -> bool:
    """Whether absolute words need a G90 here; LinuxCNC is in it afterwards."""
    own = draft.state.own("distance")
    draft.change(own_distance=AS_PROGRAMMED if draft.state.distance == "G90" else "G90")
    return own != "G90"


def in_absolute_words(draft: Draft) -> None:
    """Write G90 in a block whose words have become positions, G91 before the next ones."""
    if needs_g90(draft) or draft.state.distance == "G91":
        draft.take_codes({"G91"})
        draft.put_first("G90")


def exact_stop(draft: Draft, code: ForeignWord) -> None:
    """Keep G9 in a section; elsewhere a dwell of no time makes the exact stop."""
    if draft.state.polar != "off":
        draft.put_first("G9")
    else:
        draft.comments.append(code.code)
        draft.after.append("G4 P0")


def refuse_feed_of_c(draft: Draft) -> None:
    """Refuse C beside a slide at a feed outside a section, but where F is the slides' alone.

    On a Fanuc F is along the path of millimetres (X as a radius) and degrees together, on others
    C's alone; LinuxCNC takes it along X, Y and Z and would turn C too fast.
    """
    axes = {axis_of(word.letter) for word in (*draft.axis_words(), *draft.increments())}
    moved = {axis for axis in axes if not is_unmoved(draft, axis)}
    as_here = draft.control.feed_of_c == "mm" or draft.state.feed_mode == "G93"
    if "C" in moved and moved.intersection("XYZ") and _is_feed(draft) and not as_here:
        raise NotTranslated(
            "C beside a slide at a feed: F has another path here: write G93 and F, 1 / minutes, "
            "or say feed_of_c = \"mm\" in a control of your own, where F is X's and Z's alone"
        )


def _is_feed(draft: Draft) -> bool:
    other = draft.state.polar != "off" or draft.meanings or draft.state.cycle
    codes = {*CONSUMERS, "G53", "G33"}.intersection(draft.codes())
    return draft.motion() not in ("G0", UNKNOWN) and not other and not codes
