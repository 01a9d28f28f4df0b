# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a call of a polygon, a slot or a round pocket, by ngc/polar_shapes.md.

Points are those of the tool's centre on the face, which turns with C: the real axis is the X line
of the program's C0, the level is Z. Lengths are mm, angles radians unless a name says degrees.
"""

import cmath
import math

from support.oracle.calls import SubCall, equal_steps
from support.oracle.toolpath import Expected, Writer

CLEAR = 1.0  # above the face, and between the tool and the stock beside it
WIDEST = 0.75  # of the cutter's diameter: rounds and rings are no farther apart
CLEARED = 0.9  # of the cutter's radius: the first ring is not larger
LEAST_RING = 0.00508  # a smaller first ring is 0, and so small a rest is no ring of its own
ROUNDING = 1e-6
FLATS = 2  # sides that meet nowhere


class ShapePath:
    """Writes the moves of one shape, whose points are those seen along the zero line."""

    def __init__(self, call: SubCall, zero_line: float) -> None:
        """``zero_line`` is its angle in degrees."""
        self.call, self.feed, self.plunge_feed = call, call.feed(), call.plunge_feed()
        self.allowance, self.cutter = call.length("allowance"), call.cutter
        self.most = WIDEST * 2 * self.cutter
        self._zero_line, self._turn = zero_line, cmath.rect(1.0, math.radians(zero_line))
        x, self.start_level, c = call.at
        there = complex(x, call.beside) * cmath.rect(1.0, math.radians(c))
        self._writer = Writer(there, self.start_level, call.line)

    @property
    def path(self) -> list[Expected]:
        return self._writer.path

    @property
    def level(self) -> float:
        return self._writer.level

    @property
    def levels(self) -> list[float]:
        depth = self.call.length("depth")
        most = self.call.length("depth_per_pass", depth)
        return equal_steps(0.0, -depth, most, ROUNDING)

    def approach(self, x: float, first: complex) -> None:
        """Write the rapids to X on the zero line and down, and the line to the first point."""
        turn = math.radians(self.call.turn_to(self._zero_line))
        parts = max(1, math.ceil(abs(turn) / math.pi))
        for _ in range(parts):
            self._writer.arc("rapid of C", 0j, turn / parts, rapid=True)
        beside = self._turn * complex(x, self.call.beside)
        self._writer.straight("rapid of X", beside, rapid=True)
        self._writer.vertical("rapid down", min(self.start_level, CLEAR), rapid=True)
        self.line("approach", first)

    def line(self, name: str, end: complex, fall: float = 0.0) -> None:
        """Write a line, at the feed down if it falls."""
        self._writer.straight(name, self._turn * end, self._feed(fall), fall)

    def arc(self, name: str, centre: complex, sweep: float, fall: float = 0.0) -> None:
        """Write an arc, at the feed down if it falls."""
        self._writer.arc(name, self._turn * centre, sweep, self._feed(fall), fall)

    def plunge(self, level: float) -> None:
        self._writer.vertical("plunge", level, self.plunge_feed)

    def up(self) -> None:
        """Write the rapid up to where the tool stood."""
        self._writer.vertical("rapid up", self.start_level, rapid=True)

    def _feed(self, fall: float) -> float | None:
        return self.plunge_feed if fall else self.feed


class Polygon:
    """A polygon, or two flats: its rounds by the distance of their flats from the spindle."""

    def __init__(self, call: SubCall) -> None:
        self._sides = round(call.given["sides"])
        self._half = math.pi / self._sides  # the angle from the middle of a flat to a corner
        apothem, stock = call.length("across_flats") / 2, call.length("stock_diameter") / 2
        self._inner = apothem - call.length("corner_radius")  # to where the corners' arcs begin
        self._shape = ShapePath(call, call.given.get("angle", 0.0) + math.degrees(self._half))
        self._clip = stock + call.cutter + CLEAR
        self._final = apothem + call.cutter
        last = self._final + self._shape.allowance
        self._rounds = equal_steps(stock + call.cutter, last, self._shape.most, ROUNDING)
        tops = map(self._top, (*self._rounds, self._final))
        self._outside = max(self._clip, *tops)

    def toolpath(self) -> list[Expected]:
        shape = self._shape
        shape.approach(self._outside, self._outside)
        for level in shape.levels:
            shape.plunge(level)
            for apothem in self._rounds:
                self._round(apothem)
        if shape.allowance:
            self._round(self._final, "finish ")
        shape.up()
        return shape.path

    def _is_clipped(self, apothem: float) -> bool:
        """Tell whether a round's flats would end beyond the clip circle."""
        side = self._inner * math.tan(self._half)
        return self._sides == FLATS or math.hypot(apothem, side) > self._clip + ROUNDING

    def _top(self, apothem: float) -> float:
        """Return how far the middle of a round's corners is from the spindle."""
        if self._is_clipped(apothem):
            return self._clip
        return self._inner / math.cos(self._half) + apothem - self._inner

    def _round(self, apothem: float, kind: str = "") -> None:
        """Write one round, clockwise from the zero line."""
        shape, top = self._shape, self._top(apothem)
        lead = math.acos(min(1.0, top / self._outside))
        shape.arc("lead-in", 0j, lead)
        shape.line("lead-in", top)
        for index in range(self._sides):
            self._corner(apothem, index, kind, 1 if index else 0.5)
            flat = cmath.rect(1.0, -(2 * index + 1) * self._half)
            shape.line(f"{kind}flat", flat * complex(apothem, -self._flat_half(apothem)))
        self._corner(apothem, 0, kind, 0.5)
        shape.line("lead-out", top - 1j * self._outside * math.sin(lead))
        shape.arc("lead-out", 0j, lead)

    def _corner(self, apothem: float, index: int, kind: str, share: float) -> None:
        """Write a share of a corner."""
        flat = math.atan2(self._flat_half(apothem), apothem)
        name, sweep = f"{kind}corner", 2 * share * (self._half - flat)
        centre = 0j
        if not self._is_clipped(apothem):
            away = self._inner / math.cos(self._half)
            centre, sweep = cmath.rect(away, -2 * index * self._half), 2 * share * self._half
        self._shape.arc(name, centre, -sweep)

    def _flat_half(self, apothem: float) -> float:
        """Return half the length of a round's flats."""
        if self._is_clipped(apothem):
            return math.sqrt(self._clip**2 - apothem**2)
        return self._inner * math.tan(self._half)


