# SPDX-License-Identifier: GPL-2.0-or-later
"""How far the tool is off the contour or the circles that a planner reported, in mm."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from shapely.geometry import MultiLineString

from g12.cut_report import CutElement
from g12.tools.path.part import on_segments
from g12.tools.verify.model.cut import Cut, curve_points
from g12.tools.verify.model.finding import FINDING, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram

WALL = 0.005  # of a circle: a tenth of what a tool's diameter is measured to
RUN = 0.001  # added for a run: one servo period at a usual feed, and the joint's resolution
ROUNDED = 0.03  # of a run beside its path where the material decides
SAMPLES = 8  # of a move
TOGETHER = 32  # moves that are compared with the contour at once
AROUND = 0.2  # mm: a move that is off its contour by less is measured from what is near it
SAME = 1e-3
CHORD = 1e-4  # of arcs
LAST_DECIMAL = 1e-3  # mm: words are rounded, and so are the chords that are measured
OFF = kind("off", FINDING, "it is {off:fine} off its contour at {at:xyz} ({allowed:fine} allowed)")
RUN_OFF = kind(
    "run-off", WARNING, "the run is {off:fine} beside its path at {at:xyz}, in line {by}"
)


class Deviation(NamedTuple):
    """How far off, and where: a point of the part, in a move."""

    size: float = 0.0
    point: Sequence[float] | None = None
    move: int = 0


def judge_deviations(
    found_of: Sequence[Deviation], program: TracedProgram, tolerance: float | None
) -> Iterator[Finding]:
    for cut, found in zip(program.cuts, found_of):
        allowed = allowed_off(cut, program, tolerance)
        beside = _of_run(cut.fed, program)
        if found.point is not None and found.size > allowed + LAST_DECIMAL:
            at = program.words(found.move, found.point, cut.surface)
            values = {"off": found.size, "at": at, "allowed": allowed, "surface": cut.surface}
            yield program.found(OFF, found.move, found.point, **values)
        elif beside.point is not None and beside.size > ROUNDED:
            at = program.words(beside.move, beside.point, program.surface)
            line = program.moves[beside.move].line
            yield cut.found(RUN_OFF, off=beside.size, at=at, by=line)


def allowed_off(cut: Cut, program: TracedProgram, tolerance: float | None) -> float:
    """Return what a cut may be off; a run's sections RUN more than POLAR_TOLERANCE.

    Elsewhere a run may round its corners by P of the program's G64.
    """
    if tolerance is not None:
        return tolerance
    if not program.turning:
        return WALL + (_blending(cut, program) if program.real else 0.0)
    ini = program.ini
    return ini.settings.tolerance(ini.mm) * ini.mm + RUN * bool(program.real)


def _blending(cut: Cut, program: TracedProgram) -> float:
    """Return P of the G64 in force where a cut begins, mm."""
    tolerance = re.match(r"G64 P([0-9.]+)", program.last("G6", cut.at))
    return float(tolerance[1]) if tolerance else 0.0


def deviation_of(cut: Cut, program: TracedProgram) -> Deviation:
    if cut.at >= cut.end or cut.upright:
        return Deviation()
    if cut.is_section:
        return _of_section(cut, program)
    if cut.is_circle:
        return max(_of_wall(cut, program), off_circles(cut, program), key=lambda each: each.size)
    return _of_shape(cut, program) if cut.is_shape else _of_run(cut.fed, program)


def _of_run(moves: Iterable[int], program: TracedProgram) -> Deviation:
    """Return how far a run is off its path in some moves."""
    real = program.real
    own = np.flatnonzero(np.isin(real.move, list(moves))) if real else ()
    if not real or not len(own):
        return Deviation()
    worst = own[real.deviation[own].argmax()]
    return Deviation(float(real.deviation[worst]), real.points[worst], int(real.move[worst]))


def _sideways(cut: Cut, program: TracedProgram) -> Iterator[tuple[int, np.ndarray]]:
    """Yield the moves at feed across the tool's axis, with their points."""
    for index in cut.fed:
        points = program.tip(index, cut.surface)
        if len(points) > 1 and np.ptp(points[:, :2], axis=0).max() > SAME:
            yield index, points


