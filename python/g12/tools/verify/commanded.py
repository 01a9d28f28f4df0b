# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything that a program's words command: circles, sections, shapes and holes, in order."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from g12.tools.preview.executed_blocks import Block, Text
from g12.tools.preview.moves import Event, Move, Trace
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
from g12.tools.verify.result.finding import Finding

PENS = {POLAR: Pen, CYLINDER: SurfacePen}


class Commanded(NamedTuple):
    """What a program commands; each circle has its block.

    ``idle`` are the findings of the cycles and the sections that move nothing.
    ``clamped`` are the codes of C's clamp, None where no trace shows them.
    ``moves_there`` are the moves with the work offsets of the machine's var file, None where they
    differ by more than those. ``in_g7`` says from which move on X words are diameters or not.
    """

    circles: Sequence[tuple[Block, Target]] = ()
    sections: Sequence[SectionContour] = ()
    idle: Sequence[Finding] = ()
    shapes: Sequence[SubCall] = ()
    holes: Sequence[SubCall] = ()
    clamped: Sequence[Event] | None = None
    moves_there: Sequence[Move] | None = None
    in_g7: Sequence[tuple[int, bool]] = ()

    @property
    def on_face(self) -> list[SectionContour]:
        """The sections on the face."""
        return [section for section in self.sections if not section.surface]

    def in_diameters(self, index: int) -> bool:
        """Tell whether the X words outside of cuts are diameters at a move."""
        return next((is_on for at, is_on in reversed(self.in_g7) if at <= index), False)


def commanded_by(
    tracer: Tracer, program: Path, trace: Trace, tools: Tools, parameters: Parameters
) -> tuple[Trace, Commanded]:
    """Return a traced program with its tool tables, and what its words command."""
    ini, moves, codes = tracer.ini, trace.moves, Codes(tracer.ini)
    blocks, clamped, trace = executed_everywhere(tracer, program, trace, codes, tools, parameters)
    reader = CircleReader(codes, ini, trace)
    pens = {kind: partial(pen, ini=ini) for kind, pen in PENS.items()}
    found = sections(tracer, program, codes, pens, blocks, tools, parameters)
    still = [
        Finding("not-cut" if each.elements else "empty", each.line, {"code": each.code})
        for each in found
        if each.at == each.end
    ]
    cut = [each for each in found if each.end > each.at]
    subs = (codes.shape_of, codes.holes_of)
    shapes, holes = (list(_calls(blocks, tracer, trace, sub)) for sub in subs)
    if cut:
        cut = with_zero_lines(cut, [*shapes, *holes], moves, CLines(program, codes, ini))
    return trace, Commanded(
        list(reader.targets(blocks)),
        cut,
        [*_idle_blocks(blocks, codes), *still],
        shapes,
        holes,
        clamped,
        _moves_there(tracer, program, moves, parameters),
        _diameter_modes(blocks),
    )


def _diameter_modes(blocks: Sequence[Block]) -> list[tuple[int, bool]]:
    """Return G7 or not from moves on; that of a block counts for its own X word, too."""
    states = [(0, block.state) for block in blocks[:1]]
    states += [(block.at, block.state_after or block.state) for block in blocks]
    return [(at, bool(state["_lathe_diameter_mode"])) for at, state in states]


def _calls(
    blocks: Sequence[Block], tracer: Tracer, trace: Trace, named: Callable[[Text], str]
) -> Iterator[SubCall]:
    """Yield each call of the subs that are ``named`` which moves anything."""
    for block in (each for each in blocks if named(each.text) and each.end > each.at):
        first = trace.moves[block.at]
        yield SubCall(block, first, trace.radius(block.at), tracer.ini)


def _idle_blocks(blocks: Sequence[Block], codes: Codes) -> Iterator[Finding]:
    """Yield the cycles and the shapes that move nothing."""
    for block in (each for each in blocks if each.at == each.end):
        is_cycle = codes.cycle_of(block.text.call, block.codes)
        if is_cycle or codes.shape_of(block.text) or codes.holes_of(block.text):
            name = codes.name_of(block.codes) if is_cycle else block.text.call
            yield Finding("not-cut", block.text.number, {"code": name})


def _moves_there(
    tracer: Tracer, program: Path, moves: Sequence[Move], parameters: Parameters
) -> Sequence[Move] | None:
    stored = tracer.ini.file("RS274NGC", "PARAMETER_FILE")
    if parameters is not None or not (stored and stored.is_file()):
        return moves
    there = tracer.trace(program, parameters=stored).moves
    return there if [move.block for move in there] == [move.block for move in moves] else None
