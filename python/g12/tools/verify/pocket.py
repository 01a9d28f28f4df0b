# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a circle was cut: size, walls, what is left or gouged, from the emitted or real motion.

Lengths are millimetres, areas square millimetres, angles degrees, feeds mm/min, times seconds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import NamedTuple

import numpy as np
from shapely.geometry import MultiLineString, Point
from shapely.geometry.base import BaseGeometry

from g12.tools.path.follow import Followed
from g12.tools.path.part import disc, swept
from g12.tools.path.slowest import Pace, pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.wanted_circle import Target

SECTORS = 720  # directions in which the wall is looked at
SAME_LEVEL = 1e-3
FINE = 1e-5  # chord error of the polylines that stand for arcs
ROUND = 4e-6  # the same of an arc with radius 1, so that every sector gets a point
COARSE = 1e-4  # the same where distances are looked for many times
SAME_FEED = 1e-6
SAME_PLACE = 6  # decimals
NEAR_CENTRE = 0.02  # of a move's own reach

Lines = dict[float, list[np.ndarray]]


@dataclass(frozen=True)
class PocketFacts:
    """What was measured of one pocket.

    ``reached`` is the radius of the wall, ``deviation`` the wall's greatest distance from the
    programmed circle, all round; ``left`` and ``gouge`` are areas beyond the tolerance;
    ``rings`` the radii of the tool centre's full circles; ``stepover`` None with one ring only.
    ``circles`` are the turns of the full circles in the order they are cut, ``passes`` says how
    many of them are along the wall. ``lowest`` is the least depth that any move comes to. Of the
    first move with another feed than the words ask for, ``feed`` is its feed and the one asked.
    ``overruns`` are the axes that would leave their travel.
    ``off_path`` and ``off_rings`` are the real motion's largest deviations, None without a run.
    """

    target: Target
    reached: float
    deviation: float
    left: float
    gouge: float
    stepover: float | None
    jump: float
    rings: tuple[float, ...]
    depths: tuple[float, ...]
    circles: tuple[int, ...]
    passes: int
    lowest: float
    feed: tuple[float, float] | None
    shortest: float
    longest: float
    pace: Pace
    off_path: float | None
    off_rings: float | None
    overruns: tuple[Overrun, ...] = ()

    @property
    def turns(self) -> tuple[int, ...]:
        """The turns of the full circles, each but once."""
        return tuple(sorted(set(self.circles)))


class Shape(NamedTuple):
    """What of a pocket's facts follows from its size and the tool's path about its centre."""

    reached: float
    deviation: float
    left: float
    gouge: float
    stepover: float | None


def measure_pocket(
    target: Target,
    first: int,
    last: int,
    path: Track,
    moves: Sequence[Move],
    tolerance: float,
    real: Followed | None = None,
    known: dict[tuple, Shape] | None = None,
) -> PocketFacts:
    """Return the facts of the pocket that moves ``first`` to ``last`` - 1 cut.

    ``known`` are shapes measured before, to which this one is added.
    """
    own = moves[first:last]
    lines = real_lines(target, first, own, real) if real else emitted_lines(target, own, path)
    known = {} if known is None else known
    key = key_of(lines, target, tolerance)
    shape = known[key] = known.get(key) or shape_of(lines, target, tolerance)
    circles = [move for move in own if is_full_circle(move)]
    cutting = [move for move in own if is_cutting(move, target)]
    cutters = [index for index in range(first, last) if is_cutting(moves[index], target)]
    rings = [index for index in range(first, last) if is_full_circle(moves[index])]
    pace = pace_of(range(first, last), cutters, path, real)
    lengths = [move.length for move in cutting] or [0.0]
    return PocketFacts(
        target,
        **shape._asdict(),
        jump=largest_jump(own, target),
        rings=tuple(dict.fromkeys(round(move.radius, 6) for move in circles)),
        depths=tuple(sorted(lines, reverse=True)),
        circles=tuple(int(math.copysign(1, move.turns)) for move in circles),
        passes=passes_of(circles, target),
        lowest=lowest_of(first, last, path, target),
        feed=wrong_feed(own, target),
        shortest=min(lengths),
        longest=max(lengths),
        pace=pace,
        off_path=real.largest(cutters) if real else None,
        off_rings=real.largest(rings) if real else None,
    )


