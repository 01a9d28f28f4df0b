# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a section follows its contour, from the emitted or the real motion.

The contour's plane is that of complex numbers. That of a polar section turns with the part, the
real axis is X where the section begins; on a cylinder it is the unrolled surface. Lengths are
millimetres, areas square millimetres, angles degrees, C's speed degrees/s.

With compensation the tool's centre must stay one tool radius away from the contour, on the
programmed side. ``gouge`` is what the cutter takes beyond the contour, ``left`` what it leaves of
what it could have reached, each an integral of the excess along the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from g12.tools.path.follow import Followed
from g12.tools.path.part import C
from g12.tools.path.slowest import Pace, pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.closed_contour import MEETS, trimmed
from g12.tools.verify.compare.state import StateDifference
from g12.tools.verify.contour_distance import SAME, STEP, ContourDistances
from g12.tools.verify.contour_side import OtherSide, other_side
from g12.tools.verify.contour_width import across_flats
from g12.tools.verify.section_blocks import (
    InPlace,
    OffOrder,
    OffWords,
    depth_off,
    feed_off,
    order_off,
    turn_speed,
    turned_in_place,
)
from g12.tools.verify.section_motion import OffMotion, SectionAxes, motion_off
from g12.tools.verify.section_paths import Plane, ToolPaths, plane_of, tool_paths_of
from g12.tools.verify.section_state import OffAct, act_off, left_by_section
from g12.tools.verify.wanted_contour import Element, SectionContour

TINY_PIECE = 1e-6


@dataclass(frozen=True)
class SectionFacts:
    """What was measured of one section.

    ``wanted`` and ``reached`` are the contour's least and greatest distance from the spindle's
    centre, on a cylinder Z, where compensation is on if it is anywhere, ``flats`` its widths
    between parallel sides, programmed and reached; what leads to it and from it is no part of it.
    ``other_side`` says that compensation takes the tool to the other side than it comes from.
    ``deviation`` is the tool centre's greatest distance from where it should be, ``jump`` the
    greatest change of direction from piece to piece of one block, ``c_speed`` the highest speed
    of C and ``c_limit`` its limit, ``tool`` the cutter's radius. ``through`` says that the tool's
    centre goes beyond the contour: then ``gouge`` is only what lies next to it, and there is more.

    ``zero`` is the angle of C where the section begins, ``start_height`` Z there, ``lowest`` the
    lowest Z, on a cylinder X. ``slowest_at`` is the place of the lowest feed as the section's own
    X (a radius), C and Z, ``slowest_line`` its block. ``depth_off`` and ``feed_off`` are the first
    Z (X on a cylinder) and the first feed that are not the words', ``turn_speed`` is what F asks
    of C where it turns in place, ``in_place`` how far and how long it does below the part's face.
    ``order_off``, ``motion_off`` and ``act_off`` are the first lines and acts that are not in
    their place, rapids and corners that are blended, ``left_behind`` is what is left otherwise.
    """

    section: SectionContour
    tool: float
    sides: tuple[int, ...]
    wanted: tuple[float, float]
    reached: tuple[float, float]
    deviation: float
    left: float
    gouge: float
    through: bool
    flats: tuple[tuple[float, float], ...]
    other_side: OtherSide | None
    jump: float
    pieces: int
    shortest: float
    longest: float
    pace: Pace
    c_speed: float
    c_limit: float
    zero: float
    start_height: float
    lowest: float
    slowest_at: tuple[float, float, float]
    slowest_line: int
    depth_off: OffWords | None
    feed_off: OffWords | None
    turn_speed: float
    in_place: InPlace
    order_off: OffOrder | None = None
    motion_off: tuple[OffMotion, ...] = ()
    act_off: OffAct | None = None
    left_behind: tuple[StateDifference, ...] = ()


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
    plane = plane_of(section, moves[section.at])
    own = range(section.at, section.end)
    cutting = [i for i in own if moves[i].kind != "rapid" and path.part_length(i) > TINY_PIECE]
    across = [index for index in cutting if plane.goes_across(moves[index])]
    tool = diameters.get(moves[section.at].tool, 0.0) / 2
    paths = tool_paths_of(plane, cutting, moves, path, real)
    lengths = [path.part_length(index) for index in across] or [0.0]
    pace = pace_of(own, across, path, real)
    return SectionFacts(
        section,
        tool,
        **contour_facts(section, paths, tool, tolerance),
        jump=jump_between_pieces(across, moves, plane, path),
        pieces=len(across),
        shortest=min(lengths),
        longest=max(lengths),
        pace=pace,
        c_speed=c_speed_of(own, path, plane, real),
        c_limit=axes.c_speed,
        zero=moves[section.at].start[C],
        start_height=moves[section.at].start[section.third],
        lowest=min(moves[index].end[section.third] for index in own),
        slowest_at=plane.of_part(pace.point),
        slowest_line=moves[pace.move].line,
        **block_facts(section, path, moves, axes.of(section), tolerance),
    )


