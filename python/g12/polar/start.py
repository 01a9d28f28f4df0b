# SPDX-License-Identifier: GPL-2.0-or-later
"""From the state at a section's start and the machine's settings to the values of its plan."""

from __future__ import annotations

from collections.abc import Collection
from math import hypot, inf, radians, sqrt

from g12.errors import number
from g12.machine_ini import Axis, FaceAxes
from g12.moves.setup import (
    LEAST_MM,
    RADIUS_TOLERANCE_MM,
    SectionSetup,
    check_entry,
    rapid_feed_of,
    tolerance_of,
    travel,
)
from g12.polar.follow import FaceLimits
from g12.polar.plan import PolarSettings
from g12.polar.words import POLAR_WORDS
from g12.section.start import SectionStart, WordRules
from g12.settings import Settings

SEGMENTS_SHARE = 0.7  # of the speed that a chord's length and the acceleration allow: measured


def check_section_start(start: SectionStart, axes: Collection[str]) -> None:
    """Refuse to begin a section where it cannot; ``axes`` are the letters of the machine's."""
    above = f"needs the tool at X above zero, not at {number(start.x)} (radius)"
    own = ((not start.yz_plane, "needs G18 or G17, not G19"), (start.x > 0, above))
    check_entry(start, axes, "XC", own)


def polar_setup(
    start: SectionStart, settings: Settings, axes: dict[str, Axis], face: FaceAxes | None
) -> SectionSetup[PolarSettings]:
    """Return the setup of a section; ``settings`` and ``axes`` are in machine units.

    ``face`` are the axes of the part's face, if the machine has its kinematics.
    """
    switches = settings.polar_kinematics == "1"
    if switches and not face:
        raise start.location.refuse(
            "needs [KINS] KINEMATICS = polar_xzc for [G12] POLAR_KINEMATICS = 1"
        )
    tolerance = tolerance_of(start, settings)
    planning = PolarSettings(
        tolerance=tolerance,
        least_x=LEAST_MM * start.millimetre,
        x_acceleration=axes["X"].acceleration * start.machine_unit,
        c_acceleration=axes["C"].acceleration,
        c_speed=axes["C"].velocity * 60,
        pole_refused=settings.polar_pole == "refuse",
        face=_face_limits(start, settings, face, axes["C"]) if switches and face else None,
        beside=settings.polar_tool_offset * start.machine_unit,
    )
    return SectionSetup(_word_rules(start, settings), planning, travel(start, axes), tolerance)


def _word_rules(start: SectionStart, settings: Settings) -> WordRules:
    g7, setting = start.diameter, settings.polar_x
    diameter = g7 if setting == "inherit" else setting == "diameter"
    return WordRules(
        words=POLAR_WORDS,
        diameter=diameter,
        x_scale=(0.5 if diameter else 1.0) / (0.5 if g7 else 1.0),  # the parser halves X in G7
        c_scale=1.0,
        third_with_others=settings.polar_z == "allow",
        rapid_feed=rapid_feed_of(start, settings),
        radius_tolerance=RADIUS_TOLERANCE_MM * start.millimetre,
        beside=settings.polar_tool_offset * start.machine_unit,
    )


def _face_limits(start: SectionStart, settings: Settings, face: FaceAxes, c: Axis) -> FaceLimits:
    tolerance = tolerance_of(start, settings)
    slide = face.slide.acceleration * start.machine_unit
    beside = settings.polar_tool_offset * start.machine_unit
    nearest = slide / radians(c.acceleration)  # least distance from the pole on the face
    chord = sqrt(8.0 * tolerance * nearest)
    x, y = (axis.acceleration * start.machine_unit for axis in (face.x, face.y))
    return FaceLimits(
        acceleration=hypot(x, y),
        round_acceleration=min(x, y),
        slide_acceleration=slide,
        c_acceleration=radians(c.acceleration),
        c_speed=radians(c.velocity),
        override=max(1.0, face.override),
        segments_speed=SEGMENTS_SHARE * sqrt(slide * chord),
        slide_speed=face.slide.velocity * start.machine_unit if beside else inf,  # else X's own
        beside=beside,
    )
