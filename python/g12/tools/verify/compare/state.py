# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state after a block and what happens besides motion, against what the words ask.

States are by the interpreter's names, ``_metric``, ``_feed``, in program units; events are texts
of a trace: ``M8 on``, ``S1000``, ``dwell 2``.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from g12.tools.preview.executed_blocks import Block
from g12.tools.units import plain
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import STATE

ACT = re.compile(r"(G|M\d|S|tool|dwell (?!0$))")  # of what a trace reports
UNITS, FORGOTTEN = {20.0, 21.0}, "G64 P0.1 Q0.1"  # what a preview makes of G64 where units change
MODES = {
    "_metric": ("G20", "G21"),
    "_absolute": ("G91", "G90"),
    "_units_per_rev": ("G94", "G95"),
    "_lathe_diameter_mode": ("G8", "G7"),
    "_ijk_absolute_mode": ("G91.1", "G90.1"),
}
CODES = ("_motion_mode", "_plane")
LETTERS = {"_selected_tool": "T", "_rpm": "S"}


class StateDifference(NamedTuple):
    """A modal value that is otherwise than the words ask, in program units."""

    name: str
    found: float
    expected: float

    def texts(self) -> tuple[str, str]:
        """Return as words what was found and what is expected."""
        return _text(self.name, self.found), _text(self.name, self.expected)


def state_differences(
    found: Mapping[str, float],
    expected: Mapping[str, float],
    allowed: Mapping[str, float] | None = None,
) -> tuple[StateDifference, ...]:
    """Return which values differ by more than is ``allowed``, or relatively by rounding.

    An empty state is that of a program which ended in the block. Angles of C count in any turn.
    """
    allowed = allowed or {}
    return tuple(
        StateDifference(name, found[name], value)
        for name, value in expected.items()
        if found
        and _apart(name, found[name], value) > allowed.get(name, STATE * max(1.0, abs(value)))
    )


def _apart(name: str, one: float, other: float) -> float:
    return abs(math.remainder(one - other, 360.0) if name == "_c" else one - other)


def extra_events(block: Block) -> tuple[str, ...]:
    """Return what a block does besides moving, though its words do not say so."""
    found = [event.text for event in block.own_events if ACT.match(event.text)]
    return tuple(dict.fromkeys(text for text in found if not _is_said(text, block)))


def _is_said(event: str, block: Block) -> bool:
    """Tell whether a block's words say what an event reports.

    Where the units change, a preview makes another G64 of the one in force.
    """
    if event == FORGOTTEN and UNITS.intersection(block.codes):
        return True
    said = [f"M{code:g}" for code in block.m_codes] + [f"G{code:g}" for code in block.codes]
    if 9.0 in block.m_codes and event.endswith(" off"):
        return True
    return event.split()[0] in said or (event[0] == "S" and "S" in block.words)


def judge_state(
    differences: Iterable[StateDifference], events: Iterable[str], line: int, file: str = ""
) -> Iterator[Finding]:
    """Yield the findings of a state that is otherwise, and of events that are not in the words."""
    for difference in differences:
        found, expected = difference.texts()
        yield Finding("state", line, {"found": found, "expected": expected}, file=file)
    for text in events:
        yield Finding("extra-event", line, {"event": text}, file=file)


def _text(name: str, value: float) -> str:
    if name in MODES:
        return MODES[name][int(value)]
    if name in CODES:
        return f"G{value / 10:g}"
    letter = LETTERS.get(name) or name.removeprefix("_")[0].upper()
    return f"{letter}{plain(value, 4)}"
