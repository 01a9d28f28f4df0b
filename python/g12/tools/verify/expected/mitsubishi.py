# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a Mitsubishi G12 or G13 block, by ngc/mitsubishi.md, in any plane. Lengths mm."""

from __future__ import annotations

import math
from typing import NamedTuple

from g12.tools.verify.expected.toolpath import Expected, Writer


class MitsubishiWords(NamedTuple):
    """A block's words; ``radius`` is the tool centre's, ``turn`` +1 counterclockwise, else -1."""

    radius: float
    turn: int
    feed: float | None
    line: int = 0
    per_rev: bool = False
    stepover: float | None = None  # there is but one circle

    def toolpath(self) -> list[Expected]:
        """Return the expected moves: half a circle out along the first axis, round, and back."""
        writer, half = Writer(0j, 0.0, self.line, self.per_rev), self.turn * math.pi
        writer.arc("lead-in", complex(self.radius) / 2, half, self.feed)
        writer.arc("circle", 0j, 2 * half, self.feed)
        writer.arc("lead-out", complex(self.radius) / 2, half, self.feed)
        return writer.path
