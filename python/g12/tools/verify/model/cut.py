# SPDX-License-Identifier: GPL-2.0-or-later
"""A cut as its planner reported it, in mm of the part: what goes, what stays, how deep.

The plane is that of ``Part.points``: machine X and Y of a mill, the face of a lathe's part as it
turns with C, or the unrolled surface of a cylinder, where the level is the radius.
"""

import cmath
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby
from typing import Any

import numpy as np
from shapely.affinity import rotate, translate
from shapely.geometry import LineString, Polygon, box
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.cut_report import (
    CutElement,
    EventCut,
    FrameCut,
    HolesCut,
    PocketCut,
    PolygonCut,
    RoundPocketCut,
    SectionCut,
    SlotCut,
    ThreadCut,
    UsedCutter,
)
from g12.tools.path.part import ROLES, arc_segments, disc
from g12.tools.preview.moves import ReportedCut, Trace
from g12.tools.verify.model.finding import Finding, Kind

CLOSED = 0.01  # mm between the ends of a contour that is closed
CHORD = 1e-3  # of arcs
MOST_OF_A_TURN = math.radians(225)
WEAR = 0.05  # of the loaded tool's radius: D may differ by that
LEAST_CORE = 0.05  # mm: the radius of a core that remains
NOTHING = Polygon()
NO_CUTTER = UsedCutter(0.0, "")
TAPS = (1, 2)  # kinds of holes
Point3 = tuple[float, float, float]


@dataclass(frozen=True)
class Outline:
    """A contour with the tool beside it: its points in the plane, and on which side.

    ``left``: the tool is on its left. ``lead`` is where the move onto it begins. ``lines`` are the
    first and the last of its blocks, ``level`` its lowest, ``lead_level`` the lead's.
    """

    points: np.ndarray  # complex
    left: bool
    lead: complex
    lines: tuple[int, int]
    level: float
    lead_level: float

    @property
    def is_closed(self) -> bool:
        """Whether it goes round an area: ends where it begins, or round the axis but for a gap.

        The ends of an open slot are the farthest of its points, outside of the bar.
        """
        if len(self.points) < 3 or abs(self.points[0] - self.points[-1]) < CLOSED:
            return len(self.points) > 2
        away = np.abs(self.points)
        if away.min() < CLOSED or min(away[0], away[-1]) > 0.9 * away.max():
            return False
        return abs(np.angle(self.points[1:] / self.points[:-1]).sum()) > MOST_OF_A_TURN

    @cached_property
    def polygon(self) -> BaseGeometry:
        return Polygon(_xy(self.points)).buffer(0)

    @property
    def tool_inside(self) -> bool:
        """Whether the tool goes round inside of a closed contour."""
        after = np.roll(self.points, -1)
        return bool(((np.conj(self.points) * after).imag.sum() > 0) == self.left)

    def part_side(self, width: float) -> BaseGeometry:
        """Return what stays next to the contour, up to a width."""
        if self.is_closed and not self.tool_inside:
            return self.polygon
        if self.is_closed:
            return self.polygon.buffer(width).difference(self.polygon)
        away = -width if self.left else width
        return LineString(_xy(self.points)).buffer(away, single_sided=True, join_style=2)


