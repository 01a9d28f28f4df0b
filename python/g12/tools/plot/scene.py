# SPDX-License-Identifier: GPL-2.0-or-later
"""The content of a picture: a program, its motion, the findings and the stock that it marks.

Lengths are millimetres in the coordinates of the picture's part.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from shapely.geometry import box
from shapely.geometry.base import BaseGeometry

from g12.tools.path.follow import Followed
from g12.tools.path.part import C, X
from g12.tools.path.track import Track
from g12.tools.preview.moves import Move
from g12.tools.units import Unit, clock, plain, unit_of
from g12.tools.verify.judge import Judgement
from g12.tools.verify.model.deviation import deviation_of
from g12.tools.verify.model.finding import FINDING, Finding
from g12.tools.verify.model.program import RUNS, SPINDLE, TracedProgram
from g12.tools.verify.model.solid import FACE

SAME_POINT = 1e-6  # mm
FAR = 1e4  # mm: an unrolled bar goes beyond every view


class DrawnStock(NamedTuple):
    """A given stock: its name, its area along the view, its top, its bottom if that is known."""

    name: str
    shape: BaseGeometry
    top: float
    bottom: float | None


@dataclass(frozen=True)
class Scene:
    """A traced program on its machine.

    ``unit`` is that of the labels. ``override`` is the feed override of the run in per cent.
    ``findings`` are those with a place in the picture. ``contour`` is the largest deviation (mm)
    from the programmed contours of sections, where these are known. ``user_line`` returns the line
    of the user's file for one that LinuxCNC reads, and for the name of a sub's own file.
    """

    program: TracedProgram
    unit: Unit
    override: float = 100.0
    findings: Sequence[Finding] = ()
    stock: DrawnStock | None = None
    contour: float | None = None
    user_line: Callable[[int, str], int] = lambda line, _file: line

    @property
    def moves(self) -> Sequence[Move]:
        return self.program.trace.moves

    @property
    def path(self) -> Track:
        return self.program.path

    @property
    def real(self) -> Followed | None:
        return self.program.real

    @cached_property
    def hits(self) -> list[np.ndarray]:
        """The paths (n, 3) of rapids through material, unrolled on the picture's surface."""
        surface = self.program.surface
        rapids = (each.values for each in self.findings if "path" in each.values)
        return [
            each["path"] * (surface / each["surface"], 1.0, 1.0)
            if each.get("surface") and surface
            else each["path"]
            for each in rapids
        ]

    @property
    def uncut(self) -> list[Finding]:
        """The uncut material in pockets: its ``shape`` along Z, and the ``floor`` below it."""
        return [each for each in self.findings if "floor" in each.values]

    @property
    def signs(self) -> list[Finding]:
        """The findings that are not drawn as a path or an area."""
        return [each for each in self.findings if not {"path", "floor"} & each.values.keys()]

    @cached_property
    def fed(self) -> list[int]:
        """The moves at feed, by their indices."""
        return [index for index, move in enumerate(self.moves) if move.kind != "rapid"]

    @cached_property
    def radial(self) -> list[int]:
        """The moves at feed whose tool points at the axis: the face's picture shows their path."""
        if not self.path.part.turning or self.program.surface:
            return []
        sideways = self.program.sideways
        return [index for index in self.fed if sideways[index] == {True}]

    @cached_property
    def turned(self) -> list[int]:
        """The moves at feed at a part that its spindle turns, where tools have one of their own."""
        if not self.path.part.turning or not self.program.several_spindles:
            return []
        return [index for index in self.fed if self.program.last(SPINDLE, index) in RUNS]

    @cached_property
    def sweeping(self) -> list[int]:
        """The moves at feed whose tool points along the view."""
        return sorted({*self.fed} - {*self.radial, *self.turned})

    @cached_property
    def ends(self) -> np.ndarray:
        """The points (n, 2, 3) of the part at which each move starts and ends."""
        ends = np.array([(move.start, move.end) for move in self.moves])
        return self.path.part.points(ends.reshape(-1, 9)).reshape(-1, 2, 3)

    @cached_property
    def cutting(self) -> list[int]:
        """The moves that sweep, but for those straight up."""
        rises = self.ends[:, 1, 2] - self.ends[:, 0, 2]
        return [index for index in self.sweeping if self.across[index] or rises[index] < 0]

    @property
    def is_turned(self) -> bool:
        """Whether the picture is that of a lathe's part in Z and X."""
        return not self.path.part.turning and "Y" not in self.program.ini.axes

    @cached_property
    def depths(self) -> tuple[float, float]:
        """The lowest and the highest level at which a move that cuts ends."""
        levels = self.ends[self.cutting, 1, 2]
        return (levels.min(), levels.max()) if len(levels) and not self.is_turned else (0.0, 0.0)

    @cached_property
    def across(self) -> np.ndarray:
        """Whether each move has a component across the tool's axis; a turn of C may close."""
        curved = [move.kind == "arc" or move.start[C] != move.end[C] for move in self.moves]
        steps = np.abs(self.ends[:, 1, :2] - self.ends[:, 0, :2]).max(axis=1)
        return np.array(curved) | (steps > SAME_POINT)

    @property
    def x0_text(self) -> str:
        """The position of the X0 of a part that turns, "" where it is the machine's."""
        at = self.unit.text(self.program.zero[X])
        turns = self.path.part.turning and self.program.turning
        return f"X0, the spindle's axis, is at machine X{at}" if turns and at != "0" else ""

    @property
    def title(self) -> str:
        return self.program.file.stem

    @property
    def subtitle(self) -> str:
        """LinuxCNC's error if any, the machine, the time."""
        error = self.program.trace.error
        length = sum(map(self.path.part_length, self.fed))
        facts = [
            f"refused in line {error.line}: {error.rule}" if error else "",
            self.program.ini.path.name,
            f"cutting path {plain(length / self.unit.mm, 1)} {self.unit.name}",
            f"{clock(self.path.time[-1])} at the programmed feeds",
            f"run at {self.override:g}\u00a0%" if self.real and self.override != 100 else "",
        ]
        return " · ".join(filter(None, facts))


