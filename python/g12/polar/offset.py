# SPDX-License-Identifier: GPL-2.0-or-later
"""Cutter compensation: the path of the tool's centre along a contour.

Each element under compensation is shifted to its parallel on the tool's side, then joined to its
neighbours:

- outside corner: an arc about the corner, part of the block that follows;
- inside corner: both parallels end where they cross;
- ramp on: ends square to the start of the next element of the contour; ramp off: starts square to
  the end of the last one. Blocks without motion in the plane are looked through.

What the tool cannot reach is refused; only neighbours are tested against each other.
"""

from __future__ import annotations

from math import atan2, copysign, hypot, pi, sqrt
from typing import NamedTuple

from g12.errors import number
from g12.polar.contour import Arc, Contour, Line, Plunge, is_move, sweep_between

REACH = 1e-6  # program units: as exact as a program is written
TANGENT = 1e-9  # sine of an angle that is none


class _Step(NamedTuple):
    """A move of the contour, its parallel, and whether it is ``cut`` along or ``ramp`` to one."""

    move: Line | Arc
    parallel: Line | Arc
    cut: bool
    ramp: bool


class _Joint(NamedTuple):
    """Where the tool's centre leaves one move and meets the next; between them, the corner it
    turns about.
    """

    leave: tuple[float, float]
    meet: tuple[float, float]
    corner: tuple[float, float] | None = None


def tool_path(contour: Contour, smooth: float) -> list:
    """Return the contour's elements with the tool centre's coordinates, marks and plunges in their
    places.

    Where the parallels of two elements are no farther apart than ``smooth`` (program units), they
    are joined without an arc: that moves the path by less than a hundredth of it.
    """
    elements = contour.elements
    moves = [e for e in elements if is_move(e)]
    if not moves or (contour.previous is None and not any(e.offset for e in moves)):
        return elements
    centred = iter(_centred(contour, moves, smooth))
    path = []
    for element in elements:
        path.extend(next(centred) if is_move(element) else (element,))
    return path


def _centred(contour: Contour, moves: list, smooth: float):
    """Yield for each move the moves of the tool's centre."""
    steps = _steps(contour, moves)
    before = _before(contour)
    joints = [_joint(contour, a, b, smooth) for a, b in zip([before, *steps], steps)]
    if before is not None:
        _check_going_on(contour, before, joints[0], smooth)
    joints.append(_Joint(_last_place(contour, steps), (0.0, 0.0)))
    for k, step in enumerate(steps):
        start, end = joints[k].meet, joints[k + 1].leave
        turned = () if joints[k].corner is None else (_corner_arc(step.move, joints[k]),)
        if step.cut:
            yield (*turned, *_trimmed(contour, steps, k, start, end))
        else:
            yield (_placed(step.move, start, end),)


def _steps(contour: Contour, moves: list) -> list[_Step]:
    steps = []
    offset = contour.previous.offset if contour.previous else 0.0
    for move in moves:
        ramp = bool(move.offset) and not offset
        cut = bool(move.offset) and bool(offset)
        steps.append(_Step(move, _parallel(contour, move) if cut else move, cut, ramp))
        offset = move.offset
    return steps


def _before(contour: Contour) -> _Step | None:
    """Return what was cut before a section that goes on under compensation."""
    move = contour.previous
    return None if move is None else _Step(move, _parallel(contour, move), True, False)


def _check_going_on(contour: Contour, before: _Step, joint: _Joint, smooth: float) -> None:
    """Check that the tool, which stands square to the end of ``before``, has not gone too far
    already.
    """
    stands = _end(before.parallel)
    if hypot(joint.leave[0] - stands[0], joint.leave[1] - stands[1]) > smooth:
        contour.refuse(
            before.move.line,
            "an inside corner under cutter compensation cannot follow a block that waits for the machine",
        )


def _last_place(contour: Contour, steps: list[_Step]) -> tuple[float, float]:
    """Return where the tool's centre ends."""
    step = steps[-1]
    if step.ramp:
        contour.refuse(
            step.move.line, f"{_code(step.move)} needs a block of the contour behind its G1"
        )
    return _end(step.parallel)


def _joint(contour: Contour, a: _Step | None, b: _Step, smooth: float) -> _Joint:
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
    return _corner(contour, a, b, smooth)


