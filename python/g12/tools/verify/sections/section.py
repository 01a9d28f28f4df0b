# SPDX-License-Identifier: GPL-2.0-or-later
"""What is measured of a section: its toolpath against the words', its size, its pace, its acts.

The contour's plane is that of complex numbers. That of a polar section turns with the part, the
real axis is X where the section begins; on a cylinder it is the unrolled surface. Lengths are
millimetres, angles degrees, C's speed degrees/s.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.slowest import Pace, pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import OFF
from g12.tools.verify.compare.section import OffFeed, SectionPath, feed_off, lay_section
from g12.tools.verify.compare.section_plane import Plane, plane_of
from g12.tools.verify.compare.state import StateDifference
from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.result.tolerances import LAST_DECIMAL
from g12.tools.verify.sections.contour_side import OtherSide, other_side
from g12.tools.verify.sections.section_motion import (
    G64_P,
    OffMotion,
    SectionAxes,
    motion_off,
    slower_on_face,
)
from g12.tools.verify.sections.section_size import SectionSize, contour_size, stretches_of
from g12.tools.verify.sections.section_state import OffAct, act_off, left_by_section
from g12.tools.verify.sections.section_turns import InPlace, Turns, turns_of

TINY_PIECE = 1e-6


@dataclass(frozen=True)
class SectionFacts:
    """What was measured of one section.

    ``path`` is its toolpath, expected and made, ``feed_off`` the first feed that is not the words'.
    ``size`` is that of the contour, ``other_side`` says that compensation takes the tool to the
    other side than it comes from. ``jump`` is the greatest change of direction from segment to
    segment of one block, ``c_limit`` C's greatest speed, ``tool`` the cutter's radius.

    ``zero`` is the angle of C where the section begins, ``start_height`` Z there, ``lowest`` the
    lowest Z, on a cylinder X. ``slowest_at`` is the place of the lowest feed as the section's own
    X (a radius), C and Z, ``slowest_line`` its block. ``motion_off`` and ``act_off`` are the first
    lines and acts that are not as they should be, ``left_behind`` is what is left otherwise.
    """

    section: SectionContour
    plane: Plane
    tool: float
    sides: tuple[int, ...]
    path: SectionPath
    feed_off: OffFeed | None
    size: SectionSize
    other_side: OtherSide | None
    jump: float
    pieces: int
    shortest: float
    longest: float
    pace: Pace
    turns: Turns
    c_limit: float
    zero: float
    start_height: float
    lowest: float
    slowest_at: tuple[float, float, float]
    slowest_line: int
    motion_off: tuple[OffMotion, ...] = ()
    act_off: OffAct | None = None
    left_behind: tuple[StateDifference, ...] = ()

    @property
    def deviation(self) -> float:
        """The tool centre's greatest distance from where it should be, inf if part is missing."""
        difference = self.path.difference
        if difference is None:
            return self.path.deviation
        return difference.size if difference.kind == OFF else math.inf

    @property
    def in_place(self) -> InPlace:
        """How far and how long C turns in place below the part's face."""
        return self.turns.in_place


def measure_section(
    section: SectionContour,
    path: Track,
    moves: Sequence[Move],
    diameters: dict[int, float],
    axes: SectionAxes,
    tolerance: float,
    real: Followed | None = None,
) -> SectionFacts:
    """Return the facts of a section that moves; ``path`` and ``real`` are those of its part."""
    plane, axes = plane_of(section, moves[section.at]), axes.of(section)
    own = range(section.at, section.end)
    cutting = [i for i in own if moves[i].kind != "rapid" and path.part_length(i) > TINY_PIECE]
    across = [index for index in cutting if plane.goes_across(moves[index])]
    tool = diameters.get(moves[section.at].tool, 0.0) / 2
    steps = contour_path(section.elements, section.height, tool, tolerance)
    allowed = tolerance + LAST_DECIMAL
    blended = max(allowed, blending_asked(section)) if axes.face else allowed
    found = lay_section(section, steps, plane, moves, path, (allowed, blended), real)
    points = points_of(plane, across, path, real)
    lengths = [path.part_length(index) for index in across] or [0.0]
    pace = pace_of(own, across, path, real)
    return SectionFacts(
        section,
        plane,
        tool,
        tuple(sorted({stretch[0].side for stretch in stretches_of(section)})),
        found,
        feed_off(found, moves, slower_on_face(found, moves, path, axes)),
        contour_size(section, found, points, tool, plane.sizes),
        other_side(section, tool),
        jump=jump_between(across, moves, points_of(plane, across, path)),
        pieces=len(across),
        shortest=min(lengths),
        longest=max(lengths),
        pace=pace,
        turns=turns_of(section, plane, moves, path, real),
        c_limit=axes.c_speed,
        zero=moves[section.at].start[C],
        start_height=moves[section.at].start[section.third],
        lowest=min(moves[index].end[section.third] for index in own),
        slowest_at=plane.of_part(pace.point),
        slowest_line=moves[pace.move].line,
        motion_off=tuple(motion_off(section, moves, path, axes, tolerance)),
        act_off=act_off(section, moves),
        left_behind=left_by_section(section),
    )


def blending_asked(section: SectionContour) -> float:
    """Return the greatest P of G64 that the words ask for, mm: on the face it holds at corners."""
    given = (G64_P.match(path) for path in section.asked_paths)
    return max((float(each[1]) * section.unit for each in given if each), default=0.0)


def points_of(
    plane: Plane, indices: Sequence[int], path: Track, real: Followed | None = None
) -> dict[int, np.ndarray]:
    """Return the tool centre's points (complex) along moves, as emitted or as in a run."""
    if real is not None:
        return {index: plane.points(real.positions[real.during(index)]) for index in indices}
    return {index: plane.points(path.positions[path.vertices(index)]) for index in indices}


def jump_between(
    across: Sequence[int], moves: Sequence[Move], points: dict[int, np.ndarray]
) -> float:
    """Return the greatest change of direction between segments of one block, degrees."""
    joints = [
        pair for pair in zip(across, across[1:]) if moves[pair[0]].line == moves[pair[1]].line
    ]
    turns = (
        (points[after][1] - points[after][0]) / (points[before][-1] - points[before][-2])
        for before, after in joints
    )
    return float(max((abs(np.degrees(np.angle(turn))) for turn in turns), default=0.0))
