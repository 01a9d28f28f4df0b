# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a Yasnac G12 or G13 block, by ngc/yasnac.md.

Places are those of the tool's centre along X from the circle's centre, mm, signed like I.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

from g12.tools.verify.expected.toolpath import Expected, Writer

ROUNDING = 1e-6  # mm


class YasnacWords(NamedTuple):
    """A block's words: where the fast move ends (0 without one), the spiral, the circle.

    ``first`` is where the half circle ends: on the circle, or on the spiral's first turn, which
    grows by ``pitch`` (0 without a spiral). ``traverse`` is the feed of the fast moves in mm per
    minute, 0 for rapids. ``turn`` is +1 counterclockwise, -1 clockwise.
    """

    approach: float
    first: float
    radius: float
    circles: int
    turn: int
    feed: float | None
    pitch: float = 0.0
    traverse: float = 0.0
    line: int = 0
    per_rev: bool = False

    @property
    def stepover(self) -> float | None:
        """Return what the spiral grows by in a turn, None without one."""
        return max(map(abs, self._growths()), default=0.0) * 2 or None

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: fast to the approach, onto the circle, round, and back."""
        writer, half = Writer(0j, 0.0, self.line, self.per_rev), self.turn * math.pi
        self._fast(writer, self.approach)
        writer.arc("lead-in", complex(self.approach + self.first) / 2, half, self.feed)
        for growth in self._growths():
            outward = math.copysign(growth, writer.at.real)
            writer.arc("spiral", complex(-outward / 2), half, self.feed)
        for _ in range(self.circles):
            writer.arc("circle", 0j, 2 * half, self.feed)
        writer.arc("lead-out", complex(self.approach + self.radius) / 2, half, self.feed)
        self._fast(writer, 0.0)
        return writer.path

    def _growths(self) -> Iterator[float]:
        """Yield what each half turn grows by: whole turns, the last one by what is left."""
        left = abs(self.radius - self.first) if self.pitch else 0.0
        while left > ROUNDING:
            growth = self.pitch if left > self.pitch + ROUNDING else left
            yield growth / 2
            yield growth / 2
            left -= growth

    def _fast(self, writer: Writer, place: float) -> None:
        if self.traverse:
            writer.straight("fast move", complex(place), self.traverse, per_rev=False)
        else:
            writer.straight("fast move", complex(place), rapid=True)
