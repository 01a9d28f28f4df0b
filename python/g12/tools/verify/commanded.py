# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that a program's words command: circles, sections, shapes and holes, in order."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

from g12.tools.preview.executed_blocks import Block, Text
from g12.tools.preview.moves import Move
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.cylinder import SurfacePen
from g12.tools.verify.expected.polar import Pen
from g12.tools.verify.expected.words import SubCall
from g12.tools.verify.reading.circles import CircleReader, Target
from g12.tools.verify.reading.codes import CYLINDER, POLAR, Codes
from g12.tools.verify.reading.executed_subs import executed_everywhere
from g12.tools.verify.reading.sections import sections
from g12.tools.verify.reading.zero_lines import CLines, with_zero_lines
from g12.tools.verify.subject import Subject

PENS = {POLAR: Pen, CYLINDER: SurfacePen}


class Commanded(NamedTuple):
    """What a program commands; each circle has its block.

    ``idle`` are the line and the code of each cycle that moves nothing, though it should.
    ``clamp_is_traced`` says that events show the codes of C's clamp.
    """

    circles: Sequence[tuple[Block, Target]] = ()
    sections: Sequence[SectionContour] = ()
    idle: Sequence[tuple[int, str]] = ()
    shapes: Sequence[SubCall] = ()
    holes: Sequence[SubCall] = ()
    clamp_is_traced: bool = False


def commanded_by(
    tracer: Tracer, subject: Subject, tools: Tools, parameters: Parameters
) -> Commanded:
    """Return what a program's words command."""
    codes, program, trace = Codes(subject.ini), subject.program, subject.trace
    blocks, clamp_is_traced = executed_everywhere(tracer, program, trace, codes, tools, parameters)
    reader = CircleReader(codes, subject.ini, trace.moves, trace.diameters)
    pens = {kind: partial(pen, ini=subject.ini) for kind, pen in PENS.items()}
    found = sections(tracer, program, codes, pens, blocks, tools, parameters)
    idle = [*_idle_blocks(blocks, codes)]
    idle += [(each.line, each.code) for each in found if each.elements and each.at == each.end]
    cut = [each for each in found if each.end > each.at]
    shapes, holes = (list(calls(blocks, subject, sub)) for sub in (codes.shape_of, codes.holes_of))
    if cut:
        c_lines = CLines(program, codes, subject.ini)
        cut = with_zero_lines(cut, [*shapes, *holes], trace.moves, c_lines)
    return Commanded(list(reader.targets(blocks)), cut, idle, shapes, holes, clamp_is_traced)


def calls(
    blocks: Sequence[Block], subject: Subject, named: Callable[[Text], str]
) -> Iterator[SubCall]:
    """Yield each call of the subs that are ``named`` which moves anything."""
    for block in blocks:
        if named(block.text) and block.end > block.at:
            first = subject.trace.moves[block.at]
            radius = subject.trace.diameters.get(first.tool, 0.0) / 2
            yield SubCall(block, first, radius, subject.ini)


def _idle_blocks(blocks: Sequence[Block], codes: Codes) -> Iterator[tuple[int, str]]:
    """Yield the line and the code of each cycle and shape that moves nothing."""
    for block in (each for each in blocks if each.at == each.end):
        if codes.cycle_of(block.text.call, block.codes):
            yield block.text.number, codes.name_of(block.codes)
        elif codes.shape_of(block.text) or codes.holes_of(block.text):
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