def _corner(contour: Contour, a: _Step, b: _Step, smooth: float) -> _Joint:
    """Return the joint between two elements under compensation."""
    ax, ac = end_direction(a.move)
    bx, bc = start_direction(b.move)
    sine, cosine = ax * bc - ac * bx, ax * bx + ac * bc
    leave, meet = _end(a.parallel), _start(b.parallel)
    corner, offset = (b.move.x0, b.move.c0), b.move.offset
    gap = hypot(meet[0] - leave[0], meet[1] - leave[1])
    if cosine > 0.0 and gap <= smooth and gap * abs(sine) <= 0.1 * smooth:
        place = _mitre(leave, meet, corner, cosine)
        return _Joint(place, place)
    if sine * offset <= TANGENT * abs(offset):
        return _Joint(leave, meet, corner)
    place = _crossing(a.parallel, b.parallel)
    if place is None:
        contour.refuse(
            b.move.line,
            f"the tool of radius {number(abs(offset))} cannot reach both lines {a.move.line} and "
            f"{b.move.line}: their inside corner is too tight",
        )
    return _Joint(place, place)


def _code(move: Line | Arc) -> str:
    return "G41" if move.offset > 0.0 else "G42"


def _mitre(leave, meet, corner, cosine: float) -> tuple[float, float]:
    """Return where the tangents at the ends of two parallels cross; ``cosine`` of the angle
    between them.
    """
    scale = 1.0 / (1.0 + cosine)
    return (
        corner[0] + (leave[0] + meet[0] - 2 * corner[0]) * scale,
        corner[1] + (leave[1] + meet[1] - 2 * corner[1]) * scale,
    )


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
    if scale * radius < -REACH:
        contour.refuse(
            move.line,
            f"the arc of radius {number(radius)} is smaller than the tool radius "
            f"{number(abs(move.offset))} ({_neighbours(contour, move)})",
        )
    scale = max(scale, 0.0)
    cx, cc = move.cx, move.cc
    return _placed(
        move,
        (cx + (move.x0 - cx) * scale, cc + (move.c0 - cc) * scale),
        (cx + (move.x1 - cx) * scale, cc + (move.c1 - cc) * scale),
    )


def _neighbours(contour: Contour, move: Line | Arc) -> str:
    """Return the lines of the moves beside one, for a message."""
    lines = [e.line for e in contour.elements if is_move(e)]
    k = [e for e in contour.elements if is_move(e)].index(move)
    return f"between lines {lines[max(k - 1, 0)]} and {lines[min(k + 1, len(lines) - 1)]}"


def _trimmed(contour: Contour, steps: list[_Step], k: int, start, end) -> tuple:
    """Return the parallel of a step from one place to another, or refuse it when they have changed
    order.
    """
    move, parallel = steps[k].move, steps[k].parallel
    first, last = _along_start(parallel, start), _along_end(parallel, end)
    if last - first < -REACH:
        lines = [steps[n].move.line for n in (k - 1, k + 1) if 0 <= n < len(steps)]
        contour.refuse(
            move.line,
            f"too short for the tool radius {number(abs(move.offset))} between its inside corners with "
            f"lines {' and '.join(map(str, lines))}",
        )
    if last - first <= REACH:
        return () if move.z0 == move.z1 else (Plunge(move.line, move.feed, move.z0, move.z1),)
    if isinstance(move, Line):
        return (_placed(move, start, end),)
    sweep = copysign((last - first) / arc_radius(parallel), move.sweep)
    return (_placed(move, start, end, sweep),)


def _placed(move: Line | Arc, start, end, sweep: float | None = None) -> Line | Arc:
    """Return the move with other end points."""
    places = (*start, move.z0, *end, move.z1)
    if isinstance(move, Line):
        return Line(move.line, move.feed, move.offset, *places)
    sweep = move.sweep if sweep is None else sweep
    return Arc(move.line, move.feed, move.offset, *places, move.cx, move.cc, sweep)


def _start(move: Line | Arc) -> tuple[float, float]:
    return move.x0, move.c0


def _end(move: Line | Arc) -> tuple[float, float]:
    return move.x1, move.c1


def arc_radius(move: Arc) -> float:
    """Return an arc's radius."""
    return hypot(move.x0 - move.cx, move.c0 - move.cc)


def path_length(move: Line | Arc) -> float:
    """Return the length of a move in the plane."""
    if isinstance(move, Line):
        return hypot(move.x1 - move.x0, move.c1 - move.c0)
    return abs(move.sweep) * arc_radius(move)


def start_direction(move: Line | Arc) -> tuple[float, float]:
    """Return the unit vector of the motion in the plane at the move's start."""
    return _direction(move, move.x0, move.c0)


def end_direction(move: Line | Arc) -> tuple[float, float]:
    """Return the unit vector of the motion in the plane at the move's end."""
    return _direction(move, move.x1, move.c1)


