# SPDX-License-Identifier: GPL-2.0-or-later
"""What the axes of a lathe can do in a section, and what a move there demands of them.

Lengths are millimetres, times seconds.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.machine_ini import face_of
from g12.tools.machine.ini import Ini
from g12.tools.path.face_follow import FaceDemand, FollowLimits, crosses_face, demand
from g12.tools.path.track import Track

AT_POLE = 1e-7  # mm
LEAST = 1e-12


class SectionAxes(NamedTuple):
    """Accelerations of X and Z, of C in radians, per second²; C's greatest speed in degrees/s.

    ``slide`` and ``slide_speed`` are what the X slide can do on the face of the kinematics, 0
    without them. ``beside`` is the tool's distance from the X line, ``period`` the servo's.
    """

    x: float
    z: float
    c: float
    c_speed: float
    slide: float = 0.0
    slide_speed: float = math.inf
    beside: float = 0.0
    period: float = 1e-3

    @property
    def most_c_speed(self) -> float:
        """C's greatest speed in motion, degrees/s.

        Where LinuxCNC blends it adds half the acceleration of a servo period.
        """
        return self.c_speed + math.degrees(self.c) * self.period / 2

    def along(self, direction: np.ndarray, place: np.ndarray, surface: float) -> float:
        """Return the greatest acceleration along a direction (3,) at a place (3,) of the part.

        ``surface`` is the radius of the cylinder that it is on, 0 of the face.
        """
        if surface:
            limits = surface * self.c, self.z, self.x
            return 1.0 / max(*(abs(direction) / limits), LEAST)
        tool, heading = complex(*place[:2]), complex(*direction[:2])
        radius = max(abs(tool), AT_POLE)
        slide = max(math.sqrt(max(0.0, radius**2 - self.beside**2)), AT_POLE)
        seen = heading * tool.conjugate() * (slide + 1j * self.beside) / radius**2
        moved = abs(seen.real + self.beside / slide * seen.imag)
        linear = max(moved, abs(direction[2])) / max(self.x, self.z)
        return 1.0 / max(linear, abs(seen.imag) / (slide * self.c), LEAST)

    def demand(self, path: Track, index: int, faster: float = 1.0) -> FaceDemand | None:
        """Return what a move demands at its feed times a factor; None off the kinematics' face.

        X and Y together have more acceleration than each along a line: ``faster`` is of that.
        """
        move = path.moves[index]
        if not (self.slide and crosses_face(move)):
            return None
        plane = move.acceleration * self.x
        plane = plane * math.sqrt(2.0) if faster > 1.0 and move.kind != "arc" else plane
        speeds = math.radians(self.c_speed), self.slide_speed
        limits = FollowLimits(plane, self.slide, self.c, *speeds)
        return demand(
            move, faster * path.part_feed(index) / 60.0, path.part.centre, self.beside, limits
        )


def axes_of_section(ini: Ini) -> SectionAxes:
    """Return what the axes of an INI can do."""
    x, z, c = (ini.axis_limits[letter] for letter in "XZC")
    linear, face = (x.acceleration * ini.mm, z.acceleration * ini.mm), face_of(ini.get)
    slide = face.slide.acceleration * ini.mm if face else 0.0
    slide_speed = face.slide.velocity * ini.mm if face else math.inf
    rotary = math.radians(c.acceleration), c.velocity
    return SectionAxes(*linear, *rotary, slide, slide_speed, ini.tool_beside, ini.servo_period)
