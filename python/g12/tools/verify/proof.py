# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything a program's pockets, shapes and sections can be held to, in one value.

What is asked for is read from the program's words, what is cut is measured from the motion that
LinuxCNC makes of it; the cycles' own planning has no part in it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from g12.tools.machine.filter import OpenedProgram
from g12.tools.machine.ini import Ini
from g12.tools.material.material import Material
from g12.tools.material.stock import StockText
from g12.tools.path.samples import Samples
from g12.tools.path.slowest import Pace, pace_of, programmed_pace
from g12.tools.path.track import limits_of
from g12.tools.preview.ended import ended, explained
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.progress import Tell, counted, silent
from g12.tools.units import Unit
from g12.tools.verify.asked import Asked, asked_of, moves_there
from g12.tools.verify.compare.clamp import Clamp
from g12.tools.verify.compare.drilled import HolesFacts, measure_holes
from g12.tools.verify.compare.section_plane import x0_of
from g12.tools.verify.in_material import judge_material
from g12.tools.verify.judgement import judged
from g12.tools.verify.pocket import PocketFacts, measure_pocket
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import RUN, WALL
from g12.tools.verify.sections.section import SectionFacts, measure_section
from g12.tools.verify.sections.section_motion import axes_of_section
from g12.tools.verify.shape import ShapeFacts, measure_shape
from g12.tools.verify.subject import Subject, subject_of
from g12.tools.verify.workpiece import Workpiece, workpiece_of

Facts = PocketFacts | SectionFacts | ShapeFacts | HolesFacts


class Tolerances(NamedTuple):
    """What a wall or a contour may be off, mm."""

    pocket: float
    polar: float


@dataclass(frozen=True)
class Proof:
    """What was measured, and ``judged`` of it: findings, notes, what was not, in order of lines.

    ``asked`` is what the words ask for, ``workpiece`` what is cut. ``unseen`` are lines whose
    blocks make a cycle cut that belongs to nothing measured, and the cycle's code. ``opened`` is
    the user's file, None where that is what was read.
    """

    subject: Subject
    asked: Asked
    workpiece: Workpiece
    tolerances: Tolerances
    pockets: Sequence[PocketFacts] = ()
    sections: Sequence[SectionFacts] = ()
    shapes: Sequence[ShapeFacts] = ()
    holes: Sequence[HolesFacts] = ()
    unseen: Sequence[tuple[int, str]] = ()
    judged: Sequence[Finding] = ()
    opened: OpenedProgram | None = None

    @property
    def still(self) -> list[tuple[int, str]]:
        """The lines and the codes of cycles that move nothing."""
        return self.asked.still

    @property
    def given(self) -> Workpiece | None:
        """What is cut if a stock was given, None if it is assumed."""
        return self.workpiece if self.workpiece.stock else None

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
    allowed = tolerances_of(subject, tolerance)
    workpiece = workpiece_of(subject, asked, stock)
    pockets = measured_pockets(subject, asked, workpiece.material, allowed.pocket, tell)
    sections = measured_sections(subject, asked, allowed.polar, tell)
    shapes = measured_shapes(subject, asked, allowed.polar, tell)
    holes = measured_holes(subject, asked, allowed.polar)
    tell("looking for rapids through material")
    unseen = unseen_in(subject, asked)
    cuts: list[Facts] = [*pockets, *sections, *shapes, *holes]
    said = [each for facts in cuts for each in facts.judged]
    said += judge_material(workpiece)
    found = judged(subject, asked, there, unseen, said)
    cut = pockets, sections, shapes, holes
    return Proof(subject, asked, workpiece, allowed, *cut, unseen=unseen, judged=found)


def tolerances_of(subject: Subject, tolerance: float | None) -> Tolerances:
    """Return what walls and contours may be off: of a run RUN more than POLAR_TOLERANCE."""
    if tolerance is not None:
        return Tolerances(tolerance, tolerance)
    ini = subject.ini
    return Tolerances(WALL, ini.settings.tolerance(ini.mm) * ini.mm + RUN * bool(subject.samples))


def measured_pockets(
    subject: Subject, asked: Asked, material: Material, tolerance: float, tell: Tell
) -> list[PocketFacts]:
    """Return what is measured of a program's pockets."""
    moves, real, pace = subject.trace.moves, subject.real, pace_in(subject)
    return [
        measure_pocket(block, target, moves, material, tolerance, pace, real)
        for block, target in counted(asked.circles, "measuring pocket", tell)
    ]


def pace_in(subject: Subject) -> Callable[[Sequence[int], Sequence[int]], Pace]:
    """Return what gives the pace of some moves on a part that stands."""
    if subject.real:
        return partial(pace_of, path=subject.path, real=subject.real)
    trace = subject.trace
    return partial(programmed_pace, trace.moves, limits_of(subject.ini), trace.modes.speed)


def measured_sections(
    subject: Subject, asked: Asked, tolerance: float, tell: Tell
) -> list[SectionFacts]:
    """Return what is measured of a program's sections, those on a cylinder on its surface."""
    axes = axes_of_section(subject.ini) if asked.sections else None
    moves, diameters = subject.trace.moves, subject.trace.diameters
    found: list[SectionFacts] = []
    surfaces: dict[float, Subject] = {}
    for each in counted(asked.sections, "measuring section", tell):
        view = surfaces.get(each.surface) or subject.of_section(each)
        if each.surface and subject.samples:  # of a run: all of it, to be used again
            surfaces[each.surface] = view
        facts = measure_section(each, view.path, moves, diameters, axes, tolerance, view.real)
        found.append(facts)
    return found


def measured_shapes(
    subject: Subject, asked: Asked, tolerance: float, tell: Tell
) -> list[ShapeFacts]:
    """Return what is measured of a program's shapes on a face."""
    axes, moves = axes_of_section(subject.ini) if asked.shapes else None, subject.trace.moves
    return [
        measure_shape(
            each, subject.about(each[1].zero[0], each[1].moves).path, moves, axes, tolerance
        )
        for each in counted(asked.shapes, "measuring shape", tell)
    ]


def measured_holes(subject: Subject, asked: Asked, tolerance: float) -> list[HolesFacts]:
    """Return what is measured of a program's holes with C."""
    moves, codes = subject.trace.moves, [f"M{code}" for code in subject.ini.settings.c_clamp]
    clamp = Clamp(codes, asked.clamp_is_seen)
    return [measure_holes(each, moves, tolerance, clamp, subject.real) for each in asked.holes]


def unseen_in(subject: Subject, asked: Asked) -> list[tuple[int, str]]:
    """Return each line and code that makes moves of a cycle which is not measured."""
    codes, known = Codes(subject.ini), asked.moves
    found = (
        (move.block, move.remap)
        for index, move in enumerate(subject.trace.moves)
        if index not in known and codes.knows(move.remap)
    )
    return list(dict.fromkeys(found))
