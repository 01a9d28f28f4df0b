# SPDX-License-Identifier: GPL-2.0-or-later
"""A block's words in millimetres, the modal state before it and the tool's position."""

import math
from collections.abc import Iterable, Mapping

import numpy as np

from g12.lengths import MM_PER_INCH
from g12.tools.machine.ini import Ini
from g12.tools.path.part import C, X, Y, Z, plane_axes
from g12.tools.preview.executed_blocks import FEED_UNKNOWN, POSITION_NAMES, STATE_NAMES, Block
from g12.tools.preview.moves import Move

SETTING = {  # modes that no cycle changes, and the codes that do
    "_plane": {17.0, 18.0, 19.0},
    "_ijk_absolute_mode": {90.1, 91.1},
    "_lathe_diameter_mode": {7.0, 8.0},
}
FEED_MODES = {93.0, 94.0, 95.0}
LEFT_OUT = -9999.0
TAPS = (1.0, 2.0)  # kinds of holes: right-hand, left-hand
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


class BlockInMm:
    """A block's words in mm, and the position and the modal state before it; X is a radius."""

    def __init__(self, block: Block, first: Move) -> None:
        self.line, self.words, self._state = block.text.number, block.words, block.state
        in_g7 = bool(self._state["_lathe_diameter_mode"]) or 7.0 in block.codes
        if "X" in block.words and in_g7 and 8.0 not in block.codes and not block.text.call:
            self.words = {**block.words, "X": block.words["X"] / 2}
        self._first, self._codes = first, block.codes
        self.tool, self.axes = first.tool, plane_axes(first)
        self.start = np.array(first.start[:3])
        self._unit_before = 1.0 if self._state["_metric"] else MM_PER_INCH
        units = [{20.0: MM_PER_INCH, 21.0: 1.0}.get(code) for code in block.codes]
        self.unit = next(filter(None, units), self._unit_before)
        absolute = bool(self._state["_absolute"]) or 90.0 in block.codes
        self.absolute = absolute and 91.0 not in block.codes
        modes = FEED_MODES.intersection(block.codes)
        self.per_rev = 95.0 in modes if modes else bool(self._state["_units_per_rev"])

    def leaves(self, feed: float | None, last: Move) -> dict[str, float]:
        """Return the expected modal state after the block; ``last`` is its last move.

        ``feed`` in mm, None if it is not known. The comparison of the path reports a wrong end:
        here the program's coordinates are those of the actual end.
        """
        state = {
            "_metric": float(self.unit == 1.0),
            "_absolute": float(self.absolute),
            "_units_per_rev": float(self.per_rev),
            "_motion_mode": self._state["_motion_mode"],
            "_selected_tool": self.words.get("T", self._state["_selected_tool"]),
            **kept_state(self._state, self._codes),
        }
        end = turned(np.array(last.end[:3]) - self.zero(), -self._first.rotation) / self.unit
        state |= dict(zip(POSITION_NAMES, map(float, end)))
        return state if feed is None else {**state, "_feed": feed / self.unit}

    def length(self, letter: str) -> float:
        """Return a length word in mm, 0 without it."""
        return self.words.get(letter, 0.0) * self.unit

    def feed(self) -> float | None:
        """Return the feed in mm per minute or revolution: the F word, else the one in force.

        None if the preview does not know: the block changes the units, or one before it did.
        """
        if self.unit != self._unit_before:
            return None
        feed = self.words.get("F", feed_in_force(self._state))
        return None if feed is None else feed * self.unit

    def position(self, axis: str) -> float:
        """Return the tool's position before the block in program coordinates, mm."""
        return self._state[f"_{axis}"] * self._unit_before

    def centre(self) -> np.ndarray:
        """Return the centre in machine coordinates: X and Y words, else the tool's position."""
        steps = np.array([self._step("x"), self._step("y"), 0.0])
        return self.start + turned(steps, self._first.rotation)

    def zero(self) -> np.ndarray:
        """Return the program's zero in machine coordinates."""
        position = np.array([self.position(axis) for axis in "xyz"])
        return self.start - turned(position, self._first.rotation)

    def from_centre(self) -> complex:
        """Return the tool's position before the block, from the centre along the plane's axes."""
        first, second, _ = self.axes @ (self.start - self.centre())
        return complex(first, second)

    def depth(self, times: int) -> float:
        """Return how far the Z word, ``times`` over if incremental, leads from the tool."""
        end = self.start[2] + times * self.length("Z")
        if self.absolute and "Z" in self.words:
            end = self.start[2] + self.length("Z") - self.position("z")
        return end - self.start[2]

    def _step(self, axis: str) -> float:
        if axis.upper() not in self.words:
            return 0.0
        word = self.length(axis.upper())
        return word - self.position(axis) if self.absolute else word


