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
from g12.tools.verify.findings import SAME_AREA
from g12.tools.verify.in_material import MaterialFacts, zero_of
from g12.tools.verify.pocket_area import is_wrong_tool, uncut
from g12.tools.verify.pocket_walls import Circles
from g12.tools.verify.proof import (
    POCKET_TOLERANCE,
    Proof,
    StockText,
    Subject,
    prove_traced,
)
from g12.tools.verify.reading.circles import Cutter
from g12.tools.verify.result.finding import Finding
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
    findings: tuple[Finding, ...] = ()

    @property
    def stock(self) -> Workpiece | None:
        """The stock, None if none is given."""
        return self.material.given

    @property
    def signs(self) -> list[Finding]:
        """The findings with a place that are not drawn as a path or an area."""
        drawn = ("path" in each.values or each.code == "uncut" for each in self.findings)
        placed = (each for each, known in zip(self.findings, drawn) if not known)
        return [each for each in placed if each.place is not None]

    def warnings(self, unit: Unit = MM) -> Iterator[tuple[int, str]]:
        """Yield what there is to warn of: the line, and a sentence."""
        for each in self.findings:
            yield each.line, each.text(unit)


def seen_in(
    subject: Subject,
    tools: Tools = None,
    parameters: Parameters = None,
    stock: StockText | None = None,
) -> Seen:
    """Return what a picture of a traced program shows beside the cuts."""
    with Tracer(subject.ini, tools=tools) as tracer:
        return seen_of_proof(prove_traced(tracer, subject, tools, parameters, stock=stock))


def seen_of_proof(proof: Proof) -> Seen:
    """Return what a picture of a program that was measured shows beside the cuts."""
    circles, moves = proof.asked.circles, proof.subject.trace.moves
    sections = [facts.section for facts in proof.sections]
    cutters = (
        WrongCutter(target.source.line, tuple(map(float, target.wall.origin[:2])), target.cutter)
        for _, target in circles
        if is_wrong_tool(target.cutter)
    )
    return Seen(
        proof.material,
        tuple(standing_rings(circles, proof.material)),
        tuple(cutters),
        tuple(each.line for each in proof.judged if each.code == "spindle-stands"),
        surface_of(sections),
        float(zero_of(circles, sections, moves)[Z]),
        tuple(each for each in proof.judged if each.is_finding),
    )


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
