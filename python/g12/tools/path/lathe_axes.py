# SPDX-License-Identifier: GPL-2.0-or-later
"""The limits of a lathe's axes, in a section and on the face of the kinematics.

Lengths are millimetres, angles degrees, times seconds.
"""

import math
from typing import NamedTuple

import numpy as np

from g12.machine_ini import face_of
from g12.tools.machine.ini import Ini

AT_POLE = 1e-7  # mm
LEAST = 1e-12


class Rates(NamedTuple):
    """The greatest speed and acceleration of an axis."""

    speed: float
    acceleration: float


class LatheAxes(NamedTuple):
    """The limits of the X slide, of Z and of C.

    ``face`` are the accelerations of X and of Y on the face of the kinematics, empty without them.
    ``tolerance`` is POLAR_TOLERANCE, ``beside`` the tool's distance from the X line, ``period`` the
    servo's.
    """

    slide: Rates
    z: Rates
    c: Rates
    face: tuple[float, ...] = ()
    tolerance: float = 0.0
    beside: float = 0.0
    period: float = 1e-3

    @property
    def x_acceleration(self) -> float:
        """The acceleration of the axis X; on the kinematics' face it is not the slide's."""
        return self.face[0] if self.face else self.slide.acceleration

    @property
    def c_radians(self) -> Rates:
        return Rates(*map(math.radians, self.c))

    @property
    def most_c_speed(self) -> float:
        """C's greatest speed in motion.

        Where LinuxCNC blends it adds half the acceleration of a servo period.
        """
        return self.c.speed + self.c.acceleration * self.period / 2

    def along(self, direction: np.ndarray, place: np.ndarray, surface: float) -> float:
        """Return the greatest acceleration along a direction (3,) at a place (3,) of the part.

        ``surface`` is the radius of the cylinder that it is on, 0 of the face.
        """
        c, x, z = self.c_radians.acceleration, self.x_acceleration, self.z.acceleration
        if surface:
            return 1.0 / max(*(abs(direction) / (surface * c, z, x)), LEAST)
        tool, heading = complex(*place[:2]), complex(*direction[:2])
        radius = max(abs(tool), AT_POLE)
        slide = max(math.sqrt(max(0.0, radius**2 - self.beside**2)), AT_POLE)
        turned = heading * tool.conjugate() * (slide + 1j * self.beside) / radius**2
        moved = abs(turned.real + self.beside / slide * turned.imag)
        linear = max(moved, abs(direction[2])) / max(x, z)
        return 1.0 / max(linear, abs(turned.imag) / (slide * c), LEAST)


def lathe_axes(ini: Ini) -> LatheAxes:
    """Return the limits in an INI; the slide's are those of its joint with kinematics."""
    axes, face, mm = ini.axis_limits, face_of(ini.get), ini.mm
    slide, c = (face.slide if face else axes["X"]), axes["C"]
    z = axes.get("Z", slide)  # check estimates lathes without Z as well
    return LatheAxes(
        Rates(slide.velocity * mm, slide.acceleration * mm),
        Rates(z.velocity * mm, z.acceleration * mm),
        Rates(c.velocity, c.acceleration),
        (face.x.acceleration * mm, face.y.acceleration * mm) if face else (),
        ini.settings.tolerance(mm) * mm,
        ini.tool_beside,
        ini.servo_period,
    )
