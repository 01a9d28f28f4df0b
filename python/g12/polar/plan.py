# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a polar section: pieces in X and C, with their feeds, in the order of the program."""

from __future__ import annotations

from copy import copy
from math import copysign, degrees, hypot, pi, radians, remainder
from typing import NamedTuple

from g12.errors import Refusal
from g12.flat.contour import Arc, Contour, Line, Mark, Plunge, Start, is_move
from g12.flat.offset import tool_path
from g12.flat.simplify import with_points_left_out, without_short_moves
from g12.polar.exact_stops import stops
from g12.polar.face import FaceLimits, FaceMove, FaceSwitch, chosen, in_face, parted, passed
from g12.polar.feed import Position, pieces_with_feed
from g12.polar.pieces import Law, Split, split_move
from g12.polar.pole import POLE, through_pole
from g12.polar.spacing import MOST_PIECES, TooManyPieces

CHORD_SHARE = 0.96  # of the tolerance: the rest is what the estimate of it may lack
STOP_SHARE = (
    0.7  # of the tolerance: a move that stops starts quicker, and cuts deeper into the path
)
ROUNDING_SHARE = 0.5  # of the tolerance: at a corner, beside the pieces' own deviation
SHORT_SHARE = 0.3  # of the tolerance: a shorter move under compensation is rounding
POLE_SHARE = 0.5  # of the tolerance: a path that near to the pole runs through it
LEFT_OVER = 1e-3  # of the least step in X: less than that is rounding
SAME_ANGLE = 1e-9  # radians
RIPPLE = 0.01  # by so much may the speed differ from F inside a piece


class PolarSettings(NamedTuple):
    """What the machine and its owner want of a section; lengths in program units."""

    tolerance: float  # POLAR_TOLERANCE
    least_x: float  # 0.001 mm: no piece with a turn of C changes X by less, other than not at all
    x_acceleration: float  # per second squared
    c_acceleration: float  # degrees per second squared
    c_speed: float  # degrees per minute, for a turn in place at X0
    pole_refused: bool = False  # POLAR_POLE = refuse
    face: FaceLimits | None = None  # POLAR_KINEMATICS = 1


class BlockMoves(NamedTuple):
    """G1 moves of one block, one after the other, all in G90 and G94.

    ``axes`` is "XC", "XCZ" or "Z": the words to write. Each piece is ``(x, c, z, feed)``: X radius
    value, C in degrees, continuous over the section (it may leave 0..360), and F as G94 wants it:
    for the X and Z part of the move, or in degrees per minute where neither changes; it may be
    small, so write it with six significant digits. A piece that keeps X repeats the same number.
    With ``stop`` the last piece must end in an exact stop (G61), because LinuxCNC would round the
    corner by more than the tolerance.
    """

    line: int
    axes: str
    pieces: list[tuple[float, float, float, float]]
    stop: bool


class PolarPlan(NamedTuple):
    """The moves of a section.

    ``steps`` holds each :class:`BlockMoves` (on the face :class:`FaceMove`, with a
    :class:`FaceSwitch` in front and behind), and each mark's action, in order. ``place`` is where
    the machine stands in the end. ``notes`` are for the operator.
    """

    steps: list
    place: Position
    angle: float  # of the C axis in the plane, radians
    notes: list[str]


def plan(contour: Contour, settings: PolarSettings, *, c: float) -> PolarPlan:
    """Return the moves of a whole section.

    ``c`` is the C axis in degrees at the plane's zero angle. Raises Refusal, naming the blocks by
    their lines, when the contour cannot be cut as programmed.
    """
    path, moved = _centre_path(contour, settings.tolerance)
    tolerance = settings.tolerance - moved
    settings = settings._replace(tolerance=tolerance)
    path = through_pole(contour, path, POLE_SHARE * tolerance, settings.pole_refused)
    stopping = stops(
        path, ROUNDING_SHARE * tolerance, settings.x_acceleration, radians(settings.c_acceleration)
    )
    machine = _SlideAndSpindle(contour, settings, c)
    faced = [False] * len(path)
    if settings.face:
        path, stopping = parted(path, stopping, settings.face)
        faced = chosen(path, settings.face)
    for element, stop, face in zip(path, stopping, faced):
        machine.switch(element.line, face)
        if isinstance(element, Mark):
            machine.steps.append(element.action)
        elif face:
            machine.cut_on_face(element)
        elif isinstance(element, Plunge):
            machine.plunge(element, stop)
        else:
            machine.cut(element, stop)
    machine.finish(path)
    return PolarPlan(machine.steps, machine.place, machine.angle, contour.notes)


