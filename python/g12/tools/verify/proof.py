# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything a program's pockets, shapes and sections can be held to, in one value.

What is asked for is read from the program's words, what is cut is measured from the motion that
LinuxCNC makes of it; the cycles' own planning has no part in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import NamedTuple

from g12.tools.machine.filter import OpenedProgram
from g12.tools.machine.ini import Ini
from g12.tools.material.material import Material
from g12.tools.material.stock import read_stock
from g12.tools.path.follow import Followed, follow
from g12.tools.path.part import Part, part_of, part_of_program
from g12.tools.path.samples import Samples
from g12.tools.path.slowest import pace_of, programmed_pace
from g12.tools.path.surface import Surface
from g12.tools.path.track import Track, limits_of, track
from g12.tools.preview.ended import ended, explained
from g12.tools.preview.executed_blocks import Block, read_lines
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.progress import Tell, counted, silent
from g12.tools.units import Unit, unit_of
from g12.tools.verify.axis_limits import (
    extent_of_block,
    has_one_zero,
    overruns_of,
    travel_of,
    widths_of,
)
from g12.tools.verify.compare.drilled import HolesFacts, measure_holes
from g12.tools.verify.compare.section_plane import x0_of
from g12.tools.verify.expected.calls import CallReading, SubCall
from g12.tools.verify.expected.contour import SectionContour, WordReading
from g12.tools.verify.expected.cylinder import SurfacePen
from g12.tools.verify.expected.polar import Pen
from g12.tools.verify.in_material import MaterialFacts, material_facts, zero_of
from g12.tools.verify.judgement import judged
from g12.tools.verify.pocket import PocketFacts, measure_pocket
from g12.tools.verify.reading.circles import CircleReader, Target
from g12.tools.verify.reading.codes import CYLINDER, POLAR, Codes
from g12.tools.verify.reading.executed_subs import executed_everywhere
from g12.tools.verify.reading.sections import sections
from g12.tools.verify.reading.zero_line import with_zero_lines
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.sections.section import SectionFacts, measure_section
from g12.tools.verify.sections.section_motion import axes_of_section
from g12.tools.verify.shape import CalledShape, ShapeFacts, called_subs, measure_shape
from g12.tools.verify.workpiece import Program, Workpiece, assumed_workpiece, given_workpiece

POCKET_TOLERANCE = 0.005  # mm
SAME_X0 = 1e-6  # mm
PENS = {POLAR: Pen, CYLINDER: SurfacePen}
RUN_ALLOWANCE = 0.001  # mm, of a run beyond POLAR_TOLERANCE, which is that of every section


@dataclass(frozen=True)
class Subject:
    """A program on a machine, as traced, and as a part sees it; ``samples`` are those of a run.

    Of its ``own`` moves alone it is, if those are given; ``drawn`` is their path, if it is known.
    """

    program: Path
    ini: Ini
    trace: Trace
    part: Part
    samples: Samples | None = None
    own: range | None = None
    drawn: Track | None = None

    @cached_property
    def path(self) -> Track:
        """The moves as one polyline in time."""
        limits, speed = limits_of(self.ini), self.trace.modes.speed
        return self.drawn or track(self.part, self.trace.moves, limits, speed, own=self.own)

    @cached_property
    def real(self) -> Followed | None:
        """The motion of the run, laid on the path."""
        if not self.samples:
            return None
        return follow(self.path, self.trace.moves, self.samples, self.ini.mm)

    def about(self, centre: float) -> Subject:
        """Return the same with the spindle's axis at another machine X."""
        same = abs(self.part.centre - centre) < SAME_X0
        return self if same else self._laid_on(replace(self.part, centre=centre))

    def on_surface(self, radius: float) -> Subject:
        """Return the same on a cylinder's unrolled surface."""
        return self._laid_on(Surface(turning=True, radius=radius))

    def of_section(self, section: SectionContour) -> Subject:
        """Return the same as the part of a section sees it; without a run its own moves alone."""
        own = None if self.samples else range(section.at, section.end)
        if section.surface:
            return self._laid_on(Surface(turning=True, radius=section.surface), own)
        return self._turned_about(x0_of(section, self.trace.moves[section.at]), own)

    def of_shape(self, call: SubCall) -> Subject:
        """Return the same as the part of a shape sees it; without a run its own moves alone."""
        return self._turned_about(call.zero[0], None if self.samples else call.moves)

    def _turned_about(self, centre: float, own: range | None) -> Subject:
        if abs(self.part.centre - centre) < SAME_X0:
            return self
        return self._laid_on(replace(self.part, centre=centre), own)

    def _laid_on(self, part: Part, own: range | None = None) -> Subject:
        return replace(self, part=part, own=own)


