# SPDX-License-Identifier: GPL-2.0-or-later
"""Which moves of a section LinuxCNC can plan itself, as lines and arcs in X and Y of the face.

On the face LinuxCNC knows nothing of the C axis, nor of what the slide has to do. Where the tool
is at the distance r from the pole with the velocity u along the radius and w around the pole, and
the acceleration a along the radius and b around it, C and the slide need

    C's speed            w / r
    C's acceleration     (b - 2 u w / r) / r
    the slide's          a + w**2 / r

An arc needs v**2 / R towards its centre. What the planner has beside that it uses along the path,
up to speed or down, wherever the operator may stop the feed: so it counts all along. A move stays
off the face, and is made of pieces, when one of these would be beyond its limit anywhere on it.

With the tool beside the X line by p, r is where the slide stands, u and a go along it and w and b
around it. The slide's speed is u + p w / r, b is more by p (w / r)**2, and the slide's acceleration
by p times C's.
"""

from __future__ import annotations

from itertools import groupby
from math import atan2, ceil, cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

from g12.compensation.contour import (
    SAME_PLACE,
    Arc,
    Line,
    Plunge,
    Point,
    arc_radius,
    direction_at,
    end_direction,
    is_move,
    path_length,
    start_direction,
    sweep_between,
)
from g12.compensation.intersect import height_at, part_of_move, place_at
from g12.polar.beside import along_and_around, stand
from g12.polar.pole import POLE

LOOKS = 16  # places on a line, and on each quarter of an arc, that are looked at
WORTH_IT = 0.1  # seconds: two switches cost about as much
WORTH_PARTING = 0.5  # seconds: the ways there and back, and their stops
SWITCHING = 0.25  # seconds: what they take
SHARES = (1.0, 0.8, 0.64, 0.5)  # of the feed, at which C can follow nearer to the pole
LEAST_SPEED = 1e-3  # program units per second
LEAST_GAIN = 0.05  # of the time that pieces take
SAME_DIRECTION = 1e-6  # radians
SLACK = 1.0 + 1e-9  # rounding: X and Y together may have just what the slide has


class FaceLimits(NamedTuple):
    """What a machine can do on its face; lengths in program units, times in seconds."""

    acceleration: float  # of X and Y together: the most that the planner uses in any direction
    round_acceleration: float  # the most that it uses on an arc
    slide_acceleration: float
    c_acceleration: float  # radians per second squared
    c_speed: float  # radians per second
    override: float  # the most that the operator may turn the feed up by
    pieces_speed: float  # about what pieces reach: below it nothing is gained by parting
    slide_speed: float = inf
    beside: float = 0.0  # the X line is the tool, towards C+


class FaceSwitch(NamedTuple):
    """Going to the face (``on``), or back, where the machine stands at ``place``."""

    line: int
    on: bool
    place: tuple[float, float, float]  # X (radius value), C in degrees, Z


class FaceMove(NamedTuple):
    """A move on the face, in its X and Y: C's zero line is where C stood at the switch.

    ``pieces`` are places that the machine passes, X (radius value), C in degrees and Z: the last
    is the end, and no axis goes farther than they tell.
    """

    line: int
    move: Line | Arc | Plunge
    pieces: list[tuple[float, float, float]]


def chosen(path: list, limits: FaceLimits) -> list[bool]:
    """Return for each element of the tool centre's path whether it is made on the face.

    Elements that are no moves in the plane go with the one in front of them.
    """
    able = [is_able(element, limits) if is_move(element) else None for element in path]
    on_face = [False] * len(path)
    begin = 0
    while begin < len(path):
        end = begin + 1
        while end < len(path) and able[end] in (able[begin], None):
            end += 1
        run = path[begin:end]
        if able[begin] and sum(map(_seconds, run)) >= WORTH_IT:
            on_face[begin:end] = [True] * len(run)
        begin = end
    return on_face


