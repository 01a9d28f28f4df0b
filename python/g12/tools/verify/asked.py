# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that a program's words ask for: circles, sections and shapes, in order."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.cylinder import SurfacePen
from g12.tools.verify.expected.polar import Pen
from g12.tools.verify.reading.circles import CircleReader, Target
from g12.tools.verify.reading.codes import CYLINDER, POLAR, Codes
from g12.tools.verify.reading.executed_subs import executed_everywhere
from g12.tools.verify.reading.sections import sections
from g12.tools.verify.reading.zero_line import with_zero_lines
from g12.tools.verify.shape import CalledShape, called_subs
from g12.tools.verify.subject import Subject

PENS = {POLAR: Pen, CYLINDER: SurfacePen}


class Asked(NamedTuple):
    """What a program asks for: circles, each with the block that does, sections, shapes, holes.

    ``still`` are the line and the code of each cycle that moves nothing, though it should.
    """

    circles: list[tuple[Block, Target]]
    sections: list[SectionContour]
    still: list[tuple[int, str]]
    shapes: Sequence[CalledShape] = ()
    holes: Sequence[CalledShape] = ()
    clamp_is_seen: bool = False

    @property
    def moves(self) -> set[int]:
        """The moves that they are cut by, by their indices."""
        blocks = [block for block, _ in (*self.circles, *self.holes)]
        cuts = [(each.at, each.end) for each in blocks]
        cuts += [(each.at, each.end) for each in self.sections]
        return {index for cut in cuts for index in range(*cut)}


def asked_of(tracer: Tracer, subject: Subject, tools: Tools, parameters: Parameters) -> Asked:
    """Return what a program's words ask for."""
    codes, program, trace = Codes(subject.ini), subject.program, subject.trace
    blocks, clamp_is_seen = executed_everywhere(tracer, program, trace, codes, tools, parameters)
    reader = CircleReader(codes, subject.ini, trace.moves, trace.diameters)
    pens = {kind: partial(pen, ini=subject.ini) for kind, pen in PENS.items()}
    found = sections(tracer, program, codes, pens, blocks, tools, parameters)
    still = [
        *still_blocks(blocks, codes),
        *((each.line, each.code) for each in found if each.is_still),
    ]
    cut = [each for each in found if each.end > each.at]
    cut = with_zero_lines(cut, trace.moves, program, codes, subject.ini)
    called = partial(called_subs, blocks, trace.moves, trace.diameters, subject.ini)
    shapes, holes = (list(called(sub)) for sub in (codes.shape_of, codes.holes_of))
    return Asked(list(reader.targets(blocks)), cut, still, shapes, holes, clamp_is_seen)


def still_blocks(blocks: Iterable[Block], codes: Codes) -> Iterator[tuple[int, str]]:
    """Yield the line and the code of each cycle and shape that moves nothing."""
    for block in blocks:
        if block.at == block.end and codes.cycle_of(block.text.call, block.codes):
            yield block.text.number, codes.name_of(block.codes)
        elif block.at == block.end and (codes.shape_of(block.text) or codes.holes_of(block.text)):
            yield block.text.number, block.text.call


def moves_there(tracer: Tracer, subject: Subject, parameters: Parameters) -> Sequence[Move] | None:
    """Return the moves with the work offsets that the machine's var file holds.

    None where they are others for more than the offsets.
    """
    stored = subject.ini.file("RS274NGC", "PARAMETER_FILE")
    if parameters is not None or not (stored and stored.is_file()):
        return subject.trace.moves
    trace = tracer.trace(subject.program, parameters=stored)
    moves = subject.trace.moves
    same = [move.block for move in trace.moves] == [move.block for move in moves]
    return trace.moves if same else None
