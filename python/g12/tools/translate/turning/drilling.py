# SPDX-License-Identifier: GPL-2.0-or-later
"""Drilling cycles of a lathe, in the face and in the side, with C: written out as moves.

LinuxCNC's own cycles take no C. Each block of a cycle becomes

1. a stop; rapids to X (in the side: Z) and C at the level where the cycle began; a stop
2. C's clamp closed, if the block has its M code
3. by rapid to R; at F to the end, in pecks; dwell; back to R by rapid, at F or as a tap
4. C's clamp open; by rapid to the level of the beginning, under G99 of systems B and C not

G4 stops the tool where it must be before another axis moves, and at the end of a hole: LinuxCNC
would blend the moves. Where a control's R is not understood as a level nearer to the part, F begins
at the tool's level: that is right for every reading. A level is a word's number: of X a diameter.
"""

from collections.abc import Iterator
from math import ceil
from typing import Any, NamedTuple

from g12.tools.translate.blocks.control import HOLE_MEANINGS
from g12.tools.translate.blocks.draft import PARTNERS, Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, CONSUMERS, MOTIONS, UNKNOWN, UNSURE
from g12.tools.translate.blocks.positions import FIELDS, known_position, value_text
from g12.tools.translate.milling.drilling_cycles import repeats_of, seconds_of_dwell
from g12.tools.translate.rules.codes import is_own, mapped
from g12.tools.translate.rules.decimals import in_units
from g12.tools.translate.turning.given_words import (
    start_point,
    stored_setting,
    take_increments,
    take_number,
)

DRILL, BORE, TAP = "drill", "bore", "tap"
POSITION_LETTERS = frozenset("XZCUWHR")
STEPS = {axis: letter for letter, axis in PARTNERS.items()}
OWN_M_CODES = frozenset(f"M{number}" for number in range(10))  # LinuxCNC's, beside a cycle
MOST_PECKS, MOST_REPEATS = 1000, 360
STOP = "G4 P0"
LEAST_PECK = 1e-6  # of a peck that is no rounding


class LatheCycle(NamedTuple):
    """What a code drills: along X (``side``; None: the words I and K tell), how it comes out.

    ``start`` is the M code by which the control itself starts the tap's spindle; ``live``: which
    must be the live tool's.
    """

    side: bool | None
    kind: str
    start: str = ""
    live: bool = False


def lathe_cycle(meaning: str) -> LatheCycle:
    """Return what a meaning of the control's file, as ``face live tap left``, drills."""
    words = meaning.split()
    kind = next((kind for kind in (BORE, TAP) if kind in words), DRILL)
    start = {"right": "M3", "left": "M4"}.get(words[-1], "")
    return LatheCycle({"side": True, "face": False}.get(words[0]), kind, start, "live" in words)


class HoleLevels(NamedTuple):
    """Where a hole begins and ends along its axis: the tool's level between holes, R, the end."""

    axis: str
    top: float
    r: float
    end: float

    @property
    def toward(self) -> int:
        """1 where the tool goes into the part in the axis's direction, else -1."""
        return 1 if self.end > self.top else -1

    def pecked(self, depth: float, clear: float, full: bool) -> Iterator[str]:
        """Yield the moves down to the end, each ``depth`` deeper (0: at once)."""
        scale = self.toward * (2 if self.axis == "X" else 1)
        stroke = abs(self.end - self.r) / abs(scale)
        count = ceil((stroke - LEAST_PECK) / depth) if depth else 1
        if count > MOST_PECKS:
            raise NotTranslated(f"pecks of {depth:g} are {count} in one hole: at most {MOST_PECKS}")
        for peck in range(1, count):
            there = self.r + peck * depth * scale
            yield f"G1 {self.word(there)}"
            yield from [f"G0 {self.word(self.r)}"] * full
            yield f"G0 {self.word(there - min(clear, depth / 2) * scale)}"
        yield f"G1 {self.word(self.end)}"

    def word(self, level: float) -> str:
        return f"{self.axis}{value_text(level)}"


def drilling_of_lathe(draft: Draft) -> None:
    if not draft.control.is_lathe:
        return
    cancelled = draft.meanings.pop("cancel cycle", None)
    if cancelled:
        draft.comments.append(cancelled.code)
        draft.change(cycle=UNKNOWN, cycle_words=())
    meaning = next((name for name in draft.meanings if name in HOLE_MEANINGS), "")
    if not meaning and draft.state.cycle:
        meaning = _repeated_cycle(draft)
    if meaning:
        _drill_hole(draft, meaning)


def _repeated_cycle(draft: Draft) -> str:
    """Return the cycle that a block without its code repeats, "" if it drills nothing."""
    codes = set(draft.codes())
    if codes & MOTIONS or draft.meanings:
        draft.change(cycle=UNKNOWN, cycle_words=())
    elif codes & CONSUMERS:
        draft.change(cycle=UNSURE, cycle_words=UNSURE)
    elif draft.letters() & POSITION_LETTERS:
        return draft.sure("cycle", "a drilling cycle may be on: write G80 or its code")
    return ""