def scene_of(program: TracedProgram, units: str | None = None) -> Scene:
    """Return the scene of a traced program; without ``units`` in the program's."""
    return Scene(program, unit_of(program.trace.modes.gcodes, units))


def scene_of_judgement(
    judgement: Judgement, override: float = 100.0, units: str | None = None
) -> Scene:
    """Return the scene of a judged program.

    It is that of a cylinder's surface where all sections and holes are on one.
    """
    program = judgement.program
    radii = [cut.surface for cut in program.cuts if program.turning or program.is_round]
    surface = radii[0] if radii and all(radii) else 0.0
    placed = (each for each in judgement.of(FINDING) if each.place is not None)
    off = (deviation_of(cut, program).size for cut in program.cuts if cut.is_section)
    return Scene(
        program.on_surface(surface) if surface else program,
        unit_of(program.trace.modes.gcodes, units),
        override,
        [each for each in placed if bool(_surface_of(each, judgement)) == bool(surface)],
        _drawn_stock(judgement, bool(surface)),
        max(off, default=None),
        judgement.user_line,
    )


def _surface_of(found: Finding, judgement: Judgement) -> float:
    """Return the radius of the cylinder on which the place of a finding is, 0 on the face."""
    own = (cut for cut in judgement.program.cuts if cut.file == found.file)
    cut = next((each for each in own if each.line <= found.line <= each.last_line), None)
    return float(found.values.get("surface", cut.surface if cut else FACE))


def _drawn_stock(judgement: Judgement, unrolled: bool) -> DrawnStock | None:
    """Return the given stock, an unrolled bar all around, up to Z0."""
    solids = judgement.solids
    if not solids.stock:
        return None
    bottom = solids.bottom if math.isfinite(solids.bottom) else None
    around = box(-FAR, -FAR, FAR, judgement.program.z0)
    name = f"{'bar' if solids.stock.diameter else 'stock'} {solids.stock.text}"
    return DrawnStock(name, around if unrolled else solids.of(FACE).shape, solids.top(FACE), bottom)
