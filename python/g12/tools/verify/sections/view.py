# SPDX-License-Identifier: GPL-2.0-or-later
"""A section as its part sees it: the value that each rule of sections is a function of."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from g12.tools.path.follow import Followed
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.part import C, X, Y, Z
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move, Trace
from g12.tools.verify.compare.plane import plane_of
from g12.tools.verify.compare.section import ToolpathView
from g12.tools.verify.expected.compensated import ContourStep, contour_path
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.result.tolerances import LAST_DECIMAL

G64_P = re.compile(r"G64 P(\S+)")
# LinuxCNC blends a corner so that two moves of the same acceleration pass it at P. It takes that of
# the first (tp.c, tpComputeBlendVelocity): with a second move that is much quicker it is 2.15 P.
# Measured from an arc to a plunge: 1.33 P.
MOST_OF_P = 2.15
IN_PLACE = 1e-6  # mm along the part: no more is made where C turns in place


@dataclass(frozen=True)
class SectionView(ToolpathView):
    """A section; ``steps`` are its expected moves, each with its element.

    ``tool`` is the tool's radius, ``tolerance`` POLAR_TOLERANCE, ``run_tolerance`` that of a run,
    which rounds corners; mm.
    """

    section: SectionContour
    steps: Sequence[ContourStep]
    tool: float
    tolerance: float
    run_tolerance: float

    @property
    def first(self) -> Move:
        return self.moves[self.own.start]

    @cached_property
    def lowest(self) -> float:
        """The lowest position of the axis square to the plane, in machine coordinates."""
        return min(self.moves[index].end[self.section.third] for index in self.own)

    @cached_property
    def fed(self) -> list[int]:
        return [index for index in self.own if self.moves[index].kind != "rapid"]

    @cached_property
    def across(self) -> list[int]:
        """The moves at a feed that go across the plane."""
        longer = (index for index in self.fed if self.path.part_length(index) > IN_PLACE)
        return [index for index in longer if self._goes_across(self.moves[index])]

    def _goes_across(self, move: Move) -> bool:
        """Tell whether a move goes across the plane: the start of a full circle is its end."""
        axes = (axis for axis in (X, Y, Z, C) if axis != self.section.third)
        return move.kind == "arc" or any(move.start[axis] != move.end[axis] for axis in axes)

    @cached_property
    def turned_in_place(self) -> dict[int, float]:
        """The turn of C, degrees, of each move at a feed in which the tool stays on the part."""
        turned = {i: abs(self.moves[i].end[C] - self.moves[i].start[C]) for i in self.fed}
        still = {index for index in self.fed if self.path.part_length(index) < IN_PLACE}
        return {index: turn for index, turn in turned.items() if turn and index in still}


def view_of(
    section: SectionContour,
    trace: Trace,
    path: Track,
    real: Followed | None,
    axes: LatheAxes,
    tolerance: float,
) -> SectionView:
    """Return the view of a section that moves; ``path`` and ``real`` are on its part."""
    first = trace.moves[section.at]
    tool = trace.radius(section.at)
    steps = contour_path(section.elements, section.height, tool, tolerance)
    kinematics = bool(axes.face) and not section.surface
    blended = MOST_OF_P * blending_commanded(section) if kinematics else 0.0
    run_tolerance = max(tolerance, blended)
    return SectionView(
        expected=[step.move for step in steps],
        plane=plane_of(section, first),
        own=range(section.at, section.end),
        moves=trace.moves,
        path=path,
        real=real,
        axes=axes,
        allowed=(tolerance + LAST_DECIMAL, run_tolerance + LAST_DECIMAL),
        diameters=section.diameters,
        last=section.last,
        section=section,
        steps=steps,
        tool=tool,
        tolerance=tolerance,
        run_tolerance=run_tolerance,
    )


def blending_commanded(section: SectionContour) -> float:
    """Return the greatest P of G64 in the words, mm: on the face it holds at corners."""
    given = (G64_P.match(path) for path in section.commanded_paths)
    return max((float(each[1]) * section.unit for each in given if each), default=0.0)
