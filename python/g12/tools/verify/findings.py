# SPDX-License-Identifier: GPL-2.0-or-later
"""What is wrong with what was measured, and what else a user should know of it, in words.

A judgement of its own is a generator here, called from the one of its kind of facts.
"""

from __future__ import annotations

from collections.abc import Iterator

from g12.tools.units import MM, Unit
from g12.tools.verify.axis_limits import Overrun
from g12.tools.verify.pocket import PocketFacts
from g12.tools.verify.pocket_area import is_wrong_tool
from g12.tools.verify.reading.circles import Cutter

SAME_AREA = 0.01  # mm², less is rounding
SAME_SIZE = 1e-4  # mm


def overrun_text(overrun: Overrun, unit: Unit) -> str:
    """Return in words which axis leaves its travel."""
    there, limit = unit.text(overrun.position), unit.text(overrun.limit)
    return f"the {overrun.letter} axis would go to {there}, its limit is {limit} {unit.name}"


def other_tool(cutter: Cutter, unit: Unit) -> str:
    """Return in words that D is not the loaded tool."""
    loaded, named = (unit.text(2 * size) for size in (cutter.loaded, cutter.radius))
    return f"the loaded tool T{cutter.tool} (⌀ {loaded}) is not D{cutter.named} (⌀ {named})"


def pocket_notes(facts: PocketFacts, unit: Unit = MM) -> Iterator[str]:
    """Yield what a user should know of a pocket that is no fault."""
    cutter = facts.target.cutter
    if cutter.word:
        yield "the tool's centre goes round on the circle, the wall is a tool radius farther"
    if facts.overruns is None:
        yield "its travel is not known: with the machine's var file the program moves otherwise"
    for overrun in facts.overruns or ():
        if not overrun.certain:
            yield f"with no work offset {overrun_text(overrun, unit)}"
    if cutter.named is None or is_wrong_tool(cutter):
        return
    if not cutter.loaded:
        lacks = f"T{cutter.tool} has no diameter" if cutter.tool > 0 else "no tool is loaded"
        yield f"{lacks}: measured with the diameter of D{cutter.named}"
    elif abs(cutter.radius - cutter.loaded) > SAME_SIZE:
        yield f"{other_tool(cutter, unit)}: measured with the cutter of D{cutter.named}"
