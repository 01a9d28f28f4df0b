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
from shapely.geometry.base import BaseGeometry

from g12.tools.path.follow import Followed
from g12.tools.path.part import disc, swept
from g12.tools.path.slowest import Pace, pace_of
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.pocket_cover import (
    FINE,
    SECTORS,
    Segments,
    Span,
    clears,
    farthest_of,
    nearest_of,
    polar,
)
from g12.tools.verify.pocket_entry import (
    HelixFacts,
    falls,
    helices_of,
    helix_facts,
    is_full_circle,
)
from g12.tools.verify.pocket_order import LeftBehind, Misplaced, growth_of, misplaced
from g12.tools.verify.wanted_circle import Target, Wall

SAME_LEVEL = 1e-3
ROUND = 4e-6  # the same of an arc with radius 1, so that every sector gets a point
COARSE = 1e-4  # to which the distance between passes is told
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
    ``overruns`` are the axes that would leave their travel, None if that is not known.
    ``off_path`` and ``off_rings`` are the real motion's largest deviations, None without a run.
    ``cut`` is the depth and the radius of every full circle in its order, ``other_mode`` says
    that a move has its feed per minute in place of per revolution, or the other way round;
    ``jump`` is the greatest change of direction, at the place ``jump_at`` on the machine,
    ``growth`` is that of a spiral in a turn, ``helix`` None where the tool goes straight down.
    ``acts`` are what the cycle does besides moving.
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
    cut: tuple[tuple[float, float], ...]
    other_mode: bool
    growth: float
    misplaced: tuple[Misplaced, ...]
    helix: HelixFacts | None = None
    overruns: tuple[Overrun, ...] | None = ()
    left_behind: tuple[LeftBehind, ...] = ()
    acts: tuple[str, ...] = ()
    jump_at: tuple[float, ...] | None = None

    @property
    def turns(self) -> tuple[int, ...]:
        """The turns of the full circles, each but once."""
        return tuple(sorted(set(self.circles)))


class PocketAreas(NamedTuple):
    """What of a pocket's facts follows from its size and the tool's path about its centre."""

    reached: float
    deviation: float
    left: float
    gouge: float
    stepover: float | None


def measure_pocket(
    target: Target,
    own: range,
    path: Track,
    moves: Sequence[Move],
    tolerance: float,
    real: Followed | None = None,
    known: dict[tuple, PocketAreas] | None = None,
) -> PocketFacts:
    """Return the facts of the pocket that some moves, given by their indices, cut.

    ``known`` are areas measured before, to which those of this pocket are added.
    """
    wall = target.wall
    entries = helices_of(own, moves, wall)
    down = {index for entry in entries for index in (entry.lead, *entry.falling)}
    across = [index for index in own if is_cutting(moves[index], wall)]
    cutting = [index for index in across if index not in down]
    lines, falling = (
        real_lines(wall, some, moves, real) if real else emitted_lines(wall, some, moves, path)
        for some in (cutting, [index for index in across if index in down])
    )
    areas = areas_once(lines, falling, target, tolerance, {} if known is None else known)
    circles = [index for index in own if is_full_circle(moves[index])]
    lengths = [moves[index].length for index in cutting] or [0.0]
    return PocketFacts(
        target,
        **areas._asdict(),
        **direction_jump([moves[index] for index in own], target)._asdict(),
        helix=helix_facts(entries, moves, wall),
        depths=tuple(sorted(lines, reverse=True)),
        lowest=lowest_of(own, path, wall),
        feed=wrong_feed([moves[index] for index in own], target),
        shortest=min(lengths),
        longest=max(lengths),
        pace=pace_of(own, cutting, path, real),
        off_path=real.largest(cutting) if real else None,
        off_rings=real.largest(circles) if real else None,
        other_mode=any(has_other_mode(moves[index], target) for index in own),
        **circle_facts(target, own, circles, moves, tolerance),
    )


def circle_facts(
    target: Target, own: range, circles: list[int], moves: Sequence[Move], tolerance: float
) -> dict[str, object]:
    """Return those members of ``PocketFacts`` that are about its full circles."""
    around = target, moves[own.start : own.stop], [index - own.start for index in circles]
    cut = [moves[index] for index in circles]
    return {
        "rings": tuple(dict.fromkeys(round(move.radius, 6) for move in cut)),
        "circles": tuple(int(math.copysign(1, move.turns)) for move in cut),
        "passes": passes_of(cut, target.wall),
        "cut": tuple((depth_of(move, target.wall), move.radius) for move in cut),
        "growth": growth_of(*around) if target.schedule.pitch else 0.0,
        "misplaced": misplaced(*around, tolerance),
    }


def areas_once(
    lines: Lines, falling: Lines, target: Target, tolerance: float, known: dict[tuple, PocketAreas]
) -> PocketAreas:
    """Return the areas of a pocket, which is measured unless ``known`` has one like it."""
    key = key_of(lines, target, tolerance) + key_of(falling, target, tolerance)
    if key not in known:
        known[key] = areas_of(lines, target.wall, target.cutter.radius, tolerance, falling)
    return known[key]


