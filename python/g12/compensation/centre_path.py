# SPDX-License-Identifier: GPL-2.0-or-later
"""From a contour to the path of the tool's centre: what is only rounding is left out."""

from __future__ import annotations

from g12.compensation.contour import Contour, Element
from g12.compensation.offset import tool_path
from g12.compensation.simplify import with_points_left_out, without_short_moves
from g12.errors import Refusal

SHORT_SHARE = 0.3  # of the tolerance: a shorter move under compensation is rounding


def centre_path(contour: Contour, tolerance: float) -> tuple[list[Element], float]:
    """Return the path of the tool's centre, and by how much the contour was moved for it.

    Points nearer to each other than their last decimal allows make corners that no tool reaches:
    where a contour would be refused, it is tried without them.
    """
    limit = SHORT_SHARE * tolerance
    meant, moved = without_short_moves(contour.elements, limit)
    try:
        return tool_path(contour, meant, tolerance - moved), moved
    except Refusal as refusal:
        fewer, left_out = with_points_left_out(meant, limit - moved)
        if len(fewer) == len(meant):
            raise
        try:
            return tool_path(contour, fewer, tolerance - moved - left_out), moved + left_out
        except Refusal:
            raise refusal from None