def _drill_hole(draft: Draft, meaning: str) -> None:
    if draft.state.polar != "off":
        raise NotTranslated("a drilling cycle in a section: end the section before it")
    if draft.sure("distance", "a drilling cycle") != "G90":
        raise NotTranslated("a drilling cycle of a lathe is translated under G90, with U W H")
    code = draft.meanings.pop(meaning, None)
    kept: dict[str, Any] = {"dwell": "0", "peck": 0.0}
    if draft.state.cycle == meaning:
        kept |= draft.sure("cycle_words", "a drilling cycle takes the words of the block before")
    cycle = lathe_cycle(meaning)
    side = _is_side_hole(draft, kept) if cycle.side is None else cycle.side
    times = int(repeats_of(draft) or 1)
    if times > MOST_REPEATS:
        raise NotTranslated(f"{times} holes in one block: at most {MOST_REPEATS}")
    clamp, first = _clamp_of(draft), [*_spindle_on(draft, cycle), STOP] if code else []
    seconds_of_dwell(draft)
    if dwell := draft.take("P"):
        kept["dwell"] = dwell.value
    _take_peck(draft, kept)
    levels = _hole_levels(draft, "X" if side else "Z", kept)
    bottom = _down_and_out(draft, levels, cycle, kept)
    other, ends = "Z" if side else "X", _positions_after(draft, times)
    there, on = _lines_to_holes(draft, other)
    _check_nothing_else(draft, code)
    stays = draft.sure("retract", "a cycle returns by G98 or G99") == "G99"
    top = levels.r if stays else levels.top
    hole = [STOP, *clamp[:1], *[f"G0 {levels.word(levels.r)}"] * (levels.r != levels.top), *bottom]
    hole += [*clamp[1:], *[f"G0 {levels.word(top)}"] * (top != levels.r), STOP]
    if not times and (there or on):
        raise NotTranslated("K0 or L0 only stores the cycle: go to X and C in another block")
    lines = [*first, *there, *on, *hole, *[*on, *hole] * (times - 1)] if times else first
    if draft.state.own_distance == "G91":
        lines = ["G90", *lines]
        draft.change(own_distance=AS_PROGRAMMED)
    draft.write(lines)
    kept |= {"top": levels.top, "r": levels.r, "end": levels.end, "side": side}
    ends[FIELDS[levels.axis]] = top if times else getattr(draft.start, FIELDS[levels.axis])
    draft.change(cycle=meaning, cycle_words=tuple(sorted(kept.items())), own_motion=UNSURE, **ends)


def _is_side_hole(draft: Draft, kept: dict) -> bool:
    """Whether a hole is in the side, by I and K: the distance of the first rapid."""
    shifts = draft.take_each("IK")
    if len(shifts) > 1 or not (shifts or "side" in kept):
        raise NotTranslated(
            "a drilling cycle needs I (a hole in the side) or K (in the face), and one of them"
        )
    draft.comments += [f"{word.text}: F begins where the tool stands" for word in shifts]
    return shifts[0].letter == "I" if shifts else kept["side"]


def _clamp_of(draft: Draft) -> list[str]:
    """Take the code of C's clamp; return the lines that close and open it."""
    codes = str(draft.control.value("holes", "clamp")).split()
    for word in [w for w in draft.words if w.code[:1] == "M"]:
        if word.code in codes[:1]:
            draft.drop([word])
            pair = (mapped(draft, ForeignWord("M", code[1:])) for code in codes)
            return [" ".join(one.text for one in words) for words in pair]
        if word.code not in OWN_M_CODES and is_own(draft, word):
            raise NotTranslated(
                f"{word.code} in the block of a drilling cycle: if it clamps C, say clamp = "
                f'"{word.code} M…" under [holes], with the code by which C is free again; if not, '
                "write it in a block of its own"
            )
    return []


def _spindle_on(draft: Draft, cycle: LatheCycle) -> list[str]:
    """Return the line that starts a tap's spindle where the control does so itself."""
    if not cycle.start:
        return []
    speed = draft.take("S")
    return [" ".join([*([speed.text] if speed else []), cycle.start, *_tap_spindle(draft, cycle)])]


def _tap_spindle(draft: Draft, cycle: LatheCycle) -> list[str]:
    """Return the word of the tap's spindle if it is not the main one."""
    number = draft.control.value("holes", "spindle", None)
    if cycle.live and number is None:
        raise NotTranslated(
            "a live tap: which spindle of LinuxCNC's drives it? say spindle = 1 under [holes]"
        )
    return [f"${number}"] if number and (cycle.live or not cycle.start) else []


def _take_peck(draft: Draft, kept: dict) -> None:
    letter = str(draft.control.value("holes", "peck_word", "Q"))
    word = draft.word(letter)
    if word is None:
        return
    lengths = draft.control.value("holes", "q") != "increments"
    if lengths and word.lacks_point:
        draft.replace(word, in_units(draft, word, "length"))
    kept["peck"] = abs((take_number if lengths else take_increments)(draft, letter))


