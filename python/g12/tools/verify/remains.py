# SPDX-License-Identifier: GPL-2.0-or-later
"""The second question to the material: what remains inside a cut, what is gone outside of it."""

from collections.abc import Iterator

import numpy as np
from shapely.geometry import LineString, Point
from shapely.geometry.base import BaseGeometry
from shapely.ops import split, unary_union

from g12.cut_report import PolygonCut
from g12.tools.verify.model.cut import NOTHING, Cut, Outline
from g12.tools.verify.model.finding import FINDING, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.solid import JUST_ABOVE, Solids, reachable

SLACK = 0.02  # mm: boundaries are compared with so much less
LEAST_GONE, LEAST_LEFT = 0.1, 0.5  # mm², of what should stand, of what should not
LIFT = 0.01  # mm beside a contour
UNCUT = kind("uncut", FINDING, "{area:mm2} of material remain uncut at Z{level:mm}")
BAR = kind("bar-remains", FINDING, "{area:mm2} of the bar remain beyond the contour at Z{level:mm}")
CORE = kind("core", WARNING, "a core of {area:mm2} remains in its middle")
OVERCUT = kind("overcut", FINDING, "{area:mm2} of what it leaves are cut away in line {by}")
WALL = kind("wall", FINDING, "its wall is cut {over:fine} too far, at {at:xyz}")
BOSS = kind("boss", FINDING, "nothing of its boss remains")
MEETS = kind("meets", WARNING, "it and the cut of line {other} go into each other's walls")