def block_facts(
    section: SectionContour,
    path: Track,
    moves: Sequence[Move],
    axes: SectionAxes,
    tolerance: float,
) -> dict[str, object]:
    """Return those members of ``SectionFacts`` that compare the moves with the blocks' words."""
    return {
        "depth_off": depth_off(section, moves, path, tolerance),
        "feed_off": feed_off(section, moves, path, tolerance, axes),
        "turn_speed": turn_speed(section, moves, path),
        "in_place": turned_in_place(section, moves, path),
        "order_off": order_off(section, moves, path, tolerance),
        "motion_off": tuple(motion_off(section, moves, path, axes, tolerance)),
        "act_off": act_off(section, moves),
        "left_behind": left_by_section(section),
    }


def contour_facts(
    section: SectionContour, paths: ToolPaths, tool: float, tolerance: float
) -> dict[str, object]:
    """Return those members of ``SectionFacts`` that compare the tool's paths with the contour."""
    leads, stretches = leads_of(section, tool), stretches_of(section)
    found = [measure_stretch(stretch, leads, paths, tool, tolerance) for stretch in stretches]
    shaping = [facts for stretch, facts in zip(stretches, found) if stretch[0].side] or found
    return {
        "sides": tuple(sorted({stretch[0].side for stretch in stretches})),
        "wanted": span([facts.wanted for facts in shaping]),
        "reached": span([facts.reached for facts in shaping]),
        "deviation": max((facts.deviation for facts in found), default=0.0),
        "left": sum(facts.left for facts in found),
        "gouge": sum(facts.gouge for facts in found),
        "through": any(facts.through for facts in found),
        "flats": tuple(flat for facts in shaping for flat in facts.flats),
        "other_side": other_side(section, tool),
    }


def stretches_of(section: SectionContour) -> list[list[Element]]:
    """Return the stretches of contour with the tool on one side, ramps aside."""
    longer = (element for element in section.elements if element.length > SAME)
    groups = groupby(longer, key=lambda element: (element.side, element.ramp))
    return [list(stretch) for (_, ramp), stretch in groups if not ramp]


def leads_of(section: SectionContour, tool: float) -> ContourDistances:
    """Return the lines on which compensation is switched on and off.

    They end square to the element that follows, one tool radius away from it, and begin square
    to the one before.
    """
    longer = [element for element in section.elements if element.length > SAME]
    leads = []
    for before, ramp, after in zip([None, *longer], longer, [*longer[1:], None]):
        if ramp.ramp:
            away = before.normal(1.0) * before.side * tool if before else 0.0
            beside = after.normal(0.0) * ramp.side * tool if after else 0.0
            start, end = ramp.start + away, ramp.end + beside
            leads.append(Element(ramp.line, start, end, 0, True, ramp.depth))
    return ContourDistances(leads)


@dataclass(frozen=True)
class StretchFacts:
    """What was measured of one stretch of contour; members as those of ``SectionFacts``."""

    deviation: float
    left: float
    gouge: float
    through: bool
    wanted: np.ndarray
    reached: np.ndarray
    flats: Sequence[tuple[float, float]] = ()


def measure_stretch(
    stretch: Sequence[Element],
    leads: ContourDistances,
    paths: ToolPaths,
    tool: float,
    tolerance: float,
) -> StretchFacts:
    """Return the facts of a stretch of contour; on the leads to and from it all is well."""
    nothing = np.zeros(0)
    if not any(paths.of(element.line) for element in stretch):
        return StretchFacts(float("inf"), 0.0, 0.0, False, nothing, nothing)
    side = stretch[0].side
    radius = tool if side else 0.0
    points, nearest, left_of, own, steps = laid_along(stretch, paths, radius)
    away = np.abs(points - nearest)
    wrong = left_of * side < -SAME
    off = np.where(wrong, -away, away) - radius
    if leads.elements:
        beside = leads.distances(points)
        off = np.where(beside < np.abs(off), beside, off)
    missed, lengths = missed_by(ContourDistances(stretch), side, radius, paths.below(np.inf))
    deviation = float(max(np.abs(off).max(), missed.max(initial=0.0)))
    wall = points + (nearest - points) * radius / np.maximum(away, 1e-12) if side else points
    reach = paths.sizes(nearest[own]), paths.sizes(wall[own])
    if not side:
        return StretchFacts(deviation, 0.0, 0.0, False, *reach)
    left = float(np.maximum(0.0, missed - tolerance) @ lengths)
    across = float(np.where(wrong, np.maximum(0.0, -off - tolerance), 0.0) @ steps)
    bite, lengths = bites(stretch, radius, paths)
    gouge = across + float(np.maximum(0.0, bite - tolerance) @ lengths)
    through = bool(wrong.any() or (bite > radius - STEP).any())
    flats = across_flats(trimmed(stretch), nearest, wall)
    return StretchFacts(deviation, left, gouge, through, *reach, flats)


