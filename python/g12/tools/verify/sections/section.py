# SPDX-License-Identifier: GPL-2.0-or-later
"""What is measured of a section: its toolpath against the words', its size, its pace, its acts.

The contour's plane is that of complex numbers. That of a polar section turns with the part, the
real axis is X where the section begins; on a cylinder it is the unrolled surface. Lengths are
millimetres, angles degrees, C's speed degrees/s.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini
from g12.tools.path.follow import Followed
from g12.tools.path.part import C, Z
from g12.tools.path.section_times import Leg, SectionTimes, section_times, turning_machine
from g12.tools.path.slowest import pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.compare.section import (
    Plane,
    SectionPath,
    judge_toolpath,
    lay_section,
    plane_of,
)
from g12.tools.verify.compare.state import judge_section_state
from g12.tools.verify.expected.compensated import contour_path
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import NO_LENGTH, Expected
from g12.tools.verify.result.cut import MeasuredCut, finite, in_file, pace_values
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import LAST_DECIMAL, LEVEL, SIZE
from g12.tools.verify.sections.outline import judge_side, neighbour_cuts
from g12.tools.verify.sections.section_motion import (
    G64_P,
    SectionAxes,
    Turns,
    judge_motion,
    slower_on_face,
    turns_of,
)
from g12.tools.verify.sections.section_size import contour_size

TINY_SEGMENT = 1e-6
SAME_ANGLE = 1e-3  # degree
SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)", 0: "on the contour"}


def measure_section(
    section: SectionContour,
    path: Track,
    moves: Sequence[Move],
    diameters: Mapping[int, float],
    axes: SectionAxes,
    tolerance: float,
    real: Followed | None = None,
) -> MeasuredCut:
    """Return what was measured of a section that moves, on its part's ``path`` and ``real``."""
    first, axes = moves[section.at], axes.of(section)
    plane, own = plane_of(section, first), range(section.at, section.end)
    tool = diameters.get(first.tool, 0.0) / 2
    steps = contour_path(section.elements, section.height, tool, tolerance)
    allowed = tolerance + LAST_DECIMAL
    blended = max(allowed, blending_asked(section)) if axes.face else allowed
    found = lay_section(section, steps, plane, moves, path, (allowed, blended), real)
    turns = turns_of(section, moves, path, axes, real)
    off = math.nan if section.doubt else found.off
    judged = [Finding("contour-unread", section.line, {"why": section.doubt})]
    if not section.doubt:
        slower = slower_on_face(found, moves, path, axes)
        judged = [
            *judge_words(section, moves, tool),
            *judge_toolpath(found, plane, section.diameters, moves, slower, section.last),
            *judge_turns(section.line, turns, axes),
            *(neighbour_cuts(steps, tool, tolerance) if tool else ()),
            *judge_motion(section, found, moves, path, axes, tolerance),
            *judge_section_state(section, moves),
        ]
    return MeasuredCut(
        section,
        section.line,
        section.file,
        section.code,
        own,
        None if section.surface else first.start[Z] - section.height,
        off,
        {
            **section_words(section, first, tool, min(moves[i].end[section.third] for i in own)),
            **motion_values(section, found, plane, moves, path, tool, real),
            "deviation": finite(off),
            "c_speed": turns.speed,
            "c_limit": finite(axes.c_speed),
            "turned_in_place": turns.in_place._asdict(),
        },
        in_file(judged, section.file, plane.place((section.start, section.height))),
        section.last,
        feeds=tuple(element.feed for element in section.elements if element.feed),
        path=found.expected,
        sound=bool(section.doubt) or found.difference is None,
    )


def section_words(
    section: SectionContour, first: Move, tool: float, lowest: float
) -> dict[str, Any]:
    """Return what the words of a section ask for as plain values; ``lowest`` is Z, or X."""
    radius, sides = section.surface, section.sides
    depth = radius - (lowest - first.start[section.third] + section.height)
    return {
        "cutter": 2 * tool,
        "sides": " and ".join(SIDES[side] for side in sides if side) or SIDES[0],
        "surface": radius or None,
        "starts_at": section.c if radius else None,
        "zero_line": None if radius else first.start[C],
        "x_words": "diameters" if section.diameters else "radii",
        "lowest": lowest,
        "below_surface": depth if radius else None,
    }


