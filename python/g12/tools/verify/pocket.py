# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a circle was cut: what was made, laid along the toolpath that its words ask for.

Lengths are millimetres, areas square millimetres, angles degrees, feeds mm/min, times seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from shapely.geometry.base import BaseGeometry

from g12.geometry.curve import Arc, Curve, Line
from g12.tools.material.material import Material
from g12.tools.path.follow import Followed
from g12.tools.path.part import arc_points, plane_axes
from g12.tools.path.slowest import Pace
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import FEED, OFF, Laid, Made, lay
from g12.tools.verify.compare.path_judge import judge_path
from g12.tools.verify.compare.state import extra_events, judge_state, state_differences
from g12.tools.verify.pocket_area import is_wrong_tool, uncut
from g12.tools.verify.reading.circles import Target, Wall
from g12.tools.verify.reading.codes import EVENT
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import AREA, RUN, SIZE

STILL = 1e-8  # mm: a shorter move is none
SAME_AXIS = 1e-9
SHARES = np.linspace(0.0, 1.0, 25)  # of an arc that stands across the pocket's plane


@dataclass(frozen=True)
class HelixFacts:
    """The helices of a pocket: how many, the radius of the tool's centre, the greatest angle."""

    count: int
    radius: float
    angle: float


@dataclass(frozen=True)
class PocketFacts:
    """What was measured of one pocket.

    ``laid`` is what was made along the expected toolpath; ``uncut`` what remains at the deepest
    level. ``reached`` is the wall's radius as cut. ``off_path``, ``off_rings`` and ``too_far`` are
    those of a run, None without one: its largest deviations, and how far it went beyond the wall.
    ``judged`` are the pocket's findings and notes.
    """

    target: Target
    laid: Laid
    reached: float
    uncut: BaseGeometry
    pace: Pace
    lengths: tuple[float, float]
    off_path: float | None = None
    off_rings: float | None = None
    too_far: float | None = None
    judged: tuple[Finding, ...] = ()

    @property
    def left(self) -> float:
        """Return the area that remains at the deepest level."""
        return self.uncut.area

    @property
    def deviation(self) -> float:
        """Return the greatest distance from the expected toolpath."""
        sizes = (each.size for each in self.laid.differences if each.kind == OFF)
        return max([self.laid.deviation, self.too_far or 0.0, *sizes])

    @property
    def rings(self) -> tuple[float, ...]:
        """Return the radii of the tool centre's circles, each once."""
        return tuple(dict.fromkeys(round(arc.radius, 6) for arc in self.target.arcs))

    @property
    def turns(self) -> tuple[int, ...]:
        """Return the turns of the circles, each once."""
        return tuple(sorted({round(math.copysign(1, arc.sweep)) for arc in self.target.arcs}))

    @property
    def helix(self) -> HelixFacts | None:
        """Return what the helices of the pocket are like, None without one."""
        falls = [move.name == "helix" for move in self.target.path]
        falling = [move for move in self.target.path if move.name == "helix"]
        curve = falling[0].curve if falling else None
        if not isinstance(curve, Arc):
            return None
        fall = max(move.start_level - move.end_level for move in falling)
        count = sum(now > before for before, now in zip(falls, falls[1:]))
        return HelixFacts(count, curve.radius, math.degrees(math.atan2(fall, curve.length)))


def measure_pocket(
    block: Block,
    target: Target,
    moves: Sequence[Move],
    material: Material,
    tolerance: float,
    pace: Callable[[Sequence[int], Sequence[int]], Pace],
    real: Followed | None = None,
) -> PocketFacts:
    """Return the facts of the pocket of a block, in its ``material``.

    ``pace`` is a function of all its moves and of those that cut.
    """
    own = range(block.at, block.end)
    laid = lay(target.path, made_in(target.wall, moves, own), tolerance)
    cutting = [i for i in own if is_cutting(moves[i], target.wall)]
    lengths = [moves[index].length for index in cutting] or [0.0]
    facts = PocketFacts(
        target,
        laid,
        reached(target, laid, moves),
        uncut(block, target, material, tolerance, real is None),
        pace(own, cutting),
        (min(lengths), max(lengths)),
        *(facts_of_run(target, laid, cutting, real) if real else (None, None, None)),
    )
    judged = [
        *judge_cutter(target),
        *judge_depth(target, tolerance),
        *judge_path(laid, target.source.line, "", target.wall.machine),
        *judge_cut(facts, tolerance),
        *judge_left(block, facts),
    ]
    file = target.source.file
    return replace(facts, judged=tuple(replace(each, file=file) for each in judged))