def key_of(lines: Lines, target: Target, tolerance: float) -> tuple:
    """Return what is equal for pockets that have the same areas, wherever they are."""
    wall = target.wall
    size = (wall.radius, target.cutter.radius, wall.cleared, wall.inside, tolerance)
    every = [np.round(line, SAME_PLACE) + 0.0 for level in sorted(lines) for line in lines[level]]
    return (*size, blake2b(b"".join(line.tobytes() for line in every)).digest())


def areas_of(
    lines: Lines, wall: Wall, cutter: float, tolerance: float, falling: Lines
) -> PocketAreas:
    """Return what a cutter of a radius makes of a wall along the tool's path at each depth.

    ``falling`` is its path on the way down.
    """
    levels = sorted(lines, reverse=True)
    deepest = lines[levels[-1]] if levels else []
    points = np.concatenate(deepest) if deepest else np.zeros((0, 3))
    radii = radii_of(points, wall, cutter)
    every = [line for some in (lines, falling) for level in some for line in some[level]]
    reached = (radii.max() if wall.inside else radii.min()) if len(points) else 0.0
    return PocketAreas(
        reached=float(reached),
        deviation=float(np.abs(radii - wall.radius).max()),
        left=area_left(wall, cutter, deepest, tolerance),
        gouge=area_gouged(wall, cutter, every, tolerance),
        stepover=stepover_of(deepest),
    )


def passes_of(circles: Sequence[Move], wall: Wall) -> int:
    """Return how many full circles are next to the wall."""
    radii = [move.radius for move in circles]
    nearest = (max if wall.inside else min)(radii, default=0.0)
    return sum(abs(radius - nearest) < SAME_LEVEL for radius in radii)


def lowest_of(own: range, path: Track, wall: Wall) -> float:
    """Return the least depth that some moves come to."""
    vertices = slice(*np.searchsorted(path.move, (own.start, own.stop)))
    return float(wall.local(path.points[vertices])[:, 2].min(initial=0.0))


def wrong_feed(moves: Sequence[Move], target: Target) -> tuple[float, float] | None:
    """Return the feed of the first move that has another one than asked, and the one asked."""
    last = max((at for at, move in enumerate(moves) if is_full_circle(move)), default=0)
    feeds = target.schedule.feeds
    for at, move in enumerate(moves):
        finishing = feeds.finish is not None and abs(at - last) < 2
        wanted = feeds.finish if finishing else feed_of(move, target)
        moves_at_feed = move.kind != "rapid" and move.length > 0.0
        if moves_at_feed and wanted and abs(move.feed / wanted - 1) > SAME_FEED:
            return move.feed, wanted
    return None


def feed_of(move: Move, target: Target) -> float | None:
    """Return the feed that the words ask for along a move that does not finish the wall."""
    feeds = target.schedule.feeds
    if move.kind == "arc":
        return feeds.plunge if falls(move, target.wall) else feeds.arc
    return feeds.straight if is_cutting(move, target.wall) else feeds.plunge


def depth_of(move: Move, wall: Wall) -> float:
    """Return the depth that a move begins at."""
    return float(wall.local(np.array(move.start))[0, 2])


def has_other_mode(move: Move, target: Target) -> bool:
    """Tell whether a move's feed is per revolution where it should be per minute, or else."""
    if move.kind == "rapid" or not move.length:
        return False
    traverse = target.source.dialect == "yasnac" and move.kind == "feed"
    return (move.feed_mode == "G95") != (target.schedule.rev and not traverse)


def is_cutting(move: Move, wall: Wall) -> bool:
    """Tell whether a move feeds across the wall's plane, which an arc does anyway."""
    if move.kind == "arc":
        return True
    across = wall.axes[:2] @ np.array(move.tangent(0.5))
    return move.kind != "rapid" and bool(np.hypot(*across) > 1e-6)


def emitted_lines(wall: Wall, cutting: Sequence[int], moves: Sequence[Move], path: Track) -> Lines:
    """Return the tool's path (n, 3) across the plane at each depth, as emitted."""
    lines: Lines = {}
    for move in (moves[index] for index in cutting):
        error = min(FINE, ROUND * move.radius) if move.kind == "arc" else FINE
        line = wall.local(path.part.polyline(move, error))
        lines.setdefault(level_of(line), []).append(line)
    return lines


def real_lines(wall: Wall, cutting: Sequence[int], moves: Sequence[Move], real: Followed) -> Lines:
    """Return the tool's path (n, 3) across the plane at each depth, as it was."""
    lines: Lines = {}
    for index in cutting:
        points = real.points[real.during(index)]
        if len(points):
            depth = level_of(wall.local(np.array(moves[index].end)))
            lines.setdefault(depth, []).append(densified(wall.local(points)))
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


