# SPDX-License-Identifier: GPL-2.0-or-later
"""The actual motion of a run, mapped onto the programmed path.

Lengths are millimetres, angles of rotary axes degrees, times seconds.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.path.nearest import on_segments, shares_along
from g12.tools.path.part import Y, plane_axes
from g12.tools.path.samples import Samples
from g12.tools.path.track import Track
from g12.tools.preview.moves import IS_LENGTH, Move

LOOK_AHEAD = 0.25  # mm: a run may be this far ahead on the path, where it cuts a corner
SAME_RADIUS = 1e-6  # mm


@dataclass(frozen=True)
class Followed:
    """Samples of a run mapped onto the programmed path, arrays of one entry per sample.

    ``positions`` (n, 9) are those of the controlled point, ``points`` (n, 3) the part's;
    ``move`` is the index of the move in motion, ``nearest`` (n, 3) the programmed point next
    to the sample and ``deviation`` the distance to it, ``time`` in seconds.
    """

    time: np.ndarray
    positions: np.ndarray
    points: np.ndarray
    move: np.ndarray
    nearest: np.ndarray
    deviation: np.ndarray

    def during(self, move: int) -> slice:
        """Return the samples of a move, and the one before, so that the lines of two moves join."""
        first, last = np.searchsorted(self.move, (move, move + 1))
        return slice(max(0, first - 1) if last > first else first, last)


class Worst(NamedTuple):
    """The largest deviation of a run from the moves at feed, mm."""

    sample: int
    deviation: float
    point: np.ndarray
    nearest: np.ndarray
    move: Move


def worst_of(real: Followed, moves: Sequence[Move]) -> Worst | None:
    """Return the largest deviation of a run from its moves at feed; None without such motion."""
    at_feed = np.array([move.kind != "rapid" for move in moves], bool)[real.move]
    if not at_feed.any():
        return None
    index = int(np.argmax(np.where(at_feed, real.deviation, -1.0)))
    return Worst(
        index,
        float(real.deviation[index]),
        real.points[index],
        real.nearest[index],
        moves[real.move[index]],
    )


def follow(path: Track, samples: Samples, unit: float) -> Followed:
    """Map the samples in motion onto a path; ``unit`` is one machine unit in mm.

    In a blended corner the tool has left the move of the line that LinuxCNC names. The distance is
    the one to that move or to its neighbours, whichever is nearest.
    """
    samples = samples.only(samples.moving())
    axes = _positions(samples, unit)
    axes[:, Y] += path.part.beside  # the tool is beside the joints' position
    axis_points = path.part.points(axes)
    segment, adjacent = (
        _segments(path.axis_points, axis_points, window)
        for window in windows_of(path, samples.line)
    )
    following = np.minimum(segment + 1, len(path.move) - 1)
    positions = axes - _offsets(path, axis_points, segment, following)
    points = path.part.points(positions)
    near = np.stack([_nearest(path, points, each) for each in (segment, adjacent)])
    away = np.linalg.norm(points - near, axis=2)
    best = away.argmin(axis=0), np.arange(len(points))
    return Followed(samples.time, positions, points, path.move[following], near[best], away[best])


def _positions(samples: Samples, unit: float) -> np.ndarray:
    """Return axis positions (n, 9) of samples, mm and degrees."""
    positions = np.zeros((len(samples.time), len(AXIS_LETTERS)))
    for letter, values in samples.axes.items():
        index = AXIS_LETTERS.index(letter)
        positions[:, index] = values * (unit if IS_LENGTH[index] else 1.0)
    return positions


def _offsets(path: Track, points: np.ndarray, segment: np.ndarray, following: np.ndarray):
    """Return the tool length offsets (n, 9) at axis points: they change along a move with G43."""
    start = path.axis_points[segment]
    share = shares_along(points, start, path.axis_points[following] - start)[:, None]
    return path.offsets[segment] * (1 - share) + path.offsets[following] * share


def windows_of(path: Track, lines: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the first and the last possible segment (n, 2) of the path for each sample of a run.

    First among the moves of the line in motion that LinuxCNC names, then with the moves before and
    after, for corners. Where those lines do not come in the order of the moves, a window is the
    whole path.
    """
    moves = path.moves
    going = [i for i, move in enumerate(moves) if move.start != move.end or move.kind == "arc"]
    groups = [list(group) for _, group in groupby(going, key=lambda index: moves[index].line)]
    at = np.concatenate([[0], np.cumsum(np.diff(lines) != 0)])[: len(lines)]
    named = lines[np.unique(at, return_index=True)[1]]
    if [moves[group[0]].line for group in groups] != named.tolist():
        everywhere = np.tile([0, max(0, len(path.move) - 2)], (len(lines), 1))
        return everywhere, everywhere
    first = np.array([path.vertices(group[0]).start for group in groups], int)
    last = np.array([max(0, path.vertices(group[-1]).stop - 2) for group in groups], int)
    earlier, later = np.append(first[:1], first[:-1]), np.append(last[1:], last[-1:])
    return np.stack([first, last], axis=1)[at], np.stack([earlier, later], axis=1)[at]


def _segments(path: np.ndarray, points: np.ndarray, within: np.ndarray) -> np.ndarray:
    """Return the index of each point's segment of the path, in ascending order.

    The search for the nearest point goes only as far ahead as the tool can have moved, and never
    back: a path may cross, repeat or retrace itself, but the tool cannot jump along it.
    """
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])
    found = np.zeros(len(points), int)
    first, here = 0, path[0]
    for index, (point, (least, most)) in enumerate(zip(points, within)):
        if first < least:
            first, here = least, path[least]
        reached = along[first] + math.dist(here, path[first])
        ahead = int(np.searchsorted(along, reached + 2 * math.dist(point, here) + LOOK_AHEAD))
        starts = path[first : min(max(ahead, first + 1), most + 1)].copy()
        ends = path[first + 1 : first + 1 + len(starts)]
        if len(ends):
            starts[0] = here
            starts = starts[: len(ends)]
            near = on_segments(point, starts, ends - starts)
            best = int(np.argmin(np.linalg.norm(point - near, axis=1)))
            first, here = first + best, near[best]
        found[index] = first
    return found


def _nearest(path: Track, points: np.ndarray, segment: np.ndarray) -> np.ndarray:
    """Return the nearest programmed point to each point, close to its segment."""
    last = len(path.points) - 1
    near, away = points.copy(), np.full(len(points), np.inf)
    move = np.zeros(len(points), int)
    for shift in (-2, -1, 0, 1, 2):
        index = np.clip(segment + shift, 0, max(0, last - 1))
        following = np.minimum(index + 1, last)
        found = on_segments(points, path.points[index], path.points[following] - path.points[index])
        distance = np.linalg.norm(points - found, axis=1)
        better = distance < away
        near[better], away[better] = found[better], distance[better]
        move[better] = path.move[following[better]]
    if not path.part.turning:
        for own in np.split(np.arange(len(move)), np.flatnonzero(np.diff(move)) + 1):
            near[own] = _on_arc(path.moves[move[own[0]]], near[own])
    return near


def _on_arc(move: Move, points: np.ndarray) -> np.ndarray:
    """Return points of a move's chords, of an arc with one radius moved outwards onto the arc."""
    if move.kind != "arc":
        return points
    axes = plane_axes(move)
    local, end = ((at - move.centre) @ axes.T for at in (points, np.array(move.end[:3])))
    if abs(math.hypot(*end[:2]) - move.radius) > SAME_RADIUS:
        return points
    local[:, :2] *= (move.radius / np.hypot(local[:, 0], local[:, 1]))[:, None]
    return local @ axes + move.centre
