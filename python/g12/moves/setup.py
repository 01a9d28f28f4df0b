# SPDX-License-Identifier: GPL-2.0-or-later
"""A kind of section: from the interpreter's state and the settings to its plan, and its travel."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from math import radians
from typing import ClassVar, NamedTuple

from g12.compensation.centre_path import centre_path
from g12.compensation.contour import Contour, Motion, PathElement, PlaneMove, Plunge, Start
from g12.errors import number
from g12.machine_ini import Axis, FaceAxes
from g12.moves.exact_stops import Direction, stops
from g12.moves.steps import (
    MOST_SEGMENTS_OF_MOVE,
    FaceMove,
    MachinePosition,
    SectionPlan,
    Segment,
    Segments,
    Split,
    Step,
    TooManySegments,
    has_short_slide_move,
    segments_with_feed,
)
from g12.section.effects import SectionStart, WordRules
from g12.section.line import SectionWords
from g12.settings import Settings
from g12.state import Beyond, beyond_travel, refused_mode

LEAST_MM = 0.001  # LinuxCNC 2.9.0~pre1 runs a smaller move of a slide with a rotary axis too fast
RADIUS_TOLERANCE_MM = 0.0127  # mismatch of an arc's radii that LinuxCNC itself accepts
CHORD_SHARE = 0.96  # of the tolerance: the estimate of the deviation may be too low by the rest
# STOP_SHARE is for a stop by G61, into which LinuxCNC cuts the corner before it deeper. Blended
# segments end in a G4 P0 (`SectionOutput`), for which CHORD_SHARE would do.
STOP_SHARE = 0.7  # of the tolerance, before a stop
ROUNDING_SHARE = 0.5  # of the tolerance: at a corner, on top of the segments' own deviation
REMAINDER_SHARE = 1e-3  # of the least step of a slide: a smaller remainder is rounding


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
        # in program units: the allowed deviation, and the least move of a slide that turns
        self.tolerance = machine.settings.tolerance(self.state.machine_mm) * self.state.machine_unit
        self.least = LEAST_MM * self.state.millimetre
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
    machine: SectionMachine,
    needed: str,
    rules: Iterable[tuple[bool, str]] = (),
    *,
    centred: str = "X",
    across: str = "Y",
    centre: str = "the spindle's axis",
) -> None:
    """Refuse to begin a section in modes that none allows, or against its own ``rules``.

    ``needed`` are its axes. ``centred`` are those whose 0 is ``centre``, and ``across``, on which
    the tool has to stand there if the machine has that axis. (The Y of a face is another one.)
    """
    *others, last = tuple(needed)
    state = start.state
    stands = across if across in machine.letters and not machine.face else ""
    for holds, rule in (
        (
            set(needed) <= machine.letters,
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
        *(_unshifted(start, letter, centre) for letter in (*centred, *stands)),
        *(
            (
                abs(state.position(letter)) <= state.rounding,
                f"needs {letter}0: the tool must stand on {centre}, not at"
                f" {letter}{number(state.position(letter))}",
            )
            for letter in stands
        ),
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


class StepMaker(ABC):
    """Plans a contour of a section, one element of the tool centre's path after the other."""

    def __init__(self, contour: Contour, kind: SectionKind, position: MachinePosition) -> None:
        self.contour, self.position, self.letters = contour, position, kind.words.axes
        self.tolerance, self.least = kind.tolerance, kind.least
        self.steps: list[Step] = []

    @abstractmethod
    def acceleration(self, direction: Direction, point: complex) -> float:
        """Return the greatest acceleration along a direction at a point that no axis exceeds.

        It is 0 where the axes have to stop.
        """

    @abstractmethod
    def slide_at(self, point: complex) -> float:
        """Return the slide's position for a point of the plane."""

    @abstractmethod
    def split(self, move: PlaneMove, deviation: float) -> Split:
        """Return the segments of a move that deviate from it by so much."""

    def plan(self) -> SectionPlan:
        """Return the moves of the whole contour.

        Raises Refusal, naming the blocks by their lines, when it cannot be cut as programmed.
        """
        path, moved = centre_path(self.contour, self.tolerance)
        self.tolerance -= moved
        path = self.routed(path)
        self.make_all(path, stops(path, ROUNDING_SHARE * self.tolerance, self.acceleration))
        return SectionPlan(self.steps, self.end(), self.contour.notes)

    def routed(self, path: list[PathElement]) -> list[PathElement]:
        """Return the path as the axes can follow it; refuse one that they cannot."""
        return path

    def end(self) -> Start:
        slide, turn, height = self.position
        return Start(slide, radians(turn), height)

    def make_all(self, path: Sequence[PathElement], stopping: Sequence[bool]) -> None:
        """Make the steps of a path; ``stopping``: the tool stops at the end of the element."""
        for element, stop in zip(path, stopping):
            self.make(element, stop)
        self.finish(path)

    def make(self, element: PathElement, stop: bool) -> None:
        """Make the steps of an element; ``stop``: the tool stops at its end."""
        if isinstance(element, PlaneMove):
            self._cut(element, stop)
        elif isinstance(element, Plunge):
            there = self.position._replace(height=element.h1)
            self.run(element.line, self.letters.height, [(*there, element.feed)], stop)
        else:
            self.steps.append(element)

    def _cut(self, move: PlaneMove, stop: bool) -> None:
        """Make the segments of a move; refuse too many of them.

        It is split again where a segment would turn and move the slide by less than the least: that
        segment does not move the slide, and deviates by that much more.
        """
        try:
            split = self.split(move, chord_deviation(self.tolerance, stop))
            if has_short_slide_move(split, self.least):
                split = self.split(move, chord_deviation(self.tolerance, stop, self.least))
        except TooManySegments:
            self.contour.refuse(
                move.line,
                f"more than {MOST_SEGMENTS_OF_MOVE} moves would be needed to stay within"
                " POLAR_TOLERANCE",
            )
        zero = self.zero_angle(move, split)
        segments = segments_with_feed(split, self.position, move, zero, self.least)
        slide, turn, height = self.letters
        level = move.h0 == move.h1
        self.run(move.line, slide + turn if level else slide + turn + height, segments, stop)

    def zero_angle(self, _move: PlaneMove, _split: Split) -> float:
        """Return the angle in degrees of the rotary axis where that of the split is 0."""
        return 0.0

    def run(self, line: int, axes: str, segments: list[Segment], stop: bool) -> None:
        if segments:
            self.steps.append(Segments(line, axes, segments, stop))
            self.position = MachinePosition(*segments[-1][:3])

    def finish(self, path: Sequence[PathElement]) -> None:
        """Move the slides to the path's end, by the remainder of its last segments."""
        moves = [element for element in path if isinstance(element, Motion)]
        if not moves:
            return
        last, there = moves[-1], self.position
        in_plane = [move.end for move in moves if isinstance(move, PlaneMove)]
        slide = self.slide_at(in_plane[-1]) if in_plane else there.slide
        ends = (slide, self.letters.slide), (last.h1, self.letters.height)
        offs = zip(ends, (there.slide, there.height))
        axes = "".join(
            letter for (end, letter), at in offs if abs(end - at) > REMAINDER_SHARE * self.least
        )
        if axes:
            self.run(last.line, axes, [(slide, there.turn, last.h1, last.feed)], True)


def chord_deviation(tolerance: float, stop: bool, slide_error: float = 0.0) -> float:
    """Return the deviation that the segments of a move may have; ``stop``: at its end.

    ``slide_error`` is the further deviation of a segment that does not move a slide.
    """
    remaining = max(tolerance - slide_error, 0.5 * tolerance)
    return min((STOP_SHARE if stop else CHORD_SHARE) * tolerance, CHORD_SHARE * remaining)
