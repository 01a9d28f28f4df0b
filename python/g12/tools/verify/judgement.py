# SPDX-License-Identifier: GPL-2.0-or-later
"""Every finding and note of a program, from all comparisons and rules, in the order of lines."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from g12.tools.path.part import Z, part_of
from g12.tools.path.track import limits_of
from g12.tools.preview.executed_blocks import read_lines
from g12.tools.preview.moves import Move
from g12.tools.verify.asked import Asked
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.mistakes.feeds import judge_feeds, judge_native_c
from g12.tools.verify.mistakes.home import judge_home
from g12.tools.verify.mistakes.levels import judge_levels
from g12.tools.verify.mistakes.modes import judge_return_levels
from g12.tools.verify.mistakes.reversals import judge_reversals
from g12.tools.verify.mistakes.spindle import judge_spindle
from g12.tools.verify.mistakes.tool_length import judge_tool_length
from g12.tools.verify.mistakes.travel import judge_travel
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.subject import Subject


def judged(
    subject: Subject,
    asked: Asked,
    there: Sequence[Move] | None,
    unseen: Sequence[tuple[int, str]],
    said: Sequence[Finding],
) -> list[Finding]:
    """Return what was ``said`` of cuts and material with what the rules find.

    ``there`` are the moves on the machine, None if they are not known.
    """
    trace, ini, known = subject.trace, subject.ini, asked.moves
    moves, cuts = trace.moves, list(cuts_of(asked, trace.moves))
    found = [
        *said,
        *(Finding("not-measured", line, {"code": code}) for line, code in unseen),
        *(Finding("not-cut", line, {"code": code}) for line, code in asked.still),
        *judge_travel(asked.circles, there, trace.events, ini),
        *judge_tool_length(cuts, moves, trace.lengths, trace.events),
        *judge_feeds(cuts, moves, limits_of(ini)),
        *judge_spindle(cuts, trace.events, ini),
        *judge_levels(cuts, moves),
        *judge_reversals(asked.sections),
        *not_judged(moves, known),
    ]
    if part_of(ini).turning:
        texts = read_lines(subject.program)
        found += [
            *judge_native_c(moves, known, subject.path),
            *judge_return_levels(texts, Codes(ini)),
            *judge_home(texts, ini),
        ]
    return sorted(found, key=lambda finding: finding.line)


def cuts_of(asked: Asked, moves: Sequence[Move]) -> Iterator[ProgramCut]:
    """Yield the pockets, sections and holes that a program asks for."""
    for block, target in asked.circles:
        source = target.source
        at, end = block.at, block.end
        yield ProgramCut(source.line, source.file, source.code, at, end, target.wall.face, False)
    for section in asked.sections:
        face = moves[section.at].start[Z] - section.height
        known = (section.line, section.file, section.code, section.at, section.end)
        feeds = tuple(element.feed for element in section.elements if element.feed)
        yield ProgramCut(*known, None if section.surface else face, True, feeds)
    for block, call in asked.holes:
        level = None if call.is_side else call.zero[1]
        yield ProgramCut(call.line, call.file, call.name, block.at, block.end, level, True)


def not_judged(moves: Sequence[Move], known: set[int]) -> Iterator[Finding]:
    """Yield the lines of feed moves that belong to no cut."""
    others = (move.block for i, move in enumerate(moves) if i not in known and move.kind != "rapid")
    lines = list(dict.fromkeys(others))
    if lines:
        yield Finding("plain-moves", lines[0], {"count": len(lines), "last": lines[-1]})