def key_of(lines: Lines, target: Target, tolerance: float) -> tuple:
    """Return what is equal for pockets that have the same shape, wherever they are."""
    size = (target.radius, target.cutter, target.cleared, target.inside, tolerance)
    ways = [np.round(line, SAME_PLACE) + 0.0 for level in sorted(lines) for line in lines[level]]
    return (*size, blake2b(b"".join(way.tobytes() for way in ways)).digest())


def shape_of(lines: Lines, target: Target, tolerance: float) -> Shape:
    """Return the shape that is cut along the tool's path at each depth."""
    levels = sorted(lines, reverse=True)
    deepest = lines[levels[-1]] if levels else []
    points = np.concatenate(deepest) if deepest else np.zeros((0, 3))
    wall = wall_of(points, target)
    floor = swept(deepest, target.cutter)
    above = [line for level in levels[:-1] for line in lines[level]]
    every = floor.union(swept(above, target.cutter)) if above else floor
    reached = (wall.max() if target.inside else wall.min()) if len(points) else 0.0
    return Shape(
        reached=float(reached),
        deviation=float(np.abs(wall - target.radius).max()),
        left=left_of(target, floor, tolerance).area,
        gouge=gouge_of(target, every, tolerance).area,
        stepover=stepover_of(deepest),
    )


def passes_of(circles: Sequence[Move], target: Target) -> int:
    """Return how many full circles are next to the wall."""
    radii = [move.radius for move in circles]
    nearest = (max if target.inside else min)(radii, default=0.0)
    return sum(abs(radius - nearest) < SAME_LEVEL for radius in radii)


def lowest_of(first: int, last: int, path: Track, target: Target) -> float:
    """Return the least depth that moves ``first`` to ``last`` - 1 come to."""
    vertices = slice(*np.searchsorted(path.move, (first, last)))
    return float(target.local(path.points[vertices])[:, 2].min(initial=0.0))


def wrong_feed(moves: Sequence[Move], target: Target) -> tuple[float, float] | None:
    """Return the feed of the first move that has another one than asked, and the one asked."""
    last = max((at for at, move in enumerate(moves) if is_full_circle(move)), default=0)
    for at, move in enumerate(moves):
        finishing = target.feeds.finish is not None and abs(at - last) < 2
        wanted = target.feeds.finish if finishing else feed_of(move, target)
        moves_at_feed = move.kind != "rapid" and move.length > 0.0
        if moves_at_feed and wanted and abs(move.feed / wanted - 1) > SAME_FEED:
            return move.feed, wanted
    return None


def feed_of(move: Move, target: Target) -> float | None:
    """Return the feed that the words ask for along a move that does not finish the wall."""
    if move.kind == "arc":
        return target.feeds.arc
    return target.feeds.straight if is_cutting(move, target) else target.feeds.plunge


def is_full_circle(move: Move) -> bool:
    """Tell whether a move is a full circle."""
    return move.kind == "arc" and abs(move.sweep) > 2 * math.pi - 1e-9


def is_cutting(move: Move, target: Target) -> bool:
    """Tell whether a move feeds across the target's plane."""
    across = target.axes[:2] @ np.array(move.tangent(0.5))
    return move.kind != "rapid" and bool(np.hypot(*across) > 1e-6)


def emitted_lines(target: Target, moves: Sequence[Move], path: Track) -> Lines:
    """Return the tool's path (n, 3) across the plane at each depth, as emitted."""
    lines = {}
    for move in moves:
        if is_cutting(move, target):
            error = min(FINE, ROUND * move.radius) if move.kind == "arc" else FINE
            line = target.local(path.part.polyline(move, error))
            lines.setdefault(level_of(line), []).append(line)
    return lines


def real_lines(target: Target, first: int, moves: Sequence[Move], real: Followed) -> Lines:
    """Return the tool's path (n, 3) across the plane at each depth, as it was."""
    lines = {}
    for index, move in enumerate(moves, start=first):
        points = real.points[real.during(index)]
        if is_cutting(move, target) and len(points):
            depth = level_of(target.local(np.array(move.end)))
            lines.setdefault(depth, []).append(densified(target.local(points)))
    return lines


def densified(line: np.ndarray) -> np.ndarray:
    """Return a polyline with points so close together that every sector gets one."""
    most = np.pi / SECTORS * max(np.hypot(*line[:, :2].T).max(), SAME_LEVEL)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    places = np.union1d(along, np.linspace(0.0, along[-1], int(along[-1] / most) + 2))
    return np.stack([np.interp(places, along, axis) for axis in line.T], axis=1)


