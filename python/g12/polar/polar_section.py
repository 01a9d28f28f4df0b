# SPDX-License-Identifier: GPL-2.0-or-later
"""A section on a part's face: an X slide and a C axis, with their feeds, in program order.

Words are lengths in the flat X-C plane, and Z at right angles to it.
"""

from __future__ import annotations

from functools import partial
from math import copysign, degrees, hypot, inf, pi, radians, remainder, sqrt
from typing import NamedTuple

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import Contour, Motion, PlaneMove, Plunge
from g12.errors import number
from g12.machine_ini import FaceAxes
from g12.moves.exact_stops import Direction, stops
from g12.moves.setup import (
    LEAST_MM,
    RADIUS_TOLERANCE_MM,
    SectionKind,
    SectionMachine,
    check_entry,
)
from g12.moves.steps import (
    ROUNDING_SHARE,
    FaceMove,
    FaceSwitch,
    MachinePosition,
    SectionPlan,
    Split,
    StepMaker,
)
from g12.polar.face import FaceLimits, in_face, positions_along
from g12.polar.pole import POLE, along_and_around, check_pole_distance, slide_at, through_pole
from g12.polar.quickest import FaceStretch, quickest
from g12.polar.segments import Law, split_move
from g12.section.effects import SectionStart, WordRules
from g12.section.line import AxisLetters, SectionWords, plain_line_of
from g12.state import YZ

POLE_SHARE = 0.5  # of the tolerance: a path nearer to the pole than this runs through it
NO_ROTATION = 1e-9  # radians: C does not turn
RIPPLE = 0.01  # relative: how much the speed may differ from F inside a segment
SEGMENTS_SHARE = 0.7  # of the speed that a chord's length and the acceleration allow: measured

POLAR_WORDS = SectionWords(
    plane="XCZ",
    axes=AxisLetters("X", "C", "Z"),
    turn_is_length=True,
    letters=(("X", "XU"), ("C", "CYH")),
    foreign={"u": "x", "h": "c", "y": "c"},
    relative={"U": "X", "H": "C"},
    plain=plain_line_of("XCZIJRF"),
    planes=frozenset({170, 180}),
    plane_name="X-C",
    refused={
        **dict.fromkeys("ABVW@^", "the section's words are X, C (or Y), Z, U and H"),
        "K": "the centre of an arc in the X-C plane is I and J",
    },
    own_block="Z needs a block of its own, or [G12] POLAR_Z = allow",
    origin="the origin must stay in the spindle's centre",
)


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


