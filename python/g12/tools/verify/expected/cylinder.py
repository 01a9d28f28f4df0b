# SPDX-License-Identifier: GPL-2.0-or-later
"""The words of a section on a cylinder, read once more apart from the planner.

The contour is drawn on the unrolled surface as seen from outside: to the right the length around
it, by the radius of G7.1 and C's angle, and Z upwards. So G2 is clockwise there, and
G41 has the tool on the left. X is at right angles to it; X and U are diameters where G7 is on. An
arc's centre is I or J along C and K along Z, both lengths.
"""

import math

from g12.tools.machine.ini import Ini
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.expected.polar import Pen


class SurfacePen(Pen):
    """Follows the words of the blocks of a section on a cylinder; ``surface`` is its radius, mm."""

    across = "CHZWIJKR"

    def __init__(self, first: Block, ini: Ini) -> None:
        state = first.state
        super().__init__(first, ini)
        self.x_unit = self.unit / 2 if state["_lathe_diameter_mode"] else self.unit
        halves = 2 if ini.settings.cylinder_word == "diameter" else 1
        self.surface = first.words["C"] * self.unit / halves
        self._degree = math.radians(self.surface)  # mm
        self.at = self.tool = complex(state["_c"] * self._degree, state["_z"] * self.unit)
        self.depth = state["_x"] * self.unit

    def _height(self, words: dict) -> float:
        return self._to(words, "X", "U", self.depth, self.x_unit)

    def _place(self, words: dict) -> complex:
        return complex(
            self._to(words, "C", "H", self.at.real, self._degree),
            self._to(words, "Z", "W", self.at.imag, self.unit),
        )

    def _arm(self, words: dict) -> complex | None:
        if not any(letter in words for letter in "IJK"):
            return None
        around = words.get("J", words.get("I", 0.0))
        return complex(around, words.get("K", 0.0)) * self.unit

    def _position(self, c: float) -> dict[str, float]:
        x, z = self.depth / self.unit, self.at.imag / self.unit
        return {"_x": x, "_z": z, "_c": self.at.real / self._degree}
