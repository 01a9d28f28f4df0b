# SPDX-License-Identifier: GPL-2.0-or-later
"""Cylindrical interpolation: a contour on the unrolled surface becomes moves of Z and a C axis.

A slide runs along the cylinder, a rotary axis turns it. On a surface of radius r an angle is r
times the angle in radians long. The slide and that length are proportional to the axes' positions:
a line is exactly one segment. The segments of an arc bulge equally everywhere; spacing shares the
deviation between them. `section`, `compensation` and `moves` hold what polar mode shares.

The unrolled surface is viewed from outside, so G2 is clockwise there and G41 has the tool on the
left, whatever plane is active. An arc's centre are lengths on the surface from the arc's start.

| machine | to the right | upwards | at right angles | an arc's centre |
|---|---|---|---|---|
| lathe | C | Z | X | J (or I), K |
| mill with A, which turns about X | X | A, the other way | Z | I, J |
| mill with B, which turns about Y | B | Y | Z | I, J |

LinuxCNC's positive A turns the part so that the tool moves to Y- on it, by the right-hand rule.
"""

from __future__ import annotations

import cmath
from math import copysign, degrees, radians, sqrt
from typing import ClassVar

from g12.compensation.contour import Contour, PlaneMove
from g12.errors import number
from g12.geometry.curve import Arc
from g12.lengths import LARGEST
from g12.moves.exact_stops import Direction
from g12.moves.setup import RADIUS_TOLERANCE_MM, SectionKind, StepMaker, check_entry
from g12.moves.steps import BULGE, MachinePosition, SectionPlan, Split, spaced
from g12.section.effects import SectionStart, WordRules
from g12.section.line import AxisLetters, SectionWords, plain_line_of

LEAST_DENSITY = 2.0  # segments per radian of an arc: fewer do not resemble it

ORIGIN = "the origin must stay where it is inside the section"
CYLINDER_WORDS = SectionWords(
    plane="CZX",
    axes=AxisLetters("Z", "C", "X"),
    letters=(("X", "XU"), ("Z", "ZW"), ("C", "CH"), ("the centre along C", "IJ")),
    foreign={"u": "x", "w": "z", "h": "c"},
    relative={"U": "X", "W": "Z", "H": "C"},
    plain=plain_line_of("XCZRF"),
    planes=frozenset({170, 180, 190}),
    plane_name="Z-C",
    centre=("JI", "K"),
    centre_name="J and K",
    refused=dict.fromkeys("ABVY@^", "the section's words are Z, C, X, W, H and U"),
    own_block="X needs a block of its own, or [G12] CYLINDER_X = allow",
    origin=ORIGIN,
)


def words_on_mill(plane: str, axes: AxisLetters, across: str) -> SectionWords:
    """Return the words on a mill; ``across`` is the axis that stands on the axis of rotation."""
    slide, turn, height = axes
    others = "".join(letter for letter in "ABCUVWHK@^" if letter != turn)
    return SectionWords(
        plane=plane,
        axes=axes,
        foreign={},
        relative={},
        plain=plain_line_of(f"{slide}{turn}{height}IJRF"),
        planes=frozenset({170}),
        plane_name=f"{plane[0]}-{plane[1]}",
        refused={
            **dict.fromkeys(others, f"the section's words are {slide}, {turn}, {height}, I and J"),
            across: f"{across} stays on the axis of rotation inside the section",
        },
        own_block=f"{height} needs a block of its own, or [G12] CYLINDER_X = allow",
        origin=ORIGIN,
    )


class Cylinder(SectionKind):
    """A section on a turned surface; this one is of a lathe's Z slide and its C axis."""

    words = CYLINDER_WORDS
    on_words = "C"

    def check(self, start: SectionStart) -> None:
        self.check_machine(start)
        letter = self.on_words
        word = start.words.get(letter)
        if word is None:
            rule = f"needs {letter}, the cylinder's radius; {letter}0 ends a section"
            raise start.location.refuse(rule)
        if not 0.0 < word <= LARGEST:
            rule = f"must be above 0 and at most {number(LARGEST)}"
            raise start.location.refuse(f"{letter}{number(word)}, the cylinder's radius, {rule}")
        self.surface = word * (0.5 if self.machine.settings.cylinder_word == "diameter" else 1.0)

    def check_machine(self, start: SectionStart) -> None:
        check_entry(start, self.machine, "XZC")

    @property
    def per_radian(self) -> float:
        """The length to the right or upwards of a radian of the rotary axis."""
        return self.surface

    def word_rules(self) -> WordRules:
        return WordRules(
            diameter=self.state.diameter,
            x_scale=1.0,
            turn_scale=radians(self.per_radian),
            height_with_others=self.machine.settings.cylinder_x == "allow",
            rapid_feed=self.rapid_feed,
            radius_tolerance=RADIUS_TOLERANCE_MM * self.state.millimetre,
        )

    def plan(self, contour: Contour) -> SectionPlan:
        return CylinderSteps(contour, self).plan()


