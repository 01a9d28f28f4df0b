# SPDX-License-Identifier: GPL-2.0-or-later
"""Motion and distance mode: written where LinuxCNC would be in another than the program is.

Most blocks of a long program are lines and arcs that are the same on LinuxCNC: `is_plain` finds
them, which saves most of the time.
"""

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft
from g12.tools.translate.blocks.errors import NotSure, NotTranslated
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
from g12.tools.translate.blocks.positions import FIELDS, end_of_word

INDIFFERENT = frozenset("NMSTFHD$")


def motion_mode(draft: Draft) -> None:
    codes = draft.codes()
    if "G53" in codes or draft.state.cycle or draft.has_motion:
        return
    motion = next((code for code in codes if code in MOTIONS), "")
    _refuse_rounding(draft, motion or draft.state.motion)
    consumed = not CONSUMERS.isdisjoint(codes)
    if motion and consumed and (draft.axis_words() or not REFERENCES.isdisjoint(codes)):
        _take_motion(draft, motion)
    elif motion:
        draft.change(motion=motion, own_motion=AS_PROGRAMMED)
    elif not consumed and _moves(draft):
        _bare_words(draft)


def _refuse_rounding(draft: Draft, motion: str) -> None:
    """Refuse the R of a straight line, by which some controls round the corner."""
    straight = motion in ("G0", "G1") and not CONSUMERS.intersection(draft.codes())
    if straight and "R" in draft.letters() and draft.axis_words():
        raise NotTranslated(f"R beside {motion}: write the arc of the corner as a block")


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
        raise NotTranslated(
            "words without G0 or G1, and none before them: which of them holds at the start is a "
            "setting of the control"
        )
    if state.own_motion == AS_PROGRAMMED:
        return
    if state.motion == UNSURE:
        raise NotSure("words without G0 or G1, which is not the same on every way here", "motion")
    draft.put_first(state.motion)
    draft.change(own_motion=AS_PROGRAMMED)


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


PLAIN_LETTERS = frozenset("NXYZABCIJKRF")
SETTLED = (UNKNOWN, "off", AS_PROGRAMMED, AS_PROGRAMMED, AS_PROGRAMMED)
ROTARY_LETTERS = frozenset("ABC")  # beside a slide they can need another feed


def is_plain(draft: Draft) -> bool:
    """Whether no rule has anything to do; the block's motion, feed and position are then noted.

    So it is for one motion code or none, numbers with points, and no mode that LinuxCNC lacks.
    """
    state, control = draft.state, draft.control
    if state.turn or control.onto:
        return False
    at = (state.cycle, state.polar, state.own_motion, state.own_distance, state.own_feed)
    if at != SETTLED:
        return False
    modes: dict[str, float | str] = {}
    letters = set()
    for letter, value, kind, _ in draft.words:
        if kind != "number" or letter in letters:
            return False
        letters.add(letter)
        if letter == "G":
            modes["motion"] = f"G{value.lstrip('0') or '0'}"
        elif (
            letter not in PLAIN_LETTERS
            or (letter in AXIS_NUMBERS and letter not in control.axes)
            or (letter != "N" and "." not in value and value != "0")
        ):
            return False
        elif letter == "F":
            modes["feed"] = value
    motion = modes.get("motion", state.motion)
    arc = motion in ("G2", "G3") or letters.isdisjoint("IKR" if control.is_lathe else "R")
    if not arc or motion not in MOVES or control.meanings.get(motion) != "same":
        return False
    if motion != "G0" and not ROTARY_LETTERS.isdisjoint(letters):
        return False
    modes.update(
        (FIELDS[w.letter], end_of_word(state, w)) for w in draft.words if w.letter in FIELDS
    )
    if any(getattr(state, mode) != value for mode, value in modes.items()):
        draft.change(**modes)
    return True
