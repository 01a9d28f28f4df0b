# SPDX-License-Identifier: GPL-2.0-or-later
"""How far the tool is off the contour, the circles or the places that a planner reported, in mm."""

import math
import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple

import numpy as np
from shapely.geometry import MultiLineString

from g12.cut_report import CutElement, ThreadCut
from g12.geometry.curve import Arc, Curve, Line
from g12.tools.path.nearest import on_segments
from g12.tools.verify.model.cut import Cut, curve_points
from g12.tools.verify.model.finding import FINDING, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram, straight_down

WALL = 0.005  # of a circle: a tenth of what a tool's diameter is measured to
RUN = 0.001  # added for a run: one servo period at a usual feed, and the joint's resolution
ROUNDED = 0.03  # of a run beside its path where the material decides
NEIGHBOURS = 2  # curves before and after that a corner's arc may belong to
SHORT = 0.3  # mm: within that all
SAMPLES = 8  # of a move
SAME = 1e-3
BLENDED = re.compile(r"G64 P([0-9.]+)")
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


class _Group(NamedTuple):
    """The contour's curves of one line, with those near it; of a lead none."""

    line: int
    near: list[Curve]
    radius: float


def judge_deviations(program: TracedProgram, tolerance: float | None) -> Iterator[Finding]:
    for cut in program.cuts:
        found, allowed = deviation_of(cut, program), allowed_off(cut, program, tolerance)
        if found.point is not None and found.size > allowed + LAST_DECIMAL:
            at = program.words(found.move, found.point, cut.surface)
            line, file = program.where(found.move)
            values = {"off": found.size, "at": at, "allowed": allowed, "surface": cut.surface}
            yield Finding(OFF, line, values, found.point, file)
        elif program.real:
            yield from _run_off(cut, program)


def _run_off(cut: Cut, program: TracedProgram) -> Iterator[Finding]:
    """Yield where a run is beside its path, in a cut that comes out as programmed."""
    real = program.real
    own = np.flatnonzero(np.isin(real.move, [i for i in cut.moves if _fed(i, program)]))
    worst = own[real.deviation[own].argmax()] if len(own) else None
    if worst is not None and real.deviation[worst] > ROUNDED:
        index, point = int(real.move[worst]), real.points[worst]
        at = program.words(index, point, program.surface)
        values = {"off": real.deviation[worst], "at": at, "by": program.moves[index].line}
        yield Finding(RUN_OFF, cut.line, values, None, cut.file)


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
    before = (event.text for event in program.trace.events if event.at <= cut.at)
    paths = [BLENDED.match(text) for text in before if text.startswith("G6")]
    return float(paths[-1][1]) if paths and paths[-1] else 0.0


def deviation_of(cut: Cut, program: TracedProgram) -> Deviation:
    if cut.at >= cut.end:
        return Deviation()
    if cut.is_section:
        return _of_section(cut, program)
    if isinstance(cut.plan, ThreadCut):
        return _of_thread(cut, cut.plan, program)
    if cut.is_circle:
        return _of_circle(cut, program)
    return _of_holes(cut, program) if cut.places else _of_shape(cut, program)


def _fed(index: int, program: TracedProgram) -> bool:
    return program.moves[index].kind != "rapid"


def _sideways(cut: Cut, program: TracedProgram) -> Iterator[tuple[int, np.ndarray]]:
    """Yield the moves at feed across the tool's axis, with their points."""
    for index in filter(lambda i: _fed(i, program), cut.moves):
        points = program.tip(index, cut.surface)
        if len(points) > 1 and np.ptp(points[:, :2], axis=0).max() > SAME:
            yield index, points