class StockText(NamedTuple):
    """A stock as a user says it, and the name of the unit of its numbers; None: the program's."""

    text: str
    units: str | None = None


class Asked(NamedTuple):
    """What a program asks for: circles, each with the block that does, sections, shapes, holes.

    ``still`` are the line and the code of each cycle that moves nothing, though it should.
    """

    circles: list[tuple[Block, Target]]
    sections: list[SectionContour]
    still: list[tuple[int, str]]
    shapes: Sequence[CalledShape] = ()
    holes: Sequence[CalledShape] = ()

    @property
    def moves(self) -> list[range]:
        """The moves that they are cut by, by their indices."""
        drilled = (block for block, _ in self.holes)
        every = [*(block for block, _ in self.circles), *self.sections, *drilled]
        return [range(each.at, each.end) for each in every]


NOTHING = Asked([], [], [])


class Tolerances(NamedTuple):
    """What a wall or a contour may be off, mm."""

    pocket: float
    polar: float


@dataclass(frozen=True)
class Proof:
    """What was measured.

    ``unseen`` are lines whose blocks make a cycle cut that belongs to no pocket and no section
    measured, and the cycle's code; ``still`` those of cycles that move nothing. ``asked`` is
    what the words ask for.
    ``opened`` is the user's file, None where that is what was read.
    """

    subject: Subject
    pockets: list[PocketFacts]
    sections: list[SectionFacts]
    unseen: list[tuple[int, str]]
    tolerances: Tolerances
    material: MaterialFacts
    still: list[tuple[int, str]] = field(default_factory=list)
    shapes: Sequence[ShapeFacts] = ()
    holes: Sequence[HolesFacts] = ()
    asked: Asked = NOTHING
    opened: OpenedProgram | None = None

    @cached_property
    def judged(self) -> list[Finding]:
        """Everything that is found, noted or not judged, in the order of lines."""
        return judged(self, read_lines(self.subject.program))

    def user_line(self, line: int, file: str = "") -> int:
        """Return a line in the user's file; one in a sub's own ``file`` stays."""
        return self.opened.source_line(line) if self.opened and not file else line

    def text(self, finding: Finding, unit: Unit) -> str:
        """Return the sentence of a finding with the user's lines."""
        text = finding.text(unit)
        return self.opened.in_source(text) if self.opened and not finding.file else text

    @property
    def findings(self) -> list[tuple[int, str]]:
        """Return everything that is not as programmed: the line, and what is wrong."""
        return [(each.line, each.text()) for each in self.judged if each.is_finding]


def prove(
    program: Path,
    ini: Ini,
    *,
    tools: Tools = None,
    parameters: Parameters = None,
    samples: Samples | None = None,
    tolerance: float | None = None,
    stock: StockText | None = None,
    tell: Tell = silent,
) -> Proof:
    """Return the proof of a program, of its real motion if there are samples of a run.

    ``parameters`` is what the program starts with; see ``Tracer.trace``. ``tolerance`` in mm
    replaces both that of pockets and that of sections, ``stock`` is what is cut. ``tell`` is
    told what is being done.
    """
    with Tracer(ini, tools=tools) as tracer:
        trace = ended(program, explained(tracer.trace(program, parameters=parameters), ini.path))
        subject = subject_of(program, ini, trace, samples)
        return prove_traced(tracer, subject, tools, parameters, tolerance, stock, tell)


