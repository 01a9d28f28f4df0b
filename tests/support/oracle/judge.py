# SPDX-License-Identifier: GPL-2.0-or-later
"""Each reported pocket, event and section of a trace against what its words ask for."""

import cmath
import math
from collections.abc import Iterator, Sequence

import numpy as np

from g12.cut_report import EventCut, PocketCut, SectionCut
from g12.geometry.curve import Arc, Line
from g12.machine_ini import remap_lines
from g12.tools.machine.ini import Ini
from g12.tools.path.lathe_axes import lathe_axes
from g12.tools.path.part import Part, arc_points, plane_axes
from g12.tools.path.surface import Surface
from g12.tools.path.track import limits_of, track
from g12.tools.preview.moves import Move, ReportedCut, Trace
from support.oracle import circles
from support.oracle.circles import BlockInMm
from support.oracle.contour import contour_path, elements_of
from support.oracle.follow import Made, judge_path, lay
from support.oracle.lathe import LatheCut, judge_lathe_cut
from support.oracle.toolpath import Difference

WALL = 0.005  # mm of a pocket's toolpath
CART_FUZZ = 1e-8
SHARES = np.linspace(0.0, 1.0, 25)  # of an arc in another plane than the pocket's
SAME_AXIS = 1e-9
PATHS = {
    "haas": circles.haas_path,
    "yasnac": circles.yasnac_path,
    "mitsubishi": circles.mitsubishi_path,
}


class Oracle:
    """The cuts of a trace with reports."""

    def __init__(self, trace: Trace, ini: Ini) -> None:
        self.trace, self.moves, self.ini = trace, trace.moves, ini
        handlers = [remap.keywords.get("prolog", "") for remap in remap_lines(ini.all)]
        self.dialect = next((d for d in PATHS if any(h.endswith(d) for h in handlers)), "")

    def differences(self) -> Iterator[Difference]:
        for number, cut in enumerate(self.trace.cuts):
            if cut.at == cut.end:
                yield Difference("path-missing", cut.line, "nothing is cut")
            elif isinstance(cut.report.cut, SectionCut):
                yield from judge_lathe_cut(self._section(cut))
            else:
                yield from self._pocket(number, cut)

    # ------------------------------------------------------------ pockets and events

    def _pocket(self, number: int, cut: ReportedCut) -> Iterator[Difference]:
        block = BlockInMm(cut.report, self._cutter(number, cut), self.ini.settings)
        block.machine_mm = self.ini.mm
        if isinstance(cut.report.cut, EventCut):
            path = circles.event_path(block, [self._before(number, plane) for plane in "WO"])
        else:
            path = PATHS[self.dialect](block)
        first = self.moves[cut.at]
        x, y, z = block.centre()
        there = cut.report.frame.point(x, y)
        origin = np.array([there.real, there.imag, cut.report.frame.level(z)])
        made = made_in(origin, plane_axes(first), self.moves, range(cut.at, cut.end))
        yield from judge_path(lay(path, made, WALL), cut.line)

    def _cutter(self, number: int, cut: ReportedCut) -> float:
        """Return the radius of the cutter that a path is for: D's, the last D's, the loaded one."""
        loaded = self.trace.radius(cut.at)
        if isinstance(cut.report.cut, EventCut):
            return loaded
        before = self.trace.cuts[: number + 1] if self.dialect == "haas" else [cut]
        for each in reversed(before):
            d = each.report.words.get("D")
            if d is not None and isinstance(each.report.cut, PocketCut):
                return self.trace.table_at(each.at).diameters.get(round(d), 0.0) / 2
        return loaded if self.dialect == "haas" else 0.0

    def _before(self, number: int, plane: str) -> float | None:
        """Return W or O of the last event that has one, mm."""
        for cut in reversed(self.trace.cuts[:number]):
            if isinstance(cut.report.cut, EventCut):
                entries = circles.event_entries(BlockInMm(cut.report, 0.0, None))
                if plane in entries:
                    return entries[plane]
        return None

    # ------------------------------------------------------------ sections

    def _section(self, cut: ReportedCut) -> LatheCut:
        planned, frame = cut.report.cut, cut.report.frame
        surface = planned.surface * frame.mm
        height = cut.report.at[0 if surface else 2] * frame.mm
        path = contour_path(
            list(elements_of(cut.report, planned)), height, self.trace.radius(cut.at)
        )
        angle = math.radians(frame.zero[3] + (0.0 if surface else cut.report.at[3]))
        x, _, z = (value * frame.mm for value in frame.zero[:3])
        part = Surface(True, self.ini.tool_beside, x, radius=surface) if surface else None
        part = part or Part(True, self.ini.tool_beside, x)
        speed = self.trace.modes.speed
        drawn = range(len(self.moves))[max(0, cut.at - 1) : cut.end + 1]
        return LatheCut(
            line=cut.line,
            last_line=cut.last_line,
            expected=[step.move for step in path],
            own=range(cut.at, cut.end),
            moves=self.moves,
            path=track(part, self.moves, limits_of(self.ini), speed, own=drawn),
            axes=lathe_axes(self.ini),
            zero=complex(angle * surface, z) if surface else 0j,
            axis=1 + 0j if surface else cmath.rect(1.0, angle),
            base=x if surface else z,
            surface=surface,
            tolerance=self.ini.settings.tolerance(self.ini.mm) * self.ini.mm,
        )


def made_in(
    origin: np.ndarray, axes: np.ndarray, moves: Sequence[Move], own: range
) -> Iterator[Made]:
    """Yield the moves that have a length, from a place along axes."""

    def local(positions):
        found = (np.atleast_2d(positions)[:, :3] - origin) @ axes.T
        return [(complex(x, y), level) for x, y, level in found.tolist()]

    for index in own:
        move = moves[index]
        if move.length <= CART_FUZZ:
            continue
        points = local([move.start[:3], move.end[:3]])
        across = plane_axes(move)
        if move.kind != "arc":
            curve = Line(points[0][0], points[1][0])
        elif np.abs(across[2] - axes[2]).max() < SAME_AXIS:
            curve = Arc(points[0][0], local(move.centre)[0][0], move.sweep)
        else:
            curve, points = None, local(arc_points(move, SHARES))
        yield Made.of(index, move, points, curve)
