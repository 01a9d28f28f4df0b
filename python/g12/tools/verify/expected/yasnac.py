# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a Yasnac G12 or G13 block, by ngc/yasnac.md.

Positions are those of the tool's centre along X from the circle's centre, mm, signed like I.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Self

from g12.tools.machine.ini import Ini
from g12.tools.verify.expected.toolpath import CircleWords, Expected, Writer, core_within
from g12.tools.verify.expected.words import BlockInMm

ROUNDING = 1e-6  # mm


@dataclass(frozen=True)
class YasnacWords(CircleWords):
    """A block's words: the end of the fast move (0 without one), the spiral, the circle.

    ``first`` is the end of the half circle: on the circle, or on the spiral's first turn, which
    grows by ``pitch`` (0 without a spiral). ``traverse`` is the feed of the fast moves in mm per
    minute, 0 for rapids. ``turn`` is +1 counterclockwise, -1 clockwise. ``hole`` is the radius of
    the hole that was there before, without an offset that of the tool's centre in it.
    """

    approach: float
    first: float
    radius: float
    circles: int
    turn: int
    feed: float | None
    pitch: float = 0.0
    traverse: float = 0.0
    word: str = ""
    hole: float = 0.0

    @classmethod
    def of(cls, view: BlockInMm, turn: int, offset: float, ini: Ini) -> Self:
        """Return the words of a block; ``offset`` is the radius of D, 0 without it."""
        words, hole = view.words, view.length("R") or view.length("J")
        inward = math.copysign(offset, words["I"])
        radius = view.length("I") - inward
        return cls(
            hole - inward if hole else 0.0,
            view.length("K") - inward if "K" in words else radius,
            radius,
            int(words.get("L", 1)),
            turn,
            view.feed(),
            view.length("Q"),
            ini.settings.yasnac_traverse * ini.mm,
            "" if offset else "I",
            abs(hole),
            line=view.line,
            per_rev=view.per_rev,
        )

    @property
    def final(self) -> float:
        return abs(self.radius)

    def bore(self, cutter: float) -> float:
        """Return the radius of the hole that was there before."""
        return self.hole + (cutter if self.hole and self.word else 0.0)

    def cleared(self, cutter: float) -> float:
        """Return the radius within which material may remain.

        A spiral has gone all round when it has grown by Q.
        """
        spiral = max(0.0, self.final - abs(self.first) - self.pitch)
        return self.bore(cutter) or core_within(self.final - spiral, cutter)

    @property
    def stepover(self) -> float | None:
        """Return what the spiral grows by in a turn, None without one."""
        return max(map(abs, self._growths()), default=0.0) * 2 or None

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: fast to the approach, onto the circle, round, and back."""
        writer, half = self.writer(), self.turn * math.pi
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
        """Yield what each half turn grows by: whole turns, the last one by the rest."""
        rest = abs(self.radius - self.first) if self.pitch else 0.0
        while rest > ROUNDING:
            growth = self.pitch if rest > self.pitch + ROUNDING else rest
            yield growth / 2
            yield growth / 2
            rest -= growth

    def _fast(self, writer: Writer, x: float) -> None:
        how = {"per_rev": False} if self.traverse else {"rapid": True}
        writer.straight("fast move", complex(x), self.traverse or None, **how)