def feed_in_force(state: Mapping[str, float]) -> float | None:
    """Return the F in force in program units, None after a preview changed the units."""
    return None if state["_feed"] == FEED_UNKNOWN else state["_feed"]


def turned(vector: np.ndarray, degrees: float) -> np.ndarray:
    """Return a vector rotated about Z."""
    (x, y, z), cos, sin = vector, np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([x * cos - y * sin, x * sin + y * cos, z])


def kept_state(state: Mapping[str, float], codes: Iterable[float]) -> dict[str, float]:
    """Return the modes that a block must not change: none of its codes sets them."""
    return {name: state[name] for name, setting in SETTING.items() if setting.isdisjoint(codes)}


class SubCall:
    """One call of a sub: its entries, the cutter and its position before the first move.

    ``given`` are the entries that the program has, in program units. ``moves`` are those of its
    ``block``, ``cutter`` is the cutter's radius, ``at`` X, Z and C of the tool, ``beside`` its
    distance from the X line, ``turned`` the angle by which the first move turns C, degrees.
    """

    def __init__(self, block: Block, first: Move, cutter: float, ini: Ini) -> None:
        self.name, self.line, self.file = block.text.call, block.text.number, block.text.file
        self.block, self.moves = block, range(block.at, block.end)
        names = ENTRIES[self.name]
        values = (*block.arguments, *[0.0] * len(names))  # LinuxCNC passes 0 for the missing
        self.given = {n: value for n, value in zip(names, values) if value != LEFT_OUT}
        self.cutter, self.settings = cutter, ini.settings
        self._several = ini.number("TRAJ", "SPINDLES", 1) > 1
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

    @property
    def is_tapped(self) -> bool:
        return self.given.get("kind", 0.0) in TAPS

    @property
    def surface(self) -> float:
        """The radius of the surface in which holes in the side are drilled."""
        return self.length("surface_diameter") / 2

    def length(self, name: str, default: float = 0.0) -> float:
        """Return a length, or its default in mm."""
        return self.given[name] * self.unit if name in self.given else default

    def x(self) -> float:
        return self.length("x") / (2 if self.diameters else 1)

    def feed(self) -> float | None:
        """Return the feed per minute, None if the F in force is not known."""
        return None if self._feed is None else self._feed * self._per_minute

    def feed_as_given(self) -> tuple[float | None, bool]:
        """Return the feed in mm per minute or revolution, and whether it is per revolution."""
        return self._feed and self._feed * self.unit, bool(self._state["_units_per_rev"])

    def plunge_feed(self) -> float | None:
        """Return the feed down per minute, None if the F in force is not known."""
        if "plunge_feed" in self.given:
            return self.given["plunge_feed"] * self._per_minute
        feed = self.feed()
        return None if feed is None else feed * self.settings.plunge_feed / 100

    @property
    def speed(self) -> float:
        """S in force, revolutions per minute, 0 if it may be another spindle's."""
        return 0.0 if self._several else self._state["_rpm"]

    @property
    def _feed(self) -> float | None:
        return self.given.get("feed", feed_in_force(self._state))

    @property
    def _per_minute(self) -> float:
        """The mm per minute of a feed of 1: the unit, under G95 times the spindle's speed."""
        return self.unit * (self._state["_rpm"] if self._state["_units_per_rev"] else 1.0)

    def turn_to(self, angle: float) -> float:
        """Return by how much C turns to an angle; the machine chooses the whole turns."""
        turn = angle - self.at[2]
        return turn + 360.0 * round((self.turned - turn) / 360.0)

    def leaves(self) -> dict[str, float]:
        """Return the expected modal state after the call: that before it, without positions."""
        feed_known = feed_in_force(self._state) is not None
        names = [name for name in STATE_NAMES if feed_known or name != "_feed"]
        return {name: self._state[name] for name in names if name not in POSITION_NAMES}


def equal_steps(first: float, last: float, most: float, rounding: float) -> list[float]:
    """Return the ends of the fewest equal steps of at most ``most``.

    A rest of at most ``rounding`` is no step of its own.
    """
    count = math.ceil((abs(last - first) - rounding) / most)
    return [first + (last - first) * step / count for step in range(1, count + 1)]
