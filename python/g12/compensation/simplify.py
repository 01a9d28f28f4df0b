# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves under compensation that are too short to be meant: the rounding of a program's points.

A CAM system's last decimal makes a chamfer of a corner, or sends the contour back by a step. Beside
such a move the tool's centre would turn by any angle. What is shorter than a small part of the
tolerance is left out and its neighbours meet instead; its Z is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from g12.compensation.contour import Arc, Line, Plunge, is_move, path_length
from g12.compensation.intersect import distance_from

MOST_POINTS = 100  # that one line stands for: all of them are looked at for each one more


def without_short_moves(elements: Sequence, limit: float) -> tuple[list, float]:
    """Return a contour's elements without the moves under compensation up to ``limit`` long.

    Also returns by how much that has moved the contour at most, up to ``limit``. Program units.
    """
    kept: list = []
    last, moved = None, 0.0  # the index of the move kept last
    for element in elements:
        if not is_move(element):
            kept.append(element)
            continue
        before = None if last is None else kept[last]
        away = 0.0 if before is None else _distance(before, element.x1, element.c1)
        if before and _is_short(before, element, limit) and away <= limit:
            moved = max(moved, away)
            if element.z0 != element.z1:
                kept.append(Plunge(element.line, element.feed, element.z0, element.z1))
            continue
        if before and _distance(before, element.x0, element.c0) > 0.0:
            kept[last], *between, element = _meeting(before, element)
            kept.extend(between)
        last = len(kept)
        kept.append(element)
    return kept, moved


def _meeting(before: Line | Arc, move: Line | Arc) -> list[Line | Arc]:
    """Return two moves and what is between them, each beginning where the one before ends."""
    if isinstance(move, Line):
        return [before, move._replace(x0=before.x1, c0=before.c1)]
    if isinstance(before, Line):
        return [before._replace(x1=move.x0, c1=move.c0), move]
    start, end = (before.x1, before.c1, move.z0), (move.x0, move.c0, move.z0)
    return [before, Line(move.line, move.feed, move.offset, *start, *end), move]


def with_points_left_out(elements: Sequence, limit: float) -> tuple[list, float]:
    """Return a contour's elements without the points of polylines that are only rounding.

    Lines under compensation that follow each other at one feed and Z become one line, as long as
    all points between stay within ``limit`` of it. Also returns by how much that has moved the
    contour at most. Program units.
    """
    kept: list = []
    moved = offset = 0.0
    at = 0
    while at < len(elements):
        element = elements[at]
        beside = offset != 0.0  # else this is the ramp: it ends where the contour begins
        last, away = _reach(elements, at, limit) if beside else (at, 0.0)
        offset = element.offset if is_move(element) else offset
        if last > at:
            moved = max(moved, away)
            element = element._replace(x1=elements[last].x1, c1=elements[last].c1)
        kept.append(element)
        at = last + 1
    return kept, moved


def _reach(elements: Sequence, first: int, limit: float) -> tuple[int, float]:
    """Return the last of the elements that one line can stand for, and how far it is off them."""
    last, most = first, 0.0
    end_at = min(len(elements), first + MOST_POINTS)
    while last + 1 < end_at and _is_like(elements[first], elements[last + 1]):
        end = elements[last + 1]
        chord = elements[first]._replace(x1=end.x1, c1=end.c1)
        if path_length(chord) <= limit:
            break
        points = elements[first : last + 1]
        away = max(distance_from(chord, (point.x1, point.c1)) for point in points)
        if away > limit:
            break
        last, most = last + 1, away
    return last, most


def _is_like(one: object, other: object) -> bool:
    """Return whether two elements are lines under compensation that may be one."""
    if not (isinstance(one, Line) and isinstance(other, Line) and one.offset):
        return False
    level = one.z0 == one.z1 == other.z1
    return level and one.feed == other.feed and one.offset == other.offset


def _is_short(before: Line | Arc, move: Line | Arc, limit: float) -> bool:
    """Return whether a move that follows another under compensation may be left out."""
    return bool(before.offset and move.offset) and path_length(move) <= limit


def _distance(move: Line | Arc, x: float, c: float) -> float:
    """Return how far a place is from the end of a move."""
    return hypot(x - move.x1, c - move.c1)
