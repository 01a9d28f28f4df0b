# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that a program's words ask for: circles, sections, shapes and holes, in order."""

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
from g12.tools.verify.reading.sections import sections, with_zero_lines
from g12.tools.verify.subject import Subject

PENS = {POLAR: Pen, CYLINDER: SurfacePen}


class Asked(NamedTuple):
    """What a program asks for: circles, shapes and holes each with the block that does.

    ``still`` are the line and the code of each cycle that moves nothing, though it should.
    """

    circles: Sequence[tuple[Block, Target]] = ()
    sections: Sequence[SectionContour] = ()
    still: Sequence[tuple[int, str]] = ()
    shapes: Sequence[tuple[Block, SubCall]] = ()
    holes: Sequence[tuple[Block, SubCall]] = ()
    clamp_is_seen: bool = False


def asked_of(tracer: Tracer, subject: Subject, tools: Tools, parameters: Parameters) -> Asked:
    """Return what a program's words ask for."""
    codes, program, trace = Codes(subject.ini), subject.program, subject.trace
    blocks, clamp_is_seen = executed_everywhere(tracer, program, trace, codes, tools, parameters)
    reader = CircleReader(codes, subject.ini, trace.moves, trace.diameters)
    pens = {kind: partial(pen, ini=subject.ini) for kind, pen in PENS.items()}
    found = sections(tracer, program, codes, pens, blocks, tools, parameters)
    still = [*still_blocks(blocks, codes)]
    still += [(each.line, each.code) for each in found if each.elements and each.at == each.end]
    cut = [each for each in found if each.end > each.at]
    cut = with_zero_lines(cut, trace.moves, program, codes, subject.ini)
    shapes, holes = (list(calls(blocks, subject, sub)) for sub in (codes.shape_of, codes.holes_of))
    return Asked(list(reader.targets(blocks)), cut, still, shapes, holes, clamp_is_seen)


def calls(
    blocks: Sequence[Block], subject: Subject, named: Callable[[Text], str]
) -> Iterator[tuple[Block, SubCall]]:
    """Yield each call of the subs that are ``named`` which moves anything."""
    for block in blocks:
        if named(block.text) and block.end > block.at:
            first = subject.trace.moves[block.at]
            radius = subject.trace.diameters.get(first.tool, 0.0) / 2
            yield block, SubCall(block, first, radius, subject.ini)


def still_blocks(blocks: Sequence[Block], codes: Codes) -> Iterator[tuple[int, str]]:
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