def laid_along(
    stretch: Sequence[Element], paths: ToolPaths, radius: float
) -> tuple[np.ndarray, ...]:
    """Return the tool centre's points, the contour's next to them, their sides, their steps.

    Before the steps comes which of the contour's points are no lead to it or from it.

    Each block is compared with its own element and those before and after, as far as these are
    part of a closed contour: a later pass may cross the lead-in's extension. Where one line makes
    both, in a loop, a point is held to what it is nearer to. In a run a block's motion begins on
    the one before, where the corner between them is blended, be that a lead.
    """
    closed = trimmed(stretch)
    columns = []
    near: dict[int, set[int]] = {}
    for index, element in enumerate(stretch):
        near.setdefault(element.line, set()).update((index - 1, index, index + 1))
    for line, indices in near.items():
        inside = indices.difference((-1, len(stretch)))
        own = {index for index in inside if stretch[index].line == line}
        elements = [stretch[index] for index in own] + [closed[index] for index in inside - own]
        contours = [ContourDistances(elements)]
        if len(own) > 1:
            contours.append(ContourDistances([closed[index] for index in inside]))
        if paths.measured:
            contours.append(ContourDistances([stretch[index] for index in inside]))
        for tool_path in paths.of(line):
            nearest, sides = next_to(contours, tool_path, stretch[0].side, radius)
            parts = ([each[index] for index in inside] for each in (stretch, closed))
            is_shape = on_shape(nearest, *parts)
            columns.append((tool_path, nearest, sides, is_shape, shares_of(tool_path)))
    return tuple(np.concatenate(column) for column in zip(*columns))


def next_to(
    contours: Sequence[ContourDistances], tool_path: np.ndarray, side: int, radius: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the points next to a path, and its side, of the contour that each point fits best."""
    found = [contour.nearest(tool_path) for contour in contours if contour.elements]
    if len(found) == 1:
        return found[0]
    nearest, sides = (np.array(column) for column in zip(*found))
    away = np.abs(tool_path - nearest)
    off = np.abs(np.where(sides * side < -SAME, -away, away) - radius)
    best = (off.argmin(axis=0), np.arange(len(tool_path)))
    return nearest[best], sides[best]


def on_shape(
    points: np.ndarray, elements: Sequence[Element], closed: Sequence[Element]
) -> np.ndarray:
    """Tell which points of some elements are on what of these is no lead; see ``trimmed``."""
    if sum(part.length for part in closed) > sum(element.length for element in elements) - SAME:
        return np.ones(len(points), bool)
    shape = ContourDistances(closed)
    return shape.distances(points) < MEETS if shape.elements else np.zeros(len(points), bool)


def shares_of(tool_path: np.ndarray) -> np.ndarray:
    """Return the length of a polyline that each of its points stands for."""
    steps = np.abs(np.diff(tool_path)) / 2
    return np.append(steps, 0.0) + np.insert(steps, 0, 0.0)


def missed_by(
    contour: ContourDistances, side: int, wanted: float, tool_path: ContourDistances
) -> tuple[np.ndarray, np.ndarray]:
    """Return how far the cutter stays away from points of the contour that it can reach."""
    points, lengths, normals = contour.samples
    reachable = contour.distances(points + normals * side * wanted) >= wanted - 10 * SAME
    away = tool_path.distances(points[reachable]) - wanted
    return np.maximum(0.0, away), lengths[reachable]


def span(distances: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the least and the greatest of all distances."""
    every = np.concatenate([np.zeros(0), *distances])
    return (float(every.min()), float(every.max())) if len(every) else (0.0, 0.0)


def bites(
    stretch: Sequence[Element], tool: float, paths: ToolPaths
) -> tuple[np.ndarray, np.ndarray]:
    """Return how deep the cutter goes into points of the contour, and the length of each.

    Ramps and later passes count. Where the end of a contour meets its beginning, what sticks out
    beyond is no contour.
    """
    points, lengths, _ = ContourDistances(trimmed(stretch)).samples
    return np.maximum(0.0, tool - paths.distances(points, paths.solid(stretch))), lengths


def jump_between_pieces(
    across: Sequence[int], moves: Sequence[Move], plane: Plane, path: Track
) -> float:
    """Return the greatest change of direction between pieces of one block."""
    jumps = []
    for before, after in zip(across, across[1:]):
        if moves[before].line == moves[after].line:
            one, other = (plane.tool_path(index, path, None).points for index in (before, after))
            turn = (other[1] - other[0]) / (one[-1] - one[-2])
            jumps.append(abs(np.degrees(np.angle(turn))))
    return float(max(jumps, default=0.0))


def c_speed_of(own: Sequence[int], path: Track, plane: Plane, real: Followed | None) -> float:
    """Return the highest speed of C."""
    if real is not None:
        mask = np.isin(real.move, own)
        angle, time = real.positions[mask, C], real.time[mask]
        return float(np.abs(np.gradient(angle, time)).max()) if len(time) > 1 else 0.0
    vertices = slice(path.vertices(own[0]).start, path.vertices(own[-1]).stop)
    positions, seconds = path.positions[vertices], np.maximum(np.diff(path.time[vertices]), 1e-12)
    turned = np.diff(plane.angles(positions, path.part.beside))
    return float((np.abs(turned) / seconds).max(initial=0.0))
