# SPDX-License-Identifier: GPL-2.0-or-later
"""The moves of a planned section, in the order of the program. Lengths in program units."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from g12.compensation.contour import Contour, Mark, PathElement, PlaneMove, Start
from g12.moves.feed import Segment, Split, has_short_slide_move
from g12.moves.spacing import MOST_SEGMENTS_OF_MOVE, TooManySegments

CHORD_SHARE = 0.96  # of the tolerance: the estimate of the deviation may be too low by the rest
# STOP_SHARE is for a stop by G61, into which LinuxCNC cuts the corner before it deeper. Blended
# segments end in a G4 P0 (`SectionOutput`), for which CHORD_SHARE would do.
STOP_SHARE = 0.7  # of the tolerance, before a stop
ROUNDING_SHARE = 0.5  # of the tolerance: at a corner, on top of the segments' own deviation
REMAINDER_SHARE = 1e-3  # of the least step of a slide: a smaller remainder is rounding


class MachinePosition(NamedTuple):
    """The machine's position: X radius value, C in degrees, Z."""

    x: float
    c: float
    z: float


class BlockMoves(NamedTuple):
    """G1 moves of one block, one after the other, all in G90 and G94.

    ``axes`` are the words to write, as "XC", "XZC" or "Z". Each segment is ``(x, c, z, feed)``: X
    radius value, C in degrees, continuous over the section (it may leave 0..360), and F as G94
    takes it: for the X and Z portion of the move, or in degrees per minute where neither changes. F
    may be small: write it with six significant digits. A segment that does not move a slide repeats
    the same number. With ``stop`` the last segment must end in an exact stop, because
    LinuxCNC would round the corner by more than the tolerance.
    """

    line: int
    axes: str
    segments: list[Segment]
    stop: bool


class SectionPlan(NamedTuple):
    """The moves of a section.

    ``steps`` holds each :class:`BlockMoves` (on the face the moves and switches of
    `g12.polar.face`), and each mark's action, in order. ``position`` is the machine's after them,
    ``angle`` that of C in the contour's plane, in radians. ``notes`` are messages for the operator.
    """

    steps: list[object]
    position: MachinePosition
    angle: float
    notes: list[str]

    @property
    def end(self) -> Start:
        return Start(self.position.x, self.angle, self.position.z)


class StepMaker:
    """Makes the steps of a plan, one element of the tool centre's path after the other."""

    def __init__(self, contour: Contour, position: MachinePosition) -> None:
        self.steps: list[object] = []
        self.position = position
        self._contour = contour

    def _run(self, line: int, axes: str, segments: list[Segment], stop: bool) -> None:
        if segments:
            self.steps.append(BlockMoves(line, axes, segments, stop))
            self.position = MachinePosition(*segments[-1][:3])

    def _add_remainder(self, path: Sequence[PathElement], x: float, z: float, least: float) -> None:
        """Move the slides to x and z, by the remainder of the last segments of a path."""
        rest = {"X": x - self.position.x, "Z": z - self.position.z}
        axes = "".join(axis for axis, off in rest.items() if abs(off) > REMAINDER_SHARE * least)
        if axes:
            last = [element for element in path if not isinstance(element, Mark)][-1]
            self._run(last.line, axes, [(x, self.position.c, z, last.feed)], True)

    def _split(
        self,
        move: PlaneMove,
        split: Callable[[float], Split],
        tolerance: float,
        stop: bool,
        least: float,
    ) -> Split:
        """Return the segments that ``split`` makes of a move; refuse too many of them.

        ``split`` is called with a deviation, and again where a segment would move its slide by less
        than ``least``: that segment does not move the slide, and deviates by that much more.
        """
        try:
            ends = split(chord_deviation(tolerance, stop))
            if has_short_slide_move(ends, least):
                ends = split(chord_deviation(tolerance, stop, least))
            return ends
        except TooManySegments:
            self._contour.refuse(
                move.line,
                f"more than {MOST_SEGMENTS_OF_MOVE} moves would be needed to stay within"
                " POLAR_TOLERANCE",
            )


def chord_deviation(tolerance: float, stop: bool, slide_error: float = 0.0) -> float:
    """Return the deviation that the segments of a move may have; ``stop``: at its end.

    ``slide_error`` is the further deviation of a segment that does not move a slide.
    """
    remaining = max(tolerance - slide_error, 0.5 * tolerance)
    return min((STOP_SHARE if stop else CHORD_SHARE) * tolerance, CHORD_SHARE * remaining)
