# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion and distance mode: written where LinuxCNC would be in another than the program is.

Most blocks of a long program are lines and arcs that are the same on LinuxCNC: `is_plain` finds
them, which saves most of the time.
"""

import re

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft
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
from g12.tools.translate.blocks.positions import FIELDS, axis_of, end_of_word, is_unmoved

SLIDES = frozenset("XYZ")
INDIFFERENT = frozenset("NMSTFHD$")


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
    found = sorted(letter for letter in draft.letters() if letter[0] == "," or letter in words)
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
    if "C" in moved and moved.intersection(SLIDES) and _is_feed(draft) and not as_here:
        raise NotTranslated(
            "C beside a slide at a feed: F has another path here: write G93 and F, 1 / minutes, "
            "or say feed_of_c = \"mm\" in a control of your own, where F is X's and Z's alone"
        )


def _is_feed(draft: Draft) -> bool:
    other = draft.state.polar != "off" or draft.meanings or draft.state.cycle
    codes = {*CONSUMERS, "G53", "G33"}.intersection(draft.codes())
    return draft.motion() not in ("G0", UNKNOWN) and not other and not codes


PLAIN = re.compile(r"N.*|G0*[0-3]|[XYZABCIJKRF](.*\..*|0)")  # a number that has a point
SETTLED = ("", UNKNOWN, UNKNOWN, UNKNOWN, "off", AS_PROGRAMMED, AS_PROGRAMMED, AS_PROGRAMMED)


def is_plain(draft: Draft) -> bool:
    """Whether no rule has anything to do; the block's motion, feed and position are then noted.

    So it is for one motion code or none, numbers with points, and no mode that LinuxCNC lacks.
    """
    state, control, words = draft.state, draft.control, draft.words
    own = (state.own_motion, state.own_distance, state.own_feed)
    letters = {word.letter for word in words}
    if (
        (control.onto, state.turning_cycle, state.cycle, state.delayed, state.polar, *own)
        != SETTLED
        or len(letters) < len(words)
        or not all(word.kind == "number" and PLAIN.fullmatch(word.text) for word in words)
        or not letters.isdisjoint(AXIS_NUMBERS.keys() - set(control.axes))
    ):
        return False
    motion = next(iter(draft.codes()), state.motion)
    # A line's R, and I and K on a lathe, are a corner; C beside a slide can need another feed.
    others = "" if motion in ("G2", "G3") else "IKR" if control.is_lathe else "R"
    others += "" if motion == "G0" else "ABC"
    if motion not in MOVES or control.meanings.get(motion) != "same" or letters & set(others):
        return False
    modes: dict[str, float | str | None] = {"motion": motion}
    if feed := draft.word("F"):
        modes["feed"] = feed.value
    modes |= {FIELDS[w.letter]: end_of_word(state, w) for w in words if w.letter in FIELDS}
    draft.change(**modes)
    return True
