# SPDX-License-Identifier: GPL-2.0-or-later
"""From a contour to the tool centre's path: cutter compensation, without the program's rounding.

Each element under compensation is shifted to its parallel on the tool's side, then joined to its
neighbours:

- outside corner: an arc about the corner, part of the block that follows;
- inside corner: both parallels end where they cross;
- ramp on: ends square to the start of the next element of the contour; ramp off: starts square to
  the end of the last one. Blocks without motion in the plane are skipped.

Corners that are too tight for the tool are refused, and so is a path on which it gouges (`gouge`).

Moves under compensation may be only rounding of the program's points, not geometry. A CAM system's
last decimal makes a chamfer of a corner, or sends the contour back by a step. The tool's centre
would turn by any angle about such a move. A move shorter than a small share of the tolerance is
removed and its neighbours are joined; its Z remains.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from math import copysign
from typing import NamedTuple, NoReturn, TypeGuard

from g12.compensation.compensated import PathOfMove
from g12.compensation.contour import SAME_POINT, Contour, PathElement, PlaneMove, Plunge
from g12.compensation.gouge import LeadRefusal, check_gouges
from g12.errors import Refusal, number
from g12.geometry.curve import PARALLEL_SINE, Arc, Curve, Line, crossings, sweep_between

JOINED = 0.04  # tolerances: parallels with an arc of less sagitta are joined without it
ONE_CORNER = 2.0  # tolerances: ends within this distance are one corner


class _Step(NamedTuple):
    """A move of the contour, and its parallel.

    ``compensated``: compensation is on at both its ends. ``ramp``: it is switched on by this move.
    """

    move: PlaneMove
    parallel: Curve
    compensated: bool
    ramp: bool


class _Joint(NamedTuple):
    """The end of one move's path and the start of the next one's, with an arc about ``corner``.

    Without a corner the two points are the same.
    """

    end_before: complex
    start_after: complex
    corner: complex | None = None


def tool_path(contour: Contour, elements: list[PathElement], tolerance: float) -> list[PathElement]:
    """Return the tool centre's path for a contour's elements, in the same order.

    ``tolerance`` in program units: the path deviates by a small share of it.
    """
    moves = [e for e in elements if isinstance(e, PlaneMove)]
    if not any(e.offset for e in moves):
        return elements
    try:
        centred = iter(_centred(contour, moves, tolerance))
    except LeadRefusal as refusal:
        raise _with_other_side(refusal, contour, moves, tolerance) from None
    path: list[PathElement] = []
    for element in elements:
        path.extend(next(centred) if isinstance(element, PlaneMove) else (element,))
    return path


def _with_other_side(
    refusal: Refusal, contour: Contour, moves: list[PlaneMove], tolerance: float
) -> Refusal:
    """Return a refusal that suggests the other of G41 and G42, where that one can be cut."""
    others = [move._replace(offset=-move.offset) for move in moves]
    trial = copy(contour)
    trial.elements, trial.notes = list(others), []
    try:
        _centred(trial, others, tolerance)
    except Refusal:
        return refusal
    codes = sorted({_code(contour, move) for move in others if move.offset})
    return Refusal(f"{refusal.rule}. {' and '.join(codes)}?", refusal.code, refusal.line)


def _centred(
    contour: Contour, moves: list[PlaneMove], tolerance: float
) -> list[tuple[PathElement, ...]]:
    """Return for each move the moves of the tool's centre."""
    steps = _steps(contour, moves)
    last = steps[-1]
    if last.ramp:
        contour.refuse(
            last.move.line,
            f"{_code(contour, last.move)} needs a block of the contour after its G1",
        )
    joints = [_joint(contour, a, b, tolerance) for a, b in zip([None, *steps], steps)]
    joints.append(_Joint(last.parallel.end, last.parallel.end))
    cuts = []
    for k, step in enumerate(steps):
        joint = joints[k]
        path = _between(contour, steps, k, joint.start_after, joints[k + 1].end_before)
        if joint.corner is not None:
            path = (_corner_arc(step.move, joint, joint.corner), *path)
        cuts.append(PathOfMove(step.move, path, step.compensated))
    check_gouges(contour, cuts, tolerance)
    return [cut.path for cut in cuts]


def _steps(contour: Contour, moves: list[PlaneMove]) -> list[_Step]:
    steps = []
    offset = 0.0
    for move in moves:
        ramp = bool(move.offset) and not offset
        compensated = bool(move.offset) and bool(offset)
        curve = _parallel(contour, move) if compensated else move.curve
        steps.append(_Step(move, curve, compensated, ramp))
        offset = move.offset
    return steps


def _joint(contour: Contour, a: _Step | None, b: _Step, tolerance: float) -> _Joint:
    """Return the joint between two moves that follow each other in the plane."""
    if a is not None and a.ramp and not b.compensated:
        contour.refuse(
            b.move.line,
            f"G40 follows {_code(contour, a.move)} of line {a.move.line}"
            " with nothing between them to cut",
        )
    if a is not None and a.compensated and b.compensated:
        return _corner(contour, a, b, tolerance)
    point = a.parallel.end if a is not None and a.compensated else b.parallel.start
    return _Joint(point, point)


