# SPDX-License-Identifier: GPL-2.0-or-later
"""The cutter of a cycle whose D is modal: that of the block, the last one, or the loaded tool."""

from collections.abc import Callable
from typing import NamedTuple

from g12.cut_report import BY_D, BY_LAST_D, LOADED, PlannedCut, UsedCutter
from g12.cycles.plan import CyclePlan
from g12.request.common import commanded_tool, other_cutter, sound_tool
from g12.request.context import Tool
from g12.request.travel import CycleExtent
from g12.request.words import Words


class Cutter(NamedTuple):
    """The cutter of a block, its name in messages, and what the operator hears of it."""

    used: UsedCutter
    source: str
    other: str | None
    kept: str | None

    @property
    def radius(self) -> float:
        return self.used.radius

    def plan(
        self,
        numbers: dict[str, float],
        extent: CycleExtent,
        cut: Callable[[], PlannedCut],
        message: str | None = None,
    ) -> CyclePlan:
        used = self.used
        commanded = Tool(used.number, used.radius) if used.source == BY_D else None
        return CyclePlan(
            numbers, extent, cut, message, self.other, commanded, kept_cutter=self.kept
        )


def chosen_cutter(words: Words) -> Cutter:
    """Return the cutter: D in the block, else the D last commanded, else the loaded tool."""
    context, other = words.context, other_cutter(words, words.context.last_cutter)
    tool, by, kept = commanded_tool(words), BY_D, None
    if tool is not None:
        source = f"D{tool.number}"
    elif context.last_cutter is not None:
        tool, by, source = context.last_cutter, BY_LAST_D, "the D last commanded"
    elif context.spindle_tool is not None:
        tool, by = context.spindle_tool, LOADED
        source = f"T{tool.number} in the spindle"
    else:
        raise words.refuse("D is missing, none was commanded before and no tool is loaded")
    if by != BY_LAST_D:
        sound_tool(words, tool, source)
    if by != BY_D:
        kept = kept_cutter(words, tool)
    return Cutter(UsedCutter(tool.radius, by, tool.number), source, other, kept)


def kept_cutter(words: Words, cutter: Tool) -> str | None:
    """Return the operator message of a block without D whose cutter the program does not show.

    It may be that of an older line of the tool table, or depend on what ran before.
    """
    context, before = words.context, "the D of what ran before"
    size = context.tool_size(2 * cutter.radius)
    named = context.tool_in_table(cutter.number) if cutter.number else None
    if named and abs(named.radius - cutter.radius) > context.rounding:
        now = context.tool_size(2 * named.radius)
        return (
            f"{words.code}: D{cutter.number} has the diameter {now} in the tool table now, but"
            f" counts as it was commanded, with {size}. Give D{cutter.number} again"
        )
    if not context.d_is_earlier():
        return None
    counts = f"{before} counts, diameter {size}"
    if context.last_cutter is None:
        counts = f"the loaded tool T{cutter.number} counts, diameter {size}, or {before}"
    return f"{words.code}: no D above this block in the program: {counts}. Give D"