def level_of(line: np.ndarray) -> float:
    """Return the depth of a path, rounded so that equal depths are equal."""
    return round(float(line[-1, 2]) / SAME_LEVEL) * SAME_LEVEL + 0.0


def wall_of(points: np.ndarray, target: Target) -> np.ndarray:
    """Return the wall's radius in each direction: where the cutter reaches farthest.

    Where nothing was cut it is 0 (and infinite for a wall cut from outside).
    """
    far = np.zeros(SECTORS) if target.inside else np.full(SECTORS, np.inf)
    if len(points):
        gather = np.maximum if target.inside else np.minimum
        gather.at(far, *polar(points))
    return far + target.cutter if target.inside else far - target.cutter


def polar(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the sector about the centre and the distance from it of points."""
    turn = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1.0
    sector = np.minimum((turn * SECTORS).astype(int), SECTORS - 1)
    return sector, np.hypot(points[:, 0], points[:, 1])


def left_of(target: Target, floor: BaseGeometry, tolerance: float) -> BaseGeometry:
    """Return what is left standing at the deepest level, beyond the tolerance."""
    if target.inside:
        wanted = ring(target.cleared + tolerance, target.radius - tolerance)
    else:
        wanted = ring(target.radius + tolerance, target.radius + 2 * target.cutter - tolerance)
    return wanted.difference(floor)


def gouge_of(target: Target, area: BaseGeometry, tolerance: float) -> BaseGeometry:
    """Return what is cut beyond the wall and the tolerance."""
    if target.inside:
        return area.difference(disc((0, 0), target.radius + tolerance, FINE))
    return area.intersection(disc((0, 0), target.radius - tolerance, FINE))


def ring(inner: float, outer: float) -> BaseGeometry:
    """Return the area between two circles about the centre."""
    area = disc((0, 0), outer, FINE)
    return area.difference(disc((0, 0), inner, FINE)) if inner > 0.01 else area


def stepover_of(lines: Sequence[np.ndarray]) -> float | None:
    """Return the largest distance between neighbouring passes, None if there is but one.

    It is twice the distance from the middle of a gap between passes to the nearest path. Moves
    through the centre, which lead to the first ring and from the last, bound no gap.
    """
    passes = [line for line in lines if is_pass(line)]
    gaps = gaps_between(np.concatenate(passes)) if passes else ()
    ways = MultiLineString([line[:, :2] for line in lines]).simplify(COARSE, False)
    return max((2 * ways.distance(Point(gap)) for gap in gaps), default=None)


def gaps_between(points: np.ndarray) -> np.ndarray:
    """Return the middle (n, 2) of the widest gap between passes in each direction."""
    sector, radius = polar(points)
    order = np.lexsort((radius, sector))
    sector, radius = sector[order], radius[order]
    gap = np.where(np.diff(sector) == 0, np.diff(radius), 0.0)
    middles = []
    for first, last in zip(*(np.searchsorted(sector, range(k, k + SECTORS)) for k in (0, 1))):
        if last - first > 1:
            index = first + int(np.argmax(gap[first : last - 1]))
            if gap[index] > SAME_LEVEL:
                angle = (sector[index] + 0.5) / SECTORS * 2 * np.pi
                half = (radius[index] + radius[index + 1]) / 2
                middles.append((half * np.cos(angle), half * np.sin(angle)))
    return np.array(middles).reshape(-1, 2)


def is_pass(line: np.ndarray) -> bool:
    """Tell whether a path leaves the centre out."""
    radius = np.hypot(line[:, 0], line[:, 1])
    return bool(radius.min() > NEAR_CENTRE * radius.max())


def largest_jump(moves: Sequence[Move], target: Target) -> float:
    """Return the largest change of direction between cutting moves that follow each other.

    Yasnac's straight moves are its fast ones to and from the approach, whatever their feed.
    """
    moves = [move for move in moves if target.dialect != "yasnac" or move.kind != "feed"]
    jumps = [
        angle_between(before.tangent(1.0), after.tangent(0.0))
        for before, after in zip(moves, moves[1:])
        if is_cutting(before, target) and is_cutting(after, target)
    ]
    return max(jumps, default=0.0)


def angle_between(one: Sequence[float], other: Sequence[float]) -> float:
    """Return the angle between two directions, degrees."""
    across = np.linalg.norm(np.cross(one, other))
    return math.degrees(math.atan2(across, np.dot(one, other)))
