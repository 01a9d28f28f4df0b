# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a circle was cut: what was made, laid along the toolpath that its words ask for.

Lengths are millimetres, areas square millimetres, angles degrees, feeds mm/min, times seconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from g12.geometry.curve import Arc, Curve, Line
from g12.tools.material.material import Material
from g12.tools.path.follow import Followed
from g12.tools.path.part import arc_points, plane_axes
from g12.tools.path.slowest import Pace
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.compare.path import FEED, OFF, Laid, Made, lay
from g12.tools.verify.compare.path_judge import judge_path
from g12.tools.verify.compare.state import (
    StateDifference,
    extra_events,
    judge_state,
    state_differences,
)
from g12.tools.verify.pocket_area import is_wrong_tool, uncut, uncut_in_run
from g12.tools.verify.reading.circles import Target, Wall
from g12.tools.verify.reading.codes import EVENT
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import AREA, RUN

STILL = 1e-8  # mm: a shorter move is none
SAME_AXIS = 1e-9
SHARES = np.linspace(0.0, 1.0, 25)  # of an arc that stands across the pocket's plane


class HelixFacts(NamedTuple):
    """The helices of a pocket: how many, the radius of the tool's centre, the greatest angle."""

    count: int
    radius: float
    angle: float


@dataclass(frozen=True)
class PocketFacts:
    """What was measured of one pocket.

    ``laid`` is what was made along the expected toolpath; ``left`` the area that the words leave
    at the deepest level, or that a run does. ``reached`` is the wall's radius as cut.
    ``off_path``, ``off_rings`` and ``too_far`` are those of a run, None without one: its largest
    deviations, and how far it went beyond the wall. ``overruns`` are the axes that would leave
    their travel, None if that is not known.
    """

    target: Target
    laid: Laid
    reached: float
    left: float
    pace: Pace
    lengths: tuple[float, float]
    state: tuple[StateDifference, ...] = ()
    events: tuple[str, ...] = ()
    off_path: float | None = None
    off_rings: float | None = None
    too_far: float | None = None
    overruns: tuple[Overrun, ...] | None = ()

    @property
    def deviation(self) -> float:
        """Return the greatest distance from the expected toolpath."""
        sizes = (each.size for each in self.laid.differences if each.kind == OFF)
        return max([self.laid.deviation, self.too_far or 0.0, *sizes])

    @property
    def rings(self) -> tuple[float, ...]:
        """Return the radii of the tool centre's circles, each once."""
        return tuple(dict.fromkeys(round(move.curve.radius, 6) for move in self.target.circles))

    @property
    def turns(self) -> tuple[int, ...]:
        """Return the turns of the circles, each once."""
        return tuple(sorted({round(math.copysign(1, c.curve.sweep)) for c in self.target.circles}))

    @property
    def helix(self) -> HelixFacts | None:
        """Return what the helices of the pocket are like, None without one."""
        falls = [move.name == "helix" for move in self.target.path]
        if not any(falls):
            return None
        falling = [move for move in self.target.path if move.name == "helix"]
        fall = max(move.start_level - move.end_level for move in falling)
        curve, count = falling[0].curve, sum(now > before for before, now in zip(falls, falls[1:]))
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
    if real:
        of_run = facts_of_run(block, target, laid, cutting, real, material, tolerance)
    else:
        of_run = {"left": uncut(block, target, material, tolerance).area}
    return PocketFacts(
        target,
        laid,
        **{
            "reached": reached(target, laid, moves),
            "pace": pace(own, cutting),
            "lengths": (min(lengths), max(lengths)),
            "state": state_differences(block.left, target.leaves),
            "events": extra_events(block),
            **of_run,
        },
    )


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
    block: Block,
    target: Target,
    laid: Laid,
    cutting: Sequence[int],
    real: Followed,
    material: Material,
    tolerance: float,
) -> dict[str, float]:
    """Return those members of ``PocketFacts`` that only a run has."""
    wall, cutter = target.wall, target.cutter.radius
    floor = [
        index
        for move, indices in zip(target.path, laid.moves)
        if move.end_level == target.deepest and move.start_level == target.deepest
        for index in indices
    ]
    full = {id(move) for move in target.circles}
    circles = [i for move, made in zip(target.path, laid.moves) if id(move) in full for i in made]
    lines = [wall.local(real.points[real.during(index)]) for index in cutting]
    radii = np.concatenate([np.zeros(0), *(np.hypot(*line[:, :2].T) for line in lines)])
    far = radii.max(initial=0.0) + cutter - wall.radius
    if not wall.inside:
        far = wall.radius - (radii.min(initial=math.inf) - cutter)
    own = [line for index, line in zip(cutting, lines) if index in floor]
    left = uncut_in_run(block, target, material, own, tolerance)
    return {
        "off_path": real.largest(cutting),
        "off_rings": real.largest(circles),
        "too_far": max(0.0, float(far)),
        "left": left,
    }


def judge_pocket(facts: PocketFacts, tolerance: float) -> Iterator[Finding]:
    """Yield what is wrong with a pocket."""
    source, wall = facts.target.source, facts.target.wall
    where = (source.line, source.file)
    yield from mistakes(facts, tolerance)
    yield from judge_path(facts.laid, *where, wall.machine)
    if facts.left > AREA:
        place = wall.machine((0j, facts.target.deepest))
        yield Finding("uncut", source.line, {"area": facts.left}, place, source.file)
    if (facts.too_far or 0.0) > tolerance + RUN:
        place = wall.machine((complex(wall.radius), facts.target.deepest))
        yield Finding("wall-run", source.line, {"size": facts.too_far}, place, source.file)
    yield from judge_state(left_otherwise(facts), facts.events, *where)
    for overrun in facts.overruns or ():
        if overrun.certain:
            values = {"axis": overrun.letter, "position": overrun.position, "limit": overrun.limit}
            yield Finding("travel", source.line, values, file=source.file)


def left_otherwise(facts: PocketFacts) -> Iterator[StateDifference]:
    """Yield what the pocket leaves otherwise: of a feed that it was cut at no more is said."""
    other_feed = any(each.kind == FEED for each in facts.laid.differences)
    return (each for each in facts.state if not (other_feed and each.name == "_feed"))


def mistakes(facts: PocketFacts, tolerance: float) -> Iterator[Finding]:
    """Yield what the words of a pocket most likely do not mean."""
    target, source = facts.target, facts.target.source
    cutter, wall = target.cutter, target.wall
    if is_wrong_tool(cutter):
        values = {
            "tool": cutter.tool,
            "named": cutter.named,
            "loaded": 2 * cutter.loaded,
            "diameter": 2 * cutter.radius,
            "wall": wall.radius,
            "cut": wall.radius - cutter.radius + cutter.loaded,
        }
        yield Finding("wrong-cutter", source.line, values, file=source.file)
    if source.dialect != EVENT and target.deepest > tolerance:  # an event begins at its W
        values = {"depth": wall.height(target.deepest), "start": wall.height(0.0)}
        yield Finding("cuts-air", source.line, values, file=source.file)
