# SPDX-License-Identifier: GPL-2.0-or-later
"""Tools and the spindle: T, H and D; the speed limit, which spindle, and when it stops.

A lathe's T0303 is tool and offset; on a mill G43 has H, and D is modal. G50 S and G92 S are the
limit, which LinuxCNC takes as D beside G96; with axes the origin.
"""

import re

from g12.tools.translate.blocks.draft import AXIS_NUMBERS, Draft, word_of
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import CONSUMERS, MOTIONS, REFERENCES, UNKNOWN
from g12.tools.translate.blocks.positions import is_unmoved
from g12.tools.translate.rules.codes import live_spindle
from g12.tools.translate.rules.polar import SECTION_NAMES

STOP_CODES = frozenset(("M5", "M9"))
RAPIDS = REFERENCES | {"G0", "G53"}
SPINDLE_M_CODES = frozenset(("M3", "M4", "M5"))
POCKET_CODES = frozenset(("G12", "G13", "G12.2", "G13.2"))
PLANES = {"G18": "XZ", "G19": "YZ"}
COMPENSATION_ON = frozenset(("G41", "G42"))
PLAIN_POCKETS = frozenset(("G12", "G13"))
USES_D = COMPENSATION_ON | PLAIN_POCKETS


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
        live = live_spindle(draft, word) if spindles[word.text] == "live" else ""
        draft.words += [word_of(live)] if live else []
    return next((w.text for w in draft.words if w.letter == "$"), UNKNOWN)


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


def tool_and_offsets(draft: Draft) -> None:
    if draft.control.is_lathe:
        _turret_word(draft)
        if COMPENSATION_ON.intersection(draft.codes()) and not draft.word("D"):
            draft.words += offsets_radius(draft)
    else:
        _length_offset(draft)
        _wait_for_the_plane(draft)
        _radius_offset(draft)
        if word := draft.word("T"):
            draft.change(next_tool=word.value.lstrip("0") or "0")
        if "M6" in draft.m_codes():
            draft.change(tool=draft.state.next_tool)
    again = COMPENSATION_ON.intersection(draft.codes()) and draft.start.compensation != "G40"
    if again and draft.start.polar == "off" and not draft.start.delayed:
        raise NotTranslated("G41 or G42 is on here already: take it out, or write G40 before it")


def _turret_word(draft: Draft) -> None:
    word = draft.word("T")
    change = draft.meanings.pop("tool change", None)
    if change and not word:
        raise NotTranslated(f"{change.code} without T: the turret turns by T alone, take it out")
    if not word:
        return
    draft.comments += [change.text] if change else []
    tool, offset = _parts_of(draft, word)
    loaded = not tool or draft.state.tool == str(tool)
    texts = [] if loaded else [f"T{tool}", "M6"]
    if offset >= 0:
        texts += ["G43", f"H{offset}"] if offset else ["G49"]
    draft.replace(word, *map(word_of, texts))
    if not loaded and SPINDLE_M_CODES.isdisjoint(draft.m_codes()) and not draft.state.live_tool:
        why = "LinuxCNC's tool change stops the spindle (say M3, M4 or M5 in the block of T)"
        draft.words += map(word_of, filter(None, [draft.sure("spindle", why)]))
    draft.comments += [word.text] if loaded else []
    length = str(offset) if offset >= 0 else UNKNOWN
    if draft.start.compensation != "G40" and draft.state.length != length:
        raise NotTranslated(f"{word.text} changes the radius of G41 or G42: write G40 before it")
    draft.change(tool=str(tool) if tool else draft.state.tool, length=length)


def offsets_radius(draft: Draft) -> list[ForeignWord]:
    """Return the D word by which G41 or G42 of a lathe takes the radius of the offset in force."""
    why = "G41 and G42 take the radius of T's offset"
    offset, tool = draft.sure("length", why), draft.sure("tool", why)
    if offset in (UNKNOWN, tool):
        return []
    if offset == "0":
        raise NotTranslated("G41 or G42, and T says no offset whose radius it takes: as T0101")
    if draft.state.polar != "off":
        raise NotTranslated(
            f"G41 or G42 {SECTION_NAMES[draft.state.polar]} takes the loaded tool's radius, not "
            f"that of offset {offset}: give the tool offset {offset}'s values in the tool table, "
            "and write T with one number for both, as T0101"
        )
    return [word_of(f"D{offset}")]


