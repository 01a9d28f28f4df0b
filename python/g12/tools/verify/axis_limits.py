# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether a pocket fits into the machine's travel: the axes' own positions against their limits.

LinuxCNC itself adds the work offsets, those that the program sets and those of the machine's var
file. Where there are none, a pocket is not known to be where it is traced, but how wide it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from g12.machine_ini import axes_of
from g12.tools.machine.ini import Ini
from g12.tools.path.part import arc_points
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Event, Move
from g12.tools.verify.reading.block_words import BlockInMm

LETTERS = "XYZ"
SHARES = np.linspace(0.0, 1.0, 181)  # of an arc that are looked at
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
    """Return the ends of travel of a machine's axes X, Y and Z, mm."""
    limits = axes_of(ini.get, LETTERS)
    return {letter: (axis.low * ini.mm, axis.high * ini.mm) for letter, axis in limits.items()}


def overruns_of(
    block: Block,
    moves: Sequence[Move],
    travel: Mapping[str, tuple[float, float]],
    widths: Mapping[Zero, np.ndarray],
) -> Iterator[Overrun]:
    """Yield where a block leaves the travel, of moves with the machine's work offsets.

    ``widths`` is how far apart blocks of the same zero are: see ``widths_of``.
    """
    zero = zero_of_block(block, moves)
    known = np.abs(zero).max() > SAME_ZERO
    points = points_of_block(block, moves)
    own = np.ptp(points[:, :3], axis=0)
    for letter, values, width in zip(LETTERS, points.T, widths.get(zero, own)):
        low, high = float(values.min()), float(values.max())
        least, most = travel[letter]
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


def widths_of(blocks: Iterable[Block], moves: Sequence[Move]) -> dict[Zero, np.ndarray]:
    """Return, by the program's zero, how far blocks reach in X, Y and Z all together."""
    found: dict[Zero, list[np.ndarray]] = {}
    for block in blocks:
        points = points_of_block(block, moves)[:, :3]
        ends = [points.min(axis=0), points.max(axis=0)]
        found.setdefault(zero_of_block(block, moves), []).extend(ends)
    return {zero: np.ptp(ends, axis=0) for zero, ends in found.items()}


def zero_of_block(block: Block, moves: Sequence[Move]) -> Zero:
    """Return the program's zero in machine coordinates."""
    return tuple(map(float, np.round(BlockInMm(block, moves[block.at]).zero(), DECIMALS) + 0.0))


def points_of_block(block: Block, moves: Sequence[Move]) -> np.ndarray:
    """Return positions (n, 9) of the axes along a block's moves."""
    return np.concatenate([axes_along(move) for move in moves[block.at : block.end]])


def axes_along(move: Move) -> np.ndarray:
    """Return positions (n, 9) of the axes along a move, tool length offset included."""
    points = arc_points(move, SHARES) if move.kind == "arc" else np.array([move.start, move.end])
    return points + np.array(move.tool_offset)
