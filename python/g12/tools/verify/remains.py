# SPDX-License-Identifier: GPL-2.0-or-later
"""The second and third question to the material, at each cut.

What remains inside of it, what is gone outside of it; does it remove nothing, or go too deep?
"""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from shapely.geometry import LineString
from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.cut_report import PolygonCut, RoundPocketCut, ThreadCut
from g12.tools.path.part import disc, swept
from g12.tools.verify.model.cut import NOTHING, Cut
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.solid import JUST_ABOVE, Solids, pieces, reachable

SLACK = 0.02  # mm: boundaries are compared with so much less
LEAST_GONE, LEAST_LEFT = 0.1, 0.5  # mm², of what should stand, of what should not
UNCUT = kind("uncut", FINDING, "{area:mm2} of material remain uncut at Z{level:mm}")
BAR = kind(
    "bar-remains",
    FINDING,
    "{area:mm2} of the bar remain at Z{level:mm} on the tool's side of the contour",
)
CORE = kind("core", WARNING, "a core of {area:mm2} remains in its middle")
OVERCUT = kind("overcut", FINDING, "{area:mm2} of what it leaves are cut away in line {by}")
MEETS = kind("meets", WARNING, "it and the cut of line {other} go into each other's walls")
BOSS = kind("boss", FINDING, "nothing of its boss remains")
WALL = kind("wall", FINDING, "its wall is cut {over:fine} too far, at {at:xyz}")
LEVEL = 1e-3  # mm
DEEPEST = 3.0  # times a cutter's radius: few pockets are milled so deep at once
AIR = kind("air", FINDING, "it cuts nothing: it stays {above:length} above the part{hint}")
BESIDE = kind("no-stock-met", FINDING, "it meets nothing of the stock")
BEFORE = kind("cut-before", WARNING, "all of it was cut before: {why}?")
SPRING, SIZE = "a spring pass, or the wrong place", "is its hole too large, its boss too small"
UPRIGHT = kind("upright", NOT_JUDGED, "the material around a circle in another plane than G17")
OUTSIDE = kind("outside", WARNING, "a portion of it lies outside of the stock")
DEEP = kind("deep-pass", WARNING, "it cuts {deep:length} deep at once: cutter ⌀ {cutter:mm}")
MINUS, DOWN = ": a lost minus sign?", ": no move down to the depth before it?"
NO_DEPTH = ("yasnac", "mitsubishi")  # whose blocks have no Z


