# SPDX-License-Identifier: GPL-2.0-or-later
"""Compensated lines that go back along the line before: the tool then cuts on both sides of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from g12.tools.verify.expected.contour import Element, SectionContour
from g12.tools.verify.result.finding import Finding

STRAIGHT_BACK = -0.999999  # cosine of the angle between the two directions, at most


def judge_reversals(sections: Sequence[SectionContour]) -> Iterator[Finding]:
    """Yield the lines under G41 or G42 that go straight back: a lost minus sign does that."""
    for section in sections:
        drawn = [element for element in section.elements if element.length]
        for before, after in pairwise(drawn):
            if goes_back(before, after):
                values = {"line": before.line, "code": "G41" if after.side > 0 else "G42"}
                yield Finding("goes-back", after.line, values, file=section.file)


def goes_back(before: Element, after: Element) -> bool:
    """Return whether both are lines of a compensated contour, the second back along the first."""
    if not before.side or before.side != after.side or before.ramp or after.ramp:
        return False
    if before.centre is not None or after.centre is not None:
        return False
    ways = (before.end - before.start) * (after.end - after.start).conjugate()
    return ways.real < STRAIGHT_BACK * abs(ways)
