# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a polar section follows its contour, from the emitted or the real motion.

The contour's plane is that of complex numbers: the real axis is X where the section begins, and
the plane turns with the part. Lengths are millimetres, areas square millimetres, angles degrees,
C's speed degrees/s.

With compensation the tool's centre must stay one tool radius away from the contour, on the
programmed side. ``gouge`` is what the cutter takes beyond the contour, ``left`` what it leaves of
what it could have reached, each an integral of the excess along the way.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import groupby, product

import numpy as np
from shapely.geometry import LineString
from shapely.ops import nearest_points

from g12.cli.contour_words import Element, Section
from g12.cli.motion import Followed, Track
from g12.cli.pace import Pace, pace_of
from g12.cli.part import C, X
from g12.cli.trace import Move

STEP = 0.05  # mm between points of the contour that are looked at
CHUNK = 256
LEADS = 3  # elements at either end of a contour that may be there to lead in or out
MEETS = 1e-3
SAME = 1e-7
TINY_PIECE = 1e-6


@dataclass(frozen=True)
class SectionFacts:
    """What was measured of one section.

    ``wanted`` and ``reached`` are the contour's least and greatest distance from the spindle's
    centre, where compensation is on if it is anywhere. ``deviation`` is the tool centre's
    greatest distance from where it should be, ``jump`` the greatest change of direction from
    piece to piece of one block, ``c_speed`` the highest speed of C and ``c_limit`` its limit,
    ``tool`` the cutter's radius.
    """

    section: Section
    tool: float
    sides: tuple[int, ...]
    wanted: tuple[float, float]
    reached: tuple[float, float]
    deviation: float
    left: float
    gouge: float
    jump: float
    pieces: int
    shortest: float
    longest: float
    pace: Pace
    c_speed: float
    c_limit: float


