# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything a program's pockets, shapes and sections can be held to, in one value.

What is expected is read from the program's words. What is actual is measured from the motion that
LinuxCNC makes of it. The planners have no part in it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from g12.tools.machine.filter import OpenedProgram
from g12.tools.machine.ini import Ini
from g12.tools.material.stock import StockText
from g12.tools.path.lathe_axes import lathe_axes
from g12.tools.path.part import part_of
from g12.tools.path.samples import Samples
from g12.tools.path.slowest import pace_of
from g12.tools.path.track import limits_of
from g12.tools.preview.ended import ended, explained
from g12.tools.preview.executed_blocks import read_lines
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.progress import Report, counted, silent
from g12.tools.units import Unit
from g12.tools.verify.called import Clamp, measure_holes, measure_shape
from g12.tools.verify.clamp import judge_clamp
from g12.tools.verify.commanded import Commanded, commanded_by
from g12.tools.verify.in_material import judge_material
from g12.tools.verify.mistakes.tool import (
    judge_feeds,
    judge_levels,
    judge_native_c,
    judge_spindle,
    judge_tool_length,
)
from g12.tools.verify.mistakes.travel import judge_travel
from g12.tools.verify.mistakes.words import (
    judge_home,
    judge_left_offset,
    judge_preview,
    judge_return_levels,
    judge_reversals,
    judge_unrun,
)
from g12.tools.verify.pocket import measure_pocket
from g12.tools.verify.rapids import judge_rapid_lengths
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.result.cut import MeasuredCut
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import RUN, WALL
from g12.tools.verify.sections.section import measure_section
from g12.tools.verify.subject import Subject, subject_of
from g12.tools.verify.workpiece import Workpiece, workpiece_of


class Tolerances(NamedTuple):
    """What a wall or a contour may be off, mm."""

    pocket: float
    polar: float


class Cuts(NamedTuple):
    """What was measured of a program's cuts, by kind."""

    pockets: Sequence[MeasuredCut] = ()
    sections: Sequence[MeasuredCut] = ()
    shapes: Sequence[MeasuredCut] = ()
    holes: Sequence[MeasuredCut] = ()


@dataclass(frozen=True)
class Proof:
    """What was measured, and ``judged`` of it: findings, notes, what was not, in order of lines.

    ``workpiece`` is what is cut, ``opened`` the user's file, None where that is what was read.
    """

    subject: Subject
    workpiece: Workpiece
    tolerances: Tolerances
    cuts: Cuts
    judged: Sequence[Finding]
    opened: OpenedProgram | None = None

    @property
    def pockets(self) -> Sequence[MeasuredCut]:
        return self.cuts.pockets

    @property
    def sections(self) -> Sequence[MeasuredCut]:
        """The sections of polar interpolation and those on a cylinder."""
        return self.cuts.sections

    @property
    def given(self) -> Workpiece | None:
        """What is cut if a stock was given, None if it is assumed."""
        return self.workpiece if self.workpiece.stock else None

    def user_line(self, line: int, file: str = "") -> int:
        """Return a line in the user's file; one in a sub's own ``file`` stays."""
        return self.opened.source_line(line) if self.opened and not file else line

    def text(self, finding: Finding, unit: Unit) -> str:
        text = finding.text(unit)
        return self.opened.in_source(text) if self.opened and not finding.file else text

    def lines_with(self, code: str) -> list[tuple[int, str]]:
        """Return the lines with a finding, each with the program's code that it names."""
        return [(each.line, each.values["code"]) for each in self.judged if each.code == code]

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
    tell: Report = silent,
) -> Proof:
    """Return the proof of a program, of its real motion if there are samples of a run.

    ``parameters`` is what the program starts with; see ``Tracer.trace``. ``tolerance`` in mm
    replaces both that of pockets and that of sections, ``stock`` is what is cut. ``tell`` is
    called with the name of each step.
    """
    trace, commanded = moves_and_words(program, ini, tools, parameters)
    subject = subject_of(program, ini, ended(program, trace), samples, commanded)
    return prove_subject(subject, tolerance, stock, tell)


def moves_and_words(
    program: Path, ini: Ini, tools: Tools = None, parameters: Parameters = None
) -> tuple[Trace, Commanded]:
    """Return the trace of a program, and what its words command: nothing if it is refused."""
    with Tracer(ini, tools=tools) as tracer:
        trace = explained(tracer.trace(program, parameters=parameters), ini.path, program)
        if trace.error:
            return trace, Commanded()
        return commanded_by(tracer, program, trace, tools, parameters)


def prove_subject(
    subject: Subject,
    tolerance: float | None = None,
    stock: StockText | None = None,
    tell: Report = silent,
) -> Proof:
    """Return the proof of a program whose words were read; see ``prove``."""
    allowed = _tolerances_of(subject, tolerance)
    workpiece = workpiece_of(subject, stock)
    cuts = compared(subject, workpiece, allowed, tell)
    tell("looking for rapids through material")
    judged = sorted(_judged(subject, workpiece, cuts), key=lambda finding: finding.line)
    return Proof(subject, workpiece, allowed, cuts, judged)


