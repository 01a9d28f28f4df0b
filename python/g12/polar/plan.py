# SPDX-License-Identifier: GPL-2.0-or-later
"""The plan of a polar section: segments in X and C with their feeds, in program order."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from math import copysign, degrees, pi, radians, remainder
from typing import NamedTuple

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import Contour, Mark, PathElement, PlaneMove, Plunge
from g12.moves.exact_stops import Direction, stops
from g12.moves.feed import Split, segments_with_feed
from g12.moves.steps import ROUNDING_SHARE, MachinePosition, SectionPlan, StepMaker
from g12.polar.face import FaceMove, FaceSwitch, in_face, positions_along
from g12.polar.follow import FaceLimits
from g12.polar.pole import (
    POLE,
    along_and_around,
    check_pole_distance,
    slide_at,
    through_pole,
)
from g12.polar.quickest import FaceStretch, quickest
from g12.polar.segments import Law, split_move

POLE_SHARE = 0.5  # of the tolerance: a path nearer to the pole than this runs through it
NO_ROTATION = 1e-9  # radians: C does not turn
RIPPLE = 0.01  # relative: how much the speed may differ from F inside a segment


class PolarSettings(NamedTuple):
    """The machine's limits and the owner's settings for a section; lengths in program units."""

    tolerance: float  # POLAR_TOLERANCE
    least_x: float  # 0.001 mm: a segment that turns C changes X by this at least, or not at all
    x_acceleration: float  # per second squared
    c_acceleration: float  # degrees per second squared
    c_speed: float  # degrees per minute, for a rotation at the pole at X0
    pole_refused: bool = False  # POLAR_POLE = refuse
    face: FaceLimits | None = None  # POLAR_KINEMATICS = 1
    beside: float = 0.0  # POLAR_TOOL_OFFSET


def plan(contour: Contour, settings: PolarSettings, *, c: float) -> SectionPlan:
    """Return the moves of a whole section.

    ``c`` is the C axis in degrees at the plane's zero angle. Raises Refusal, naming the blocks by
    their lines, when the contour cannot be cut as programmed.
    """
    path, moved = centre_path(contour, settings.tolerance)
    tolerance = settings.tolerance - moved
    settings = settings._replace(tolerance=tolerance)
    if settings.beside:
        check_pole_distance(contour, path, settings.beside, tolerance)
    else:
        path = through_pole(contour, path, POLE_SHARE * tolerance, settings.pole_refused)
    quick = partial(
        quickness,
        x_acceleration=settings.x_acceleration,
        c_acceleration=settings.c_acceleration,
        beside=settings.beside,
    )
    stopping = stops(path, ROUNDING_SHARE * tolerance, quick)
    machine = _SlideAndSpindle(contour, settings, c)
    stretches: list[FaceStretch | None] = [None] * len(path)
    if settings.face:
        path, stopping, stretches = quickest(path, stopping, settings.face)
    for element, stop, face in zip(path, stopping, stretches):
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
    return SectionPlan(machine.steps, machine.position, machine.angle, contour.notes)


def quickness(
    direction: Direction,
    point: complex,
    *,
    x_acceleration: float,
    c_acceleration: float,
    beside: float,
) -> float:
    """Return the greatest acceleration along a direction at a point that both axes allow.

    ``c_acceleration`` in degrees per second squared, the tool is ``beside`` X's line. 0 at the
    pole, where C would have to jump; straight down and up, Z's acceleration is taken to be X's.
    """
    if point == POLE:
        return 0.0
    in_plane = complex(*direction[:2])
    if not in_plane:
        return x_acceleration
    slide, slide_direction = slide_at(point, beside)
    along, around = along_and_around(in_plane, slide_direction)
    moved = max(abs(along + beside / slide * around), abs(direction[2]))
    return 1.0 / max(moved / x_acceleration, abs(around) / (slide * radians(c_acceleration)))


class _SlideAndSpindle(StepMaker):
    def __init__(self, contour: Contour, settings: PolarSettings, c: float) -> None:
        x, self.angle, z = contour.start
        super().__init__(contour, MachinePosition(x, c + degrees(self.angle), z))
        self._settings, self._entry = settings, c
        self._on_face, self._face_angle = False, 0.0  # the angle is that of the face's X axis

    def cut(self, move: PlaneMove, stop: bool) -> None:
        settings = self._settings
        split = partial(self._split_move, move)
        ends = self._split(move, split, settings.tolerance, stop, settings.least_x)
        if move.start == POLE:
            self._turn(move, ends.angles[0])
        turns = round((self.angle - ends.angles[0]) / (2 * pi))
        entry = self._entry + 360.0 * turns
        segments = segments_with_feed(ends, self.position, move, entry, settings.least_x)
        self.angle = ends.angles[-1] + 2 * pi * turns
        self._run(move.line, "XC" if move.z0 == move.z1 else "XCZ", segments, stop)

    def _split_move(self, move: PlaneMove, deviation: float) -> Split:
        law = self._law(move.feed, deviation)
        return split_move(move.curve, law, self._settings.beside)

    def switch(self, line: int, stretch: FaceStretch | None) -> None:
        """Switch to the face for a stretch of the path, or back (None), if not there already."""
        if (stretch is not None) is not self._on_face:
            self._on_face, self._face_angle = stretch is not None, self.angle
            self.steps.append(
                FaceSwitch(line, stretch is not None, self.position, *(stretch or ()))
            )

    def cut_on_face(self, move: PlaneMove | Plunge) -> None:
        if isinstance(move, Plunge):
            points = [(*self.position[:2], move.z1)]
        else:
            there = positions_along(move, self.angle, self._settings.beside)
            self.angle = there[-1][1]
            points = [(slide, self._entry + degrees(angle), z) for slide, angle, z in there]
        self.steps.append(FaceMove(move.line, in_face(move, self._face_angle), points))
        self.position = MachinePosition(*points[-1])

    def plunge(self, move: Plunge, stop: bool) -> None:
        self._run(move.line, "Z", [(self.position.x, self.position.c, move.z1, move.feed)], stop)

    def finish(self, path: Sequence[PathElement]) -> None:
        """Switch back from the face; add the remainder of the last segments in X and Z."""
        self.switch(path[-1].line if path else 0, None)
        slide, z = self.position.x, self.position.z
        for element in path:
            z = z if isinstance(element, Mark) else element.z1
        moves = [element for element in path if isinstance(element, PlaneMove)]
        if moves:
            slide, _ = slide_at(moves[-1].end, self._settings.beside)
        self._add_remainder(path, slide, z, self._settings.least_x)

    def _turn(self, move: PlaneMove, angle: float) -> None:
        """Rotate C at the pole by the shorter turn; half a turn in the direction that unwinds C."""
        turn = remainder(angle - self.angle, 2 * pi)
        if abs(abs(turn) - pi) < NO_ROTATION:
            turn = copysign(pi, -self.angle)
        self.angle += turn
        if abs(turn) > NO_ROTATION:
            x, _, z = self.position
            segment = (x, self._entry + degrees(self.angle), z, self._settings.c_speed)
            self._run(move.line, "XC", [segment], True)

    def _law(self, feed: float, deviation: float) -> Law:
        settings, hold = self._settings, 0.5 / (feed / 60.0) ** 2
        c_hold = hold * radians(settings.c_acceleration)
        return Law(deviation, RIPPLE, hold * settings.x_acceleration, c_hold)