class Shape:
    """Elements of a contour as arrays, for distances to many points at once."""

    def __init__(self, elements: Sequence[Element]) -> None:
        self.elements = [element for element in elements if element.length > SAME]
        self.start = np.array([element.start for element in self.elements])
        self.end = np.array([element.end for element in self.elements])
        arcs = [element.centre is not None for element in self.elements]
        self.arc = np.array(arcs, bool)
        self.centre = np.array([element.centre or 0.0 for element in self.elements], complex)
        self.sweep = np.array([element.sweep for element in self.elements])
        radius = np.where(self.arc, np.abs(self.start - self.centre), 0.0)
        middle = np.where(self.arc, self.centre, (self.start + self.end) / 2)
        self.middle = middle
        self.reach = np.where(self.arc, radius, np.abs(self.end - self.start) / 2)

    @cached_property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Points along the contour, the length each stands for, the directions to its left."""
        points, lengths, normals = [], [], []
        for element in self.elements:
            count = max(2, int(element.length / STEP))
            shares = (np.arange(count) + 0.5) / count
            points += [element.point(share) for share in shares]
            normals += [element.normal(share) for share in shares]
            lengths += [element.length / count] * count
        return np.array(points, complex), np.array(lengths), np.array(normals, complex)

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return the distance of points to the contour."""
        return np.abs(points - self.nearest(points)[0])

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the contour's point next to each point, and the side: above 0 is left of it."""
        found, side = np.empty(len(points), complex), np.empty(len(points))
        for first in range(0, len(points), CHUNK):
            part = slice(first, first + CHUNK)
            found[part], side[part] = self._nearest(points[part])
        return found, side

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        near = self._near(points)
        nearest = np.where(
            self.arc[near], self._on_arcs(points, near), self._on_lines(points, near)
        )
        away = np.abs(points[:, None] - nearest)
        first = away.argmin(axis=1)[:, None]
        tied = away <= np.take_along_axis(away, first, axis=1) + SAME
        side = np.where(tied, self._sides(points, nearest, near), 0.0).sum(axis=1)
        return np.take_along_axis(nearest, first, axis=1)[:, 0], side

    def _near(self, points: np.ndarray) -> np.ndarray:
        """Return the elements that can be nearest to any of some points close together."""
        middle = (points[0] + points[-1]) / 2
        spread = np.abs(points - middle).max()
        between = np.abs(self.middle - middle)
        inner = np.maximum(0.0, between - self.reach) - spread
        farthest = (between + self.reach).min() + spread
        return np.flatnonzero(np.where(self.arc, 0.0, inner) <= farthest)

    def _on_lines(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        start, along = self.start[near], self.end[near] - self.start[near]
        square = np.maximum(np.abs(along) ** 2, 1e-30)
        share = ((points[:, None] - start) * along.conj()).real / square
        return start + along * np.clip(share, 0.0, 1.0)

    def _on_arcs(self, points: np.ndarray, near: np.ndarray) -> np.ndarray:
        centre, start = self.centre[near], self.start[near] - self.centre[near]
        sweep = self.sweep[near]
        way = points[:, None] - centre
        turn = np.angle(way / np.where(start == 0, 1.0, start)) * np.sign(sweep)
        on = np.where(turn < 0, turn + 2 * np.pi, turn) <= np.abs(sweep)
        away = np.abs(way)
        towards = np.where(away > SAME, way / np.maximum(away, SAME), start / np.abs(start + 1e-30))
        ring = centre + towards * np.abs(start)
        ends = np.stack(np.broadcast_arrays(self.start[near], self.end[near]))
        closer = np.abs(points[:, None] - ends[0]) < np.abs(points[:, None] - ends[1])
        return np.where(on, ring, np.where(closer, ends[0], ends[1]))

    def _sides(self, points: np.ndarray, nearest: np.ndarray, near: np.ndarray) -> np.ndarray:
        lines = self.end[near] - self.start[near]
        arcs = 1j * np.sign(self.sweep[near]) * (nearest - self.centre[near])
        along = np.where(self.arc[near], arcs, lines)
        along = along / np.maximum(np.abs(along), 1e-30)
        return (along.conj() * (points[:, None] - nearest)).imag


def measure_section(
    section: Section,
    path: Track,
    moves: Sequence[Move],
    diameters: dict[int, float],
    limit: float,
    tolerance: float,
    real: Followed | None = None,
) -> SectionFacts:
    """Return the facts of a section; ``limit`` is C's greatest speed, degrees/s."""
    plane = Plane(section, moves[section.at])
    own = range(section.at, section.end)
    cutting = [i for i in own if moves[i].kind != "rapid" and path.part_length(i) > TINY_PIECE]
    across = [index for index in cutting if goes_across(moves[index])]
    tool = diameters.get(moves[section.at].tool, 0.0) / 2
    ways = Ways(
        (block, joined([plane.line(index, path, real) for index in stretch]))
        for block, stretch in groupby(across, key=lambda index: moves[index].block)
    )
    runs = runs_of(section)
    leads = leads_of(section, tool)
    found = [measure_run(run, leads, ways, tool, tolerance) for run in runs]
    shaping = [facts for run, facts in zip(runs, found) if run[0].side] or found
    lengths = [path.part_length(index) for index in across] or [0.0]
    return SectionFacts(
        section,
        tool,
        tuple(sorted({run[0].side for run in runs})),
        wanted=span([facts.wanted for facts in shaping]),
        reached=span([facts.reached for facts in shaping]),
        deviation=max((facts.deviation for facts in found), default=0.0),
        left=sum(facts.left for facts in found),
        gouge=sum(facts.gouge for facts in found),
        jump=largest_jump(across, moves, plane, path),
        pieces=len(across),
        shortest=min(lengths),
        longest=max(lengths),
        pace=pace_of(own, across, path, real),
        c_speed=c_speed_of(own, path, real),
        c_limit=limit,
    )


class Plane:
    """Turns machine positions into points of the contour's plane."""

    def __init__(self, section: Section, first: Move) -> None:
        self._shift = first.start[X] - section.x
        self._angle = first.start[C]

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the points (complex) of machine positions (n, 9)."""
        angle = np.radians(positions[:, C] - self._angle)
        return (positions[:, X] - self._shift) * np.exp(1j * angle)

    def line(self, index: int, path: Track, real: Followed | None) -> np.ndarray:
        """Return the tool centre's way during a move: emitted, or as it was."""
        if real is not None:
            return self.points(real.positions[real.during(index)])
        return self.points(path.positions[path.vertices(index)])


def goes_across(move: Move) -> bool:
    """Tell whether a move changes X or C."""
    return move.start[X] != move.end[X] or move.start[C] != move.end[C]


def runs_of(section: Section) -> list[list[Element]]:
    """Return the stretches of contour with the tool on one side, ramps aside."""
    longer = (element for element in section.elements if element.length > SAME)
    groups = groupby(longer, key=lambda element: (element.side, element.ramp))
    return [list(run) for (_, ramp), run in groups if not ramp]


def leads_of(section: Section, tool: float) -> Shape:
    """Return the ways on which compensation is switched on and off.

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
    return Shape(leads)


class Ways:
    """The tool centre's ways during a section, each with the line of its block."""

    def __init__(self, ways: Iterable[tuple[int, np.ndarray]]) -> None:
        self._ways: dict[int, list[np.ndarray]] = {}
        for line, way in ways:
            if len(way) > 1:
                self._ways.setdefault(line, []).append(way)

    def of(self, line: int) -> list[np.ndarray]:
        """Return the ways of a line."""
        return self._ways.get(line, [])

    @cached_property
    def shape(self) -> Shape:
        """Return all of them, to measure distances from."""
        return shape_of_ways([way for ways in self._ways.values() for way in ways])


def joined(lines: Sequence[np.ndarray]) -> np.ndarray:
    """Return the ways of moves that follow each other as one."""
    points = np.concatenate(lines)
    return points[np.append(True, np.abs(np.diff(points)) > 0.0)] if len(points) else points


def shape_of_ways(ways: Sequence[np.ndarray]) -> Shape:
    """Return polylines as a shape."""
    pairs = (pair for way in ways for pair in zip(way, way[1:]))
    return Shape([Element(0, start, end, 0, False, 0.0) for start, end in pairs])


@dataclass(frozen=True)
class RunFacts:
    """What was measured of one stretch of contour; members as those of ``SectionFacts``."""

    deviation: float
    left: float
    gouge: float
    wanted: np.ndarray
    reached: np.ndarray


def measure_run(
    run: Sequence[Element], leads: Shape, ways: Ways, tool: float, tolerance: float
) -> RunFacts:
    """Return the facts of a stretch of contour; on the leads to and from it all is well."""
    nothing = np.zeros(0)
    if not any(ways.of(element.line) for element in run):
        return RunFacts(float("inf"), 0.0, 0.0, nothing, nothing)
    side = run[0].side
    radius = tool if side else 0.0
    points, nearest, left_of, steps = laid_along(run, ways)
    away = np.abs(points - nearest)
    wrong = left_of * side < -SAME
    off = np.where(wrong, -away, away) - radius
    if leads.elements:
        beside = leads.distances(points)
        off = np.where(beside < np.abs(off), beside, off)
    missed, lengths = missed_by(Shape(run), side, radius, ways.shape)
    deviation = float(max(np.abs(off).max(), missed.max(initial=0.0)))
    wall = points + (nearest - points) * radius / np.maximum(away, 1e-12) if side else points
    if not side:
        return RunFacts(deviation, 0.0, 0.0, np.abs(nearest), np.abs(wall))
    left = float(np.maximum(0.0, missed - tolerance) @ lengths)
    across = float(np.where(wrong, np.maximum(0.0, -off - tolerance), 0.0) @ steps)
    gouge = across + bitten(run, radius, ways, tolerance)
    return RunFacts(deviation, left, gouge, np.abs(nearest), np.abs(wall))


def laid_along(run: Sequence[Element], ways: Ways) -> tuple[np.ndarray, ...]:
    """Return the tool centre's points, the contour's next to them, their sides, their steps.

    Each block is compared with its own element and those before and after: a later pass may
    cross the lead-in's extension.
    """
    columns = []
    near: dict[int, set[int]] = {}
    for index, element in enumerate(run):
        near.setdefault(element.line, set()).update((index - 1, index, index + 1))
    for line, indices in near.items():
        shape = Shape([run[index] for index in sorted(indices) if 0 <= index < len(run)])
        for way in ways.of(line):
            columns.append((way, *shape.nearest(way), shares_of(way)))
    return tuple(np.concatenate(column) for column in zip(*columns))


def shares_of(way: np.ndarray) -> np.ndarray:
    """Return the length of a polyline that each of its points stands for."""
    steps = np.abs(np.diff(way)) / 2
    return np.append(steps, 0.0) + np.insert(steps, 0, 0.0)


def missed_by(shape: Shape, side: int, wanted: float, way: Shape) -> tuple[np.ndarray, np.ndarray]:
    """Return how far the cutter stays away from points of the contour that it can reach."""
    points, lengths, normals = shape.samples
    reachable = shape.distances(points + normals * side * wanted) >= wanted - 10 * SAME
    away = way.distances(points[reachable]) - wanted
    return np.maximum(0.0, away), lengths[reachable]


def span(distances: Sequence[np.ndarray]) -> tuple[float, float]:
    """Return the least and the greatest of all distances."""
    every = np.concatenate([np.zeros(0), *distances])
    return (float(every.min()), float(every.max())) if len(every) else (0.0, 0.0)


def bitten(run: Sequence[Element], tool: float, ways: Ways, tolerance: float) -> float:
    """Return the area that the cutter takes beyond the contour, ramps and later passes included.

    Where the end of a contour meets its beginning, what sticks out beyond is no contour.
    """
    first, last = closing(run)
    points, lengths, _ = Shape(run).samples
    along = np.cumsum(lengths) - lengths / 2
    kept = (along >= first) & (along <= last)
    away = ways.shape.distances(points[kept])
    return float(np.maximum(0.0, tool - away - tolerance) @ lengths[kept])


def closing(run: Sequence[Element]) -> tuple[float, float]:
    """Return the lengths along a contour between which it is closed; else its whole length."""
    ends = np.concatenate([[0.0], np.cumsum([element.length for element in run])])
    for i, j in product(range(min(len(run), LEADS)), range(len(run) - 1, len(run) - 1 - LEADS, -1)):
        if j > i + 1:
            one, other = (as_line(run[k]) for k in (i, j))
            if one.distance(other) < MEETS:
                here, there = nearest_points(one, other)
                return ends[i] + one.project(here), ends[j] + other.project(there)
    return 0.0, ends[-1]


def as_line(element: Element) -> LineString:
    """Return an element as a polyline."""
    count = max(1, int(element.length / STEP)) if element.centre is not None else 1
    points = (element.point(index / count) for index in range(count + 1))
    return LineString([(point.real, point.imag) for point in points])


def largest_jump(across: Sequence[int], moves: Sequence[Move], plane: Plane, path: Track) -> float:
    """Return the greatest change of direction between pieces of one block."""
    jumps = []
    for before, after in zip(across, across[1:]):
        if moves[before].block == moves[after].block:
            one, other = (plane.line(index, path, None) for index in (before, after))
            turn = (other[1] - other[0]) / (one[-1] - one[-2])
            jumps.append(abs(np.degrees(np.angle(turn))))
    return float(max(jumps, default=0.0))


def c_speed_of(own: Sequence[int], path: Track, real: Followed | None) -> float:
    """Return the highest speed of C."""
    if real is not None:
        mask = np.isin(real.move, own)
        angle, time = real.positions[mask, C], real.time[mask]
        return float(np.abs(np.gradient(angle, time)).max()) if len(time) > 1 else 0.0
    vertices = slice(path.vertices(own[0]).start, path.vertices(own[-1]).stop)
    turned, seconds = np.diff(path.positions[vertices, C]), np.diff(path.time[vertices])
    return float((np.abs(turned) / np.maximum(seconds, 1e-12)).max(initial=0.0))
