# SPDX-License-Identifier: GPL-2.0-or-later
"""Which codes and words a block of a section may hold, and why others are refused.

Codes are the parser's: a G code times ten, by modal group.
"""

import re
from collections.abc import Iterable
from enum import IntEnum
from typing import NamedTuple

from g12.section.line import BlockLocation, SectionWords, TextLine

NO_CODE = -1


class GGroup(IntEnum):
    """Modal groups of the G codes, as the parser numbers them (GM_… in interp_internal.hh)."""

    NON_MODAL = 0
    MOTION = 1
    DISTANCE = 3
    IJK_DISTANCE = 4
    FEED = 5
    COMPENSATION = 7
    TOOL_LENGTH = 8
    RETURN_LEVEL = 10
    PATH_CONTROL = 13
    SPINDLE = 14
    DIAMETER = 15


class MGroup(IntEnum):
    """The modal groups of the M codes, those that a section has rules for."""

    STOP = 4
    INPUT_OUTPUT = 5
    MODAL_STATE = 7


G0, G1, G2, G3, G4 = 0, 10, 20, 30, 40
M2, M30 = 2, 30
# LinuxCNC's names for M70 to M73
STATE_CODES = M_SAVE, M_INVALIDATE, M_RESTORE, M_AUTORESTORE = 70, 71, 72, 73
TAKEN_G = frozenset(
    (G1, G2, G3, G4, 400, 410, 420, 610, 611, 640, 900, 910, 911, 940, 950, 970, 980, 990)
)
FEED_CODES = {940: False, 980: False, 950: True, 990: True}  # code: per revolution
MOVING_WORDS = "XYZABCIJK"
NO_TOOL_CHANGE = "the tool cannot change inside the section"
REFUSED_WORDS = {"T": NO_TOOL_CHANGE, "D": "the radius is that of the loaded tool"}
RAPID = (
    "a rapid leaves the contour. Is the section's end missing above? "
    "Else use G1 with a high F, or set [G12] POLAR_G0 = feed"
)
ONLY_CUTS = "only G1, G2 and G3 move inside the section"
# The others that LinuxCNC knows; {0} are the section's words.
REASONS_OF_G = (
    (RAPID, (G0,)),
    (ONLY_CUTS, (*range(50, 54), 330, 331, *range(382, 386))),
    (ONLY_CUTS, (700, 710, 711, 712, 720, 721, 722, 730, 740, 760, *range(800, 900, 10))),
    ("the section's plane is {0.plane_name}", (170, 171, 180, 181, 190, 191)),
    ("{0.centre_name} are always incremental inside the section", (901,)),
    ("the feed of a section is G94 or G95 (G98 or G99)", (930,)),
    ("the units cannot change inside the section", (200, 210)),
    ("the radius is that of the loaded tool: G41 or G42 without D", (411, 421)),
    ("the tool length offset cannot change inside the section", (430, 431, 432, 490)),
    ("the spindle keeps its speed inside the section (G97)", (960,)),
    ("X cannot change between diameter and radius inside the section", (70, 80)),
    ("offsets cannot change inside the section", (100,)),
    ("the reference point is not in the plane", (280, 281, 300, 301)),
    ("machine coordinates are not those of the plane", (530,)),
    ("{0.origin}", (520, *range(540, 600, 10), 591, 592, 593, *range(920, 924))),
)
REFUSED_G = {code: reason for reason, codes in REASONS_OF_G for code in codes}
REASON_OF_M = dict.fromkeys((6, 61), NO_TOOL_CHANGE) | dict.fromkeys(
    (98, 99), "it needs a block of its own"
)
NEEDED_WORD = {62: "P", 63: "P", 64: "P", 65: "P", 67: "E", 68: "E"}
ORIENT = 19  # M19
WAIT_FOR_INPUT, AT_ONCE = 66, 0  # M66, and the L that does not wait
WAIT_RULE = "Q above zero, the longest wait in seconds"

MADE_OUTSIDE = re.compile(r"o<(face_holes?(?:_at)?|side_holes|polar_(?:polygon|slot|pocket))>call")


class SectionBlock(NamedTuple):
    """A parsed line: codes by modal group, -1 for none, and word values."""

    g: tuple[int, ...]
    m: tuple[int, ...]
    motion: int
    words: dict[str, float]

    @property
    def moves(self) -> bool:
        return any(letter in self.words for letter in MOVING_WORDS)