def judge_remains(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    for cut in program.cuts:
        if cut.upright or cut.at >= cut.end or program.cutter(cut.at) <= 0:
            continue
        if program.is_known(cut.at):
            yield from too_far(cut, solids)
            yield from remaining(cut, solids)
            yield from gone(cut, program, solids)
    yield from meeting([cut for cut in program.cuts if cut.is_circle and not cut.upright])


# ------------------------------------------------------------ what should be gone


def remaining(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield what should be gone and stands at the program's end."""
    radius = solids.program.cutter(cut.at)
    left = left_of(cut.goes, cut, solids)
    if cut.is_section:  # a contour round the inside is no pocket
        yield from _core(cut, left.buffer(-radius / 2))
        left = NOTHING
    if left.area > LEAST_GONE:
        level = cut.floor - cut.zero[2]
        values = {"area": left.area, "level": level, "shape": left, "floor": cut.floor}
        place = (*_middle_of(cut, left), cut.floor)
        yield Finding(UNCUT, cut.line, values, place, cut.file)
    yield from _bar(cut, solids, radius)
    if not cut.is_ring:  # whose core is meant
        yield from _core(cut, left_of(cut.core, cut, solids))


def _middle_of(cut: Cut, left: BaseGeometry) -> tuple[float, float]:
    at = left.representative_point()
    return cut.centre if cut.is_circle else (at.x, at.y)


def left_of(region: BaseGeometry, cut: Cut, solids: Solids) -> BaseGeometry:
    """Return what stands of a region at a cut's floor, without what is narrower than two slacks."""
    if solids.standing(region.buffer(-SLACK), cut.floor, cut.surface).is_empty:
        return NOTHING  # no more than a rim, of chords and rounding
    area = solids.standing(region, cut.floor, cut.surface)
    return area.buffer(-SLACK, join_style=2).buffer(SLACK, join_style=2)


def _core(cut: Cut, core: BaseGeometry) -> Iterator[Finding]:
    if core.area > LEAST_GONE:
        yield Finding(CORE, cut.line, {"area": core.area}, file=cut.file)


def _bar(cut: Cut, solids: Solids, radius: float) -> Iterator[Finding]:
    """Yield what stands of a given bar on the tool's side of a contour."""
    if cut.surface or not (solids.stock and solids.stock.diameter):
        return
    bar = solids.shape(cut.surface)
    beyond = [beyond_contour(outline, bar, radius) for outline in cut.outlines]
    if isinstance(cut.plan, PolygonCut):
        beyond = [reachable(bar.difference(cut.stays[0][0]), radius)]
    left = left_of(unary_union([NOTHING, *beyond]), cut, solids)
    if left.area > LEAST_LEFT:
        at = left.representative_point()
        values = {"area": left.area, "level": cut.floor - cut.zero[2]}
        yield Finding(BAR, cut.line, values, (at.x, at.y, cut.floor), cut.file)


def beyond_contour(outline: Outline, bar: BaseGeometry, cutter: float) -> BaseGeometry:
    """Return what of a bar lies on the tool's side of a contour, as far as a cutter reaches."""
    whole = bar.buffer(3 * cutter)
    if outline.is_closed:
        outside = NOTHING if outline.tool_inside else whole.difference(outline.polygon)
        return reachable(outside, cutter).intersection(bar)
    points = outline.points
    far = 4.0 * max(bar.bounds[2], float(np.abs(points).max()))
    before = points[0] + far * _unit(points[0] - points[1])
    after = points[-1] + far * _unit(points[-1] - points[-2])
    line = LineString([(p.real, p.imag) for p in (before, *points, after)])
    middle = len(points) // 2
    lift = LIFT if outline.left else -LIFT
    beside = (points[middle] + points[middle - 1]) / 2
    beside += 1j * lift * _unit(points[middle] - points[middle - 1])
    own = [
        each for each in split(whole, line).geoms if each.contains(Point(beside.real, beside.imag))
    ]
    return reachable(unary_union([NOTHING, *own]), cutter).intersection(bar)


def _unit(direction: complex) -> complex:
    return direction / abs(direction)


# ------------------------------------------------------------ what should stand


def too_far(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield what a circle's own moves remove beyond its wall: D is not the cutter that cuts."""
    if not cut.is_circle or cut.has_boss:
        return
    for sweep in solids.made_by(cut):
        away = np.hypot(*(sweep.line - cut.centre).T)
        over = float(away.max()) + sweep.radius - cut.wall
        if over > SLACK:
            place = (*sweep.line[away.argmax()], sweep.level)
            at = solids.program.words(cut.at, place, cut.surface)
            yield Finding(WALL, cut.line, {"over": over, "at": at}, place, cut.file)
            return


def gone(cut: Cut, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield what should stay of the part beside a cut, and is cut away by what does not mean to.

    What the planner compensated stays off its own contour. Its leads do not, nor do cuts round
    another island, or moves at feed that belong to no cut.
    """
    if cut.has_boss and _is_boss_gone(cut, solids):
        yield Finding(BOSS, cut.line, {}, (*cut.centre, cut.floor), cut.file)
        return
    if not cut.stays:
        return
    others = [each for each in program.cuts if each is not cut and each.surface == cut.surface]
    meant = unary_union([NOTHING, *(each.goes for each in others)])
    for stays, level in cut.stays:
        if level > solids.top(cut.surface) - JUST_ABOVE:
            continue
        region = stays.intersection(solids.shape(cut.surface)).buffer(-2 * SLACK)
        swept, by = _cut_away(cut, region.difference(meant), program, solids)
        if by is not None:
            at = swept.representative_point()
            line, file = program.where(by)
            values = {"area": swept.area, "by": f"{line} of {file}" if file else line}
            yield Finding(OVERCUT, cut.line, values, (at.x, at.y, level), cut.file)
            return
    yield from islands_cut(cut, others, solids)


def _is_boss_gone(cut: Cut, solids: Solids) -> bool:
    boss, middle = cut.stays[0][0].buffer(-2 * SLACK), (cut.floor + solids.top(cut.surface)) / 2

    def stands(level: float, before: float) -> bool:
        return solids.standing(boss, level, cut.surface, before).area > LEAST_GONE

    lowered = stands(middle, cut.at) and not stands(middle, np.inf)
    return lowered or not stands(cut.floor, cut.at)


def _cut_away(
    cut: Cut, region: BaseGeometry, program: TracedProgram, solids: Solids
) -> tuple[BaseGeometry, int | None]:
    """Return what of a region loose moves cut, and the first of them, None if none does."""
    loose = cut.loose_lines
    moves = [i for i in cut.moves if program.moves[i].line in loose]
    if cut.island.area:
        moves += [
            i for i, m in enumerate(program.moves) if m.kind != "rapid" and not program.cut_at(i)
        ]
    swept, first = solids.swept_in(region, moves, cut.surface)
    if swept.area > LEAST_GONE:  # less what the contour itself has taken, where it crosses itself
        kept_off = [i for i in cut.moves if program.moves[i].line not in loose]
        swept = swept.difference(solids.swept_in(swept, kept_off, cut.surface)[0])
    return swept, first if swept.area > LEAST_GONE else None


def islands_cut(cut: Cut, others: list[Cut], solids: Solids) -> Iterator[Finding]:
    """Yield a cut round another island that goes into this one's, at the same depth.

    That of a finer pass lies within it. Two that cross may be meant: a hexagon twice makes twelve.
    """
    island = cut.island.buffer(-2 * SLACK)
    for other in others if not island.is_empty else ():
        apart = abs(other.floor - cut.floor) > SLACK or other.island.is_empty
        if apart or cut.island.buffer(SLACK).covers(other.island):
            continue
        if solids.swept_in(island, other.moves, cut.surface)[0].area > LEAST_GONE:
            yield Finding(MEETS, cut.line, {"other": other.line}, file=cut.file)
            return


def meeting(circles: list[Cut]) -> Iterator[Finding]:
    """Yield pockets and bosses that go into each other's walls."""
    heights = np.array([cut.zero[2] for cut in circles])
    centres = np.array([complex(*cut.centre) for cut in circles])
    walls = np.array([cut.wall for cut in circles])
    for index, cut in enumerate(circles):
        apart, own = np.abs(centres[:index] - centres[index]), walls[index]
        within = apart <= np.abs(walls[:index] - own) + SLACK
        level = np.abs(heights[:index] - heights[index]) < SLACK
        for other in np.flatnonzero((apart < walls[:index] + own - SLACK) & ~within & level):
            yield Finding(MEETS, cut.line, {"other": circles[other].line}, file=cut.file)