def _parts_of(draft: Draft, word: ForeignWord) -> tuple[int, int]:
    """Return tool and offset of ``T0303``; the shortest pattern that has room for it.

    The offset is -1 where G43 H has it.
    """
    patterns = sorted(draft.control.value("tools", "patterns", ()), key=len)
    if word.kind != "number" or not word.value.isdigit():
        raise NotTranslated(f"{word.text}: a tool word must be a whole number")
    if not int(word.value):
        return 0, 0  # T00: no tool is changed, its offset ends
    if not patterns:
        raise NotTranslated(f"{word.text}: [tools] patterns does not say what its digits are")
    pattern = next((p for p in patterns if len(p) >= len(word.value)), None)
    if not pattern:
        raise NotTranslated(
            f"{word.text} has {len(word.value)} digits: tool and offset are "
            f"{' or '.join(patterns)}; say another pattern under [tools], as patterns = "
            '["TTOO", "TTTOOO"]'
        )
    if len(word.value) < len(patterns[0]) - 1:
        raise NotTranslated(
            f"{word.text} is too short for tool and offset, {patterns[0]}: write both, as T0101"
        )
    digits = word.value.zfill(len(pattern))
    tool, offset = (
        int("".join(d for d, p in zip(digits, pattern) if p == place) or -1) for place in "TO"
    )
    return tool, offset


def _length_offset(draft: Draft) -> None:
    codes, word = draft.codes(), draft.word("H")
    if "G49" in codes:
        draft.change(length="0")
    if word and "G43" not in codes:
        raise NotTranslated("H without G43 in its block: write G43 before it")
    if "G43" in codes and not word:
        word = ForeignWord("H", draft.sure("length", "G43 without H takes the last one"))
        if word.value in (UNKNOWN, "0"):
            raise NotTranslated("G43 without H, and no H before it: LinuxCNC would take T's length")
        draft.words.append(word)
    if not word:
        return
    if word.is_zero:
        draft.drop([word])
        draft.take_codes({"G43"})
        draft.words.append(word_of("G49"))
    draft.change(length=word.value.lstrip("0") or "0")


def _wait_for_the_plane(draft: Draft) -> None:
    """Write G41 and G42 with the next move in the plane: LinuxCNC refuses a Z move before it."""
    codes, own = draft.codes(), COMPENSATION_ON.intersection(draft.codes())
    if draft.control.onto or not (own or draft.state.delayed):
        return
    plane = PLANES.get(draft.state.plane, "XY")
    moves = any(w.letter in plane and not is_unmoved(draft, w.letter) for w in draft.axis_words())
    if own and not moves and (draft.axis_words() or _next_move_is_beside(draft, plane)):
        draft.change(delayed=draft.take_codes(own)[0])
        draft.comments.append(f"{draft.state.delayed} with the next move")
    elif own or "G40" in codes:
        draft.change(delayed=UNKNOWN)
    elif moves and CONSUMERS.isdisjoint(codes):
        draft.put_first(draft.sure("delayed", "G41 or G42 is before this move"))
        draft.change(delayed=UNKNOWN)


def _next_move_is_beside(draft: Draft, plane: str) -> bool:
    """Whether the next move of the program is not in its plane."""
    for index, block in draft.program:
        letters = {word.letter for word in block.words}
        if index > draft.index and (block.kind != "words" or letters & {*plane, *"OPQ"}):
            return False
        if index > draft.index and letters & AXIS_NUMBERS.keys():
            return True
    return False


def _radius_offset(draft: Draft) -> None:
    """Keep D for the codes that use it, store it for those without."""
    codes = draft.codes()
    word = draft.word("D")
    if word:
        draft.change(radius=word.value)
        if not USES_D.intersection(codes):
            draft.comment_out("D")
    takes_last = draft.control.value("tools", "pocket") == "last"
    if COMPENSATION_ON.intersection(codes):
        _compensation(draft, word)
    elif not word and PLAIN_POCKETS.intersection(codes) and takes_last:
        value = draft.sure("radius", "a pocket without D takes the last one")
        draft.words += [ForeignWord("D", value)] if value else []


def _compensation(draft: Draft, word: ForeignWord | None) -> None:
    """Give G41 and G42 the D in force."""
    if draft.state.plane == "G19":
        raise NotTranslated(
            "G41 or G42 in G19: LinuxCNC compensates in G17 and G18 only: let CAM write the path "
            "of the tool's centre"
        )
    value = draft.sure("radius", "G41 and G42 need D")
    if value == UNKNOWN:
        raise NotTranslated("G41 or G42 without D, and no D before it")
    if re.fullmatch("0+", value):
        raise NotTranslated("G41 or G42 with D0, a radius of 0: take G41 and G42 out")
    if not word:
        draft.words.append(ForeignWord("D", value))
