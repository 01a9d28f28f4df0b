# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of a program as one dense polyline in time.

Lengths are millimetres, angles of rotary axes degrees, times seconds.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from g12.machine_ini import AXIS_LETTERS
from g12.tools.machine.ini import Ini
from g12.tools.path.part import Part
from g12.tools.preview.moves import IS_LENGTH, Move, Trace

UNLIMITED = math.inf
CART_FUZZ = 1e-8  # mm or degrees: LinuxCNC ignores shorter moves (CART_FUZZ)
DWELL_EVENT = "dwell "  # prefix of an event; the seconds follow it


@dataclass(frozen=True)
class Limits:
    """Greatest speeds: per axis (mm/s or degrees/s, in the order of AXES) and along the path."""

    axes: tuple[float, ...]
    path: float


@dataclass(frozen=True)
class Track:
    """Moves as one polyline in time; it is made when it is first used.

    Every move is at its feed, as far as the axes' speeds allow. ``spindle_speed`` (rev/min) is for
    moves in G95.
    """

    part: Part
    moves: Sequence[Move]
    limits: Limits
    spindle_speed: float = 0.0

    def seconds(self, index: int) -> float:
        """Return the time of a move."""
        return duration(self.moves[index], self.limits, self.spindle_speed)

    @cached_property
    def _vertices(self) -> tuple[np.ndarray, np.ndarray]:
        lines = [self.part.machine_points(move) for move in self.moves]
        lines[1:] = [line[1:] for line in lines[1:]]
        if not lines:
            return np.zeros((1, len(AXIS_LETTERS))), np.zeros(1, int)
        counts = [len(line) for line in lines]
        return np.concatenate(lines), np.repeat(np.arange(len(lines)), counts)

    @property
    def positions(self) -> np.ndarray:
        """Machine positions (n, 9) of the controlled point."""
        return self._vertices[0]

    @property
    def move(self) -> np.ndarray:
        """The index of the move that ends at or passes each vertex."""
        return self._vertices[1]

    def _along(self, at_ends: Sequence[float]) -> np.ndarray:
        """Return a value at each vertex, from those at the start and at the end of each move."""
        ends = np.searchsorted(self.move, range(len(self.moves)), side="right") - 1
        return np.interp(np.arange(len(self.move)), [0, *ends], at_ends)

    @cached_property
    def time(self) -> np.ndarray:
        """The seconds since the start."""
        return self._along(np.cumsum([0.0, *map(self.seconds, range(len(self.moves)))]))

    @cached_property
    def offsets(self) -> np.ndarray:
        """The tool length offsets (n, 9) in force, which change along a move with G43."""
        at_ends = (0.0,) * len(AXIS_LETTERS), *(move.tool_offset for move in self.moves)
        return np.stack([self._along(values) for values in zip(*at_ends)], axis=1)

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