class Rings:
    """A hole cleared ring by ring: a slot, or a round pocket, whose ends are one point.

    ``centre`` is the middle of its ends, ``ahead`` the direction from there to the first end,
    ``reach`` how far that is. A ring begins on the left of an end.
    """

    def __init__(
        self, shape: ShapePath, width: float, centre: complex, ahead: complex, reach: float
    ) -> None:
        self._shape, self._centre, self._ahead, self._reach = shape, centre, ahead, reach
        self._way_down = "ramp" if reach else "helix"
        self._final = max(0.0, width / 2 - shape.cutter)
        last = self._final - shape.allowance
        self.first = min(last, CLEARED * shape.cutter) if last > LEAST_RING - ROUNDING else 0.0
        is_line = not self.first
        self._further = [] if is_line else equal_steps(self.first, last, shape.most, LEAST_RING)
        self.side = 1  # the end at which the tool is: 1 or -1
        self._radius = self.first

    def place(self, radius: float) -> complex:
        """Return where a ring begins at the end at which the tool is."""
        return self._centre + self.side * self._ahead * complex(self._reach, radius)

    def clear(self) -> None:
        """Write all passes."""
        shape, above = self._shape, self._shape.level
        for level in shape.levels:
            self._down(above - level)
            self._once_round("ring")
            rings = [("ring", radius) for radius in self._further]
            if shape.allowance and level == shape.levels[-1]:
                rings.append(("finish ring", self._final))
            for name, radius in rings:
                self.half_turn("stepover", radius)
                self._once_round(name)
            if rings:
                self.half_turn("stepover back", self.first)
            above = level

    def _down(self, height: float) -> None:
        """Write the fewest half turns of the first ring that are not too steep."""
        length = 2 * self._reach + math.pi * self.first
        steepest = math.tan(math.radians(self._shape.call.settings.entry_angle))
        count = math.ceil(height / (length * steepest))
        for _ in range(count):
            self.half_turn(self._way_down, self.first, height / count)

    def _once_round(self, name: str) -> None:
        for _ in range(2):
            self.half_turn(name, self._radius)

    def half_turn(self, name: str, radius: float, fall: float = 0.0) -> None:
        """Write a line to the other end, and the half circle about it to a ring of a radius."""
        length, bend = 2 * self._reach, math.pi * self._radius
        on_line = fall * length / (length + bend) if fall else 0.0
        self.side = -self.side
        left = -self.side * self._ahead * 1j
        end = self._centre + self.side * self._ahead * self._reach
        self._shape.line(name, end + left * self._radius, on_line)
        self._shape.arc(name, end + left * (self._radius - radius) / 2, math.pi, fall - on_line)
        self._radius = radius


def _slot_path(call: SubCall) -> list[Expected]:
    shape = ShapePath(call, call.given.get("angle", 0.0))
    width = call.length("width")
    reach = (call.length("length") - width) / 2
    rings = Rings(shape, width, 0j, 1 + 0j, reach)
    shape.approach(reach, rings.place(rings.first))
    rings.clear()
    shape.line("lead-out", rings.place(0.0))
    shape.up()
    return shape.path


def _pocket_path(call: SubCall) -> list[Expected]:
    centre = complex(call.x(), call.length("c"))
    shape = ShapePath(call, math.degrees(cmath.phase(centre)) if centre else 0.0)
    away = abs(centre)
    rings = Rings(shape, call.length("diameter"), away, -1j, 0.0)
    shape.approach(away + rings.first, rings.place(rings.first))
    rings.clear()
    if rings.side < 0:
        rings.half_turn("lead-out", rings.first)
    shape.line("lead-out", away + rings.first / 2)
    shape.up()
    return shape.path


def shape_path(call: SubCall) -> list[Expected]:
    if call.name == "polar_polygon":
        return Polygon(call).toolpath()
    return (_slot_path if call.name == "polar_slot" else _pocket_path)(call)
