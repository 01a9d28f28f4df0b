# SPDX-License-Identifier: GPL-2.0-or-later
"""How well a circle was cut: its moves, laid along the toolpath that its words command.

Lengths are millimetres, areas square millimetres, angles degrees, feeds mm/min, times seconds.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from shapely.affinity import translate
from shapely.geometry import Polygon
from shapely.geometry.base import BaseGeometry

from g12.geometry.curve import Arc, Curve, Line
from g12.tools.material.material import LEAST_AREA, Material
from g12.tools.path.follow import Followed
from g12.tools.path.part import Z, arc_points, disc, plane_axes
from g12.tools.path.slowest import Pace
from g12.tools.path.track import CART_FUZZ
from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.verify.compare.path import FEED, OFF, Laid, Made, judge_path, lay
from g12.tools.verify.compare.state import extra_events, judge_events, judge_state
from g12.tools.verify.expected.toolpath import TOUCHING, Point
from g12.tools.verify.reading.circles import Cutter, Target, Wall
from g12.tools.verify.reading.codes import EVENT
from g12.tools.verify.result.cut import MeasuredCut, finite, in_file, pace_values
from g12.tools.verify.result.finding import Finding, minus_hint
from g12.tools.verify.result.tolerances import AREA, RUN, SIZE, WEAR

SAME_AXIS = 1e-9
SHARES = np.linspace(0.0, 1.0, 25)  # of an arc in another plane than the pocket's
FINE = 1e-5  # chord error of the circles about a pocket's centre
LEAST_CORE = 0.01  # mm: a smaller radius is 0
TURNS = {-1: "clockwise", 1: "counterclockwise"}


def measure_pocket(
    block: Block,
    target: Target,
    moves: Sequence[Move],
    material: Material,
    tolerance: float,
    pace: Callable[[Sequence[int], Sequence[int]], Pace],
    real: Followed | None = None,
) -> MeasuredCut:
    """Return what was measured of the pocket of a block, in its ``material``.

    ``pace`` is a function of all its moves and of those that cut.
    """
    own, wall = range(block.at, block.end), target.wall
    laid = lay(target.path, _made_in(wall, moves, own), tolerance)
    cutting = [i for i in own if _is_cutting(moves[i], wall)]
    remaining = uncut(block, target, material, tolerance, real is None)
    run = _run_values(target, laid, cutting, real) if real else {}
    too_far = run.get("too_far", 0.0)
    judged = [
        *_judge_cutter(target),
        *_judge_depth(block, target, material, tolerance),
        *judge_path(laid, target.line, wall.machine),
        *_judge_cut(target, remaining, too_far, tolerance),
        *_judge_state_after(block, target, laid),
    ]
    sizes = (each.size for each in laid.differences if each.kind == OFF)
    deviation = max([laid.deviation, too_far, *sizes])
    lengths = [moves[index].length for index in cutting] or [0.0]
    took = pace(own, cutting)
    values = {
        **_pocket_values(target),
        "reached": reached(target, laid, moves),
        "deviation": finite(deviation),
        "left": remaining.area,
        "shortest": min(lengths),
        "longest": max(lengths),
        "off_circles": None,
        "off_path": None,
        **run,
        **pace_values(took),
        "lowest_feed_line": moves[took.move].block,
    }
    return MeasuredCut(
        target,
        target.line,
        target.file,
        target.code,
        own,
        wall.face,
        deviation,
        values,
        in_file(judged, target.file, wall.machine((0j, 0.0))),
        turning=False,
        sound=not laid.differences,
    )


def _pocket_values(target: Target) -> dict[str, Any]:
    """Return what the words of a pocket command as plain values; ``z`` is of G18 and G19."""
    wall, words = target.wall, target.words
    rings = list(dict.fromkeys(round(each.radius, 6) for each in target.circles))
    turns = sorted({round(math.copysign(1, each.sweep)) for each in target.circles})
    reach, level = max(rings, default=0.0), float(wall.origin[Z])
    return {
        "dialect": target.dialect,
        "centre": [float(value) for value in wall.origin[:2]],
        "cutter": 2 * target.cutter.radius,
        "circle": {"word": words.word, "radius": words.final} if words.word else None,
        "radius": wall.radius,
        "core": wall.core or None,
        "rings": rings,
        "turns": " and ".join(TURNS[turn] for turn in turns),
        "square_to": "XYZ"[wall.plane],
        "depths": [wall.height(depth) for depth in target.depths],
        "lowest": wall.height(target.deepest),
        "z": None if wall.plane == Z else [level - reach, level + reach],
        "entry": _entry_values(target),
        "stepover": words.stepover,
    }


def _entry_values(target: Target) -> dict[str, Any]:
    """Return the entry: the helices' count, radius and greatest angle, or straight."""
    falls = [move.name == "helix" for move in target.path]
    falling = [move for move in target.path if move.name == "helix"]
    if not falling:
        return {"way": "straight"}
    fall = max(move.start_level - move.end_level for move in falling)
    count = sum(now > before for before, now in zip(falls, falls[1:]))
    angle = math.degrees(math.atan2(fall, falling[0].curve.length))
    return {"way": "helix", "count": count, "radius": falling[0].radius, "angle": angle}


