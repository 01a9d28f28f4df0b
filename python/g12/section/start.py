# SPDX-License-Identifier: GPL-2.0-or-later
"""The state at the start of a section, how its words are read, the codes that begin and end it."""

from collections.abc import Collection
from typing import NamedTuple

from g12.machine_ini import Remap, code_number
from g12.section.block_rules import GGroup, SectionBlock
from g12.section.effects import SectionModes
from g12.section.line import BlockLocation


class SectionStart(NamedTuple):
    """The interpreter's state at the start of a section, read once.

    Lengths are in program units. ``location`` is that of the block that switches on, ``words`` are
    the section's words in it, ``alone``: it holds nothing else, ``level`` is its call level.
    ``position`` is by letter: X a radius value, C in degrees. ``machine_unit`` is the length of a
    machine unit, ``millimetre`` that of 1 mm; ``offsets`` convert from program to machine
    coordinates, ``shifts`` are what G52 or G92 adds to X, Y and Z, of X a radius value. ``speeds``
    are the commanded ones of all spindles in rpm, ``spindle`` is the number of the one that feeds
    per revolution refer to. ``tool_radius`` is None if no tool is loaded.
    """

    location: BlockLocation
    words: dict[str, float]
    alone: bool
    level: int
    position: dict[str, float]
    machine_unit: float
    millimetre: float
    offsets: dict[str, float]
    shifts: dict[str, float]
    modes: SectionModes
    spindle: int
    speeds: tuple[float, ...]
    tool_radius: float | None
    diameter: bool  # G7
    yz_plane: bool  # G19
    compensated: bool
    offset_pending: bool  # after G40 the tool is still offset from the programmed point
    inverse_time: bool  # G93
    surface_speed: bool  # G96
    rotated: bool  # the work offset, by G10 L2 R
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


def codes_of_section(code: str, remaps: Collection[Remap], on: str, off: str) -> SectionCodes:
    """Return the codes for a section begun by ``code``.

    ``remaps`` are the REMAP lines, ``on`` and ``off`` the names of their handlers. Every code that
    is remapped to ``off`` ends a section.
    """
    switching_on, switching_off = (_codes_with(handler, remaps) for handler in (on, off))
    partner = f"G{float(code[1:]) + 1:g}"
    return SectionCodes(
        frozenset(map(_number_of, (code, *switching_on))),
        frozenset(map(_number_of, switching_off or [partner])),
        partner if partner in switching_off else (switching_off or [partner])[0],
        _remapped(remaps),
    )


def codes_with_word(code: str, remaps: Collection[Remap], handler: str, word: str) -> SectionCodes:
    """Return the codes for a section begun by ``code``, which 0 after ``word`` ends."""
    codes = frozenset(map(_number_of, (code, *_codes_with(handler, remaps))))
    return SectionCodes(codes, codes, f"{code} {word}0", _remapped(remaps), word)


def _codes_with(handler: str, remaps: Collection[Remap]) -> list[str]:
    return [remap.code for remap in remaps if remap.keywords.get("python") == handler]


def _remapped(remaps: Collection[Remap]) -> dict[int, bool]:
    return {
        remap.number[1] // 10: "ngc" in remap.keywords for remap in remaps if remap.number[0] == "M"
    }


def code_of_handler(remaps: Collection[Remap], handler: str) -> float | None:
    """Return the number of the G code that is remapped to a handler, None if none is."""
    found = (remap.code for remap in remaps if remap.keywords.get("python") == handler)
    return next((_number_of(code) / 10 for code in found), None)


def _number_of(code: str) -> int:
    return code_number(code)[1]