def prove_traced(
    tracer: Tracer,
    subject: Subject,
    tools: Tools = None,
    parameters: Parameters = None,
    tolerance: float | None = None,
    stock: StockText | None = None,
    tell: Tell = silent,
) -> Proof:
    """Return the proof of a program that has been traced; see ``prove``."""
    asked = asked_of(tracer, subject, tools, parameters)
    there = moves_there(tracer, subject, parameters)
    for first in [each for each in asked.sections if not each.surface][:1]:
        subject = subject.about(x0_of(first, subject.trace.moves[first.at]))
    ini, run = subject.ini, RUN_ALLOWANCE if subject.samples else 0.0
    usual = Tolerances(POCKET_TOLERANCE, ini.settings.tolerance(ini.mm) * ini.mm + run)
    tolerances = usual if tolerance is None else Tolerances(tolerance, tolerance)
    return measured(subject, asked, there, tolerances, stock, tell)


def subject_of(program: Path, ini: Ini, trace: Trace, samples: Samples | None = None) -> Subject:
    """Return a traced program as its part sees it, and a run of it."""
    return Subject(program, ini, trace, part_of_program(ini, trace), samples)


def asked_of(tracer: Tracer, subject: Subject, tools: Tools, parameters: Parameters) -> Asked:
    """Return what a program's words ask for."""
    codes, program = Codes(subject.ini), subject.program
    blocks = executed_everywhere(tracer, program, subject.trace, codes, tools, parameters)
    settings = subject.ini.settings
    reader = CircleReader(
        codes,
        subject.trace.moves,
        subject.trace.diameters,
        spiral=settings.clearing == "spiral",
        traverse=settings.yasnac_traverse * subject.ini.mm,
        helix_angle=settings.entry_angle if settings.entry == "helix" else None,
        plunge_share=settings.plunge_feed / 100,
    )
    rapid_feed = settings.polar_g0_feed and settings.polar_g0_feed * subject.ini.mm
    reading = WordReading(
        settings.polar_x, rapid_feed, subject.ini.tool_beside, settings.cylinder_word
    )
    pens = {kind: partial(pen, reading=reading) for kind, pen in PENS.items()}
    found = sections(tracer, program, codes, pens, blocks, tools, parameters)
    still = [
        (block.text.number, codes.name_of(block.codes))
        for block in blocks
        if block.at == block.end and codes.cycle_of(block.text.call, block.codes)
    ]
    still += [
        (block.text.number, block.text.call)
        for block in blocks
        if block.at == block.end and (codes.shape_of(block.text) or codes.holes_of(block.text))
    ]
    still += [(each.line, each.code) for each in found if each.elements and each.at == each.end]
    found = [each for each in found if each.end > each.at]
    found = with_zero_lines(found, subject.trace.moves, program, codes, subject.ini)
    moves, diameters = subject.trace.moves, subject.trace.diameters
    calls = CallReading(settings.polar_x, settings.plunge_feed / 100, settings.entry_angle)
    subs = (codes.shape_of, codes.holes_of)
    shapes, holes = (list(called_subs(blocks, moves, diameters, calls, sub)) for sub in subs)
    return Asked(list(reader.targets(blocks)), found, still, shapes, holes)


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


def measured(
    subject: Subject,
    asked: Asked,
    there: Sequence[Move] | None,
    tolerances: Tolerances,
    stock: StockText | None,
    tell: Tell,
) -> Proof:
    """Return what is measured of a program; ``there`` are its moves on the machine, if known."""
    moves, piece = subject.trace.moves, workpiece_of(subject, asked, stock)
    pockets = measured_pockets(subject, asked, there, piece.material, tolerances.pocket, tell)
    found = measured_sections(subject, asked.sections, tolerances.polar, tell)
    shapes = measured_shapes(subject, asked.shapes, tolerances.polar, tell)
    tell("looking for rapids through material")
    material = material_facts(program_of(subject, asked), piece)
    unseen = unseen_in(moves, Codes(subject.ini), asked.moves)
    told = {"still": asked.still, "asked": asked, "shapes": shapes}
    told["holes"] = measured_holes(subject, asked.holes, tolerances.polar)
    return Proof(subject, pockets, found, unseen, tolerances, material, **told)