def _direction(move: Line | Arc, x: float, c: float) -> tuple[float, float]:
    if isinstance(move, Line):
        tx, tc = move.x1 - move.x0, move.c1 - move.c0
    else:
        turn = 1.0 if move.sweep > 0.0 else -1.0
        tx, tc = turn * (move.cc - c), turn * (x - move.cx)
    length = hypot(tx, tc)
    return tx / length, tc / length


def _along_start(move: Line | Arc, place) -> float:
    """Return how far along a move a place near its start lies; below zero in front of it."""
    if isinstance(move, Line):
        tx, tc = start_direction(move)
        return (place[0] - move.x0) * tx + (place[1] - move.c0) * tc
    angle = _arc_angle(move, place)
    before = max(pi - 0.5 * abs(move.sweep), 0.5)
    return arc_radius(move) * (angle if angle < 2 * pi - before else angle - 2 * pi)


def _along_end(move: Line | Arc, place) -> float:
    """Return how far along a move a place near its end lies; more than its length beyond it."""
    if isinstance(move, Line):
        return _along_start(move, place)
    behind = abs(move.sweep) + max(pi - 0.5 * abs(move.sweep), 0.5)
    return arc_radius(move) * (behind - (behind - _arc_angle(move, place)) % (2 * pi))


def _arc_angle(move: Arc, place) -> float:
    """Return the angle from an arc's start to a place, in its sense of turning, 0 to a full turn."""
    ax, ac = move.x0 - move.cx, move.c0 - move.cc
    bx, bc = place[0] - move.cx, place[1] - move.cc
    angle = atan2(ax * bc - ac * bx, ax * bx + ac * bc)
    return (angle if move.sweep > 0.0 else -angle) % (2 * pi)


def _crossing(a: Line | Arc, b: Line | Arc) -> tuple[float, float] | None:
    """Return where ``a`` is left for ``b``: their crossing nearest to the corner, if there is one."""
    length, best, nearest = path_length(a), None, 0.0
    for place in _crossings(a, b):
        leave, meet = _along_end(a, place), _along_start(b, place)
        on_both = -REACH <= leave <= length + REACH and -REACH <= meet <= path_length(b) + REACH
        if on_both and (best is None or length - leave + meet < nearest):
            best, nearest = place, length - leave + meet
    return best


def _crossings(a: Line | Arc, b: Line | Arc) -> list[tuple[float, float]]:
    """Return the places common to the lines or circles that two moves lie on."""
    if isinstance(a, Arc):
        return _circle_circle(a, b) if isinstance(b, Arc) else _line_circle(b, a)
    return _line_circle(a, b) if isinstance(b, Arc) else _line_line(a, b)


def _line_line(a: Line, b: Line) -> list[tuple[float, float]]:
    ax, ac = start_direction(a)
    bx, bc = start_direction(b)
    sine = ax * bc - ac * bx
    if abs(sine) <= TANGENT:
        return []
    along = ((b.x0 - a.x0) * bc - (b.c0 - a.c0) * bx) / sine
    return [(a.x0 + along * ax, a.c0 + along * ac)]


def _line_circle(line: Line, arc: Arc) -> list[tuple[float, float]]:
    tx, tc = start_direction(line)
    along = (arc.cx - line.x0) * tx + (arc.cc - line.c0) * tc
    foot = (line.x0 + along * tx, line.c0 + along * tc)
    half = _half_chord(hypot(arc.cx - foot[0], arc.cc - foot[1]), arc_radius(arc))
    return [(foot[0] + h * tx, foot[1] + h * tc) for h in half]


def _circle_circle(a: Arc, b: Arc) -> list[tuple[float, float]]:
    distance = hypot(b.cx - a.cx, b.cc - a.cc)
    if distance <= REACH:
        return []
    ux, uc = (b.cx - a.cx) / distance, (b.cc - a.cc) / distance
    radius = arc_radius(a)
    along = 0.5 * (distance + (radius - arc_radius(b)) * (radius + arc_radius(b)) / distance)
    half = _half_chord(abs(along), radius)
    return [(a.cx + along * ux - h * uc, a.cc + along * uc + h * ux) for h in half]


def _half_chord(distance: float, radius: float) -> tuple[float, ...]:
    """Return half the chord at a distance from a circle's centre, both signs; none beside the
    circle.
    """
    if distance > radius + REACH:
        return ()
    half = sqrt(max(0.0, (radius - distance) * (radius + distance)))
    return (half, -half)