def radii_of(points: np.ndarray, wall: Wall, cutter: float) -> np.ndarray:
    """Return the wall's radius in each direction: where the cutter reaches farthest.

    Where nothing was cut it is 0 (and infinite for a wall cut from outside).
    """
    far = np.zeros(SECTORS) if wall.inside else np.full(SECTORS, np.inf)
    if len(points):
        gather = np.maximum if wall.inside else np.minimum
        sector, radius = polar(points)
        order = np.argsort(sector.astype(np.int16), kind="stable")
        sector, first = np.unique(sector[order], return_index=True)
        far[sector] = gather.reduceat(radius[order], first)
    return far + cutter if wall.inside else far - cutter


def area_left(wall: Wall, cutter: float, lines: Sequence[np.ndarray], tolerance: float) -> float:
    """Return the area of what paths leave standing; see ``left_of``."""
    if clears(lines, cutter, wanted_of(wall, cutter, tolerance)):
        return 0.0
    return left_of(wall, cutter, swept(lines, cutter), tolerance).area


def area_gouged(wall: Wall, cutter: float, lines: Sequence[np.ndarray], tolerance: float) -> float:
    """Return the area of what paths cut beyond a wall; see ``gouge_of``."""
    if wall.inside:
        spared = farthest_of(lines) + cutter <= wall.radius + tolerance
    else:
        spared = nearest_of(lines) - cutter >= wall.radius - tolerance
    return 0.0 if spared else gouge_of(wall, swept(lines, cutter), tolerance).area


def wanted_of(wall: Wall, cutter: float, tolerance: float) -> Span:
    """Return between which distances from the centre nothing may be left."""
    if wall.inside:
        return wall.cleared + tolerance, wall.radius - tolerance
    return wall.radius + tolerance, wall.radius + 2 * cutter - tolerance


def left_of(wall: Wall, cutter: float, floor: BaseGeometry, tolerance: float) -> BaseGeometry:
    """Return what is left standing at the deepest level, beyond the tolerance."""
    return ring(*wanted_of(wall, cutter, tolerance)).difference(floor)


def gouge_of(wall: Wall, area: BaseGeometry, tolerance: float) -> BaseGeometry:
    """Return what is cut beyond the wall and the tolerance."""
    if wall.inside:
        return area.difference(disc((0, 0), wall.radius + tolerance, FINE))
    return area.intersection(disc((0, 0), wall.radius - tolerance, FINE))


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
    if not passes:
        return None
    most, paths = None, Segments(lines)
    widths, middles = gaps_between(np.concatenate(passes))
    for index in np.argsort(widths)[::-1]:
        if most is not None and widths[index] <= most + COARSE:
            break  # a gap is nowhere wider than straight outward
        most = max(most or 0.0, 2 * paths.distance(middles[index]))
    return most


def gaps_between(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the width of the widest gap between passes in each direction, and its middle (n, 2).

    Directions without a gap are left out.
    """
    sector, radius = polar(points)
    order = np.argsort(sector + radius / (2 * radius.max()))
    sector, radius = sector[order], radius[order]
    gap = np.where(np.diff(sector) == 0, np.diff(radius), 0.0)
    sectors, first = np.unique(sector[:-1], return_index=True)
    most = np.zeros(SECTORS)
    most[sectors] = np.maximum.reduceat(gap, first)
    widest = np.flatnonzero((gap >= most[sector[:-1]]) & (gap > SAME_LEVEL))
    middle = (radius[widest] + radius[widest + 1]) / 2
    angle = (sector[widest] + 0.5) / SECTORS * 2 * np.pi
    return gap[widest], np.stack([middle * np.cos(angle), middle * np.sin(angle)], axis=1)


def is_pass(line: np.ndarray) -> bool:
    """Tell whether a path leaves the centre out."""
    radius = np.hypot(line[:, 0], line[:, 1])
    return bool(radius.min() > NEAR_CENTRE * radius.max())


class DirectionJump(NamedTuple):
    """A change of direction in degrees, and where it is: members of ``PocketFacts``."""

    jump: float = 0.0
    jump_at: tuple[float, ...] | None = None


def direction_jump(moves: Sequence[Move], target: Target) -> DirectionJump:
    """Return the largest change of direction between cutting moves that follow each other.

    Yasnac's straight moves are its fast ones to and from the approach, whatever their feed. Where
    a helix begins the tool comes from the flat.
    """
    moves = [move for move in moves if target.source.dialect != "yasnac" or move.kind != "feed"]
    cutting = [is_cutting(move, target.wall) for move in moves]
    falling = [falls(move, target.wall) for move in moves]
    jumps = [
        DirectionJump(
            angle_between(moves[at].tangent(1.0), moves[at + 1].tangent(0.0)), moves[at].end[:3]
        )
        for at in range(len(moves) - 1)
        if cutting[at] and cutting[at + 1] and (falling[at] or not falling[at + 1])
    ]
    return max(jumps, default=DirectionJump())


def angle_between(one: Sequence[float], other: Sequence[float]) -> float:
    """Return the angle between two directions, degrees."""
    across = np.linalg.norm(np.cross(one, other))
    return math.degrees(math.atan2(across, np.dot(one, other)))
