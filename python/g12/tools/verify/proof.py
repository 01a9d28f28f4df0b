# SPDX-License-Identifier: GPL-2.0-or-later
"""Everything a program's pockets and polar sections can be held to, in one value.

What is asked for is read from the program's words, what is cut is measured from the motion that
LinuxCNC makes of it; the cycles' own planning has no part in it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from g12.tools.headless.machine import Run
from g12.tools.machine.ini import Ini
from g12.tools.path.follow import Followed, follow
from g12.tools.path.part import C, part_of_program, tool_diameters
from g12.tools.path.track import Track, limits_of, track
from g12.tools.preview.ended import ended, with_axes
from g12.tools.preview.executed_blocks import read_lines
from g12.tools.preview.moves import Move, Trace
from g12.tools.preview.tracer import Tools, Tracer
from g12.tools.progress import Tell, counted, silent
from g12.tools.units import MM, Unit, plain
from g12.tools.verify.axis_limits import Overrun, Travel
from g12.tools.verify.executed_subs import executed_everywhere
from g12.tools.verify.pocket import SAME_LEVEL, PocketFacts, Shape, measure_pocket
from g12.tools.verify.rapids import Collision, collisions
from g12.tools.verify.section import SectionFacts, measure_section
from g12.tools.verify.wanted_circle import Codes, Reader, Target
from g12.tools.verify.wanted_contour import sections

POCKET_TOLERANCE = 0.005  # mm
LAST_DECIMAL = 0.0005  # mm: arcs whose words are rounded do not close any better
RUN_ALLOWANCE = 0.001  # mm, of a run beyond POLAR_TOLERANCE
SAME_AREA = 0.01  # mm², less is rounding
MOST_JUMP = 1.0  # degree
SAME_SPEED = 1.001
WEAR = 0.05  # of its diameter: D differs from the loaded tool by more than an allowance for wear
SAME_SIZE = 1e-4  # mm
SAME_ANGLE = 1e-3  # degree
UNMEASURED = "a cycle cuts here that could not be measured"


@dataclass(frozen=True)
class Subject:
    """A program on a machine, as traced: ``path`` is its track, ``real`` the motion of a run."""

    program: Path
    ini: Ini
    trace: Trace
    path: Track
    real: Followed | None = None


@dataclass(frozen=True)
class Proof:
    """What was measured; tolerances are in mm.

    ``unseen`` are lines whose blocks make a cycle cut that belongs to no pocket and no section
    measured, and the cycle's code.
    """

    subject: Subject
    pockets: list[PocketFacts]
    sections: list[SectionFacts]
    collisions: list[Collision]
    unseen: list[tuple[int, str]]
    pocket_tolerance: float
    polar_tolerance: float

    @property
    def findings(self) -> list[tuple[int, str]]:
        """Return everything that is not as programmed: the line, and what is wrong."""
        return self.findings_in(MM)

    def findings_in(self, unit: Unit) -> list[tuple[int, str]]:
        """Return the findings with their sizes in another unit."""
        told = [
            (facts.target.line, text)
            for facts in self.pockets
            for text in pocket_findings(facts, self.pocket_tolerance, unit)
        ]
        told += [
            (facts.section.line, text)
            for facts in self.sections
            for text in section_findings(facts, self.polar_tolerance, unit)
        ]
        told += [(hit.line, collision_text(hit, unit)) for hit in self.collisions]
        return told + [(line, UNMEASURED) for line, _ in self.unseen]


def prove(
    program: Path,
    ini: Ini,
    *,
    tools: Tools = None,
    run: Run | None = None,
    tolerance: float | None = None,
    tell: Tell = silent,
) -> Proof:
    """Return the proof of a program, of its real motion if there is a run.

    ``tolerance`` in mm replaces both that of pockets and that of polar sections, ``tell`` is told
    what is being done.
    """
    limits, diameters, codes = limits_of(ini), tool_diameters(ini, tools), Codes(ini)
    usual = (POCKET_TOLERANCE, polar_tolerance(ini) + (RUN_ALLOWANCE if run else 0.0))
    round_, polar = usual if tolerance is None else (tolerance, tolerance)
    with Tracer(ini, tools=tools) as tracer:
        trace = ended(program, with_axes(tracer.trace(program), ini.path))
        blocks = executed_everywhere(tracer, program, trace, codes, tools)
        reading = ini.settings.polar_x
        polars = sections(tracer, program, codes, reading, blocks)
    moves = trace.moves
    path = track(part_of_program(ini, moves), moves, limits, trace.modes.speed)
    real = follow(path, moves, run.samples, ini.mm) if run else None
    asked = list(Reader(codes, moves, diameters).targets(blocks))
    travel = Travel(ini, trace, read_lines(program))
    measured = [*(block for block, _ in asked), *polars]
    known: dict[tuple, Shape] = {}
    tell("looking for rapids through material")
    collided = collisions(asked, moves, path, diameters, real)
    return Proof(
        Subject(program, ini, trace, path, real),
        [
            replace(
                measure_pocket(wanted, block.at, block.end, path, moves, round_, real, known),
                overruns=tuple(travel.overruns(block.at, block.end, path)),
            )
            for block, wanted in counted(asked, "measuring pocket", tell)
        ],
        [
            measure_section(each, path, moves, diameters, limits.axes[C], polar, real)
            for each in counted(polars, "measuring section", tell)
        ],
        collided,
        unseen(moves, codes, [range(each.at, each.end) for each in measured]),
        round_,
        polar,
    )


def collisions_in(
    program: Path,
    ini: Ini,
    trace: Trace,
    path: Track,
    tools: Tools = None,
    real: Followed | None = None,
) -> list[Collision]:
    """Return the rapids of a program that go through material, of its run if there is one."""
    codes, diameters = Codes(ini), tool_diameters(ini, tools)
    if not any(codes.knows(move.remap) for move in trace.moves):
        return []
    with Tracer(ini, tools=tools) as tracer:
        blocks = executed_everywhere(tracer, program, trace, codes, tools)
    asked = list(Reader(codes, trace.moves, diameters).targets(blocks))
    return collisions(asked, trace.moves, path, diameters, real)


def collision_text(hit: Collision, unit: Unit = MM) -> str:
    """Return in words what a rapid goes through."""
    x, y, z = (unit.text(value) for value in hit.way[0])
    return f"a rapid goes through {unit.area(hit.area)} not cleared before, from X{x} Y{y} Z{z} on"


def unseen(moves: Sequence[Move], codes: Codes, measured: Iterable[range]) -> list[tuple[int, str]]:
    """Return each line and code that makes moves of a cycle outside the ranges measured."""
    seen = {index for stretch in measured for index in stretch}
    told = (
        (move.block, move.remap)
        for index, move in enumerate(moves)
        if index not in seen and codes.knows(move.remap)
    )
    return list(dict.fromkeys(told))


def polar_tolerance(ini: Ini) -> float:
    """Return [G12] POLAR_TOLERANCE in mm."""
    return ini.settings.tolerance(ini.mm) * ini.mm


def pocket_findings(facts: PocketFacts, tolerance: float, unit: Unit = MM) -> Iterator[str]:
    """Yield what is wrong with a pocket."""
    target = facts.target
    if not facts.depths:
        yield "nothing is cut"
        return
    if is_wrong_tool(target):
        wall, cut = (unit.text(size) for size in (target.radius, wall_of_loaded(target)))
        yield f"{other_tool(target, unit)}: the wall comes out at radius {cut}, not {wall}"
    if facts.deviation > tolerance:
        yield f"the wall is {unit.fine(facts.deviation)} {unit.name} off the programmed circle"
    if facts.gouge > SAME_AREA:
        yield f"{unit.area(facts.gouge)} are gouged beyond the wall"
    if facts.left > SAME_AREA:
        yield f"{unit.area(facts.left)} of material are left standing"
    if target.smooth and facts.jump > MOST_JUMP:
        yield f"the direction jumps by {facts.jump:.3g} degrees"
    too_high = facts.depths[-1] - target.deepest if target.deepest is not None else 0.0
    if abs(too_high) > tolerance:
        yield f"the depth is off by {unit.fine(too_high)} {unit.name}"
    elif target.deepest is not None and min(target.deepest, 0.0) - facts.lowest > tolerance:
        yield f"it goes {unit.fine(target.deepest - facts.lowest)} {unit.name} below its depth"
    elif target.levels is not None:
        yield from level_findings(facts, max(tolerance, SAME_LEVEL), unit)
    yield from way_findings(facts, unit)
    for overrun in facts.overruns:
        if overrun.certain:
            yield overrun_text(overrun, unit)


def level_findings(facts: PocketFacts, tolerance: float, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the levels of a pocket whose last one is right."""
    wanted, cut = sorted(facts.target.levels, reverse=True), facts.depths
    equal = len(wanted) == len(cut)
    if not equal or max(map(abs, map(float.__sub__, wanted, cut))) > tolerance:
        told = [", ".join(map(unit.text, map(facts.target.height, z))) for z in (cut, wanted)]
        yield f"it is cut at {told[0]}, not at {told[1]} {unit.name}"


