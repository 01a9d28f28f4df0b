# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter's state before a block, read once, and the travel that it leaves to the axes."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import cos, radians, sin
from types import MappingProxyType
from typing import NamedTuple

from g12.errors import number
from g12.lengths import MM_PER_INCH, ROUNDING_MM, converts, is_inch

XY, YZ, XZ = "G17", "G19", "G18"
LINEAR_AXES, ROTARY_AXES = "XYZ", "ABC"
SMALLEST_RING_MM = 0.00508  # 0.0002 in: its half circles are twice what LinuxCNC needs
SpacePoint = tuple[float, float, float]  # X, Y, Z


class Tool(NamedTuple):
    """A cutter: its number in the tool table and its radius in program units."""

    number: int
    radius: float


NO_TOOLS: Mapping[int, Tool] = MappingProxyType({})


class State(NamedTuple):
    """The interpreter's state before a block, in program units and degrees; X is a radius."""

    inch: bool
    machine_mm: float  # the machine's unit of length
    x: float  # in the active work offset, with the tool's
    y: float
    z: float
    offsets: Mapping[str, float]  # of each axis, the sum of work offset, G92 and tool
    shifts: Mapping[str, float]  # of X, Y and Z by G92 or G52
    rotation: float  # of the work offset about Z
    plane: str
    incremental: bool
    inverse_time: bool  # G93
    per_revolution: bool  # G95
    feed: float
    speed: float  # rpm as commanded, of the spindle that feeds per revolution refer to
    compensated: bool
    offset_pending: bool  # after G40 the tool is still offset from the programmed point
    spindle_tool: Tool | None
    last_cutter: Tool | None = None  # of the last D; tool 0 where its number is not known
    d_is_earlier: Callable[[], bool] = bool  # this run of the program has not commanded it
    tools: Mapping[int, Tool] = NO_TOOLS  # of the table, those whose D counts in the block
    a: float = 0.0
    b: float = 0.0
    c: float = 0.0
    motion: int = 0  # the code that bare words repeat, times ten
    spindle: int = 0  # number of the one that feeds per revolution refer to
    speeds: tuple[float, ...] = (0.0,)
    diameter: bool = False  # G7
    surface_speed: bool = False  # G96
    travel: Mapping[str, Sequence[float]] | None = None  # limits of X, Y, Z; none in a preview

    @property
    def millimetre(self) -> float:
        return 1.0 / MM_PER_INCH if self.inch else 1.0

    @property
    def machine_unit(self) -> float:
        """The length of a machine unit in program units."""
        return self.machine_mm / (MM_PER_INCH if self.inch else 1.0)

    def length(self, millimetres: float) -> float:
        """Return a length given in mm in program units."""
        return millimetres / MM_PER_INCH if self.inch else millimetres

    @property
    def xyz(self) -> SpacePoint:
        return self.x, self.y, self.z

    def position(self, letter: str) -> float:
        """Return the position of an axis."""
        return float(getattr(self, letter.lower()))

    @property
    def rounding(self) -> float:
        """The greatest difference of equal lengths."""
        return self.length(ROUNDING_MM)

    @property
    def smallest_ring(self) -> float:
        """The smallest radius of a circle, and of a difference of two."""
        return self.length(SMALLEST_RING_MM)

    def tool_size(self, length: float) -> str:
        """Return a tool's radius or diameter for a message: ``3.175``.

        The tool table's numbers are the machine's: where its unit is another, ``3.175 mm``.
        """
        unit = "in" if self.inch else "mm"
        return f"{number(length)} {unit}" if converts(self.machine_unit) else number(length)

    def turned(self, x: float, y: float, z: float) -> SpacePoint:
        """Return a direction of the program as one of the machine."""
        turn = radians(self.rotation)
        return x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), z

    def on_machine(self, letter: str, position: float) -> float:
        """Return a position of an axis in machine units; the work offset is not rotated."""
        there = position + self.offsets[letter]
        return there if letter in ROTARY_AXES else there / self.machine_unit

    def point_on_machine(self, point: SpacePoint) -> SpacePoint:
        """Return a point of X, Y and Z in machine units; G92 comes before the rotation."""
        shifts = [self.shifts[letter] for letter in LINEAR_AXES]
        turned = self.turned(*(value + shift for value, shift in zip(point, shifts)))
        x, y, z = (
            self.on_machine(letter, value - shift)
            for letter, value, shift in zip(LINEAR_AXES, turned, shifts)
        )
        return x, y, z


# By the name of the state's field, the modes in which no code of the package can begin.
REFUSED_MODES = {
    "inverse_time": "needs G94 or G95, not G93",
    "compensated": "needs G40: compensation is switched on inside",
    "offset_pending": "needs a move after G40: the tool is still beside the programmed point",
}


def refused_mode(state: State, *, moves_first: bool = False) -> str:
    """Return the rule that the first refused mode breaks, "" if none is in force.

    ``moves_first``: the block itself moves to where the tool is not offset.
    """
    for name, rule in REFUSED_MODES.items():
        if getattr(state, name) and not (moves_first and name == "offset_pending"):
            return rule
    return ""


class Beyond(NamedTuple):
    """An axis that would leave its travel, and the rule for a message."""

    axis: str
    rule: str


def beyond_travel(
    state: State,
    limits: Mapping[str, Sequence[float]],
    ranges: Iterable[tuple[str, float, float]],
    *,
    diameters: bool = False,
) -> Beyond | None:
    """Return the first axis whose range, in machine units, leaves its limits, None if none does.

    A machine shows the radius of X; ``diameters``: the program's words are the diameter.
    """
    for axis, low, high in ranges:
        least, most, *_ = limits[axis]
        for position, limit, over in ((low, least, least - low), (high, most, high - most)):
            if over > ROUNDING_MM / state.machine_mm:
                unit = "in" if is_inch(state.machine_mm) else "mm"
                name = f"{unit} (radius)" if diameters and axis == "X" else unit
                active = f" (G{20 if unit == 'mm' else 21} is active)"
                if axis in ROTARY_AXES:
                    unit = name = "degrees"
                other = active if axis in LINEAR_AXES and converts(state.machine_unit) else ""
                return Beyond(
                    axis,
                    f"the {axis} axis would go to {number(position)} {name}, beyond its limit"
                    f" {number(limit)} {unit}{other}",
                )
    return None
