# SPDX-License-Identifier: GPL-2.0-or-later
"""Warnings that a program or a user accepts: ``(g12: expect core)`` in a line, ``--accept core``.

In the line of a cut it is for all of that cut. What would break a part is never accepted.
"""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from g12.tools.verify.model.cut import Cut
from g12.tools.verify.model.finding import KINDS, WARNING, Finding, kind

EXPECT = re.compile(r"\(\s*g12:\s*expect\s+([^()]*)\)", re.IGNORECASE)
UNMET = kind("expect", WARNING, "{code} is accepted here, and nothing of it is found{hint}")
NEVER = ": only a warning can be accepted"


class Accepted(NamedTuple):
    """A code that is accepted in a line, or with line 0 everywhere."""

    code: str
    line: int


def acceptable() -> set[str]:
    return {each.code for each in KINDS.values() if each.severity == WARNING and each is not UNMET}


def expectations(program: Path) -> list[Accepted]:
    """Return what the comments of a program accept."""
    lines = program.read_text(encoding="utf-8", errors="replace").splitlines()
    return [
        Accepted(code.lower(), number)
        for number, line in enumerate(lines, 1)
        for comment in EXPECT.finditer(line)
        for code in re.split(r"[\s,]+", comment[1].strip())
        if code
    ]


def accepted(
    found: Iterable[Finding], cuts: Sequence[Cut], expected: Sequence[Accepted]
) -> tuple[list[Finding], list[Finding]]:
    """Return what remains, with a warning for each unmet acceptance, and what is accepted."""
    pairs = [(each, [one for one in expected if _meets(each, one, cuts)]) for each in found]
    met = {one for _, ones in pairs for one in ones}
    rest = [each for each, ones in pairs if not ones]
    for one in expected:
        if one not in met:
            hint = "" if one.code in acceptable() else NEVER
            rest.append(Finding(UNMET, one.line, {"code": one.code, "hint": hint}))
    return rest, [each for each, ones in pairs if ones]


def _meets(found: Finding, one: Accepted, cuts: Sequence[Cut]) -> bool:
    if found.code != one.code or found.severity != WARNING:
        return False
    own = [cut for cut in cuts if cut.line == one.line and not found.file]
    inside = any(cut.line <= found.line <= cut.last_line for cut in own)
    return inside or one.line in (0, found.line)