def _tolerances_of(subject: Subject, tolerance: float | None) -> Tolerances:
    """Return what walls and contours may be off: of a run RUN more than POLAR_TOLERANCE."""
    if tolerance is not None:
        return Tolerances(tolerance, tolerance)
    ini = subject.ini
    return Tolerances(WALL, ini.settings.tolerance(ini.mm) * ini.mm + RUN * bool(subject.samples))


def compared(subject: Subject, workpiece: Workpiece, allowed: Tolerances, tell: Report) -> Cuts:
    """Return each cut with what was made of it against what its words command."""
    commanded, moves, real, ini = subject.commanded, subject.moves, subject.real, subject.ini
    pace = partial(pace_of, path=subject.path, real=real)
    axes = lathe_axes(ini) if commanded.sections or commanded.shapes else None
    clamp = Clamp([f"M{code}" for code in ini.settings.c_clamp], commanded.clamped is not None)
    polar = allowed.polar
    return Cuts(
        [
            measure_pocket(*circle, moves, workpiece.material, allowed.pocket, pace, real)
            for circle in counted(commanded.circles, "measuring pocket", tell)
        ],
        [
            measure_section(subject.view(each, axes, polar))
            for each in counted(commanded.sections, "measuring section", tell)
        ],
        [
            measure_shape(each, subject.about(each.zero[0], each.moves), axes, polar)
            for each in counted(commanded.shapes, "measuring shape", tell)
        ],
        [measure_holes(each, moves, polar, clamp, pace, real) for each in commanded.holes],
    )


def _judged(subject: Subject, workpiece: Workpiece, cuts: Cuts) -> Iterator[Finding]:
    """Yield what was found of each cut, of the material, and of the words."""
    commanded, trace, ini = subject.commanded, subject.trace, subject.ini
    known = {index for cut in (*cuts.pockets, *cuts.sections, *cuts.holes) for index in cut.own}
    unmeasured = _unmeasured_in(subject, known)
    sections = list(_as_called(cuts.sections, cuts.shapes))
    all_cuts = [*cuts.pockets, *sections, *cuts.holes]
    yield from (each for cut in (*all_cuts, *cuts.shapes) for each in cut.judged)
    yield from judge_material(workpiece, all_cuts)
    yield from (Finding("not-measured", line, {"code": code}) for line, code in unmeasured)
    yield from commanded.idle
    yield from judge_travel(commanded.circles, commanded.moves_there, trace.events, ini)
    yield from _mistakes(subject, all_cuts, known)
    run = {cut.line for kind in cuts for cut in kind if not cut.file}
    run |= {line for line, _ in unmeasured} | {each.line for each in commanded.idle}
    yield from judge_unrun(read_lines(subject.program), Codes(ini), run)


def _unmeasured_in(subject: Subject, known: set[int]) -> list[tuple[int, str]]:
    """Return each line and code that makes moves of a cycle which is not measured."""
    codes = Codes(subject.ini)
    found = (
        (move.block, move.remap)
        for index, move in enumerate(subject.moves)
        if index not in known and codes.knows(move.remap)
    )
    return list(dict.fromkeys(found))


def _mistakes(subject: Subject, cuts: Sequence[MeasuredCut], known: set[int]) -> Iterator[Finding]:
    """Yield what the rules about words find; ``known`` are the moves of cuts."""
    trace, ini, moves = subject.trace, subject.ini, subject.moves
    texts = read_lines(subject.program)
    yield from judge_tool_length(cuts, trace)
    yield from judge_rapid_lengths(subject, known) if not part_of(ini).turning else ()
    yield from judge_feeds(cuts, moves, limits_of(ini))
    yield from judge_spindle(cuts, trace.events, ini)
    yield from judge_levels(cuts, moves)
    yield from judge_reversals(subject.commanded.sections)
    yield from judge_preview(texts, ini.swaps_pockets)
    yield from judge_left_offset(texts, trace.state)
    yield from not_judged(moves, known)
    if part_of(ini).turning:
        yield from judge_clamp(subject)
        yield from judge_native_c(moves, known, subject.path)
        yield from judge_return_levels(texts, Codes(ini))
        yield from judge_home(texts, ini)


def _as_called(
    sections: Sequence[MeasuredCut], shapes: Sequence[MeasuredCut]
) -> Iterator[MeasuredCut]:
    """Yield sections, that in a shape's own sub with the user's line that calls the shape.

    Findings about the whole section get that line, too.
    """
    for section in sections:
        callers = (shape for shape in shapes if section.own.start in shape.own)
        caller = next(callers, section)
        line, file = caller.line, caller.file
        judged = (
            replace(each, line=line, file=file) if each.line == section.line else each
            for each in section.judged
        )
        yield replace(section, line=line, file=file, judged=tuple(judged))


def not_judged(moves: Sequence[Move], known: set[int]) -> Iterator[Finding]:
    """Yield the lines of feed moves that belong to no cut."""
    others = (move.block for i, move in enumerate(moves) if i not in known and move.kind != "rapid")
    lines = list(dict.fromkeys(others))
    if lines:
        yield Finding("plain-moves", lines[0], {"lines": lines})
