# SPDX-License-Identifier: GPL-2.0-or-later
"""What bore, thread and frame share: centre, top and bottom, the cutter, the turns of a helix.

Lengths are in program units.
"""

from collections.abc import Callable
from math import ceil, cos, pi, sin
from typing import NamedTuple

from g12.cut_report import BY_D, BY_LAST_D, LOADED, PlannedCut, UsedCutter
from g12.cycles.haas import choose_cutter, kept_cutter
from g12.cycles.plan import CyclePlan
from g12.errors import number
from g12.request.common import COUNTERCLOCKWISE, check_modes, check_start, other_cutter
from g12.request.context import Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words

CLEARANCE_MM, CLEARANCE_INCH = 1.0, 0.04  # of the rapid down, above the top
WHOLE_TURN = 1e-5  # a smaller part of a turn is rounding: its arc would be a full circle


class Hole(NamedTuple):
    """Centre, the Z where the block begins, the end of the rapid down, top and bottom."""

    x: float
    y: float
    start: float
    clear: float
    top: float
    bottom: float

    @property
    def depth(self) -> float:
        return self.top - self.bottom


class Chosen(NamedTuple):
    """The cutter of a block, its name in messages, and what the operator hears of it."""

    tool: Tool
    source: str
    used: UsedCutter
    other: str | None
    kept: str | None

    @property
    def radius(self) -> float:
        return self.tool.radius

    def plan(
        self,
        numbers: dict[str, float],
        extent: CycleExtent,
        cut: Callable[[], PlannedCut],
        message: str | None = None,
    ) -> CyclePlan:
        commanded = self.tool if self.used.source == BY_D else None
        return CyclePlan(
            numbers, extent, cut, message, self.other, commanded, kept_cutter=self.kept
        )


def check_block(words: Words, known: str) -> None:
    check_modes(words)
    words.check_known(known)
    if "X" not in words and "Y" not in words:
        check_start(words)


def hole_of(words: Words, top: float | None = None) -> Hole:
    """Return where the cycle cuts; under G91 its Z counts from the top, which is R or ``top``."""
    context = words.context
    x = context.absolute(words.take("X"), context.x)
    y = context.absolute(words.take("Y"), context.y)
    depth = words.require("Z", "the depth")
    if top is None:
        given = words.take("R")
        top = context.absolute(given, context.z)
        if top > context.z + context.rounding:
            rule = f"puts the top above the tool at Z{number(context.z)}: retract first"
            raise words.refuse_word("R", top if given is None else given, rule)
    bottom = top + depth if context.incremental else depth
    if bottom >= top - context.smallest_ring:
        raise words.refuse_word("Z", depth, f"must be below the top, Z{number(top)}")
    clearance = CLEARANCE_INCH if context.inch else CLEARANCE_MM
    return Hole(x, y, context.z, min(context.z, top + clearance), top, bottom)


def chosen_cutter(words: Words) -> Chosen:
    """Return the cutter: D, else the D last commanded, else the loaded tool."""
    context, with_d = words.context, "D" in words
    other = other_cutter(words, context.last_cutter)
    tool, source = choose_cutter(words)
    by = BY_D if with_d else LOADED if context.last_cutter is None else BY_LAST_D
    kept = None if with_d else kept_cutter(words, tool)
    return Chosen(tool, source, UsedCutter(tool.radius, by, tool.number), other, kept)


def turns_of(height: float, pitch: float, arc: int) -> dict[str, float]:
    """Return the locals of one helix from +X: turns begun, direction of its end from the centre."""
    turns = height / pitch
    if abs(turns - round(turns)) < WHOLE_TURN:
        turns = max(1, round(turns))
    angle = 2 * pi * (turns % 1) * (1 if arc == COUNTERCLOCKWISE else -1)
    return {"rounds": ceil(turns), "end_x": cos(angle), "end_y": sin(angle)}