class CylinderOnMill(Cylinder):
    """A section of a mill with A, which turns about X.

    ``across`` is the axis that stands on the axis of rotation, ``sense`` is 1 where a positive
    angle leads to the right or upwards.
    """

    words = words_on_mill("XAZ", AxisLetters("X", "A", "Z"), across="Y")
    on_words = "A"
    across: ClassVar[str] = "Y"
    sense: ClassVar[float] = -1.0

    def check_machine(self, start: SectionStart) -> None:
        check_entry(
            start,
            self.machine,
            "".join(self.words.axes),
            centred="Z",
            across=self.across,
            centre="the axis of rotation",
        )

    @property
    def per_radian(self) -> float:
        turned = -1.0 if self.machine.settings.rotary_sense == "reversed" else 1.0
        return self.surface * self.sense * turned


class CylinderOnMillWithB(CylinderOnMill):
    """A section of a mill with B, which turns about Y."""

    words = words_on_mill("BYZ", AxisLetters("Y", "B", "Z"), across="X")
    on_words = "B"
    across = "X"
    sense = 1.0


# By the letter of the rotary axis.
CYLINDERS: dict[str, type[Cylinder]] = {
    kind.on_words: kind for kind in (Cylinder, CylinderOnMill, CylinderOnMillWithB)
}


class CylinderSteps(StepMaker):
    """Plans a contour on the unrolled surface."""

    def __init__(self, contour: Contour, kind: Cylinder) -> None:
        slide, angle, height = contour.start
        super().__init__(contour, kind, MachinePosition(slide, degrees(angle), height))
        along, turn, deep = (kind.machine.axes[letter] for letter in self.letters)
        self._per_radian = kind.per_radian
        self._turn_is_first = kind.words.plane[0] == self.letters.turn
        self._slide, self._height = kind.in_program(along), kind.in_program(deep)
        self._surface = abs(kind.per_radian) * radians(turn.acceleration)

    def acceleration(self, direction: Direction, _point: complex) -> float:
        """Return the acceleration, which is the same everywhere."""
        *in_plane, deep = map(abs, direction)
        along, around = self._slide_and_around(complex(*in_plane))
        return 1.0 / max(around / self._surface, along / self._slide, deep / self._height)

    def slide_at(self, point: complex) -> float:
        return self._slide_and_around(point)[0]

    def _slide_and_around(self, point: complex) -> tuple[float, float]:
        """Return a point of the plane as the slide's position and the length around."""
        return (point.imag, point.real) if self._turn_is_first else (point.real, point.imag)

    def split(self, move: PlaneMove, deviation: float) -> Split:
        """Return where the segments of a move on the cylinder end: slide, angle and length."""
        if isinstance(move.curve, Arc):
            points, lengths = _along_arc(move.curve, deviation)
        else:
            points, lengths = [move.start, move.end], [0.0, move.length]
        slides, around = zip(*map(self._slide_and_around, points))
        return Split(list(slides), [length / self._per_radian for length in around], lengths)


def _along_arc(arc: Arc, deviation: float) -> tuple[list[complex], list[float]]:
    """Return the ends of an arc's segments, and the length of the arc up to them."""
    radius, turn = arc.radius, copysign(1.0, arc.sweep)
    bulging = sqrt(radius / (8.0 * BULGE * deviation))
    segments = max(bulging, LEAST_DENSITY)
    density = (segments, (bulging / segments) ** 2)
    angles, shares = spaced(abs(arc.sweep), lambda _: density)
    outward = (arc.start - arc.centre) / radius
    points = [
        arc.centre + (radius + deviation * share) * outward * cmath.rect(1.0, turn * angle)
        for angle, share in zip(angles, shares)
    ]
    points[0], points[-1] = arc.start, arc.end
    return points, [radius * angle for angle in angles]