def _centre_path(contour: Contour, tolerance: float) -> tuple[list, float]:
    """Return the path of the tool's centre, and by how much the contour was moved for it.

    Points nearer to each other than their last decimal allows make corners that no tool reaches:
    where a contour would be refused, it is tried without them.
    """
    limit = SHORT_SHARE * tolerance
    meant, moved = without_short_moves(contour.elements, limit)
    try:
        return tool_path(contour, meant, tolerance - moved), moved
    except Refusal as refusal:
        fewer, left_out = with_points_left_out(meant, limit - moved)
        if len(fewer) == len(meant):
            raise
        try:
            return tool_path(contour, fewer, tolerance - moved - left_out), moved + left_out
        except Refusal:
            raise refusal from None


def resume(contour: Contour, planned: PolarPlan) -> Contour:
    """Return an empty contour that goes on where a planned one ended.

    For a section that is cut in two by a block that waits for the machine. Plan it with the same
    ``c``.
    """
    following = copy(contour)
    following.elements, following.notes = [], []
    following.start = Start(planned.place.x, planned.angle, planned.place.z)
    return following


class _SlideAndSpindle:
    """The X slide and the C axis, making one element after the other."""

    def __init__(self, contour: Contour, settings: PolarSettings, c: float) -> None:
        x, self.angle, z = contour.start
        self.steps: list = []
        self.place = Position(x, c + degrees(self.angle), z)
        self._contour, self._settings, self._entry = contour, settings, c
        self._face: float | None = None  # angle of its X axis, while the machine is on it
        self._laws: dict[tuple[float, bool], Law] = {}

    def cut(self, move: Line | Arc, stop: bool) -> None:
        """Add the pieces of a move in the plane."""
        parts = self._split(move, self._law(move.feed, stop))
        if (move.x0, move.c0) == POLE:
            self._turn(move, parts.angles[0])
        turns = round((self.angle - parts.angles[0]) / (2 * pi))
        entry = self._entry + 360.0 * turns
        pieces = pieces_with_feed(parts, self.place, move, entry, self._settings.least_x)
        self.angle = parts.angles[-1] + 2 * pi * turns
        self._run(move.line, "XC" if move.z0 == move.z1 else "XCZ", pieces, stop)

    def _split(self, move: Line | Arc, law: Law) -> Split:
        try:
            return split_move(move, law)
        except TooManyPieces:
            self._contour.refuse(
                move.line,
                f"more than {MOST_PIECES} moves would be needed to stay within POLAR_TOLERANCE",
            )

    def switch(self, line: int, face: bool) -> None:
        """Go to the face or back from it, if it is another way than before."""
        if face is not (self._face is not None):
            self._face = self.angle if face else None
            self.steps.append(FaceSwitch(line, face, self.place))

    def cut_on_face(self, move: Line | Arc | Plunge) -> None:
        """Add a move on the face as it is."""
        if isinstance(move, Plunge):
            places = [(*self.place[:2], move.z1)]
        else:
            there = passed(move, self.angle)
            self.angle = there[-1][1]
            places = [(radius, self._entry + degrees(angle), z) for radius, angle, z in there]
        self.steps.append(FaceMove(move.line, in_face(move, self._face), places))
        self.place = Position(*places[-1])

    def plunge(self, move: Plunge, stop: bool) -> None:
        """Add a move of Z alone."""
        self._run(move.line, "Z", [(self.place.x, self.place.c, move.z1, move.feed)], stop)

    def finish(self, path: list) -> None:
        """Come back from the face; add what the last piece left over of X."""
        self.switch(path[-1].line if path else 0, face=False)
        moves = [element for element in path if is_move(element)]
        radius = hypot(moves[-1].x1, moves[-1].c1) if moves else self.place.x
        if abs(radius - self.place.x) > LEFT_OVER * self._settings.least_x:
            self._run(moves[-1].line, "XC", [(radius, *self.place[1:], moves[-1].feed)], True)

    def _turn(self, move: Line | Arc, angle: float) -> None:
        """Add a turn in place, the shorter way; of two equal ways the one that unwinds C."""
        turn = remainder(angle - self.angle, 2 * pi)
        if abs(abs(turn) - pi) < SAME_ANGLE:
            turn = copysign(pi, -self.angle)
        self.angle += turn
        if abs(turn) > SAME_ANGLE:
            x, _, z = self.place
            piece = (x, self._entry + degrees(self.angle), z, self._settings.c_speed)
            self._run(move.line, "XC", [piece], True)

    def _run(self, line: int, axes: str, pieces: list, stop: bool) -> None:
        if pieces:
            self.steps.append(BlockMoves(line, axes, pieces, stop))
            self.place = Position(*pieces[-1][:3])

    def _law(self, feed: float, stop: bool) -> Law:
        law = self._laws.get((feed, stop))
        if law is None:
            settings = self._settings
            hold = 0.5 / (feed / 60.0) ** 2
            law = self._laws[feed, stop] = Law(
                (STOP_SHARE if stop else CHORD_SHARE) * settings.tolerance,
                RIPPLE,
                hold * settings.x_acceleration,
                hold * radians(settings.c_acceleration),
            )
        return law
