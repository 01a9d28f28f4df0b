# SPDX-License-Identifier: GPL-2.0-or-later
"""What pockets leave standing in their middle, and where two of them meet.

Each is cut as its words ask. A core may be meant, or bored before; pockets may be meant to meet,
and a spring pass cuts nothing.
Lengths are mm in machine coordinates.
"""

from collections.abc import Collection, Iterator
from typing import NamedTuple

import numpy as np

from g12.tools.material.material import ALLOWED, LEAST_AREA, Material
from g12.tools.path.part import Z, disc
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.reading.circles import Target
from g12.tools.verify.result.finding import Finding, also_in


class Round(NamedTuple):
    """A circle's line, its centre, the radii of its wall and of what it cuts, its floor and top."""

    line: int
    centre: complex
    wall: float
    cut: float
    floor: float
    top: float


def judge_circles(
    circles: Collection[tuple[Block, Target]], material: Material
) -> Iterator[Finding]:
    """Yield cores that stand, walls that another circle cuts, and circles that cut nothing."""
    flat = [each for each in circles if each[1].wall.plane == Z]
    rounds = [round_of(target) for _, target in flat]
    pairs = list(near_pairs(rounds))
    yield from cores(flat, material)
    yield from cut_walls([(rounds[before], rounds[after]) for before, after in pairs])
    again = [flat[index] for index in sorted({after for _, after in pairs})]
    yield from cut_before(again, material)


def cores(circles: Collection[tuple[Block, Target]], material: Material) -> Iterator[Finding]:
    """Yield one note of the cores that stand when their circles are cut."""
    found = [each for each in circles if core_area(*each, material) > LEAST_AREA]
    for block, target in found[:1]:
        line, wall = target.line, target.wall
        others = {other.line for _, other in found} - {line}
        values = {"area": core_area(block, target, material), "more": also_in(others)}
        place = wall.machine((0j, target.deepest))
        yield Finding("core-stands", line, values, place, target.file)


def core_area(block: Block, target: Target, material: Material) -> float:
    """Return the area of what stands in the middle of a circle after its block."""
    wall = target.wall
    if not wall.inside or not target.cutter.radius or wall.cleared <= ALLOWED:
        return 0.0
    middle = disc(wall.origin, wall.cleared - ALLOWED)
    return material.standing(middle, wall.height(target.deepest), block.end).area


def round_of(target: Target) -> Round:
    """Return a circle with what it cuts outside of its centre."""
    wall = target.wall
    cut = wall.radius + 2 * target.cutter.radius * (not wall.inside)
    centre, floor = complex(*wall.origin[:2]), wall.height(target.deepest)
    return Round(target.line, centre, wall.radius, cut, floor, wall.face)


def cut_before(circles: Collection[tuple[Block, Target]], material: Material) -> Iterator[Finding]:
    """Yield one note of the circles of which all was cut before."""
    lines = [target.line for block, target in circles if was_cut(block, target, material)]
    if lines:
        yield Finding("cut-before", lines[0], {"more": also_in(set(lines) - {lines[0]})})


def was_cut(block: Block, target: Target, material: Material) -> bool:
    """Tell whether all that a circle cuts was cut before its block."""
    wall = target.wall
    if not wall.inside or not target.cutter.radius:
        return False
    own = disc(wall.origin, wall.radius - ALLOWED)
    own = own.difference(disc(wall.origin, wall.cleared)) if wall.cleared > ALLOWED else own
    return material.standing(own, wall.height(target.deepest), block.at).area <= LEAST_AREA


def cut_walls(pairs: Collection[tuple[Round, Round]]) -> Iterator[Finding]:
    """Yield the first other circle whose wall each circle cuts, or that cuts its own."""
    reported: set[int] = set()
    for before, after in pairs:
        meet = walls_cross(before, after) or walls_cross(after, before)
        if meet and after.line not in reported:
            reported.add(after.line)
            place = (after.centre.real, after.centre.imag, after.floor)
            yield Finding("cuts-wall", after.line, {"line": before.line}, place)


def near_pairs(rounds: list[Round]) -> Iterator[tuple[int, int]]:
    """Yield each two circles that meet in the plane, by their indices."""
    centres = np.array([each.centre for each in rounds])
    reaches = np.array([each.cut for each in rounds])
    for index, each in enumerate(rounds):
        near = np.abs(centres[:index] - each.centre) < reaches[:index] + each.cut - ALLOWED
        for other in np.flatnonzero(near):
            yield int(other), index


def walls_cross(one: Round, other: Round) -> bool:
    """Tell whether one circle's wall is cut by another.

    A circle about the same centre is another pass, one inside of it a deeper pocket.
    """
    apart = abs(one.centre - other.centre)
    if apart < ALLOWED or max(one.floor, other.floor) > min(one.top, other.top) - ALLOWED:
        return False
    least, most = abs(one.wall - other.cut) + ALLOWED, one.wall + other.cut - ALLOWED
    return least < apart < most