def way_findings(facts: PocketFacts, unit: Unit) -> Iterator[str]:
    """Yield what is wrong with the way a pocket is cut: turns, passes and feeds."""
    target = facts.target
    rough = facts.circles[:-1] if target.finish_turn else facts.circles
    if target.turn and any(turn != target.turn for turn in rough):
        yield "it turns the wrong way"
    if target.finish_turn and target.finish_turn not in facts.circles[-1:]:
        yield "its finish pass turns the wrong way"
    if target.passes is not None and facts.passes != target.passes:
        yield f"full circles along the wall: {facts.passes}, not {target.passes}"
    if facts.feed:
        yield "a move has the feed {}, not {}".format(*map(unit.text, facts.feed))


def overrun_text(overrun: Overrun, unit: Unit) -> str:
    """Return in words which axis leaves its travel."""
    there, limit = unit.text(overrun.position), unit.text(overrun.limit)
    return f"the {overrun.letter} axis would go to {there}, its limit is {limit} {unit.name}"


def gouged(facts: SectionFacts, unit: Unit) -> str:
    """Return the gouged area of a section in words: of a deep one only a part is measured."""
    return f"{'at least ' if facts.through else ''}{unit.area(facts.gouge)}"


def is_wrong_tool(target: Target) -> bool:
    """Tell whether D names another cutter than the loaded one, by more than wear."""
    known = target.offset is not None and target.loaded > 0.0
    return known and abs(target.cutter - target.loaded) > WEAR * target.loaded