def _corner(contour: Contour, a: _Step, b: _Step, tolerance: float) -> _Joint:
    turned = a.move.curve.direction(1.0).conjugate() * b.move.curve.direction(0.0)
    sine, cosine = turned.imag, turned.real
    end_before, start_after, offset = a.parallel.end, b.parallel.start, b.move.offset
    if cosine > 0.0 and _is_joined(a, b, abs(start_after - end_before), abs(sine), tolerance):
        point = (end_before + start_after) / 2
        return _Joint(point, point)
    if sine * offset <= PARALLEL_SINE * abs(offset):
        return _Joint(end_before, start_after, b.move.start)
    crossing = _crossing(a.parallel, b.parallel)
    if crossing is None:
        _refuse_tight(contour, a, b)
    return _Joint(crossing, crossing)


def _crossing(one: Curve, other: Curve) -> complex | None:
    """Return the crossing of two parallels nearest to the corner, None without one."""
    length, best, nearest = one.length, None, 0.0
    for point in crossings(one, other):
        on_one, on_other = one.length_to(point, late=True), other.length_to(point)
        on_both = (
            -SAME_POINT <= on_one <= length + SAME_POINT
            and -SAME_POINT <= on_other <= other.length + SAME_POINT
        )
        if on_both and (best is None or length - on_one + on_other < nearest):
            best, nearest = point, length - on_one + on_other
    return best


def _is_joined(a: _Step, b: _Step, gap: float, sine: float, tolerance: float) -> bool:
    """Return whether two parallels need no arc between them: it would be very short."""
    straight = isinstance(a.parallel, Line) and isinstance(b.parallel, Line)
    sagitta = gap * sine / 8.0  # of an arc with the gap as its chord
    return sagitta <= JOINED * tolerance and (straight or gap <= ONE_CORNER * tolerance)


def _refuse_tight(contour: Contour, a: _Step, b: _Step) -> NoReturn:
    contour.refuse(
        b.move.line,
        f"the tool of radius {number(abs(b.move.offset))} cannot reach both lines {a.move.line} "
        f"and {b.move.line}: their corner is too tight",
    )


def _code(contour: Contour, move: PlaneMove) -> str:
    return "G41" if (move.offset > 0.0) != contour.mirrored else "G42"


def _corner_arc(move: PlaneMove, joint: _Joint, corner: complex) -> PlaneMove:
    turn = -1 if move.offset > 0.0 else 1
    sweep = sweep_between(joint.end_before, joint.start_after, corner, turn)
    return move._replace(curve=Arc(joint.end_before, corner, sweep), h1=move.h0)


def _parallel(contour: Contour, move: PlaneMove) -> Curve:
    """Return the curve shifted by its offset: the path of the tool's centre along it."""
    curve = move.curve
    if isinstance(curve, Arc):
        inward = move.offset if curve.sweep > 0.0 else -move.offset
        if inward - curve.radius > SAME_POINT:
            contour.refuse(
                move.line,
                f"the arc of radius {number(curve.radius)} is smaller than the tool radius "
                f"{number(abs(move.offset))} ({_neighbours(contour, move)})",
            )
    return curve.offset(move.offset)


def _neighbours(contour: Contour, move: PlaneMove) -> str:
    moves = [e for e in contour.elements if isinstance(e, PlaneMove)]
    k = moves.index(move)  # one ramp comes before it, another after it
    return f"between lines {moves[k - 1].line} and {moves[k + 1].line}"


def _between(
    contour: Contour, steps: list[_Step], k: int, start: complex, end: complex
) -> tuple[PathElement, ...]:
    """Return the parallel of a step between the joints at its ends; refuse them in reverse order.

    A ramp that is square to the contour and as long as the tool's radius shrinks to a point.
    """
    move, parallel, compensated = steps[k].move, steps[k].parallel, steps[k].compensated
    if isinstance(parallel, Arc) and not compensated:
        return (move,)
    length = abs(end - start)
    if compensated:
        length = parallel.length_to(end, late=True) - parallel.length_to(start)
    if length < -SAME_POINT:
        contour.refuse(
            move.line,
            f"too short for the tool radius {number(abs(move.offset))} between its inside corners "
            f"with lines {steps[k - 1].move.line} and {steps[k + 1].move.line}",
        )
    if length <= SAME_POINT:
        return _move_of_z(move)
    if isinstance(parallel, Line):
        return (move._replace(curve=Line(start, end)),)
    sweep = copysign(length / parallel.radius, parallel.sweep)
    return (move._replace(curve=Arc(start, parallel.centre, sweep)),)


def _move_of_z(move: PlaneMove) -> tuple[PathElement, ...]:
    """Return the move of Z that remains of a move without length in the plane, if any."""
    return () if move.h0 == move.h1 else (Plunge(move.line, move.feed, move.h0, move.h1),)


MOST_POINTS = 100  # replaced by one line: each further point is checked against all of them


