# SPDX-License-Identifier: GPL-2.0-or-later
"""The spindle: its speed limit, its orientation, and when it stops.

G50 S and G92 S are the limit, which LinuxCNC takes as D beside G96; with axes the origin.
"""

from g12.tools.translate.blocks.draft import Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import MOTIONS, REFERENCES, UNKNOWN

LONGEST_WAIT = "Q30"  # s, then LinuxCNC reports a spindle that is not oriented
STOP_CODES = frozenset(("M5", "M9"))
RAPIDS = REFERENCES | {"G0", "G53"}
SPINDLE_M_CODES = frozenset(("M3", "M4", "M5"))
NO_LIVE_TOOL = (
    "{} is the live tool's spindle: say [G12] LIVE_SPINDLE in the INI, LinuxCNC's that drives it"
)
POCKET_CODES = frozenset(("G12", "G13", "G12.2", "G13.2"))


def speed_limit(draft: Draft) -> None:
    """Remember a limit, write it where G96 begins; an origin becomes G92."""
    code = draft.meanings.pop("speed limit or origin", None)
    if code:
        _limit_or_origin(draft, code.code)
    if "G96" in draft.codes() and not code:
        limit = draft.sure("limit", "G96 needs the speed limit")
        draft.words += [word_of(f"D{limit}")] if limit else []
    if {"G96", "G97"}.intersection(draft.codes()) and "S" not in draft.letters():
        _mode_without_speed(draft)


def _mode_without_speed(draft: Draft) -> None:
    """Give G96 its last S, as the controls do; LinuxCNC's G97 changes nothing before the next S."""
    mode, before = draft.state.spindle_mode, draft.start.spindle_mode or "G97"
    surface = draft.sure("surface", "G96 without S") if "G96" in draft.codes() else UNKNOWN
    turns = draft.state.spindle and "M5" not in draft.m_codes()
    if surface:
        draft.words.append(word_of(f"S{surface}"))
    elif mode == "G96" or (before != mode and turns):
        raise NotTranslated(f"{mode} without S, and the speed is not known: write S")


def _limit_or_origin(draft: Draft, code: str) -> None:
    """Take the S of a speed limit; other words must be axes."""
    limit = draft.take("S")
    if limit:
        draft.change(limit=limit.value)
        draft.comments.append(f"{code} {limit.text}")
    if limit and draft.sure("spindle_mode", f"{code} S limits G96") == "G96":
        why = f"{code} S within G96"
        surface = draft.sure("surface", why)
        if surface == UNKNOWN:
            raise NotTranslated(f"{why}, and the S of G96 is not known: write it before")
        draft.write([f"G96 S{surface} D{limit.value}"])
    if draft.axis_words():
        draft.put_first("G92")
    elif not limit or draft.letters() & set("UVWH"):
        raise NotTranslated(f"{code} needs S, a speed limit, or X and Z, an origin")


def live_tool(draft: Draft) -> None:
    """Name the spindle of M3, M4, M5 and S: that of the block's P word, or the live tool's."""
    if draft.control.c_axis_on.intersection(word.code for word in draft.block.words):
        draft.change(spindle=UNKNOWN)
    codes = SPINDLE_M_CODES.intersection(draft.m_codes())
    named = _named_spindle(draft, bool(codes))
    if codes and named in ("", "$0", "$-1"):
        draft.change(spindle=next(iter(codes - {"M5"}), UNKNOWN))
    if codes - {"M5"}:
        draft.change(live_tool=named)
    elif codes and named in (draft.state.live_tool, "$-1"):
        draft.change(live_tool=UNKNOWN)
    elif "S" in draft.letters() and not codes and not named:
        live = draft.sure("live_tool", "S is a spindle's")
        draft.words += [word_of(live)] if live else []


def _named_spindle(draft: Draft, turns: bool) -> str:
    """Return the block's ``$`` word, "" for the first spindle; write a P word as one."""
    spindles = draft.control.tables.get("spindles", {})
    word = next((w for w in draft.words if w.letter == "P" and spindles), None)
    if word and turns and word.text not in spindles:
        known = ", ".join(spindles)
        raise NotTranslated(f"{word.text}: no spindle of the machine: there are {known}")
    if word and (turns or (word.text in spindles and "S" in draft.letters())):
        draft.take("P")
        live, is_live = draft.control.live_spindle, spindles[word.text] == "live"
        if is_live and not live:
            raise NotTranslated(NO_LIVE_TOOL.format(word.text))
        draft.words += [word_of(f"${live}")] if is_live and live != "0" else []
    return next((w.text for w in draft.words if w.letter == "$"), UNKNOWN)


def orientation(draft: Draft, code: ForeignWord) -> None:
    """Write M19 so that LinuxCNC waits for it: at the machine's own angle, or at R or P degrees."""
    angles = draft.take_each("RP")
    if len(angles) > 1:
        raise NotTranslated(f"{code.code} with R and P: one of them is its angle")
    draft.change(spindle=UNKNOWN)  # M19 stops it
    line = " ".join(["M19", *(f"R{word.value}" for word in angles), LONGEST_WAIT])
    if draft.is_empty():
        draft.write([line])
    else:
        draft.before.append(line)


def stop_behind_a_cut(draft: Draft) -> None:
    """Write M5 and M9 of a cutting block on a line after it: LinuxCNC stops before the move."""
    stops = [word for word in draft.words if word.code in STOP_CODES]
    if stops and cuts(draft):
        draft.drop(stops)
        draft.after.insert(0, " ".join(word.text for word in stops))


def cuts(draft: Draft) -> bool:
    codes, state = set(draft.codes()), draft.state
    feeds = codes & POCKET_CODES or state.cycle or state.motion in MOTIONS - {"G0"}
    return bool(feeds and draft.letters() & set("XYZABCIJKR")) and not codes & RAPIDS
