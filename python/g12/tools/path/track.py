# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of a program as one dense polyline in time.

Lengths are millimetres, angles of rotary axes degrees, times seconds.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini
from g12.tools.path.part import CHORD_ERROR, Part
from g12.tools.preview.moves import IS_LENGTH, Move, Trace

UNLIMITED = math.inf
CART_FUZZ = 1e-8  # mm or degrees: LinuxCNC ignores shorter moves (CART_FUZZ)
DWELL_EVENT = "dwell "  # prefix of an event; the seconds follow it


@dataclass(frozen=True)
class Limits:
    """Greatest speeds: per axis (mm/s or degrees/s, in the order of AXES) and along the path."""

    axes: tuple[float, ...]
    path: float


class Vertices(NamedTuple):
    """A polyline: per vertex the machine position, the tool length offset, the move, the time.

    ``positions`` (n, 9) are those of the controlled point, ``offsets`` (n, 9) the tool length
    offset in force, ``move`` (n,) the index of the move that ends at or passes the vertex,
    ``time`` (n,) the seconds since the start.
    """

    positions: np.ndarray
    offsets: np.ndarray
    move: np.ndarray
    time: np.ndarray


@dataclass(frozen=True)
class Track:
    """Moves as one polyline in time, computed when its vertices are first used; see ``track``.

    ``seconds`` returns the time of a move by its index, with every move at its feed, as far as the
    axes' speeds allow.
    """

    part: Part
    moves: Sequence[Move]
    draw: Callable[[], Vertices]
    seconds: Callable[[int], float]

    @cached_property
    def _vertices(self) -> Vertices:
        return self.draw()

    @property
    def positions(self) -> np.ndarray:
        return self._vertices.positions

    @property
    def offsets(self) -> np.ndarray:
        return self._vertices.offsets

    @property
    def move(self) -> np.ndarray:
        return self._vertices.move

    @property
    def time(self) -> np.ndarray:
        return self._vertices.time

    @cached_property
    def points(self) -> np.ndarray:
        """Part points (n, 3)."""
        return self.part.points(self.positions)

    @cached_property
    def axis_points(self) -> np.ndarray:
        """Part points (n, 3) of the axes' positions, tool length offset included."""
        return self.part.points(self.positions + self.offsets)

    def vertices(self, index: int) -> slice:
        """Return the vertices of a move, its start included."""
        first, last = np.searchsorted(self.move, (index, index + 1))
        return slice(max(0, first - (1 if index else 0)), last)

    def end(self, index: int) -> tuple[float, ...]:
        return tuple(self.part.points(np.array(self.moves[index].end))[0])

    def part_length(self, index: int) -> float:
        """Return the length along the part of a move, mm."""
        if not self.part.turning:
            return self.moves[index].length
        return float(self._part_lengths[index]) if index < len(self._part_lengths) else 0.0

    @cached_property
    def _part_lengths(self) -> np.ndarray:
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return np.bincount(self.move[1:], weights=steps)

    def part_feed(self, index: int) -> float:
        """Return the speed along the part of a move, mm/min."""
        seconds = self.seconds(index)
        return self.part_length(index) / seconds * 60.0 if seconds else 0.0


def limits_of(ini: Ini) -> Limits:
    known, scale = ini.axis_limits, [ini.mm if linear else 1.0 for linear in IS_LENGTH]
    axes = [known[axis].velocity if axis in known else UNLIMITED for axis in AXIS_LETTERS]
    path = ini.number("TRAJ", "MAX_LINEAR_VELOCITY", UNLIMITED) * ini.mm
    return Limits(tuple(map(float.__mul__, axes, scale)), path)


def program_seconds(trace: Trace, ini: Ini, override: float = 100.0) -> float:
    """Return a program's estimated time, with its dwells, at a feed override in per cent."""
    limits, share = limits_of(ini), override / 100.0
    moves = (move._replace(feed=move.feed * share) for move in trace.moves)
    dwells = (event.text for event in trace.events if event.text.startswith(DWELL_EVENT))
    waiting = sum(float(text.removeprefix(DWELL_EVENT)) for text in dwells)
    return waiting + sum(duration(move, limits, trace.modes.speed) for move in moves)


def duration(move: Move, limits: Limits, spindle_speed: float = 0.0) -> float:
    """Return the seconds a move takes at its feed, axis speeds permitting, without acceleration.

    ``spindle_speed`` in revolutions per minute is for moves in G95.
    """
    changes = [abs(end - start) for start, end in zip(move.start, move.end)]
    if move.kind == "arc":
        return move.length / min(rate(move, spindle_speed) or limits.path, limits.path)
    needed = max(change / limit for change, limit in zip(changes, limits.axes))
    needed = max(needed, move.length / limits.path)
    feed = rate(move, spindle_speed)
    return max(needed, feed_length(move) / feed) if feed else needed


def rate(move: Move, spindle_speed: float) -> float:
    """Return the programmed speed of a move in mm/s or degrees/s; 0 is unlimited."""
    per_minute = move.feed * spindle_speed if move.feed_mode == "G95" else move.feed
    return per_minute / 60.0


def feed_length(move: Move) -> float:
    """Return the length to which a move's feed refers: of X Y Z, else of U V W, else degrees."""
    change = np.subtract(move.end, move.start)
    lengths = (math.hypot(*change[:3]), math.hypot(*change[6:]), math.hypot(*change[3:6]))
    return next((length for length in lengths if length >= CART_FUZZ), 0.0)


def track(
    part: Part,
    moves: Sequence[Move],
    limits: Limits,
    spindle_speed: float = 0.0,
    chord_error: float = CHORD_ERROR,
    *,
    own: range | None = None,
) -> Track:
    """Return the polyline of moves, only of those in ``own`` if given."""
    own = range(len(moves)) if own is None else own

    def seconds(index: int) -> float:
        return duration(moves[index], limits, spindle_speed)

    drawn = partial(vertices_of, part, moves, own, seconds, chord_error)
    return Track(part, moves, drawn, seconds)


def vertices_of(
    part: Part,
    moves: Sequence[Move],
    own: range,
    seconds: Callable[[int], float],
    chord_error: float,
) -> Vertices:
    positions, offsets, owner, times = [], [], [], [np.zeros(1)]
    before = moves[own.start - 1].tool_offset if own.start else (0.0,) * 9
    for index in own:
        move = moves[index]
        points = part.machine_points(move, chord_error)
        skip = 1 if index > own.start else 0
        share = np.linspace(0.0, 1.0, len(points))
        positions.append(points[skip:])
        offsets.append(offsets_between(before, move.tool_offset, share)[skip:])
        owner.append(len(points) - skip)
        times.append(times[-1][-1] + seconds(index) * share[1:])
        before = move.tool_offset
    return Vertices(
        np.concatenate(positions or [np.zeros((1, 9))]),
        np.concatenate(offsets or [np.zeros((1, 9))]),
        np.repeat(own, owner) if owner else np.zeros(1, int),
        np.concatenate(times),
    )


def offsets_between(
    before: Sequence[float], after: Sequence[float], share: np.ndarray
) -> np.ndarray:
    """Return tool length offsets (n, 9) at shares of a move on which they change."""
    if before == after:
        return np.broadcast_to(after, (len(share), len(after)))
    return np.multiply.outer(1 - share, before) + np.multiply.outer(share, after)
