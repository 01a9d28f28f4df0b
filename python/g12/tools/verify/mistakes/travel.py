# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a pocket fits into the machine's travel: the axes' own positions against their limits.

LinuxCNC itself adds the work offsets, those that the program sets and those of the machine's var
file. Where there are none, a pocket is not known to be where it is traced, but how wide it is.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from g12.tools.machine.ini import Ini
from g12.tools.path.part import axes_of_plane
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.expected.words import BlockInMm
from g12.tools.verify.reading.circles import Target
from g12.tools.verify.result.finding import WHOLE_PROGRAM, Finding

LETTERS = "XYZ"
BEYOND = 1e-3  # mm
SAME_ZERO = 1e-6  # mm
DECIMALS = 4  # of a program's zero
WORK_OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59")


class BlockExtent(NamedTuple):
    """How far a block reaches: its zero, and the least and greatest positions (3,) of the axes."""

    zero: tuple[float, ...]
    low: np.ndarray
    high: np.ndarray

    @property
    def is_placed(self) -> bool:
        """Whether a work offset is set: without one its zero is that of the machine."""
        return max(map(abs, self.zero)) > SAME_ZERO


def judge_travel(
    circles: Sequence[tuple[Block, Target]],
    moves: Sequence[Move] | None,
    events: Sequence[Event],
    ini: Ini,
) -> Iterator[Finding]:
    """Yield the pockets that leave the travel; ``moves`` are those on the machine, if known."""
    if moves is None:
        for _, target in circles:
            yield Finding("travel-unknown", target.line, file=target.file)
        return
    extents = [_extent_of(block, moves) for block, _ in circles]
    offsets = {event.text for event in events if event.text.startswith(WORK_OFFSETS)}
    ends: dict[tuple[float, ...], list[np.ndarray]] = {}
    for extent in extents:
        ends.setdefault(extent.zero, []).extend((extent.low, extent.high))
    widths = {zero: np.ptp(both, axis=0) for zero, both in ends.items()}
    unplaced = False
    for (_, target), extent in zip(circles, extents):
        # Blocks of one zero lie beside each other; those of other work offsets may be anywhere.
        width = widths[extent.zero] if len(offsets) < 2 else extent.high - extent.low
        overruns = list(_overruns(extent, width, ini))
        unplaced = unplaced or not (extent.is_placed or "travel" in dict(overruns))
        for code, values in overruns:
            place = target.wall.machine((0j, target.deepest))
            yield Finding(code, target.line, values, place, target.file)
    if unplaced:
        yield Finding("travel-unplaced", WHOLE_PROGRAM)


def _overruns(extent: BlockExtent, width: np.ndarray, ini: Ini) -> Iterator[tuple[str, dict]]:
    """Yield where a block leaves the travel: the finding's code and values.

    ``width`` is how wide all blocks of its zero are.
    """
    limits = ini.axis_limits
    for axis, letter in enumerate(LETTERS):
        if letter not in limits:
            continue
        least, most = limits[letter].low * ini.mm, limits[letter].high * ini.mm
        certain = extent.is_placed or width[axis] > most - least
        low, high = float(extent.low[axis]), float(extent.high[axis])
        position, limit = (high, most) if high > most + BEYOND else (low, least)
        fits = least - BEYOND <= position <= most + BEYOND
        if not fits and (certain or letter != "Z"):  # hardly ever true of Z, with any tool length
            values = {"axis": letter, "position": position, "limit": limit}
            yield "travel" if certain else "travel-perhaps", values


def _extent_of(block: Block, moves: Sequence[Move]) -> BlockExtent:
    """Return how far a block reaches, of moves with the machine's work offsets.

    An arc counts as its circle, which no cycle leaves by its full circles.
    """
    own = moves[block.at : block.end]
    ends = np.array([place[:3] for move in own for place in (move.start, move.end)])
    offsets = np.array([move.tool_offset[:3] for move in own])
    points = [ends + np.repeat(offsets, 2, axis=0)]
    arcs = [(move, offset) for move, offset in zip(own, offsets) if move.kind == "arc"]
    if arcs:
        centres = np.array([move.centre for move, _ in arcs]) + [offset for _, offset in arcs]
        spread = np.array([move.radius * _spread(move.plane, move.rotation) for move, _ in arcs])
        points += [centres - spread, centres + spread]
    every = np.concatenate(points)
    zero = tuple(map(float, np.round(BlockInMm(block, moves[block.at]).zero(), DECIMALS) + 0.0))
    return BlockExtent(zero, every.min(axis=0), every.max(axis=0))


@lru_cache(maxsize=64)
def _spread(plane: int, rotation: float) -> np.ndarray:
    """Return how far a circle of radius 1 reaches along X, Y and Z."""
    return np.hypot(*axes_of_plane(plane, rotation)[:2])
