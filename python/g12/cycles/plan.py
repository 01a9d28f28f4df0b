# SPDX-License-Identifier: GPL-2.0-or-later
"""The result of the planner of any cycle."""

from collections.abc import Callable
from typing import NamedTuple

from g12.cut_report import PlannedCut
from g12.request.travel import CycleExtent


class CyclePlan(NamedTuple):
    """A checked cycle: ``locals`` are the named locals of its sub, which its .ngc file explains.

    Lengths and feeds are in program units. ``message`` is for the operator, never a refusal, as is
    ``other_cutter``: D is not the loaded tool. ``commanded_radius`` is that of the cutter that a
    Haas D names. ``cut`` returns what is reported of it.
    """

    locals: dict[str, float]
    extent: CycleExtent
    cut: Callable[[], PlannedCut]
    message: str | None = None
    other_cutter: str | None = None
    commanded_radius: float | None = None
