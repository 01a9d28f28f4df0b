# SPDX-License-Identifier: GPL-2.0-or-later
"""The result of the planner of any cycle."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from g12.cut_report import PlannedCut
from g12.request.context import Tool
from g12.request.travel import CycleExtent


class EventPlanes(NamedTuple):
    """The circle mill's modal reference planes W and O; None where no event has commanded one."""

    first: float | None = None
    second: float | None = None

    def scaled(self, factor: float) -> EventPlanes:
        """Return the planes in another unit."""
        return EventPlanes(*(None if plane is None else plane * factor for plane in self))


class CyclePlan(NamedTuple):
    """A checked cycle: ``locals`` are the named locals of its sub, which its .ngc file explains.

    Lengths and feeds are in program units. ``message`` is for the operator, never a refusal, as are
    ``other_cutter``: D is not the loaded tool, and ``kept_cutter``: without D another one counts
    than the program shows. ``commanded_cutter`` is the one that a Haas D names,
    ``commanded_planes`` are those that an event gives for later ones. ``cut`` returns what is
    reported.
    """

    locals: dict[str, float]
    extent: CycleExtent
    cut: Callable[[], PlannedCut]
    message: str | None = None
    other_cutter: str | None = None
    commanded_cutter: Tool | None = None
    commanded_planes: EventPlanes | None = None
    kept_cutter: str | None = None
