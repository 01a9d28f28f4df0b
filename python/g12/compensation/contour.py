# SPDX-License-Identifier: GPL-2.0-or-later
"""The programmed contour: lines and arcs in a flat plane, each with the block it comes from.

The plane has a first and a second axis, and a height at right angles to it, all in program units;
its points are complex numbers, first + j second. On a part's face they are X (a radius value,
whatever the X words are), C as a length, and Z, with their origin in the spindle's centre; on a
cylinder C as a length, Z, and X. An angle grows from the first axis to the second; a positive sweep
is counterclockwise (G3), in radians.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from math import copysign, sqrt
from typing import NamedTuple, NoReturn

from g12.errors import Refusal, number
from g12.geometry.curve import FULL_TURN, Arc, Curve, Line, recentred, sweep_between
from g12.lengths import LARGEST
from g12.section.effects import Action, BlockEnd

SAME_POINT = 1e-6  # program units: points within it coincide, a shorter move is rounding
RADIUS_TOLERANCE_RATIO = 0.001  # of the radius: the mismatch that LinuxCNC allows any arc


class PlaneMove(NamedTuple):
    """A line or an arc in the plane, with the height from ``h0`` to ``h1``.

    ``offset`` is the compensation in force: the tool's radius, above zero with the tool on the
    left of the path (G41), below zero on its right (G42), 0 without. ``feed`` is the tool centre's
    speed in program units per minute. ``side`` is 1, -1 or 0, also with a radius of 0.
    """

    line: int
    feed: float
    offset: float
    curve: Curve
    h0: float
    h1: float
    side: int = 0

    @property
    def start(self) -> complex:
        return self.curve.start

    @property
    def end(self) -> complex:
        return self.curve.end

    @property
    def length(self) -> float:
        return self.curve.length

    @property
    def lowest(self) -> float:
        return min(self.h0, self.h1)

    def level(self, share: float) -> float:
        return self.h0 + share * (self.h1 - self.h0)

    def portion(self, first: float, last: float) -> PlaneMove:
        curve = self.curve.portion(first, last)
        return self._replace(curve=curve, h0=self.level(first), h1=self.level(last))


class Plunge(NamedTuple):
    line: int
    feed: float
    h0: float
    h1: float


class Start(NamedTuple):
    """The machine's position: the slide of the plane, the rotary axis in radians, the height.

    Its slide moves one axis of the plane, on a face the first one; there it is a radius value.
    """

    slide: float
    angle: float
    height: float


Motion = PlaneMove | Plunge
PathElement = Motion | Action | BlockEnd  # of a contour, or of the tool centre's path


class Contour:
    """Collects the blocks of one section, in order, and refuses those that cannot be a contour.

    ``first``, ``second`` and ``height`` are the programmed position, readable at any time. ``code``
    is for messages, and so are the letters of the ``plane`` and of an arc's ``centre``.
    ``radius_tolerance`` is how far an arc's radii at start and end may differ. ``beside`` is the
    tool's distance from the programmed start along the second axis; the first G1 removes it.

    ``side`` is the compensation in force: 40, 41 or 42. ``mirrored``: the tool of a G41 is on the
    right, as its radius is below 0, and that of a G42 on the left. ``start`` is the machine's
    position: by default on a face, at its zero line. ``notes`` are warnings for the operator about
    a contour that is cut.
    """

    def __init__(
        self,
        first: float,
        second: float,
        height: float,
        *,
        code: str = "G12.1",
        plane: str = "XCZ",
        centre: str = "I and J",
        radius_tolerance: float = 0.0,
        start: Start | None = None,
        beside: float = 0.0,
    ) -> None:
        self.first, self.second, self.height = first, second, height
        self.code, self.radius_tolerance = code, radius_tolerance
        self._plane, self._centre = plane, centre
        self.elements: list[PathElement] = []
        # of the elements, within SAME_POINT
        self._end, self._level = complex(first, second + beside), height
        self.side, self.mirrored = 40, False
        self.start = start or Start(first, 0.0, height)
        self._offset = self._radius = 0.0
        self._hand = 0
        self._switch: int | None = None  # line of the G40, G41 or G42 that waits for its G1
        self._switched_on = 0
        self.notes: list[str] = []

    def refuse(self, line: int, reason: str) -> NoReturn:
        raise Refusal(reason, self.code, line)

    def straight(
        self,
        first: float | None = None,
        second: float | None = None,
        height: float | None = None,
        *,
        at: int,
        feed: float,
    ) -> None:
        """Add the G1 of line ``at`` to an absolute point; a coordinate that is None stays."""
        end, h1 = self._absolute(at, first, second, height)
        h0, in_plane = self._level, first is not None or second is not None
        length = abs(end - self._end) if in_plane else 0.0
        self._check_feed(feed, at)
        self._check_switch(at, length)
        if length > SAME_POINT:
            curve = Line(self._end, end)
            move = PlaneMove(at, feed, self._offset, curve, h0, h1, self._hand)
            self.elements.append(move)
            self._end, self._level = end, h1
        elif abs(h1 - h0) > SAME_POINT:
            self.elements.append(Plunge(at, feed, h0, h1))
            self._level = h1
        self._reach(end, h1)

    def arc(
        self,
        turn: int,
        first: float | None = None,
        second: float | None = None,
        height: float | None = None,
        *,
        i: float | None = None,
        j: float | None = None,
        radius: float | None = None,
        at: int,
        feed: float,
    ) -> None:
        """Add the G2 (``turn`` -1) or G3 (``turn`` +1) of line ``at`` to an absolute point.

        Either ``i`` and/or ``j``: the centre from the arc's start along the first and the second
        axis, or ``radius``: negative for the arc over a half turn. The start as end point, or no
        end point, is a full circle with ``i``/``j``.
        """
        self._check_arc(turn, i, j, radius, at, feed)
        end, h1 = self._absolute(at, first, second, height)
        self._check_lengths(at, (*self._centre.split(" and "), "R"), (i, j, radius))
        if radius is None:
            curve = self._about_centre(turn, end, complex(i or 0.0, j or 0.0), at)
        else:
            curve = self._with_radius(turn, end, radius, at)
        move = PlaneMove(at, feed, self._offset, curve, self._level, h1, self._hand)
        self.elements.append(move)
        self._end, self._level = end, h1
        self._reach(end, h1)

    def compensate(self, side: int, radius: float, *, at: int) -> None:
        """Switch to G40, G41 or G42 (``side`` 40, 41, 42) on line ``at``, which must be a G1.

        Call it before the :meth:`straight` of the same block. ``radius`` is the tool's, and may be
        0. Below 0 it is a size correction: the path is offset by it to the other side.
        """
        self._check_waiting()
        if side == self.side:
            return
        if 40 not in (side, self.side):
            self.refuse(
                at, f"G{side}: cancel G{self.side} of line {self._switched_on} with G40 first"
            )
        self._radius = abs(radius) if side != 40 else abs(self._offset)
        self.mirrored = radius < 0.0 if side != 40 else self.mirrored
        self._hand = {40: 0, 41: 1, 42: -1}[side]
        self._offset = self._hand * radius
        self._switched_on = self._switch = at
        self.side = side

    def continued(self, start: Start) -> Contour:
        """Return an empty contour that continues this one from the machine's position.

        For a section that is cut in two by a block that waits for the machine.
        """
        following = copy(self)
        following.elements, following.notes, following.start = [], [], start
        return following

    def mark(self, action: Action | BlockEnd) -> None:
        """Add a step without motion at this point of the order."""
        self._check_waiting()
        self.elements.append(action)

    def close(self, *, at: int) -> None:
        """Check that the section may end here: compensation is off."""
        self._check_waiting()
        if self.side != 40:
            self.refuse(at, f"G{self.side} of line {self._switched_on} is still on: G40 is missing")

    def wait(self, *, at: int) -> None:
        """Check that M66 may wait for the machine here: compensation is off.

        Under compensation the next block decides where the tool stops, and that block is not read
        yet. LinuxCNC has the same rule.
        """
        if self.side != 40:
            self.refuse(
                at,
                "M66 waits for the machine, which needs G40: "
                f"G{self.side} of line {self._switched_on} is on",
            )

    def _reach(self, end: complex, height: float) -> None:
        self.first, self.second, self.height = end.real, end.imag, height

    def _absolute(
        self, line: int, first: float | None, second: float | None, height: float | None
    ) -> tuple[complex, float]:
        """Return the end of a block, with the programmed position for what it leaves out."""
        first = self.first if first is None else first
        second = self.second if second is None else second
        height = self.height if height is None else height
        self._check_lengths(line, self._plane, (first, second, height))
        return complex(first, second), height

    def _check_lengths(
        self, line: int, words: Sequence[str], values: Sequence[float | None]
    ) -> None:
        for word, value in zip(words, values):
            if value is not None and abs(value) > LARGEST:
                reason = f"{word}{number(value)} is no length: at most {number(LARGEST)}"
                self.refuse(line, reason)

    def _check_feed(self, feed: float, line: int) -> None:
        if feed <= 0.0:
            self.refuse(line, f"F{number(feed)} must be above zero (no feed commanded?)")

    def _check_waiting(self) -> None:
        if self._switch is not None:
            either = " or ".join(self._plane[:2])
            self.refuse(self._switch, f"G{self.side} needs a G1 with {either} in its own block")

    def _check_switch(self, line: int, length: float) -> None:
        if self._switch is None:
            return
        if self._switch != line or length <= SAME_POINT:
            self._check_waiting()
        if length < self._radius - SAME_POINT:
            self.refuse(
                line,
                f"the G1 with G{self.side} is {number(length)} long: it must be at least "
                f"the tool radius {number(self._radius)}",
            )
        self._switch = None

    def _check_arc(
        self,
        turn: int,
        i: float | None,
        j: float | None,
        radius: float | None,
        line: int,
        feed: float,
    ) -> None:
        name, beside = _name(turn), abs(self._end.imag - self.second)
        self._check_feed(feed, line)
        if beside > SAME_POINT:
            self.refuse(
                line,
                f"{name} needs a G1 with X or C before it: the tool is {number(beside)} "
                "beside X's line (POLAR_TOOL_OFFSET)",
            )
        if self._switch is not None:
            self.refuse(line, f"G{self.side} with {name}: compensation is switched by a G1 only")
        if radius is not None and (i is not None or j is not None):
            self.refuse(line, f"{name}: either R or {self._centre}, not both")
        if radius is None and not i and not j:
            self.refuse(line, f"{name} needs R, or the centre in {self._centre}")

    def _about_centre(self, turn: int, end: complex, arm: complex, line: int) -> Arc:
        """Return an arc about a centre, which is moved to be equally far from both ends."""
        start, centre = self._end, complex(self.first, self.second) + arm
        if abs(end - start) <= SAME_POINT:
            return Arc(start, centre, turn * FULL_TURN)
        from_start, from_end = abs(arm), abs(end - centre)
        allowed = max(self.radius_tolerance, RADIUS_TOLERANCE_RATIO * from_start)
        if abs(from_start - from_end) > allowed:
            self.refuse(
                line,
                f"{_name(turn)} does not close: its centre is {number(from_start)} from the start, "
                f"{number(from_end)} from the end",
            )
        centre = recentred(start, end, centre)
        return Arc(start, centre, sweep_between(start, end, centre, turn))

    def _with_radius(self, turn: int, end: complex, radius: float, line: int) -> Arc:
        start = self._end
        apart = abs(end - start)
        half, name = 0.5 * apart, f"{_name(turn)} R{number(radius)}"
        if apart <= SAME_POINT:
            self.refuse(line, f"{name}: a full circle needs {self._centre}, not R")
        if half - abs(radius) > max(0.5 * self.radius_tolerance, RADIUS_TOLERANCE_RATIO * half):
            self.refuse(
                line,
                f"{name} does not close: the ends are {number(apart)} apart, R must be at least "
                f"{number(half)}",
            )
        height = copysign(sqrt(max(0.0, radius * radius - half * half)) / apart, turn * radius)
        centre = (start + end) / 2 + 1j * height * (end - start)
        return Arc(start, centre, sweep_between(start, end, centre, turn))


def _name(turn: int) -> str:
    return "G3" if turn > 0 else "G2"
