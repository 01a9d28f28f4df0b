# SPDX-License-Identifier: GPL-2.0-or-later
"""Which codes and words a block of a section may hold, and why others are refused.

Codes are the parser's: a G code times ten, by modal group.
"""

import re
from collections.abc import Iterable
from typing import NamedTuple

from g12.section.line import BlockLocation, TextLine
from g12.section.words import SectionWords

NO_CODE = -1
# Modal groups of the G codes, as the parser numbers them, and two of the M codes.
NON_MODAL, MOTION, PLANE, DISTANCE, CENTRE = 0, 1, 2, 3, 4
FEED, UNITS, COMPENSATION, LENGTH, RETRACT = 5, 6, 7, 8, 10
WORK_OFFSET, PATH, SPINDLE, DIAMETER, SHIFT = 12, 13, 14, 15, 16
M_STOP, M_STATE = 4, 7
G0, G1, G2, G3, G4 = 0, 10, 20, 30, 40
M2, M30 = 2, 30
STATE_CODES = SAVE, FORGET, RESTORE, SAVE_FOR_SUB = 70, 71, 72, 73
KNOWN_G = {
    NON_MODAL: {G4},
    MOTION: {G0, G1, G2, G3},
    DISTANCE: {900, 910},
    CENTRE: {911},
    FEED: {940, 950},
    COMPENSATION: {400, 410, 420},
    RETRACT: {980, 990},
    PATH: {610, 611, 640},
    SPINDLE: {970},
}
REFUSED_G = {  # the others that LinuxCNC knows
    NON_MODAL: (100, 280, 281, 300, 301, 520, 530, 920, 921, 922, 923),
    MOTION: (
        *range(50, 54),
        *(330, 331, 382, 383, 384, 385),
        *(700, 710, 711, 712, 720, 721, 722, 730, 740, 760),
        *range(800, 900, 10),
    ),
    PLANE: (171, 181, 190, 191),
    CENTRE: (901,),
    FEED: (930,),
    UNITS: (200, 210),
    COMPENSATION: (411, 421),
    LENGTH: (430, 431, 432, 490),
    WORK_OFFSET: (540, 550, 560, 570, 580, 590, 591, 592, 593),
    SPINDLE: (960,),
    DIAMETER: (70, 80),
}
GROUP_OF_G = {code: group for group, codes in REFUSED_G.items() for code in codes} | {G0: MOTION}
FEED_MODES = {940: False, 980: False, 950: True, 990: True}  # code: per revolution
MOVING_WORDS = ("X", "C", "Z", "I", "J", "K")
NO_TOOL_CHANGE = "the tool cannot change inside the section"
OWN_RADIUS = "the radius is that of the loaded tool"
REASON_OF_GROUP = {
    MOTION: "only G1, G2 and G3 move inside the section",
    FEED: "the feed of a section is G94 or G95 (G98 or G99)",
    UNITS: "the units cannot change inside the section",
    COMPENSATION: "the radius is that of the loaded tool: G41 or G42 without D",
    LENGTH: "the tool length offset cannot change inside the section",
    SPINDLE: "the spindle keeps its speed inside the section (G97)",
    DIAMETER: "X cannot change between diameter and radius inside the section",
}
REASON_OF_G = {
    G0: "a rapid leaves the contour. Is the section's end missing above? "
    "Else use G1 with a high F, or set [G12] POLAR_G0 = feed",
    100: "offsets cannot change inside the section",
    280: "the reference point is not in the plane",
    281: "the reference point is not in the plane",
    300: "the reference point is not in the plane",
    301: "the reference point is not in the plane",
    530: "machine coordinates are not those of the plane",
}
REASON_OF_M = dict.fromkeys((6, 61), NO_TOOL_CHANGE)
NEEDED_WORD = {62: "P", 63: "P", 64: "P", 65: "P", 67: "E", 68: "E"}
ORIENT = 19
WAIT_FOR_INPUT, AT_ONCE = 66, 0  # M66, and the L that does not wait
LONGEST_WAIT = "Q above zero, the longest wait in seconds"

MADE_OUTSIDE = re.compile(r"o<(face_holes?(?:_at)?|side_holes|polar_(?:polygon|slot|pocket))>call")


