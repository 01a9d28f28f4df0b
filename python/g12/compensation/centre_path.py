# SPDX-License-Identifier: GPL-2.0-or-later
"""From a contour to the tool centre's path, without the rounding in the program's points."""

from __future__ import annotations

from g12.compensation.contour import Contour, PathElement
from g12.compensation.offset import tool_path
from g12.compensation.simplify import (
    with_arcs_of_the_tool,
    without_rounding_points,
    without_short_moves,
)
from g12.errors import Refusal

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
