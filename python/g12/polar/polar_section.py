# SPDX-License-Identifier: GPL-2.0-or-later
"""A section on a part's face: an X slide and a C axis, with their feeds, in program order.

Words are lengths in the flat X-C plane, and Z at right angles to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, degrees, hypot, inf, pi, radians, remainder, sqrt

from g12.compensation.contour import Contour, Motion, PathElement, PlaneMove, Plunge, Start
from g12.errors import number
from g12.moves.exact_stops import Direction
from g12.moves.setup import RADIUS_TOLERANCE_MM, SectionKind, SectionMachine, StepMaker, check_entry
from g12.moves.steps import FaceMove, FaceSwitch, MachinePosition, SectionPlan, Split
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
        check_entry(start, machine, "XC", own)
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
    def pole_refused(self) -> bool:
        return self.machine.settings.polar_pole == "refuse"

    @property
    def face_limits(self) -> FaceLimits | None:
        """The limits on the face, None where sections are made of segments alone."""
        face = self.machine.face
        if not (face and self.machine.settings.polar_kinematics):
            return None
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
        return PolarSteps(contour, self).plan()


class PolarSteps(StepMaker):
    """Plans a contour on the face, with C's angle in the plane, which is 0 at the section's C."""

    def __init__(self, contour: Contour, kind: Polar) -> None:
        slide, self.angle, height = contour.start
        position = MachinePosition(slide, kind.state.c + degrees(self.angle), height)
        super().__init__(contour, kind, position)
        self._kind, self._zero, self._beside = kind, kind.state.c, kind.beside
        self._x = kind.in_program(kind.machine.axes["X"])
        self._c = radians(kind.machine.axes["C"].acceleration)
        self._on_face, self._face_angle = False, 0.0  # the angle is that of the face's X axis

    def acceleration(self, direction: Direction, point: complex) -> float:
        """Return 0 at the pole, where C would have to jump.

        Straight down and up, Z's acceleration is taken to be X's.
        """
        if point == POLE:
            return 0.0
        in_plane = complex(*direction[:2])
        if not in_plane:
            return self._x
        slide, slide_direction = slide_at(point, self._beside)
        along, around = along_and_around(in_plane, slide_direction)
        moved = max(abs(along + self._beside / slide * around), abs(direction[2]))
        return 1.0 / max(moved / self._x, abs(around) / (slide * self._c))

    def slide_at(self, point: complex) -> float:
        return slide_at(point, self._beside)[0]

    def routed(self, path: list[PathElement]) -> list[PathElement]:
        if self._beside:
            check_pole_distance(self.contour, path, self._beside, self.tolerance)
            return path
        reach = POLE_SHARE * self.tolerance
        return through_pole(self.contour, path, reach, self._kind.pole_refused)

    def end(self) -> Start:
        return super().end()._replace(angle=self.angle)

    def split(self, move: PlaneMove, deviation: float) -> Split:
        hold = 0.5 / (move.feed / 60.0) ** 2
        law = Law(deviation, RIPPLE, hold * self._x, hold * self._c)
        return split_move(move.curve, law, self._beside)

    def zero_angle(self, move: PlaneMove, split: Split) -> float:
        """Turn C at the pole, and to the end of the move."""
        if move.start == POLE:
            self._turn(move, split.angles[0])
        turns = round((self.angle - split.angles[0]) / (2 * pi))
        self.angle = split.angles[-1] + 2 * pi * turns
        return self._zero + 360.0 * turns

    def _turn(self, move: PlaneMove, angle: float) -> None:
        """Rotate C at the pole by the shorter turn; half a turn in the direction that unwinds C."""
        turn = remainder(angle - self.angle, 2 * pi)
        if abs(abs(turn) - pi) < NO_ROTATION:
            turn = copysign(pi, -self.angle)
        self.angle += turn
        if abs(turn) > NO_ROTATION:
            slide, _, height = self.position
            speed = self._kind.machine.axes["C"].velocity * 60
            segment = (slide, self._zero + degrees(self.angle), height, speed)
            self.run(move.line, "XC", [segment], True)

    def make_all(self, path: Sequence[PathElement], stopping: Sequence[bool]) -> None:
        limits = self._kind.face_limits
        if not limits:
            super().make_all(path, stopping)
            return
        divided = list(quickest(path, stopping, limits))
        for element, stop, stretch in divided:
            self._switch(element.line, stretch)
            if stretch and isinstance(element, Motion):
                self._cut_on_face(element)
            else:
                self.make(element, stop)
        self._switch(path[-1].line if path else 0, None)
        self.finish([element for element, _, _ in divided])

    def _switch(self, line: int, stretch: FaceStretch | None) -> None:
        """Switch to the face for a stretch of the path, or back (None), if not there already."""
        if (stretch is not None) is not self._on_face:
            self._on_face, self._face_angle = stretch is not None, self.angle
            self.steps.append(
                FaceSwitch(line, stretch is not None, self.position, *(stretch or ()))
            )

    def _cut_on_face(self, move: Motion) -> None:
        if isinstance(move, Plunge):
            points = [self.position._replace(height=move.h1)]
        else:
            there = positions_along(move, self.angle, self._beside)
            self.angle = there[-1][1]
            points = [
                MachinePosition(slide, self._zero + degrees(angle), height)
                for slide, angle, height in there
            ]
        self.steps.append(FaceMove(move.line, in_face(move, self._face_angle), points))
        self.position = points[-1]
