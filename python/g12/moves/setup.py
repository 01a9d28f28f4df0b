# SPDX-License-Identifier: GPL-2.0-or-later
"""A kind of section: from the interpreter's state and the settings to its plan, and its travel."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from typing import ClassVar, NamedTuple

from g12.compensation.contour import Contour
from g12.errors import number
from g12.lengths import ROUNDING_MM, beyond_limit, converts, is_inch
from g12.machine_ini import Axis, FaceAxes
from g12.moves.steps import FaceMove, SectionPlan, Segments, Step
from g12.section.effects import SectionStart, WordRules
from g12.section.line import SectionWords
from g12.settings import Settings

LEAST_MM = 0.001  # LinuxCNC 2.9.0~pre1 runs a smaller move of a slide with a rotary axis too fast
RADIUS_TOLERANCE_MM = 0.0127  # mismatch of an arc's radii that LinuxCNC itself accepts
ROTARY_AXES = "ABC"


class SectionMachine(NamedTuple):
    """The machine of a section: the letters of its axes, the settings, the axes' limits.

    Both are in machine units. ``face`` are the axes of the part's face, if it has kinematics.
    """

    letters: frozenset[str]
    settings: Settings
    axes: Mapping[str, Axis]
    face: FaceAxes | None = None


class SectionKind(ABC):
    """One section of a kind, which reads words, plans a contour and knows its travel.

    ``on_words`` are the letters that the block that switches on may have. ``unwinds``: the
    operator is told how far the rotary axis has to unwind, as the program does not command its
    turns.
    """

    words: ClassVar[SectionWords]
    on_words: ClassVar[str] = ""
    unwinds: ClassVar[bool] = False
    surface: float = 0.0  # the radius of the cylinder, 0 on a face

    def __init__(self, start: SectionStart, machine: SectionMachine) -> None:
        """Refuse to begin a section where it cannot."""
        self.start, self.machine = start, machine
        self.check(start)
        settings = machine.settings
        self.tolerance = settings.tolerance(start.machine_unit / start.millimetre)
        self.tolerance *= start.machine_unit  # the allowed deviation, in program units
        self.rules = self.word_rules()
        self.limits = travel(start, machine.axes, "".join(self.words.axes))

    @abstractmethod
    def check(self, start: SectionStart) -> None:
        """Refuse the state in which no such section can begin."""

    @abstractmethod
    def word_rules(self) -> WordRules:
        """Return the rules for reading the words."""

    @abstractmethod
    def plan(self, contour: Contour) -> SectionPlan:
        """Return the moves of the contour; refuse one that cannot be cut as programmed."""

    @property
    def rapid_feed(self) -> float | None:
        """The feed of G0, None where it is refused."""
        settings = self.machine.settings
        feed = settings.polar_g0_feed if settings.polar_g0 == "feed" else None
        return None if feed is None else feed * self.start.machine_unit

    def in_program(self, axis: Axis) -> float:
        """Return the acceleration of a linear axis in program units."""
        return axis.acceleration * self.start.machine_unit


def check_entry(
    start: SectionStart,
    letters: Iterable[str],
    needed: str,
    rules: Iterable[tuple[bool, str]],
    centred: Iterable[str] = "X",
    centre: str = "the spindle's axis",
) -> None:
    """Refuse to begin a section in modes that none allows, or against its own ``rules``.

    ``letters`` are the machine's axes, ``needed`` those of the section. ``centred`` are those whose
    0 is ``centre``.
    """
    beside = "needs a move after G40: the tool is still beside the programmed point"
    *others, last = tuple(needed)
    for holds, rule in (
        (
            set(needed) <= set(letters),
            f"needs a machine with an {', '.join(others)} and a {last} axis",
        ),
        (start.alone, "must be alone in its block"),
        (not start.missing_code, f"needs the spindle as C: {start.missing_code} first"),
        (not start.compensated, "needs G40: compensation is switched on inside"),
        (not start.inverse_time, "needs G94 or G95, not G93"),
        (not start.surface_speed, "needs G97: with G96 the speed would change with X"),
        (not start.offset_pending, beside),
        (not start.rotated, "needs an unrotated work offset (G10 L2 R0)"),
        *(_unshifted(start, letter, centre) for letter in centred),
        *rules,
    ):
        if not holds:
            raise start.location.refuse(rule)


def _unshifted(start: SectionStart, letter: str, centre: str) -> tuple[bool, str]:
    """Return the rule that an axis has its 0 at the ``centre``."""
    shift = start.shifts[letter]
    written = shift * (2 if letter == "X" and start.diameter else 1)
    return abs(shift) <= ROUNDING_MM * start.millimetre, (
        f"{letter}0 must be {centre}: G52 or G92 shifts {letter} by {number(written)};"
        f" cancel it with G92.1 (a{'n' * (letter == 'X')} {letter} offset of G54 may stay)"
    )


class AxisScale(NamedTuple):
    """How a program coordinate becomes a machine coordinate: times ``factor``, plus ``offset``."""

    factor: float
    offset: float


class Beyond(NamedTuple):
    """A move that an axis cannot make: where it would go, and its limit, in machine coordinates.

    ``unit`` is theirs; ``converted``: the program's is another.
    """

    line: int
    axis: str
    position: float
    limit: float
    unit: str
    converted: bool

    def text(self, diameters: bool) -> str:
        """Return the rule for the message; ``diameters``: the program's X words are diameters."""
        return beyond_limit(
            *(self.axis, self.position, self.limit, self.unit),
            converted=self.converted,
            radius=self.axis == "X" and diameters,
        )


