# SPDX-License-Identifier: GPL-2.0-or-later
"""From what a section finds and the machine's settings to the values it is read and planned by."""

from __future__ import annotations

from collections.abc import Collection
from math import hypot, radians, sqrt
from typing import NamedTuple

from g12.errors import number
from g12.lengths import is_inch
from g12.machine_ini import Axis, FaceAxes
from g12.polar.face import FaceLimits
from g12.polar.plan import PolarSettings
from g12.polar.soft_limits import AxisScale, SoftLimits
from g12.section.start import SectionStart, WordRules
from g12.settings import Settings

LEAST_X_MM = 0.001  # a smaller part in X makes LinuxCNC 2.9 get the feed of a piece wrong
PIECES_SHARE = 0.7  # of what a chord's length and the acceleration allow: measured
CLOSING_MM = 0.0127  # radius mismatch of an arc that LinuxCNC itself forgives


class PolarSetup(NamedTuple):
    """What a section is read, planned and moved by; ``tolerance`` in program units."""

    words: WordRules
    plan: PolarSettings
    limits: SoftLimits
    tolerance: float


def check_section_start(start: SectionStart, axes: Collection[str]) -> None:
    """Refuse to begin a section where it cannot; ``axes`` are the letters of the machine's."""
    above = f"needs the tool at X above zero, not at {number(start.x)} (radius)"
    beside = "needs a move after G40: the tool is still beside the programmed point"
    rules = (
        ({"X", "C"} <= set(axes), "needs a machine with an X and a C axis"),
        (start.alone, "stands alone in its block"),
        (not start.compensated, "needs G40: compensation is switched on inside"),
        (not start.inverse_time, "needs G94 or G95, not G93"),
        (not start.yz_plane, "needs G18 or G17, not G19"),
        (not start.surface_speed, "needs G97: with G96 the speed would change with X"),
        (not start.offset_pending, beside),
        (not start.rotated, "needs an unrotated work offset (G10 L2 R0)"),
        (start.x > 0, above),
    )
    for holds, rule in rules:
        if not holds:
            raise start.place.refuse(rule)


def polar_setup(
    start: SectionStart, settings: Settings, axes: dict[str, Axis], face: FaceAxes | None
) -> PolarSetup:
    """Return what a section goes by; ``settings`` and ``axes`` are in machine units.

    ``face`` are the axes of the part's face, if the machine has its kinematics.
    """
    if settings.polar_kinematics == "1" and not face:
        raise start.place.refuse(
            "needs [KINS] KINEMATICS = polar_xzc for [G12] POLAR_KINEMATICS = 1"
        )
    machine_unit_mm = start.machine_unit / start.millimetre
    tolerance = settings.tolerance(machine_unit_mm) * start.machine_unit
    return PolarSetup(
        _word_rules(start, settings),
        _planning(start, settings, axes, tolerance)._replace(
            face=_face_limits(start, face, axes["C"], tolerance)
            if settings.polar_kinematics == "1"
            else None
        ),
        SoftLimits(axes, _scales(start), "in" if is_inch(machine_unit_mm) else "mm"),
        tolerance,
    )


def _word_rules(start: SectionStart, settings: Settings) -> WordRules:
    g7, meant = start.diameter, settings.polar_x
    diameter = g7 if meant == "inherit" else meant == "diameter"
    feeds = settings.polar_g0 == "feed"
    return WordRules(
        diameter=diameter,
        x_scale=(0.5 if diameter else 1.0) / (0.5 if g7 else 1.0),  # G7 has halved it already
        z_with_x=settings.polar_z == "allow",
        rapid_feed=settings.polar_g0_feed * start.machine_unit if feeds else None,
        closing=CLOSING_MM * start.millimetre,
    )


def _planning(
    start: SectionStart, settings: Settings, axes: dict[str, Axis], tolerance: float
) -> PolarSettings:
    return PolarSettings(
        tolerance=tolerance,
        least_x=LEAST_X_MM * start.millimetre,
        x_acceleration=axes["X"].acceleration * start.machine_unit,
        c_acceleration=axes["C"].acceleration,
        c_speed=axes["C"].velocity * 60,
        pole_refused=settings.polar_pole == "refuse",
    )


def _face_limits(start: SectionStart, face: FaceAxes, c: Axis, tolerance: float) -> FaceLimits:
    slide = face.slide.acceleration * start.machine_unit
    nearest = slide / radians(c.acceleration)  # to the pole that the face is good for
    chord = sqrt(8.0 * tolerance * nearest)
    x, y = (axis.acceleration * start.machine_unit for axis in (face.x, face.y))
    return FaceLimits(
        acceleration=hypot(x, y),
        round_acceleration=min(x, y),
        slide_acceleration=slide,
        c_acceleration=radians(c.acceleration),
        c_speed=radians(c.velocity),
        override=max(1.0, face.override),
        pieces_speed=PIECES_SHARE * sqrt(slide * chord),
    )


def _scales(start: SectionStart) -> dict[str, AxisScale]:
    """Return how the program's X, Z and C become machine coordinates."""
    factors = {"X": 1 / start.machine_unit, "Z": 1 / start.machine_unit, "C": 1.0}
    return {
        letter: AxisScale(factor, start.offsets[letter] * factor)
        for letter, factor in factors.items()
    }