def motion_values(
    section: SectionContour,
    found: SectionPath,
    plane: Plane,
    moves: Sequence[Move],
    path: Track,
    tool: float,
    real: Followed | None,
) -> dict[str, Any]:
    """Return what was made as plain values; the place of the lowest feed is in program words."""
    own = range(section.at, section.end)
    cutting = [i for i in own if moves[i].kind != "rapid" and path.part_length(i) > TINY_SEGMENT]
    across = [  # the start of a full circle is its end
        i
        for i in cutting
        if moves[i].kind == "arc" or any(moves[i].start[a] != moves[i].end[a] for a in plane.axes)
    ]
    size = contour_size(section, found, points_of(plane, across, path, real), tool, plane.sizes)
    lengths = [path.part_length(index) for index in across] or [0.0]
    pace = pace_of(own, across, path, real)
    x, c, z = plane.of_part(pace.point)
    return {
        "along_z" if section.surface else "radii": list(size.wanted),
        "reached": list(size.reached),
        "across_flats": [list(flat) for flat in size.flats],
        "direction_jump": jump_between(across, moves, points_of(plane, across, path)),
        "segments": len(across),
        "shortest": min(lengths),
        "longest": max(lengths),
        **pace_values(pace),
        "lowest_feed_words": [
            ["X", 2 * x if section.diameters else x],
            ["C", plain(c, 3) if section.surface else c],
            ["Z", z],
        ],
        "lowest_feed_line": moves[pace.move].line,
    }


def judge_words(section: SectionContour, moves: Sequence[Move], tool: float) -> Iterator[Finding]:
    """Yield what the words of a section most likely do not mean, and what to know of them."""
    zero, first, third = section.zero_line, moves[section.at], section.third
    yield from judge_side(section, tool)
    if not zero.commanded and zero.turned:
        values = {"line": zero.line, "turned": zero.turned}
        yield Finding("zero-line-turned", section.line, values)
    if not zero.commanded and not zero.line:
        yield Finding("zero-line-unknown", section.line, {"angle": first.start[C]})
    letter, factor = AXIS_LETTERS[third], 2 if section.surface and section.diameters else 1
    depths = [each.depth for each in section.elements if each.side and not each.ramp]
    if depths and min(depths) > section.height + LEVEL:
        levels = {"level": factor * min(depths), "start": factor * section.height}
        yield Finding("above-start", section.line, {"letter": letter, **levels})
    lowest = min(moves[index].end[third] for index in range(section.at, section.end))
    if section.surface and lowest >= first.start[third] - SIZE:
        yield Finding("not-below-start", section.line, {"letter": letter, "code": section.code})
    if not tool and any(section.sides):
        yield Finding("no-diameter", section.line)


def judge_turns(line: int, turns: Turns, axes: SectionAxes) -> Iterator[Finding]:
    """Yield where C is faster than its limit, turns farther than it needs to, or rubs."""
    speed = max(turns.speed, turns.asked)
    if speed > axes.most_c_speed:
        yield Finding("c-speed", line, {"made": speed, "limit": axes.c_speed})
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


def times_of_section(
    section: SectionContour, toolpath: Sequence[Expected], ini: Ini
) -> SectionTimes | None:
    """Return about how long a section takes, None where that is not reckoned.

    That is on a cylinder, with the tool beside the X line, and without a feed.
    """
    unknown = section.doubt or section.surface or ini.tool_beside
    if unknown or not toolpath or not all(move.feed for move in toolpath):
        return None
    across = [move for move in toolpath if move.curve.length > NO_LENGTH]
    plunging = sum(_seconds(move) for move in toolpath if move.curve.length <= NO_LENGTH)
    legs = [Leg(move.curve, move.curve.length / _seconds(move)) for move in across]
    return SectionTimes(*(plunging + each for each in section_times(legs, turning_machine(ini))))


def _seconds(move: Expected) -> float:
    """Return the time of a move at its feed."""
    return 60.0 * move.length / (move.feed or 1.0)
