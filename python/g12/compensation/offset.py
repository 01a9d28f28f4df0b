# SPDX-License-Identifier: GPL-2.0-or-later
"""Cutter compensation: the path of the tool's centre along a contour.

Each element under compensation is shifted to its parallel on the tool's side, then joined to its
neighbours:

- outside corner: an arc about the corner, part of the block that follows;
- inside corner: both parallels end where they cross;
- ramp on: ends square to the start of the next element of the contour; ramp off: starts square to
  the end of the last one. Blocks without motion in the plane are looked through.

What the tool cannot reach is refused, and so is a path that cuts into its contour (`gouge`) or
another one (`between`).
"""

from __future__ import annotations

from copy import copy
from math import copysign, hypot
from typing import NamedTuple, NoReturn

from g12.compensation.between import check_contours
from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Contour,
    Line,
    Plunge,
    Point,
    arc_radius,
    end_direction,
    is_move,
    start_direction,
    sweep_between,
)
from g12.compensation.gouge import Cut, LeadRefusal, check_gouges
from g12.compensation.intersect import PARALLEL, along_end, along_start, crossing
from g12.errors import Refusal, number

JOINED = 0.04  # tolerances: moved by no more, parallels are joined without an arc
BESIDE = 2.0  # tolerances: places so near to each other are one corner


class _Step(NamedTuple):
    """A move of the contour, its parallel, and whether it is ``cut`` along or ``ramp`` to one."""

    move: Line | Arc
    parallel: Line | Arc
    cut: bool
    ramp: bool


class _Joint(NamedTuple):
    """Where the tool's centre leaves one move and meets the next, turning about a corner."""

    leave: Point
    meet: Point
    corner: Point | None = None


def tool_path(contour: Contour, elements: list, tolerance: float) -> list:
    """Return a contour's elements as the tool's centre makes them, all in their places.

    ``tolerance`` in program units: a small part of it is what the path may be off.
    """
    moves = [e for e in elements if is_move(e)]
    if not any(e.offset for e in moves):
        return elements
    try:
        centred = iter(_centred(contour, moves, tolerance))
    except LeadRefusal as refusal:
        raise _with_other_side(refusal, contour, moves, tolerance) from None
    path = []
    for element in elements:
        path.extend(next(centred) if is_move(element) else (element,))
    return path


def _with_other_side(refusal: Refusal, contour: Contour, moves: list, tolerance: float) -> Refusal:
    """Return a refusal that asks whether the other of G41 and G42 is meant, where that is cut."""
    others = [move._replace(offset=-move.offset) for move in moves]
    trial = copy(contour)
    trial.elements, trial.notes = others, []
    try:
        _centred(trial, others, tolerance)
    except Refusal:
        return refusal
    codes = sorted({_code(move) for move in others if move.offset})
    return Refusal(f"{refusal.message}. {' and '.join(codes)}?")


def _centred(contour: Contour, moves: list, tolerance: float) -> list[tuple]:
    """Return for each move the moves of the tool's centre."""
    steps = _steps(contour, moves)
    joints = [_joint(contour, a, b, tolerance) for a, b in zip([None, *steps], steps)]
    joints.append(_Joint(_last_place(contour, steps), (0.0, 0.0)))
    cuts = []
    for k, step in enumerate(steps):
        joint, end = joints[k], joints[k + 1].leave
        if not step.cut:
            path = _uncut(step.move, joint.meet, end)
        else:
            path = _trimmed(contour, steps, k, joint.meet, end)
            if joint.corner is not None:
                path = (_corner_arc(step.move, joint), *path)
        cuts.append(Cut(step.move, path, step.cut))
    check_gouges(contour, cuts, tolerance)
    check_contours(contour, cuts, tolerance)
    return [cut.path for cut in cuts]


def _steps(contour: Contour, moves: list) -> list[_Step]:
    steps = []
    offset = 0.0
    for move in moves:
        ramp = bool(move.offset) and not offset
        cut = bool(move.offset) and bool(offset)
        steps.append(_Step(move, _parallel(contour, move) if cut else move, cut, ramp))
        offset = move.offset
    return steps


def _last_place(contour: Contour, steps: list[_Step]) -> Point:
    """Return where the tool's centre ends."""
    step = steps[-1]
    if step.ramp:
        contour.refuse(
            step.move.line, f"{_code(step.move)} needs a block of the contour behind its G1"
        )
    return _end(step.parallel)


def _joint(contour: Contour, a: _Step | None, b: _Step, tolerance: float) -> _Joint:
    """Return the joint between two moves that follow each other in the plane."""
    if a is not None and a.ramp and not b.cut:
        contour.refuse(
            b.move.line,
            f"G40 follows {_code(a.move)} of line {a.move.line} with nothing between them to cut",
        )
    if a is None or not a.cut:
        place = _start(b.parallel)
        return _Joint(place, place)
    if not b.cut:
        place = _end(a.parallel)
        return _Joint(place, place)
    return _corner(contour, a, b, tolerance)