def check_codes(
    codes: Iterable[tuple[str, int]],
    known: SectionWords,
    rapid_allowed: bool,
    location: BlockLocation,
) -> None:
    """Refuse codes as they are written, before the parser complains about the words beside them.

    ``codes`` are letters, with numbers times ten.
    """
    for letter, code in codes:
        if letter == "G" and code in REFUSED_G:
            _check_g(code, known, rapid_allowed, location)
        elif letter == "M":
            _check_m(code // 10, location)


def never_ended(line: TextLine) -> str:
    """Return why the lines after an O-word are skipped to the end of the file."""
    if line.control == "call":
        return f"there is no sub for {line.text}, in the program or as a file"
    return f"the program ends before what belongs to {line.text}"


def check_call(text: str, off_code: str, location: BlockLocation) -> None:
    """Refuse a call of holes or a shape by its name; ``text`` has no blanks, in lower case.

    Such a sub turns C and moves at once, but a section is planned as a whole before it moves.
    """
    called = MADE_OUTSIDE.search(text)
    if called:
        raise location.refuse(
            f"o<{called[1]}> must be called outside of a section: "
            f"{off_code} in the line before it, {location.code} again after it"
        )


def check_letters(line: TextLine, known: SectionWords, location: BlockLocation) -> None:
    """Refuse words that a section does not have, and two words for one axis."""
    refused = REFUSED_WORDS | known.refused
    for letter in line.letters:
        if letter in refused:
            raise location.refuse(f"{letter} is refused: {refused[letter]}")
    for axis, letters in known.letters:
        given = [letter for letter in letters if letter in line.letters]
        if len(given) > 1:
            raise location.refuse(f"{given[0]} and {given[1]} both move {axis}: only one of them")


def check_block(
    block: SectionBlock, known: SectionWords, rapid_allowed: bool, location: BlockLocation
) -> None:
    """Refuse codes that no section may have, each with its reason."""
    for code in block.g:
        if code != NO_CODE:
            _check_g(code, known, rapid_allowed, location)
    for code in block.m:
        _check_m(code, location)
    _check_arguments(block, location)
    if "P" in block.words and block.moves and block.motion in (G2, G3):
        raise location.refuse("P is refused: an arc inside the section has no turns")
    if len(feed_modes(block)) > 1:
        raise location.refuse(
            "G94 and G98 are feed per minute, G95 and G99 per revolution: not both"
        )


def _check_g(code: int, known: SectionWords, rapid_allowed: bool, location: BlockLocation) -> None:
    if code in TAKEN_G or code in known.planes or (code == G0 and rapid_allowed):
        return
    reason = REFUSED_G.get(code, ONLY_CUTS).format(known)
    raise location.refuse(f"G{code / 10:g} is refused: {reason}")


def _check_m(code: int, location: BlockLocation) -> None:
    if code in REASON_OF_M:
        raise location.refuse(f"M{code} is refused: {REASON_OF_M[code]}")


def _check_arguments(block: SectionBlock, location: BlockLocation) -> None:
    """Refuse words of an M code that LinuxCNC itself would refuse only later, between the moves."""
    words = block.words
    for code in block.m:
        needed = NEEDED_WORD.get(code)
        if needed and words.get(needed, -1.0) < 0.0:
            raise location.refuse(f"M{code} needs {needed}, the number of the output")
    if ORIENT in block.m and words.get("Q", 1.0) <= 0.0:
        raise location.refuse(f"M{ORIENT} needs {WAIT_RULE}")
    if WAIT_FOR_INPUT in block.m:
        _check_waiting(words, location)


def _check_waiting(words: dict[str, float], location: BlockLocation) -> None:
    waits = words.get("L", AT_ONCE) != AT_ONCE
    for wrong, reason in (
        (("P" in words) == ("E" in words), "either P or E, the number of the input"),
        (waits and "E" in words, "L0 with E: only a digital input can be waited for"),
        (waits and words.get("Q", 0.0) <= 0.0, WAIT_RULE),
        (words.get("L", 0.0) not in range(5), "L from 0 to 4"),
    ):
        if wrong:
            raise location.refuse(f"M{WAIT_FOR_INPUT} needs {reason}")


def feed_modes(block: SectionBlock) -> set[bool]:
    """Return the feed modes that a block commands; True is per revolution."""
    return {
        FEED_CODES[code]
        for code in (block.g[GGroup.FEED], block.g[GGroup.RETURN_LEVEL])
        if code in FEED_CODES
    }


def alone(block: SectionBlock, words: str = "") -> bool:
    """Return whether the block holds only a motion code, and its ``words``."""
    others = [*block.g[: GGroup.MOTION], *block.g[GGroup.MOTION + 1 :], *block.m]
    return set(block.words) <= set(words) and max(others) == NO_CODE


def m_code_alone(block: SectionBlock, m_code: int) -> bool:
    """Return whether the block holds only ``m_code`` and its arguments."""
    codes = [code for code in (*block.g, *block.m) if code != NO_CODE]
    return codes == [m_code] and set(block.words) <= set("PQLE")
