# SPDX-License-Identifier: GPL-2.0-or-later
"""The toolpath of a call of holes with C, by ngc/holes.md.

The plane is that of the tool's approach: across is the slide that does not move in a hole (X of the
face, Z of the side), upwards C as millimetres round the circle of holes. The level is the height
above the face or the surface. Lengths are mm, angles degrees unless a name says otherwise.
"""

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

from support.oracle.calls import C, SubCall, X, Z
from support.oracle.toolpath import Expected, Writer

CHIP = 0.254  # back to break a chip, and short of where the drill was, but half a peck at most
ROUNDING = 1e-6  # so small a rest is no peck of its own
HALF_TURN, SAME_TURN = 180.0, 1e-6
LEAST_RADIUS = 1.0  # of a hole in the centre, where C counts too
DRILL, TAP_RIGHT, TAP_LEFT, BORE = range(4)


@dataclass(frozen=True)
class Holes:
    """What a call commands: the positions of its holes, and how each is drilled.

    ``x`` and ``angle`` are those of the first one (in the side ``x`` is that of the surface),
    ``z`` is 0 on the face. ``turn`` leads from one hole to the next. ``pitch`` is a tap's, else 0.
    """

    call: SubCall
    side: bool
    count: int
    x: float
    z: float
    angle: float
    turn: float
    kind: int

    @property
    def depth(self) -> float:
        """The depth below the face or surface."""
        return self.call.length("depth")

    @property
    def dwell(self) -> float:
        """The seconds at the bottom; a tap has none."""
        return 0.0 if self.pitch else self.call.given.get("dwell", 0.0)

    @property
    def pitch(self) -> float:
        """The pitch of a tap, 0 of any other hole."""
        return self.call.length("feed") if self.kind in (TAP_RIGHT, TAP_LEFT) else 0.0

    @property
    def circle(self) -> float:
        """The radius of the circle on which the holes lie: on the face or the surface."""
        return self.x if self.side else math.hypot(self.x, self.call.beside)

    @property
    def round_scale(self) -> float:
        """The mm that C counts for a degree."""
        return math.radians(max(LEAST_RADIUS, self.circle))

    def point(self, position: Sequence[float]) -> tuple[complex, float]:
        """Return a machine position as a point and a level."""
        x, z, c = (position[a] - zero for a, zero in zip((X, Z, C), self.call.zero))
        across, level = (z, x - self.x) if self.side else (x, z)
        return complex(across, c * self.round_scale), level

    def clamped(self, move: Expected) -> bool | None:
        """Return whether C's clamp is to be closed: in a hole, not where C turns; None: either."""
        if abs(move.curve.end.imag - move.curve.start.imag) > SAME_TURN:
            return False
        lowest = min(move.start_level, move.end_level)
        return True if lowest < self.call.length("retract") - ROUNDING else None


def _shorter(angle: float, made: float) -> float:
    """Return a turn as the shorter way; a half turn goes as it is ``made``."""
    short = math.remainder(angle, 360.0)
    if abs(abs(short) - HALF_TURN) < SAME_TURN:
        return math.copysign(HALF_TURN, made)
    return short


def holes_of(call: SubCall) -> Holes:
    given, side = call.given, call.is_side
    count, kind = round(given.get("count", 1)), round(given.get("kind", DRILL))
    step = given.get("step_angle", 360.0 / count)
    turn = _shorter(step, step) if count > 1 else 0.0
    if side:
        x, z = call.surface, call.length("z")
        return Holes(call, side, count, x, z, given.get("first_angle", 0.0), turn, kind)
    if call.name == "face_holes":
        radius, angle = call.length("circle_diameter") / 2, given.get("first_angle", 0.0)
    else:
        centre = complex(call.x(), call.length("c"))
        radius, angle = abs(centre), math.degrees(cmath.phase(centre)) if centre else 0.0
    x = math.sqrt(max(0.0, radius**2 - call.beside**2))
    angle -= math.degrees(math.atan2(call.beside, x))
    return Holes(call, side, count, x, 0.0, angle, turn, kind)


class HolesPath:
    """Writes the moves of one call; ``turned`` is by how much C really goes to the first hole."""

    def __init__(self, holes: Holes, turned: float) -> None:
        self._holes, call = holes, holes.call
        x, z, c = call.at
        across, level = (z, x - holes.x) if holes.side else (x, z)
        there = complex(across, c * holes.round_scale)
        self._feed, per_rev = call.feed_as_given()
        self._writer = Writer(there, level, call.line, per_rev)
        self._retract = call.length("retract")
        self._top = max(level, self._retract)
        self._turns = [_shorter(holes.angle - c, turned), *[holes.turn] * (holes.count - 1)]

    def toolpath(self) -> list[Expected]:
        writer = self._writer
        writer.vertical("rapid out", self._top, rapid=True)
        for number, turn in enumerate(self._turns):
            self._turn(turn)
            if not number:
                across = self._holes.z if self._holes.side else self._holes.x
                writer.straight("rapid over the hole", complex(across, writer.at.imag), rapid=True)
            writer.vertical("rapid down", self._retract, rapid=True)
            self._hole()
        writer.vertical("rapid up", self._top, rapid=True)
        return writer.path

    def _turn(self, degrees: float) -> None:
        end = self._writer.at + 1j * degrees * self._holes.round_scale
        self._writer.straight("turn of C", end, rapid=True)

    def _hole(self) -> None:
        """Write the way from the retract height down and back."""
        writer, depth = self._writer, self._holes.depth
        if self._holes.pitch:
            writer.vertical("tap", -depth)
            writer.vertical("tap back", self._retract)
            return
        self._pecks()
        writer.vertical("hole", -depth, self._feed)
        if self._holes.kind == BORE:
            writer.vertical("bore back", self._retract, self._feed)
        writer.vertical("rapid back", self._retract, rapid=True)

    def _pecks(self) -> None:
        """Write all pecks but the last."""
        writer, peck = self._writer, self._holes.call.length("peck")
        count = math.ceil((self._holes.depth - ROUNDING) / abs(peck)) if peck else 1
        for number in range(1, count):
            writer.vertical("peck", -number * abs(peck), self._feed)
            if peck > 0:
                writer.vertical("rapid back", self._retract, rapid=True)
            clear = min(CHIP, abs(peck) / 2)
            writer.vertical("rapid again", clear - number * abs(peck), rapid=True)