def _made_in(wall: Wall, moves: Sequence[Move], own: range) -> Iterator[Made]:
    """Yield the moves that have a length, by their indices, from a wall's centre."""
    starts, ends = (
        _points(wall, np.array([getattr(moves[i], end)[:3] for i in own]))
        for end in ("start", "end")
    )
    for index, *points in zip(own, starts, ends):
        move = moves[index]
        if move.length <= CART_FUZZ:
            continue
        across = plane_axes(move)
        in_plane = across is wall.axes or np.abs(across[2] - wall.axes[2]).max() < SAME_AXIS
        if move.kind == "arc" and in_plane:
            centre, _ = _points(wall, np.array(move.centre))[0]
            curve: Curve | None = Arc(points[0][0], centre, move.sweep)
        elif move.kind == "arc":
            curve, points = None, _points(wall, arc_points(move, SHARES))
        else:
            curve = Line(points[0][0], points[1][0])
        yield Made.of(index, move, points, curve)


def _points(wall: Wall, positions: np.ndarray) -> list[Point]:
    """Return machine positions (n, 3 or more) as points of a wall's plane with their levels."""
    return [(complex(x, y), level) for x, y, level in wall.local(positions).tolist()]


def _is_cutting(move: Move, wall: Wall) -> bool:
    if move.kind != "feed":
        return move.kind == "arc"
    along = np.subtract(move.end[:3], move.start[:3])
    return bool(np.abs(wall.axes[:2] @ along).max() > SAME_AXIS)


def reached(target: Target, laid: Laid, moves: Sequence[Move]) -> float:
    """Return the radius of the wall as cut, 0 if it is not."""
    made = [
        moves[index].radius
        for move, indices in zip(target.path, laid.moves)
        if move.is_circle and abs(move.radius - target.words.final) < TOUCHING
        for index in indices
        if moves[index].kind == "arc"
    ]
    if not made:
        return 0.0
    cutter = target.cutter.radius
    return max(made) + cutter if target.wall.inside else min(made) - cutter


def _run_values(
    target: Target, laid: Laid, cutting: Sequence[int], real: Followed
) -> Mapping[str, float]:
    """Return the greatest deviations of a run, and how far it cut beyond the wall."""
    wall, cutter = target.wall, target.cutter.radius
    circles = [i for move, made in zip(target.path, laid.moves) if move.is_circle for i in made]
    lines = [wall.local(real.points[real.during(index)]) for index in cutting]
    radii = np.concatenate([np.zeros(0), *(np.hypot(*line[:, :2].T) for line in lines)])
    far = radii.max(initial=0.0) + cutter - wall.radius
    if not wall.inside:
        far = wall.radius - (radii.min(initial=math.inf) - cutter)
    off = {"off_circles": real.largest(circles), "off_path": real.largest(cutting)}
    return {**off, "too_far": max(0.0, float(far))}


def _judge_cutter(target: Target) -> Iterator[Finding]:
    """Yield the findings of the cutter: that of D, the loaded one, or none."""
    cutter, wall, line = target.cutter, target.wall, target.line
    values = {
        "tool": cutter.tool,
        "named": cutter.named,
        "loaded": 2 * cutter.loaded,
        "diameter": 2 * cutter.radius,
    }
    if target.words.word:
        yield Finding("centre-on-circle", line)
    if _is_wrong_tool(cutter):
        cut = wall.radius - cutter.radius + cutter.loaded
        values |= {"wall": wall.radius, "cut": cut}
        yield Finding("wrong-cutter", line, values, wall.machine((0j, target.deepest)))
    elif cutter.named is not None and not cutter.loaded:
        yield Finding("loaded-unknown" if cutter.tool > 0 else "none-loaded", line, values)
    elif cutter.named is not None and abs(cutter.radius - cutter.loaded) > SIZE:
        yield Finding("worn-cutter", line, values)


