# SPDX-License-Identifier: GPL-2.0-or-later
"""Moves under compensation that are too short to be meant: the rounding of a program's points.

A CAM system's last decimal makes a chamfer of a corner, or sends the contour back by a step. Beside
such a move the tool's centre would turn by any angle. What is shorter than a small part of the
tolerance is left out and its neighbours meet instead; its Z is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from g12.polar.contour import Arc, Line, Plunge, is_move, path_length


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


def _is_short(before: Line | Arc, move: Line | Arc, limit: float) -> bool:
    """Return whether a move that follows another under compensation may be left out."""
    return bool(before.offset and move.offset) and path_length(move) <= limit


def _distance(move: Line | Arc, x: float, c: float) -> float:
    """Return how far a place is from the end of a move."""
    return hypot(x - move.x1, c - move.c1)
