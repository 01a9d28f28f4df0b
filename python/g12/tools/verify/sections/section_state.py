# SPDX-License-Identifier: GPL-2.0-or-later
"""What a section does besides moving, and what it leaves, against the words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

from g12.tools.preview.moves import Move
from g12.tools.verify.compare.state import judge_state, state_differences
from g12.tools.verify.expected.contour import ACTS, SectionContour
from g12.tools.verify.result.finding import Finding
from g12.tools.verify.result.tolerances import ANGLE, WALL


class Done(NamedTuple):
    """An act as it came, or as it is asked for, and the line cut before it (0: none)."""

    text: str
    behind: int

    @property
    def place(self) -> str:
        """Where it comes in words."""
        return f"after line {self.behind}" if self.behind else "at the start"


def judge_section_state(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield what a section does besides moving, or leaves, otherwise than its words ask."""
    yield from judge_acts(section, moves)
    place = WALL / section.unit
    allowed = {"_x": place, "_z": place, "_c": ANGLE}
    differences = state_differences(section.left, section.leaves, allowed)
    yield from judge_state(differences, (), section.last)
    if len(set(section.paths)) > 1:
        found, expected = section.paths
        yield Finding("state", section.last, {"found": found, "expected": expected})


def judge_acts(section: SectionContour, moves: Sequence[Move]) -> Iterator[Finding]:
    """Yield the first act of a section that is missing, in another place or not in the words."""
    told = [
        Done(event.text, moves[event.at - 1].line if event.at > section.at else 0)
        for event in section.told
        if ACTS.match(event.text)
    ]
    cut = {moves[index].line for index in range(section.at, section.end)}
    lines = [
        [e.line for e in section.elements[: act.drawn] if e.line in cut] for act in section.acts
    ]
    asked = [
        Done(act.text, before[-1] if before else 0) for act, before in zip(section.acts, lines)
    ]
    pairs = zip_longest(told, asked)
    at = next((at for at, (one, other) in enumerate(pairs) if one != other), None)
    if at is None:
        return
    found, expected = told[at:], asked[at:]
    moved = bool(found and expected) and expected[0] in found
    if not expected or (moved and expected[0].text != found[0].text):
        values = {"act": found[0].text, "found": found[0].place}
        yield Finding("act-extra", found[0].behind, values)
        return
    values = {"act": expected[0].text, "asked": expected[0].place}
    same = [done for done in found if done.text == expected[0].text]
    more, code = ({"found": same[0].place}, "act-elsewhere") if same else ({}, "act-missing")
    yield Finding(code, section.acts[at].line, {**values, **more})