class SectionBlock(NamedTuple):
    """A parsed line: codes by modal group, -1 for none, and word values."""

    g: tuple[int, ...]
    m: tuple[int, ...]
    motion: int
    words: dict[str, float]

    @property
    def moves(self) -> bool:
        """Return whether the block is a segment of the contour."""
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
        if letter == "G" and code in GROUP_OF_G:
            _check_g(GROUP_OF_G[code], code, known, rapid_allowed, location)
        elif letter == "M":
            _check_m(code // 10, location)


def check_call(text: str, off_code: str, location: BlockLocation) -> None:
    """Refuse a call of holes or a shape by its name; ``text`` has no blanks, in lower case.

    Such a sub turns C and moves at once, but a section is planned as a whole before it moves.
    """
    called = MADE_OUTSIDE.search(text)
    if called:
        raise location.refuse(
            f"o<{called[1]}> is made outside of a section: "
            f"{off_code} in the line before it, {location.code} again after it"
        )


def check_letters(line: TextLine, known: SectionWords, location: BlockLocation) -> None:
    """Refuse words that a section does not have, and two words for one axis."""
    for letter in line.letters:
        if letter in known.refused:
            raise location.refuse(f"{letter} is refused: {known.refused[letter]}")
    for axis, letters in known.letters:
        given = [letter for letter in letters if letter in line.letters]
        if len(given) > 1:
            raise location.refuse(f"{given[0]} and {given[1]} both move {axis}: only one of them")


def check_block(
    block: SectionBlock, known: SectionWords, rapid_allowed: bool, location: BlockLocation
) -> None:
    """Refuse codes that no section may have, each with its reason."""
    for group, code in enumerate(block.g):
        if code != NO_CODE:
            _check_g(group, code, known, rapid_allowed, location)
    for code in block.m:
        _check_m(code, location)
    _check_arguments(block, location)
    if "P" in block.words and block.moves and block.motion in (G2, G3):
        raise location.refuse("P is refused: an arc inside the section has no turns")
    if len(feed_modes(block)) > 1:
        raise location.refuse(
            "G94 and G98 are feed per minute, G95 and G99 per revolution: not both"
        )


def _check_g(
    group: int, code: int, known: SectionWords, rapid_allowed: bool, location: BlockLocation
) -> None:
    taken = known.planes if group == PLANE else KNOWN_G.get(group, ())
    if code not in taken or (code == G0 and not rapid_allowed):
        reason = REASON_OF_G.get(code) or _reason_of_group(group, known)
        raise location.refuse(f"G{code / 10:g} is refused: {reason}")


def _reason_of_group(group: int, known: SectionWords) -> str:
    if group in (NON_MODAL, WORK_OFFSET, SHIFT):
        return known.origin
    if group == PLANE:
        return f"the section's plane is {known.plane_name}"
    if group == CENTRE:
        return f"{known.centre_name} are always incremental inside the section"
    return REASON_OF_GROUP.get(group, "it is not known here")


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
        raise location.refuse(f"M{ORIENT} needs {LONGEST_WAIT}")
    if WAIT_FOR_INPUT in block.m:
        _check_waiting(words, location)


def _check_waiting(words: dict[str, float], location: BlockLocation) -> None:
    """Refuse an M66 that LinuxCNC would refuse."""
    waits = words.get("L", AT_ONCE) != AT_ONCE
    for wrong, reason in (
        (("P" in words) == ("E" in words), "either P or E, the number of the input"),
        (waits and "E" in words, "L0 with E: only a digital input can be waited for"),
        (waits and words.get("Q", 0.0) <= 0.0, LONGEST_WAIT),
        (words.get("L", 0.0) not in range(5), "L from 0 to 4"),
    ):
        if wrong:
            raise location.refuse(f"M{WAIT_FOR_INPUT} needs {reason}")


def feed_modes(block: SectionBlock) -> set[bool]:
    """Return the feed modes that a block commands; True is per revolution."""
    return {FEED_MODES[code] for code in (block.g[FEED], block.g[RETRACT]) if code in FEED_MODES}


def alone(block: SectionBlock, words: str = "") -> bool:
    """Return whether the block holds only a motion code, and its ``words``."""
    others = [*block.g[:MOTION], *block.g[MOTION + 1 :], *block.m]
    return set(block.words) <= set(words) and max(others) == NO_CODE


def m_code_alone(block: SectionBlock, m_code: int) -> bool:
    """Return whether the block holds only ``m_code`` and its arguments."""
    codes = [code for code in (*block.g, *block.m) if code != NO_CODE]
    return codes == [m_code] and set(block.words) <= set("PQLE")