class SoftLimits:
    """The travel of axes, for moves in program coordinates.

    ``scales`` are by letter, in the order of a step's positions. ``unit`` is the machine's unit of
    length, ``mm`` or ``in``.
    """

    def __init__(
        self, axes: Mapping[str, Axis], scales: Mapping[str, AxisScale], unit: str
    ) -> None:
        self._unit, self._scales = unit, scales
        self._ranges = [
            [(limit - scale.offset) / scale.factor for limit in axes[letter][:2]]
            for letter, scale in scales.items()
        ]

    def beyond(self, steps: Iterable[Step]) -> Beyond | None:
        """Return the first move that leaves the travel of an axis, None if all stay within."""
        runs = [step for step in steps if isinstance(step, Segments | FaceMove)]
        columns = zip(*(segment[:3] for run in runs for segment in run.segments))
        for at, (limits, positions) in enumerate(zip(self._ranges, columns)):
            if min(positions) < limits[0] or limits[1] < max(positions):
                return self._first(runs, at, limits)
        return None

    def _first(self, runs: list[Segments | FaceMove], at: int, limits: list[float]) -> Beyond:
        line, position = next(
            (run.line, segment[at])
            for run in runs
            for segment in run.segments
            if not limits[0] <= segment[at] <= limits[1]
        )
        limit = limits[0] if position < limits[0] else limits[1]
        letter, (factor, offset) = list(self._scales.items())[at]
        unit = "degrees" if letter in ROTARY_AXES else self._unit
        there, end = (value * factor + offset for value in (position, limit))
        return Beyond(line, letter, there, end, unit, converts(factor))


def travel(start: SectionStart, axes: Mapping[str, Axis], letters: str) -> SoftLimits:
    """Return the limits of a section's axes for moves in program coordinates."""
    factors = {
        letter: 1.0 if letter in ROTARY_AXES else 1 / start.machine_unit for letter in letters
    }
    scales = {
        letter: AxisScale(factor, start.offsets[letter] * factor)
        for letter, factor in factors.items()
    }
    unit = "in" if is_inch(start.machine_unit / start.millimetre) else "mm"
    return SoftLimits(axes, scales, unit)
