# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a pocket fits into the machine's travel: the axes' own positions against their limits.

LinuxCNC itself adds the work offsets, those that the program sets and those of the machine's var
file. Where there are none, a pocket is not known to be where it is traced, but how wide it is.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from g12.tools.machine.ini import Ini
from g12.tools.path.part import axes_of_plane
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.reading.block_words import BlockInMm

LETTERS = "XYZ"
BEYOND = 1e-3  # mm
SAME_ZERO = 1e-6  # mm
DECIMALS = 4  # of a program's zero
WORK_OFFSET = re.compile(r"G5[4-9](\.[1-3])?")

Zero = tuple[float, ...]


class Overrun(NamedTuple):
    """An axis that would go to a position (mm) beyond its limit.

    ``certain`` is False where another work offset may be meant.
    """

    letter: str
    position: float
    limit: float
    certain: bool


def travel_of(ini: Ini) -> dict[str, tuple[float, float]]:
    """Return the ends of travel of those axes X, Y and Z that a machine has, mm."""
    limits = ini.axis_limits
    return {
        letter: (limits[letter].low * ini.mm, limits[letter].high * ini.mm)
        for letter in LETTERS
        if letter in limits
    }


class BlockExtent(NamedTuple):
    """How far a block reaches: its zero, and the least and greatest positions (3,) of the axes."""

    zero: Zero
    low: np.ndarray
    high: np.ndarray


def overruns_of(
    extent: BlockExtent,
    travel: Mapping[str, tuple[float, float]],
    widths: Mapping[Zero, np.ndarray],
) -> Iterator[Overrun]:
    """Yield where a block leaves the travel.

    ``widths`` is how far apart blocks of the same zero are: see ``widths_of``.
    """
    known = max(map(abs, extent.zero)) > SAME_ZERO
    ends = zip(LETTERS, extent.low.tolist(), extent.high.tolist())
    for (letter, low, high), width in zip(ends, widths.get(extent.zero, extent.high - extent.low)):
        least, most = travel.get(letter, (-math.inf, math.inf))
        certain = bool(known or width > most - least)
        if not certain and letter == "Z":  # hardly ever true, with any tool length
            continue
        if high > most + BEYOND:
            yield Overrun(letter, high, most, certain)
        elif low < least - BEYOND:
            yield Overrun(letter, low, least, certain)


def has_one_zero(events: Iterable[Event]) -> bool:
    """Tell whether a program stays in one of G54 to G59.3: others may be anywhere."""
    return len({event.text for event in events if WORK_OFFSET.fullmatch(event.text)}) < 2


def widths_of(extents: Iterable[BlockExtent]) -> dict[Zero, np.ndarray]:
    """Return, by the program's zero, how far blocks reach in X, Y and Z all together."""
    found: dict[Zero, list[np.ndarray]] = {}
    for extent in extents:
        found.setdefault(extent.zero, []).extend((extent.low, extent.high))
    return {zero: np.ptp(ends, axis=0) for zero, ends in found.items()}


def extent_of_block(block: Block, moves: Sequence[Move]) -> BlockExtent:
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
