# SPDX-License-Identifier: GPL-2.0-or-later
"""From a contour to the tool centre's path, without the rounding in the program's points.

Moves under compensation may be only rounding of the program's points, not geometry. A CAM system's
last decimal makes a chamfer of a corner, or sends the contour back by a step. The tool's centre
would turn by any angle about such a move. A move shorter than a small share of the tolerance is
removed and its neighbours are joined; its Z remains.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign
from typing import TypeGuard

from g12.compensation.contour import SAME_POINT, Contour, PathElement, PlaneMove, Plunge
from g12.compensation.offset import tool_path
from g12.errors import Refusal
from g12.geometry.curve import Arc, Line

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
        if before and _is_short(before, element, limit) and away <= limit:
            shift = max(shift, away)
            if element.h0 != element.h1:
                remaining.append(Plunge(element.line, element.feed, element.h0, element.h1))
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
    if not _is_line(one):
        return first, most
    lines = [one]
    for at in range(first + 1, min(len(elements), first + MOST_POINTS)):
        other = elements[at]
        if not (_is_line(other) and _is_like(one, other)):
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


def _is_like(one: PlaneMove, other: PlaneMove) -> bool:
    level = one.h0 == one.h1 == other.h1
    alike = one.feed == other.feed and one.offset == other.offset
    return one.offset != 0.0 and level and alike


def _is_line(element: PathElement) -> TypeGuard[PlaneMove]:
    return isinstance(element, PlaneMove) and isinstance(element.curve, Line)


def _is_short(before: PlaneMove, move: PlaneMove, limit: float) -> bool:
    return bool(before.offset and move.offset) and move.length <= limit


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
