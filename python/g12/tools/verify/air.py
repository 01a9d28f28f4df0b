# SPDX-License-Identifier: GPL-2.0-or-later
"""The third question: does a cut remove nothing, or lie outside the material or below it."""

import math
from collections.abc import Iterator
from itertools import pairwise

from shapely.geometry.base import BaseGeometry
from shapely.ops import unary_union

from g12.tools.path.part import disc
from g12.tools.verify.model.cut import NOTHING, Cut
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
UPRIGHT = kind("upright", NOT_JUDGED, "the material around a circle in another plane than G17")
OUTSIDE = kind("outside", WARNING, "a portion of it lies outside of the stock")
DEEP = kind("deep-pass", WARNING, "it cuts {deep:length} deep at once: cutter ⌀ {cutter:mm}")
BELOW = kind("below-stock", FINDING, "it goes {below:length} below the block")
MINUS = ": a lost minus sign?"


def judge_air(program: TracedProgram, solids: Solids) -> Iterator[Finding]:
    for cut in program.cuts:
        if cut.at >= cut.end:
            continue
        if cut.upright:
            yield cut.found(UPRIGHT)
        elif program.cutter(cut.at) > 0 and program.is_known(cut.at):
            yield from _judge(cut, solids)


def _judge(cut: Cut, solids: Solids) -> Iterator[Finding]:
    program, material, top = solids.program, solids.of(cut.surface), solids.top(cut.surface)
    place = program.tip(cut.at, cut.surface)[0]
    if not material.sweeps_of(cut.moves):
        tips = (program.tip(index, cut.surface) for index in program.fed(cut))
        above = min((tip[:, 2].min() for tip in tips), default=math.inf) - top
        yield cut.found(AIR, place, above=above, hint=MINUS if above > LEVEL else "")
    elif not material.removes(cut.moves):
        if not solids.is_met(cut):
            yield cut.found(BESIDE, place)
        elif not cut.is_tap:
            yield cut.found(BEFORE, place)
    elif solids.stock and material.beyond(_wanted(cut, solids)) > LEAST_GONE:
        yield cut.found(OUTSIDE, place)
    if cut.levels and program.dialects.get(cut.code) != "bore":  # cuts by its helices
        yield from _deep(cut, solids)
    if solids.bottom - cut.floor > THROUGH:
        yield cut.found(BELOW, place, below=solids.bottom - cut.floor)


def _deep(cut: Cut, solids: Solids) -> Iterator[Finding]:
    """Yield a first level that is far below what stands, or a level far below the one before."""
    radius, levels = solids.program.cutter(cut.at), cut.levels
    steps = [upper - lower for upper, lower in pairwise(levels)]
    high, top = levels[0] + DEEPEST * radius, solids.top(cut.surface)
    if high < top:
        standing = solids.standing(cut.goes, high, cut.surface, before=cut.at)
        steps += [top - levels[0]] if standing.area > math.pi * radius**2 else []
    if max(steps, default=0.0) > DEEPEST * radius:
        yield cut.found(DEEP, deep=max(steps), cutter=2 * radius)


def _wanted(cut: Cut, solids: Solids) -> BaseGeometry:
    """Return what a pocket, a shape or holes are to remove."""
    radius = solids.program.cutter(cut.at)
    holes = [disc((at.real, at.imag), radius) for at in cut.places]
    return unary_union([NOTHING if cut.is_section else cut.goes, *holes])