def _of_section(cut: Cut, program: TracedProgram) -> Deviation:
    groups, at, worst, chords = _groups(cut), 0, Deviation(), None
    moves = groupby(_sideways(cut, program), key=lambda own: program.moves[own[0]].line)
    for line, own in moves:
        found = next((n for n in range(at, len(groups)) if groups[n].line == line), None)
        if found is None:
            continue
        at, group = found, groups[found]
        for index, points in own if group.near else ():
            for point in points[:: math.ceil(len(points) / SAMPLES)]:
                here = complex(*point[:2])
                off = _off_curves(here, group, worst.size)
                if off > max(worst.size, LAST_DECIMAL):  # a move may cut more lines than its own
                    chords = chords or _chords(cut)
                    off = min(off, _off_chords(here, *chords))
                if off > worst.size:
                    worst = Deviation(off, point, index)
    return worst


def _off_curves(at: complex, group: _Group, enough: float) -> float:
    """Return how far a point is off the nearest of some curves, or no more than is enough."""
    off = math.inf
    for curve in group.near:
        off = min(off, abs(curve.distance(at) - group.radius))
        if off <= enough:
            break
    return off


def _chords(cut: Cut) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return starts (n, 2), directions (n, 2) and cutter radii (n,) of all of a contour."""
    lines: list[tuple[complex, complex]] = []
    radii: list[float] = []
    for each in (each for each in cut.elements if each.end is not None):
        points = [cut.point(at) for at in (each.start, *curve_points(each))]
        lines += zip(points, points[1:])
        radii += [each.radius * cut.mm * bool(each.side)] * (len(points) - 1)
    ends = np.array([[(p.real, p.imag) for p in line] for line in lines])
    return ends[:, 0], ends[:, 1] - ends[:, 0], np.array(radii)


def _off_chords(at: complex, starts: np.ndarray, along: np.ndarray, radii: np.ndarray) -> float:
    point = np.array([at.real, at.imag])
    away = np.linalg.norm(on_segments(point, starts, along) - point, axis=1)
    return float(np.abs(away - radii).min())


def _groups(cut: Cut) -> list[_Group]:
    """Return the groups of a section; the first curve on either side is a lead."""
    found: list[_Group] = []
    elements = [each for each in cut.elements if each.end is not None]
    for side, grouped in groupby(elements, key=lambda each: each.side):
        run = list(grouped)
        lead = int(bool(side) or bool(found))
        curves, first = [section_curve(each, cut) for each in run], 0
        radius = run[0].radius * cut.mm if side else 0.0
        for line, own in groupby(run, key=lambda each: each.line):
            last = first + len(list(own))
            near = _around_group(curves, first, last, lead) if first >= lead else []
            found.append(_Group(line, near, radius))
            first = last
    return found


def _around_group(curves: Sequence[Curve], first: int, last: int, least: int) -> list[Curve]:
    """Return curves, then those beside them that a move may cut as well: CAM's are short."""
    begin, end = max(first - NEIGHBOURS, least), min(last + NEIGHBOURS, len(curves))
    while begin > least and abs(curves[begin].start - curves[first].start) < SHORT:
        begin -= 1
    while end < len(curves) and abs(curves[end - 1].end - curves[last - 1].end) < SHORT:
        end += 1
    return [*curves[first:last], *curves[begin:first], *curves[last:end]]


def section_curve(element: CutElement, cut: Cut) -> Curve:
    start, end = cut.point(element.start), cut.point(element.end)
    if element.centre is None:
        return Line(start, end)
    return Arc(start, cut.point(element.centre), element.sweep)


def circles_of(cut: Cut, program: TracedProgram) -> dict[int, float]:
    """Return the arcs about a circle's centre by their moves: the radius of the tool's centre."""
    centre, found = np.array(cut.centre), {}
    for index in cut.moves:
        move = program.moves[index]
        if move.kind == "arc" and (cut.upright or np.abs(move.centre[:2] - centre).max() < SAME):
            found[index] = move.radius
    return found


def off_circles(cut: Cut, program: TracedProgram) -> Deviation:
    """Return how far off its circles a run is."""
    real = program.real
    if not real or cut.upright:
        return Deviation(0.0, None, cut.at)
    own = np.flatnonzero(np.isin(real.move, list(circles_of(cut, program))))
    if not len(own):
        return Deviation(0.0, None, cut.at)
    worst = own[real.deviation[own].argmax()]
    return Deviation(float(real.deviation[worst]), real.points[worst], int(real.move[worst]))


