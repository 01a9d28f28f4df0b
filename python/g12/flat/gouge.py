# SPDX-License-Identifier: GPL-2.0-or-later
"""Gouges: places where the tool, on its way beside one move of the contour, cuts into another.

Tested against each other are neighbours, and moves that only moves shorter than the tool's radius
lie between: there the tool swings round corners so near to each other that it may reach past the
move in the middle. Of the tool's way only what is near their corner: a later pass may cross a move.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from g12.errors import number
from g12.flat.contour import Arc, Contour, Line, path_length
from g12.flat.intersect import cross_inside, least_distance, part_of_move

LOCAL = 2.0  # tool radii: so far from the corner the tool's way is tested
BESIDE = 2.0  # tolerances: places so near to each other are one corner


class Cut(NamedTuple):
    """A move of the contour under compensation, and the way of the tool's centre for it.

    ``corner`` is the arc about the corner in front of it, ``path`` what is beside it; None where
    there is none.
    """

    move: Line | Arc
    corner: Arc | None
    path: Line | Arc | None


def refuse_gouges(contour: Contour, cuts: Sequence[Cut | None], tolerance: float) -> None:
    """Refuse a contour along which the tool cuts deeper into it than the tolerance.

    ``cuts`` has None for moves without compensation. Program units.
    """
    for k in range(1, len(cuts)):
        a, b = cuts[k - 1], cuts[k]
        if a and b and _cross(a, b, tolerance):
            _refuse(contour, a, b)
    for a, b, corners in _across_short_moves(cuts):
        if _gouges(a, b, corners, tolerance):
            _refuse(contour, a, b)


def _cross(a: Cut, b: Cut, tolerance: float) -> bool:
    """Return whether neighbours come too near to each other; two lines cannot."""
    if isinstance(a.move, Line) and isinstance(b.move, Line):
        return False
    if a.path and b.path and cross_inside(a.path, b.path, BESIDE * tolerance):
        return True
    return _gouges(a, b, [b.corner] if b.corner else [], tolerance)


def _gouges(a: Cut, b: Cut, corners: Sequence[Arc], tolerance: float) -> bool:
    """Return whether the tool beside either move, or at corners between them, cuts the other."""
    radius = abs(a.move.offset)
    ways = [(corner, cut.move) for corner in corners for cut in (a, b)]
    if a.path:
        ways.append((_near(a.path, radius, True), b.move))
    if b.path:
        ways.append((_near(b.path, radius, False), a.move))
    return any(least_distance(way, move) < radius - tolerance for way, move in ways)


def _near(move: Line | Arc, radius: float, end: bool) -> Line | Arc:
    """Return the part of a move that is near its end, or near its start."""
    share = LOCAL * radius / path_length(move)
    if share >= 1.0:
        return move
    return part_of_move(move, 1.0 - share, 1.0) if end else part_of_move(move, 0.0, share)


def _across_short_moves(cuts: Sequence[Cut | None]) -> Iterator[tuple[Cut, Cut, list[Arc]]]:
    """Yield moves that only short ones lie between, with the corner arcs there: one at least."""
    for k, cut in enumerate(cuts):
        if cut and cut.corner:
            for i, j in _pairs(cuts, k):
                corners = (between.corner for between in cuts[i + 1 : j + 1])
                yield cuts[i], cuts[j], [corner for corner in corners if corner]


def _pairs(cuts: Sequence[Cut | None], k: int) -> Iterator[tuple[int, int]]:
    """Yield the moves in front of and behind corner ``k``, where it is the first between them."""
    radius, before = abs(cuts[k].move.offset), 0.0
    for i in range(k - 1, -1, -1):
        if not cuts[i] or before >= radius:
            return
        between = before
        for j in range(k, len(cuts)):
            if not cuts[j] or between >= radius:
                break
            if j > i + 1:
                yield i, j
            between += path_length(cuts[j].move)
        if cuts[i].corner:
            return
        before += path_length(cuts[i].move)


def _refuse(contour: Contour, a: Cut, b: Cut) -> None:
    contour.refuse(
        b.move.line,
        f"the tool of radius {number(abs(b.move.offset))} cannot follow both lines {a.move.line} "
        f"and {b.move.line}: beside one of them it cuts into the other",
    )
