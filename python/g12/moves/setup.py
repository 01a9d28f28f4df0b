# SPDX-License-Identifier: GPL-2.0-or-later
"""The setup that sections of every kind derive from the interpreter's state and the settings."""

from collections.abc import Collection, Iterable
from typing import Generic, NamedTuple, TypeVar

from g12.errors import number
from g12.lengths import ROUNDING_MM, is_inch
from g12.machine_ini import Axis
from g12.moves.soft_limits import AxisScale, SoftLimits
from g12.section.start import SectionStart, WordRules
from g12.settings import Settings

LEAST_MM = 0.001  # LinuxCNC 2.9.0~pre1 runs a smaller move of a slide together with C too fast
RADIUS_TOLERANCE_MM = 0.0127  # mismatch of an arc's radii that LinuxCNC itself accepts


Planning = TypeVar("Planning")


class SectionSetup(NamedTuple, Generic[Planning]):
    """The values that a section is read, planned and executed with; ``tolerance`` in program units.

    ``plan`` are the settings of its planner.
    """

    words: WordRules
    plan: Planning
    limits: SoftLimits
    tolerance: float


def check_entry(
    start: SectionStart, axes: Collection[str], needed: str, rules: Iterable[tuple[bool, str]]
) -> None:
    """Refuse to begin a section in modes that none allows, or against its own ``rules``.

    ``axes`` are the letters of the machine's, ``needed`` those of the section.
    """
    beside = "needs a move after G40: the tool is still beside the programmed point"
    shift = number(start.x_shift * (2 if start.diameter else 1))
    shifted = (
        f"X0 must be the spindle's axis: G52 or G92 shifts X by {shift};"
        " cancel it with G92.1 (an X offset of G54 may stay)"
    )
    *others, last = tuple(needed)
    for holds, rule in (
        (
            set(needed) <= set(axes),
            f"needs a machine with an {', '.join(others)} and a {last} axis",
        ),
        (start.alone, "must be alone in its block"),
        (not start.missing_code, f"needs the spindle as C: {start.missing_code} first"),
        (not start.compensated, "needs G40: compensation is switched on inside"),
        (not start.inverse_time, "needs G94 or G95, not G93"),
        (not start.surface_speed, "needs G97: with G96 the speed would change with X"),
        (not start.offset_pending, beside),
        (not start.rotated, "needs an unrotated work offset (G10 L2 R0)"),
        (abs(start.x_shift) <= ROUNDING_MM * start.millimetre, shifted),
        *rules,
    ):
        if not holds:
            raise start.location.refuse(rule)


def tolerance_of(start: SectionStart, settings: Settings) -> float:
    """Return the allowed deviation from the programmed path, in program units."""
    return settings.tolerance(start.machine_unit / start.millimetre) * start.machine_unit


def rapid_feed_of(start: SectionStart, settings: Settings) -> float | None:
    """Return the feed of G0, None where it is refused."""
    feed = settings.polar_g0_feed
    return None if settings.polar_g0 != "feed" or feed is None else feed * start.machine_unit


def travel(start: SectionStart, axes: dict[str, Axis]) -> SoftLimits:
    """Return the limits of X, Z and C for moves in program coordinates."""
    factors = {"X": 1 / start.machine_unit, "Z": 1 / start.machine_unit, "C": 1.0}
    scales = {
        letter: AxisScale(factor, start.offsets[letter] * factor)
        for letter, factor in factors.items()
    }
    unit = "in" if is_inch(start.machine_unit / start.millimetre) else "mm"
    return SoftLimits(axes, scales, unit)
