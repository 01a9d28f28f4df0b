# SPDX-License-Identifier: GPL-2.0-or-later
"""Every finding and note of a program, from all comparisons and rules, in the order of lines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from g12.tools.path.part import Z, part_of
from g12.tools.path.track import limits_of
from g12.tools.preview.executed_blocks import Text
from g12.tools.preview.moves import Move
from g12.tools.units import MM, Unit
from g12.tools.verify.compare.drilled import judge_holes
from g12.tools.verify.findings import (
    pocket_notes,
)
from g12.tools.verify.mistakes.cut import ProgramCut
from g12.tools.verify.mistakes.feeds import judge_feeds, judge_native_c
from g12.tools.verify.mistakes.levels import judge_levels
from g12.tools.verify.mistakes.modes import judge_return_levels
from g12.tools.verify.mistakes.spindle import judge_spindle
from g12.tools.verify.mistakes.tool_length import judge_tool_length
from g12.tools.verify.pocket import judge_pocket
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.section_findings import judge_section
from g12.tools.verify.shape import judge_shape

if TYPE_CHECKING:
    from g12.tools.verify.proof import Asked, Proof

Judge = Callable[..., Iterator[str]]
Texts = Callable[[Unit], list[str]]


def judged(proof: Proof, texts: Sequence[Text]) -> list[Finding]:
    """Return the findings and notes of a proof; ``texts`` are the program's lines."""
    subject = proof.subject
    trace, ini = subject.trace, subject.ini
    moves = trace.moves
    cuts = list(cuts_of(proof.asked, moves))
    known = {index for some in proof.asked.moves for index in some}
    found = [
        *said_of_cuts(proof),
        *proof.material.judged,
        *judge_tool_length(cuts, moves, trace.lengths, trace.events),
        *judge_feeds(cuts, moves, limits_of(ini)),
        *judge_spindle(cuts, trace.events, ini),
        *judge_levels(cuts, moves),
        *not_judged(moves, known),
    ]
    if part_of(ini).turning:
        found += [
            *judge_native_c(moves, known, subject.path),
            *judge_return_levels(texts, Codes(ini)),
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
        source = (section.line, section.file, section.code, section.at, section.end)
        feeds = tuple(element.feed for element in section.elements if element.feed)
        yield ProgramCut(*source, None if section.surface else face, True, feeds)
    for block, call in asked.holes:
        level = None if call.is_side else call.zero[1]
        yield ProgramCut(call.line, call.file, call.name, block.at, block.end, level, True)


def not_judged(moves: Sequence[Move], known: set[int]) -> Iterator[Finding]:
    """Yield the lines of feed moves that belong to no cut."""
    others = (move.block for i, move in enumerate(moves) if i not in known and move.kind != "rapid")
    lines = list(dict.fromkeys(others))
    if lines:
        yield Finding("plain-moves", lines[0], {"count": len(lines), "last": lines[-1]})


def said_of_cuts(proof: Proof) -> Iterator[Finding]:
    """Yield what the judges of the kinds of cuts say."""
    tolerances = proof.tolerances
    for facts in proof.pockets:
        source = facts.target.source
        yield from judge_pocket(facts, tolerances.pocket)
        yield from noted(source.line, source.file, pocket_notes, facts)
    for facts in proof.sections:
        yield from judge_section(facts)
    for facts in proof.shapes:
        yield from judge_shape(facts)
    for facts in proof.holes:
        yield from judge_holes(facts)
    for line, code in proof.unseen:
        yield Finding("not-measured", line, {"code": code})
    for line, code in proof.still:
        yield Finding("not-cut", line, {"code": code})


def noted(line: int, file: str, judge: Judge, facts: object) -> Iterator[Finding]:
    """Yield the notes of a judge that gives sentences."""
    yield from in_words("noted", line, file, lambda unit: list(judge(facts, unit)))


def in_words(code: str, line: int, file: str, texts: Texts) -> Iterator[Finding]:
    """Yield a finding for each sentence that a function of the unit returns."""
    for at in range(len(texts(MM))):
        yield Finding(code, line, {"text": partial(nth, texts, at)}, file=file)


def nth(texts: Texts, at: int, unit: Unit) -> str:
    """Return one of the sentences that a function of the unit returns."""
    return texts(unit)[at]