def measured_pockets(
    subject: Subject,
    asked: Asked,
    there: Sequence[Move] | None,
    material: Material,
    tolerance: float,
    tell: Tell,
) -> list[PocketFacts]:
    """Return what is measured of a program's pockets, with the travel that they need."""
    trace, real, travel = subject.trace, subject.real, travel_of(subject.ini)
    pace = partial(programmed_pace, trace.moves, limits_of(subject.ini), trace.modes.speed)
    if real:
        pace = partial(pace_of, path=subject.path, real=real)
    extents = [extent_of_block(block, there) if there else None for block, _ in asked.circles]
    widths = widths_of(extents) if there and has_one_zero(trace.events) else {}
    found = []
    pairs = list(zip(asked.circles, extents))
    for (block, target), extent in counted(pairs, "measuring pocket", tell):
        facts = measure_pocket(block, target, trace.moves, material, tolerance, pace, real)
        overruns = None if extent is None else tuple(overruns_of(extent, travel, widths))
        found.append(replace(facts, overruns=overruns))
    return found


def measured_sections(
    subject: Subject, asked: Sequence[SectionContour], tolerance: float, tell: Tell
) -> list[SectionFacts]:
    """Return what is measured of a program's sections, those on a cylinder on its surface."""
    axes = axes_of_section(subject.ini) if asked else None
    moves, diameters = subject.trace.moves, subject.trace.diameters
    found, surfaces = [], {}
    for each in counted(asked, "measuring section", tell):
        view = surfaces.get(each.surface) or subject.of_section(each)
        if each.surface and subject.samples:  # of a run: all of it, to be used again
            surfaces[each.surface] = view
        facts = measure_section(each, view.path, moves, diameters, axes, tolerance, view.real)
        found.append(facts)
    return found


def measured_shapes(
    subject: Subject, asked: Sequence[CalledShape], tolerance: float, tell: Tell
) -> list[ShapeFacts]:
    """Return what is measured of a program's shapes on a face."""
    axes, moves = axes_of_section(subject.ini) if asked else None, subject.trace.moves
    return [
        measure_shape(each, subject.of_shape(each[1]).path, moves, axes, tolerance)
        for each in counted(asked, "measuring shape", tell)
    ]


def measured_holes(
    subject: Subject, asked: Sequence[CalledShape], tolerance: float
) -> list[HolesFacts]:
    """Return what is measured of a program's holes with C."""
    moves, clamps = subject.trace.moves, bool(subject.ini.settings.c_clamp)
    return [measure_holes(each, moves, tolerance, clamps, subject.real) for each in asked]


def program_of(subject: Subject, asked: Asked) -> Program:
    """Return what is judged in the material."""
    trace, part = subject.trace, subject.part
    holes = [call for _, call in asked.holes]
    return Program(
        trace.moves, part, asked.circles, asked.sections, trace.diameters, subject.real, holes
    )


def workpiece_of(subject: Subject, asked: Asked, stock: StockText | None) -> Workpiece:
    """Return what a program is cut from, assumed where no stock is given.

    Raises UsageError for a text that is no stock of the machine's.
    """
    program = program_of(subject, asked)
    if stock is None:
        return assumed_workpiece(program)
    unit = unit_of(subject.trace.modes.gcodes, stock.units)
    said = read_stock(stock.text, part_of(subject.ini).turning, unit)
    zero = zero_of(asked.circles, asked.sections, program.moves, program.holes)
    return given_workpiece(program, said, zero)


def unseen_in(moves: Sequence[Move], codes: Codes, seen: Iterable[range]) -> list[tuple[int, str]]:
    """Return each line and code that makes moves of a cycle outside the ranges seen."""
    known = {index for some in seen for index in some}
    found = (
        (move.block, move.remap)
        for index, move in enumerate(moves)
        if index not in known and codes.knows(move.remap)
    )
    return list(dict.fromkeys(found))
