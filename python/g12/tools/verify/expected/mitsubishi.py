# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a Mitsubishi G12 or G13 block, by ngc/mitsubishi.md, in any plane. Lengths mm."""

import math
from dataclasses import dataclass
from typing import Self

from g12.tools.machine.ini import Ini
from g12.tools.verify.expected.toolpath import CircleWords, Expected, core_within
from g12.tools.verify.expected.words import BlockInMm


@dataclass(frozen=True)
class MitsubishiWords(CircleWords):
    """A block's words; ``final`` is the tool centre's radius, ``turn`` +1 counterclockwise."""

    final: float
    turn: int
    feed: float | None
    word: str = ""

    @classmethod
    def of(cls, view: BlockInMm, turn: int, offset: float, ini: Ini) -> Self:
        """Return the words of a block; ``offset`` is the radius of D."""
        final, word = abs(view.length("I")) - offset, "" if offset else "I"
        return cls(final, turn, view.feed(), word, line=view.line, per_rev=view.per_rev)

    def cleared(self, cutter: float) -> float:
        return core_within(self.final, cutter)

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: half a circle out along the first axis, round, and back."""
        writer, half = self.writer(), self.turn * math.pi
        writer.arc("lead-in", complex(self.final) / 2, half, self.feed)
        writer.arc("circle", 0j, 2 * half, self.feed)
        writer.arc("lead-out", complex(self.final) / 2, half, self.feed)
        return writer.path
