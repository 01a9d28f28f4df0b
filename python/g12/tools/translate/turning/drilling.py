# SPDX-License-Identifier: GPL-2.0-or-later
"""Drilling cycles of a lathe, in the face and in the side, with C: written out as moves.

LinuxCNC's own cycles take no C. Each block of a cycle is a hole:

1. a stop; a rapid to X (in the side: Z) and C at the level where the cycle began; a stop
2. C's clamp closed, if the block has its M code
3. by rapid to R; at F to the end, in pecks, each with a way out to R; dwell; back to R
4. C's clamp open; by rapid to the level of the beginning, under G99 of systems B and C not

G4 stops the tool where it must be before another axis moves, and at the end of a hole: LinuxCNC
would blend the moves. Where a control's R is not understood as a level nearer to the part, F begins
at the tool's level: that is right for every reading. A level is a word's number: of X a diameter.
"""

from collections.abc import Iterator
from math import ceil
from typing import Any, NamedTuple

from g12.tools.translate.blocks.control import HOLE_MEANINGS
from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.modal import AS_PROGRAMMED, CONSUMERS, MOTIONS, UNKNOWN, UNSURE
from g12.tools.translate.blocks.positions import FIELDS, value_text
from g12.tools.translate.rules.codes import is_own, mapped
from g12.tools.translate.rules.decimals import in_units
from g12.tools.translate.rules.drilling_cycles import seconds_of_dwell
from g12.tools.translate.turning.given_words import (
    start_point,
    stored_setting,
    take_increments,
    take_number,
)
from g12.tools.translate.turning.moves import limited

POSITION_LETTERS = frozenset("XZCUWHR")
OWN_M_CODES = frozenset(f"M{number}" for number in range(10))  # LinuxCNC's, beside a cycle
STOP = "G4 P0"
LEAST_PECK = 1e-6  # of a peck that is no rounding


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

    @property
    def scale(self) -> int:
        """What the word changes by for each unit into the part."""
        return self.toward * (2 if self.axis == "X" else 1)

    def pecked(self, depth: float, clear: float) -> Iterator[str]:
        """Yield the moves down to the end, each ``depth`` deeper (0: at once)."""
        stroke = (self.end - self.r) / self.scale
        count = limited(ceil((stroke - LEAST_PECK) / depth), "pecks") if depth else 1
        for peck in range(1, count):
            there = self.r + peck * depth * self.scale
            yield f"G1 {self.word(there)}"
            yield f"G0 {self.word(self.r)}"
            yield f"G0 {self.word(there - min(clear, depth / 2) * self.scale)}"
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
        raise NotTranslated("a drilling cycle of a lathe is translated under G90")
    code = draft.meanings.pop(meaning, None)
    kept: dict[str, Any] = {"dwell": "0", "peck": 0.0}
    if draft.state.cycle == meaning:
        kept |= draft.sure("cycle_words", "a drilling cycle takes the words of the block before")
    where, kind = meaning.split()
    clamp, first = _clamp_of(draft), [STOP] if code else []
    seconds_of_dwell(draft)
    if dwell := draft.take("P"):
        kept["dwell"] = dwell.value
    _take_peck(draft, kept)
    levels = _hole_levels(draft, "X" if where == "side" else "Z", kept)
    ends, place = _place_of(draft, "Z" if where == "side" else "X")
    _check_nothing_else(draft, code)
    stays = draft.sure("retract", "a cycle returns by G98 or G99") == "G99"
    top = levels.r if stays else levels.top
    lines = [*first, *place, STOP, *clamp[:1]]
    lines += [f"G0 {levels.word(levels.r)}"] * (levels.r != levels.top)
    clear = stored_setting(draft, "retract") or kept["peck"] / 2
    lines += levels.pecked(kept["peck"] if kind == "hole" else 0.0, clear)
    lines += [f"G4 P{kept['dwell']}", f"{'G1' if kind == 'bore' else 'G0'} {levels.word(levels.r)}"]
    lines += [*clamp[1:], *[f"G0 {levels.word(top)}"] * (top != levels.r), STOP]
    if draft.state.own_distance == "G91":
        lines = ["G90", *lines]
        draft.change(own_distance=AS_PROGRAMMED)
    draft.write(lines)
    kept |= {"top": levels.top, "r": levels.r, "end": levels.end}
    ends[FIELDS[levels.axis]] = top
    draft.change(cycle=meaning, cycle_words=tuple(sorted(kept.items())), own_motion=UNSURE, **ends)


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


def _take_peck(draft: Draft, kept: dict) -> None:
    word = draft.word("Q")
    if word is None:
        return
    lengths = draft.control.value("holes", "q") != "increments"
    if lengths and word.lacks_point:
        draft.replace(word, in_units(draft, word, "length"))
    kept["peck"] = abs((take_number if lengths else take_increments)(draft, "Q"))


def _hole_levels(draft: Draft, axis: str, kept: dict) -> HoleLevels:
    if "top" not in kept:
        start = start_point(draft)
        kept["top"] = 2 * start.imag if axis == "X" else start.real
    top, r = kept["top"], take_number(draft, "R")
    own = take_number(draft, axis)
    end = own if own is not None else kept.get("end")
    if end is None or end == top:
        raise NotTranslated(f"a drilling cycle needs {axis}, where the hole ends, not at {top:g}")
    levels = HoleLevels(axis, top, kept.get("r", top), end)
    if r is not None:
        levels = _with_r(draft, levels, r)
    if (levels.end - levels.r) * levels.toward <= 0:
        raise NotTranslated(f"R lies beyond {levels.word(levels.end)}, where the hole ends")
    return levels


def _with_r(draft: Draft, levels: HoleLevels, r: float) -> HoleLevels:
    """Apply R: a distance from the tool's level, or a level."""
    if draft.control.value("holes", "r") != "from start":
        outer = levels.top if (r - levels.top) * levels.toward > 0 else r
        return levels._replace(top=outer, r=r)
    if r * levels.toward < 0:
        draft.comments.append(f"R{r:g}: F begins where the tool stands")
        return levels._replace(r=levels.top)
    return levels._replace(r=levels.top + r * (2 if levels.axis == "X" else 1))


def _place_of(draft: Draft, other: str) -> tuple[dict[str, Any], list[str]]:
    """Return the positions after a block, by the names of their modes, and the line to its hole."""
    ends = {field: getattr(draft.start, field) for field in FIELDS.values()}
    words = draft.take_each(f"{other}C")
    for word in words:
        ends[FIELDS[word.letter]] = word.number if word.kind == "number" else None
    return ends, [" ".join(["G0", *(word.text for word in words)])] if words else []


def _check_nothing_else(draft: Draft, code: ForeignWord | None) -> None:
    odd = next((word for word in draft.words if word.letter not in "NGMSTF"), None)
    if odd:
        name = code.code if code else "a drilling cycle"
        raise NotTranslated(
            f"{odd.text} in {name} is not translated: write each hole with its X or Z and C"
        )
