# SPDX-License-Identifier: GPL-2.0-or-later
"""What a picture of a program warns of, beside what it cuts: the same that ``verify`` finds.

Lengths are millimetres in machine coordinates.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from shapely.geometry.base import BaseGeometry

from g12.tools.path.part import Z
from g12.tools.preview.tracer import Parameters, Tools, Tracer
from g12.tools.units import MM, Unit
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.findings import SAME_AREA, other_tool
from g12.tools.verify.in_material import MaterialFacts, material_facts, zero_of
from g12.tools.verify.judgement import cuts_of
from g12.tools.verify.mistakes.spindle import judge_spindle
from g12.tools.verify.pocket_area import is_wrong_tool, uncut
from g12.tools.verify.pocket_walls import Circles
from g12.tools.verify.proof import (
    POCKET_TOLERANCE,
    Asked,
    Proof,
    StockText,
    Subject,
    asked_of,
    program_of,
    workpiece_of,
)
from g12.tools.verify.reading.circles import Cutter
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.workpiece import Workpiece


class StandingRings(NamedTuple):
    """What stands in a pocket though it was to be cut: its line, area, and the floor's height.

    ``centre`` is that of the pocket in X and Y.
    """

    line: int
    shape: BaseGeometry
    centre: tuple[float, float]
    floor: float


class WrongCutter(NamedTuple):
    """A pocket that is cut with another cutter than D's: its line, its centre in X and Y."""

    line: int
    centre: tuple[float, float]
    cutter: Cutter


class Seen(NamedTuple):
    """What there is to warn of, the stock, and lines of pockets whose spindle stands.

    ``surface`` is the radius of the cylinder that the program cuts on, 0 without one. ``z0`` is
    how high the program's Z0 is where it first cuts, as far as that is known.
    """

    material: MaterialFacts = MaterialFacts()
    rings: tuple[StandingRings, ...] = ()
    cutters: tuple[WrongCutter, ...] = ()
    still: tuple[int, ...] = ()
    surface: float = 0.0
    z0: float = 0.0

    @property
    def stock(self) -> Workpiece | None:
        """The stock, None if none is given."""
        return self.material.given

    def warnings(self, unit: Unit = MM) -> Iterator[tuple[int, str]]:
        """Yield what there is to warn of: the line, and a sentence."""
        for each in self.material.judged:
            if each.is_finding:
                yield each.line, each.text(unit)
        for line, shape, *_ in self.rings:
            yield line, f"{unit.area(shape.area)} of material remain uncut"
        for line, _, cutter in self.cutters:
            yield line, other_tool(cutter, unit)


def seen_in(
    subject: Subject,
    tools: Tools = None,
    parameters: Parameters = None,
    stock: StockText | None = None,
) -> Seen:
    """Return what a picture of a traced program shows beside the cuts."""
    codes, trace = Codes(subject.ini), subject.trace
    asked = Asked([], [], [])
    if any(codes.knows(move.remap) for move in trace.moves):
        with Tracer(subject.ini, tools=tools) as tracer:
            asked = asked_of(tracer, subject, tools, parameters)
    piece = workpiece_of(subject, asked, stock)
    facts = material_facts(program_of(subject, asked), piece)
    return seen_of(subject, asked.circles, asked.sections, facts)


def seen_of_proof(proof: Proof) -> Seen:
    """Return what a picture of a program that was measured shows beside the cuts."""
    sections = [facts.section for facts in proof.sections]
    return seen_of(proof.subject, proof.asked.circles, sections, proof.material)


def seen_of(
    subject: Subject,
    circles: Circles,
    sections: Sequence[SectionContour],
    material: MaterialFacts,
) -> Seen:
    """Return what is seen of circles and sections, with what is known of the material."""
    trace = subject.trace
    rings = standing_rings(circles, material)
    cutters = (
        WrongCutter(target.source.line, tuple(map(float, target.wall.origin[:2])), target.cutter)
        for _, target in circles
        if is_wrong_tool(target.cutter)
    )
    cuts = list(cuts_of(Asked(list(circles), [], []), trace.moves))
    still = (each.line for each in judge_spindle(cuts, trace.events, subject.ini))
    surface, z0 = surface_of(sections), float(zero_of(circles, sections, trace.moves)[Z])
    return Seen(material, tuple(rings), tuple(cutters), tuple(still), surface, z0)


def surface_of(sections: Sequence[SectionContour]) -> float:
    """Return the radius of the cylinder that sections are cut on; 0 if not all of them are."""
    radii = [section.surface for section in sections]
    return radii[0] if radii and all(radii) else 0.0


def standing_rings(circles: Circles, material: MaterialFacts) -> Iterator[StandingRings]:
    """Yield what stands in pockets in the plane XY."""
    for block, target in circles:
        left = uncut(block, target, material.piece.material, POCKET_TOLERANCE)
        if target.wall.inside and left.area > SAME_AREA:
            centre = tuple(map(float, target.wall.origin[:2]))
            floor = target.wall.height(target.deepest)
            yield StandingRings(target.source.line, left, centre, floor)
