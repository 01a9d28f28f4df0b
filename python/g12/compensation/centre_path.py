# SPDX-License-Identifier: GPL-2.0-or-later
"""From a contour to the path of the tool's centre: rounding in the program's points is left out."""

from __future__ import annotations

from g12.compensation.contour import Contour, PathElement
from g12.compensation.offset import tool_path
from g12.compensation.simplify import without_rounding_points, without_short_moves
from g12.errors import Refusal

SHORT_SHARE = 0.3  # of the tolerance: a shorter move under compensation is rounding


def centre_path(contour: Contour, tolerance: float) -> tuple[list[PathElement], float]:
    """Return the path of the tool's centre, and by how much the contour was moved for it.

    Points as close together as their last decimal make corners that no tool reaches. Where a
    contour would be refused, it is tried again without them.
    """
    limit = SHORT_SHARE * tolerance
    elements, moved = without_short_moves(contour.elements, limit)
    try:
        return tool_path(contour, elements, tolerance - moved), moved
    except Refusal as refusal:
        fewer, left_out = without_rounding_points(elements, limit - moved)
        if len(fewer) == len(elements):
            raise
        try:
            return tool_path(contour, fewer, tolerance - moved - left_out), moved + left_out
        except Refusal:
            raise refusal from None