def made_in(wall: Wall, moves: Sequence[Move], own: range) -> Iterator[Made]:
    """Yield moves, by their indices, as seen from a wall's centre, but for those of no length."""
    starts, ends = (
        wall.local(np.array([getattr(moves[i], end)[:3] for i in own])).tolist()
        for end in ("start", "end")
    )
    for index, start, end in zip(own, starts, ends):
        move = moves[index]
        points = [(complex(*start[:2]), start[2]), (complex(*end[:2]), end[2])]
        if move.length <= STILL:
            continue
        if move.kind == "arc" and is_in_plane(move, wall):
            centre = complex(*wall.local(np.array(move.centre))[0, :2])
            curve: Curve | None = Arc(points[0][0], centre, move.sweep)
        elif move.kind == "arc":
            curve, there = None, wall.local(arc_points(move, SHARES)[:, :3]).tolist()
            points = [(complex(*at[:2]), at[2]) for at in there]
        else:
            curve = Line(points[0][0], points[1][0])
        rapid = move.kind == "rapid"
        feed = None if rapid else move.feed
        yield Made(index, points, curve, feed, rapid, move.feed_mode == "G95")


def is_in_plane(move: Move, wall: Wall) -> bool:
    """Tell whether an arc lies in a wall's plane."""
    axes = plane_axes(move)
    return axes is wall.axes or bool(np.abs(axes[2] - wall.axes[2]).max() < SAME_AXIS)


def is_cutting(move: Move, wall: Wall) -> bool:
    """Tell whether a move feeds across the wall's plane."""
    if move.kind != "feed":
        return move.kind == "arc"
    way = np.subtract(move.end[:3], move.start[:3])
    return bool(np.abs(wall.axes[:2] @ way).max() > SAME_AXIS)


def reached(target: Target, laid: Laid, moves: Sequence[Move]) -> float:
    """Return the radius of the wall as cut, 0 if it is not."""
    walls = {id(move) for move in target.walls}
    made = [
        moves[index].radius
        for move, indices in zip(target.path, laid.moves)
        for index in indices
        if id(move) in walls and moves[index].kind == "arc"
    ]
    if not made:
        return 0.0
    cutter = target.cutter.radius
    return max(made) + cutter if target.wall.inside else min(made) - cutter


def facts_of_run(
    target: Target, laid: Laid, cutting: Sequence[int], real: Followed
) -> tuple[float, float, float]:
    """Return ``off_path``, ``off_rings`` and ``too_far`` of ``PocketFacts``."""
    wall, cutter = target.wall, target.cutter.radius
    full = {id(move) for move in target.circles}
    circles = [i for move, made in zip(target.path, laid.moves) if id(move) in full for i in made]
    lines = [wall.local(real.points[real.during(index)]) for index in cutting]
    radii = np.concatenate([np.zeros(0), *(np.hypot(*line[:, :2].T) for line in lines)])
    far = radii.max(initial=0.0) + cutter - wall.radius
    if not wall.inside:
        far = wall.radius - (radii.min(initial=math.inf) - cutter)
    return real.largest(cutting), real.largest(circles), max(0.0, float(far))


def judge_cutter(target: Target) -> Iterator[Finding]:
    """Yield what is to know of the cutter: that of D, the loaded one, or none."""
    cutter, wall, line = target.cutter, target.wall, target.source.line
    values = {
        "tool": cutter.tool,
        "named": cutter.named,
        "loaded": 2 * cutter.loaded,
        "diameter": 2 * cutter.radius,
    }
    if cutter.word:
        yield Finding("centre-on-circle", line)
    if is_wrong_tool(cutter):
        cut = wall.radius - cutter.radius + cutter.loaded
        values |= {"wall": wall.radius, "cut": cut}
        yield Finding("wrong-cutter", line, values, wall.machine((0j, target.deepest)))
    elif cutter.named is not None and not cutter.loaded:
        yield Finding("loaded-unknown" if cutter.tool > 0 else "none-loaded", line, values)
    elif cutter.named is not None and abs(cutter.radius - cutter.loaded) > SIZE:
        yield Finding("worn-cutter", line, values)


def judge_depth(target: Target, tolerance: float) -> Iterator[Finding]:
    """Yield that a circle lies above where the tool comes from; an event begins at its W."""
    if target.source.dialect != EVENT and target.deepest > tolerance:
        values = {"depth": target.wall.height(target.deepest), "start": target.wall.height(0.0)}
        yield Finding("cuts-air", target.source.line, values)


def judge_cut(facts: PocketFacts, tolerance: float) -> Iterator[Finding]:
    """Yield material that remains, and a wall that a run cut too far."""
    wall, deepest, line = facts.target.wall, facts.target.deepest, facts.target.source.line
    if facts.left > AREA:
        values = {"area": facts.left, "shape": facts.uncut, "floor": wall.height(deepest)}
        yield Finding("uncut", line, values, wall.machine((0j, deepest)))
    if (facts.too_far or 0.0) > tolerance + RUN:
        place = wall.machine((complex(wall.radius), deepest))
        yield Finding("wall-run", line, {"size": facts.too_far, "at": place}, place)


def judge_left(block: Block, facts: PocketFacts) -> Iterator[Finding]:
    """Yield the state that a pocket leaves otherwise; of another feed no more is said."""
    other_feed = any(each.kind == FEED for each in facts.laid.differences)
    state = state_differences(block.left, facts.target.leaves)
    told = [each for each in state if not (other_feed and each.name == "_feed")]
    yield from judge_state(told, extra_events(block), facts.target.source.line)
