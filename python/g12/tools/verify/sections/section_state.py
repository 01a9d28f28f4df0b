# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section does besides moving, and what it leaves behind, against the words."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from typing import NamedTuple

from g12.tools.preview.moves import Move
from g12.tools.verify.compare.state import StateDifference, state_differences
from g12.tools.verify.expected.contour import ACTS, Act, SectionContour

SAME_PLACE = 0.005  # mm
SAME_ANGLE = 0.01  # degrees


class OffAct(NamedTuple):
    """An act that is missing, in another place or not in the words.

    ``found`` and ``asked`` are the lines cut before it, 0 at the section's start; None where it
    does not come or is not asked for.
    """

    line: int
    text: str
    found: int | None
    asked: int | None


class Done(NamedTuple):
    """An act as it came, or as it is asked for, and the line cut before it (0: none)."""

    text: str
    behind: int


def act_off(section: SectionContour, moves: Sequence[Move]) -> OffAct | None:
    """Return the first act of a section that is not as its words ask."""
    told = [
        Done(event.text, moves[event.at - 1].line if event.at > section.at else 0)
        for event in section.told
        if ACTS.match(event.text)
    ]
    cut = {moves[index].line for index in range(section.at, section.end)}
    asked = [Done(act.text, line_before(act, section, cut)) for act in section.acts]
    for index, (found, wanted) in enumerate(zip_longest(told, asked)):
        if found != wanted:
            lines = [act.line for act in section.acts[index:]]
            return different(told[index:], asked[index:], lines)
    return None


def line_before(act: Act, section: SectionContour, cut: set[int]) -> int:
    """Return the line of the last element before an act that was cut, 0 without one."""
    drawn = section.elements[: act.drawn]
    return next((element.line for element in drawn[::-1] if element.line in cut), 0)


def different(told: Sequence[Done], asked: Sequence[Done], lines: Sequence[int]) -> OffAct:
    """Return how the first two acts differ; ``lines`` are those of the ones asked for."""
    if not asked or (told and asked[0].text != told[0].text and asked[0] in told):
        return OffAct(told[0].behind, told[0].text, told[0].behind, None)
    same = [act for act in told if act.text == asked[0].text]
    return OffAct(lines[0], asked[0].text, same[0].behind if same else None, asked[0].behind)


def left_by_section(section: SectionContour) -> tuple[StateDifference, ...]:
    """Return which positions and modes a section leaves otherwise than its words ask."""
    place = SAME_PLACE / section.unit
    allowed = {"_x": place, "_z": place, "_c": SAME_ANGLE}
    return state_differences(section.left, section.leaves, allowed)
