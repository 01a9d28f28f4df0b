# SPDX-License-Identifier: GPL-2.0-or-later
"""What pockets leave uncut in their middle, and where two of them meet.

Each is cut as its words command. A core may be intended, or bored before; pockets may be meant to
meet, and a spring pass cuts nothing. Lengths are mm in machine coordinates.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from g12.tools.material.material import ALLOWED, LEAST_AREA, Material
from g12.tools.path.part import disc
from g12.tools.preview.executed_blocks import Block
from g12.tools.verify.reading.circles import Target
from g12.tools.verify.result.finding import Finding

Circles = Sequence[tuple[Block, Target]]


def judge_circles(circles: Circles, material: Material) -> Iterator[Finding]:
    """Yield the cores that remain, walls that another circle cuts, and circles that cut nothing.

    All of the circles are in the plane XY.
    """
    yield from _cores(circles, material)
    meetings = list(_meetings([target for _, target in circles]))
    yield from _cut_walls(circles, meetings)
    yield from _cut_before([circles[at] for at, _ in meetings], material)
    yield from _bosses_cut(circles, material)


def _cores(circles: Circles, material: Material) -> Iterator[Finding]:
    """Yield one note of the circles in whose middle material remains after their blocks."""
    areas = ((target, _area_in(target, material, block.end)) for block, target in circles)
    found = [(target, area) for target, area in areas if area > LEAST_AREA]
    for target, area in found[:1]:
        line = target.line
        values = {"area": area, "more": {each.line for each, _ in found} - {line}}
        place = target.wall.machine((0j, target.deepest))
        yield Finding("core-remains", line, values, place, target.file)


def _area_in(target: Target, material: Material, before: int) -> float:
    wall = target.wall
    if not wall.inside or not target.cutter.radius or wall.cleared <= ALLOWED:
        return 0.0
    middle = disc(wall.origin, wall.cleared - ALLOWED)
    return material.standing(middle, wall.height(target.deepest), before).area


def _cut_before(circles: Circles, material: Material) -> Iterator[Finding]:
    """Yield one note of the circles of which all was cut before their blocks."""
    found = [target for block, target in circles if _was_cut(block, target, material)]
    for first in found[:1]:
        more = {each.line for each in found} - {first.line}
        yield Finding("cut-before", first.line, {"more": more}, file=first.file)


def _was_cut(block: Block, target: Target, material: Material) -> bool:
    wall = target.wall
    if not wall.inside or not target.cutter.radius:
        return False
    own = disc(wall.origin, wall.radius - ALLOWED)
    own = own.difference(disc(wall.origin, wall.cleared)) if wall.cleared > ALLOWED else own
    return material.is_cleared(own, wall.height(target.deepest), block.at)


def _bosses_cut(circles: Circles, material: Material) -> Iterator[Finding]:
    """Yield the bosses of which nothing remains at a level: at their floor, or later at their Z0.

    One whose top was cut before stays as high as it was.
    """
    for block, target in circles:
        wall = target.wall
        if wall.inside or not target.cutter.radius:
            continue
        boss, floor = disc(wall.origin, wall.radius - ALLOWED), wall.height(target.deepest)
        for level, since in ((floor, 0), (wall.face - ALLOWED, block.end)):
            ends = [material.standing(boss, level, at).area for at in (since, math.inf)]
            if ends[0] > LEAST_AREA >= ends[1]:
                place = (*map(float, wall.origin[:2]), level)
                yield Finding("boss-cut", target.line, {"level": level}, place, target.file)
                break


def _meetings(targets: Sequence[Target]) -> Iterator[tuple[int, np.ndarray]]:
    """Yield each circle that meets others before it in the plane, and those with crossing walls.

    All are indices. A circle about the same centre is another pass, one inside of it a deeper
    pocket; a boss inside of it is cut by the ring that does not pass it, or cuts its wall. What a
    circle ``cuts`` are all points between ``core`` and ``cuts`` from its centre.
    """
    centre = np.array([complex(*each.wall.origin[:2]) for each in targets])
    wall = np.array([each.wall.radius for each in targets])
    core = np.array([each.wall.cleared for each in targets])
    inside = np.array([each.wall.inside for each in targets])
    cuts = wall + [2 * each.cutter.radius * (not each.wall.inside) for each in targets]
    floor = np.array([each.wall.height(each.deepest) for each in targets])
    top = np.array([each.wall.face for each in targets]) - ALLOWED
    for at in range(1, len(targets)):
        apart = np.abs(centre[:at] - centre[at])
        if (apart < cuts[:at] + cuts[at] - ALLOWED).any():
            deep = np.maximum(floor[:at], floor[at]) <= np.minimum(top[:at], top[at])
            cross = _crosses(apart, wall[:at], cuts[at]) | _crosses(apart, wall[at], cuts[:at])
            one = [values[at] for values in (wall, core, cuts)]
            others = [values[:at] for values in (wall, core, cuts)]
            ring = _cuts_boss(apart, one, others) & inside[at] & ~inside[:at]
            ring |= _cuts_boss(apart, others, one) & inside[:at] & ~inside[at]
            yield at, np.flatnonzero(((apart >= ALLOWED) & cross | ring) & deep)


def _crosses(apart: np.ndarray, wall: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Return whether circles of two radii cross whose centres are so far ``apart``."""
    return (abs(wall - cut) + ALLOWED < apart) & (apart < wall + cut - ALLOWED)


def _cuts_boss(apart: np.ndarray, ring: Sequence, boss: Sequence) -> np.ndarray:
    """Return whether a ring cuts the boss that it lies round, or that is cut into its wall.

    Both are their wall, core and all that they cut; a pocket without a core is no ring.
    """
    (wall, core, _), (radius, _, outside) = ring, boss
    too_narrow = (core > ALLOWED) & (apart + radius > core + ALLOWED)
    too_wide = apart + outside > wall + ALLOWED
    return (apart + radius < wall + ALLOWED) & (too_narrow | too_wide)


def _cut_walls(circles: Circles, meetings: Sequence[tuple[int, np.ndarray]]) -> Iterator[Finding]:
    """Yield the first other circle whose wall each circle cuts, or that cuts its own."""
    reported: set[int] = set()
    for at, others in meetings:
        target = circles[at][1]
        line = target.line
        if len(others) and line not in reported:
            reported.add(line)
            place = target.wall.machine((0j, target.deepest))
            other = circles[others[0]][1]
            own, its = (tuple(zip("XY", each.wall.origin)) for each in (target, other))
            values = {"line": other.line, "at": own, "other": its}
            yield Finding("cuts-wall", line, values, place, target.file)
