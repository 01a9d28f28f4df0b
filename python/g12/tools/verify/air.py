# SPDX-License-Identifier: GPL-2.0-or-later
"""The third question: does a cut remove nothing, or lie outside the material or below it."""

import math
from collections.abc import Iterator
from itertools import pairwise

from g12.cut_report import PolygonCut
from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.finding import FINDING, NOT_JUDGED, WARNING, Finding, kind
from g12.tools.verify.model.program import TracedProgram
from g12.tools.verify.model.solid import Solids
from g12.tools.verify.remains import LEAST_GONE

LEVEL = 1e-3  # mm
DEEPEST = 3.0  # times a cutter's radius: few pockets are milled so deep at once
THROUGH = 2.0  # mm below the block: more is no through hole
AIR = kind("air", FINDING, "it cuts nothing: it stays {above:length} above the part{hint}")
BESIDE = kind("no-stock-met", FINDING, "it meets nothing of the stock")
BEFORE = kind("cut-before", WARNING, "all of it was cut before: a spring pass, or the wrong place?")
EMPTY = kind("empty", WARNING, "{code} moves nothing")
UPRIGHT = kind("upright", NOT_JUDGED, "the material around a circle in another plane than G17")
OUTSIDE = kind("outside", WARNING, "a portion of it lies outside of the stock")
AIR_CONTOUR = kind("air-contour", WARNING, "its contour stays above the part, others are below")
AIR_LEVELS = kind("air-levels", WARNING, "{n} of its {of} levels cut nothing, above the part")
DEEP = kind("deep-pass", WARNING, "it cuts {deep:length} deep at once: cutter ⌀ {cutter:mm}")
ABOVE_ZERO = kind("above-zero", WARNING, "nothing of it is below Z0: is that the part's face?")
BELOW = kind("below-stock", FINDING, "it goes {below:length} below the block")
THROUGH_STOCK = kind("through-stock", WARNING, "it goes {below:length} below the block")
MINUS = ": a lost minus sign?"


def judge_air(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    for cut in program.cuts:
        if cut.at >= cut.end:
            yield Finding(EMPTY, cut.line, {"code": cut.code}, file=cut.file)
        elif cut.upright:
            yield Finding(UPRIGHT, cut.line, file=cut.file)
        elif program.cutter(cut.at) > 0 and program.is_known(cut.at):
            yield from _judge(cut, solids)


def _judge(cut: Cut, solids: Solids) -> Iterator[Finding]:
    top = solids.top(cut.surface)
    lowest = min((each.level for each in solids.made_by(cut)), default=math.inf)
    place = solids.program.tip(cut.at, cut.surface)[0]
    if lowest > top - LEVEL:
        lowest = lowest_of(cut, solids)
        values = {"above": lowest - top, "hint": MINUS if lowest > top + LEVEL else ""}
        yield Finding(AIR, cut.line, values, place, cut.file)
    elif not solids.removes(cut):
        if not solids.is_met(cut):
            yield Finding(BESIDE, cut.line, {}, place, cut.file)
        elif not cut.is_tap:
            yield Finding(BEFORE, cut.line, {}, place, cut.file)
    elif _lies_outside(cut, solids):
        yield Finding(OUTSIDE, cut.line, {}, place, cut.file)
    is_round = solids.program.is_round
    if cut.surface and not solids.stock and not is_round and solids.above_face(cut.surface):
        yield Finding(ABOVE_ZERO, cut.line, {}, place, cut.file)
    above = [outline for outline in cut.outlines if outline.level > top - LEVEL]
    if above and lowest < top - LEVEL:
        yield Finding(AIR_CONTOUR, above[0].lines[0], file=cut.file)
    high = sum(level > top - LEVEL for level in cut.levels)
    if 0 < high < len(cut.levels):
        yield Finding(AIR_LEVELS, cut.line, {"n": high, "of": len(cut.levels)}, place, cut.file)
    if cut.levels:
        yield from _deep(cut, solids)
    below = solids.bottom - cut.floor
    if below > LEVEL:
        kind_of = BELOW if below > THROUGH else THROUGH_STOCK
        yield Finding(kind_of, cut.line, {"below": below}, place, cut.file)


def _deep(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield a first level that is far below what stands, or a level far below the one before."""
    radius, levels = solids.program.cutter(cut.at), cut.levels
    steps = [upper - lower for upper, lower in pairwise(levels)]
    high, top = levels[0] + DEEPEST * radius, solids.top(cut.surface)
    if high < top:
        standing = solids.standing(cut.goes, high, cut.surface, before=cut.at)
        steps += [top - levels[0]] if standing.area > math.pi * radius**2 else []
    if max(steps, default=0.0) > DEEPEST * radius:
        values = {"deep": max(steps), "cutter": 2 * radius}
        yield Finding(DEEP, cut.line, values, file=cut.file)


def lowest_of(cut: Cut, solids: Solids) -> float:
    """Return the lowest level of its moves at feed."""
    fed = (i for i in cut.moves if solids.program.moves[i].kind != "rapid")
    levels = (float(solids.program.tip(i, cut.surface)[:, 2].min()) for i in fed)
    return min(levels, default=math.inf)


def _lies_outside(cut: Cut, solids: Solids) -> bool:
    """Return whether a portion of a pocket or a hole is outside of a given stock."""
    if not solids.stock:
        return False
    radius = solids.program.cutter(cut.at)
    if cut.places:
        if cut.surface:
            return any(hole.imag + radius > solids.z0 for hole in cut.places)
        return any(abs(hole) + radius > solids.bar for hole in cut.places)
    pocket = cut.is_circle or (cut.is_shape and not isinstance(cut.plan, PolygonCut))
    if not pocket or not solids.stock.is_whole:
        return False
    return bool(cut.goes.difference(solids.unbored).area > LEAST_GONE)
