# SPDX-License-Identifier: GPL-2.0-or-later
"""What a polar section gains from kinematics on its machine, by the toolpath of its words."""

from __future__ import annotations

from collections.abc import Sequence

from g12.tools.machine.ini import Ini
from g12.tools.path.section_times import Leg, SectionTimes, section_times, turning_machine
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.toolpath import NO_LENGTH, Expected


def times_of_section(
    section: SectionContour, toolpath: Sequence[Expected], ini: Ini
) -> SectionTimes | None:
    """Return about how long a section takes, None where that is not reckoned.

    That is on a cylinder, with the tool beside the X line, and without a feed.
    """
    unknown = section.doubt or section.surface or ini.tool_beside
    if unknown or not toolpath or not all(move.feed for move in toolpath):
        return None
    across = [move for move in toolpath if move.curve.length > NO_LENGTH]
    plunging = sum(_seconds(move) for move in toolpath if move.curve.length <= NO_LENGTH)
    legs = [Leg(move.curve, move.curve.length / _seconds(move)) for move in across]
    return SectionTimes(*(plunging + each for each in section_times(legs, turning_machine(ini))))


def _seconds(move: Expected) -> float:
    """Return the time of a move at its feed."""
    return 60.0 * move.length / (move.feed or 1.0)