def _hole_levels(draft: Draft, axis: str, kept: dict) -> HoleLevels:
    if "top" not in kept or kept.get("side", axis == "X") != (axis == "X"):
        start = start_point(draft)
        kept["top"] = 2 * start.imag if axis == "X" else start.real
    top, r = kept["top"], take_number(draft, "R")
    own, step = take_number(draft, axis), take_number(draft, STEPS[axis])
    kind = draft.control.value("holes", "r", "none")
    if step is not None and (axis == "X" or kind != "from start"):
        raise NotTranslated(f"{STEPS[axis]} as the end of a hole: write {axis}, where it ends")
    end = own if own is not None else kept.get("end")
    if step is not None:
        end = top + step  # only its direction counts for R
    if end is None or end == top:
        raise NotTranslated(f"a drilling cycle needs {axis}, where the hole ends, not at {top:g}")
    levels = HoleLevels(axis, top, kept.get("r", top), end)
    if r is not None:
        levels = _with_r(draft, levels, r, kind)
    if step is not None:
        levels = levels._replace(end=levels.r + step)
    if (levels.end - levels.r) * levels.toward <= 0:
        raise NotTranslated(f"R lies beyond {levels.word(levels.end)}, where the hole ends")
    return levels


def _with_r(draft: Draft, levels: HoleLevels, r: float, kind: str) -> HoleLevels:
    """Apply R: a level, or a distance from the tool's level."""
    if kind == "level":
        outer = levels.top if (r - levels.top) * levels.toward > 0 else r
        return levels._replace(top=outer, r=r)
    if kind == "none":
        raise NotTranslated(f"R{r:g} of a drilling cycle: write {levels.axis}, where the hole ends")
    if r * levels.toward < 0:
        draft.comments.append(f"R{r:g}: F begins where the tool stands")
        return levels._replace(r=levels.top)
    return levels._replace(r=levels.top + r * (2 if levels.axis == "X" else 1))


def _down_and_out(draft: Draft, levels: HoleLevels, cycle: LatheCycle, kept: dict) -> list[str]:
    if cycle.kind == TAP:
        pitch = f"K{value_text(_tap_pitch(draft))}"
        return [" ".join(["G33.1", levels.word(levels.end), pitch, *_tap_spindle(draft, cycle)])]
    full = draft.control.value("holes", "out", "full") == "full"
    clear = stored_setting(draft, "retract") or kept["peck"] / 2
    lines = list(levels.pecked(kept["peck"] if cycle.kind == DRILL else 0.0, clear, full))
    out = f"{'G1' if cycle.kind == BORE else 'G0'} {levels.word(levels.r)}"
    return [*lines, f"G4 P{kept['dwell']}", out]


def _tap_pitch(draft: Draft) -> float:
    """Return the pitch of a tap: F per revolution, or F over the S of its block."""
    why, word = "the pitch of a tap depends on F", draft.word("S")
    speed = word.value if word else ""
    per_turn = draft.sure("feed_mode", why) == "G95"
    try:
        return float(draft.sure("feed", why)) / (1 if per_turn else float(speed))
    except (ValueError, ZeroDivisionError):
        raise NotTranslated(
            "a tap needs its pitch as a number: F per revolution (G99), or F and S in its block"
        ) from None


def _lines_to_holes(draft: Draft, other: str) -> tuple[list[str], list[str]]:
    """Return the lines to the first hole, and those from hole to hole."""
    there = [word.text for word in draft.take_each(f"{other}C")]
    increments = draft.take_each(f"{STEPS[other]}H")
    steps = [f"{PARTNERS[word.letter]}{word.value}" for word in increments]
    if {word[0] for word in there} & {word[0] for word in steps}:
        raise NotTranslated("a word of an axis and its increment in one block")
    step_lines = [" ".join(["G91", "G0", *steps]), "G90"] if steps else []
    return [" ".join(["G0", *there])] if there else [], step_lines


def _positions_after(draft: Draft, times: int) -> dict[str, Any]:
    """Return X, Z and C after a block, by the names of their modes."""
    found = {field: getattr(draft.start, field) for field in FIELDS.values()}
    for word in draft.words:
        number = word.number if word.kind == "number" else None
        if word.letter in ("X", "Z", "C"):
            found[FIELDS[word.letter]] = number
        elif word.letter in PARTNERS:
            axis = PARTNERS[word.letter]
            at = known_position(draft.start, axis)
            found[FIELDS[axis]] = None if None in (at, number) else at + times * number
    return found


def _check_nothing_else(draft: Draft, code: ForeignWord | None) -> None:
    odd = sorted(draft.letters() - set("NGMSTF"))
    if odd:
        name = code.code if code else "a drilling cycle"
        raise NotTranslated(
            f"{odd[0]} in {name} is not translated: write the hole as G0 and G1, or take it out"
        )
