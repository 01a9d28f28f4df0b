# SPDX-License-Identifier: GPL-2.0-or-later
"""What the rules need to know of a cut: a pocket, a section or a shape of the program."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from g12.tools.path.part import Z
from g12.tools.preview.moves import Move


class ProgramCut(NamedTuple):
    """A cut by its line, its code, and its moves from ``at`` to before ``end``.

    ``file`` is the name of a sub's own file. ``face`` is the machine Z of the program's Z0, None
    on a cylinder, where Z goes along the surface. ``turning`` says that C turns the part: its words
    then ask for the ``feeds`` along the part, mm/min, which its moves do not show.
    """

    line: int
    file: str
    code: str
    at: int
    end: int
    face: float | None
    turning: bool
    feeds: tuple[float, ...] = ()

    def fed(self, moves: Sequence[Move]) -> list[int]:
        """Return the indices of its moves at a feed."""
        return [i for i in range(self.at, self.end) if moves[i].kind != "rapid"]

    def lowest(self, moves: Sequence[Move]) -> float:
        """Return the lowest machine Z of its moves at a feed."""
        return min((moves[i].end[Z] for i in self.fed(moves)), default=float("inf"))