def without_short_moves(
    elements: Sequence[PathElement], limit: float
) -> tuple[list[PathElement], float]:
    """Return a contour's elements without the moves under compensation up to ``limit`` long.

    Also returns the greatest shift of the contour by that, at most ``limit``. Program units.
    """
    remaining: list[PathElement] = []
    last, shift = None, 0.0  # ``last``: the index of the last move in ``remaining``
    for element in elements:
        if not isinstance(element, PlaneMove):
            remaining.append(element)
            continue
        before = None if last is None else remaining[last]
        away = 0.0 if before is None else abs(element.end - before.end)
        compensated = before is not None and before.offset and element.offset
        if compensated and max(element.length, away) <= limit:
            shift = max(shift, away)
            remaining.extend(_move_of_z(element))
            continue
        if before and abs(element.start - before.end) > SAME_POINT:
            remaining[last], *between, element = _connected(before, element)
            remaining.extend(between)
        last = len(remaining)
        remaining.append(element)
    return remaining, shift


def _connected(before: PlaneMove, move: PlaneMove) -> list[PlaneMove]:
    """Return two moves, the first ending where the second begins, by a line between two arcs."""
    if isinstance(move.curve, Line):
        return [before, move._replace(curve=Line(before.end, move.end))]
    if isinstance(before.curve, Line):
        return [before._replace(curve=Line(before.start, move.start)), move]
    return [before, move._replace(curve=Line(before.end, move.start), h1=move.h0), move]


def without_rounding_points(
    elements: Sequence[PathElement], limit: float
) -> tuple[list[PathElement], float]:
    """Return a contour's elements without the points of polylines that are only rounding.

    Lines under compensation that follow each other at one feed and Z become one line, as long as
    all points between stay within ``limit`` of it. Also returns the greatest shift of the contour
    by that. Program units.
    """
    remaining: list[PathElement] = []
    shift = offset = 0.0
    at = 0
    while at < len(elements):
        element = elements[at]
        # A ramp is not changed: the contour begins at its end.
        last, away = _line_through(elements, at, limit) if offset else (at, 0.0)
        offset = element.offset if isinstance(element, PlaneMove) else offset
        end = elements[last]
        if last > at and isinstance(element, PlaneMove) and isinstance(end, PlaneMove):
            shift = max(shift, away)
            element = element._replace(curve=Line(element.start, end.end))
        remaining.append(element)
        at = last + 1
    return remaining, shift


def with_arcs_of_the_tool(
    elements: Sequence[PathElement], limit: float
) -> tuple[list[PathElement], float]:
    """Return a contour's elements with the tool's radius for inside arcs of nearly that radius.

    Within ``limit``: a rounded I and J make such a fillet a little smaller or larger than the tool.
    The centres are kept. Also returns the greatest shift of the contour by that. Program units.
    """
    remaining: list[PathElement] = []
    shift = 0.0
    for element in elements:
        if isinstance(element, PlaneMove) and isinstance(element.curve, Arc):
            arc = element.curve
            growth = copysign(element.offset, element.offset * arc.sweep) - arc.radius
            if element.offset and abs(growth) <= limit:
                shift = max(shift, abs(growth))
                element = element._replace(curve=arc.offset(-growth * copysign(1.0, arc.sweep)))
        remaining.append(element)
    return remaining, shift


def _line_through(elements: Sequence[PathElement], first: int, limit: float) -> tuple[int, float]:
    """Return the last of the elements that one line can replace, and its deviation from them."""
    one, most = elements[first], 0.0
    if not _is_level_line(one) or not one.offset:
        return first, most
    lines = [one]
    for at in range(first + 1, min(len(elements), first + MOST_POINTS)):
        other = elements[at]
        if not _is_level_line(other) or other.h1 != one.h1:
            break
        if (other.feed, other.offset) != (one.feed, one.offset):
            break
        chord = Line(one.start, other.end)
        if chord.length <= limit:
            break
        away = max(chord.distance(line.end) for line in lines)
        if away > limit:
            break
        lines.append(other)
        most = away
    return first + len(lines) - 1, most


def _is_level_line(element: PathElement) -> TypeGuard[PlaneMove]:
    if isinstance(element, PlaneMove) and isinstance(element.curve, Line):
        return element.h0 == element.h1
    return False


SHORT_SHARE = 0.3  # of the tolerance: a shorter move under compensation is rounding


def centre_path(contour: Contour, tolerance: float) -> tuple[list[PathElement], float]:
    """Return the tool centre's path, and the greatest shift of the contour for it.

    Points as close together as their last decimal make corners that no tool can follow, and fillets
    of the tool's radius are a little off it. Where a contour would be refused, it is tried again
    without such rounding.
    """
    limit = SHORT_SHARE * tolerance
    elements, shift = without_short_moves(contour.elements, limit)
    try:
        return tool_path(contour, elements, tolerance - shift), shift
    except Refusal as refusal:
        simpler = elements
        for simplified in (without_rounding_points, with_arcs_of_the_tool):
            simpler, further_shift = simplified(simpler, limit - shift)
            shift += further_shift
        if simpler == elements:
            raise
        try:
            return tool_path(contour, simpler, tolerance - shift), shift
        except Refusal:
            raise refusal from None
