# SPDX-License-Identifier: GPL-2.0-or-later
"""What has become of C before each polar section: where its zero line is on the part.

C stays turned after a section, a shape and holes. The next section is turned on the part with it,
unless the program commands C in between, or gives it another zero.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from g12.tools.machine.ini import Ini
from g12.tools.path.part import C
from g12.tools.preview.executed_blocks import Text, is_number, read_lines
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.contour import SectionContour, ZeroLine
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.reading.executed_subs import called_files

SAME_ANGLE = 1e-3  # degree


class CutBefore(NamedTuple):
    """A cut that turns C: its moves, its first and last line, whether it is on the face.

    ``zero`` is its zero line and ``offset`` the program's C0 after it, both as the machine's C.
    """

    own: range
    line: int
    last: int
    on_face: bool
    zero: float
    offset: float


class CLines:
    """The C words of a program and of its subs outside of sections, by their lines."""

    def __init__(self, program: Path, codes: Codes, ini: Ini) -> None:
        texts = read_lines(program)
        flagged = codes.with_switches(texts)
        own = (text for text, switch, inside in flagged if not (inside or switch))
        self._program = _c_words(own)
        self._every = _c_words(chain.from_iterable(map(read_lines, called_files(texts, ini))))
        for line, words in self._program.items():
            self._every.setdefault(line, []).extend(words)

    def words(self, move: Move) -> list[str]:
        """Return the C words of a move's line; the move of a sub may be in a file of its own."""
        lines = self._program if move.line == move.block else self._every
        return lines.get(move.line, [])

    def set_angle(self, move: Move, offset: float) -> bool:
        """Tell whether C goes to an angle that is commanded, and not by an increment (G91).

        ``offset`` is the program's C0.
        """
        words = self.words(move)
        if not words:
            return move.end[C] != move.start[C]
        to = move.end[C] - offset
        return any(not is_number(word) or _apart(to, float(word)) < SAME_ANGLE for word in words)


def _c_words(texts: Iterable[Text]) -> dict[int, list[str]]:
    found: dict[int, list[str]] = {}
    for text in texts:
        if "C" in dict(text.words):
            found.setdefault(text.number, []).append(dict(text.words)["C"])
    return found


def _apart(one: float, other: float) -> float:
    """Return by how much two angles of C differ in any turn, degrees."""
    return abs(math.remainder(one - other, 360.0))


def with_zero_lines(
    sections: Sequence[SectionContour],
    calls: Sequence[SubCall],
    moves: Sequence[Move],
    lines: CLines,
) -> list[SectionContour]:
    """Return the sections of a program, each polar one with what has become of C before it.

    ``calls`` are those of shapes and holes. The section in a shape is the shape's.
    """
    called = [call.moves for call in calls]
    own = [each for each in sections if not any(each.at in moves_of for moves_of in called)]
    cuts = [*map(_of_call, calls), *(_of_section(each, moves) for each in own)]
    cuts.sort(key=lambda cut: cut.own.stop)
    found = {each.at: zero_line(each, cuts, moves, lines) for each in own if not each.surface}
    return [replace(each, zero_line=found.get(each.at, each.zero_line)) for each in sections]


def _of_call(call: SubCall) -> CutBefore:
    zero = call.zero[2]
    return CutBefore(call.moves, call.line, call.line, not call.is_side, zero, zero)


def _of_section(section: SectionContour, moves: Sequence[Move]) -> CutBefore:
    own, block = range(section.at, section.end), moves[section.at].block
    lines = (block, block) if section.file else (section.line, section.last)
    zero, c_after = moves[section.at].start[C], section.state_after.get("_c", math.nan)
    after = moves[section.end].start if section.end < len(moves) else moves[section.end - 1].end
    offset = after[C] - c_after  # the kinematics of the face turn C without a move of it
    return CutBefore(own, *lines, not section.surface, zero, offset)


def zero_line(
    section: SectionContour, cuts: Sequence[CutBefore], moves: Sequence[Move], lines: CLines
) -> ZeroLine:
    """Return what has become of C since the cut before, or since the program's beginning.

    It is turned against the cuts on the face where it agrees with none of them, without one against
    the program's C0.
    """
    before = [cut for cut in cuts if cut.own.stop <= section.at]
    between = moves[before[-1].own.stop if before else 0 : section.at]
    angle = moves[section.at].start[C]
    offset = angle - section.c
    commanded = any(lines.set_angle(move, offset) for move in between)
    if not before:
        return ZeroLine(commanded)
    last, faces = before[-1], [cut for cut in before if cut.on_face]
    # G92 C0 declares C's present angle its zero; other offsets only change what it is called
    is_zeroed = abs(offset - last.offset) > SAME_ANGLE and _apart(section.c, 0.0) < SAME_ANGLE
    commanded = commanded or is_zeroed
    if _apart(moves[last.own.stop].start[C], last.zero) < SAME_ANGLE:
        # from the zero line an increment indexes the part
        commanded = commanded or any(map(lines.words, between))
    zeros = [cut.zero for cut in faces] or [offset]
    turned = math.remainder(angle - zeros[-1], 360.0)
    if any(_apart(angle, zero) < SAME_ANGLE for zero in zeros):
        turned = 0.0
    return ZeroLine(commanded, turned, last.last, faces[-1].line if faces else 0)
