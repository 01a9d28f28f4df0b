# SPDX-License-Identifier: GPL-2.0-or-later
"""A program on a machine: as traced, as its words command, as it ran, and as its parts see it."""

from bisect import bisect_right
from dataclasses import dataclass, replace
from functools import cached_property
from operator import itemgetter
from pathlib import Path
from typing import Self

import numpy as np

from g12.tools.machine.ini import Ini
from g12.tools.material.material import SAME_LEVEL
from g12.tools.path.follow import Followed, follow
from g12.tools.path.lathe_axes import LatheAxes
from g12.tools.path.part import Part, X, Z, part_of_program
from g12.tools.path.samples import Samples
from g12.tools.path.surface import Surface
from g12.tools.path.track import Track, limits_of, track
from g12.tools.preview.executed_blocks import read_lines
from g12.tools.preview.moves import Move, Trace
from g12.tools.verify.commanded import Commanded
from g12.tools.verify.compare.plane import x0_of
from g12.tools.verify.expected.contour import SectionContour
from g12.tools.verify.expected.words import BlockInMm
from g12.tools.verify.reading.executed_subs import called_files
from g12.tools.verify.sections.view import SectionView, view_of

SAME_X0 = 1e-6  # mm
NOTHING = Commanded()


@dataclass(frozen=True)
class Subject:
    """A program on a machine, as traced, and as a part sees it; ``samples`` are those of a run.

    It is of its ``own`` moves alone, if those are given, and of those beside them: a corner may be
    blended. ``first`` is the same on the part of which the run was laid first.
    """

    program: Path
    ini: Ini
    trace: Trace
    part: Part
    samples: Samples | None = None
    commanded: Commanded = NOTHING
    own: range | None = None
    first: Self | None = None

    @property
    def moves(self) -> list[Move]:
        return self.trace.moves

    @cached_property
    def path(self) -> Track:
        """The moves as one polyline in time."""
        limits, speed = limits_of(self.ini), self.trace.modes.speed
        return track(self.part, self.moves, limits, speed, own=self._drawn)

    @property
    def _drawn(self) -> range:
        every = range(len(self.moves))
        return every[max(0, self.own.start - 1) : self.own.stop + 1] if self.own else every

    @cached_property
    def real(self) -> Followed | None:
        """The motion of the run, laid on the path."""
        if not self.samples:
            return None
        if not (self.first and self.first.real):
            return follow(self.path, self.samples, self.ini.mm)
        moves, drawn = self.first.real.move, self._drawn
        there = (drawn.start <= moves) & (moves < drawn.stop)
        moving = self.samples.only(self.samples.moving())
        return follow(self.path, moving.only(there), self.ini.mm, moves[there])

    def about(self, centre: float, own: range | None = None) -> Self:
        """Return the same with the spindle's axis at another machine X; of its ``own`` moves."""
        same = abs(self.part.centre - centre) < SAME_X0
        return self if same else self._on(replace(self.part, centre=centre), own)

    def on_surface(self, radius: float, own: range | None = None) -> Self:
        return self._on(Surface(turning=True, radius=radius), own)

    def view(self, section: SectionContour, axes: LatheAxes, tolerance: float) -> SectionView:
        """Return a section that moves as its part sees it."""
        own, radius = range(section.at, section.end), section.surface
        x0 = x0_of(section, self.moves[section.at])
        there = self.on_surface(radius, own) if radius else self.about(x0, own)
        return view_of(section, self.trace, there.path, there.real, axes, tolerance)

    def _on(self, part: Part, own: range | None) -> Self:
        return replace(self, part=part, own=own, first=self.first or self)

    # ------------------------------------------------------------ its moves

    def points(self, index: int, part: Part) -> np.ndarray:
        """Return the tool's points (n, 3) on a part along a move, as programmed or as they ran."""
        sampled = self.real.positions[self.real.during(index)] if self.real else ()
        return part.points(sampled) if len(sampled) else part.polyline(self.moves[index])

    def lowest(self, part: Part) -> np.ndarray:
        """Return the lowest level of each straight move on a part, as programmed or as it ran."""
        positions = np.array([(move.start, move.end) for move in self.moves]).reshape(-1, 9)
        levels = part.points(positions)[:, 2].reshape(-1, 2).min(axis=1)
        if self.real:
            sampled = part.points(self.real.positions)[:, 2]
            np.minimum.at(levels, self.real.move, sampled)
            np.minimum.at(levels, self.real.move[1:], sampled[:-1])  # see Followed.during
        return levels

    def end(self, index: int) -> tuple[float, float, float]:
        x, y, z = self.ends[index].tolist()
        return x, y, z

    @cached_property
    def ends(self) -> np.ndarray:
        """The points (n, 3) of the part at which the moves end."""
        return self.part.points(np.array([move.end for move in self.moves]).reshape(-1, 9))

    def line(self, index: int) -> int:
        """Return the program's line of a move, of one in another file the line that calls it.

        A cycle's own lines are in its subroutine, those of a section may be in a sub's own file.
        """
        move, sections = self.moves[index], self.commanded.sections
        cycles = ((block, target) for block, target in self.commanded.circles if not target.file)
        cycle = next((each.line for block, each in cycles if block.at <= index < block.end), 0)
        own = (each for each in sections if each.at <= index < each.end and not each.file)
        if cycle or move.line == move.block:
            return cycle or move.line
        is_own = any(move.remap == each.code for each in own) if move.remap else self._is_one_file
        return move.line if is_own else move.block

    @cached_property
    def _is_one_file(self) -> bool:
        """Whether every sub that the program calls is in the program itself."""
        return not called_files(read_lines(self.program), self.ini)

    def cutter(self, index: int) -> float:
        """Return the radius of a move's cutter: the loaded one's, else D's; 0 if none is known."""
        tool = self.moves[index].tool
        return self.trace.radius(index) or self._named_cutters.get(tool, 0.0)

    @cached_property
    def _named_cutters(self) -> dict[int, float]:
        return {each.cutter.tool: each.cutter.radius for _, each in self.commanded.circles}

    @cached_property
    def widest_cutter(self) -> float:
        return max(map(self.cutter, range(len(self.moves))), default=0.0)

    @cached_property
    def sideways(self) -> list[set[bool]]:
        """Whether the tool of each move points at the axis, as in its cuts before and after.

        Next to a cut it points as in that one. There are two answers where cuts differ, none for a
        tool of a lathe that cuts neither a section nor a hole.
        """
        if not self.part.turning:
            return [{False}] * len(self.moves)
        commanded = self.commanded
        cuts = [(each.at, each.end, each.surface > 0.0) for each in commanded.sections]
        cuts += [(each.moves.start, each.moves.stop, each.is_side) for each in commanded.holes]
        of_tool: dict[int, list[tuple[int, int, bool]]] = {}
        for cut in sorted(cuts):
            of_tool.setdefault(self.moves[cut[0]].tool, []).append(cut)
        found = []
        for index, move in enumerate(self.moves):
            own = of_tool.get(move.tool, [])
            last = bisect_right(own, index, key=itemgetter(0)) - 1
            following = bisect_right(own, index, key=itemgetter(1))
            near = own[max(last, 0) : following + 1]
            beside = {side for at, end, side in near if index in (at - 1, end)}
            found.append(beside or {side for *_, side in near})
        return found

    @cached_property
    def ends_known(self) -> np.ndarray:
        """Whether each move ends where the program says: a trace begins anywhere.

        Where the program's zero is that of the machine, only a work offset would tell where G53,
        G28 and G30 lead.
        """
        axes = [X, Z] if self.part.turning else [Z]
        starts, ends = (
            np.array([getattr(move, name) for move in self.moves]).reshape(-1, 9)[:, axes]
            for name in ("start", "end")
        )
        offset = any(abs(target.wall.face) > SAME_LEVEL for _, target in self.commanded.circles)
        lost = np.array([move.by_machine and not offset for move in self.moves], bool)
        moved = starts != ends
        last = np.maximum.accumulate(np.where(moved, np.arange(len(moved))[:, None], -1), axis=0)
        return ~np.where(last < 0, moved.any(axis=0), lost[last]).any(axis=1)

    # ------------------------------------------------------------ its zero

    @cached_property
    def zero(self) -> np.ndarray:
        """The program's zero where it first cuts; on a lathe X is that of the spindle.

        A section on a cylinder does not define it.
        """
        commanded = self.commanded
        for section in commanded.on_face:
            return np.array([0.0, 0.0, self.moves[section.at].start[Z] - section.height])
        for block, _ in commanded.circles:
            return BlockInMm(block, self.moves[block.at]).zero()
        return np.array([0.0, 0.0, next((call.zero[1] for call in commanded.holes), 0.0)])

    @property
    def rotation(self) -> float:
        """The angle of the program's X on a mill where it first cuts a circle, degrees."""
        first = next((block.at for block, _ in self.commanded.circles), None)
        return 0.0 if first is None else self.moves[first].rotation

    @property
    def z0(self) -> float:
        """The machine Z of the program's Z0; where all is cut on cylinders that of the first."""
        commanded = self.commanded
        if commanded.sections and not (commanded.on_face or commanded.circles or commanded.holes):
            first = commanded.sections[0]
            return self.moves[first.at].start[Z] - first.start.imag
        return float(self.zero[Z])


def subject_of(
    program: Path,
    ini: Ini,
    trace: Trace,
    samples: Samples | None = None,
    commanded: Commanded = NOTHING,
) -> Subject:
    """Return a traced program, and a run of it, about the X0 of its first cut on a lathe."""
    part = part_of_program(ini, trace, bool(commanded.sections or commanded.holes))
    subject = Subject(program, ini, trace, part, samples, commanded)
    sections = [*commanded.on_face, *commanded.sections]
    centres = [x0_of(each, trace.moves[each.at]) for each in sections]
    centres += [call.zero[0] for call in commanded.holes]
    return subject.about(centres[0]) if centres else subject
