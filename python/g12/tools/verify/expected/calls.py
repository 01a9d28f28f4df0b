# SPDX-License-Identifier: GPL-2.0-or-later
"""What a call of a sub for the lathe asks for: its entries by name, and what was in force.

Lengths are mm, angles degrees. X is a radius; the program's zero is X0, Z0 and C0.
"""

from __future__ import annotations

import math

from g12.lengths import MM_PER_INCH
from g12.tools.machine.ini import Ini
from g12.tools.path.part import C, X, Y, Z
from g12.tools.preview.executed_blocks import FORGOTTEN, PLACES, STATE, Block
from g12.tools.preview.moves import Move

LEFT_OUT = -9999.0
CUT = ("depth", "depth_per_pass", "allowance", "feed", "plunge_feed")
HOLE = ("depth", "retract", "feed", "peck", "dwell", "kind")
ENTRIES = {
    "polar_polygon": (
        *("sides", "across_flats", "depth", "stock_diameter", "corner_radius"),
        *(*CUT[1:], "angle"),
    ),
    "polar_slot": ("width", "length", *CUT, "angle"),
    "polar_pocket": ("x", "c", "diameter", *CUT),
    "face_holes": ("count", "circle_diameter", "first_angle", "step_angle", *HOLE),
    "side_holes": ("count", "z", "first_angle", "step_angle", "surface_diameter", *HOLE),
    "face_hole_at": ("x", "c", *HOLE),
}


class SubCall:
    """One call: its entries, the tool and its place when it begins, and how the sub reads it.

    ``given`` has the entries that are not left out, in program units. ``moves`` are those of the
    call, ``cutter`` is the cutter's radius, ``at`` X, Z and C of the tool, ``beside`` how far it
    stands from the X line, ``turned`` by how much the first move turns C.
    """

    def __init__(self, block: Block, first: Move, cutter: float, ini: Ini) -> None:
        self.name, self.line, self.file = block.text.call, block.text.number, block.text.file
        self.moves = range(block.at, block.end)
        names = ENTRIES[self.name]
        values = (*block.arguments, *[0.0] * len(names))  # LinuxCNC makes up for those that lack
        self.given = {n: value for n, value in zip(names, values) if value != LEFT_OUT}
        self.cutter, self.settings = cutter, ini.settings
        self._state = state = block.state
        self.unit = 1.0 if state["_metric"] else MM_PER_INCH
        in_g7 = bool(state["_lathe_diameter_mode"])
        self.diameters = {"diameter": True, "radius": False}.get(self.settings.polar_x, in_g7)
        self.at = (state["_x"] * self.unit, state["_z"] * self.unit, state["_c"])
        self._start, self.beside = first.start, first.start[Y]
        self.turned = first.end[C] - first.start[C]

    @property
    def zero(self) -> tuple[float, float, float]:
        """The program's X0, Z0 and C0 in machine coordinates."""
        x, z, c = (self._start[axis] - at for axis, at in zip((X, Z, C), self.at))
        return x, z, c

    @property
    def is_side(self) -> bool:
        """Whether the tool points at the axis."""
        return self.name == "side_holes"

    def length(self, name: str, default: float = 0.0) -> float:
        """Return a length, or its default in mm."""
        return self.given[name] * self.unit if name in self.given else default

    def x(self) -> float:
        """Return the X entry as a radius."""
        return self.length("x") / (2 if self.diameters else 1)

    def feed(self) -> float | None:
        """Return the feed per minute, None if the F in force is not known."""
        known = self._state["_feed"] if self._state["_feed"] != FORGOTTEN else None
        feed = self.given.get("feed", known)
        return None if feed is None else feed * self._per_minute

    def feed_as_given(self) -> tuple[float | None, bool]:
        """Return the feed in mm per minute or revolution, and whether it is per revolution."""
        known = self._state["_feed"] if self._state["_feed"] != FORGOTTEN else None
        feed = self.given.get("feed", known)
        return feed and feed * self.unit, bool(self._state["_units_per_rev"])

    def plunge_feed(self) -> float | None:
        """Return the feed down per minute, None if the F in force is not known."""
        if "plunge_feed" in self.given:
            return self.given["plunge_feed"] * self._per_minute
        feed = self.feed()
        return None if feed is None else feed * self.settings.plunge_feed / 100

    @property
    def _per_minute(self) -> float:
        """What makes mm per minute of a feed: the unit, under G95 the spindle's speed too."""
        return self.unit * (self._state["_rpm"] if self._state["_units_per_rev"] else 1.0)

    def turn_to(self, angle: float) -> float:
        """Return by how much C turns to an angle: the whole turns of it are the machine's."""
        turn = angle - self.at[2]
        return turn + 360.0 * round((self.turned - turn) / 360.0)

    def leaves(self) -> dict[str, float]:
        """Return the state after the call: all that it found, but for where the tool is."""
        lost = {"_feed"} if self._state["_feed"] == FORGOTTEN else set()
        return {name: self._state[name] for name in STATE if name not in lost.union(PLACES)}


def equal_steps(first: float, last: float, most: float, rounding: float) -> list[float]:
    """Return where the fewest equal steps of at most ``most`` lead, without the first place.

    A rest that is not longer than ``rounding`` is no step of its own.
    """
    count = math.ceil((abs(last - first) - rounding) / most)
    return [first + (last - first) * step / count for step in range(1, count + 1)]
