# SPDX-License-Identifier: GPL-2.0-or-later
"""A kind of section: from the interpreter's state and the settings to its plan, and its travel."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar, NamedTuple

from g12.compensation.contour import Contour
from g12.errors import number
from g12.machine_ini import Axis, FaceAxes
from g12.moves.steps import FaceMove, SectionPlan, Segments, Step
from g12.section.effects import SectionStart, WordRules
from g12.section.line import SectionWords
from g12.settings import Settings
from g12.state import Beyond, beyond_travel, refused_mode

LEAST_MM = 0.001  # LinuxCNC 2.9.0~pre1 runs a smaller move of a slide with a rotary axis too fast
RADIUS_TOLERANCE_MM = 0.0127  # mismatch of an arc's radii that LinuxCNC itself accepts


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
        self.start, self.state, self.machine = start, start.state, machine
        self.check(start)
        # the allowed deviation, in program units
        self.tolerance = machine.settings.tolerance(self.state.machine_mm) * self.state.machine_unit
        self.rules = self.word_rules()

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
        return None if feed is None else feed * self.state.machine_unit

    def beyond_travel(self, steps: Iterable[Step]) -> tuple[int, Beyond] | None:
        """Return the line of the first move that leaves the travel, and how; None if all stay."""
        runs = [step for step in steps if isinstance(step, Segments | FaceMove)]
        if self._beyond([end for run in runs for end in run.segments]):
            for line, end in ((run.line, end) for run in runs for end in run.segments):
                beyond = self._beyond([end])
                if beyond:
                    return line, beyond
        return None

    def _beyond(self, ends: Iterable[Sequence[float]]) -> Beyond | None:
        """Return how the ends of moves leave the travel, None if they do not."""
        axes, at, limits = self.words.axes, self.state.on_machine, self.machine.axes
        columns = zip(axes, zip(*(end[:3] for end in ends)))
        ranges = [(axis, at(axis, min(there)), at(axis, max(there))) for axis, there in columns]
        return beyond_travel(self.state, limits, ranges, diameters=self.rules.diameter)

    def in_program(self, axis: Axis) -> float:
        """Return the acceleration of a linear axis in program units."""
        return axis.acceleration * self.state.machine_unit


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
    *others, last = tuple(needed)
    state = start.state
    for holds, rule in (
        (
            set(needed) <= set(letters),
            f"needs a machine with an {', '.join(others)} and a {last} axis",
        ),
        (start.alone, "must be alone in its block"),
        (
            "C" not in needed or not start.missing_code,
            f"needs the spindle as C: {start.missing_code} first",
        ),
        (not (refused := refused_mode(state)), refused),
        (not state.surface_speed, "needs G97: with G96 the speed would change with X"),
        (not state.rotation, "needs an unrotated work offset (G10 L2 R0)"),
        *(_unshifted(start, letter, centre) for letter in centred),
        *rules,
    ):
        if not holds:
            raise start.location.refuse(rule)


def _unshifted(start: SectionStart, letter: str, centre: str) -> tuple[bool, str]:
    """Return the rule that an axis has its 0 at the ``centre``."""
    shift = start.state.shifts[letter]
    written = shift * (2 if letter == "X" and start.state.diameter else 1)
    return abs(shift) <= start.state.rounding, (
        f"{letter}0 must be {centre}: G52 or G92 shifts {letter} by {number(written)};"
        f" cancel it with G92.1 (a{'n' * (letter == 'X')} {letter} offset of G54 may stay)"
    )
