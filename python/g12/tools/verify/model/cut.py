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
from typing import Any

import numpy as np
from shapely.affinity import rotate
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
from g12.tools.path.part import ROLES, Roles, arc_segments, disc
from g12.tools.preview.moves import ReportedCut, Trace

CLOSED = 0.01  # mm between the ends of a contour that is closed
CHORD = 1e-3  # of arcs
MOST_OF_A_TURN = math.radians(225)
LEAST_CORE = 0.05  # mm: the radius of a core that remains
NOTHING = Polygon()
NO_CUTTER = UsedCutter(0.0, "")
TAPS = (1, 2)  # kinds of holes
SHAPES = (PolygonCut, SlotCut, RoundPocketCut, FrameCut)
CIRCLES = (PocketCut, EventCut, ThreadCut)


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


@dataclass
class Cut:
    """One reported cut with the range of its moves; ``loaded`` is the loaded cutter's radius."""

    index: int
    reported: ReportedCut
    loaded: float

    @property
    def at(self) -> int:
        return self.reported.at

    @property
    def end(self) -> int:
        return self.reported.end

    @property
    def moves(self) -> range:
        return range(self.at, self.end)

    @property
    def plan(self) -> Any:
        """The planner's record, a ``PlannedCut``; which fields it has is asked by its kind."""
        return self.reported.report.cut

    @property
    def code(self) -> str:
        return self.reported.report.code

    @property
    def line(self) -> int:
        return self.reported.report.line

    @property
    def file(self) -> str:
        return self.reported.report.file

    @property
    def last_line(self) -> int:
        """The line that ends a section."""
        return max(self.line, self.reported.last_line) if self.is_section else self.line

    @property
    def is_section(self) -> bool:
        return isinstance(self.plan, SectionCut)

    @property
    def is_circle(self) -> bool:
        return isinstance(self.plan, CIRCLES)

    @property
    def is_shape(self) -> bool:
        return isinstance(self.plan, SHAPES)

    @property
    def is_tap(self) -> bool:
        return isinstance(self.plan, HolesCut) and self.plan.kind in TAPS

    @property
    def mm(self) -> float:
        return self.reported.report.frame.mm

    @cached_property
    def zero(self) -> tuple[float, float, float]:
        """The program's zero on the machine."""
        x, y, z = (value * self.mm for value in self.reported.report.frame.zero[:3])
        return x, y, z

    @property
    def zero_c(self) -> float:
        return self.reported.report.frame.zero[3]

    @property
    def rotation(self) -> float:
        return self.reported.report.frame.rotation

    @property
    def surface(self) -> float:
        """The radius of the cylinder on which it is, 0 on the face."""
        return getattr(self.plan, "surface", 0.0) * self.mm

    @property
    def used(self) -> UsedCutter:
        passes = getattr(self.plan, "passes", self.plan)
        return getattr(passes, "cutter", NO_CUTTER)

    @cached_property
    def cutter(self) -> float:
        """The cutter radius that its path is computed with, 0 if it is not the planner's."""
        return self.used.radius * self.mm

    @property
    def compensated(self) -> bool:
        return any(each.side for each in self.elements)

    @cached_property
    def top(self) -> float:
        return self.surface or self.zero[2]

    @cached_property
    def wall(self) -> float:
        """The radius that a circle clears; without a cutter its words are those of its centre."""
        if isinstance(self.plan, ThreadCut):
            return self.plan.large * self.mm
        return self.plan.wall * self.mm + self._unknown_cutter if self.is_circle else 0.0

    @cached_property
    def inner(self) -> float:
        """The radius of what a circle leaves in its middle, 0 if nothing."""
        if isinstance(self.plan, PocketCut):
            return max(self.plan.inner * self.mm - self._unknown_cutter, 0.0)
        if isinstance(self.plan, ThreadCut):
            return self.plan.small * self.mm if self.plan.outside else 0.0
        return self.plan.boss * self.mm if isinstance(self.plan, EventCut) else 0.0

    @property
    def has_boss(self) -> bool:
        if isinstance(self.plan, ThreadCut):
            return self.plan.outside
        return isinstance(self.plan, EventCut) and self.plan.side > 0

    @property
    def is_ring(self) -> bool:
        """Whether it is one circle."""
        return isinstance(self.plan, PocketCut) and not self.plan.step

    def plane_words(self, at: complex) -> complex:
        """Return a point of the face in the plane of a section: X as a radius, C as a length."""
        return at / self._turned

    @property
    def _unknown_cutter(self) -> float:
        return 0.0 if self.cutter else self.loaded

    @cached_property
    def centre(self) -> tuple[float, float]:
        at = self.reported.report.frame.point(*self.plan.centre[:2])
        return at.real, at.imag

    @property
    def upright(self) -> bool:
        return getattr(self.plan, "plane", "G17") != "G17"

    @cached_property
    def levels(self) -> list[float]:
        """The levels of its floors: machine Z, or the radius on a cylinder."""
        plan = self.plan
        if isinstance(plan, SectionCut):
            ends = [min(each.z0, each.z1) for each in self.elements if each.end is not None]
            return [self._level(min(ends))] if ends else []
        if isinstance(plan, HolesCut):
            place = plan.places[0]
            return [self._level((place[0] if plan.surface else place[1]) - plan.depth)]
        levels = getattr(plan, "passes", plan).levels
        return [self._level(level) for level in levels]

    @cached_property
    def floor(self) -> float:
        return min(self.levels, default=math.inf)

    def _level(self, level: float) -> float:
        return level * self.mm + (0.0 if self.surface else self.zero[2])

    # ------------------------------------------------------------ areas

    @cached_property
    def goes(self) -> BaseGeometry:
        """What its words say is to go, at its floor; at a thread's nothing is gone all round."""
        if isinstance(self.plan, ThreadCut):
            return NOTHING
        if self.is_circle and not self.upright:
            return disc(self.centre, self.wall).difference(self._middle)
        if self.is_shape:
            return self._shape[0]
        return unary_union([o.polygon for o in self.outlines if o.is_closed and o.tool_inside])

    @property
    def _middle(self) -> BaseGeometry:
        return disc(self.centre, self.inner) if self.inner > 0 else NOTHING

    @cached_property
    def core(self) -> BaseGeometry:
        """What a circle leaves in its middle that is no boss."""
        is_core = self.is_circle and not self.upright and not self.has_boss
        return self._middle if is_core and self.inner > LEAST_CORE else NOTHING

    @cached_property
    def stays(self) -> list[tuple[BaseGeometry, float]]:
        """What stays of the part beside it, and the level down to which it is cut."""
        if self.has_boss:
            return [(self._middle, self.floor)]
        if self.is_shape:
            return [(self._shape[1], self.floor)]
        width = max((each.radius for each in self.elements), default=0.0) * self.mm or 1.0
        return [(each.part_side(width), each.level) for each in self.outlines]

    @cached_property
    def island(self) -> BaseGeometry:
        """The part that it goes round on the outside, as far as that is closed."""
        if self.has_boss or isinstance(self.plan, PolygonCut) or self._is_frame_outside:
            return self.stays[0][0]
        return unary_union([o.polygon for o in self.outlines if o.is_closed and not o.tool_inside])

    @cached_property
    def loose_lines(self) -> set[int]:
        """The blocks of a section that no contour keeps off the part: leads, without G41 or G42."""
        leads = {outline.lines[0] for outline in self.outlines}
        return leads | {each.line for each in self.elements if not each.side}

    @property
    def _is_frame_outside(self) -> bool:
        return isinstance(self.plan, FrameCut) and self.plan.side > 0

    @cached_property
    def _frame(self) -> tuple[BaseGeometry, BaseGeometry]:
        """What goes and what stays of a rectangle on a mill."""
        plan, mm = self.plan, self.mm
        (x, y), corner = self.centre, plan.corner * mm
        across, along = (length * mm / 2 - corner for length in plan.lengths)
        whole = box(x - across, y - along, x + across, y + along).buffer(corner, 64)
        whole = rotate(whole, self.rotation, origin=(x, y))
        if plan.side > 0:
            return NOTHING, whole
        beside = whole.buffer(-2 * self.cutter) if plan.middle else NOTHING
        return whole.difference(beside), whole.buffer(1.0).difference(whole)

    @cached_property
    def _shape(self) -> tuple[BaseGeometry, BaseGeometry]:
        """What goes and what stays of a shape."""
        if isinstance(self.plan, FrameCut):
            return self._frame
        plan, mm = self.plan, self.mm
        if isinstance(plan, PolygonCut):
            stays = bar = disc((0, 0), plan.stock_diameter * mm / 2)
            for side in range(plan.sides):
                flat = box(plan.across_flats * mm / 2, -1e3, 1e3, 1e3)
                middle = plan.angle + self.zero_c + 360 * side / plan.sides
                stays = stays.difference(rotate(flat, middle, origin=(0, 0)))
            radius = plan.corner_radius * mm
            if radius > 0 and plan.sides > 2:
                stays = stays.buffer(-radius, 64).buffer(radius, 64)
            return bar.difference(stays), stays
        if isinstance(plan, RoundPocketCut):
            centre = complex(*plan.centre) * mm * cmath.rect(1.0, math.radians(self.zero_c))
            whole = disc((centre.real, centre.imag), plan.diameter * mm / 2)
        else:
            half = (plan.length - plan.width) / 2 * mm
            whole = LineString([(-half, 0), (half, 0)]).buffer(plan.width * mm / 2, 64)
            whole = rotate(whole, plan.angle + self.zero_c, origin=(0, 0))
        return whole, whole.buffer(1.0).difference(whole)

    @cached_property
    def places(self) -> list[complex]:
        """The middles of its holes."""
        if not isinstance(self.plan, HolesCut):
            return []
        if self.surface:
            return [
                complex(self.surface * math.radians(c + self.zero_c), z * self.mm + self.zero[2])
                for _, z, c in self.plan.places
            ]
        return [
            cmath.rect(x * self.mm, math.radians(c + self.zero_c)) for x, _, c in self.plan.places
        ]

    # ------------------------------------------------------------ a section's contour

    @property
    def elements(self) -> Sequence[CutElement]:
        return self.plan.elements if isinstance(self.plan, SectionCut) else ()

    @cached_property
    def outlines(self) -> list[Outline]:
        return list(self._outlines())

    def _outlines(self) -> Iterator[Outline]:
        run: list[CutElement] = []
        for each in (*(e for e in self.elements if e.end is not None), None):
            if run and not (each and each.side == run[-1].side):
                if len(run) > 1:
                    yield self._outline(run)
                run = []
            if each and each.side:
                run.append(each)

    def _outline(self, run: Sequence[CutElement]) -> Outline:
        lead, *own = run
        points = [self.point(own[0].start)]
        for each in own:
            points += [self.point(at) for at in curve_points(each)]
        level = self._level(min(min(each.z0, each.z1) for each in own))
        low = self._level(min(lead.z0, lead.z1))
        lines = lead.line, own[-1].line
        return Outline(np.array(points), own[0].side > 0, self.point(lead.start), lines, level, low)

    @cached_property
    def roles(self) -> Roles:
        """The axes of the cylinder on which it is."""
        return ROLES[getattr(self.plan, "turn", "C")]

    @cached_property
    def _upright(self) -> complex:
        """What turns the plane of its words so that the axis of rotation is upwards."""
        return 1j if self.roles == ROLES["A"] else 1.0

    @property
    def sense(self) -> float:
        """1 where the length around the cylinder grows with the angle, else -1."""
        sense = getattr(self.plan, "sense", 1.0)
        return -sense if self.roles == ROLES["A"] else sense

    def point(self, at: complex) -> complex:
        """Return a point of the program's plane on the part."""
        if self.surface:
            around = math.radians(self.zero_c) * self.surface * self.sense
            return at * self._upright * self.mm + complex(around, self.zero[self.roles.along])
        return at * self.mm * self._turned

    @cached_property
    def _turned(self) -> complex:
        return cmath.rect(1.0, math.radians(self.reported.report.at[3] + self.zero_c))

    @cached_property
    def deep_reach(self) -> float:
        """How far its path below Z0 is from the axis."""
        deep = (e for e in self.elements if e.start is not None and min(e.z0, e.z1) < 0)
        ends = (abs(at) for e in deep for at in (e.start, e.end or e.start))
        return max(ends, default=0.0) * self.mm


def curve_points(element: CutElement) -> Iterator[complex]:
    """Yield the points of a line or an arc after its start."""
    start, centre = element.start, element.centre
    if centre is not None:
        count = arc_segments(abs(start - centre), element.sweep, CHORD)
        for n in range(1, count):
            yield centre + (start - centre) * cmath.rect(1.0, element.sweep * n / count)
    yield element.end


def cuts_of(trace: Trace) -> list[Cut]:
    """Return the reported cuts in the order of their moves."""
    last = len(trace.moves)
    return [
        Cut(index, each, trace.radius(each.at) if each.at < last else 0.0)
        for index, each in enumerate(trace.cuts)
    ]


def _xy(points: np.ndarray) -> np.ndarray:
    return np.stack([points.real, points.imag], axis=1)