def parted(path: list, stopping: list[bool], limits: FaceLimits) -> tuple[list, list[bool]]:
    """Return a path whose moves are parted where C can no longer follow them on the face.

    ``stopping`` tells of each element whether it ends in a stop; so does what is returned.
    """
    elements: list = []
    stops: list[bool] = []
    for element, stop in zip(path, stopping):
        parts = _stretches(element, limits) if is_move(element) else [element]
        elements += parts
        stops += [*[False] * (len(parts) - 1), stop]
    return elements, stops


def _stretches(move: Line | Arc, limits: FaceLimits) -> list[Line | Arc]:
    """Return a move in parts, those on the face at a feed at which they can be followed."""
    if move.feed / 60.0 <= limits.pieces_speed or is_able(move, limits):
        return [move]
    places = (0.0, *_parts(move))
    ways = [_at_feed(move, places, share, limits) for share in SHARES]
    runs, share, seconds = min(ways, key=lambda way: way[2])
    if seconds > (1.0 - LEAST_GAIN) * _in_pieces(move, limits):
        return [move]
    cuts = sorted({0.0, 1.0, *(end for run in runs for end in run)})
    parts = [part_of_move(move, first, last) for first, last in zip(cuts, cuts[1:])]
    return [
        _as_fast_as_followed(part, share, limits) if ends in runs else part
        for part, ends in zip(parts, zip(cuts, cuts[1:]))
    ]


def _as_fast_as_followed(part: Line | Arc, least: float, limits: FaceLimits) -> Line | Arc:
    """Return a part of a move at the most of its feed that is followed, the share ``least`` is."""
    faster = (part._replace(feed=share * part.feed) for share in SHARES if share > least)
    slowest = part._replace(feed=least * part.feed)
    return next((one for one in faster if is_able(one, limits)), slowest)


def _at_feed(
    move: Line | Arc, places: tuple[float, ...], share: float, limits: FaceLimits
) -> tuple[list[tuple[float, float]], float, float]:
    """Return which parts of a move are worth the way to the face at a share of its feed.

    With that share, and about how long the move takes, the rest in pieces.
    """
    slower, runs = move._replace(feed=share * move.feed), []
    for followed, run in groupby(places, lambda part: _is_followed(slower, part, limits)):
        first, *between = run
        last = between[-1] if between else first
        if followed and (last - first) * _seconds(slower) >= WORTH_PARTING:
            runs.append((first, last))
    on_face = sum(last - first for first, last in runs)
    in_pieces = (1.0 - on_face) * _in_pieces(move, limits)
    return runs, share, on_face * _seconds(slower) + in_pieces + SWITCHING * len(runs)


def _in_pieces(move: Line | Arc, limits: FaceLimits) -> float:
    """Return about how long pieces take, in seconds."""
    return 60.0 * path_length(move) / min(move.feed, 60.0 * max(limits.pieces_speed, LEAST_SPEED))


def _seconds(element: object) -> float:
    return 60.0 * path_length(element) / element.feed if is_move(element) else 0.0


def is_able(move: Line | Arc, limits: FaceLimits) -> bool:
    """Return whether C and the slide can follow a move on the face, wherever it is stopped."""
    return all(_is_followed(move, part, limits) for part in (0.0, *_parts(move)))


def _is_followed(move: Line | Arc, part: float, limits: FaceLimits) -> bool:
    """Return whether C and the slide can follow a move at one of its places."""
    most, speed = limits.acceleration, limits.override * move.feed / 60.0
    curving = 0.0
    if isinstance(move, Arc):
        most, radius = limits.round_acceleration, arc_radius(move)
        speed = min(speed, sqrt(most * radius))  # the planner goes no faster round it
        curving = speed * speed / radius
    left = sqrt(max(0.0, most * most - curving * curving))
    at_speed, standing = _Going(speed, curving, left), _Going(0.0, 0.0, most)
    return all(_can_follow(move, part, going, limits) for going in (at_speed, standing))


class _Going(NamedTuple):
    """A speed, the acceleration towards an arc's centre at it, and what is left along the path."""

    speed: float
    curving: float
    left: float