class Cut:
    """One reported cut: its moves are those from ``at`` to ``end``.

    ``line`` is in its ``file``, "" is the program; ``last_line`` of a section is the line that ends
    it. ``plan`` is the planner's record, whose kind says which fields it has. ``cutter`` is the
    radius that its path is computed with, 0 if that is not the planner's; ``radius`` is that of the
    tool that cuts. ``surface`` is that of the cylinder on which it is, 0 on the face. ``wall`` is
    that of what a circle clears, ``inner`` that of what it leaves in its middle, which may be a
    boss. ``fed`` are its moves that are no rapids.
    """

    def __init__(self, index: int, reported: ReportedCut, trace: Trace) -> None:
        report, frame = reported.report, reported.report.frame
        self.index, self.report, self.frame = index, report, frame
        self.at, self.end, self.moves = *reported[:2], range(*reported[:2])
        self.code, self.line, self.file = report[:3]
        self.c_commanded = reported.c_commanded
        self.plan: Any = report.cut
        self.is_section = isinstance(self.plan, SectionCut)
        self.is_circle = isinstance(self.plan, PocketCut | EventCut | ThreadCut)
        self.is_shape = isinstance(self.plan, PolygonCut | SlotCut | RoundPocketCut | FrameCut)
        self.is_tap = isinstance(self.plan, HolesCut) and self.plan.kind in TAPS
        self.is_ring = isinstance(self.plan, PocketCut) and not self.plan.step  # one circle
        self.last_line = max(self.line, reported.last_line if self.is_section else 0)
        self.upright = getattr(self.plan, "plane", "G17") != "G17"
        self.mm = mm = frame.mm
        self.zero: Point3 = (frame.zero[0] * mm, frame.zero[1] * mm, frame.zero[2] * mm)
        self.zero_c = frame.zero[3]
        self.surface: float = getattr(self.plan, "surface", 0.0) * mm
        self.passes: Any = getattr(self.plan, "passes", self.plan)
        self.used: UsedCutter = getattr(self.passes, "cutter", NO_CUTTER)
        self.cutter = self.used.radius * mm
        loaded = trace.radius(self.at) if self.at < len(trace.moves) else 0.0
        worn = abs(self.cutter - loaded) <= WEAR * loaded
        self.radius = self.cutter if worn or not loaded else loaded
        self.fed = [index for index in self.moves if trace.moves[index].kind != "rapid"]
        self.wall, self.inner, self.is_boss = self._circle(0.0 if self.cutter else loaded)
        self.elements: Sequence[CutElement] = getattr(self.plan, "elements", ())
        self.roles = ROLES[getattr(self.plan, "turn", "C")]
        # What turns the plane of its words so that the axis of rotation is upwards.
        self._upright = 1j if self.roles == ROLES["A"] else 1.0
        # 1 where the length around the cylinder grows with the angle, else -1.
        self.sense = getattr(self.plan, "sense", 1.0) * (-1 if self._upright == 1j else 1)
        self._turned = cmath.rect(1.0, math.radians(report.at[3] + self.zero_c))

    def found(self, of: Kind, place: Sequence[float] | None = None, /, **values: Any) -> Finding:
        """Return a finding in its line."""
        return Finding(of, self.line, values, place, self.file)

    @cached_property
    def centre(self) -> tuple[float, float]:
        at = self.frame.point(*self.plan.centre[:2])
        return at.real, at.imag

    def _circle(self, beside: float) -> tuple[float, float, bool]:
        """Return a circle's wall, its inner radius, whether it is a boss; 0 of what is no circle.

        Without a cutter its words are those of the centre, and the loaded one is ``beside`` it.
        """
        plan, mm = self.plan, self.mm
        if isinstance(plan, ThreadCut):
            return plan.large * mm, plan.small * mm * plan.outside, plan.outside
        if isinstance(plan, EventCut):
            return plan.wall * mm + beside, plan.boss * mm, plan.side > 0
        if isinstance(plan, PocketCut):
            return plan.wall * mm + beside, max(plan.inner * mm - beside, 0.0), False
        return 0.0, 0.0, False

    @cached_property
    def levels(self) -> list[float]:
        """The levels of its floors: machine Z, or the radius on a cylinder."""
        plan = self.plan
        if isinstance(plan, SectionCut):
            ends = [min(each.z0, each.z1) for each in self.elements]
            return [self._level(min(ends))] if ends else []
        if isinstance(plan, HolesCut):
            x, z, _ = plan.places[0]
            return [self._level((x if plan.surface else z) - plan.depth)]
        return [self._level(level) for level in self.passes.levels]

    @cached_property
    def steps_down(self) -> list[float]:
        """The levels at which a section moves in its plane, the highest first."""
        ends = {self._level(round(min(each.z0, each.z1), 6)) for each in self.drawn}
        return sorted(ends, reverse=True) or self.levels

    @cached_property
    def floor(self) -> float:
        return min(self.levels, default=math.inf)

    def _level(self, level: float) -> float:
        return level * self.mm + (0.0 if self.surface else self.zero[2])

    # ------------------------------------------------------------ areas

    @cached_property
    def goes(self) -> BaseGeometry:
        """What its words say is to go, at its floor; at a thread's nothing is gone all round."""
        if self.is_shape:
            return self._shape[0]
        if self.is_circle and not self.upright and not isinstance(self.plan, ThreadCut):
            return disc(self.centre, self.wall, CHORD).difference(self._middle)
        return unary_union([outline.polygon for outline in self.pockets])

    @property
    def pockets(self) -> list[Outline]:
        """The closed contours of a section that are cut from the inside."""
        return [each for each in self.outlines if each.is_closed and each.tool_inside]

    @property
    def _middle(self) -> BaseGeometry:
        return disc(self.centre, self.inner, CHORD) if self.inner > 0 else NOTHING

    @property
    def core(self) -> BaseGeometry:
        """What a circle leaves in its middle that is no boss."""
        return NOTHING if self.is_boss or self.inner < LEAST_CORE else self._middle

    @cached_property
    def stays(self) -> list[tuple[BaseGeometry, float]]:
        """What stays of the part beside it, and the level down to which it is cut."""
        if self.is_boss:
            return [(self._middle, self.floor)]
        if self.is_shape:
            return [(self._shape[1], self.floor)]
        width = max(map(self.offset, self.elements), default=0.0) or 1.0
        return [(each.part_side(width), each.level) for each in self.outlines]

    @cached_property
    def island(self) -> BaseGeometry:
        """The part that it goes round on the outside, as far as that is closed."""
        if self.is_boss or (self.is_shape and self._shape[0].is_empty):
            return self.stays[0][0]
        return unary_union([o.polygon for o in self.outlines if o.is_closed and not o.tool_inside])

    @cached_property
    def _shape(self) -> tuple[BaseGeometry, BaseGeometry]:
        """What goes of a pocket or a slot, nothing of a polygon or a frame, and what stays."""
        plan, mm, middle = self.plan, self.mm, (0.0, 0.0)
        if isinstance(plan, PolygonCut):
            return NOTHING, self._polygon(plan)
        if isinstance(plan, FrameCut):
            middle, corner = self.centre, plan.corner * mm
            x, y = (length * mm / 2 - corner for length in plan.lengths)
            whole, turned = box(-x, -y, x, y).buffer(corner, 64), self.frame.rotation
        elif isinstance(plan, RoundPocketCut):
            centre = complex(*plan.centre) * mm
            whole, turned = disc((centre.real, centre.imag), plan.diameter * mm / 2), self.zero_c
        else:
            half = (plan.length - plan.width) / 2 * mm
            line = LineString([(-half, 0), (half, 0)])
            whole, turned = line.buffer(plan.width * mm / 2, 64), plan.angle + self.zero_c
        whole = translate(rotate(whole, turned, origin=(0, 0)), *middle)
        if isinstance(plan, FrameCut) and plan.side > 0:
            return NOTHING, whole
        left = whole.buffer(-2 * self.cutter) if getattr(plan, "middle", False) else NOTHING
        return whole.difference(left), whole.buffer(1.0).difference(whole)

    def _polygon(self, plan: PolygonCut) -> BaseGeometry:
        radius = plan.corner_radius * self.mm
        stays = disc((0, 0), plan.stock_diameter * self.mm / 2)
        for side in range(plan.sides):
            flat = box(plan.across_flats * self.mm / 2, -1e3, 1e3, 1e3)
            middle = plan.angle + self.zero_c + 360 * side / plan.sides
            stays = stays.difference(rotate(flat, middle, origin=(0, 0)))
        rounded = radius > 0 and plan.sides > 2
        return stays.buffer(-radius, 64).buffer(radius, 64) if rounded else stays

    @cached_property
    def places(self) -> list[complex]:
        """The middles of its holes."""
        own = self.plan.places if isinstance(self.plan, HolesCut) else ()
        turned = [(x * self.mm, z * self.mm, math.radians(c + self.zero_c)) for x, z, c in own]
        if self.surface:
            return [complex(self.surface * turn, z + self.zero[2]) for _, z, turn in turned]
        return [cmath.rect(x, turn) for x, _, turn in turned]

    # ------------------------------------------------------------ a section's contour

    @cached_property
    def drawn(self) -> list[CutElement]:
        """The elements that are no plunge."""
        return [each for each in self.elements if each.end is not None]

    @cached_property
    def _runs(self) -> list[list[CutElement]]:
        """What is drawn on one side of its contour; the first of each but a plain first is a lead.

        A lead leads onto the contour or, by G40, away from it.
        """
        return [list(run) for _, run in groupby(self.drawn, key=lambda each: each.side)]

    @cached_property
    def outlines(self) -> list[Outline]:
        return [self._outline(run) for run in self._runs if run[0].side and len(run) > 1]

    @cached_property
    def contour_lines(self) -> set[int]:
        """The blocks of a section that are no leads."""
        leads = [bool(run[0].side) or n > 0 for n, run in enumerate(self._runs)]
        return {each.line for lead, run in zip(leads, self._runs) for each in run[lead:]}

    @cached_property
    def loose_lines(self) -> set[int]:
        """The blocks of a section that no contour keeps off the part: leads, without G41 or G42."""
        leads = {outline.lines[0] for outline in self.outlines}
        return leads | {each.line for each in self.elements if not each.side}

    def _outline(self, run: Sequence[CutElement]) -> Outline:
        lead, *own = run
        points = [self.point(own[0].start)]
        for each in own:
            points += [self.point(at) for at in curve_points(each)]
        level = self._level(min(min(each.z0, each.z1) for each in own))
        low = self._level(min(lead.z0, lead.z1))
        lines = lead.line, own[-1].line
        return Outline(np.array(points), own[0].side > 0, self.point(lead.start), lines, level, low)

    def offset(self, element: CutElement) -> float:
        """Return how far the tool's centre is beside an element's contour, mm."""
        return element.radius * self.mm * bool(element.side)

    def point(self, at: complex) -> complex:
        """Return a point of the program's plane on the part."""
        if self.surface:
            around = math.radians(self.zero_c) * self.surface * self.sense
            return at * self._upright * self.mm + complex(around, self.zero[self.roles.along])
        return at * self.mm * self._turned

    def plane_words(self, at: complex) -> complex:
        """Return a point of the face in the plane of a section: X as a radius, C as a length."""
        return at / self._turned

    @cached_property
    def deep_reach(self) -> float:
        """How far its path below Z0 is from the axis."""
        at, ends = complex(self.report.at[0]), [0.0]
        for each in self.elements:
            start, at = at, each.end or at
            ends += [abs(start), abs(at)] if min(each.z0, each.z1) < 0 else []
        return max(ends) * self.mm


def curve_points(element: CutElement, chord_error: float = CHORD) -> Iterator[complex]:
    """Yield the points of a line or an arc after its start."""
    start, centre = element.start, element.centre
    if centre is not None:
        count = arc_segments(abs(start - centre), element.sweep, chord_error)
        for n in range(1, count):
            yield centre + (start - centre) * cmath.rect(1.0, element.sweep * n / count)
    yield element.end


def cuts_of(trace: Trace) -> list[Cut]:
    """Return the reported cuts in the order of their moves."""
    return [Cut(index, each, trace) for index, each in enumerate(trace.cuts)]


def _xy(points: np.ndarray) -> np.ndarray:
    return np.stack([points.real, points.imag], axis=1)
