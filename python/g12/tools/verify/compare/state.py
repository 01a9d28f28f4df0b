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
REPORTED = {43.0, 43.1, 43.2, 49.0, *(54.0, 55.0, 56.0, 57.0, 58.0, 59.0, 59.1, 59.2, 59.3)}
REPORTED |= {61.0, 61.1, 64.0, 96.0, 97.0}  # codes of which a trace reports
UNITS, FORGOTTEN = {20.0, 21.0}, "G64 P0.1 Q0.1"  # what a preview makes of G64 where units change
MODES = {
    "_metric": ("G20", "G21"),
    "_absolute": ("G91", "G90"),
    "_units_per_rev": ("G94", "G95"),
    "_lathe_diameter_mode": ("G8", "G7"),
    "_ijk_absolute_mode": ("G91.1", "G90.1"),
}
CODES = ("_motion_mode", "_plane")


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
    says_more = block.m_codes or block.words.keys() & {"S", "T"} or set(block.codes) & REPORTED
    found = [] if says_more else [event.text for event in block.own_events if ACT.match(event.text)]
    forgotten = FORGOTTEN if UNITS.intersection(block.codes) else None
    return tuple(dict.fromkeys(text for text in found if text != forgotten))


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
    return f"{name.removeprefix('_')[0].upper()}{plain(value, 4)}"
