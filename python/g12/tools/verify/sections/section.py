# SPDX-License-Identifier: GPL-2.0-or-later
"""What is measured of a section: its toolpath against the words', its size, its pace, its acts.

The contour's plane is that of complex numbers. That of a polar section turns with the part, the
real axis is X where the section begins; on a cylinder it is the unrolled surface. Lengths are
millimetres, angles degrees, C's speed degrees/s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from g12.machine_ini import AXES
from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.slowest import Pace, pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.section import SectionPath, judge_toolpath, lay_section
from g12.tools.verify.compare.section_plane import Plane, plane_of
from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LAST_DECIMAL, LEVEL, SIZE, TURNING
from g12.tools.verify.sections.contour_side import judge_side
from g12.tools.verify.sections.neighbour_cuts import NeighbourCut, neighbour_cuts
from g12.tools.verify.sections.outline import outlines_of
from g12.tools.verify.sections.section_motion import (
    G64_P,
    SectionAxes,
    judge_motion,
    slower_on_face,
)
from g12.tools.verify.sections.section_size import SectionSize, contour_size
from g12.tools.verify.sections.section_state import judge_section_state
from g12.tools.verify.sections.section_turns import Turns, turns_of

TINY_SEGMENT = 1e-6
SAME_ANGLE = 1e-3  # degree


@dataclass(frozen=True)
class SectionFacts:
    """What was measured of one section.

    ``path`` is its toolpath, expected and made, ``size`` that of the contour. ``jump`` is the
    greatest change of direction from segment to segment of one block, ``c_limit`` C's greatest
    speed, ``tool`` the cutter's radius.

    ``zero`` is the angle of C where the section begins, ``start_height`` Z there, ``lowest`` the
    lowest Z, on a cylinder X. ``slowest_at`` is the place of the lowest feed as the section's own
    X (a radius), C and Z, ``slowest_line`` its block. ``judged`` are its findings and notes.
    """

    section: SectionContour
    plane: Plane
    tool: float
    sides: tuple[int, ...]
    path: SectionPath
    size: SectionSize
    jump: float
    segments: int
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
    judged: tuple[Finding, ...] = ()

    @property
    def deviation(self) -> float:
        """The tool centre's greatest distance from where it should be, inf if part is missing."""
        return self.path.off


def measure_section(
    section: SectionContour,
    path: Track,
    moves: Sequence[Move],
    diameters: Mapping[int, float],
    axes: SectionAxes,
    tolerance: float,
    real: Followed | None = None,
) -> SectionFacts:
    """Return the facts of a section that moves; ``path`` and ``real`` are those of its part."""
    plane, axes = plane_of(section, moves[section.at]), axes.of(section)
    own = range(section.at, section.end)
    cutting = [i for i in own if moves[i].kind != "rapid" and path.part_length(i) > TINY_SEGMENT]
    across = [index for index in cutting if plane.goes_across(moves[index])]
    tool = diameters.get(moves[section.at].tool, 0.0) / 2
    steps = contour_path(section.elements, section.height, tool, tolerance)
    allowed = tolerance + LAST_DECIMAL
    blended = max(allowed, blending_asked(section)) if axes.face else allowed
    found = lay_section(section, steps, plane, moves, path, (allowed, blended), real)
    points = points_of(plane, across, path, real)
    lengths = [path.part_length(index) for index in across] or [0.0]
    pace = pace_of(own, across, path, real)
    facts = SectionFacts(
        section,
        plane,
        tool,
        tuple(sorted({outline.side for outline in outlines_of(section)})),
        found,
        contour_size(section, found, points, tool, plane.sizes),
        jump=jump_between(across, moves, points_of(plane, across, path)),
        segments=len(across),
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
    )
    judged = [Finding("contour-unread", section.line, {"why": section.doubt})]
    if not section.doubt:
        motion = judge_motion(section, found, moves, path, axes, tolerance)
        slower = slower_on_face(found, moves, path, axes)
        judged = [
            *judge_words(facts),
            *judge_toolpath(found, plane, section.diameters, moves, slower, section.last),
            *judge_turns(facts),
            *judge_neighbours(neighbour_cuts(steps, tool, tolerance) if tool else ()),
            *motion,
            *judge_section_state(section, moves),
        ]
    return replace(facts, judged=tuple(replace(each, file=section.file) for each in judged))


def judge_words(facts: SectionFacts) -> Iterator[Finding]:
    """Yield what the words of a section most likely do not mean, and what to know of them."""
    section, zero = facts.section, facts.section.zero_line
    yield from judge_side(section, facts.tool)
    if not zero.commanded and zero.turned:
        values = {"line": zero.line, "turned": zero.turned}
        yield Finding("zero-line-turned", section.line, values)
    if not zero.commanded and not zero.line:
        yield Finding("zero-line-unknown", section.line, {"angle": facts.zero})
    letter, factor = AXES[section.third], 2 if section.surface and section.diameters else 1
    depths = [each.depth for each in section.elements if each.side and not each.ramp]
    if depths and min(depths) > section.height + LEVEL:
        levels = {"level": factor * min(depths), "start": factor * section.height}
        yield Finding("above-start", section.line, {"letter": letter, **levels})
    if section.surface and facts.lowest >= facts.start_height - SIZE:
        yield Finding("not-below-start", section.line, {"letter": letter, "code": section.code})
    if not facts.tool and any(facts.sides):
        yield Finding("no-diameter", section.line)


def judge_neighbours(cuts: Sequence[NeighbourCut]) -> Iterator[Finding]:
    """Yield where the tool of one contour cuts into another one."""
    for cut in cuts:
        yield Finding("cuts-contour", cut.line, {"size": cut.size, "line": cut.other})


def judge_turns(facts: SectionFacts) -> Iterator[Finding]:
    """Yield where C is faster than it may be, turns farther than it needs to, or rubs."""
    turns, line = facts.turns, facts.section.line
    speed = max(turns.speed, turns.asked)
    if speed > facts.c_limit * TURNING:
        yield Finding("c-speed", line, {"made": speed, "limit": facts.c_limit})
    if turns.too_far is not None:
        yield Finding("c-turned-too-far", turns.too_far[0], {"turned": turns.too_far[1]})
    if turns.in_place.degrees > SAME_ANGLE:
        yield Finding("rubs", line, turns.in_place._asdict())


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
