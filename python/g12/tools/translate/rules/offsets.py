# SPDX-License-Identifier: GPL-2.0-or-later
"""Work offsets beyond G54 to G59, and offsets that a program sets.

G154 P1 to P3 (G110 to G112, G54.1 P1 to P3) are LinuxCNC's G59.1 to G59.3; it has no others.

G10 of these controls: L2 P1-P6 is G54 to G59, P0 is G52; L20 P1-P3 is G154.
"""

from g12.tools.translate.blocks.draft import Draft
from g12.tools.translate.blocks.errors import NotTranslated
from g12.tools.translate.blocks.lexer import ForeignWord
from g12.tools.translate.blocks.positions import ORIGINS
from g12.tools.translate.rules.codes import check_axis

EXTRA = range(1, 4)  # of G154
BEFORE_EXTRA = 6  # G54 to G59
SYSTEM_CODES = range(110, 130)  # G codes of the first of G154


def numbered_offset(draft: Draft, code: ForeignWord) -> None:
    for own in ORIGINS.intersection(draft.codes()):
        raise NotTranslated(f"{own} and {code.code} in one block")
    named = code.number in SYSTEM_CODES
    number = SYSTEM_CODES.index(int(code.number)) + 1 if named else _take_number(draft, code.code)
    draft.put_first(f"G59.{_extra(number, f'G154 P{number}')}")
    draft.comments.append(code.code if named else f"{code.code} P{number}")


def _extra(number: int, name: str) -> int:
    if number not in EXTRA:
        raise NotTranslated(
            f"{name}: LinuxCNC has G54 to G59, and three more, G154 P1 to P3: choose one of them"
        )
    return number


def _take_number(draft: Draft, code: str) -> int:
    """Take P out, the number of an offset."""
    word = draft.take("P")
    if not word or word.kind != "number" or not word.number.is_integer():
        raise NotTranslated(f"{code} needs P and a whole number")
    return int(word.number)


def offset_by_program(draft: Draft, code: ForeignWord) -> None:
    kind = draft.take("L")
    number = int(kind.number) if kind and kind.kind == "number" else 0
    if draft.sure("distance", "G10 sets or adds") == "G91":
        raise NotTranslated("G10 under G91 adds to the offset: write G90 and its new value")
    if draft.control.is_lathe:
        raise NotTranslated("G10 of a lathe is not translated: set the offset on the machine")
    if number == 2:
        system = _take_number(draft, "G10 L2")
        if not 0 <= system <= BEFORE_EXTRA:
            raise NotTranslated(f"G10 L2 P{system} must be from 0 to {BEFORE_EXTRA}")
    elif number == 20:
        system = _take_number(draft, "G10 L20")
        system = BEFORE_EXTRA + _extra(system, f"G10 L20 P{system}")
    else:
        raise NotTranslated("G10 needs L2 or L20; set a tool's values in the tool table")
    words = draft.axis_words()
    draft.drop(words)
    if not words:
        raise NotTranslated(f"G10 L{number} without an axis sets nothing")
    for word in words:
        check_axis(draft, word)
    modes = draft.take_codes({"G90"})
    if not draft.is_empty():
        raise NotTranslated(f"{draft.words[-1].text} cannot be beside G10")
    first = f"G10 L2 P{system}" if system else "G52"
    draft.write([" ".join([*modes, first, *(word.text for word in words)])])