# ------------------------------------------------------------ sections


class _Contour:
    """The chords of a contour with its leads: starts and directions (n, 2), cutter radii (n,)."""

    def __init__(self, cut: Cut) -> None:
        drawn = [each for each in cut.elements if each.end is not None]
        rows = [(*chord, cut.offset(each)) for each in drawn for chord in _chords(each, cut)]
        starts, ends, self.radii = map(np.array, zip(*rows)) if rows else (np.empty(0),) * 3
        self.starts, self.ends = (np.stack([at.real, at.imag], axis=-1) for at in (starts, ends))
        self.low, self.high = np.minimum(self.starts, self.ends), np.maximum(self.starts, self.ends)
        self.around = self.radii.max(initial=0.0) + AROUND

    def off(self, points: np.ndarray) -> np.ndarray:
        """Return how far points (n, 2) are off, each from the chord that it fits best."""
        low, high = points.min(axis=0) - self.around, points.max(axis=0) + self.around
        near = np.all((self.low <= high) & (self.high >= low), axis=1)
        near = near if near.any() else ~near
        starts, at = self.starts[near], points[:, None]
        away = np.linalg.norm(on_segments(at, starts, self.ends[near] - starts) - at, axis=2)
        return np.abs(away - self.radii[near]).min(axis=1)


def _chords(element: CutElement, cut: Cut) -> Iterable[tuple[complex, complex]]:
    points = [cut.point(at) for at in (element.start, *curve_points(element, CHORD / cut.mm))]
    return zip(points, points[1:])


def _of_section(cut: Cut, program: TracedProgram) -> Deviation:
    """Return how far the moves of a section's contour are off it, without those of leads."""
    contour, worst, lines = _Contour(cut), Deviation(), cut.contour_lines
    own = [each for each in _sideways(cut, program) if program.moves[each[0]].line in lines]
    for first in range(0, len(own), TOGETHER):
        indices, whole = zip(*own[first : first + TOGETHER])
        paths = [points[:: math.ceil(len(points) / SAMPLES)] for points in whole]
        points, moves = np.concatenate(paths), np.repeat(indices, [len(each) for each in paths])
        off = contour.off(points[:, :2])
        if off.max() > worst.size:
            at = off.argmax()
            worst = Deviation(float(off[at]), points[at], int(moves[at]))
    return worst


# ------------------------------------------------------------ circles and shapes


def circles_of(cut: Cut, program: TracedProgram) -> dict[int, float]:
    """Return the arcs about a circle's centre by their moves: the radius of the tool's centre."""
    arcs = [index for index in cut.moves if program.moves[index].kind == "arc"]
    moves, centre = program.moves, None if cut.upright else cut.centre
    own = (i for i in arcs if not centre or math.dist(moves[i].centre[:2], centre) < SAME)
    return {index: moves[index].radius for index in own}


def off_circles(cut: Cut, program: TracedProgram) -> Deviation:
    """Return how far off its circles a run is."""
    return Deviation() if cut.upright else _of_run(circles_of(cut, program), program)


def _of_wall(cut: Cut, program: TracedProgram) -> Deviation:
    """Return how far the cutter's edge on the outermost circle, of a boss the innermost, is off."""
    rings = circles_of(cut, program)
    if not rings or not cut.cutter or getattr(cut.plan, "taper", None):
        return Deviation()
    index = (min if cut.is_boss else max)(rings, key=rings.__getitem__)
    edge = rings[index] + (-cut.cutter if cut.is_boss else cut.cutter)
    off = abs(edge - (cut.inner if cut.is_boss else cut.wall))
    return Deviation(off, program.moves[index].start[:3], index)


def _of_shape(cut: Cut, program: TracedProgram) -> Deviation:
    low = cut.zero[2] - SAME
    lines = [(i, points) for i, points in _sideways(cut, program) if points[:, 2].max() < low]
    if not lines or not cut.cutter:
        return Deviation()
    stays = cut.stays[0][0]
    away = stays.distance(MultiLineString([points[:, :2] for _, points in lines]))
    return Deviation(abs(away - cut.cutter), lines[0][1][0], lines[0][0])
