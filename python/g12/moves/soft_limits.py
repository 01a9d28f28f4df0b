# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether planned moves stay within the travel of the machine's axes."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol, TypeGuard

from g12.errors import number
from g12.lengths import converts
from g12.machine_ini import Axis


class AxisScale(NamedTuple):
    """How a program coordinate becomes a machine coordinate: times ``factor``, plus ``offset``."""

    factor: float
    offset: float


class Moving(Protocol):
    """A step of a plan that moves axes: X, C and Z of each segment come first."""

    @property
    def line(self) -> int:
        """The number of the block's line."""

    @property
    def segments(self) -> Sequence[tuple[float, ...]]:
        """The end positions, one after the other."""


class Beyond(NamedTuple):
    """A move that an axis cannot make: where it would go, and its limit, in machine coordinates.

    ``unit`` is theirs; ``converted``: the program's is another.
    """

    line: int
    axis: str
    position: float
    limit: float
    unit: str
    converted: bool

    def text(self, diameters: bool) -> str:
        """Return the rule for the message; ``diameters``: the program's X words are diameters."""
        active = f" (G{20 if self.unit == 'mm' else 21} is active)"
        return (
            f"the {self.axis} axis would go to {number(self.position)} {self.unit}"
            f"{' (radius)' * (self.axis == 'X' and diameters)}, beyond its limit"
            f" {number(self.limit)} {self.unit}"
            f"{active * self.converted}"
        )


class SoftLimits:
    """The travel of the axes X, C and Z, for moves in program coordinates.

    ``unit`` is the machine's unit of length, ``mm`` or ``in``.
    """

    def __init__(self, axes: dict[str, Axis], scales: dict[str, AxisScale], unit: str) -> None:
        self._unit = unit
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

    def beyond(self, steps: Iterable[object]) -> Beyond | None:
        """Return the first move that leaves the travel of an axis, None if all stay within.

        Steps without ``segments`` move nothing.
        """
        runs = [step for step in steps if _moves(step)]
        columns = zip(*(segment[:3] for run in runs for segment in run.segments))
        for (letter, limits), positions in zip(self._ranges, columns):
            if min(positions) < limits[0] or limits[1] < max(positions):
                return self._first(runs, letter, limits)
        return None

    def _first(self, runs: list[Moving], letter: str, limits: list[float]) -> Beyond:
        at = "XCZ".index(letter)
        line, position = next(
            (run.line, segment[at])
            for run in runs
            for segment in run.segments
            if not limits[0] <= segment[at] <= limits[1]
        )
        limit = limits[0] if position < limits[0] else limits[1]
        factor, offset = self._scales[letter]
        unit = "degrees" if letter == "C" else self._unit
        there, end = (value * factor + offset for value in (position, limit))
        return Beyond(line, letter, there, end, unit, converts(factor))


def _moves(step: object) -> TypeGuard[Moving]:
    return hasattr(step, "segments")
