# SPDX-License-Identifier: GPL-2.0-or-later
"""From the state at a section's start and the machine's settings to the values of its plan."""

from collections.abc import Collection
from math import radians

from g12.cylinder.plan import CylinderSettings
from g12.cylinder.words import CYLINDER_WORDS
from g12.errors import number
from g12.lengths import LARGEST
from g12.machine_ini import Axis
from g12.moves.setup import (
    LEAST_MM,
    RADIUS_TOLERANCE_MM,
    SectionSetup,
    check_entry,
    rapid_feed_of,
    tolerance_of,
    travel,
)
from g12.section.start import SectionStart, WordRules
from g12.settings import Settings

RADIUS = "C"  # the word of G7.1


def check_cylinder_start(start: SectionStart, axes: Collection[str]) -> None:
    """Refuse to begin a section where it cannot; ``axes`` are the letters of the machine's."""
    check_entry(start, axes, "XZC", ())
    word = start.words.get(RADIUS)
    if word is None:
        rule = f"needs {RADIUS}, the cylinder's radius; {RADIUS}0 ends a section"
        raise start.location.refuse(rule)
    if not 0.0 < word <= LARGEST:
        rule = f"must be above 0 and at most {number(LARGEST)}"
        raise start.location.refuse(f"{RADIUS}{number(word)}, the cylinder's radius, {rule}")


def cylinder_setup(
    start: SectionStart, settings: Settings, axes: dict[str, Axis]
) -> SectionSetup[CylinderSettings]:
    """Return the setup of a section; ``settings`` and ``axes`` are in machine units."""
    radius = start.words[RADIUS] * (0.5 if settings.cylinder_word == "diameter" else 1.0)
    tolerance = tolerance_of(start, settings)
    return SectionSetup(
        WordRules(
            words=CYLINDER_WORDS,
            diameter=start.diameter,
            x_scale=1.0,
            c_scale=radians(radius),
            third_with_others=settings.cylinder_x == "allow",
            rapid_feed=rapid_feed_of(start, settings),
            radius_tolerance=RADIUS_TOLERANCE_MM * start.millimetre,
        ),
        CylinderSettings(
            radius=radius,
            tolerance=tolerance,
            least_z=LEAST_MM * start.millimetre,
            x_acceleration=axes["X"].acceleration * start.machine_unit,
            z_acceleration=axes["Z"].acceleration * start.machine_unit,
            c_acceleration=axes["C"].acceleration,
        ),
        travel(start, axes),
        tolerance,
    )
