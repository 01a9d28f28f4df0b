# SPDX-License-Identifier: GPL-2.0-or-later
"""Check of a cycle against the travel of the machine's axes, before its first motion."""

from collections.abc import Mapping
from math import cos, hypot, radians, sin
from typing import NamedTuple

from g12.lengths import ROUNDING_MM, beyond_limit, converts, is_inch
from g12.request.context import XY, XZ, YZ
from g12.request.words import Words

SpacePoint = tuple[float, float, float]  # X, Y, Z
TRAVEL_AXES = "XYZ"
_X, _Y, _Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
DIRECTIONS = {XY: (_X, _Y), XZ: (_Z, _X), YZ: (_Y, _Z)}  # a plane's axes


class CycleExtent(NamedTuple):
    """The largest circle that a cycle's tool centre follows, in program coordinates and units.

    ``heights`` are the other Z levels of the cycle. A rectangle's circle is that of its corners,
    whose centres are as far as ``corners`` from its own.
    """

    plane: str
    centre: SpacePoint
    radius: float
    heights: tuple[float, ...] = ()
    corners: tuple[float, float] = (0.0, 0.0)

    def points(self) -> list[SpacePoint]:
        x, y, z = self.centre
        return [(x, y, height) for height in self.heights or (z,)]


class MachineFrame(NamedTuple):
    """The transformation from program to machine coordinates.

    Add ``shift`` (G92), rotate about Z by ``rotation`` degrees, add ``offset`` (work and tool
    offset). All are in program units, which are ``unit`` machine units of ``millimetres`` each.
    """

    shift: SpacePoint
    rotation: float
    offset: SpacePoint
    unit: float
    millimetres: float

    def position(self, point: SpacePoint) -> SpacePoint:
        turned = self._turned(*(value + plus for value, plus in zip(point, self.shift)))
        x, y, z = (self.unit * (value + plus) for value, plus in zip(turned, self.offset))
        return x, y, z

    def half_widths(self, extent: CycleExtent) -> list[float]:
        """Return the path's extent from its centre along each axis, in machine units."""
        first, second = (self._turned(*axis) for axis in DIRECTIONS[extent.plane])
        along, across = extent.corners
        return [
            self.unit * (extent.radius * hypot(one, two) + abs(one * along) + abs(two * across))
            for one, two in zip(first, second)
        ]

    def _turned(self, x: float, y: float, z: float) -> SpacePoint:
        turn = radians(self.rotation)
        return x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), z


def check_travel(
    words: Words,
    extent: CycleExtent,
    frame: MachineFrame,
    limits: Mapping[str, tuple[float, float]],
) -> None:
    """Refuse a cycle that leaves the limits of an axis, its lowest and highest machine position."""
    centres = [frame.position(point) for point in extent.points()]
    rounding = ROUNDING_MM / frame.millimetres
    for letter, centre_positions, width in zip(
        TRAVEL_AXES, zip(*centres), frame.half_widths(extent)
    ):
        low, high = limits[letter]
        for position, limit, side in (
            (min(centre_positions) - width, low, -1),
            (max(centre_positions) + width, high, 1),
        ):
            if side * (position - limit) > rounding:
                raise words.refuse(_beyond(letter, position, limit, frame))


def _beyond(letter: str, position: float, limit: float, frame: MachineFrame) -> str:
    name = "in" if is_inch(frame.millimetres) else "mm"
    return beyond_limit(letter, position, limit, name, converted=converts(frame.unit))