class Polar(SectionKind):
    """A section on the face; in a shape's, whose tool goes down along a ramp, Z may move with X."""

    words = POLAR_WORDS
    unwinds = True

    def __init__(
        self, start: SectionStart, machine: SectionMachine, *, in_shape: bool = False
    ) -> None:
        self.in_shape = in_shape
        self.beside = machine.settings.polar_tool_offset * start.state.machine_unit
        super().__init__(start, machine)

    def check(self, start: SectionStart) -> None:
        x, machine = start.state.x, self.machine
        above = f"needs the tool at X above zero, not at {number(x)} (radius)"
        own = ((start.state.plane != YZ, "needs G18 or G17, not G19"), (x > 0, above))
        check_entry(start, machine.letters, "XC", own)
        if machine.settings.polar_kinematics and not machine.face:
            raise start.location.refuse(
                "needs [KINS] KINEMATICS = polar_xzc for [G12] POLAR_KINEMATICS = 1"
            )

    def word_rules(self) -> WordRules:
        settings, g7 = self.machine.settings, self.state.diameter
        diameter = g7 if settings.polar_x == "inherit" else settings.polar_x == "diameter"
        return WordRules(
            diameter=diameter,
            x_scale=(0.5 if diameter else 1.0) / (0.5 if g7 else 1.0),  # the parser halves X in G7
            turn_scale=1.0,
            height_with_others=self.in_shape or settings.polar_z == "allow",
            rapid_feed=self.rapid_feed,
            radius_tolerance=RADIUS_TOLERANCE_MM * self.state.millimetre,
            beside=self.beside,
        )

    @property
    def planning(self) -> PolarSettings:
        settings, face = self.machine.settings, self.machine.face
        slide, c = self.machine.axes["X"], self.machine.axes["C"]
        return PolarSettings(
            tolerance=self.tolerance,
            least_x=LEAST_MM * self.state.millimetre,
            x_acceleration=self.in_program(slide),
            c_acceleration=c.acceleration,
            c_speed=c.velocity * 60,
            pole_refused=settings.polar_pole == "refuse",
            face=self._face_limits(face) if settings.polar_kinematics and face else None,
            beside=self.beside,
        )

    def _face_limits(self, face: FaceAxes) -> FaceLimits:
        c, slide = self.machine.axes["C"], self.in_program(face.slide)
        x, y = self.in_program(face.x), self.in_program(face.y)
        nearest = slide / radians(c.acceleration)  # least distance from the pole on the face
        chord = sqrt(8.0 * self.tolerance * nearest)
        speed = face.slide.velocity * self.state.machine_unit
        return FaceLimits(
            acceleration=hypot(x, y),
            round_acceleration=min(x, y),
            slide_acceleration=slide,
            c_acceleration=radians(c.acceleration),
            c_speed=radians(c.velocity),
            override=max(1.0, face.override),
            segments_speed=SEGMENTS_SHARE * sqrt(slide * chord),
            slide_speed=speed if self.beside else inf,  # else X's own
            beside=self.beside,
        )

    def plan(self, contour: Contour) -> SectionPlan:
        return plan(contour, self.planning, c=self.state.c)


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
        if face and isinstance(element, Motion):
            machine.cut_on_face(element)
        else:
            machine.make(element, stop)
    machine.switch(path[-1].line if path else 0, None)
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
        slide, self.angle, height = contour.start
        position = MachinePosition(slide, c + degrees(self.angle), height)
        super().__init__(contour, position, POLAR_WORDS.axes, settings.least_x)
        self._settings, self._zero = settings, c
        self._on_face, self._face_angle = False, 0.0  # the angle is that of the face's X axis

    def cut(self, move: PlaneMove, stop: bool) -> None:
        settings, hold = self._settings, 0.5 / (move.feed / 60.0) ** 2
        holds = hold * settings.x_acceleration, hold * radians(settings.c_acceleration)

        def split(deviation: float) -> Split:
            return split_move(move.curve, Law(deviation, RIPPLE, *holds), settings.beside)

        ends = self._split(move, split, settings.tolerance, stop)
        if move.start == POLE:
            self._turn(move, ends.angles[0])
        turns = round((self.angle - ends.angles[0]) / (2 * pi))
        self.angle = ends.angles[-1] + 2 * pi * turns
        self._segments(move, ends, self._zero + 360.0 * turns, stop)

    def switch(self, line: int, stretch: FaceStretch | None) -> None:
        """Switch to the face for a stretch of the path, or back (None), if not there already."""
        if (stretch is not None) is not self._on_face:
            self._on_face, self._face_angle = stretch is not None, self.angle
            self.steps.append(
                FaceSwitch(line, stretch is not None, self.position, *(stretch or ()))
            )

    def cut_on_face(self, move: Motion) -> None:
        if isinstance(move, Plunge):
            points = [self.position._replace(height=move.h1)]
        else:
            there = positions_along(move, self.angle, self._settings.beside)
            self.angle = there[-1][1]
            points = [
                MachinePosition(slide, self._zero + degrees(angle), height)
                for slide, angle, height in there
            ]
        self.steps.append(FaceMove(move.line, in_face(move, self._face_angle), points))
        self.position = points[-1]

    def slide_at(self, point: complex) -> float:
        return slide_at(point, self._settings.beside)[0]

    def _turn(self, move: PlaneMove, angle: float) -> None:
        """Rotate C at the pole by the shorter turn; half a turn in the direction that unwinds C."""
        turn = remainder(angle - self.angle, 2 * pi)
        if abs(abs(turn) - pi) < NO_ROTATION:
            turn = copysign(pi, -self.angle)
        self.angle += turn
        if abs(turn) > NO_ROTATION:
            slide, _, height = self.position
            segment = (slide, self._zero + degrees(self.angle), height, self._settings.c_speed)
            self._run(move.line, "XC", [segment], True)