def wall_of_loaded(target: Target) -> float:
    """Return the radius of the wall that the loaded tool cuts."""
    return target.radius - target.cutter + target.loaded


def other_tool(target: Target, unit: Unit) -> str:
    """Return in words that D is not the loaded tool."""
    loaded, named = (unit.text(2 * size) for size in (target.loaded, target.cutter))
    return f"the loaded tool T{target.tool} (⌀ {loaded}) is not D{target.offset} (⌀ {named})"


def pocket_notes(facts: PocketFacts, unit: Unit = MM) -> Iterator[str]:
    """Yield what a user should know of a pocket that is no fault."""
    target = facts.target
    if target.word:
        yield "the tool's centre goes round on the circle, the wall is a tool radius farther"
    for overrun in facts.overruns:
        if not overrun.certain:
            yield f"with no work offset {overrun_text(overrun, unit)}"
    if target.offset is None or is_wrong_tool(target):
        return
    if not target.loaded:
        yield f"T{max(target.tool, 0)} has no diameter: measured with that of D{target.offset}"
    elif abs(target.cutter - target.loaded) > SAME_SIZE:
        yield f"{other_tool(target, unit)}: measured with the cutter of D{target.offset}"


def section_notes(facts: SectionFacts, first: SectionFacts, unit: Unit = MM) -> Iterator[str]:
    """Yield what a user should know of a section that is no fault; ``first`` is the program's."""
    if facts.lowest >= facts.start_height - SAME_SIZE:
        yield "no move goes below the Z of G12.1"
    turned = (facts.zero - first.zero + 180.0) % 360.0 - 180.0
    if abs(turned) > SAME_ANGLE:
        yield (
            f"its zero line is turned by {plain(turned, 3)}° against that of the program's first "
            f"section (line {first.section.line})"
        )
    if not facts.tool and any(facts.sides):
        yield "the tool has no diameter: only its centre is measured"


def section_findings(facts: SectionFacts, tolerance: float, unit: Unit = MM) -> Iterator[str]:
    """Yield what is wrong with a polar section."""
    if facts.section.doubt:
        yield f"the contour cannot be read from the words: {facts.section.doubt}"
        return
    if facts.deviation > tolerance + LAST_DECIMAL:
        yield f"the path is {unit.fine(facts.deviation)} {unit.name} off the contour"
    if facts.gouge > SAME_AREA:
        yield f"{gouged(facts, unit)} are gouged beyond the contour"
    if facts.left > SAME_AREA:
        yield f"{unit.area(facts.left)} of material are left standing"
    if facts.c_speed > facts.c_limit * SAME_SPEED:
        yield f"C turns at {facts.c_speed:.4g} degrees/s, its limit is {facts.c_limit:.4g}"