def _corner(contour: Contour, a: _Step, b: _Step, tolerance: float) -> _Joint:
    """Return the joint between two elements under compensation."""
    ax, ac = end_direction(a.move)
    bx, bc = start_direction(b.move)
    sine, cosine = ax * bc - ac * bx, ax * bx + ac * bc
    leave, meet = _end(a.parallel), _start(b.parallel)
    corner, offset = (b.move.x0, b.move.c0), b.move.offset
    gap = hypot(meet[0] - leave[0], meet[1] - leave[1])
    if cosine > 0.0 and _is_joined(a, b, gap, abs(sine), tolerance):
        place = (0.5 * (leave[0] + meet[0]), 0.5 * (leave[1] + meet[1]))
        return _Joint(place, place)
    if sine * offset <= PARALLEL * abs(offset):
        return _Joint(leave, meet, corner)
    place = crossing(a.parallel, b.parallel)
    if place is None:
        _refuse_tight(contour, a, b)
    return _Joint(place, place)


def _is_joined(a: _Step, b: _Step, gap: float, sine: float, tolerance: float) -> bool:
    """Return whether two parallels need no arc between them: it would be a very short piece."""
    straight = isinstance(a.move, Line) and isinstance(b.move, Line)
    moved = gap * sine / 8.0
    return moved <= JOINED * tolerance and (straight or gap <= BESIDE * tolerance)


def _refuse_tight(contour: Contour, a: _Step, b: _Step) -> NoReturn:
    contour.refuse(
        b.move.line,
        f"the tool of radius {number(abs(b.move.offset))} cannot reach both lines {a.move.line} "
        f"and {b.move.line}: their corner is too tight",
    )


def _code(move: Line | Arc) -> str:
    return "G41" if move.offset > 0.0 else "G42"


def _corner_arc(move: Line | Arc, joint: _Joint) -> Arc:
    """Return the arc about an outside corner in front of ``move``."""
    turn = -1 if move.offset > 0.0 else 1
    sweep = sweep_between(joint.leave, joint.meet, joint.corner, turn)
    return Arc(
        move.line,
        move.feed,
        move.offset,
        *joint.leave,
        move.z0,
        *joint.meet,
        move.z0,
        *joint.corner,
        sweep,
    )


def _parallel(contour: Contour, move: Line | Arc) -> Line | Arc:
    """Return the move shifted by its offset: the path of the tool's centre along it."""
    if isinstance(move, Line):
        tx, tc = start_direction(move)
        dx, dc = -tc * move.offset, tx * move.offset
        return _placed(move, (move.x0 + dx, move.c0 + dc), (move.x1 + dx, move.c1 + dc))
    radius = arc_radius(move)
    scale = 1.0 - copysign(move.offset, move.offset * move.sweep) / radius
    if scale * radius < -SAME_PLACE:
        contour.refuse(
            move.line,
            f"the arc of radius {number(radius)} is smaller than the tool radius "
            f"{number(abs(move.offset))} ({_neighbours(contour, move)})",
        )
    cx, cc = move.cx, move.cc
    return _placed(
        move,
        (cx + (move.x0 - cx) * scale, cc + (move.c0 - cc) * scale),
        (cx + (move.x1 - cx) * scale, cc + (move.c1 - cc) * scale),
    )


def _neighbours(contour: Contour, move: Line | Arc) -> str:
    """Return the lines of the moves beside one, for a message."""
    moves = [e for e in contour.elements if is_move(e)]
    k = moves.index(move)  # a ramp is in front of it, and one behind
    return f"between lines {moves[k - 1].line} and {moves[k + 1].line}"


def _trimmed(contour: Contour, steps: list[_Step], k: int, start: Point, end: Point) -> tuple:
    """Return the parallel of a step from one place on it to another that must lie behind."""
    move, parallel = steps[k].move, steps[k].parallel
    first, last = along_start(parallel, start), along_end(parallel, end)
    if last - first < -SAME_PLACE:
        contour.refuse(
            move.line,
            f"too short for the tool radius {number(abs(move.offset))} between its inside corners "
            f"with lines {steps[k - 1].move.line} and {steps[k + 1].move.line}",
        )
    if last - first <= SAME_PLACE:
        return _in_place(move)
    if isinstance(move, Line):
        return (_placed(move, start, end),)
    sweep = copysign((last - first) / arc_radius(parallel), move.sweep)
    return (_placed(move, start, end, sweep),)


def _uncut(move: Line | Arc, start: Point, end: Point) -> tuple:
    """Return a ramp, or a move without compensation, between the joints at its ends.

    A ramp square to the contour and as long as the tool's radius is no way at all.
    """
    if isinstance(move, Line) and hypot(end[0] - start[0], end[1] - start[1]) <= SAME_PLACE:
        return _in_place(move)
    return (_placed(move, start, end),)


def _in_place(move: Line | Arc) -> tuple:
    """Return what is left of a move whose way in the plane is none: its Z."""
    return () if move.z0 == move.z1 else (Plunge(move.line, move.feed, move.z0, move.z1),)


def _placed(move: Line | Arc, start: Point, end: Point, sweep: float | None = None) -> Line | Arc:
    """Return the move with other end points."""
    places = (*start, move.z0, *end, move.z1)
    if isinstance(move, Line):
        return Line(move.line, move.feed, move.offset, *places)
    sweep = move.sweep if sweep is None else sweep
    return Arc(move.line, move.feed, move.offset, *places, move.cx, move.cc, sweep)


def _start(move: Line | Arc) -> Point:
    return move.x0, move.c0


def _end(move: Line | Arc) -> Point:
    return move.x1, move.c1
