# SPDX-License-Identifier: GPL-2.0-or-later
"""A section's state and codes, and the effects of its blocks besides motion: modes, actions."""

import re
from collections.abc import Callable, Collection
from typing import NamedTuple

from g12.errors import LONGEST_BLOCK
from g12.machine_ini import Remap, code_number
from g12.section.block_rules import (
    NO_CODE,
    ORIENT,
    STATE_CODES,
    GGroup,
    MGroup,
    SectionBlock,
    feed_modes,
)
from g12.section.line import BlockLocation, TextLine
from g12.state import State

PASSED_ON = (
    GGroup.NON_MODAL,
    GGroup.IJK_DISTANCE,
    GGroup.PATH_CONTROL,
    GGroup.SPINDLE,
)  # modal groups of actions of the machine
ACTION_WORDS = ("S", "P", "Q", "L", "E")  # words of the codes without motion
_IN_REPORT = re.compile(r"%(d|f|\.\df)|#(\d+|<[^>]*>)")
_REPORTS = ("debug,", "print,", "log,", "abort,")


class SectionModes(NamedTuple):
    """The modes of a section, which change as the lines are read, not as the tool moves.

    ``feed`` is F in program units per minute, or per revolution; ``speed`` that of the spindle
    which turns the latter into the former; ``motion`` the code that bare words repeat.
    """

    incremental: bool
    per_revolution: bool
    feed: float
    speed: float
    motion: int


class Action(NamedTuple):
    """A block without motion, in order between the moves.

    ``modes`` are those in force at that point of the path, None for a comment that needs none.
    ``level`` is the call level whose saved state an M70 to M72 refers to, None for other blocks.
    """

    line: int
    text: str
    modes: SectionModes | None
    level: int | None = None


class BlockEnd(NamedTuple):
    """The end of a block before another one on the same line, as in a loop."""

    line: int


def modes_after(modes: SectionModes, block: SectionBlock, speed: float) -> SectionModes:
    """Return the modes after the codes and F of ``block``, with ``speed`` by its S."""
    words = block.words
    distance, commanded = block.g[GGroup.DISTANCE], feed_modes(block)
    per_revolution = commanded.pop() if commanded else modes.per_revolution
    feed = modes.feed if per_revolution == modes.per_revolution else 0.0  # F in the other unit
    return SectionModes(
        incremental=modes.incremental if distance == NO_CODE else distance == 910,
        per_revolution=per_revolution,
        feed=words.get("F", feed),
        speed=speed,
        motion=modes.motion if block.g[GGroup.MOTION] == NO_CODE else block.g[GGroup.MOTION],
    )


def action_text(block: SectionBlock, line: TextLine) -> str:
    """Return the block without its motion, with values for expressions; "" if nothing remains."""
    codes = [f"G{block.g[group] / 10:g}" for group in PASSED_ON if block.g[group] != NO_CODE]
    codes += [
        f"M{code}"
        for group, code in enumerate(block.m)
        if code != NO_CODE and group != MGroup.STOP and code not in STATE_CODES
    ]
    letters = (*ACTION_WORDS, "R") if ORIENT in block.m else ACTION_WORDS
    codes += [letter + decimal(block.words[letter]) for letter in letters if letter in block.words]
    return "".join(codes) + line.spindle if codes else ""


def stop_text(block: SectionBlock) -> str:
    """Return the block's M0, M1 or M60, which acts after its motion; "" without one."""
    return "" if block.m[MGroup.STOP] == NO_CODE else f"M{block.m[MGroup.STOP]}"


def decimal(value: float) -> str:
    """Return a value in a form that the parser reads: without an exponent."""
    return f"{value:.10f}".rstrip("0").rstrip(".")


def may_fail(comment: str) -> bool:
    """Return whether a comment may stop the program: (ABORT,), (PY,) and their like."""
    return comment.lstrip().lower().startswith(("abort,", "py"))


