# SPDX-License-Identifier: GPL-2.0-or-later
"""The programmed contour: lines and arcs in a flat plane, each with the block it comes from.

The plane has the axes x and c, and z at right angles to it, all in program units. On a part's face
they are X (a radius value, whatever the X words meant), C as a length, and Z, with their origin in
the spindle's centre; on a cylinder C as a length, Z, and X. An angle grows from +x to +c; a
positive sweep is counterclockwise (G3), in radians.
"""

from __future__ import annotations

from copy import copy
from math import atan2, copysign, hypot, pi, sqrt
from typing import NamedTuple, NoReturn, TypeGuard

from g12.errors import Refusal, number
from g12.lengths import LARGEST

Point = tuple[float, float]  # x, c
SAME_PLACE = 1e-6  # program units: closer points are one point, a shorter move is rounding
CLOSING_RATIO = 0.001  # of the radius: the mismatch LinuxCNC allows any arc


class Line(NamedTuple):
    """A straight move in the plane, with Z from ``z0`` to ``z1``.

    ``offset`` is the compensation in force: the tool's radius, above zero with the tool on the
    left of the path (G41), below zero on its right (G42), 0 without. ``feed`` is the tool centre's
    speed in program units per minute.
    """

    line: int
    feed: float
    offset: float
    x0: float
    c0: float
    z0: float
    x1: float
    c1: float
    z1: float


class Arc(NamedTuple):
    """A circular move about (``cx``, ``cc``) by the signed angle ``sweep``.

    The other members are those of :class:`Line`.
    """

    line: int
    feed: float
    offset: float
    x0: float
    c0: float
    z0: float
    x1: float
    c1: float
    z1: float
    cx: float
    cc: float
    sweep: float


class Plunge(NamedTuple):
    """A move of Z alone."""

    line: int
    feed: float
    z0: float
    z1: float


class Mark(NamedTuple):
    """A block without motion; the plan gives the caller's ``action`` back in its place."""

    line: int
    action: object


class PlaneNames(NamedTuple):
    """What a program calls the axes of the plane, and an arc's centre, for messages."""

    x: str
    c: str
    z: str
    centre: str


FACE = PlaneNames("X", "C", "Z", "I and J")


class Start(NamedTuple):
    """Where the machine stands: X radius value, angle of C in radians, Z."""

    x: float
    angle: float
    z: float


Move = Line | Arc | Plunge
Element = Move | Mark  # of a contour, or of the tool centre's path


def is_move(element: Element) -> TypeGuard[Line | Arc]:
    """Return whether an element moves in the plane."""
    return isinstance(element, (Line, Arc))


def arc_radius(move: Arc) -> float:
    """Return an arc's radius."""
    return hypot(move.x0 - move.cx, move.c0 - move.cc)


def path_length(move: Line | Arc) -> float:
    """Return the length of a move in the plane."""
    if isinstance(move, Line):
        return hypot(move.x1 - move.x0, move.c1 - move.c0)
    return abs(move.sweep) * arc_radius(move)


def start_direction(move: Line | Arc) -> Point:
    """Return the unit vector of the motion in the plane at the move's start."""
    return direction_at(move, (move.x0, move.c0))


def end_direction(move: Line | Arc) -> Point:
    """Return the unit vector of the motion in the plane at the move's end."""
    return direction_at(move, (move.x1, move.c1))


def direction_at(move: Line | Arc, place: Point) -> Point:
    """Return the unit vector of the motion in the plane at a place of the move."""
    if isinstance(move, Line):
        tx, tc = move.x1 - move.x0, move.c1 - move.c0
    else:
        turn = 1.0 if move.sweep > 0.0 else -1.0
        tx, tc = turn * (move.cc - place[1]), turn * (place[0] - move.cx)
    length = hypot(tx, tc)
    return tx / length, tc / length


