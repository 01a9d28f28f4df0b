# SPDX-License-Identifier: GPL-2.0-or-later
"""What shape on a face a call asks for: its entries read once more, apart from the planners.

Lengths are millimetres in machine coordinates, but for heights, which count from the program's Z0,
the part's face; X is a radius. Angles are degrees.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from g12.lengths import MM_PER_INCH
from g12.tools.path.part import C, X, Z
from g12.tools.preview.executed_blocks import FORGOTTEN, PLACES, STATE, Block
from g12.tools.preview.moves import Move
from g12.tools.verify.reading.circles import LEFT_OUT
from g12.tools.verify.reading.codes import Codes
from g12.tools.verify.shapes.shape_form import ShapeForm, polygon_form, round_form, slot_form

CUT = ("depth", "depth_per_pass", "allowance", "feed", "plunge_feed")
ENTRIES_OF = {
    "polar_polygon": (
        *("sides", "across_flats", "depth", "stock_diameter", "corner_radius"),
        *(*CUT[1:], "angle"),
    ),
    "polar_slot": ("width", "length", *CUT, "angle"),
    "polar_pocket": ("x", "c", "diameter", *CUT),
}
SAME_DEPTH = 1e-6  # mm: a rest as small is no pass of its own
CLEARANCE = 1.0  # mm above the face, and beside the stock, where the tool comes down


class ShapeReading(NamedTuple):
    """What a machine's [G12] settings make of a call.

    ``x`` is POLAR_X, ``plunge_share`` of F the feed down, ``entry_angle`` the steepest way down.
    """

    x: str
    plunge_share: float
    entry_angle: float


@dataclass(frozen=True)
class ShapeAsked:
    """A shape to be cut, who asks for it (``file``: of a sub, "" the program), with what, how.

    ``zero`` is where the program's zero is on the machine: X, Z, and C in degrees. ``tool`` is the
    cutter's number, ``cutter`` its radius. ``levels`` are the heights of its passes, ``allowance``
    stands on its walls before the last round. Feeds are mm/min, None if they are not known.
    ``start`` is the height where the tool stands before and behind, ``leaves`` the state behind,
    as ``Block.left`` has it.
    """

    name: str
    line: int
    file: str
    moves: range
    form: ShapeForm
    zero: tuple[float, float, float]
    tool: int
    cutter: float
    levels: tuple[float, ...]
    allowance: float
    feed: float | None
    plunge_feed: float | None
    entry_angle: float
    start: float
    diameters: bool
    entries: Mapping[str, float]
    leaves: Mapping[str, float] = field(default_factory=dict)

    @property
    def near(self) -> float:
        """Return the height down to which the tool goes by rapid."""
        return min(self.start, CLEARANCE)


def shapes_asked(
    blocks: Sequence[Block],
    codes: Codes,
    moves: Sequence[Move],
    diameters: Mapping[int, float],
    reading: ShapeReading,
) -> Iterator[tuple[Block, ShapeAsked]]:
    """Yield each call that cuts a shape, with what it asks for."""
    for block in blocks:
        if codes.shape_of(block.text) and block.end > block.at:
            tool = moves[block.at].tool
            cutter = diameters.get(tool, 0.0) / 2
            yield block, ShapeCall(block, moves[block.at], reading).asked(tool, cutter)


class ShapeCall:
    """One call of a shape: its entries by name, in mm, and what was in force."""

    def __init__(self, block: Block, first: Move, reading: ShapeReading) -> None:
        names = ENTRIES_OF[block.text.call]
        given = (*block.arguments, *[0.0] * len(names))  # LinuxCNC makes up for those that lack
        self._entries = {n: value for n, value in zip(names, given) if value != LEFT_OUT}
        self._block, self._first, self._reading = block, first, reading
        self._state = block.state
        self._unit = 1.0 if block.state["_metric"] else MM_PER_INCH
        in_g7 = bool(block.state["_lathe_diameter_mode"])
        self._diameters = {"diameter": True, "radius": False}.get(reading.x, in_g7)

    def asked(self, tool: int, cutter: float) -> ShapeAsked:
        """Return what the call asks for."""
        feed = self._feed()
        return ShapeAsked(
            self._block.text.call,
            self._block.text.number,
            self._block.text.file,
            range(self._block.at, self._block.end),
            self._form(),
            self._zero(),
            tool,
            cutter,
            self._levels(),
            self._length("allowance"),
            feed,
            self._plunge_feed(feed),
            self._reading.entry_angle,
            self._state["_z"] * self._unit,
            self._diameters,
            self._entries,
            self._leaves(),
        )

    def _length(self, name: str, default: float = 0.0) -> float:
        return self._entries.get(name, default / self._unit) * self._unit

    def _zero(self) -> tuple[float, float, float]:
        """Return where the program's zero is on the machine."""
        start, state = self._first.start, self._state
        x, z = (start[axis] - state[n] * self._unit for axis, n in ((X, "_x"), (Z, "_z")))
        return x, z, start[C] - state["_c"]

    def _form(self) -> ShapeForm:
        """Return the form on the part, which C turns."""
        turned = self._zero()[2] + self._entries.get("angle", 0.0)
        if self._block.text.call == "polar_polygon":
            sizes = map(self._length, ("across_flats", "corner_radius"))
            bar = self._length("stock_diameter") / 2
            return polygon_form(round(self._entries["sides"]), *sizes, bar, turned)
        if self._block.text.call == "polar_slot":
            return slot_form(self._length("width"), self._length("length"), turned)
        x = self._length("x") / (2 if self._diameters else 1)
        away, angle = cmath.polar(complex(x, self._length("c")))
        angle += math.radians(self._zero()[2])
        centre = cmath.rect(away, angle)
        return round_form(centre, self._length("diameter"), math.degrees(angle))

    def _levels(self) -> tuple[float, ...]:
        """Return the heights of the passes, all equally deep, none deeper than it may be."""
        depth = self._length("depth")
        count = max(1, math.ceil((depth - SAME_DEPTH) / self._length("depth_per_pass", depth)))
        return tuple(-depth * level / count for level in range(1, count + 1))

    def _feed(self) -> float | None:
        """Return the feed per minute of the tool's centre."""
        known = self._state["_feed"] if self._state["_feed"] != FORGOTTEN else None
        feed = self._entries.get("feed", known)
        return None if feed is None else feed * self._unit * self._turns()

    def _plunge_feed(self, feed: float | None) -> float | None:
        if "plunge_feed" in self._entries:
            return self._entries["plunge_feed"] * self._unit * self._turns()
        return None if feed is None else feed * self._reading.plunge_share

    def _turns(self) -> float:
        """Return what makes a feed one per minute: the spindle's speed under G95."""
        return self._state["_rpm"] if self._state["_units_per_rev"] else 1.0

    def _leaves(self) -> dict[str, float]:
        """Return the state behind the call: all that it found, but for where the tool is."""
        lost = {"_feed"} if self._state["_feed"] == FORGOTTEN else set()
        return {n: self._state[n] for n in STATE if n not in lost.union(PLACES)}
