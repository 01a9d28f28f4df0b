# SPDX-License-Identifier: GPL-2.0-or-later
"""The state before a block: modes, units, position, tools. Plain data, no LinuxCNC."""

from collections.abc import Callable
from typing import NamedTuple

from g12.errors import number
from g12.lengths import MM_PER_INCH, ROUNDING_MM

XY, YZ, XZ = "G17", "G19", "G18"
SMALLEST_RING_MM = 0.00508  # 0.0002 in: its half circles are twice what LinuxCNC needs


class Tool(NamedTuple):
    """A cutter: its number in the tool table and its radius in program units."""

    number: int
    radius: float


class Context(NamedTuple):
    """The interpreter's state before a block. Lengths are in program units.

    Position is in the active work coordinate system, tool offset applied, X as a radius.
    ``speed`` is the commanded spindle speed in rpm. ``offset_pending``: G40 came after the last
    move, and the tool is still offset from the programmed point by its radius. ``last_cutter`` is
    that of the last D commanded (None: none ever was), tool 0 where its number is not known;
    ``d_is_earlier()`` tells whether this run of the program has not commanded it.
    ``tool_in_table(n)`` gives tool n or None. ``unit`` is the program's where the machine has
    another, "mm" or "in": for sizes of the tool table in messages.
    """

    inch: bool
    x: float
    y: float
    z: float
    incremental: bool
    plane: str
    inverse_time: bool
    per_revolution: bool
    speed: float
    feed: float
    compensated: bool
    offset_pending: bool
    spindle_tool: Tool | None
    last_cutter: Tool | None
    d_is_earlier: Callable[[], bool]
    tool_in_table: Callable[[int], Tool | None]
    unit: str = ""

    def length(self, millimetres: float) -> float:
        """Return a length given in mm in program units."""
        return millimetres / MM_PER_INCH if self.inch else millimetres

    @property
    def position(self) -> tuple[float, float, float]:
        """The tool's X, Y and Z."""
        return self.x, self.y, self.z

    @property
    def rounding(self) -> float:
        """The greatest difference of equal lengths."""
        return self.length(ROUNDING_MM)

    @property
    def smallest_ring(self) -> float:
        """The smallest radius of a circle, and of a difference of two."""
        return self.length(SMALLEST_RING_MM)

    def absolute(self, word: float | None, present: float) -> float:
        """Return the absolute coordinate of a word in G90 or G91; without it, the present one."""
        if word is None:
            return present
        return present + word if self.incremental else word

    def tool_size(self, length: float) -> str:
        """Return a tool's radius or diameter for a message: ``3.175``, or ``3.175 mm``."""
        return f"{number(length)} {self.unit}".rstrip()
