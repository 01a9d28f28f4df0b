# SPDX-License-Identifier: GPL-2.0-or-later
"""Where C stands when a polar section begins, and whether the program has put it there.

C stays turned behind a section. The next one is turned on the part with it, unless the program
commands C in between, or gives it another zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path

from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.preview.executed_blocks import Text, read_lines
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.contour import BEGUN, SectionContour, ZeroLine
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import called_files

SAME_ANGLE = 1e-3  # degree


def with_zero_lines(
    sections: Sequence[SectionContour],
    moves: Sequence[Move],
    program: Path,
    codes: Codes,
    ini: Ini,
) -> list[SectionContour]:
    """Return the sections of a program, each polar one with what has become of C before it."""
    if not sections:
        return []
    lines = lines_with_c(read_lines(program), codes, ini)
    polar = [each for each in sections if not each.surface]
    found = {
        each.at: zero_line(before, each, moves, lines)
        for before, each in zip([None, *polar], polar)
    }
    return [replace(each, zero_line=found.get(each.at, BEGUN)) for each in sections]


def lines_with_c(texts: Sequence[Text], codes: Codes, ini: Ini) -> set[int]:
    """Return the lines, those in files of subs included, that have a C word for the axis."""
    subs = chain.from_iterable(map(read_lines, called_files(texts, ini)))
    return {text.number for text in chain(outside(texts, codes), subs) if has_c(text)}


def outside(texts: Iterable[Text], codes: Codes) -> Iterator[Text]:
    """Yield the lines outside of sections, of which C may be no axis."""
    for text, switch, inside in codes.with_switches(texts):
        if not (inside or switch):
            yield text


def has_c(text: Text) -> bool:
    """Tell whether a line has a C word."""
    return any(letter == "C" for letter, _ in text.words)


def zero_line(
    before: SectionContour | None, section: SectionContour, moves: Sequence[Move], lines: set[int]
) -> ZeroLine:
    """Return what has become of C since the section before, or the program's beginning."""
    between = moves[before.end if before else 0 : section.at]
    commanded = any(move.end[C] != move.start[C] or move.line in lines for move in between)
    if before is None:
        return ZeroLine(commanded)
    angle, other = (moves[each.at].start[C] for each in (section, before))
    turned = (angle - other + 180.0) % 360.0 - 180.0
    offsets = angle - section.c, moves[before.end - 1].end[C] - before.left_c
    commanded = commanded or abs(offsets[0] - offsets[1]) > SAME_ANGLE
    return ZeroLine(commanded, turned if abs(turned) > SAME_ANGLE else 0.0, before.last)