def _of_circle(cut: Cut, program: TracedProgram) -> Deviation:
    rings, off = circles_of(cut, program), off_circles(cut, program)
    if not rings or cut.upright:
        return off
    index, outermost = max(rings.items(), key=lambda ring: ring[1])
    reached = abs(outermost + cut.cutter - (cut.wall if cut.cutter else outermost))
    if cut.has_boss:
        index, innermost = min(rings.items(), key=lambda ring: ring[1])
        reached = abs(innermost - cut.cutter - cut.inner)
    return max(Deviation(reached, program.tip(index, 0.0)[0], index), off, key=lambda d: d.size)


def _of_thread(cut: Cut, thread: ThreadCut, program: TracedProgram) -> Deviation:
    """Return how far a thread is off its radius, its groove, or its ends.

    The half circles belong to the groove as well, as far as they are at its radius.
    """
    moves = list(_sideways(cut, program))
    if not moves or not cut.cutter:
        return Deviation()
    points = np.concatenate([points for _, points in moves])
    own = np.repeat([index for index, _ in moves], [len(points) for _, points in moves])
    at = points[:, 0] + 1j * points[:, 1] - complex(*cut.centre)
    z, side = points[:, 2] - cut.zero[2], 1 if thread.outside else -1
    finished = thread.small if thread.outside else thread.large
    wall = finished * cut.mm + thread.taper * (z - thread.top * cut.mm)
    beside = side * (np.abs(at) - wall) - cut.cutter
    nearest = int(beside.argmin())
    pitch = thread.pitch * cut.mm
    cutting = np.flatnonzero(beside < beside[nearest] + WALL)
    at, z = at[cutting], z[cutting]
    groove = np.exp(2j * np.pi * z / pitch) * at.conj()
    along = np.abs(np.angle(groove * groove[0].conj())) * abs(pitch) / (2 * np.pi)
    top, bottom = thread.top * cut.mm, thread.levels[0] * cut.mm
    beyond = (thread.teeth - 1) * abs(pitch)
    short = max(z.min() - bottom - abs(pitch), top - z.max() - beyond, 0.0)
    worst = cutting[along.argmax()]
    found = (abs(beside[nearest]), nearest), (float(along.max()), worst), (short, nearest)
    size, place = max(found, key=lambda each: each[0])
    return Deviation(float(size), points[place], int(own[place]))


def _of_shape(cut: Cut, program: TracedProgram) -> Deviation:
    low = cut.zero[2] - SAME
    lines = [(i, points) for i, points in _sideways(cut, program) if points[:, 2].max() < low]
    if not lines or not cut.cutter:
        return Deviation()
    stays = cut.stays[0][0]
    away = stays.distance(MultiLineString([points[:, :2] for _, points in lines]))
    return Deviation(abs(away - cut.cutter), lines[0][1][0], lines[0][0])


def _of_holes(cut: Cut, program: TracedProgram) -> Deviation:
    bottoms = []
    for index in cut.moves:
        points = program.tip(index, cut.surface)
        if straight_down(points) and _fed(index, program):
            bottoms.append((index, points[points[:, 2].argmin()]))
    worst = Deviation()
    for place in cut.places if bottoms else ():
        away = [
            (math.dist(_around(p, place, cut), (place.real, place.imag)), i, p) for i, p in bottoms
        ]
        size, index, point = min(away, key=lambda each: each[0])
        worst = max(worst, Deviation(size, point, index), key=lambda each: each.size)
    return worst


def _around(point: np.ndarray, place: complex, cut: Cut) -> tuple[float, float]:
    """Return a point of a surface, turned to the place's turn of C."""
    turn = 2 * math.pi * cut.surface
    whole = turn * round((place.real - point[0]) / turn) if turn else 0.0
    return point[0] + whole, point[1]
