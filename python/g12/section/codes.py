# SPDX-License-Identifier: GPL-2.0-or-later
"""The codes that switch a section on and off, as the user's REMAP lines define them."""

from collections.abc import Collection
from typing import NamedTuple

from g12.machine_ini import Remap, code_number
from g12.section.block_rules import GGroup, SectionBlock


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