def comment_text(comment: str, value_of: Callable[[str], float | None]) -> str:
    """Return a comment with the parameters of (DEBUG,), (PRINT,), (LOG,) and (ABORT,) filled in.

    It is truncated to a line that LinuxCNC can read. ``value_of`` gives a parameter by number or
    name ("12", "_x"), None if it does not exist.
    """
    if not comment.lstrip().lower().startswith(_REPORTS):
        return f"({comment})"
    decimals = 6

    def filled(match: re.Match[str]) -> str:
        nonlocal decimals
        if match[1]:
            decimals = {"d": 0, "f": 4}[match[1]] if match[1] in "df" else int(match[1][1])
            return ""
        value = value_of("".join(match[2].split()).strip("<>").lower())
        return "######" if value is None else f"{value:.{decimals}f}"

    text = _IN_REPORT.sub(filled, comment)[: LONGEST_BLOCK - len("( )")]
    return f"({text} )" if text.endswith("#") else f"({text})"  # no parameter may begin there


class SectionStart(NamedTuple):
    """The block that begins a section, and the state before it."""

    location: BlockLocation
    words: dict[str, float]  # the section's
    alone: bool  # it holds nothing else
    level: int  # of its call
    state: State
    missing_code: str = ""  # the code that makes the spindle C, where it is not


class WordRules(NamedTuple):
    """Rules for reading the words of a section; lengths and feeds in program units.

    ``diameter``: X words are diameters. ``x_scale`` converts a parsed X word into a radius value,
    ``turn_scale`` a word of the rotary axis into a length. ``height_with_others``: the axis at
    right angles to the plane may move together with those in it. ``rapid_feed`` is None where G0 is
    refused, ``radius_tolerance`` is how far an arc's radii at start and end may differ, ``beside``
    the tool's distance from the X line towards C+.
    """

    diameter: bool
    x_scale: float
    turn_scale: float
    height_with_others: bool
    rapid_feed: float | None
    radius_tolerance: float
    beside: float = 0.0


class SectionCodes(NamedTuple):
    """The codes of sections, as the parser numbers them: G12.1 is 121.

    ``off_code`` is the one that messages name. ``remapped`` has the remapped M codes: True for a
    sub, False for Python. ``word`` is the letter of a code that switches both on and off: off where
    it is 0.
    """

    on: frozenset[int]
    off: frozenset[int]
    off_code: str
    remapped: dict[int, bool]
    word: str = ""

    def begins(self, block: SectionBlock) -> bool:
        return block.g[GGroup.MOTION] in self.on and not self.ends(block)

    def ends(self, block: SectionBlock) -> bool:
        off = not self.word or block.words.get(self.word) == 0.0
        return off and block.g[GGroup.MOTION] in self.off


def codes_of_section(
    code: str, remaps: Collection[Remap], on: str, off: str, word: str = ""
) -> SectionCodes:
    """Return the codes for a section begun by ``code``.

    ``remaps`` are the REMAP lines, ``on`` and ``off`` the names of their handlers. Every code that
    is remapped to ``off`` ends a section. With ``word`` every code does both: its 0 ends a section.
    """
    begin = [code, *_codes_with(on, remaps)]
    named = f"{code} {word}0" if word else f"G{float(code[1:]) + 1:g}"
    ending = _codes_with(off, remaps) or [named]
    if word:
        ending = begin
    elif named not in ending:
        named = ending[0]
    on_codes, off_codes = (frozenset(code_number(each)[1] for each in k) for k in (begin, ending))
    m_codes = [remap for remap in remaps if remap.number[0] == "M"]
    remapped = {remap.number[1] // 10: "ngc" in remap.keywords for remap in m_codes}
    return SectionCodes(on_codes, off_codes, named, remapped, word)


def _codes_with(handler: str, remaps: Collection[Remap]) -> list[str]:
    return [remap.code for remap in remaps if remap.keywords.get("python") == handler]


def code_of_handler(remaps: Collection[Remap], handler: str) -> float | None:
    """Return the number of the G code that is remapped to a handler, None if none is."""
    codes = _codes_with(handler, remaps)
    return code_number(codes[0])[1] / 10 if codes else None
