# SPDX-License-Identifier: GPL-2.0-or-later
"""What the axes of a machine can do, from its INI file, and whether moves stay within it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from .polar import Run
from .settings import section_entries

NO_LIMIT = 1e99
DEFAULT_SPEED = 1.0  # of an axis without MAX_VELOCITY or MAX_ACCELERATION


class Axis(NamedTuple):
    """One axis in machine units (degrees for C) and seconds: where it may go, and how fast."""

    low: float
    high: float
    velocity: float
    acceleration: float


class Scale(NamedTuple):
    """How a program coordinate becomes a machine coordinate: times ``factor``, plus ``offset``."""

    factor: float
    offset: float


class Beyond(NamedTuple):
    """A move that an axis cannot make: where it would go, and its limit, in machine coordinates."""

    line: int
    axis: str
    position: float
    limit: float


class Travel:
    """The travel of the axes X, C and Z, for moves in program coordinates."""

    def __init__(self, axes: dict[str, Axis], scales: dict[str, Scale]) -> None:
        self._ranges = [
            (
                letter,
                [
                    (limit - scales[letter].offset) / scales[letter].factor
                    for limit in axes[letter][:2]
                ],
            )
            for letter in "XCZ"
        ]
        self._scales = scales

    def beyond(self, runs: Iterable[Run]) -> Beyond | None:
        """Return the first move that leaves the travel of an axis, None if all stay within."""
        for run in runs:
            for (letter, limits), positions in zip(self._ranges, zip(*run.pieces)):
                if (
                    letter in run.axes
                    and not limits[0] <= min(positions) <= max(positions) <= limits[1]
                ):
                    return self._first(run, letter, limits, positions)
        return None

    def _first(
        self, run: Run, letter: str, limits: list[float], positions: Sequence[float]
    ) -> Beyond:
        position = next(
            position for position in positions if not limits[0] <= position <= limits[1]
        )
        limit = limits[0] if position < limits[0] else limits[1]
        factor, offset = self._scales[letter]
        return Beyond(run.line, letter, position * factor + offset, limit * factor + offset)


def axes_from_ini(text: str) -> dict[str, Axis]:
    """Return the axes X, Z and C of an (expanded) INI file."""
    return {letter: _axis(dict(section_entries(text, f"AXIS_{letter}"))) for letter in "XZC"}


def _axis(entries: Mapping[str, str]) -> Axis:
    keys = (
        ("MIN_LIMIT", -NO_LIMIT),
        ("MAX_LIMIT", NO_LIMIT),
        ("MAX_VELOCITY", DEFAULT_SPEED),
        ("MAX_ACCELERATION", DEFAULT_SPEED),
    )
    return Axis(*(float(entries.get(key, f"{default}").split()[0]) for key, default in keys))