def _is_wrong_tool(cutter: Cutter) -> bool:
    """Return whether D names another cutter than the loaded one, by more than wear."""
    known = cutter.named is not None and cutter.loaded > 0.0
    return known and abs(cutter.radius - cutter.loaded) > WEAR * cutter.loaded


def _judge_depth(
    block: Block, target: Target, material: Material, tolerance: float
) -> Iterator[Finding]:
    """Yield a depth above the tool, unless there is material to cut."""
    wall, depth = target.wall, target.wall.height(target.deepest)
    if target.dialect == EVENT or target.deepest <= tolerance:
        return
    own = disc(wall.origin, wall.radius)
    if wall.plane != Z or material.standing(own, depth, block.at).area <= LEAST_AREA:
        values = {"depth": depth, "start": wall.height(0.0), "hint": minus_hint(depth, wall.face)}
        yield Finding("cuts-air", target.line, values)


def _judge_cut(
    target: Target, remaining: BaseGeometry, too_far: float, tolerance: float
) -> Iterator[Finding]:
    """Yield uncut material, and a wall that a run cut too far."""
    wall, deepest, line = target.wall, target.deepest, target.line
    if remaining.area > AREA:
        values = {"area": remaining.area, "shape": remaining, "floor": wall.height(deepest)}
        yield Finding("uncut", line, values, wall.machine((0j, deepest)))
    if too_far > tolerance + RUN:
        at = wall.machine((complex(wall.radius), deepest))
        yield Finding("wall-run", line, {"size": too_far, "at": at}, at)


def _judge_state_after(block: Block, target: Target, laid: Laid) -> Iterator[Finding]:
    """Yield the wrong modal state after a pocket; a wrong feed is reported once."""
    expected = dict(target.leaves)
    if any(each.kind == FEED for each in laid.differences):
        expected.pop("_feed", None)
    yield from judge_state(block.state_after, expected, target.line)
    yield from judge_events(extra_events(block), target.line)


def uncut(
    block: Block, target: Target, material: Material, tolerance: float, as_emitted: bool
) -> BaseGeometry:
    """Return the uncut area of a pocket after its block, in machine coordinates of the plane XY.

    ``as_emitted``: its circles are those of its moves, not those of a run.
    """
    wall, (inner, outer) = target.wall, reach(target, tolerance)
    known = as_emitted and _clears(target, inner, outer)
    if wall.plane != Z or not target.cutter.radius or known:
        return Polygon()
    region = disc((0, 0), outer, FINE)
    if inner > LEAST_CORE:
        region = region.difference(disc((0, 0), inner, FINE))
    region = translate(region, *wall.origin[:2])
    return material.standing(region, wall.height(target.deepest), block.end)


def reach(target: Target, tolerance: float) -> tuple[float, float]:
    """Return the distances from the centre between which no material may remain.

    D may be larger than the cutter by an allowance for wear.
    """
    wall, cutter = target.wall, target.cutter
    if not wall.inside:
        return wall.radius + tolerance, wall.radius + 2 * cutter.radius - tolerance
    worn = 0.0 if _is_wrong_tool(cutter) else max(0.0, cutter.radius - cutter.loaded)
    return wall.cleared + tolerance, wall.radius - tolerance - worn * bool(cutter.loaded)


def _clears(target: Target, inner: float, outer: float) -> bool:
    """Return whether the circles of the deepest level clear all between two distances.

    An optimisation: to ask the material of 1,000 pockets takes five times as long.
    """
    cutter, floor = target.cutter, target.deepest
    edge = cutter.loaded if _is_wrong_tool(cutter) else cutter.radius
    flat = [m for m in target.path if m.start_level == m.end_level == floor and not m.rapid]
    spans = [(0.0, edge)] if any(abs(move.curve.start) < FINE for move in flat) else []
    rings = (move.radius for move in target.circles if move.end_level == floor)
    spans += [(max(0.0, radius - edge), radius + edge) for radius in rings]
    for first, last in sorted(spans):
        inner = max(inner, last) if first <= inner else inner
    return inner >= outer
