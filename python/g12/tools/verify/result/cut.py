# SPDX-License-Identifier: GPL-2.0-or-later
"""A cut as it was measured: one record for pockets, sections, shapes and calls of holes."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from g12.tools.path.part import Z
from g12.tools.path.slowest import Pace
from g12.tools.preview.moves import Move
from g12.tools.verify.expected.toolpath import Expected
from g12.tools.verify.result.finding import Finding


@dataclass(frozen=True)
class MeasuredCut:
    """What was ``commanded``, how far the tool's centre was off (mm), and more.

    It is infinite if part is missing, nan if the words could not be read.

    ``last`` is the last line of a section, ``file`` the name of a sub's own file. ``own`` are its
    moves, ``face`` is the machine Z of the program's Z0. C turns or holds the part (``turning``).
    ``surface`` is the radius, mm, of the cylinder that it is on, 0 without one.
    ``feeds`` are those of its words along the part, mm/min, None where its moves show them.
    ``per_turn`` is the highest of its words per revolution, mm, 0 where its moves show it.
    ``path`` is the expected toolpath, ``sound`` says that it was followed.
    ``values`` are its measures by the names of ``--json`` and the report: mm, mm², mm/min, degrees,
    seconds; None is not known.
    """

    commanded: Any
    line: int
    file: str
    code: str
    own: range
    face: float
    deviation: float
    values: Mapping[str, Any]
    judged: tuple[Finding, ...]
    last: int = 0
    turning: bool = True
    surface: float = 0.0
    feeds: tuple[float, ...] | None = None
    per_turn: float = 0.0
    path: Sequence[Expected] = ()
    sound: bool = True

    def fed(self, moves: Sequence[Move]) -> list[Move]:
        return [moves[i] for i in self.own if moves[i].kind != "rapid"]

    def lowest(self, moves: Sequence[Move]) -> float:
        """Return the lowest machine Z of its moves at a feed."""
        return min((move.end[Z] for move in self.fed(moves)), default=float("inf"))


def in_file(
    found: Iterable[Finding], file: str, start: Sequence[float] | None = None
) -> tuple[Finding, ...]:
    """Return what was found in a sub's own file, or "" in the program.

    Its place is where the cut starts if it has none of its own.
    """
    return tuple(replace(each, file=file, place=each.place or start) for each in found)


def pace_values(pace: Pace) -> dict[str, Any]:
    return {
        "lowest_feed": pace.lowest,
        "lowest_feed_at": [float(value) for value in pace.point],
        "seconds": pace.seconds,
        "seconds_programmed": pace.expected,
    }


def finite(value: float) -> float | None:
    """Return a number that JSON has, None for infinity and for what is not known."""
    return value if abs(value) < float("inf") else None
