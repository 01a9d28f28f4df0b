# SPDX-License-Identifier: GPL-2.0-or-later
"""The modal state after a block and what happens besides motion, against what the words ask.

States are by the interpreter's names, ``_metric``, ``_feed``, in program units; events are texts
of a trace: ``M8 on``, ``S1000``, ``dwell 2``.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import NamedTuple

from g12.tools.preview.executed_blocks import Block
from g12.tools.preview.moves import Move
from g12.tools.units import plain
from g12.tools.verify.expected.contour import ACTS, SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import ANGLE, STATE, WALL

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
    differences: Iterable[StateDifference], events: Iterable[str], line: int
) -> Iterator[Finding]:
    """Yield the findings of a state that is otherwise, and of events that are not in the words."""
    for difference in differences:
        found, expected = difference.texts()
        yield Finding("state", line, {"found": found, "expected": expected})
    for text in events:
        yield Finding("extra-event", line, {"event": text})


def _text(name: str, value: float) -> str:
    if name in MODES:
        return MODES[name][int(value)]
    if name in CODES:
        return f"G{value / 10:g}"
    letter = LETTERS.get(name) or name.removeprefix("_")[0].upper()
    return f"{letter}{plain(value, 4)}"


class Done(NamedTuple):
    """An act, actual or expected, and the line cut before it (0: none)."""

    text: str
    after: int

    @property
    def place(self) -> str:
        """Where it comes in words."""
        return f"after line {self.after}" if self.after else "at the start"


def judge_section_state(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield what a section does besides moving, or leaves, otherwise than its words ask."""
    yield from judge_acts(section, moves)
    place = WALL / section.unit
    allowed = {"_x": place, "_z": place, "_c": ANGLE}
    differences = state_differences(section.state_after, section.expected_state, allowed)
    yield from judge_state(differences, (), section.last)
    if len(set(section.paths_after)) > 1:
        found, expected = section.paths_after
        yield Finding("state", section.last, {"found": found, "expected": expected})


def judge_acts(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the first act of a section that is missing, in another place or not in the words."""
    actual = [
        Done(event.text, moves[event.at - 1].line if event.at > section.at else 0)
        for event in section.events
        if ACTS.match(event.text)
    ]
    cut = {moves[index].line for index in range(section.at, section.end)}
    lines = [
        [e.line for e in section.elements[: act.drawn] if e.line in cut] for act in section.acts
    ]
    commanded = [
        Done(act.text, before[-1] if before else 0) for act, before in zip(section.acts, lines)
    ]
    pairs = zip_longest(actual, commanded)
    at = next((at for at, (one, other) in enumerate(pairs) if one != other), None)
    if at is None:
        return
    found, expected = actual[at:], commanded[at:]
    moved = bool(found and expected) and expected[0] in found
    if not expected or (moved and expected[0].text != found[0].text):
        values = {"act": found[0].text, "found": found[0].place}
        yield Finding("act-extra", found[0].after, values)
        return
    values = {"act": expected[0].text, "asked": expected[0].place}
    same = [done for done in found if done.text == expected[0].text]
    more, code = ({"found": same[0].place}, "act-elsewhere") if same else ({}, "act-missing")
    yield Finding(code, section.acts[at].line, {**values, **more})