def recentred(start: Point, end: Point, centre: Point) -> Point:
    """Return the point nearest to ``centre`` that is equally far from ``start`` and ``end``."""
    ux, uc = end[0] - start[0], end[1] - start[1]
    mx, mc = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    along = ((centre[0] - mx) * ux + (centre[1] - mc) * uc) / (ux * ux + uc * uc)
    return centre[0] - along * ux, centre[1] - along * uc


def sweep_between(start: Point, end: Point, centre: Point, turn: int) -> float:
    """Return the signed angle from one point to another about a third.

    ``turn``: +1 counterclockwise, -1 clockwise. A full turn where the angle is none.
    """
    ax, ac = start[0] - centre[0], start[1] - centre[1]
    bx, bc = end[0] - centre[0], end[1] - centre[1]
    angle = turn * atan2(ax * bc - ac * bx, ax * bx + ac * bc)
    return turn * (angle if angle > 0.0 else angle + 2 * pi)


class Contour:
    """Collects the blocks of one section, in order, and refuses those that cannot be a contour.

    ``x``, ``c`` and ``z`` are the programmed position in the plane, readable at any time.
    ``code`` and ``names`` are for messages. ``diameter`` tells whether the program's words for x
    are diameters, None where they cannot be: the values passed in never are, but a message has to
    say which reading was meant. ``closing`` is the radius mismatch of an arc that is forgiven, in
    program units. ``beside``: the tool itself stands so far from there along the second axis, until
    the first G1 takes it to its programmed end.

    ``side`` is the compensation in force: 40, 41 or 42. ``start`` is where the machine stands: by
    default on a face, at its zero line. ``notes`` are what the operator is told of it, though it is
    cut.
    """

    def __init__(
        self,
        x: float,
        z: float,
        c: float = 0.0,
        *,
        code: str = "G12.1",
        names: PlaneNames = FACE,
        diameter: bool | None = False,
        closing: float = 0.0,
        start: Start | None = None,
        beside: float = 0.0,
    ) -> None:
        self.x, self.c, self.z = x, c, z
        self.code, self.names, self.diameter, self.closing = code, names, diameter, closing
        self.elements: list[Line | Arc | Plunge | Mark] = []
        self._end = (x, c + beside, z)  # of the elements; else less than SAME_PLACE away
        self.side = 40
        self.start = start or Start(x, 0.0, z)
        self._offset = self._radius = 0.0
        self._switch: int | None = None  # line of the G40, G41 or G42 that waits for its G1
        self._switched_on = 0
        self.notes: list[str] = []

    def refuse(self, line: int, reason: str) -> NoReturn:
        """Raise the refusal of a block of this section."""
        raise Refusal(f"{self.code} line {line}: {reason}")

    def line(
        self,
        x: float | None = None,
        c: float | None = None,
        z: float | None = None,
        *,
        line: int,
        feed: float,
    ) -> None:
        """Add a G1 to the absolute point given; a coordinate left out stays."""
        x0, c0, z0 = self._end
        x1 = self.x if x is None else x
        c1 = self.c if c is None else c
        z1 = self.z if z is None else z
        if max(abs(x1), abs(c1), abs(z1)) > LARGEST:
            self._check_place(line, x1, c1, z1)
        across = x is not None or c is not None
        length = hypot(x1 - x0, c1 - c0) if across else 0.0
        self._check_feed(feed, line)
        self._check_switch(line, length)
        if length > SAME_PLACE:
            self.elements.append(Line(line, feed, self._offset, x0, c0, z0, x1, c1, z1))
            self._end = x1, c1, z1
        elif abs(z1 - z0) > SAME_PLACE:
            self.elements.append(Plunge(line, feed, z0, z1))
            self._end = x0, c0, z1
        self.x, self.c, self.z = x1, c1, z1

    def arc(
        self,
        turn: int,
        x: float | None = None,
        c: float | None = None,
        z: float | None = None,
        *,
        i: float | None = None,
        j: float | None = None,
        radius: float | None = None,
        line: int,
        feed: float,
    ) -> None:
        """Add a G2 (``turn`` -1) or G3 (``turn`` +1) to the absolute point given.

        Either ``i`` and/or ``j``: the centre from the arc's start, or ``radius``: negative for the
        arc over a half turn. The start as end point, or no end point, is a full circle with
        ``i``/``j``.
        """
        self._check_arc(turn, i, j, radius, line, feed)
        end = (self.x if x is None else x, self.c if c is None else c)
        z1 = self.z if z is None else z
        self._check_place(line, *end, z1)
        centre = dict(zip(self.names.centre.split(" and "), (i, j)))
        self._check_lengths(line, **centre, R=radius)
        if radius is None:
            centre, sweep = self._about_centre(turn, end, i or 0.0, j or 0.0, line)
        else:
            centre, sweep = self._with_radius(turn, end, radius, line)
        self.elements.append(Arc(line, feed, self._offset, *self._end, *end, z1, *centre, sweep))
        self.x, self.c, self.z = self._end = (*end, z1)

    def compensation(self, side: int, radius: float, *, line: int) -> None:
        """Switch to G40, G41 or G42 (``side`` 40, 41, 42) with the next block, which must be a G1.

        Call it before the :meth:`line` of the same block. ``radius`` is the tool's, and may be 0.
        """
        self._check_waiting()
        if side == self.side:
            return
        if 40 not in (side, self.side):
            self.refuse(
                line, f"G{side}: cancel G{self.side} of line {self._switched_on} with G40 first"
            )
        self._radius = radius if side != 40 else abs(self._offset)
        self._offset = {40: 0.0, 41: radius, 42: -radius}[side]
        self._switched_on = line
        self._switch = line
        self.side = side

    def continued(self, start: Start) -> Contour:
        """Return an empty contour that goes on where this one ended and the machine stands.

        For a section that is cut in two by a block that waits for the machine.
        """
        following = copy(self)
        following.elements, following.notes, following.start = [], [], start
        return following

    def mark(self, action: object, *, line: int) -> None:
        """Add a block without motion."""
        self._check_waiting()
        self.elements.append(Mark(line, action))

    def close(self, *, line: int) -> None:
        """Check that the section may end here: compensation is off."""
        self._check_waiting()
        if self.side != 40:
            self.refuse(
                line, f"G{self.side} of line {self._switched_on} is still on: G40 is missing"
            )

    def wait(self, *, line: int) -> None:
        """Check that M66 may wait for the machine here: compensation is off.

        Where the tool has to stop under compensation is told by the block behind, which is not
        known yet. LinuxCNC has the same rule.
        """
        if self.side != 40:
            self.refuse(
                line,
                "M66 waits for the machine, which needs G40: "
                f"G{self.side} of line {self._switched_on} is on",
            )

    def _check_place(self, line: int, x: float, c: float, z: float) -> None:
        self._check_lengths(line, **{self.names.x: x, self.names.c: c, self.names.z: z})

    def _check_lengths(self, line: int, **words: float | None) -> None:
        for word, value in words.items():
            if value is not None and abs(value) > LARGEST:
                reason = f"{word}{number(value)} is no length: at most {number(LARGEST)}"
                self.refuse(line, reason)

    def _check_feed(self, feed: float, line: int) -> None:
        if feed <= 0.0:
            self.refuse(line, f"F{number(feed)} must be above zero (no feed commanded?)")

    def _check_waiting(self) -> None:
        if self._switch is not None:
            either = f"{self.names.x} or {self.names.c}"
            self.refuse(self._switch, f"G{self.side} needs a G1 with {either} in its own block")

    def _check_switch(self, line: int, length: float) -> None:
        """Check the G1 that switches compensation on or off."""
        if self._switch is None:
            return
        if self._switch != line or length <= SAME_PLACE:
            self._check_waiting()
        if length < self._radius - SAME_PLACE:
            self.refuse(
                line,
                f"the G1 with G{self.side} is {number(length)} long: it must be at least "
                f"the tool radius {number(self._radius)}",
            )
        self._switch = None

    def _check_arc(self, turn, i, j, radius, line, feed) -> None:
        name, beside = _name(turn), abs(self._end[1] - self.c)
        self._check_feed(feed, line)
        if beside > SAME_PLACE:
            self.refuse(
                line,
                f"{name} needs a G1 with X or C before it: the tool stands {number(beside)} "
                "beside X's line (POLAR_TOOL_OFFSET)",
            )
        if self._switch is not None:
            self.refuse(line, f"G{self.side} with {name}: compensation is switched by a G1 only")
        if radius is not None and (i is not None or j is not None):
            self.refuse(line, f"{name}: either R or {self.names.centre}, not both")
        if radius is None and not i and not j:
            self.refuse(line, f"{name} needs R, or the centre in {self.names.centre}")

    def _about_centre(self, turn, end, i, j, line):
        """Return centre and sweep of an arc about a centre, which is equally far from both ends."""
        start, centre = self._end[:2], (self.x + i, self.c + j)
        if hypot(end[0] - start[0], end[1] - start[1]) <= SAME_PLACE:
            return centre, turn * 2 * pi
        from_start, from_end = hypot(i, j), hypot(end[0] - centre[0], end[1] - centre[1])
        if not self._closes(from_start, from_end):
            self.refuse(
                line,
                f"{_name(turn)} does not close: its centre is {number(from_start)} from the start, "
                f"{number(from_end)} from the end{self._hint(self._centre_closes, end, i, j)}",
            )
        centre = recentred(start, end, centre)
        return centre, sweep_between(start, end, centre, turn)

    def _with_radius(self, turn, end, radius, line):
        """Return centre and sweep of an arc with R."""
        start = self._end[:2]
        apart = hypot(end[0] - start[0], end[1] - start[1])
        half, name = 0.5 * apart, f"{_name(turn)} R{number(radius)}"
        if apart <= SAME_PLACE:
            self.refuse(line, f"{name}: a full circle needs {self.names.centre}, not R")
        if not self._spans(half, radius):
            self.refuse(
                line,
                f"{name} does not close: the ends are {number(apart)} apart, R must be at least "
                f"{number(half)}{self._hint(self._radius_closes, end, radius)}",
            )
        height = sqrt(max(0.0, radius * radius - half * half)) / apart
        height = copysign(height, turn * radius)
        centre = (
            0.5 * (start[0] + end[0]) - height * (end[1] - start[1]),
            0.5 * (start[1] + end[1]) + height * (end[0] - start[0]),
        )
        return centre, sweep_between(start, end, centre, turn)

    def _closes(self, from_start: float, from_end: float) -> bool:
        return abs(from_start - from_end) <= max(self.closing, CLOSING_RATIO * from_start)

    def _spans(self, half: float, radius: float) -> bool:
        return half - abs(radius) <= max(0.5 * self.closing, CLOSING_RATIO * half)

    def _centre_closes(self, x0, x1, c1, i, j) -> bool:
        return self._closes(hypot(i, j), hypot(x1 - x0 - i, c1 - self.c - j))

    def _radius_closes(self, x0, x1, c1, radius) -> bool:
        return self._spans(0.5 * hypot(x1 - x0, c1 - self.c), radius)

    def _hint(self, closes, end, *words) -> str:
        """Return which other reading of the X words, if any, would close the arc."""
        if self.diameter is None:
            return ""
        other, ratio = ("radius", 2.0) if self.diameter else ("diameter", 0.5)
        for x0 in (self.x * ratio, self.x):
            if closes(x0, end[0] * ratio, end[1], *words):
                return f"; it would close with X read as a {other} (POLAR_X = {other})"
        return ""


def _name(turn: int) -> str:
    return "G3" if turn > 0 else "G2"