def judge_cuts(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    for cut in program.cuts:
        if cut.at >= cut.end:
            continue
        if cut.upright:
            yield cut.found(UPRIGHT)
        elif cut.radius > 0 and program.stretch_at(cut.at).is_known:
            yield from too_far(cut, solids)
            yield from remaining(cut, solids)
            yield from gone(cut, program, solids)
            yield from in_air(cut, solids)
    yield from meeting(program)


# ------------------------------------------------------------ what should be gone


def remaining(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield what should be gone and stands at the program's end."""
    level = cut.floor - cut.zero[2]
    left = NOTHING
    core = left_of(cut.core, cut, solids)
    if cut.is_section:  # a contour round the inside is no pocket
        inside = (left_of(o.polygon, cut, solids, o.level) for o in cut.pockets)
        core = unary_union([NOTHING, *(each.buffer(-cut.radius / 2) for each in inside)])
    elif not _is_cleared(cut, solids):
        left = left_of(cut.goes, cut, solids)
    if left.area > LEAST_GONE:
        middle = cut.centre if cut.is_circle else left.representative_point().coords[0]
        values = {"area": left.area, "level": level, "shape": left, "floor": cut.floor}
        yield cut.found(UNCUT, (*middle, cut.floor), **values)
    if core.area > LEAST_GONE and not cut.is_ring:  # whose core is meant
        yield cut.found(CORE, area=core.area)
    for region, floor in _beyond(cut, solids):
        beyond = left_of(region, cut, solids, floor)
        if beyond.area > LEAST_LEFT:
            place = (*beyond.representative_point().coords[0], floor)
            yield cut.found(BAR, place, area=beyond.area, level=floor - cut.zero[2])
            return


def _is_cleared(cut: Cut, solids: Solids) -> bool:
    """Return whether a circle's own rings clear it: seen without any geometry."""
    edges = cut.inner + SLACK, cut.wall - SLACK
    level = cut.floor + JUST_ABOVE
    return cut.is_circle and solids.of(cut.surface).has_cleared(cut.centre, edges, level)


def left_of(
    region: BaseGeometry, cut: Cut, solids: Solids, level: float | None = None
) -> BaseGeometry:
    """Return what stands of a region at a level, a cut's floor by default.

    What is narrower than two slacks is left out.
    """
    level = cut.floor if level is None else level
    if region.is_empty or solids.standing(region.buffer(-SLACK), level, cut.surface).is_empty:
        return NOTHING  # no more than a rim, of chords and rounding
    area = solids.standing(region, level, cut.surface)
    return area.buffer(-SLACK, join_style=2).buffer(SLACK, join_style=2)


def _beyond(cut: Cut, solids: Solids) -> Iterator[tuple[BaseGeometry, float]]:
    """Yield what of a given bar lies on the tool's side of a contour, and the contour's level.

    It reaches as far as a cutter. An open contour goes on straight at its ends.
    """
    if cut.surface or not solids.given_bar:
        return
    bar, radius = solids.of(cut.surface).shape, cut.radius
    whole = bar.buffer(3 * radius)
    if isinstance(cut.plan, PolygonCut):
        outside = bar.difference(cut.stays[0][0])
        yield reachable(outside, radius).intersection(bar), cut.floor
    for outline in cut.outlines:
        if outline.is_closed:
            outside = NOTHING if outline.tool_inside else whole.difference(outline.polygon)
            yield reachable(outside, radius).intersection(bar), outline.level
            continue
        points = outline.points
        far = 4.0 * max(bar.bounds[2], float(np.abs(points).max()))
        first, last = points[0] - points[1], points[-1] - points[-2]
        ends = points[0] + far * first / abs(first), points[-1] + far * last / abs(last)
        line = LineString([(p.real, p.imag) for p in (ends[0], *points, ends[1])])
        beside = line.buffer(far if outline.left else -far, single_sided=True, join_style=2)
        outside = whole.intersection(beside)
        yield reachable(outside, radius).intersection(bar), outline.level


# ------------------------------------------------------------ what should stand


def too_far(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield what a circle's own moves remove beyond its wall: D is not the cutter that cuts."""
    if not cut.is_circle or cut.is_boss:
        return
    for sweep in solids.of(cut.surface).sweeps_of(cut.moves):
        point = sweep.farthest(cut.centre)
        over = math.dist(point, cut.centre) + sweep.radius - cut.wall
        if over > SLACK:
            place = (*point, sweep.level)
            at = solids.program.words(cut.at, place, cut.surface)
            yield cut.found(WALL, place, over=over, at=at)
            return


def gone(cut: Cut, program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    """Yield what should stay of the part beside a cut, and is cut away by what does not mean to.

    What the planner compensated stays off its own contour. Its leads do not, nor do cuts round
    another island, or moves at feed that belong to no cut.
    """
    if cut.is_boss and _is_boss_gone(cut, solids):
        yield cut.found(BOSS, (*cut.centre, cut.floor))
        return
    if not cut.stays:
        return
    others = (each for each in program.cuts if each is not cut and each.surface == cut.surface)
    meant = unary_union([NOTHING, *(each.goes for each in others)])
    for stays, level in cut.stays:
        if level > solids.top(cut.surface) - JUST_ABOVE:
            continue
        region = stays.intersection(solids.of(cut.surface).shape).buffer(-2 * SLACK)
        swept, by = _cut_away(cut, region.difference(meant), program, solids)
        if by is not None:
            at = swept.representative_point()
            line, file = program.where(by)
            where = f"{line} of {file}" if file else line
            yield cut.found(OVERCUT, (at.x, at.y, level), area=swept.area, by=where)
            return


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
        plain = (each for each in program.stretches if not each.is_rapid and not each.cut)
        moves += [index for each in plain for index in each.moves]
    swept, first = solids.swept_in(region, moves, cut.surface)
    if swept.area > LEAST_GONE:  # less what the contour itself has taken, where it crosses itself
        kept_off = [i for i in cut.moves if program.moves[i].line not in loose]
        swept = swept.difference(solids.swept_in(swept, kept_off, cut.surface)[0])
    return swept, first if swept.area > LEAST_GONE else None


def meeting(program: TracedProgram) -> Iterator[Finding]:
    """Yield pockets, bosses and holes of a plane that go into each other's walls."""
    first: dict[tuple, Cut] = {}  # of equal circles
    for cut in program.cuts:
        for centre, wall in discs_of(cut):
            first.setdefault((centre, wall, cut.zero[2]), cut)
    centres = np.array([centre for centre, _, _ in first], complex)
    walls, heights = np.array([sizes for _, *sizes in first], float).reshape(-1, 2).T
    of = np.array([cut.index for cut in first.values()])
    met: dict[tuple[int, int], Finding] = {}
    for index, cut in enumerate(first.values()):
        apart, own = np.abs(centres[:index] - centres[index]), walls[index]
        within = apart <= np.abs(walls[:index] - own) + SLACK
        level = np.abs(heights[:index] - heights[index]) < SLACK
        walled = (apart < walls[:index] + own - SLACK) & ~within & level
        for other in map(int, np.unique(of[:index][walled])):
            line = program.cuts[other].line
            met.setdefault((cut.index, other), cut.found(MEETS, other=line))
    yield from met.values()


def discs_of(cut: Cut) -> Iterator[tuple[complex, float]]:
    """Yield the circles of a cut on the face or in XY: the centre and the wall's radius."""
    if cut.is_circle and not cut.upright:
        yield complex(*cut.centre), cut.wall
    elif isinstance(cut.plan, RoundPocketCut):
        middle = cut.goes.centroid
        yield complex(middle.x, middle.y), cut.plan.diameter * cut.mm / 2
    elif cut.places and not cut.surface and cut.at < cut.end:
        yield from ((at, cut.radius) for at in cut.places)


# ------------------------------------------------------------ a cut in the air, or too deep


def in_air(cut: Cut, solids: Solids) -> Iterator[Finding]:
    program, material, top = solids.program, solids.of(cut.surface), solids.top(cut.surface)
    place = program.tip(cut.at, cut.surface)[0]
    if not material.sweeps_of(cut.moves):
        tips = (program.tip(index, cut.surface) for index in cut.fed)
        above = min((tip[:, 2].min() for tip in tips), default=math.inf) - top
        hint = DOWN if program.dialects.get(cut.code) in NO_DEPTH else MINUS
        yield cut.found(AIR, place, above=above, hint=hint if above > LEVEL else "")
    elif not material.removes(cut.moves):
        if not solids.is_met(cut):
            yield cut.found(BESIDE, place)
        elif not cut.is_tap:
            yield cut.found(BEFORE, place, why=SIZE if isinstance(cut.plan, ThreadCut) else SPRING)
    elif solids.stock and material.beyond(_wanted(cut)) > LEAST_GONE:
        yield cut.found(OUTSIDE, place)
    if cut.levels and program.dialects.get(cut.code) != "bore":  # cuts by its helices
        yield from _deep(cut, solids)


def _deep(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield a first level that is far below what stands, or a level far below the one before."""
    top, levels, radius = solids.top(cut.surface), cut.levels, cut.radius
    if cut.is_section:
        levels = [level for level in cut.steps_down if level < top] or levels
    steps = [upper - lower for upper, lower in pairwise(levels)]
    high = levels[0] + DEEPEST * radius
    if high < top:
        wanted = cut.goes
        if wanted.is_empty and (cut.is_section or cut.is_shape):
            tips = [solids.program.tip(index, cut.surface) for index in cut.fed]
            wanted = swept(
                (part for tip in tips if tip[:, 2].max() < top for part in pieces(tip)), radius
            )
        standing = solids.standing(wanted, high, cut.surface, before=cut.at)
        steps += [top - levels[0]] if standing.area > math.pi * radius**2 else []
    if max(steps, default=0.0) > DEEPEST * radius:
        yield cut.found(DEEP, deep=max(steps), cutter=2 * radius)


def _wanted(cut: Cut) -> BaseGeometry:
    """Return what a pocket, a shape or holes are to remove."""
    holes = [disc((at.real, at.imag), cut.radius) for at in cut.places]
    return unary_union([NOTHING if cut.is_section else cut.goes, *holes])
