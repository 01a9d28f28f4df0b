# SPDX-License-Identifier: GPL-2.0-or-later
"""A block's words in millimetres, and the modes, the position and the tool that it finds."""

import math
from collections.abc import Iterable, Mapping, Sequence

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


class BlockInMm:
    """A block's words in mm, and where the tool is when it begins."""

    def __init__(self, block: Block, first: Move) -> None:
        self.line = block.text.number
        self.words = block.words
        self.arguments = block.arguments
        self.tool = first.tool
        self.start = np.array(first.start[:3])
        self.axes = plane_axes(first)
        self._state = block.state
        self._unit_before = 1.0 if block.state["_metric"] else MM_PER_INCH
        commanded = {20.0: MM_PER_INCH, 21.0: 1.0}
        changes = (commanded[code] for code in block.codes if code in commanded)
        self.unit = next(changes, self._unit_before)
        absolute = bool(block.state["_absolute"])
        self.absolute = (absolute or 90.0 in block.codes) and 91.0 not in block.codes
        self._first, self._codes = first, block.codes
        self.rev = self._per_revolution(block.codes)

    def _per_revolution(self, codes: Sequence[float]) -> bool:
        commanded = [code for code in codes if code in (93.0, 94.0, 95.0)]
        return 95.0 in commanded if commanded else bool(self._state["_units_per_rev"])

    def leaves(self, feed: float | None, last: Move) -> dict[str, float]:
        """Return the state that the block should leave behind its last move.

        ``feed`` in mm, None if it is not known. The tool may end elsewhere, which is told by
        itself: there the program's coordinates are those of its zero.
        """
        left = {
            "_metric": float(self.unit == 1.0),
            "_absolute": float(self.absolute),
            "_units_per_rev": float(self.rev),
            "_motion_mode": self._state["_motion_mode"],
            "_selected_tool": self.words.get("T", self._state["_selected_tool"]),
        }
        left |= kept_state(self._state, self._codes)
        if not self._state["_lathe_diameter_mode"]:
            place = turned(np.array(last.end[:3]) - self.zero(), -self._first.rotation) / self.unit
            left |= dict(zip(("_x", "_y", "_z"), map(float, place)))
        return left if feed is None else {**left, "_feed": feed / self.unit}

    def length(self, letter: str) -> float:
        """Return a length word in mm, 0 without it."""
        return self.words.get(letter, 0.0) * self.unit

    def feed(self) -> float | None:
        """Return the feed in mm per minute or revolution: the F word, else what is in force.

        None if the preview does not know: the block changes the units, or one before it did.
        """
        if self.unit != self._unit_before:
            return None
        if "F" not in self.words and self._state["_feed"] == FEED_UNKNOWN:
            return None
        return self.words.get("F", self._state["_feed"]) * self.unit

    def present(self, axis: str) -> float:
        """Return where the tool stands in program coordinates, mm."""
        return self._state[f"_{axis}"] * self._unit_before

    def centre(self) -> np.ndarray:
        """Return the centre in machine coordinates: X and Y words, else where the tool stands."""
        return self.start + self._turned(self._step("x"), self._step("y"), 0.0)

    def zero(self) -> np.ndarray:
        """Return the program's zero in machine coordinates."""
        return self.start - self._turned(*map(self.present, "xyz"))

    def seen_from(self, centre: np.ndarray) -> complex:
        """Return where the tool stands, along the plane's axes from a centre."""
        first, second, _ = self.axes @ (self.start - centre)
        return complex(first, second)

    def height(self, letter: str, times: int) -> float:
        """Return the height in machine coordinates that a Z word leads to, ``times`` over.

        Without the word it is where the tool stands.
        """
        if self.absolute and letter in self.words:
            return self.start[2] + self.length(letter) - self.present("z")
        return self.start[2] + times * self.length(letter)

    def _step(self, axis: str) -> float:
        if axis.upper() not in self.words:
            return 0.0
        word = self.length(axis.upper())
        return word - self.present(axis) if self.absolute else word

    def _turned(self, x: float, y: float, z: float) -> np.ndarray:
        """Return a direction of the program in machine coordinates."""
        return turned(np.array([x, y, z]), self._first.rotation)


def turned(way: np.ndarray, degrees: float) -> np.ndarray:
    """Return a direction turned about Z."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([way[0] * cos - way[1] * sin, way[0] * sin + way[1] * cos, way[2]])


def kept_state(state: Mapping[str, float], codes: Iterable[float]) -> dict[str, float]:
    """Return what must be behind blocks as it was: the modes that none of their codes sets."""
    given = set(codes)
    return {name: state[name] for name, setting in SETTING.items() if not given & setting}


class SubCall:
    """One call: its entries, the tool and its place when it begins, and how the sub reads it.

    ``given`` has the entries that are not left out, in program units. ``moves`` are those of its
    ``block``, ``cutter`` is the cutter's radius, ``at`` X, Z and C of the tool, ``beside`` its
    distance from the X line, ``turned`` by how much the first move turns C.
    """

    def __init__(self, block: Block, first: Move, cutter: float, ini: Ini) -> None:
        self.name, self.line, self.file = block.text.call, block.text.number, block.text.file
        self.block, self.moves = block, range(block.at, block.end)
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
        known = self._state["_feed"] if self._state["_feed"] != FEED_UNKNOWN else None
        feed = self.given.get("feed", known)
        return None if feed is None else feed * self._per_minute

    def feed_as_given(self) -> tuple[float | None, bool]:
        """Return the feed in mm per minute or revolution, and whether it is per revolution."""
        known = self._state["_feed"] if self._state["_feed"] != FEED_UNKNOWN else None
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
        unknown = {"_feed"} if self._state["_feed"] == FEED_UNKNOWN else set()
        names = [name for name in STATE_NAMES if name not in unknown.union(POSITION_NAMES)]
        return {name: self._state[name] for name in names}


def equal_steps(first: float, last: float, most: float, rounding: float) -> list[float]:
    """Return where the fewest equal steps of at most ``most`` lead, without the first place.

    A rest that is not longer than ``rounding`` is no step of its own.
    """
    count = math.ceil((abs(last - first) - rounding) / most)
    return [first + (last - first) * step / count for step in range(1, count + 1)]