def _can_follow(move: Line | Arc, part: float, going: _Going, limits: FaceLimits) -> bool:
    place, beside = place_at(move, part), limits.beside
    if hypot(*place) <= abs(beside) + SAME_PLACE:
        return False
    slide, way = stand(place, beside)
    along, around = along_and_around(direction_at(move, place), way)
    leftwards = going.curving if isinstance(move, Arc) and move.sweep > 0.0 else -going.curving
    inward, aside = -leftwards * around, leftwards * along
    turning = going.speed * around / slide
    share = beside / slide * around
    sliding = going.speed * (along + share)
    pushed = (aside - 2.0 * turning * sliding + beside * turning * turning) / slide
    lifted = inward + turning * turning * slide + beside * pushed
    return (
        abs(turning) <= limits.c_speed
        and abs(sliding) <= limits.slide_speed * SLACK
        and abs(pushed) + going.left * abs(around) / slide <= limits.c_acceleration
        and abs(lifted) + going.left * abs(along + share) <= limits.slide_acceleration * SLACK
    )


def _parts(move: Line | Arc) -> list[float]:
    """Return the parts of a move to look at: evenly spaced, and where it may be nearest."""
    count = LOOKS
    if isinstance(move, Arc):
        count *= ceil(abs(move.sweep) / (pi / 2))
        special = [_part_towards(move, place) for place in (POLE, (2 * move.cx, 2 * move.cc))]
    else:
        dx, dc = move.x1 - move.x0, move.c1 - move.c0
        special = [-(move.x0 * dx + move.c0 * dc) / (dx * dx + dc * dc)]
    return sorted({k / count for k in range(1, count + 1)} | {k for k in special if 0.0 < k < 1.0})


def _part_towards(move: Arc, place: Point) -> float:
    """Return the part of an arc at which it is in the direction of a place from its centre."""
    turn = 1 if move.sweep > 0.0 else -1
    return sweep_between((move.x0, move.c0), place, (move.cx, move.cc), turn) / move.sweep


def flows_into(move: object, following: object) -> bool:
    """Return whether an arc goes on in its own direction: nothing stops or is blended there."""
    if not isinstance(move, Arc) or not isinstance(following, (Line, Arc)):
        return False
    (x0, c0), (x1, c1) = end_direction(move), start_direction(following)
    return x0 * x1 + c0 * c1 > 0.0 and abs(x0 * c1 - c0 * x1) <= SAME_DIRECTION


def in_face(move: Line | Arc | Plunge, angle: float) -> Line | Arc | Plunge:
    """Return a move of the plane in X and Y of a face whose X axis is at ``angle``, radians."""
    if isinstance(move, Plunge):
        return move
    (x0, c0), (x1, c1) = (
        _turned(*place, -angle) for place in ((move.x0, move.c0), (move.x1, move.c1))
    )
    turned = move._replace(x0=x0, c0=c0, x1=x1, c1=c1)
    if isinstance(move, Line):
        return turned
    cx, cc = _turned(move.cx, move.cc, -angle)
    return turned._replace(cx=cx, cc=cc)


def _turned(x: float, c: float, angle: float) -> tuple[float, float]:
    return x * cos(angle) - c * sin(angle), x * sin(angle) + c * cos(angle)


def passed(move: Line | Arc, angle: float, beside: float = 0.0) -> list[tuple[float, float, float]]:
    """Return places that a move passes: where the slide stands, C's angle in radians, Z.

    The farthest one and the end are among them. ``angle`` is that at the start; the angles go on
    from there without a jump.
    """
    places, (_, before) = [], stand((move.x0, move.c0), beside)
    for part in _parts(move) if isinstance(move, Arc) else (1.0,):
        slide, (x, c) = stand(place_at(move, part), beside)
        angle += atan2(before[0] * c - before[1] * x, before[0] * x + before[1] * c)
        places.append((slide, angle, height_at(move, part)))
        before = x, c
    return places
