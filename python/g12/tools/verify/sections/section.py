# SPDX-License-Identifier: GPL-2.0-or-later
"""What is measured of a section: its toolpath against the words', its size, its pace, its acts.

The contour's plane is that of complex numbers. That of a polar section turns with the part, the
real axis is X where the section begins; on a cylinder it is the unrolled surface. Lengths are
millimetres, angles degrees, C's speed degrees/s.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini
from g12.tools.path.lathe_axes import lathe_axes
from g12.tools.path.part import C, Z
from g12.tools.path.section_times import Leg, SectionTimes, section_times
from g12.tools.path.slowest import pace_of
from g12.tools.verify.compare.section import judge_toolpath
from g12.tools.verify.compare.state import judge_section_state
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import NO_LENGTH, Expected
from g12.tools.verify.result.cut import MeasuredCut, finite, in_file, pace_values
from g12.tools.verify.result.finding import Finding, minus_hint
from g12.tools.verify.result.tolerances import LEVEL, SIZE
from g12.tools.verify.sections.outline import judge_side, neighbour_cuts, stretches_of
from g12.tools.verify.sections.section_motion import c_speed, judge_c, judge_motion, rubbing
from g12.tools.verify.sections.section_size import contour_size
from g12.tools.verify.sections.view import SectionView

SIDES = {1: "left of the contour (G41)", -1: "right of the contour (G42)", 0: "on the contour"}


def measure_section(view: SectionView) -> MeasuredCut:
    section, plane = view.section, view.plane
    off = math.nan if section.doubt else view.found.off
    unread = [Finding("contour-unread", section.line, {"why": section.doubt})]
    return MeasuredCut(
        section,
        section.line,
        section.file,
        section.code,
        view.own,
        plane.zero.imag if section.surface else plane.base,
        off,
        {
            **section_words(view),
            **motion_values(view),
            "deviation": finite(off),
            "c_speed": c_speed(view),
            "c_limit": finite(view.axes.c.speed),
            "turned_in_place": rubbing(view),
        },
        in_file(
            unread if section.doubt else judge_section(view),
            section.file,
            plane.place((section.start, section.height)),
        ),
        section.last,
        surface=section.surface,
        feeds=tuple(element.feed for element in section.elements if element.feed),
        per_turn=max((element.per_turn for element in section.elements), default=0.0),
        path=view.expected,
        sound=bool(section.doubt) or view.found.difference is None,
    )


def judge_section(view: SectionView) -> Iterator[Finding]:
    """Yield what is to know of a section."""
    yield from judge_words(view)
    yield from judge_toolpath(view)
    yield from judge_c(view)
    if view.tool:
        yield from neighbour_cuts(view.steps, view.tool, view.tolerance, view.section.surface)
    yield from judge_motion(view)
    yield from judge_section_state(view.section, view.moves)


def section_words(view: SectionView) -> dict[str, Any]:
    """Return what the words of a section command as plain values.

    ``lowest`` is machine Z, or how far from the axis of a cylinder.
    """
    section, radius = view.section, view.section.surface
    return {
        "cutter": 2 * view.tool,
        "sides": " and ".join(SIDES[side] for side in section.sides if side) or SIDES[0],
        "surface": radius or None,
        "starts_at": section.c if radius else None,
        "zero_line": None if radius else view.first.start[C],
        "x_words": "diameters" if section.diameters else "radii",
        "lowest": view.lowest - (view.plane.base if radius else 0.0),
        "below_surface": view.plane.face - view.lowest if radius else None,
    }


def motion_values(view: SectionView) -> dict[str, Any]:
    """Return what was made as plain values; the place of the lowest feed is in program words."""
    section, plane, across = view.section, view.plane, view.across
    size, lengths = contour_size(view), [view.path.part_length(i) for i in across] or [0.0]
    pace = pace_of(view.own, across, view.path, view.real)
    level = pace.point[Z] - (plane.base if section.surface else 0.0)
    lowest_at = complex(plane.points(np.array([pace.point]))[0]), level
    return {
        "along_z" if section.surface else "radii": list(size.programmed),
        "reached": list(size.reached),
        "across_flats": [list(flat) for flat in size.flats],
        "direction_jump": direction_jump(view),
        "segments": len(across),
        "allowed": view.run_tolerance if view.real else view.tolerance,
        "shortest": min(lengths),
        "longest": max(lengths),
        **pace_values(pace),
        "lowest_feed_words": plane.words(lowest_at, section.diameters),
        "lowest_feed_line": view.moves[pace.move].line,
    }


def direction_jump(view: SectionView) -> float:
    """Return the greatest change of direction between segments of one block, degrees."""
    steps = {index: np.diff(view.plane.points(view.points(index))) for index in view.across}
    turns = (
        np.angle(steps[after][0] / steps[before][-1])
        for before, after in pairwise(view.across)
        if view.moves[before].line == view.moves[after].line
    )
    return float(max((abs(np.degrees(turn)) for turn in turns), default=0.0))


def judge_words(view: SectionView) -> Iterator[Finding]:
    """Yield what the words of a section most likely do not mean, and what to know of them."""
    section, zero, third = view.section, view.section.zero_line, view.section.third
    yield from judge_side(section, view.tool)
    if not zero.commanded and zero.turned:
        values = {"line": zero.line, "turned": zero.turned, "cut": zero.cut}
        code = "zero-line-turned" if zero.cut else "zero-line-left"
        yield Finding(code, section.line, values)
    if not zero.commanded and not zero.line:
        yield Finding("zero-line-unknown", section.line, {"angle": view.first.start[C]})
    yield from judge_depths(view)
    letter, start = AXIS_LETTERS[third], view.first.start[third]
    if section.surface and view.lowest >= start - SIZE and start > view.plane.face - SIZE:
        yield Finding("not-below-start", section.line, {"letter": letter, "code": section.code})
    if section.cancelled:
        yield Finding("side-cancelled", section.cancelled)
    if not view.tool and any(section.sides):
        yield Finding("no-diameter", section.line)


def judge_depths(view: SectionView) -> Iterator[Finding]:
    """Yield the compensated contours above the part: above the section's start they cut air.

    Below the start they may be a dry pass, unless all of the cut is: that is reported of the cut.
    """
    section, zero = view.section, view.section.surface
    letter, factor = AXIS_LETTERS[section.third], 2 if zero and section.diameters else 1
    lowest = min((each.depth for each in section.elements), default=zero)
    for own in stretches_of(section):
        level = min(each.depth for each in own)
        is_above = own[0].side and not own[0].ramp and level > zero + LEVEL
        values = {"letter": letter, "level": factor * level, "start": factor * section.height}
        if is_above and level > section.height + LEVEL:
            values["hint"] = minus_hint(level, zero)
            yield Finding("above-start", own[0].line, values)
        elif is_above and lowest < zero - LEVEL:
            yield Finding("contour-above", own[0].line, values)


def times_of_section(
    section: SectionContour, toolpath: Sequence[Expected], ini: Ini
) -> SectionTimes | None:
    """Return about how long a section takes, None where that is not estimated.

    That is on a cylinder, with the tool beside the X line, and without a feed.
    """
    unknown = section.doubt or section.surface or ini.tool_beside
    if unknown or not toolpath or not all(move.feed for move in toolpath):
        return None
    across = [move for move in toolpath if move.curve.length > NO_LENGTH]
    plunging = sum(_seconds(move) for move in toolpath if move.curve.length <= NO_LENGTH)
    legs = [Leg(move.curve, move.curve.length / _seconds(move)) for move in across]
    return SectionTimes(*(plunging + each for each in section_times(legs, lathe_axes(ini))))


def _seconds(move: Expected) -> float:
    return 60.0 * move.length / (move.feed or 1.0)
